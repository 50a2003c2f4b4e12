//! Relaxations of all times at once: creep along the logarithm of time.

use crate::scalar::Scalar;

use super::MaxwellBranch;

/// Relaxations in a decade of time: with two, creep is off its straight line by less than a thousandth of a decade's, though its pace
/// ripples by 0.2 %.
const PER_DECADE: f64 = 2.0;
/// Below this share of the relaxed stiffness branches part as they do in the limit of none.
const LEAST_RATIO: f64 = 1e-6;
/// Halvings in the logarithm: of brackets that span up to `1 + E/k`, at most a million or so, to the last digit.
const HALVINGS: usize = 60;

/// Maxwell branches that make a spring creep in proportion to the logarithm of time.
///
/// Beside a spring `k` = `relaxed_n_m` and under a constant load, `n = 2 decades + 1` equal retardations two to a decade:
///
/// ```text
/// e(t)/F = 1/(k + E) + sum_i J (1 - exp(-t/tau_i)),    J = E/(n k (k + E)),    tau_i = tau 10^(i/2),  i = 0..n-1
/// ```
///
/// The branches are those of the relaxation `k + sum_j E_j exp(-t/theta_j)` that this creep belongs to, exactly: `theta_j` are the
/// roots of `1 + r/n sum_i 1/(1 - tau_i/theta) = 0`, `r = E/k`, one below each `tau_i`, and `sum_j E_j = E`. `together` has `E`, N/m,
/// and `tau`, s > 0; `decades` finite and >= 0, `relaxed_n_m` > 0.
///
/// Source: constant logarithmic retardation spectrum (Ferry 1980, chapter 3); conversion of discrete spectra (Park and Schapery 1999).
///
/// ```
/// use smam::effects::{MaxwellBranch, logarithmic_creep};
///
/// let together = MaxwellBranch { stiffness_n_m: 60.0_f64, relaxation_time_s: 0.1 };
/// let branches = logarithmic_creep(together, 4.0, 30.0);
/// assert_eq!(branches.len(), 9);
/// let sum: f64 = branches.iter().map(|b| b.stiffness_n_m).sum();
/// assert!((sum / 60.0 - 1.0).abs() < 1e-9);
/// ```
pub fn logarithmic_creep<D: Scalar>(together: MaxwellBranch<D>, decades: f64, relaxed_n_m: D) -> Vec<MaxwellBranch<D>> {
    let count = (PER_DECADE * decades).round() as usize + 1;
    let ratio = together.stiffness_n_m / relaxed_n_m;
    let least = D::constant(LEAST_RATIO);
    let ladder = Ladder { times: (0..count).map(time).collect(), ratio: ratio.select_above(least, ratio, least) };
    let branch = |i: usize| {
        let relaxation = ladder.relaxation(i);
        MaxwellBranch {
            stiffness_n_m: together.stiffness_n_m * ladder.share(relaxation),
            relaxation_time_s: together.relaxation_time_s * relaxation,
        }
    };
    (0..count).map(branch).collect()
}

/// Retardation time, in units of the shortest.
fn time(index: usize) -> f64 {
    10f64.powf(index as f64 / PER_DECADE)
}

/// Equal retardations in a row; times in units of the shortest.
struct Ladder<D> {
    times: Vec<f64>,
    ratio: D,
}

impl<D: Scalar> Ladder<D> {
    /// `r/n`
    fn part(&self) -> D {
        self.ratio / self.times.len() as f64
    }

    /// `1 + r/n sum_i 1/(1 - tau_i/theta)`, which falls from pole to pole, and its slope.
    fn value_and_slope(&self, theta: D) -> (D, D) {
        let (mut value, mut slope) = (D::constant(1.0), D::constant(0.0));
        for &time in &self.times {
            let quotient = theta.recip() * time;
            let term = (-quotient + 1.0).recip();
            value += self.part() * term;
            slope += -(self.part() * term * term * quotient / theta);
        }
        (value, slope)
    }

    /// The relaxation time below the retardation time `index`.
    fn relaxation(&self, index: usize) -> D {
        let mut high = D::constant(self.times[index]);
        let mut low = match index.checked_sub(1) {
            Some(before) => D::constant(self.times[before]),
            None => (self.ratio + 1.0).recip(),
        };
        let zero = D::constant(0.0);
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            let (value, _) = self.value_and_slope(middle);
            (low, high) = (value.select_above(zero, middle, low), value.select_above(zero, high, middle));
        }
        // A step of Newton's gives the root the derivatives that the halving lost.
        let (value, slope) = self.value_and_slope(low);
        low - value / slope
    }

    /// `E_j/E` of the branch that relaxes in `theta`.
    fn share(&self, theta: D) -> D {
        let (_, slope) = self.value_and_slope(theta);
        -(self.ratio + 1.0) / (self.ratio * slope * theta)
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;

    fn together(stiffness_n_m: f64) -> MaxwellBranch<f64> {
        MaxwellBranch { stiffness_n_m, relaxation_time_s: 0.1 }
    }

    /// Elongation per force of a spring with the branches beside it, at times that are `RATIO` apart, m/N.
    fn creep(branches: &[MaxwellBranch<f64>], relaxed_n_m: f64, times_s: &[f64]) -> Vec<f64> {
        let instant_n_m = relaxed_n_m + branches.iter().map(|b| b.stiffness_n_m).sum::<f64>();
        let mut dashpots = vec![0.0; branches.len()];
        let (mut now_s, mut creep) = (0.0, Vec::new());
        let elongation = |dashpots: &[f64]| {
            let held: f64 = branches.iter().zip(dashpots).map(|(b, d)| b.stiffness_n_m * d).sum();
            (1.0 + held) / instant_n_m
        };
        for &end_s in times_s {
            // Steps that grow with time: what relaxes fast has done so by then.
            while now_s < end_s {
                let step_s = (2e-3 * (now_s + 0.01)).min(end_s - now_s);
                let before = elongation(&dashpots);
                let half: Vec<f64> = stepped(branches, &dashpots, before, step_s / 2.0);
                dashpots = stepped(branches, &dashpots, elongation(&half), step_s);
                now_s += step_s;
            }
            creep.push(elongation(&dashpots));
        }
        creep
    }

    /// Dashpots after a step at a constant elongation, exactly.
    fn stepped(branches: &[MaxwellBranch<f64>], dashpots: &[f64], elongation: f64, step_s: f64) -> Vec<f64> {
        let one =
            |(b, d): (&MaxwellBranch<f64>, &f64)| elongation + (d - elongation) * (-step_s / b.relaxation_time_s).exp();
        branches.iter().zip(dashpots).map(one).collect()
    }

    #[test]
    fn creep_is_that_of_equal_retardations() {
        let (relaxed, glassy, decades) = (30.0, 90.0, 4.0);
        let branches = logarithmic_creep(together(glassy - relaxed), decades, relaxed);
        let times_s = [0.01, 0.1, 1.0, 10.0, 100.0, 1e4];
        let each = (1.0 / relaxed - 1.0 / glassy) / branches.len() as f64;
        for (t, found) in times_s.into_iter().zip(creep(&branches, relaxed, &times_s)) {
            let retarded: f64 = (0..branches.len()).map(|i| 1.0 - (-t / (0.1 * time(i))).exp()).sum();
            let expected = 1.0 / glassy + each * retarded;
            assert!((found / expected - 1.0).abs() < 2e-4, "{t} s: {found} for {expected} m/N");
        }
    }

    #[test]
    fn between_its_ends_creep_follows_the_logarithm_of_time() {
        let branches = logarithmic_creep(together(60.0), 6.0, 30.0);
        let times_s: Vec<f64> = (0..=12).map(|i| 10f64.powf(0.25 * f64::from(i))).collect();
        let creep = creep(&branches, 30.0, &times_s);
        let steps: Vec<f64> = creep.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(steps.iter().all(|s| (s / steps[0] - 1.0).abs() < 5e-3), "{steps:?}");
    }

    #[test]
    fn shares_are_positive_and_make_up_the_whole() {
        for stiffness in [0.0, 1e-9, 1e-3, 1.0, 100.0, 1e4] {
            let branches = logarithmic_creep(together(stiffness), 5.0, 20.0);
            let sum: f64 = branches.iter().map(|b| b.stiffness_n_m).sum();
            assert!((sum - stiffness).abs() <= 1e-6 * stiffness, "{sum} for {stiffness} N/m");
            assert!(branches.iter().all(|b| b.stiffness_n_m >= 0.0));
            assert!(branches.windows(2).all(|b| b[0].relaxation_time_s < b[1].relaxation_time_s));
        }
    }

    #[test]
    fn no_decade_is_one_branch() {
        let [one] = logarithmic_creep(together(6.0), 0.0, 20.0)[..] else { panic!("one branch") };
        // One retardation of 0.1 s of a spring of 26 N/m, 20 N/m in the end: relaxation in 20/26 of that.
        assert!((one.stiffness_n_m - 6.0).abs() < 1e-9);
        assert!((one.relaxation_time_s - 0.1 * 20.0 / 26.0).abs() < 1e-12);
    }

    #[test]
    fn derivatives_are_exact() {
        let at = |stiffness: Dual64| {
            let together = MaxwellBranch { stiffness_n_m: stiffness, relaxation_time_s: Dual64::from(0.1) };
            logarithmic_creep(together, 3.0, Dual64::from(20.0))
        };
        let (low, high) = (at(Dual64::from(59.999)), at(Dual64::from(60.001)));
        for ((exact, low), high) in at(Dual64::new(60.0, 1.0)).iter().zip(&low).zip(&high) {
            let stiffness = (high.stiffness_n_m.re - low.stiffness_n_m.re) / 2e-3;
            let time = (high.relaxation_time_s.re - low.relaxation_time_s.re) / 2e-3;
            assert!((exact.stiffness_n_m.eps - stiffness).abs() < 1e-6 * stiffness.abs().max(1e-3));
            assert!((exact.relaxation_time_s.eps - time).abs() < 1e-6 * time.abs().max(1e-3));
        }
    }
}
