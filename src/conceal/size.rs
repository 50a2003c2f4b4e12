//! How large a secret is made: by the misfit that it leaves after the rig's own numbers were refitted.

use nalgebra::{DMatrix, DVector};

use super::ConcealError;
use super::noise::ChannelNoise;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S};
use super::secrets::{KINDS, Secret};
use super::solve::solve;
use super::stock::{Calibration, Rig};

/// One run of a rig's own experiment, on which secrets are weighed.
pub struct Sizing<'a> {
    pub rig: Rig,
    pub calibration: Calibration,
    pub drives: &'a [Drive],
    /// When this run begins, s after the first one.
    pub begun_s: f64,
    pub noise: &'a [ChannelNoise],
    pub shown: &'a [bool],
}

/// Share by which each calibrated number is moved for its slope.
const SHARE: f64 = 0.01;
/// Every so many samples are weighed: misfits are slow.
const STRIDE: usize = 7;
const ROUNDS: usize = 3;

impl Sizing<'_> {
    /// Scales a secret so that it leaves `wanted` of misfit per sample, in units of the noise's variance, after a linear
    /// refit; as near as its largest size allows.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn scale(&self, secret: &mut Secret, wanted: f64) -> Result<(), ConcealError> {
        let plain = self.weighted(None, self.calibration)?;
        let slopes = self.slopes(&plain)?;
        let decomposed = slopes.svd(true, false);
        let basis = decomposed.u.ok_or_else(|| ConcealError::Solver("slopes without a basis".to_owned()))?;
        let largest = KINDS.iter().find(|k| k.name == secret.name).map_or(f64::INFINITY, |k| k.largest);
        for _ in 0..ROUNDS {
            let signature = self.weighted(Some(secret), self.calibration)? - &plain;
            let left = &signature - &basis * (basis.tr_mul(&signature));
            let excess = left.norm_squared() / left.len() as f64;
            let factor = (wanted / excess.max(1e-12)).sqrt().clamp(0.02, 30.0);
            secret.size = (secret.size * factor).clamp(-largest, largest);
            if (0.8..1.25).contains(&factor) {
                break;
            }
        }
        Ok(())
    }

    fn slopes(&self, plain: &DVector<f64>) -> Result<DMatrix<f64>, ConcealError> {
        let columns = (0..Calibration::COUNT).map(|i| {
            let mut by = [1.0; Calibration::COUNT];
            by[i] += SHARE;
            Ok((self.weighted(None, self.calibration.scaled(by))? - plain) / SHARE)
        });
        Ok(DMatrix::from_columns(&columns.collect::<Result<Vec<_>, ConcealError>>()?))
    }

    /// Outputs in units of the noise, thinned.
    fn weighted(&self, secret: Option<&Secret>, calibration: Calibration) -> Result<DVector<f64>, ConcealError> {
        let mut plant = Plant::new(self.rig, calibration);
        plant.begun_s = self.begun_s;
        if let Some(secret) = secret {
            secret.install(&mut plant);
        }
        let mut all = Vec::new();
        let series = solve(&plant, self.drives)?;
        for (i, mut series) in series.into_iter().enumerate().filter(|(i, _)| self.shown[*i]) {
            let column = self.rig.outputs()[i].column;
            if let Some(secret) = secret.filter(|s| s.channel.as_deref() == Some(column)) {
                secret.corrupt(&mut series, SAMPLE_S, self.begun_s);
            }
            all.extend(series.iter().step_by(STRIDE).map(|x| x / self.noise[i].sd));
        }
        Ok(DVector::from_vec(all))
    }
}
