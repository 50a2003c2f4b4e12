//! Effects that a rig could have, and the parameters each is first tried with.

use crate::effects::{Element, ElementKind, EntryId, Levels, Part, catalogue};
use crate::recording::parse_column;
use crate::scene::{Scene, SceneFile};

use crate::diagnose::case::Case;
use crate::diagnose::fit::{Placed, Variant};
use crate::diagnose::grammar;

/// Every effect that fits the scene, in its initial variants.
pub fn variants(case: &Case) -> Vec<Variant> {
    let mut all = Vec::new();
    for entry in catalogue().filter(|e| !e.hypothetical && (case.has_clock || !e.trying.needs_clock)) {
        for placed in places(case, entry) {
            let tried = starts(case, &placed).into_iter().filter(|v| fits_scene(case, &placed, v));
            all.extend(tried.map(|values| Variant { placed: placed.clone(), values }));
        }
    }
    all.extend(case.scene.candidates.iter().map(|candidate| grammar::candidate(case, candidate)));
    all
}

fn places(case: &Case, entry: EntryId) -> Vec<Placed> {
    let file = &case.scene.file;
    let on = |kind: ElementKind, index: usize, count: usize, channel: Option<&str>| Placed {
        entry,
        element: Element::of(kind, index, count),
        channel: channel.map(str::to_owned),
    };
    let count = match entry.element {
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
    let mut placed: Vec<Placed> = (0..count).map(|i| on(entry.element, i, count, None)).collect();
    if count > 1 && (entry.trying.shared || file.chamber.is_some()) {
        placed.push(on(entry.element, 0, 1, None));
    }
    let is_of_drive = entry.needs.iter().any(|need| need.scene == Part::DrivenCable);
    if is_of_drive && count > 1 && is_one_drive(file) {
        // What one drive has, all of its cables have.
        placed.drain(..count);
    }
    if let Some(kind) = entry.also_on.filter(|_| file.cable.is_empty()) {
        // On a bench the weight hangs on the muscle.
        placed = (0..file.muscle.len()).map(|i| on(kind, i, file.muscle.len(), None)).collect();
    }
    placed
}

/// Whether all cables hang on the same drive.
fn is_one_drive(file: &SceneFile) -> bool {
    let mut inputs = file.cable.iter().map(|cable| cable.drive.as_ref().map(|drive| &drive.input));
    let first = inputs.next().flatten();
    first.is_some() && inputs.all(|input| input == first)
}

/// Number of recorded chambers: each run may be of another one.
fn chambers(case: &Case) -> usize {
    let parameters = case.runs.iter().filter_map(|r| r.scene.file.chamber.as_ref()).map(|c| c.number);
    parameters.max().unwrap_or(1)
}

/// Whether the scene accepts the effect, by the checks of a scene file.
fn fits_scene(case: &Case, placed: &Placed, values: &[f64]) -> bool {
    let trying = &placed.spec().trying;
    // What a scene calibrates is no candidate beside it.
    let is_calibrated = |own: &String| case.parameters.iter().any(|p| p.key.contains(own));
    if trying.unless_calibrated.as_ref().is_some_and(is_calibrated)
        || (trying.needs_flexures && !has_flexures(&case.scene))
    {
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

/// Start values. If a second parameter bends the law (a time, a threshold), several are tried.
fn starts(case: &Case, placed: &Placed) -> Vec<Vec<f64>> {
    let typical = placed.spec().typical();
    let trying = &placed.spec().trying;
    let seconds = trying.levels.as_ref().and_then(|own| levels(case, own)).unwrap_or_else(|| trying.second.clone());
    if seconds.is_empty() {
        return vec![typical];
    }
    let with = |second: f64| [&typical[..1], &[second], &typical[2..]].concat();
    seconds.into_iter().map(with).collect()
}

/// Levels of the first recorded channel of a kind, SI.
fn levels(case: &Case, own: &Levels) -> Option<Vec<f64>> {
    let is_own = |column: &String| column.ends_with(&own.ending) && column.contains(&own.column);
    let channel = case.channels.iter().position(|c| is_own(&c.column))?;
    let unit = parse_column(&case.channels[channel].column).ok()?.unit;
    let mut values: Vec<f64> =
        case.runs.iter().flat_map(|r| r.measured[channel].iter().copied()).filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get((share * (values.len().max(1) - 1) as f64) as usize).copied();
    let found: Vec<f64> = own.shares.iter().filter_map(|&s| at(s)).map(|v| unit.to_si(v)).collect();
    (!found.is_empty()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;

    /// Both tendons hang on the one drive: its play is theirs together, and no single one's.
    #[test]
    fn what_a_drive_has_all_its_cables_have() {
        let case = made::recorded("tendon_sheath", &[], &["drive_deg"], &["tip_deg"]);
        let elements = |name: &str| -> Vec<String> {
            let own = variants(&case).into_iter().filter(|v| v.placed.spec().name == name);
            own.map(|v| v.placed.element.to_string()).collect()
        };
        assert_eq!(elements("drive_backlash"), ["cable"]);
        assert_eq!(elements("drive_nonlinearity"), ["cable"]);
        assert_eq!(elements("cable_slack"), ["cable_1", "cable_2"]);
    }

    /// Rows without a clock tell an order but no pace.
    #[test]
    fn without_a_clock_no_lag_is_tried() {
        let mut case = made::recorded("antagonistic_pulley", &[], &["plunger_1_mm", "plunger_2_mm"], &["angle_deg"]);
        let lags = |case: &Case| variants(case).iter().filter(|v| v.placed.spec().trying.needs_clock).count();
        assert!(lags(&case) > 0);
        case.has_clock = false;
        assert_eq!(lags(&case), 0);
    }
}
