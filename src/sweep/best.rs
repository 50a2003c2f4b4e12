//! The best points of a sweep under its limits, and how each point is scored.

use std::path::Path;

use super::SweepError;
use super::pareto::{Score, front};
use super::plan::Plan;
use super::point::Row;
use super::spec::{Goal, LimitSpec};
use super::table::Table;
use crate::files::write_whole;
use crate::system::Concern;

/// Indices into the table's rows: within the limits, and beaten by no other in all objectives. Without objectives none.
pub fn best(plan: &Plan, table: &Table) -> Vec<usize> {
    if plan.file.objective.is_empty() {
        return Vec::new();
    }
    front(&table.rows.iter().map(|row| score(plan, row)).collect::<Vec<_>>())
}

/// Writes the rows of the best points as `best.csv`; nothing where there are no objectives.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_best(plan: &Plan, table: &Table, folder: &Path) -> Result<(), SweepError> {
    if plan.file.objective.is_empty() {
        return Ok(());
    }
    let rows = best(plan, table).into_iter().map(|i| table.rows[i].clone()).collect();
    let file = folder.join("best.csv");
    let csv = Table { rows, ..table.clone() }.csv();
    write_whole(&file, &csv).map_err(|source| SweepError::Write { file, source })
}

/// What a row is worth to the sweep's objectives.
pub(super) fn score(plan: &Plan, row: &Row) -> Score {
    let cost = |measure: &str, goal: Goal| match goal {
        Goal::Maximise => -plan.measured(row, measure),
        Goal::Minimise => plan.measured(row, measure),
    };
    let costs: Vec<f64> = plan.file.objective.iter().map(|o| cost(&o.measure, o.goal)).collect();
    let excess: f64 = plan.file.limit.iter().map(|l| excess(l, plan.measured(row, &l.measure))).sum();
    let excess = excess + trouble(plan, row).map(|(_, share)| share).sum::<f64>();
    let known = costs.iter().all(|c| c.is_finite()) && excess.is_finite();
    Score { costs, excess: if known { excess } else { f64::INFINITY } }
}

/// Kinds of trouble that a point is in and the sweep does not allow, with the share of the run.
pub fn trouble(plan: &Plan, row: &Row) -> impl Iterator<Item = (Concern, f64)> {
    let duration_s = plan.schedule.last_s().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    let all = Concern::ALL.into_iter().zip(row.concerns_s);
    let not_allowed = all.filter(|(concern, s)| *s > 0.0 && !plan.file.allow.contains(concern));
    not_allowed.map(move |(concern, s)| (concern, s / duration_s))
}

/// By how much a value breaks a limit, as a share of the bound; infinite where there is no value.
pub fn excess(limit: &LimitSpec, value: f64) -> f64 {
    if value.is_nan() {
        return f64::INFINITY;
    }
    let share = |over: f64, bound: f64| over.max(0.0) / if bound == 0.0 { 1.0 } else { bound.abs() };
    let below = limit.min.map_or(0.0, |min| share(min - value, min));
    let above = limit.max.map_or(0.0, |max| share(value - max, max));
    below + above
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_broken_by_its_share() {
        let limit = |min, max| LimitSpec { measure: "m".to_owned(), min, max, label: String::new() };
        assert_eq!(excess(&limit(None, Some(2.0)), 3.0), 0.5);
        assert_eq!(excess(&limit(Some(-4.0), None), -5.0), 0.25);
        assert_eq!(excess(&limit(Some(0.0), Some(1.0)), 0.5), 0.0);
        assert_eq!(excess(&limit(None, Some(0.0)), 0.1), 0.1);
        assert!(excess(&limit(None, Some(1.0)), f64::NAN).is_infinite());
    }
}
