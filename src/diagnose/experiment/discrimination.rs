//! Model discrimination: how far a run would separate models, in standard errors, and what one more sensor would add.

use nalgebra::{DMatrix, DVector, DVectorView};

use crate::diagnose::case::{Case, CaseChannel, CaseRun, Noise};
use crate::diagnose::fit::{Fit, Problem, Sides, probes, respond, simulate};
use crate::diagnose::verdict::Open;

/// Default noise of sensors, by unit of their column.
const TYPICAL_NOISE: [(&str, f64); 4] = [("_mm", 0.02), ("_kpa", 5.0), ("_deg", 0.15), ("_n", 0.02)];

/// The question to a future run: how far would it separate the best model from its alternatives?
pub(super) struct Question<'a> {
    best: &'a Fit,
    rivals: Vec<&'a Fit>,
    /// The alternatives that count.
    counted: Vec<usize>,
    /// Difference in chi² that counts as one.
    unit: f64,
    /// Information in the existing recordings; `None` if the run alone shall count.
    known: Option<Digest>,
    /// The case with every output of the scene recorded, those first that are.
    case: Case,
    noise: Vec<Noise>,
    recorded: usize,
}

/// Predicted measurements of a run for each alternative.
pub(super) struct Foreseen {
    /// Of the channels that are recorded.
    recorded: Digest,
    /// Of each output that could be.
    sensors: Vec<Digest>,
}

/// Which sensors a run is recorded with, besides those that the recordings have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum More {
    Nothing,
    /// By its place in [`Question::sensors`].
    Sensor(usize),
    Everything,
}

impl<'a> Question<'a> {
    /// The question about one alternative, existing recordings ignored.
    pub fn of_nearest(whole: &Problem, best: &'a Fit, rival: &'a Fit) -> Self {
        let (case, noise) = with_every_sensor(whole);
        let recorded = whole.case.channels.len();
        Self { best, rivals: vec![rival], counted: vec![0], unit: 1.0, known: None, case, noise, recorded }
    }

    /// The question about all open alternatives, existing recordings included. `None` if one cannot be simulated.
    pub fn of_open(whole: &Problem, best: &'a Fit, open: &Open<'a>) -> Option<Self> {
        let rows = whole.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)?;
        let of = |rival: &&Fit| Some(&rows.residual - whole.weighted_residual(&rival.model, &rival.x)?);
        let apart = open.rivals.iter().map(of).collect::<Option<Vec<_>>>()?;
        let (case, noise) = with_every_sensor(whole);
        Some(Self {
            best,
            rivals: open.rivals.clone(),
            counted: (0..open.rivals.len()).collect(),
            unit: open.unit,
            known: Some(Digest::of(&rows.jacobian, &apart)),
            case,
            noise,
            recorded: whole.case.channels.len(),
        })
    }

    /// Drops the alternatives that do not satisfy `counts`; returns them.
    pub fn count_only(&mut self, counts: impl Fn(usize) -> bool) -> Vec<&'a Fit> {
        let (counted, others): (Vec<usize>, Vec<usize>) = self.counted.iter().partition(|r| counts(**r));
        self.counted = counted;
        others.into_iter().map(|r| self.rivals[r]).collect()
    }

    /// Whether no alternative counts.
    pub fn is_empty(&self) -> bool {
        self.counted.is_empty()
    }

    /// Columns that could be recorded and are not.
    pub fn sensors(&self) -> impl Iterator<Item = &str> {
        self.case.channels[self.recorded..].iter().map(|c| c.column.as_str())
    }

    /// Predicted measurements of a run; `None` if a model diverges on it.
    pub fn foresee(&self, run: &CaseRun) -> Option<Foreseen> {
        let problem = Problem { case: &self.case, runs: Vec::new(), noise: &self.noise };
        let (model, x) = (&self.best.model, &self.best.x);
        let parameters = problem.parameters(model);
        let response = respond(&self.case, run, model, x, &probes(&parameters, x, 0..x.len(), Sides::One))?;
        let measuring = |values: Vec<Vec<f64>>| CaseRun { measured: values, ..run.clone() };
        let apart = |rival: &&Fit| -> Option<Vec<Vec<f64>>> {
            let there = measuring(simulate(&self.case, run, &rival.model, &rival.x)?);
            Some(problem.subtract(&there, &response.values))
        };
        let apart = self.rivals.iter().map(apart).collect::<Option<Vec<_>>>()?;
        let shown = measuring(response.values.clone());
        let channel = |c: usize| {
            let sensitivities: Vec<DVector<f64>> = parameters
                .iter()
                .zip(&response.sensitivities)
                .map(|(n, slope)| {
                    DVector::from_iterator(slope[c].len(), problem.weighted_sensitivity(&shown, c, &slope[c], n))
                })
                .collect();
            let weighted = |rival: &Vec<Vec<f64>>| DVector::from_column_slice(&rival[c]) / self.noise[c].scale();
            Digest::of(&DMatrix::from_columns(&sensitivities), &apart.iter().map(weighted).collect::<Vec<_>>())
        };
        let recorded: Vec<Digest> = (0..self.recorded).map(channel).collect();
        let sensors = (self.recorded..self.case.channels.len()).map(channel).collect();
        Some(Foreseen { recorded: Digest::stack(&recorded.iter().collect::<Vec<_>>()), sensors })
    }

    /// Distance in standard errors to each alternative, after fitting the best model's parameters to it on all data
    /// there would then be. The best model's discrepancy grows with the run, and the dispersion with it: more of the
    /// same decides nothing.
    pub fn separations(&self, foreseen: &Foreseen, more: More) -> Vec<f64> {
        let sensors = match more {
            More::Nothing => &[],
            More::Sensor(at) => &foreseen.sensors[at..=at],
            More::Everything => &foreseen.sensors[..],
        };
        let played: Vec<&Digest> = std::iter::once(&foreseen.recorded).chain(sensors).collect();
        let all = Digest::stack(&self.known.iter().chain(played.iter().copied()).collect::<Vec<_>>());
        let grown = self.known.as_ref().map_or(1.0, |known| all.samples as f64 / known.samples as f64);
        let unit = if self.unit > 1.0 { self.unit * grown } else { 1.0 };
        all.beyond().into_iter().map(|beyond| beyond / unit.sqrt()).collect()
    }

    /// The least of those that count, and its rival.
    pub fn least(&self, foreseen: &Foreseen, more: More) -> Option<(f64, &'a Fit)> {
        let separations = self.separations(foreseen, more);
        let of = self.counted.iter().map(|&r| (separations[r], self.rivals[r]));
        of.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The case with all outputs of its scene recorded, and their noise.
fn with_every_sensor(problem: &Problem) -> (Case, Vec<Noise>) {
    let (mut case, mut noise) = (problem.case.clone(), problem.noise.to_vec());
    let sd = |column: &str| TYPICAL_NOISE.iter().find(|(unit, _)| column.ends_with(unit)).map(|(_, sd)| *sd);
    for (output, spec) in problem.case.scene.file.output.iter().enumerate() {
        let Some(sd) = sd(&spec.channel).filter(|_| problem.case.channels.iter().all(|c| c.output != output)) else {
            continue;
        };
        let (column, has_free_zero) = (spec.channel.clone(), spec.counts_from_start);
        case.channels.push(CaseChannel { column, output, stated_sd: Some(sd), has_free_zero });
        noise.push(Noise::white(sd));
    }
    (case, noise)
}

/// Compresses many rows: sensitivities of the best's parameters, then the difference to each alternative. A rotation
/// keeps all lengths and angles; this one leaves no more rows than columns.
#[derive(Clone)]
struct Digest {
    rows: DMatrix<f64>,
    parameters: usize,
    /// Rows that there were.
    samples: usize,
}

impl Digest {
    fn of(sensitivities: &DMatrix<f64>, apart: &[DVector<f64>]) -> Self {
        let mut rows = DMatrix::zeros(sensitivities.nrows(), sensitivities.ncols() + apart.len());
        rows.columns_mut(0, sensitivities.ncols()).copy_from(sensitivities);
        apart.iter().enumerate().for_each(|(i, apart)| rows.set_column(sensitivities.ncols() + i, apart));
        Self { rows: rows.qr().unpack_r(), parameters: sensitivities.ncols(), samples: sensitivities.nrows() }
    }

    fn stack(parts: &[&Self]) -> Self {
        let count = parts.iter().map(|p| p.rows.nrows()).sum();
        let columns = parts.first().map_or(0, |p| p.rows.ncols());
        let mut rows = DMatrix::zeros(count, columns);
        let mut at = 0;
        for part in parts {
            rows.rows_mut(at, part.rows.nrows()).copy_from(&part.rows);
            at += part.rows.nrows();
        }
        let parameters = parts.first().map_or(0, |p| p.parameters);
        Self { rows, parameters, samples: parts.iter().map(|p| p.samples).sum() }
    }

    /// Length of each difference orthogonal to the sensitivities.
    fn beyond(&self) -> Vec<f64> {
        let basis = directions(&self.rows.columns(0, self.parameters).into_owned());
        let left = |r: DVectorView<f64>| (r - &basis * basis.tr_mul(&r)).norm();
        (self.parameters..self.rows.ncols()).map(|i| left(self.rows.column(i))).collect()
    }
}

/// Directions below this share of the greatest are rounding.
const ROUNDING: f64 = 1e-9;

/// Orthonormal columns that span those of a matrix, whatever their sizes; some may be zero, or the same.
fn directions(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut even = columns.clone();
    for mut column in even.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let svd = even.svd(true, false);
    let greatest = svd.singular_values.iter().copied().fold(0.0, f64::max);
    let Some(u) = svd.u else { return DMatrix::zeros(columns.nrows(), 0) };
    let there = svd.singular_values.iter().map(|s| *s > ROUNDING * greatest);
    let kept: Vec<DVectorView<f64>> = u.column_iter().zip(there).filter_map(|(c, there)| there.then_some(c)).collect();
    if kept.is_empty() { DMatrix::zeros(columns.nrows(), 0) } else { DMatrix::from_columns(&kept) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(sensitivities: &[[f64; 2]], apart: &[f64]) -> Digest {
        let sensitivities = DMatrix::from_fn(sensitivities.len(), 2, |i, j| sensitivities[i][j]);
        Digest::of(&sensitivities, &[DVector::from_row_slice(apart), DVector::from_row_slice(apart) * 2.0])
    }

    #[test]
    fn what_the_best_can_imitate_separates_nothing() {
        let first = [[1.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]];
        assert!(digest(&first, &[2.0, 2.0, 0.0, 0.0, 0.0]).beyond().iter().all(|b| *b < 1e-12));
        let beyond = digest(&first, &[2.0, 2.0, 3.0, 4.0, 0.0]).beyond();
        assert!((beyond[0] - 5.0).abs() < 1e-12 && (beyond[1] - 10.0).abs() < 1e-12, "{beyond:?}");
    }

    /// Parameters are fitted to all parts together: what one part alone could imitate, two cannot.
    #[test]
    fn parts_below_each_other_are_what_the_whole_is() {
        let sensitivities = [[1.0, 0.3], [0.5, -2.0], [0.1, 1e-4], [2.0, 0.0], [-1.0, 3.0], [0.2, 0.7]];
        let apart = [1.0, -0.4, 2.0, 0.3, 0.1, -1.5];
        let whole = digest(&sensitivities, &apart).beyond();
        let [a, b] = [digest(&sensitivities[..2], &apart[..2]), digest(&sensitivities[2..], &apart[2..])];
        let parts = Digest::stack(&[&a, &b]);
        assert_eq!(parts.samples, 6);
        for (whole, parts) in whole.iter().zip(parts.beyond()) {
            assert!((whole - parts).abs() < 1e-12, "{whole} {parts}");
        }
        assert!(a.beyond()[0] < 1e-12);
    }
}
