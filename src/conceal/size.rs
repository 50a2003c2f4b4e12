//! How large a secret is made: by the misfit that it leaves after the rig's own numbers were refitted.

use nalgebra::{DMatrix, DVector};

use super::ConcealError;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S};
use super::secrets::{KINDS, Secret};
use super::solve::solve;
use super::stock::{Calibration, Rig};

/// What secrets are weighed on.
pub struct Weighed {
    pub rig: Rig,
    pub calibration: Calibration,
    pub runs: Vec<WeighedRun>,
    /// What one unit of each output is, its noise, and whether it is recorded.
    pub unit: Vec<f64>,
    pub shown: Vec<bool>,
    /// Hidden as well, their sizes as little known as the rig's own numbers.
    pub present: Vec<Secret>,
}

/// What the plungers do in one run.
pub struct WeighedRun {
    /// When it begins, s after the first one.
    pub begun_s: f64,
    pub drives: Vec<Drive>,
    /// One more sensor that it has: its place among [`Rig::more_sensors`], and its noise.
    pub sensor: Option<(usize, f64)>,
}

/// So much of each of a rig's own runs is weighed, s.
const WEIGHED_S: f64 = 30.0;

impl WeighedRun {
    /// The beginnings of runs that follow each other.
    pub fn beginnings(runs: &[Vec<Drive>]) -> Vec<Self> {
        let mut begun_s = 0.0;
        let beginning = |run: &Vec<Drive>| {
            let at_s = begun_s;
            begun_s += run[0].positions_m.len() as f64 * SAMPLE_S;
            let count = ((WEIGHED_S / SAMPLE_S) as usize).min(run[0].positions_m.len());
            let drives = run.iter().map(|d| Drive { positions_m: d.positions_m[..count].to_vec() }).collect();
            Self { begun_s: at_s, drives, sensor: None }
        };
        runs.iter().map(beginning).collect()
    }
}

/// What secrets do to a rig's outputs.
pub struct Sizing {
    weighed: Weighed,
    /// Outputs without the secret that is weighed, and a basis of what the rig's own numbers, and the sizes of what is there as
    /// well, can do to them.
    plain: DVector<f64>,
    basis: DMatrix<f64>,
}

/// Sizes that a secret may have.
fn bounds(secret: &Secret) -> (f64, f64) {
    let largest = KINDS.iter().find(|k| k.name == secret.name).map_or(f64::INFINITY, |k| k.largest);
    secret.law.map_or((-largest, largest), |law| law.bounds())
}

/// Share by which each calibrated number, or size, is moved for its slope.
const SHARE: f64 = 0.01;
/// Every so many samples are weighed: misfits are slow.
pub const STRIDE: usize = 7;
const ROUNDS: usize = 3;

impl Sizing {
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn new(weighed: Weighed) -> Result<Self, ConcealError> {
        let (plain, basis) = (weighed.outputs(weighed.calibration, &[])?, DMatrix::zeros(0, 0));
        let mut sizing = Self { weighed, plain, basis };
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
        let (least, largest) = bounds(secret);
        for _ in 0..ROUNDS {
            let left = self.left(secret)?;
            let excess = left.norm_squared() / left.len() as f64;
            let factor = (wanted / excess.max(1e-12)).sqrt().clamp(0.02, 30.0);
            secret.size = (secret.size * factor).clamp(least, largest);
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
        let signature = self.weighed.outputs(self.weighed.calibration, &[secret])? - &self.plain;
        Ok(&signature - &self.basis * (self.basis.tr_mul(&signature)))
    }

    /// What the rig's own numbers do to the outputs, and the sizes of what is present.
    fn slopes(&self) -> Result<DMatrix<f64>, ConcealError> {
        let mut columns = Vec::new();
        for i in 0..Calibration::COUNT {
            let mut by = [1.0; Calibration::COUNT];
            by[i] += SHARE;
            let moved = self.weighed.outputs(self.weighed.calibration.scaled(by), &[])?;
            columns.push((moved - &self.plain) / SHARE);
        }
        let usual = columns.iter().map(DVector::norm).fold(0.0, f64::max);
        for secret in &self.weighed.present {
            let mut more = secret.clone();
            more.size *= 1.0 + SHARE;
            let change = self.weighed.outputs(self.weighed.calibration, &[&more])? - &self.plain;
            // Of a length like the others': the basis is to hold it, however little it does.
            columns.extend((change.norm() > 0.0).then(|| &change * (usual / change.norm())));
        }
        Ok(DMatrix::from_columns(&columns))
    }
}

impl Weighed {
    /// Outputs in their units, thinned, with more secrets; one takes the place of the same that is present.
    fn outputs(&self, calibration: Calibration, more: &[&Secret]) -> Result<DVector<f64>, ConcealError> {
        let mut plant = Plant::new(self.rig, calibration);
        let stays = |p: &&Secret| !more.iter().any(|m| m.is_same_thing(p));
        let secrets: Vec<&Secret> = self.present.iter().filter(stays).chain(more.iter().copied()).collect();
        secrets.iter().for_each(|s| s.install(&mut plant));
        let mut all = Vec::new();
        for run in &self.runs {
            plant.begun_s = run.begun_s;
            let own = self.rig.outputs().len();
            for (i, mut series) in solve(&plant, &run.drives)?.into_iter().enumerate() {
                let unit = match i.checked_sub(own) {
                    None => self.shown[i].then_some(self.unit[i]),
                    Some(more) => run.sensor.and_then(|(sensor, noise)| (sensor == more).then_some(noise)),
                };
                let Some(unit) = unit else { continue };
                let column = self.rig.outputs().get(i).map(|o| o.column);
                for secret in secrets.iter().filter(|s| s.channel.is_some() && s.channel.as_deref() == column) {
                    secret.corrupt(&mut series, SAMPLE_S, run.begun_s);
                }
                all.extend(series.iter().step_by(STRIDE).map(|x| x / unit));
            }
        }
        Ok(DVector::from_vec(all))
    }
}
