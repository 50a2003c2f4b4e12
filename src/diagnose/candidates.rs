//! Which effects a rig could have, and with which numbers each is first tried.

use crate::effects::{CATALOGUE, EffectSpec, Element, ElementKind, Kind};
use crate::scene::Scene;

use super::case::Case;
use super::grammar;
use super::model::Placed;

/// An effect with numbers to start from; the size is the first of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    pub placed: Placed,
    pub values: Vec<f64>,
}

/// Every effect that can sit on the case's scene, each in the variants it is first tried in.
pub fn variants(case: &Case) -> Vec<Variant> {
    let mut all = Vec::new();
    for spec in CATALOGUE.iter().filter(|s| !s.kind.is_hypothetical()) {
        for placed in places(case, spec) {
            let tried = starts(case, &placed).into_iter().filter(|v| fits_scene(case, &placed, v));
            all.extend(tried.map(|values| Variant { placed: placed.clone(), values }));
        }
    }
    all.extend(case.scene.candidates.iter().map(|candidate| grammar::candidate(case, candidate)));
    all
}

/// What equal parts have in common when one has it: material, make, surface. These are tried on all of them at once.
const IN_ALL: [Kind; 4] = [Kind::Viscoelasticity, Kind::MullinsSoftening, Kind::CoilPreload, Kind::TendonFriction];

fn places(case: &Case, spec: &EffectSpec) -> Vec<Placed> {
    let file = &case.scene.file;
    let on = |kind: ElementKind, index: usize, count: usize, channel: Option<&str>| Placed {
        kind: spec.kind,
        element: Element::of(kind, index, count),
        channel: channel.map(str::to_owned),
    };
    let count = match spec.element {
        ElementKind::Sensor => {
            return case.channels.iter().map(|c| on(ElementKind::Sensor, 0, 1, Some(&c.column))).collect();
        }
        ElementKind::Mechanism => 1,
        ElementKind::Syringe if file.axis.is_some() => 1,
        ElementKind::Muscle if file.strip.is_some() => 1,
        ElementKind::Line if file.chamber.is_some() => chambers(case),
        ElementKind::Cable => file.cable.len(),
        _ => file.muscle.len(),
    };
    let mut placed: Vec<Placed> = (0..count).map(|i| on(spec.element, i, count, None)).collect();
    if count > 1 && (IN_ALL.contains(&spec.kind) || file.chamber.is_some()) {
        placed.push(on(spec.element, 0, 1, None));
    }
    if spec.kind == Kind::GravityLoad && file.cable.is_empty() {
        // On a bench the weight hangs on the muscle.
        placed = (0..file.muscle.len()).map(|i| on(ElementKind::Muscle, i, file.muscle.len(), None)).collect();
    }
    placed
}

/// How many chambers were recorded: each run may be another's.
fn chambers(case: &Case) -> usize {
    let numbers = case.runs.iter().filter_map(|r| r.scene.file.chamber.as_ref()).map(|c| c.number);
    numbers.max().unwrap_or(1)
}

/// Whether the scene takes the effect: the checks of a scene file decide.
fn fits_scene(case: &Case, placed: &Placed, values: &[f64]) -> bool {
    // A scene that already has friction growing with pressure calibrates it.
    if placed.kind == Kind::PressureFriction && case.parameters.iter().any(|p| p.key.contains("m1_n_pa")) {
        return false;
    }
    if placed.kind == Kind::NotchClosure && !has_flexures(&case.scene) {
        return false;
    }
    let mut file = case.scene.file.clone();
    file.law.retain(|law| !law.candidate);
    let effect = placed.with(values);
    match effect.law_table() {
        Some(law) => file.law.push(law),
        None => file.effect.push(effect.table()),
    }
    Scene::from_file(file, &case.scene.path).is_ok()
}

/// Whether a joint is a flexure, as the bridges beside a tube's notches are: bearings have no notches.
fn has_flexures(scene: &Scene) -> bool {
    let mut joints = scene.file.mechanism.iter().flat_map(|m| &m.joint);
    joints.any(|j| j.stiffness_n_m_rad.is_some_and(|k| k > 0.0))
}

/// Starting numbers. Where a second number bends the law (a time, a threshold), several are tried.
fn starts(case: &Case, placed: &Placed) -> Vec<Vec<f64>> {
    let typical = placed.spec().typical();
    let with = |seconds: &[f64]| -> Vec<Vec<f64>> {
        seconds
            .iter()
            .map(|&s| {
                let mut values = typical.clone();
                values[1] = s;
                values
            })
            .collect()
    };
    match placed.kind {
        Kind::Viscoelasticity => with(&[0.4, 4.0, 40.0]),
        Kind::PlasticSet => with(&levels(case, "elongation", 1e-3).unwrap_or_else(|| vec![0.012, 0.018, 0.03])),
        Kind::ExternalContact => with(&levels(case, "", std::f64::consts::PI / 180.0).unwrap_or_else(|| vec![0.6])),
        Kind::NotchClosure => with(&[0.15, 0.25, 0.35]),
        Kind::BearingFriction => with(&[0.01, 0.05]),
        Kind::RubberOgden => with(&[-2.0, 4.0, 8.0]),
        _ => vec![typical],
    }
}

/// Levels of the first recorded channel of a kind at which something could begin, SI: between its middle and its ends.
fn levels(case: &Case, name: &str, unit: f64) -> Option<Vec<f64>> {
    let suffix = if name.is_empty() { "_deg" } else { "_mm" };
    let channel = case.channels.iter().position(|c| c.column.ends_with(suffix) && c.column.contains(name))?;
    let mut values: Vec<f64> =
        case.runs.iter().flat_map(|r| r.measured[channel].iter().copied()).filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get((share * (values.len().max(1) - 1) as f64) as usize).copied();
    let shares: &[f64] = if name.is_empty() { &[0.03, 0.2, 0.6, 0.85, 0.97] } else { &[0.6, 0.9] };
    let found: Vec<f64> = shares.iter().filter_map(|&s| at(s)).map(|v| v * unit).collect();
    (!found.is_empty()).then_some(found)
}
