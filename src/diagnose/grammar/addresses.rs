//! The addresses that a port has in the scene of a case.

use crate::diagnose::case::Case;
use crate::laws::{Carrier, PortSpec};

/// The port of every single element, and of all at once if there are several.
pub(super) fn addresses(case: &Case, spec: &PortSpec) -> Vec<String> {
    let file = &case.scene.file;
    let (count, together) = match spec.carrier {
        Carrier::Muscle => (file.muscle.len(), true),
        Carrier::Cable => (file.cable.len(), true),
        Carrier::Joint => return of_joints(case, spec),
        Carrier::Alone => (usize::from(stands_alone(case, spec)), false),
        Carrier::Sensor => (0, false),
    };
    let name = |number: Option<usize>| {
        let number = number.map_or(String::new(), |n| format!("_{n}"));
        if spec.term.is_empty() {
            format!("{}{number}", spec.element)
        } else {
            format!("{}{number}.{}", spec.element, spec.term)
        }
    };
    match count {
        0 => Vec::new(),
        1 => vec![name(None)],
        n => (1..=n).map(|i| name(Some(i))).chain(together.then(|| name(None))).collect(),
    }
}

/// The joints that move as one, and, where one cable bends several, each of them. On a slider that a muscle moves itself a force
/// on the joint is one of the muscle.
fn of_joints(case: &Case, spec: &PortSpec) -> Vec<String> {
    let file = &case.scene.file;
    if file.mechanism.is_none() || file.cable.is_empty() {
        return Vec::new();
    }
    let each = case.runs.first().map_or_else(Vec::new, |run| run.rom.joints_that_share_a_cable());
    let named = each.into_iter().map(|name| format!("{}({name}).{}", spec.element, spec.term));
    std::iter::once(spec.name()).chain(named).collect()
}

/// Whether laws are sought at the element that stands alone. Of one pull of a strip nothing tells time from stretch.
fn stands_alone(case: &Case, spec: &PortSpec) -> bool {
    let file = &case.scene.file;
    let open = || case.runs.iter().filter(|run| !run.is_held_out).count();
    match spec.element {
        "axis" => file.axis.is_some(),
        "strip" => file.strip.is_some() && open() > 1,
        // Each run may be of another chamber, with a leak of its own.
        _ => false,
    }
}
