//! Finds the samples of a fitted model's runs at which small signals stay small.
//!
//! Responses to signals are derivatives along the runs. Where a cable goes slack, a rod meets a stop or a joint rests
//! in a dead zone, derivatives describe that very trajectory; a slightly different one would end elsewhere, and they
//! say nothing of a law of finite size. The response to a constant signal at a few ports is therefore computed twice,
//! by derivatives and by finite differences. Samples at which they disagree are excluded.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Place, places};
use crate::effects::Effect;
use crate::laws::Port;
use crate::parallel;
use crate::system::{Change, RomSetting};

/// Ports of the constant signals.
const ASKED: [Port; 3] = [Port::Pull, Port::Outflow, Port::Torque];
/// Step of the differences, relative to a clearly visible signal.
const STEP: f64 = 0.1;
/// Derivatives and differences disagree if they differ by more than this share of their size, at the sample or overall.
const NOTHING_IN_COMMON: f64 = 1.0;

/// Whether derivatives are valid at each row of a problem, in the order of [`Problem::rows`]. Ports are applied in
/// order of agreement while half of the rows remain: disagreement everywhere at one port, on a free joint, says little
/// of the others.
pub(super) fn linear_rows(problem: &Problem, fit: &Fit) -> Vec<bool> {
    let all = places(problem.case);
    let asked: Vec<&Place> =
        all.iter().filter(|place| ASKED.contains(&place.port) && !place.is_of_several(&all)).collect();
    let one = |run: &Cow<CaseRun>| in_run(problem, fit, run, &asked);
    let of_runs: Vec<Vec<Vec<bool>>> = parallel::map(&problem.runs, one);
    let of_port = |p: usize| -> Vec<bool> { of_runs.iter().flat_map(|ports| ports[p].iter().copied()).collect() };
    let mut of_ports: Vec<Vec<bool>> = (0..asked.len()).map(of_port).collect();
    of_ports.sort_by_key(|linear| std::cmp::Reverse(count(linear)));
    let mut linear = vec![true; problem.samples()];
    for port in of_ports {
        let both: Vec<bool> = linear.iter().zip(&port).map(|(a, b)| *a && *b).collect();
        if 2 * count(&both) >= both.len() {
            linear = both;
        }
    }
    linear
}

fn count(linear: &[bool]) -> usize {
    linear.iter().filter(|linear| **linear).count()
}

/// Valid rows of one run, by port. All rows if a response cannot be computed.
fn in_run(problem: &Problem, fit: &Fit, run: &CaseRun, asked: &[&Place]) -> Vec<Vec<bool>> {
    let setting = fit.model.setting(problem.case, run, &fit.x);
    let at: Vec<Effect<f64>> = asked.iter().map(|place| place.injected.with(&[0.0])).collect();
    let small = run.rom.steadily(&run.drive, &setting, &at.iter().collect::<Vec<_>>()).unwrap_or_default();
    let with = |place: &&Place, sign: f64| {
        let acting = place.injected.with(&[sign * STEP * place.typical]);
        RomSetting { effects: setting.effects.iter().cloned().chain([acting]).collect(), ..setting.clone() }
    };
    let settings: Vec<_> = asked.iter().flat_map(|place| [with(place, -1.0), with(place, 1.0)]).collect();
    let played = run.rom.simulate_many(&run.drive, &settings);
    let rows: usize = run.measured.iter().flatten().filter(|m| m.is_finite()).count();
    let of_port = |(p, place): (usize, &&Place)| -> Vec<bool> {
        let (Some(small), Some(large)) = (small.get(p), difference(&played[2 * p..][..2])) else {
            return vec![true; rows];
        };
        let small = in_noise(problem, run, small, place.typical);
        let large = in_noise(problem, run, &large, 0.5 / STEP);
        let typical = (large.iter().map(|x| x * x).sum::<f64>() / rows.max(1) as f64).sqrt();
        let is_linear = |(s, l): (&f64, &f64)| (s - l).abs() <= NOTHING_IN_COMMON * (l.abs() + typical);
        small.iter().zip(&large).map(is_linear).collect()
    };
    asked.iter().enumerate().map(of_port).collect()
}

/// Difference of two simulations; `None` if one diverges.
fn difference(two: &[Option<Change>]) -> Option<Change> {
    let [Some(first), Some(second)] = two else { return None };
    let of_channel = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| b - a).collect();
    Some(first.iter().zip(second).map(of_channel).collect())
}

/// A column with the excluded rows set to zero.
pub(super) fn where_linear(mut column: DVector<f64>, linear: &[bool]) -> DVector<f64> {
    column.iter_mut().zip(linear).filter(|(_, linear)| !**linear).for_each(|(x, _)| *x = 0.0);
    column
}

/// Orthonormal basis of columns in the linear range.
pub(super) fn basis(free: impl Iterator<Item = DVector<f64>>, linear: &[bool], rows: usize) -> DMatrix<f64> {
    let there = free.map(|column| where_linear(column, linear));
    let free: Vec<DVector<f64>> = there.filter(|column| column.norm_squared() > 0.0).collect();
    if free.is_empty() { DMatrix::zeros(rows, 0) } else { DMatrix::from_columns(&free).qr().q() }
}

/// Change of all measured samples of a run, in units of the noise, free zeros ignored.
pub(super) fn in_noise(problem: &Problem, run: &CaseRun, change: &Change, size: f64) -> Vec<f64> {
    let channels = problem.case.channels.iter().enumerate();
    let each = channels.flat_map(|(c, channel)| {
        problem.seen(run, c, &change[channel.output][run.lead_in..], size).collect::<Vec<f64>>()
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::Model;
    use crate::scene::Override;

    /// Number of valid rows, and of all rows, for a scene with changed parameters.
    fn of(scene: &str, set: &[&str], inputs: &[&str], outputs: &[&str]) -> (usize, usize) {
        let set: Vec<Override> = set.iter().map(|text| Override::parse(text).expect("one")).collect();
        let case = made::recorded_for(scene, [&set, &set], inputs, outputs);
        let noise: Vec<Noise> = outputs.iter().map(|_| Noise::white(0.05)).collect();
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let (model, x) = (Model::baseline(), problem.start(&Model::baseline(), None));
        let covariance = nalgebra::DMatrix::zeros(x.len(), x.len());
        let linear = linear_rows(&problem, &Fit { model, x, cost: 0.0, covariance, on_bound: Vec::new() });
        (count(&linear), linear.len())
    }

    /// A bench is linear everywhere. A pulley with both cables slack is not: where it comes to rest belongs to that
    /// run.
    #[test]
    fn what_is_free_is_not_looked_at() {
        let (linear, all) = of("muscle_bench", &[], &["plunger_mm"], &["elongation_mm", "pressure_kpa"]);
        assert!(linear == all && all > 1000, "{linear} of {all}");
        let inputs = ["plunger_1_mm", "plunger_2_mm"];
        let pushed = |first: &str, second: &str| {
            let set = [("1", first), ("2", second)].map(|(i, v)| format!("input.plunger_{i}_mm.program.value_m={v}"));
            of("antagonistic_pulley", &set.each_ref().map(String::as_str), &inputs, &["angle_deg"])
        };
        let (taut, all) = pushed("[0.0, -4e-4, -1e-3, -2e-4]", "[0.0, -2e-4, -1e-3, -4e-4]");
        let (slack, _) = pushed("[0.0, -1e-3, 1e-3, 2e-3]", "[0.0, 1e-3, 1e-3, 2e-3]");
        assert!(slack < taut && taut > all * 9 / 10 && 2 * slack >= all, "{slack} and {taut} of {all}");
    }
}
