//! One monotone stretch of a Bouc-Wen state: `dz/ds = c - r |z|^(n-1) z` over the path length `s`.

use crate::scalar::Scalar;

/// Local error allowed per step of the integrator, mm of state; the decay forgets it along the path.
const TOLERANCE: f64 = 1e-12;
/// A state that needs more steps on one stretch runs away.
const MOST_STEPS: usize = 20_000;
/// So does one that wants steps of so small a share of it: its slope has no end.
const LEAST_SHARE: f64 = 1e-12;
/// Dormand and Prince's stages (autonomous form), the fifth-order solution last.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Fifth- minus fourth-order solution.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// The state's law while the input moves one way: `c` drives, `r` (by the sign of `z`) pulls back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch<D> {
    pub drive: D,
    pub decay_above: D,
    pub decay_below: D,
    pub exponent: D,
}

impl<D: Scalar> Branch<D> {
    /// `z` after the path length `length >= 0`; NaN when the state runs away.
    ///
    /// Closed form for `n = 1` in plain numbers. Dual numbers always take the integrator: the closed form
    /// would lose the derivative to `n`.
    pub fn travel(&self, z: D, length: D) -> D {
        if self.exponent.value() == 1.0 && D::DERIVATIVES == 0 {
            self.closed_form(z, length)
        } else {
            self.integrate(z, length)
        }
    }

    /// Exponentials on both sides of `z = 0`, joined where the state passes it.
    pub fn closed_form(&self, z: D, length: D) -> D {
        let (above, below) = (self.decay_above, self.decay_below);
        let is_above = z.value() > 0.0 || (z.value() == 0.0 && self.drive.value() > 0.0);
        let (here, beyond) = if is_above { (above, below) } else { (below, above) };
        let slope = self.drive - here * z;
        if z.value() * self.drive.value() < 0.0 && z.value() * slope.value() < 0.0 {
            let to_zero = unfaded(-(z / slope), here);
            if to_zero.value() < length.value() {
                return self.drive * faded(length - to_zero, beyond);
            }
        }
        z + slope * faded(length, here)
    }

    /// Dormand-Prince 5(4) with step control on the plain value.
    pub fn integrate(&self, mut z: D, length: D) -> D {
        let whole = length.value();
        if whole == 0.0 {
            return z + self.slope(z) * length;
        }
        let (mut done, mut share) = (0.0, 1.0_f64);
        // The slope at the end of a step that holds is that at the start of the next.
        let mut slope = self.slope(z);
        for _ in 0..MOST_STEPS {
            if share.is_nan() || share < LEAST_SHARE || !slope.value().is_finite() {
                break;
            }
            let last = done + share >= 1.0;
            let taken = if last { 1.0 - done } else { share };
            let (next, next_slope, error) = self.step(z, slope, length * taken);
            let allowed = TOLERANCE * z.value().abs().max(1.0);
            if error <= allowed {
                (z, slope) = (next, next_slope);
                done += taken;
                if last {
                    return z;
                }
            }
            share = taken * (0.9 * (allowed / error).powf(0.2)).clamp(0.1, 5.0);
        }
        D::constant(f64::NAN)
    }

    /// How fast the state forgets near its limit, 1/mm: `n r |z|^(n-1)` where `r |z|^n = |c|`.
    pub fn fading(&self) -> f64 {
        let decay = self.decay_above.value().abs().max(self.decay_below.value().abs());
        let (n, drive) = (self.exponent.value(), self.drive.value().abs());
        n * decay.powf(1.0 / n) * drive.powf(1.0 - 1.0 / n)
    }

    /// The next state, the slope there, and the error.
    fn step(&self, z: D, slope: D, h: D) -> (D, D, f64) {
        let mut slopes = [slope; 7];
        let mut next = z;
        for (stage, weights) in STAGES.iter().enumerate() {
            next = z + h * combine(weights, &slopes);
            slopes[stage + 1] = self.slope(next);
        }
        // Only the plain value of the error decides.
        let error: f64 = ERROR.iter().zip(&slopes).map(|(e, k)| e * k.value()).sum();
        (next, slopes[6], (h.value() * error).abs())
    }

    fn slope(&self, z: D) -> D {
        let decay = if z.value() < 0.0 { self.decay_below } else { self.decay_above };
        self.drive - decay * signed_power(z, self.exponent)
    }
}

fn combine<D: Scalar>(weights: &[f64], slopes: &[D; 7]) -> D {
    weights.iter().zip(slopes).map(|(&w, &k)| k * w).sum()
}

/// `|z|^(n-1) z`, its derivatives finite at zero.
fn signed_power<D: Scalar>(z: D, n: D) -> D {
    if z.value() == 0.0 {
        return if n.value() == 1.0 { z } else { z * 0.0 };
    }
    z * z.abs().powd(n - 1.0)
}

/// `(1 - exp(-r s))/r`, finite at `r = 0`.
fn faded<D: Scalar>(s: D, r: D) -> D {
    let x = s * r;
    if x.value().abs() < 1e-5 {
        return s * (-(x * (-(x / 3.0) + 1.0)) * 0.5 + 1.0);
    }
    -(-x).exp_m1() / r
}

/// The path length whose [`faded`] is `f`.
fn unfaded<D: Scalar>(f: D, r: D) -> D {
    let x = f * r;
    if x.value().abs() < 1e-5 {
        return f * (x * (x / 3.0 * 2.0 + 1.0) * 0.5 + 1.0);
    }
    -(-x).ln_1p() / r
}
