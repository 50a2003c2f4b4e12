//! Points of a sweep whose runs leave what the model, or the rig, can do: cables hang, fluid boils, coils yield.

use smam::sweep::{Plan, Row, Table, concern_column, trouble};
use smam::system::Concern;

/// Whether a point is in no trouble that its sweep does not allow.
pub fn is_sound(plan: &Plan, row: &Row) -> bool {
    trouble(plan, row).next().is_none()
}

/// How many points are in which trouble, and for how long at most; nothing where none is.
pub fn said_of_trouble(plan: &Plan, table: &Table) -> Option<String> {
    let points = table.rows.iter().filter(|row| row.outcome.is_ok() && !is_sound(plan, row)).count();
    let kinds: Vec<String> = Concern::ALL.into_iter().filter_map(|concern| kind(plan, table, concern)).collect();
    let words = if points == 1 { "point is" } else { "points are" };
    let ran = table.rows.iter().filter(|row| row.outcome.is_ok()).count();
    // Where no point is left the extremes are those of all.
    let left_out = if points == ran { "best" } else { "extremes and best" };
    (points > 0).then(|| {
        format!(
            "{points} {words} beyond what the rig can do ({}): left out of {left_out}, unless allowed",
            kinds.join(", ")
        )
    })
}

/// `slack at 4 points, up to 2.1 s`.
fn kind(plan: &Plan, table: &Table, concern: Concern) -> Option<String> {
    let own: Vec<f64> = in_trouble(plan, table, concern).into_iter().flatten().collect();
    let longest_s = own.iter().copied().fold(0.0, f64::max);
    let points = if own.len() == 1 { "point" } else { "points" };
    (!own.is_empty()).then(|| format!("{} at {} {points}, up to {longest_s:.1} s", concern.word(), own.len()))
}

/// Of each row: how long it is in a trouble that the sweep does not allow, s.
pub fn in_trouble(plan: &Plan, table: &Table, concern: Concern) -> Vec<Option<f64>> {
    let times_s = table.column(&concern_column(concern)).unwrap_or_default();
    let is_allowed = plan.file.allow.contains(&concern);
    times_s.into_iter().map(|s| (s > 0.0 && !is_allowed).then_some(s)).collect()
}
