//! Running the points of a sweep that are not done yet.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::SweepError;
use super::best::score;
use super::journal::Journal;
use super::nsga2::Evolution;
use super::plan::{Plan, Shard};
use super::point::{Row, evaluate};

/// Who watches a sweep.
pub struct Watch<'a> {
    /// Set from outside: points that run are finished and kept, no other is begun.
    pub stop: &'a AtomicBool,
    /// Called as a point ends.
    pub point_done: &'a (dyn Fn() + Sync),
}

/// Runs what a shard has to do on all threads, into the journal.
///
/// # Errors
/// A journal that cannot be written; a shard of an optimisation.
pub fn run(plan: &Plan, journal: &Journal, shard: Shard, watch: &Watch) -> Result<(), SweepError> {
    check_shard(plan, shard)?;
    match plan.evolution()? {
        None => {
            let pending = shard.points(plan.count()).filter(|i| !journal.done.contains_key(i));
            points(plan, journal, pending.map(|i| (i, plan.point(i))).collect(), watch).map(drop)
        }
        Some(evolution) => generations(plan, journal, evolution, watch),
    }
}

/// Whether a sweep can be split so; to be asked before a journal is begun.
///
/// # Errors
/// A shard of an optimisation.
pub fn check_shard(plan: &Plan, shard: Shard) -> Result<(), SweepError> {
    if shard == Shard::WHOLE || plan.evolution()?.is_none() {
        return Ok(());
    }
    Err(SweepError::Sampling {
        message: "an optimisation has no shards: each generation needs those before it".to_owned(),
        remedy: "run it whole; all threads of a machine work on a generation".to_owned(),
    })
}

fn points(
    plan: &Plan,
    journal: &Journal,
    pending: Vec<(u64, Vec<f64>)>,
    watch: &Watch,
) -> Result<Vec<Row>, SweepError> {
    // Points in their order: with rayon's default halves, a kill would leave the far end of the range undone.
    let rows = pending.into_par_iter().with_max_len(1).map(|(index, values)| {
        if watch.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let row = evaluate(plan, index, values);
        journal.add(&row)?;
        (watch.point_done)();
        Ok(Some(row))
    });
    Ok(rows.collect::<Result<Vec<_>, SweepError>>()?.into_iter().flatten().collect())
}

/// Generation after generation. What the journal holds is not run again, and leads to the same generations.
fn generations(plan: &Plan, journal: &Journal, mut evolution: Evolution, watch: &Watch) -> Result<(), SweepError> {
    let mut first = 0;
    while let Some(asked) = evolution.ask() {
        let indices = first..first + asked.len() as u64;
        let mut rows: BTreeMap<u64, Row> = journal.done.range(indices.clone()).map(|(i, r)| (*i, r.clone())).collect();
        let pending = indices.clone().zip(asked).filter(|(i, _)| !rows.contains_key(i)).collect();
        rows.extend(points(plan, journal, pending, watch)?.into_iter().map(|r| (r.index, r)));
        if rows.len() < indices.clone().count() {
            return Ok(());
        }
        evolution.tell(rows.values().map(|r| score(plan, r)).collect());
        first = indices.end;
    }
    Ok(())
}
