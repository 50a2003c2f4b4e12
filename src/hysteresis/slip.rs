//! The Maxwell-slip model: springs whose far ends slide.

use super::Gate;
use super::error::{HysteresisError, all_of_one_sign, not_negative, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One spring with a slider of a Maxwell-slip sum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlipElement<D> {
    /// Output per stretch of the spring.
    pub stiffness: D,
    /// Stretch at which the far end slides, > 0, in the unit of the input.
    pub reach: D,
}

/// Maxwell-slip model: `y = y0 + g x + q x² + s x³ + G(x) (1 + c x) sum k_i e_i`, each stretch `e_i` following `x` within
/// `+- reach_i`.
///
/// `x`, `y`, `y0`, `reach` in mm; `g`, `k_i` dimensionless, `q`, `c` in 1/mm, `s` in 1/mm². The state is the `e_i`. `G` is 1, or `tanh x` as in
/// the paper's model, which closes the loop at `x = 0` and so makes it asymmetric; `c` makes friction grow with the input, as
/// that of a muscle does with its pressure. With `k_i > 0` unloading lies below
/// loading, with `k_i < 0` above. Source: Iwan 1966; Al-Bender et al. 2005 (the constant-limit case of their
/// generalized Maxwell-slip model); the gate is borrowed from Thai et al. 2021.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound(deserialize = "D: Scalar + Deserialize<'de>"))]
pub struct MaxwellSlip<D> {
    /// `y0`, mm: where the output counts from.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub offset: D,
    /// Output per input beside the sliders.
    pub gain: D,
    /// Output per squared input, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub curvature: D,
    /// `s`, 1/mm².
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub cubic: D,
    /// `c`, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub growth: D,
    #[serde(default = "not_gated")]
    pub gate: Gate,
    pub elements: Vec<SlipElement<D>>,
}

fn not_gated() -> Gate {
    Gate::None
}

impl<D: Scalar> MaxwellSlip<D> {
    /// All springs relaxed.
    pub fn rest(&self) -> Vec<D> {
        vec![D::constant(0.0); self.elements.len()]
    }

    /// Moves the input by `step` without turning; exact; `state` has one entry per element.
    ///
    /// ```
    /// use smam::hysteresis::{Gate, MaxwellSlip, SlipElement};
    ///
    /// let springs = vec![SlipElement { stiffness: -2.0_f64, reach: 0.1 }];
    /// let [offset, curvature, cubic, growth] = [0.0; 4];
    /// let model = MaxwellSlip { offset, gain: 9.0, curvature, cubic, growth, gate: Gate::None, elements: springs };
    /// let mut state = model.rest();
    /// model.advance(&mut state, 3.0);
    /// assert_eq!(state, [0.1]);
    /// // It slides at its reach; turned about, the spring gives way over twice that.
    /// model.advance(&mut state, -0.2);
    /// assert!((state[0] + 0.1).abs() < 1e-15);
    /// ```
    pub fn advance(&self, state: &mut [D], step: D) {
        for (stretch, element) in state.iter_mut().zip(&self.elements) {
            let free = *stretch + step;
            *stretch = if free.value() > element.reach.value() {
                element.reach
            } else if free.value() < -element.reach.value() {
                -element.reach
            } else {
                free
            };
        }
    }

    pub fn output(&self, x: D, state: &[D]) -> D {
        let springs: D = self.elements.iter().zip(state).map(|(e, &stretch)| e.stiffness * stretch).sum();
        let curve = self.offset + (self.gain + (self.curvature + self.cubic * x) * x) * x;
        curve + self.gate.factor(x) * (self.growth * x + 1.0) * springs
    }

    /// Whether every slider has a reach.
    pub fn check(&self) -> Result<(), HysteresisError> {
        self.elements.iter().try_for_each(|e| positive(MODEL, "reach", e.reach.value()))
    }

    /// Whether every loop within a range of inputs turns the same way: stiffnesses of one sign, and a factor
    /// `F = G(x) (1 + c x)` that is nowhere negative there.
    ///
    /// A slider whose far end stands at `x0` goes up at `x0 + r` and down at `x0 - r`, so that a closed path takes
    /// `k` times the sum of `Phi(x0 + r) - Phi(x0 - r)`, `Phi' = F`: never negative where `F` is not. Noise of a hundredth of the
    /// range around a gated form's zero is let pass.
    pub fn check_loops(&self, range_mm: [f64; 2]) -> Result<(), HysteresisError> {
        self.check()?;
        for x_mm in range_mm {
            not_negative(MODEL, "1 + growth x", 1.0 + self.growth.value() * x_mm)?;
        }
        if self.gate == Gate::Tanh {
            not_negative(MODEL, "least input of a gated form", range_mm[0] + 0.01 * (range_mm[1] - range_mm[0]))?;
        }
        all_of_one_sign(MODEL, "stiffness", self.elements.iter().map(|e| e.stiffness.value()))
    }
}

const MODEL: &str = "Maxwell-slip";
