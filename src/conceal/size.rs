//! How large a secret is made: by the misfit that it leaves after the rig's own numbers were refitted.

use nalgebra::{DMatrix, DVector};

use super::ConcealError;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S};
use super::secrets::{KINDS, Secret};
use super::solve::solve;
use super::stock::{Calibration, Rig};

/// The beginnings of a rig's own runs, on which secrets are weighed.
pub struct Sizing {
    rig: Rig,
    calibration: Calibration,
    /// When each run begins, s after the first one, and what its plungers do.
    runs: Vec<(f64, Vec<Drive>)>,
    /// What one unit of each output is, and whether it is recorded.
    unit: Vec<f64>,
    shown: Vec<bool>,
    /// Outputs with nothing hidden, and a basis of what the rig's own numbers can do to them.
    plain: DVector<f64>,
    basis: DMatrix<f64>,
}

/// So much of each run is weighed, s.
const WEIGHED_S: f64 = 30.0;

/// Share by which each calibrated number is moved for its slope.
const SHARE: f64 = 0.01;
/// Every so many samples are weighed: misfits are slow.
pub const STRIDE: usize = 7;
const ROUNDS: usize = 3;

impl Sizing {
    /// `runs`: what the plungers do, run by run; `unit`: what counts as one of each output, its noise.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn new(
        rig: Rig,
        calibration: Calibration,
        runs: &[Vec<Drive>],
        unit: Vec<f64>,
        shown: Vec<bool>,
    ) -> Result<Self, ConcealError> {
        let mut begun_s = 0.0;
        let beginning = |run: &Vec<Drive>| {
            let at_s = begun_s;
            begun_s += run[0].positions_m.len() as f64 * SAMPLE_S;
            let count = ((WEIGHED_S / SAMPLE_S) as usize).min(run[0].positions_m.len());
            (at_s, run.iter().map(|d| Drive { positions_m: d.positions_m[..count].to_vec() }).collect())
        };
        let runs = runs.iter().map(beginning).collect();
        let (plain, basis) = (DVector::zeros(0), DMatrix::zeros(0, 0));
        let mut sizing = Self { rig, calibration, runs, unit, shown, plain, basis };
        sizing.plain = sizing.weighted(None, calibration)?;
        let decomposed = sizing.slopes()?.svd(true, false);
        sizing.basis = decomposed.u.ok_or_else(|| ConcealError::Solver("slopes without a basis".to_owned()))?;
        Ok(sizing)
    }

    /// Scales a secret so that it leaves `wanted` of misfit per sample, in units of the noise's variance, after a linear
    /// refit; as near as its largest size allows.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn scale(&self, secret: &mut Secret, wanted: f64) -> Result<(), ConcealError> {
        let largest = KINDS.iter().find(|k| k.name == secret.name).map_or(f64::INFINITY, |k| k.largest);
        for _ in 0..ROUNDS {
            let left = self.left(secret)?;
            let excess = left.norm_squared() / left.len() as f64;
            let factor = (wanted / excess.max(1e-12)).sqrt().clamp(0.02, 30.0);
            secret.size = (secret.size * factor).clamp(-largest, largest);
            if (0.8..1.25).contains(&factor) {
                break;
            }
        }
        Ok(())
    }

    /// What a secret changes beyond what the rig's own numbers could, in units of the outputs, one row per sample weighed.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn left(&self, secret: &Secret) -> Result<DVector<f64>, ConcealError> {
        let signature = self.weighted(Some(secret), self.calibration)? - &self.plain;
        Ok(&signature - &self.basis * (self.basis.tr_mul(&signature)))
    }

    fn slopes(&self) -> Result<DMatrix<f64>, ConcealError> {
        let columns = (0..Calibration::COUNT).map(|i| {
            let mut by = [1.0; Calibration::COUNT];
            by[i] += SHARE;
            Ok((self.weighted(None, self.calibration.scaled(by))? - &self.plain) / SHARE)
        });
        Ok(DMatrix::from_columns(&columns.collect::<Result<Vec<_>, ConcealError>>()?))
    }

    /// Outputs in their units, thinned.
    fn weighted(&self, secret: Option<&Secret>, calibration: Calibration) -> Result<DVector<f64>, ConcealError> {
        let mut plant = Plant::new(self.rig, calibration);
        if let Some(secret) = secret {
            secret.install(&mut plant);
        }
        let mut all = Vec::new();
        for (begun_s, drives) in &self.runs {
            plant.begun_s = *begun_s;
            let series = solve(&plant, drives)?;
            for (i, mut series) in series.into_iter().enumerate().filter(|(i, _)| self.shown[*i]) {
                let column = self.rig.outputs()[i].column;
                if let Some(secret) = secret.filter(|s| s.channel.as_deref() == Some(column)) {
                    secret.corrupt(&mut series, SAMPLE_S, *begun_s);
                }
                all.extend(series.iter().step_by(STRIDE).map(|x| x / self.unit[i]));
            }
        }
        Ok(DVector::from_vec(all))
    }
}
