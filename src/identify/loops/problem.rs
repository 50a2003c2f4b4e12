//! The model's error as a function of its free parameters, with an exact Jacobian.

use nalgebra::{DMatrix, DVector};
use num_dual::{Derivative, DualSVec64};

use crate::hysteresis::{HysteresisModel, mean_squares};

use super::data::{LoopRun, LoopScale};
use super::form::{Form, ParameterSpec};

/// Directions carried at once; the parameters of most forms' states fit.
const CARRIED: usize = 4;
type Carried = DualSVec64<CARRIED>;

/// Data, a form, and which of its parameters are free.
pub struct Problem<'a> {
    pub runs: &'a [LoopRun],
    pub specs: Vec<ParameterSpec>,
    blank: HysteresisModel<f64>,
    /// Places of the free parameters among all.
    free: Vec<usize>,
    counted: usize,
}

impl<'a> Problem<'a> {
    pub fn new(runs: &'a [LoopRun], form: Form, scale: &LoopScale) -> Self {
        let specs = form.parameters(scale);
        let free = (0..specs.len()).filter(|&i| specs[i].fixed.is_none()).collect();
        let counted = counted_samples(runs);
        Self { runs, specs, blank: form.blank(scale), free, counted }
    }

    /// The same form on other runs, its bounds as they are.
    pub fn on<'b>(&self, runs: &'b [LoopRun]) -> Problem<'b> {
        let counted = counted_samples(runs);
        let (specs, blank, free) = (self.specs.clone(), self.blank.clone(), self.free.clone());
        Problem { runs, specs, blank, free, counted }
    }

    /// The free parameters' specifications.
    pub fn free(&self) -> Vec<&ParameterSpec> {
        self.free.iter().map(|&i| &self.specs[i]).collect()
    }

    /// Samples that count.
    pub fn counted(&self) -> usize {
        self.counted
    }

    /// All parameters, fixed ones at their values.
    pub fn all(&self, free: &[f64]) -> Vec<f64> {
        let mut all: Vec<f64> = self.specs.iter().map(|s| s.fixed.map_or(0.0, |(value, _)| value)).collect();
        self.free.iter().zip(free).for_each(|(&i, &value)| all[i] = value);
        all
    }

    /// The model of free parameters, `None` if they are out of its range.
    pub fn model(&self, free: &[f64]) -> Option<HysteresisModel<f64>> {
        self.blank.with_parameters(&self.all(free)).ok().filter(|m: &HysteresisModel<f64>| m.check().is_ok())
    }

    /// F: the mean squared error, mm². Infinite where there is no model.
    pub fn mean_square(&self, free: &[f64]) -> f64 {
        self.residuals(free).map_or(f64::INFINITY, |r| r.norm_squared() / self.counted as f64)
    }

    /// F of many sets; forms of one state go side by side.
    pub fn mean_squares(&self, sets: &[Vec<f64>]) -> Vec<f64> {
        let Some(form) = self.blank.bouc_wen() else {
            return sets.iter().map(|set| self.mean_square(set)).collect();
        };
        let all: Vec<Vec<f64>> = sets.iter().map(|set| self.all(set)).collect();
        let mut pooled = vec![0.0; sets.len()];
        for run in self.runs {
            let share = run.output_mm.iter().filter(|y| y.is_finite()).count() as f64 / self.counted as f64;
            let found = mean_squares(&form, &all, &run.input_mm, &run.output_mm);
            pooled.iter_mut().zip(found).for_each(|(sum, f)| *sum += share * f);
        }
        pooled
    }

    /// Model minus measured at every sample that counts, mm.
    pub fn residuals(&self, free: &[f64]) -> Option<DVector<f64>> {
        let model = self.model(free)?;
        let mut all = Vec::with_capacity(self.counted);
        for run in self.runs {
            let outputs = model.follow(&run.time_s, &run.input_mm);
            all.extend(counted(run, outputs).map(|(y, measured)| y - measured));
        }
        Some(DVector::from_vec(all)).filter(|r| r.iter().all(|x| x.is_finite()))
    }

    /// Jacobian of the residuals, exact, a column for each free parameter.
    ///
    /// Gains: what the output would be of each alone, at the same state. The others: dual numbers, a few at a time.
    pub fn jacobian(&self, free: &[f64]) -> Option<DMatrix<f64>> {
        let mut jacobian = DMatrix::zeros(self.counted, free.len());
        let (gains, others): (Vec<usize>, Vec<usize>) =
            (0..free.len()).partition(|&j| self.specs[self.free[j]].is_gain);
        for (column, of_gain) in gains.iter().zip(self.gain_columns(free, &gains)?) {
            jacobian.column_mut(*column).copy_from_slice(&of_gain);
        }
        for some in others.chunks(CARRIED) {
            self.carry(free, some, &mut jacobian)?;
        }
        Some(jacobian).filter(|s| s.iter().all(|x| x.is_finite()))
    }

    /// Outputs of the model with each gain alone at 1, along the states that `free` gives.
    fn gain_columns(&self, free: &[f64], gains: &[usize]) -> Option<Vec<Vec<f64>>> {
        let model = self.model(free)?;
        let unit = |&j: &usize| {
            let ungained = (0..free.len()).map(|i| if self.specs[self.free[i]].is_gain { 0.0 } else { free[i] });
            let mut only: Vec<f64> = ungained.collect();
            only[j] = 1.0;
            self.blank.with_parameters(&self.all(&only)).ok()
        };
        let units: Vec<HysteresisModel<f64>> = gains.iter().map(unit).collect::<Option<_>>()?;
        let mut columns = vec![Vec::with_capacity(self.counted); gains.len()];
        for run in self.runs {
            let mut state = model.rest(run.input_mm[0]);
            for i in 0..run.time_s.len() {
                let x = run.input_mm[i];
                if i > 0 {
                    model.advance(&mut state, run.input_mm[i - 1], x, run.time_s[i] - run.time_s[i - 1]);
                }
                if run.output_mm[i].is_finite() {
                    columns.iter_mut().zip(&units).for_each(|(c, unit)| c.push(unit.output(x, &state)));
                }
            }
        }
        Some(columns)
    }

    fn carry(&self, free: &[f64], some: &[usize], jacobian: &mut DMatrix<f64>) -> Option<()> {
        let mut dual: Vec<Carried> = self.all(free).into_iter().map(Carried::from).collect();
        for (direction, &j) in some.iter().enumerate() {
            dual[self.free[j]].eps = Derivative::derivative_generic(nalgebra::Const, nalgebra::U1, direction);
        }
        let model = self.blank.with_parameters(&dual).ok()?;
        let mut row = 0;
        for run in self.runs {
            for (y, _) in counted(run, model.follow(&run.time_s, &run.input_mm)) {
                let eps = y.eps.unwrap_generic(nalgebra::Const, nalgebra::U1);
                some.iter().enumerate().for_each(|(direction, &j)| jacobian[(row, j)] = eps[direction]);
                row += 1;
            }
        }
        Some(())
    }

    /// The set with its gains replaced by the best ones for its state (linear least squares), within their bounds.
    pub(crate) fn with_best_gains(&self, free: &[f64]) -> Option<Vec<f64>> {
        let gains: Vec<usize> = (0..free.len()).filter(|&j| self.specs[self.free[j]].is_gain).collect();
        let columns: Vec<DVector<f64>> = self.gain_columns(free, &gains)?.into_iter().map(DVector::from_vec).collect();
        let matrix = DMatrix::from_columns(&columns);
        let measured = self.runs.iter().flat_map(|r| &r.output_mm).copied().filter(|y| y.is_finite());
        let target = DVector::from_vec(measured.collect());
        let mut normal = matrix.tr_mul(&matrix);
        // So little that it only settles gains which the data leave open.
        let ridge = 1e-12 * normal.diagonal().max();
        (0..gains.len()).for_each(|j| normal[(j, j)] += ridge);
        let best = normal.cholesky()?.solve(&matrix.tr_mul(&target));
        let mut set = free.to_vec();
        for (&j, value) in gains.iter().zip(best.iter()) {
            let spec = &self.specs[self.free[j]];
            set[j] = value.clamp(spec.min, spec.max);
        }
        Some(set)
    }
}

/// Samples of the output that count.
pub(super) fn counted_samples(runs: &[LoopRun]) -> usize {
    runs.iter().flat_map(|r| &r.output_mm).filter(|y| y.is_finite()).count()
}

/// Model and measured where measured counts.
fn counted<'a, D: Copy + 'a>(run: &'a LoopRun, outputs: Vec<D>) -> impl Iterator<Item = (D, f64)> + 'a {
    outputs.into_iter().zip(run.output_mm.iter().copied()).filter(|(_, measured)| measured.is_finite())
}
