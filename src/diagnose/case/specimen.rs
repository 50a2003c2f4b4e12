//! Specimens: runs of several samples, or of set-ups of several days, in one diagnosis. The calibrated parameters are each specimen's
//! own; what is missing from the scene is one law for all.

use crate::diagnose::error::DiagnoseError;
use crate::system::RomParameter;

use super::{Case, CaseParameter, CaseRun};

impl CaseParameter {
    /// What a reader is told: its key, with the specimen that it belongs to.
    pub fn title(&self) -> String {
        match &self.specimen {
            Some(specimen) => format!("{} ({specimen})", self.key),
            None => self.key.clone(),
        }
    }
}

impl Case {
    /// Names of the specimens, in the order of the runs; none where all runs are of one.
    pub fn specimens(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for name in self.runs.iter().filter_map(|run| run.specimen.as_deref()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        if names.len() > 1 { names } else { Vec::new() }
    }

    /// Gives every specimen that an open run shows calibrated parameters of its own. The others have the mean of those.
    pub(super) fn untie(&mut self) {
        let is_open =
            |name: &&str| self.runs.iter().any(|run| !run.is_held_out && run.specimen.as_deref() == Some(*name));
        let names: Vec<String> = self.specimens().into_iter().filter(is_open).map(str::to_owned).collect();
        if names.is_empty() {
            return;
        }
        let own = |p: &CaseParameter| -> Vec<CaseParameter> {
            names.iter().map(|name| CaseParameter { specimen: Some(name.clone()), ..p.clone() }).collect()
        };
        self.parameters = self.parameters.iter().flat_map(own).collect();
    }

    /// Holds back all runs of a specimen and no others: it is predicted from the rest.
    ///
    /// # Errors
    /// A name that no run has, or that all have.
    pub fn transfer(&mut self, specimen: &str) -> Result<(), DiagnoseError> {
        let names = self.specimens();
        if !names.contains(&specimen) {
            return Err(DiagnoseError::Specimen {
                name: specimen.to_owned(),
                known: names.into_iter().map(str::to_owned).collect(),
            });
        }
        self.runs.iter_mut().for_each(|run| run.is_held_out = run.specimen.as_deref() == Some(specimen));
        // Tied again, one of each key, and untied over those that are open now.
        let mut tied: Vec<CaseParameter> = Vec::new();
        for p in std::mem::take(&mut self.parameters) {
            if tied.iter().all(|known| known.key != p.key) {
                tied.push(CaseParameter { specimen: None, ..p });
            }
        }
        self.parameters = tied;
        self.untie();
        Ok(())
    }

    /// Whether a specimen is predicted from others alone.
    pub(in crate::diagnose) fn is_transfer(&self) -> bool {
        let has_open = |name: &str| self.runs.iter().any(|r| !r.is_held_out && r.specimen.as_deref() == Some(name));
        self.specimens().into_iter().any(|name| !has_open(name))
    }

    /// The calibrated parameters of a run's specimen out of those of all: each by its place in `x`, or the mean of several.
    pub(in crate::diagnose) fn parameters_of(&self, specimen: Option<&str>, x: &[f64]) -> Vec<(&CaseParameter, f64)> {
        let is_own = |p: &CaseParameter| p.specimen.is_none() || p.specimen.as_deref() == specimen;
        let own: Vec<(&CaseParameter, f64)> =
            self.parameters.iter().zip(x).filter(|(p, _)| is_own(p)).map(|(p, v)| (p, *v)).collect();
        if !own.is_empty() || self.parameters.is_empty() {
            return own;
        }
        let mut means: Vec<(&CaseParameter, f64)> = Vec::new();
        for p in &self.parameters {
            if means.iter().any(|(known, _)| known.key == p.key) {
                continue;
            }
            let all: Vec<f64> =
                self.parameters.iter().zip(x).filter(|(o, _)| o.key == p.key).map(|(_, v)| *v).collect();
            means.push((p, all.iter().sum::<f64>() / all.len() as f64));
        }
        means
    }

    /// The same as the reduced-order model takes it.
    pub(in crate::diagnose) fn rom_parameters(&self, run: &CaseRun, x: &[f64]) -> Vec<(RomParameter, f64)> {
        let parameters = self.parameters_of(run.specimen.as_deref(), x);
        parameters.into_iter().map(|(p, value)| (p.parameter.clone(), value)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;
    use crate::scene::Override;

    fn two() -> Case {
        let set = [Override::number("friction_m0_n", 0.11)];
        let mut case = made::recorded("muscle_bench", &set, &["plunger_mm"], &["elongation_mm"]);
        let run = case.runs[0].clone();
        case.runs = ["a", "b", "c"].map(|name| CaseRun { specimen: Some(name.to_owned()), ..run.clone() }).to_vec();
        case.runs[2].is_held_out = true;
        case
    }

    #[test]
    fn each_specimen_has_its_own_numbers_and_one_that_is_held_back_the_mean() {
        let mut case = two();
        let tied = case.parameters.len();
        case.untie();
        assert_eq!(case.parameters.len(), 2 * tied);
        assert_eq!(case.parameters[1].title(), format!("{} (b)", case.parameters[0].key));
        let x: Vec<f64> = (0..2 * tied).map(|i| i as f64).collect();
        let of = |name: &str| case.parameters_of(Some(name), &x).into_iter().map(|(_, v)| v).collect::<Vec<_>>();
        let even: Vec<f64> = (0..tied).map(|i| 2.0 * i as f64).collect();
        assert_eq!(of("a"), even);
        assert_eq!(of("b"), even.iter().map(|x| x + 1.0).collect::<Vec<_>>());
        assert_eq!(of("c"), even.iter().map(|x| x + 0.5).collect::<Vec<_>>());
    }

    #[test]
    fn runs_of_one_specimen_share_their_numbers() {
        let mut case = two();
        case.runs.iter_mut().for_each(|run| run.specimen = Some("a".to_owned()));
        let before = case.parameters.clone();
        case.untie();
        assert_eq!(case.parameters, before);
        assert!(case.specimens().is_empty());
    }
}
