//! Calibrating the bench against a loop: numbers of the scene, and effects by their size.

use nalgebra::DVector;

use crate::effects::EffectTable;
use crate::identify::{Bounds, LmOptions, minimise};

use super::ReproduceError;
use super::loops::{Loop, rms_apart};
use super::rig::{Fast, stock};

/// What a knob turns.
#[derive(Clone, Copy)]
pub enum Lever {
    /// A key of the scene.
    Number(&'static str),
    /// The size of an effect.
    Effect(fn(f64) -> EffectTable),
}

/// A number that may be fitted, SI.
#[derive(Clone, Copy)]
pub struct Knob {
    pub name: &'static str,
    pub lever: Lever,
    pub start: f64,
    pub range: Bounds,
}

/// The bench on one steady loop, both counted from where the plunger is home.
pub struct Bench {
    fast: Fast,
    plunger_mm: Vec<f64>,
    period_s: f64,
    pub target: Loop,
}

/// A bench with knobs set, and how far its loop lies from the target.
pub struct Candidate {
    pub settings: Vec<(Knob, f64)>,
    pub cycle: Loop,
    pub rms_mm: f64,
}

impl Bench {
    /// The stock programme of the bench for 30 s; `target` makes the wanted outputs of the plunger's path (mm).
    pub fn new(period_s: f64, target: impl Fn(&[f64]) -> Vec<f64>) -> Result<Self, ReproduceError> {
        let fast = stock("muscle_bench").lasting(30.0).fast()?;
        let plunger_mm: Vec<f64> = fast.input_mm(0);
        let target = Loop::last(fast.times_s(), &plunger_mm, &target(&plunger_mm), period_s).zeroed();
        Ok(Self { fast, plunger_mm, period_s, target })
    }

    fn cycle(&self, settings: &[(Knob, f64)]) -> Result<Loop, ReproduceError> {
        let (mut numbers, mut effects) = (Vec::new(), Vec::new());
        for (knob, value) in settings {
            match knob.lever {
                Lever::Number(key) => numbers.push((key, *value)),
                Lever::Effect(make) => effects.push(make(*value)),
            }
        }
        let elongation = self.fast.channel("elongation_mm", &numbers, &effects)?;
        Ok(Loop::last(self.fast.times_s(), &self.plunger_mm, &elongation, self.period_s).zeroed())
    }

    /// The bench with its knobs as given.
    pub fn set(&self, settings: Vec<(Knob, f64)>) -> Result<Candidate, ReproduceError> {
        let cycle = self.cycle(&settings)?;
        let rms_mm = rms_apart(&cycle.y, &self.target.y);
        Ok(Candidate { settings, cycle, rms_mm })
    }

    /// Least squares over the loop from the knobs' starts; a bound that is met is widened once.
    pub fn calibrated(&self, knobs: &[Knob]) -> Result<Candidate, ReproduceError> {
        let found = self.within(knobs);
        let widened: Vec<Knob> =
            found.iter().map(|(k, x)| Knob { start: *x, range: widened(k.range, *x), ..*k }).collect();
        let is_wider = widened.iter().zip(knobs).any(|(a, b)| a.range != b.range);
        self.set(if is_wider { self.within(&widened) } else { found })
    }

    fn within(&self, knobs: &[Knob]) -> Vec<(Knob, f64)> {
        let set = |x: &[f64]| knobs.iter().copied().zip(x.iter().copied()).collect::<Vec<_>>();
        let residuals = |x: &[f64]| {
            let cycle = self.cycle(&set(x)).ok()?;
            Some(DVector::from_iterator(cycle.y.len(), cycle.y.iter().zip(&self.target.y).map(|(a, b)| a - b)))
        };
        let ranges: Vec<Bounds> = knobs.iter().map(|k| k.range).collect();
        let start: Vec<f64> = knobs.iter().map(|k| k.start).collect();
        // Every cycle meets the coil's stop, where steps are cut: small differences would be those of the cuts.
        let options = LmOptions { max_iterations: 60, relative_decrease: 1e-5, difference: 1e-2 };
        let found = minimise(&residuals, &start, &ranges, options);
        set(&found.map_or(start, |f| f.parameters))
    }
}

/// The range half as wide again on the side where `x` met it; what was positive stays so.
fn widened(b: Bounds, x: f64) -> Bounds {
    let (close, more) = (1e-6 * (b.max - b.min), 0.5 * (b.max - b.min));
    Bounds {
        min: if x - b.min < close { (b.min - more).max(0.05 * b.min) } else { b.min },
        max: if b.max - x < close { b.max + more } else { b.max },
    }
}
