//! Condenses recordings and the linear model of a run to short stretches of time.
//!
//! A signal is constant over a stretch, and each channel is averaged and multiplied by the root of its sample count, so
//! its noise has variance one. Only what the signal does within a stretch is lost.

use std::borrow::Cow;

use nalgebra::DMatrix;

use super::Place;
use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Problem, Rows};
use crate::effects::Effect;
use crate::parallel;
use crate::system::{Linear, RomSetting};

/// One run: measurements by stretch, and the response to states and signals there.
pub struct Condensed {
    pub measured: Vec<Measured>,
    /// Columns before the run's own parameters: the residual, then the parameters of the fit.
    pub shared: usize,
    /// Initial response of the states to a signal at each port. Behind the ports follow the channels, one signal each.
    pub start: DMatrix<f64>,
    pub maps: Vec<Map>,
}

/// Of one stretch: a row for each channel, of residual, Jacobian, and derivatives to the free zeros of the run.
pub struct Measured {
    pub rows: DMatrix<f64>,
    /// Number of samples by channel.
    pub counts: Vec<f64>,
    pub lasts_s: f64,
}

/// Response to the state at the beginning of a stretch, then to each port's signal.
pub struct Map {
    /// At its end: the state.
    pub end: DMatrix<f64>,
    /// Of the channels, in the units of [`Measured`].
    pub seen: DMatrix<f64>,
}

/// All runs in stretches of this many seconds; `None` if the model diverges or is not integrated.
pub fn condensed(
    problem: &Problem,
    settings: &[RomSetting<f64>],
    known: &Rows,
    places: &[&Place],
    stretch_s: f64,
) -> Option<Vec<Condensed>> {
    let at: Vec<Effect<f64>> = places.iter().map(|place| place.injected.with(&[0.0])).collect();
    let at: Vec<&Effect<f64>> = at.iter().collect();
    let typical: Vec<f64> = places.iter().map(|place| place.typical).collect();
    let samples = |run: &Cow<CaseRun>| run.measured.iter().flatten().filter(|m| m.is_finite()).count();
    let ends_of_rows = problem.runs.iter().scan(0, |row, run| {
        *row += samples(run);
        Some(*row)
    });
    let first_rows: Vec<usize> = std::iter::once(0).chain(ends_of_rows).collect();
    let one = |r: usize| {
        let run = &problem.runs[r];
        let ends = ends(&run.drive.times_s, stretch_s);
        let measured = measured(problem, run, (known, first_rows[r]), &ends);
        let linear = run.rom.linear(&run.drive, &settings[r], &at)?;
        let start = DMatrix::from_fn(linear.states.len(), at.len(), |i, p| linear.start(p)[i] * typical[p]);
        let start = start.resize_horizontally(at.len() + problem.case.channels.len(), 0.0);
        let maps = maps(problem, run, linear, &typical, &ends, &measured)?;
        Some(Condensed { measured, shared: 1 + known.jacobian.ncols(), start, maps })
    };
    parallel::map_indices(problem.runs.len(), one).into_iter().collect()
}

/// Index after the last sample of each stretch. The first sample belongs to none.
fn ends(times_s: &[f64], stretch_s: f64) -> Vec<usize> {
    let mut ends = Vec::new();
    let mut from = 0;
    for k in 1..times_s.len() {
        if times_s[k] - times_s[from] >= stretch_s * (1.0 - 1e-9) {
            ends.push(k + 1);
            from = k;
        }
    }
    if ends.last().is_none_or(|&end| end < times_s.len()) {
        ends.push(times_s.len());
    }
    ends
}

/// Measurements by stretch; the run's rows begin at `row`.
fn measured(problem: &Problem, run: &CaseRun, (known, mut row): (&Rows, usize), ends: &[usize]) -> Vec<Measured> {
    let channels = &problem.case.channels;
    let zeros: Vec<usize> = (0..channels.len()).filter(|&c| channels[c].has_free_zero).collect();
    let shared = 1 + known.jacobian.ncols();
    let times_s = &run.drive.times_s;
    let starts = std::iter::once(0).chain(ends.iter().map(|end| end - 1));
    let none = |(start, end): (usize, &usize)| Measured {
        rows: DMatrix::zeros(channels.len(), shared + zeros.len()),
        counts: vec![0.0; channels.len()],
        lasts_s: times_s[end - 1] - times_s[start],
    };
    let mut all: Vec<Measured> = starts.zip(ends).map(none).collect();
    for c in 0..channels.len() {
        for (i, _) in run.measured[c].iter().enumerate().filter(|(_, m)| m.is_finite()) {
            let sample = run.lead_in + i;
            if sample > 0 {
                let stretch = &mut all[ends.partition_point(|&end| end <= sample)];
                stretch.counts[c] += 1.0;
                stretch.rows[(c, 0)] += known.residual[row];
                (1..shared).for_each(|j| stretch.rows[(c, j)] += known.jacobian[(row, j - 1)]);
                if let Some(zero) = zeros.iter().position(|&zero| zero == c) {
                    stretch.rows[(c, shared + zero)] += 1.0;
                }
            }
            row += 1;
        }
    }
    for stretch in &mut all {
        for (c, count) in stretch.counts.iter().enumerate().filter(|(_, count)| **count > 0.0) {
            stretch.rows.row_mut(c).scale_mut(1.0 / count.sqrt());
        }
    }
    all
}

/// The model's maps over the stretches of a run; none where it diverges.
fn maps(
    problem: &Problem,
    run: &CaseRun,
    mut linear: Linear,
    typical: &[f64],
    ends: &[usize],
    measured: &[Measured],
) -> Option<Vec<Map>> {
    let (n, ports) = (linear.states.len(), typical.len());
    let channels = &problem.case.channels;
    let fresh = || DMatrix::identity(n, n + ports + channels.len());
    let nothing = || DMatrix::zeros(channels.len(), n + ports + channels.len());
    let (mut end, mut seen) = (fresh(), nothing());
    let mut maps: Vec<Map> = Vec::with_capacity(ends.len());
    while let Some(block) = linear.next_block() {
        for (i, matrix) in block.matrices.iter().enumerate() {
            let sample = block.first + i;
            let mut next = matrix * &end;
            for (p, typical) in typical.iter().enumerate() {
                let acts = block.column(i, p);
                next.column_mut(n + p).iter_mut().zip(acts).for_each(|(next, slope)| *next += typical * slope);
            }
            for (c, channel) in channels.iter().enumerate() {
                let is_there = sample >= run.lead_in && run.measured[c][sample - run.lead_in].is_finite();
                if is_there {
                    let weight = 1.0 / (problem.noise[c].scale() * measured[maps.len()].counts[c].sqrt());
                    seen.row_mut(c).zip_apply(&next.row(n + channel.output), |seen, shown| *seen += weight * shown);
                    seen[(c, n + ports + c)] += weight * problem.noise[c].scale();
                }
            }
            end = next.rows(0, n).into_owned();
            if sample + 1 == ends[maps.len()] {
                let [end, seen] =
                    [(&mut end, fresh()), (&mut seen, nothing())].map(|(of, new)| std::mem::replace(of, new));
                maps.push(Map { end, seen });
            }
        }
    }
    let is_finite = maps.iter().all(|map| map.end.iter().chain(&map.seen).all(|x| x.is_finite()));
    (linear.is_sound() && is_finite).then_some(maps)
}
