//! Responses to constant signals at ports, by derivatives along a run.

use crate::effects::Effect;
use crate::scalar::{Scalar, blended_at_rest};

use super::directions::{D, TOGETHER};
use super::inject::Change;
use super::{Rom, RomRun, RomSetting};

impl Rom {
    /// Response per unit to a constant signal at each port; `None` if the model diverges. At most eight ports.
    pub(crate) fn steadily(
        &self,
        run: &RomRun,
        setting: &RomSetting<f64>,
        ports: &[&Effect<f64>],
    ) -> Option<Vec<Change>> {
        let ports = &ports[..ports.len().min(TOGETHER)];
        let acting = ports.iter().enumerate().map(|(i, port)| port.lift(|_| D::along(0.0, i)));
        let setting = setting.with(acting);
        let series = blended_at_rest(|| self.simulate_over(run, &setting))?;
        let along = |i| series.iter().map(|channel| channel.iter().map(|x| x.slopes[i]).collect()).collect();
        Some((0..ports.len()).map(along).collect())
    }
}

impl RomSetting<f64> {
    /// The same over numbers that carry derivatives, with more effects.
    pub(super) fn with(&self, acting: impl Iterator<Item = Effect<D>>) -> RomSetting<D> {
        RomSetting {
            parameters: self.parameters.iter().map(|(p, x)| (p.clone(), D::constant(*x))).collect(),
            effects: self.effects.iter().map(|effect| effect.lift(D::constant)).chain(acting).collect(),
        }
    }
}
