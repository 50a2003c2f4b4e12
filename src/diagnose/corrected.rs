//! The corrected scene: calibration and effects as found, in a file that runs, sweeps and views like any other.

use toml::Table;

use crate::scene::{Override, Scene, SceneError};

use super::case::Case;
use super::fit::Fit;

/// The scene with the numbers of a fit. The mechanism's file is named by its full path: the scene may stand anywhere.
///
/// # Errors
/// A fitted number that the scene's own checks refuse.
pub fn corrected_scene(case: &Case, fit: &Fit, title: &str) -> Result<String, SceneError> {
    let mut file = case.scene.file.clone();
    if let Some(mechanism) = &mut file.mechanism {
        let urdf = case.scene.folder().join(&mechanism.urdf);
        mechanism.urdf = urdf.canonicalize().unwrap_or(urdf);
    }
    file.name = format!("{}_corrected", file.name);
    file.title = title.to_owned();
    file.expect.clear();
    file.effect = fit.model.effects_at(&fit.x[case.parameters.len()..]).iter().map(|e| e.table()).collect();
    let refuse = |message: String| SceneError::Syntax { file: case.scene.path.clone(), message };
    let mut table: Table = Table::try_from(&file).map_err(|e| refuse(e.to_string()))?;
    for (p, value) in case.parameters.iter().zip(&fit.x) {
        Override::number(&p.key, *value).apply(&mut table)?;
    }
    let text = toml::to_string(&table).map_err(|e| refuse(e.to_string()))?;
    Scene::parse(&text, &case.scene.path, &[])?;
    Ok(text)
}
