//! Folds of the recordings for cross-validation.

use std::borrow::Cow;
use std::ops::Range;

use super::problem::Problem;
use crate::diagnose::case::CaseRun;

impl Problem<'_> {
    /// Leaves out every run once: returns the others, and it. A single run is cut into halves.
    pub fn runs_left_out(&self) -> Vec<(Problem<'_>, Problem<'_>)> {
        if self.runs.len() < 2 {
            return self.halves_left_out();
        }
        let without = |i: usize| {
            let mut rest = self.borrowed();
            let left_out = rest.remove(i);
            (self.part(rest), self.part(vec![left_out]))
        };
        (0..self.runs.len()).map(without).collect()
    }

    /// Leaves out every half of every run once: returns the rest, and it.
    pub fn halves_left_out(&self) -> Vec<(Problem<'_>, Problem<'_>)> {
        let one = |i: usize| {
            let run = &self.runs[i];
            let (half, end) = (run.times_s().len() / 2, run.times_s().len());
            [(0..half, half..end), (half..end, 0..half)].map(|(kept, left_out)| {
                let mut rest = self.borrowed();
                rest[i] = Cow::Owned(without_samples(run, left_out));
                // What is left out is predicted with the zero that the rest decides.
                let mut predicted = without_samples(run, kept);
                predicted.open_part = Some(rest[i].measured.clone());
                (self.part(rest), self.part(vec![Cow::Owned(predicted)]))
            })
        };
        (0..self.runs.len()).flat_map(one).collect()
    }

    fn borrowed(&self) -> Vec<Cow<'_, CaseRun>> {
        self.runs.iter().map(|r| Cow::Borrowed(r.as_ref())).collect()
    }

    fn part<'s>(&'s self, runs: Vec<Cow<'s, CaseRun>>) -> Problem<'s> {
        Problem { case: self.case, runs, noise: self.noise }
    }
}

/// A run with the same inputs and no measurements at some times.
fn without_samples(run: &CaseRun, times: Range<usize>) -> CaseRun {
    let mut part = run.clone();
    part.measured.iter_mut().for_each(|m| m[times.clone()].fill(f64::NAN));
    part
}
