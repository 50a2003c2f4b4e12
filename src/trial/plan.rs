//! Which cases a trial consists of.

use crate::diagnose::{Case, Options, diagnose};
use crate::effects::Effect;

use super::TrialError;
use super::specimen::make_specimen;

/// How large an effect is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    Small,
    Medium,
    Large,
}

/// Small is this often what could just be seen; large at least so often.
const SMALL: f64 = 3.0;
const LARGE: f64 = 12.0;
/// And large is at least this often what is typical.
const TYPICAL: f64 = 1.5;

/// One case: a scene, and what it gets besides.
#[derive(Clone, Debug)]
pub struct TrialCase {
    pub name: String,
    pub scene: String,
    pub size: Option<Size>,
    pub effect: Option<Effect<f64>>,
    pub seed: u64,
}

/// Nulls of a scene, and every effect that its recordings could show, at three sizes.
///
/// # Errors
/// A scene that cannot be run.
pub fn plan(scene: &str, nulls: usize, only: Option<&str>, seed: u64) -> Result<Vec<TrialCase>, TrialError> {
    let null = |i: usize| TrialCase {
        name: format!("{scene} nothing {i}"),
        scene: scene.to_owned(),
        size: None,
        effect: None,
        seed: seed.wrapping_mul(1000).wrapping_add(i as u64),
    };
    let mut cases: Vec<TrialCase> = (0..nulls).map(null).collect();
    for least in just_visible(scene, seed)? {
        for size in [Size::Small, Size::Medium, Size::Large] {
            let effect = sized(&least, size);
            let on = effect.channel.clone().unwrap_or_else(|| effect.element.to_string());
            let number = cases.len() as u64;
            cases.push(TrialCase {
                name: format!("{scene} {} {on} {} {size:?}", effect.entry.name, effect.entry.parameters[0].key),
                scene: scene.to_owned(),
                size: Some(size),
                effect: Some(effect),
                seed: seed.wrapping_mul(1000).wrapping_add(500 + number),
            });
        }
    }
    // Left out at the end: a case has the same seed whether it is tried alone or among all.
    cases.retain(|c| only.is_none_or(|name| c.effect.as_ref().is_some_and(|e| e.entry.name == name)));
    Ok(cases)
}

/// Every effect at the size from which the recordings of a scene could show it; of two equal elements the first.
fn just_visible(scene: &str, seed: u64) -> Result<Vec<Effect<f64>>, TrialError> {
    let folder = tempfile::Builder::new().prefix("smam-trial-").tempdir();
    let folder = folder.map_err(|source| TrialError::Write { file: std::env::temp_dir(), source })?;
    make_specimen(scene, None, 1.0, seed, folder.path())?;
    let outcome = diagnose(Case::load(&[folder.path()], None, &[])?, Options { seed }, &|_| {})?;
    let mut least: Vec<Effect<f64>> = Vec::new();
    for effect in outcome.just_visible {
        let alike = |e: &&mut Effect<f64>| {
            e.entry == effect.entry && e.element.kind == effect.element.kind && e.channel == effect.channel
        };
        match least.iter_mut().find(alike) {
            Some(known) if known.element == effect.element && effect.values[0].abs() < known.values[0].abs() => {
                *known = effect;
            }
            Some(_) => {}
            None => least.push(effect),
        }
    }
    // Texts come after code: an entry more leaves the numbers of the others, and their seeds, as they are.
    least.sort_by_key(|e| (e.entry.native.is_none(), e.entry.native, e.entry, e.channel.clone()));
    Ok(least)
}

fn sized(least: &Effect<f64>, size: Size) -> Effect<f64> {
    let p = &least.entry.parameters[0];
    let small = SMALL * least.values[0];
    let large = (LARGE * least.values[0]).abs().max(TYPICAL * p.typical.abs()).copysign(small);
    let value = match size {
        Size::Small => small,
        Size::Medium => (small * large).sqrt().copysign(small),
        Size::Large => large,
    };
    let mut effect = least.clone();
    effect.values[0] = value.clamp(p.range.min, p.range.max);
    effect
}
