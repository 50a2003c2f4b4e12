//! Many parameter sets of a Bouc-Wen model over one path, side by side, for searches.
//!
//! The sets share the path, hence also every branch: which way the input goes, on which side of zero. What differs
//! stands in arrays of [`LANES`] numbers, plain arithmetic throughout, so that the compiler takes several per instruction.
//! `pulp` picks the widest instructions of the machine at run time; nothing is fused, so results do not depend on it.

use super::DisplacementModel;
use super::power::{power, unfinished};

/// Sets taken together.
pub const LANES: usize = 8;
/// A step reaches over this share of the state's fading length, or less.
const STEP: f64 = 0.05;
/// States that fade within a few samples are nearly at their limit at each, which every step meets.
const MOST_STEPS: f64 = 4.0;

type Lane = [f64; LANES];

/// Mean squared error of each parameter set against the measured outputs, mm²; infinite where a set cannot be followed.
///
/// As following each set by itself, to about 1e-4 of F, but in fixed steps instead of controlled ones.
/// Samples whose measured value is NaN do not count.
///
/// ```
/// use smam::hysteresis::{DisplacementModel, PaperModel, mean_squares};
///
/// let form = DisplacementModel::Paper(PaperModel::printed());
/// let plunger_mm: Vec<f64> = (0..400).map(|i| 1.5 - 1.5 * (f64::from(i) * 0.05).cos()).collect();
/// let (loop_mm, _) = form.follow(0.0, &plunger_mm);
/// let [own, mut wider] = [form.parameters(), form.parameters()];
/// wider[2] *= 1.2;
/// let found_mm2 = mean_squares(&form, &[own, wider], &plunger_mm, &loop_mm);
/// assert!(found_mm2[0] < 1e-4 && found_mm2[1] > 1e-2);
/// ```
pub fn mean_squares(
    form: &DisplacementModel<f64>,
    sets: &[Vec<f64>],
    path_mm: &[f64],
    measured_mm: &[f64],
) -> Vec<f64> {
    let machine = pulp::Arch::new();
    let mut found = Vec::with_capacity(sets.len());
    for group in sets.chunks(LANES) {
        let errors = match Pack::of(form, group) {
            Some(pack) => machine.dispatch(Errors { pack, path_mm, measured_mm }),
            None => [f64::INFINITY; LANES],
        };
        let refused = group.iter().map(|set| !is_admissible(form, set));
        found.extend(errors.iter().zip(refused).map(|(&e, r)| if r || e.is_nan() { f64::INFINITY } else { e }));
    }
    found
}

fn is_admissible(form: &DisplacementModel<f64>, set: &[f64]) -> bool {
    form.with_parameters(set).is_ok_and(|model| model.check().is_ok())
}

/// The numbers of a few sets, by branch and lane.
struct Pack {
    form: DisplacementModel<f64>,
    /// By side of zero and way of the input.
    branches: [[LaneBranch; 2]; 2],
    /// `n - 1`.
    exponent: Lane,
    /// Output per term of [`DisplacementModel::terms`].
    gains: [Lane; 3],
}

/// The work as `pulp` takes it: inlined into a function compiled for the machine's own instructions.
struct Errors<'a> {
    pack: Pack,
    path_mm: &'a [f64],
    measured_mm: &'a [f64],
}

impl pulp::WithSimd for Errors<'_> {
    type Output = Lane;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Lane {
        self.pack.errors(self.path_mm, self.measured_mm)
    }
}

#[derive(Clone, Copy)]
struct LaneBranch {
    drive: Lane,
    above: Lane,
    below: Lane,
    /// The fastest fading of all lanes, 1/mm.
    fading: f64,
}

impl Pack {
    /// `None` if no set is admissible. Lanes without a set, or with one that is not, repeat one that is.
    fn of(form: &DisplacementModel<f64>, sets: &[Vec<f64>]) -> Option<Self> {
        let models: Vec<Option<DisplacementModel<f64>>> = sets
            .iter()
            .map(|set| form.with_parameters(set).ok().filter(|m: &DisplacementModel<f64>| m.check().is_ok()))
            .collect();
        let spare = models.iter().flatten().next().copied()?;
        let model = |lane: usize| models.get(lane).copied().flatten().unwrap_or(spare);
        let lane = |of: &dyn Fn(DisplacementModel<f64>) -> f64| std::array::from_fn(|i| of(model(i)));
        let branch = |side: f64, way: f64| LaneBranch {
            drive: lane(&|m| m.branch(side, way).drive),
            above: lane(&|m| m.branch(side, way).decay_above),
            below: lane(&|m| m.branch(side, way).decay_below),
            fading: (0..LANES).map(|i| model(i).branch(side, way).fading()).fold(0.0, f64::max),
        };
        Some(Self {
            form: *form,
            branches: [[branch(-1.0, -1.0), branch(-1.0, 1.0)], [branch(1.0, -1.0), branch(1.0, 1.0)]],
            exponent: lane(&|m| m.branch(1.0, 1.0).exponent - 1.0),
            gains: [0, 1, 2].map(|k| lane(&|m| m.gains()[k])),
        })
    }

    #[inline(always)]
    fn errors(&self, path_mm: &[f64], measured_mm: &[f64]) -> Lane {
        let mut z = [0.0; LANES];
        let mut sum = [0.0; LANES];
        let mut count = 0.0;
        let mut before = path_mm.first().copied().unwrap_or(0.0);
        for (&x, &measured) in path_mm.iter().zip(measured_mm) {
            if before * x < 0.0 {
                self.travel(&mut z, before, 0.0);
                self.travel(&mut z, 0.0, x);
            } else {
                self.travel(&mut z, before, x);
            }
            before = x;
            if measured.is_nan() {
                continue;
            }
            count += 1.0;
            let [curve, line, gate] = self.form.terms(x);
            for i in 0..LANES {
                let output = self.gains[0][i] * curve + self.gains[1][i] * line + self.gains[2][i] * gate * z[i];
                sum[i] += (output - measured) * (output - measured);
            }
        }
        sum.map(|s| s / count)
    }

    /// Exponential midpoint steps, as many as the fastest lane wants.
    ///
    /// With `|z|^(n-1)` held, the law is linear and has its closed form; held at the start it gives the middle, held
    /// in the middle the end. Of second order, for `n = 1` of fourth; stable and right at the limit for any step.
    #[inline(always)]
    fn travel(&self, z: &mut Lane, from: f64, to: f64) {
        let length = (to - from).abs();
        if length == 0.0 {
            return;
        }
        let branch = &self.branches[usize::from(from + to >= 0.0)][usize::from(to >= from)];
        let steps = (length * branch.fading / STEP).ceil().clamp(1.0, MOST_STEPS);
        let h = length / steps;
        for _ in 0..steps as usize {
            for (i, z) in z.iter_mut().enumerate() {
                let middle = self.fade(branch, i, *z, *z, 0.5 * h);
                *z = self.fade(branch, i, *z, middle, h);
            }
        }
    }

    /// `z` after the length `h` with `|held|^(n-1)` in the decay.
    #[inline(always)]
    fn fade(&self, branch: &LaneBranch, i: usize, z: f64, held: f64, h: f64) -> f64 {
        let decay = if held < 0.0 { branch.below[i] } else { branch.above[i] };
        // Far below what matters, and `power` wants a normal number.
        let magnitude = held.abs().max(1e-100);
        let rate = decay * power(magnitude, self.exponent[i]);
        z + (branch.drive[i] - rate * z) * h * unfinished(rate * h)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AsymmetricBoucWen, HysteresisModel, PaperModel, SymmetricBoucWen};
    use super::*;

    /// Sines of two amplitudes about a centre, mm.
    fn path(centre: f64) -> Vec<f64> {
        (0..2_000).map(|i| f64::from(i) * 0.01).map(|s| centre - (s * 1.7).cos() - 0.5 * (s * 3.1).cos()).collect()
    }

    fn one_at_a_time(form: DisplacementModel<f64>, set: &[f64], path: &[f64], measured: &[f64]) -> f64 {
        let model = HysteresisModel::from(form.with_parameters(set).expect("as many as the form has"));
        let outputs = model.follow(path, path);
        let squares = outputs.iter().zip(measured).filter(|(_, m)| !m.is_nan()).map(|(o, m)| (o - m) * (o - m));
        squares.clone().sum::<f64>() / squares.count() as f64
    }

    #[test]
    fn lanes_agree_with_one_at_a_time() {
        let shape = [1.0, 0.1, -0.1, 0.2, 0.15, 0.05];
        let forms = [
            DisplacementModel::Symmetric(SymmetricBoucWen::from_array([8.0, -1.0, 2.0, 1.4, 0.5, 1.3])),
            DisplacementModel::Asymmetric(AsymmetricBoucWen { alpha_x: 9.0, alpha_z: -1.2, a: 2.0, n: 1.1, shape }),
            DisplacementModel::Paper(PaperModel::printed()),
        ];
        for form in forms {
            for centre in [1.5, 0.2] {
                let path = path(centre);
                let mut measured: Vec<f64> = path.iter().map(|x| 9.0 * x).collect();
                measured[7] = f64::NAN;
                // Eleven sets: a full pack and a part of one.
                let set = |i: usize| form.parameters().iter().map(|p| p * (1.0 + 0.03 * i as f64)).collect();
                let sets: Vec<Vec<f64>> = (0..11).map(set).collect();
                let found = mean_squares(&form, &sets, &path, &measured);
                for (set, found) in sets.iter().zip(&found) {
                    let exact = one_at_a_time(form, set, &path, &measured);
                    assert!((found / exact - 1.0).abs() < 1e-4, "{form:?}: {found} for {exact}");
                }
            }
        }
    }

    #[test]
    fn a_set_that_runs_away_is_infinitely_wrong_and_spoils_no_other() {
        let form = DisplacementModel::Paper(PaperModel::printed());
        let good = form.parameters();
        let mut bad = good.clone();
        bad[5] = -2.0;
        let path = path(1.5);
        let measured: Vec<f64> = path.iter().map(|x| 9.0 * x).collect();
        let found = mean_squares(&form, &[bad.clone(), good.clone()], &path, &measured);
        assert_eq!(found[0], f64::INFINITY);
        assert_eq!(found[1], mean_squares(&form, &[good], &path, &measured)[0]);
        assert_eq!(mean_squares(&form, &[bad], &path, &measured), [f64::INFINITY]);
    }
}
