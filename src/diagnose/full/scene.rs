//! Fitted scenes: calibration and effects as found, in a file that runs, sweeps and views like any other.

use toml::Table;

use crate::laws::LawTable;
use crate::scene::{Override, Scene, SceneError, SceneFile};
use crate::stock;

use crate::diagnose::case::{Case, CaseRun};
use crate::diagnose::fit::Fit;

/// The scene of a specimen (or of the only one) with the parameters of a fit, `suffix` added to its name. The mechanism's file is named by its full path: the
/// scene may stand anywhere.
///
/// # Errors
/// A fitted number that the scene's own checks refuse.
pub fn fitted_scene(
    case: &Case,
    fit: &Fit,
    specimen: Option<&str>,
    suffix: &str,
    title: &str,
) -> Result<String, SceneError> {
    let mut file = case.scene.file.clone();
    if let Some(mechanism) = &mut file.mechanism {
        let urdf = stock::join(case.scene.folder(), &mechanism.urdf);
        mechanism.urdf = urdf.canonicalize().unwrap_or(urdf);
    }
    file.name = format!("{}_{suffix}", file.name);
    file.title = title.to_owned();
    file.expect.clear();
    let text = with_parameters(case, fit, (specimen, None), file)?;
    Scene::parse(&text, &case.scene.path, &[])?;
    Ok(text)
}

/// The scene of a run, its conditions kept, with the parameters of a fit.
///
/// # Errors
/// A fitted number that the scene's own checks refuse.
pub fn corrected_run_scene(case: &Case, fit: &Fit, run: &CaseRun) -> Result<Scene, SceneError> {
    let of = (run.specimen.as_deref(), Some(run.file.as_str()));
    Scene::parse(&with_parameters(case, fit, of, run.scene.file.clone())?, &case.scene.path, &[])
}

/// A law under a name that no other has.
fn with_own_name(law: LawTable, others: &[LawTable]) -> LawTable {
    let is_free = |name: &str| others.iter().all(|other| other.name != name);
    let numbered = (2..).map(|n| format!("{}_{n}", law.name));
    let name = std::iter::once(law.name.clone()).chain(numbered).find(|name| is_free(name));
    LawTable { name: name.unwrap_or_default(), ..law }
}

/// `specimen` and `run`: what numbers may belong to.
fn with_parameters(
    case: &Case,
    fit: &Fit,
    (specimen, run): (Option<&str>, Option<&str>),
    mut file: SceneFile,
) -> Result<String, SceneError> {
    let effects = fit.model.effects_in(run, &fit.x[case.parameters.len()..]);
    file.law.retain(|law| !law.candidate);
    for effect in &effects {
        match effect.law_table() {
            Some(law) => file.law.push(with_own_name(law, &file.law)),
            None => file.effect.push(effect.table()),
        }
    }
    let refuse = |message: String| SceneError::Syntax { file: case.scene.path.clone(), message };
    let mut table: Table = Table::try_from(&file).map_err(|e| refuse(e.to_string()))?;
    for (p, value) in case.parameters_of(specimen, &fit.x) {
        Override::number(&p.key, value).apply(&mut table)?;
    }
    toml::to_string(&table).map_err(|e| refuse(e.to_string()))
}
