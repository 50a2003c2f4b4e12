//! Play, and the sums made of it. Any unit of length: widths are in the unit of the input.

use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// Play (backlash): `w = max(x - r, min(x + r, w))`, `r` half the total width, >= 0.
///
/// The output stays until the input has crossed the gap. Source: Krasnosel'skii and Pokrovskii 1989.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Play<D> {
    pub half_width: D,
}

impl<D: Scalar> Play<D> {
    /// The output after the input reached `x`; exact for any path in between that did not turn.
    pub fn advance(&self, output: D, x: D) -> D {
        let (least, most) = (x - self.half_width, x + self.half_width);
        if output.value() < least.value() {
            least
        } else if output.value() > most.value() {
            most
        } else {
            output
        }
    }
}

/// One play of a Prandtl-Ishlinskii sum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayElement<D> {
    /// Output per play output.
    pub weight: D,
    pub half_width: D,
}

/// Prandtl-Ishlinskii model: `y = g x + sum w_i P_i(x)`, `P_i` plays of half width `r_i`; the state is the plays'
/// outputs. Symmetric, rate-independent; with `w_i >= 0` unloading lies above loading and it can be inverted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrandtlIshlinskii<D> {
    /// Output per input past the hysteresis.
    pub gain: D,
    pub elements: Vec<PlayElement<D>>,
}

impl<D: Scalar> PrandtlIshlinskii<D> {
    /// The plays centred at `x`.
    pub fn rest(&self, x: D) -> Vec<D> {
        vec![x; self.elements.len()]
    }

    /// Moves every play to the input `x`; `state` has one entry per element.
    pub fn advance(&self, state: &mut [D], x: D) {
        for (output, element) in state.iter_mut().zip(&self.elements) {
            let half_width = element.half_width;
            *output = Play { half_width }.advance(*output, x);
        }
    }

    pub fn output(&self, x: D, state: &[D]) -> D {
        let plays = self.elements.iter().zip(state);
        self.gain * x + plays.map(|(e, &play)| e.weight * play).sum::<D>()
    }
}

/// One spring with a slider of a Maxwell-slip sum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlipElement<D> {
    /// Output per stretch of the spring.
    pub stiffness: D,
    /// Largest output of the element, >= 0.
    pub limit: D,
}

/// Maxwell-slip model: `y = g x + sum f_i`, each `f_i` the force of a spring whose far end slides at `|f_i| = limit_i`.
///
/// The state is the `f_i`. Unloading lies below loading; passive for `stiffness, limit >= 0`. Source: Iwan 1966,
/// Al-Bender et al. 2005 (the constant-limit case of the generalized Maxwell-slip model).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaxwellSlip<D> {
    /// Output per input beside the sliders.
    pub gain: D,
    pub elements: Vec<SlipElement<D>>,
}

impl<D: Scalar> MaxwellSlip<D> {
    /// All springs relaxed.
    pub fn rest(&self) -> Vec<D> {
        vec![D::constant(0.0); self.elements.len()]
    }

    /// Moves the input by `step` without turning; `state` has one entry per element.
    pub fn advance(&self, state: &mut [D], step: D) {
        for (force, element) in state.iter_mut().zip(&self.elements) {
            let free = *force + element.stiffness * step;
            *force = if free.value() > element.limit.value() {
                element.limit
            } else if free.value() < -element.limit.value() {
                -element.limit
            } else {
                free
            };
        }
    }

    pub fn output(&self, x: D, state: &[D]) -> D {
        self.gain * x + state.iter().copied().sum::<D>()
    }
}
