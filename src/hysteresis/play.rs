//! Play, and the Prandtl-Ishlinskii sum made of it. Any unit of length: widths are in the unit of the input.

use super::error::{HysteresisError, all_of_one_sign, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Play (backlash): `w = max(x - r, min(x + r, w))`, `r` half the total width, >= 0.
///
/// The output stays until the input has crossed the gap. Source: Krasnosel'skii and Pokrovskii 1989.
///
/// ```
/// use smam::hysteresis::Play;
///
/// let play = Play { half_width: 0.5_f64 };
/// let out = play.advance(0.0, 3.0);
/// // 1 mm of the way back is lost.
/// assert_eq!((out, play.advance(out, 2.0), play.advance(out, 1.5)), (2.5, 2.5, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Play<D> {
    pub half_width: D,
}

impl<D: Scalar> Play<D> {
    /// The output after the input reached `x`; exact for any path in between that did not turn.
    pub fn advance(&self, output: D, x: D) -> D {
        between(output, x - self.half_width, x + self.half_width)
    }
}

/// `value`, or the edge that pushes it.
fn between<D: Scalar>(value: D, least: D, most: D) -> D {
    if value.value() < least.value() {
        least
    } else if value.value() > most.value() {
        most
    } else {
        value
    }
}

/// One play of a Prandtl-Ishlinskii sum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlayElement<D> {
    /// Output per play output.
    pub weight: D,
    pub half_width: D,
}

/// Prandtl-Ishlinskii model of generalized plays:
///
/// `y = g x + q x² + sum w_i P_i(x)`, `P_i` moved up by the edge `x - kappa x² - h_i`, down by `x + kappa x² + h_i`,
/// `h_i = r_i + tau |dx/dt|`. The state is the plays' outputs.
///
/// `x`, `y`, `r_i` in mm; `g`, `w_i` dimensionless, `q`, `kappa` in 1/mm, `tau` in s. `kappa = tau = 0` is the
/// classical symmetric, rate-independent sum. `kappa > 0` makes the loop wider away from `x = 0` (asymmetry);
/// `tau > 0` makes it wider with speed. Range: `r_i, kappa, tau >= 0`; the edges rise while `2 kappa |x| < 1`.
/// With `w_i >= 0` unloading lies above loading.
///
/// Sources: Krejčí and Kuhnen 2001 (the sum); Al Janaideh, Rakheja and Su 2009 (edges of two shapes);
/// Al Janaideh and Krejčí 2013 (half widths that grow with speed).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound(deserialize = "D: Scalar + Deserialize<'de>"))]
pub struct PrandtlIshlinskii<D> {
    /// Output per input past the hysteresis.
    pub gain: D,
    /// Output per squared input, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub curvature: D,
    /// `kappa`, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub asymmetry: D,
    /// `tau`, s: growth of every half width per input speed.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub rate_s: D,
    pub elements: Vec<PlayElement<D>>,
}

impl<D: Scalar> PrandtlIshlinskii<D> {
    /// The classical sum: symmetric, of any speed.
    pub fn classical(gain: D, elements: Vec<PlayElement<D>>) -> Self {
        let [curvature, asymmetry, rate_s] = [D::constant(0.0); 3];
        Self { gain, curvature, asymmetry, rate_s, elements }
    }

    /// The plays centred at `x`.
    pub fn rest(&self, x: D) -> Vec<D> {
        vec![x; self.elements.len()]
    }

    /// Moves every play to the input `x`, reached at `speed_mm_s` without turning; `state` has one entry per element.
    ///
    /// ```
    /// use smam::hysteresis::{PlayElement, PrandtlIshlinskii};
    ///
    /// let plays = vec![PlayElement { weight: 2.0_f64, half_width: 0.1 }];
    /// let model = PrandtlIshlinskii { rate_s: 0.02, ..PrandtlIshlinskii::classical(4.0, plays) };
    /// let mut state = model.rest(0.0);
    /// let mut at = |x_mm: f64, speed_mm_s: f64| {
    ///     model.advance(&mut state, x_mm, speed_mm_s);
    ///     model.output(x_mm, &state)
    /// };
    /// // At 1.5 mm/s the loop is 2 w (r + tau v) = 0.52 mm wide.
    /// let (up_mm, _, down_mm) = (at(1.5, 1.5), at(3.0, 1.5), at(1.5, 1.5));
    /// assert!((down_mm - up_mm - 0.52).abs() < 1e-12);
    /// ```
    pub fn advance(&self, state: &mut [D], x: D, speed_mm_s: f64) {
        let bend = self.asymmetry * x * x;
        let wider = self.rate_s * speed_mm_s.abs() + bend;
        for (output, element) in state.iter_mut().zip(&self.elements) {
            *output = Play { half_width: element.half_width + wider }.advance(*output, x);
        }
    }

    pub fn output(&self, x: D, state: &[D]) -> D {
        let plays = self.elements.iter().zip(state);
        (self.gain + self.curvature * x) * x + plays.map(|(e, &play)| e.weight * play).sum::<D>()
    }

    /// Whether the edges of every play keep their order.
    pub fn check(&self) -> Result<(), HysteresisError> {
        not_negative("asymmetry", self.asymmetry.value())?;
        not_negative("rate_s", self.rate_s.value())?;
        self.elements.iter().try_for_each(|e| not_negative("half_width", e.half_width.value()))
    }

    /// Whether every loop within `reach_mm` of zero turns the same way: all weights of one sign, edges that rise.
    ///
    /// A play moves up only at `x_up` with `x_up - kappa x_up² - h = P` and down only at `x_down` with
    /// `x_down + kappa x_down² + h = P`; rising edges give `x_down <= x_up` at every level `P`, whatever the speed,
    /// so `∮ x dP = -∮ P dx >= 0`.
    pub fn check_loops(&self, reach_mm: f64) -> Result<(), HysteresisError> {
        self.check()?;
        positive(MODEL, "1 - 2 asymmetry reach", 1.0 - 2.0 * self.asymmetry.value() * reach_mm)?;
        all_of_one_sign(MODEL, "weight", self.elements.iter().map(|e| e.weight.value()))
    }
}

const MODEL: &str = "Prandtl-Ishlinskii";

fn not_negative(quantity: &'static str, value: f64) -> Result<(), HysteresisError> {
    super::error::not_negative(MODEL, quantity, value)
}
