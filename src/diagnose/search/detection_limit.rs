//! Detection limits: the smallest size of an effect that the recordings could show.

use super::screening::{Screened, least_gain, signatures};
use crate::diagnose::fit::{Fit, Problem, Sides, orthogonal};

/// Relative change at which the iteration stops.
const AGREES: f64 = 1.1;
const ROUNDS: usize = 5;

/// Recomputes limits above the typical size at that size: the signature at zero is too optimistic for laws that level
/// off. A force sensor that lags by a second looks much like one that lags by two, and both may be within the noise.
/// Infinite if no size within the range would be seen.
pub(in crate::diagnose) fn confirm_least_sizes(problem: &Problem, fit: &Fit, screened: &mut [Screened]) {
    let Some(rows) = problem.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::Both) else { return };
    let needed = least_gain(rows.residual.len()).sqrt();
    let basis = rows.jacobian.qr().q();
    let mut open: Vec<usize> = (0..screened.len()).filter(|i| screened[*i].typical_over_least() < 1.0).collect();
    for _ in 0..ROUNDS {
        open.retain(|i| screened[*i].is_possible());
        let tried: Vec<_> = open.iter().map(|i| (&screened[*i].variant, Some(screened[*i].signed_least()))).collect();
        let shown = signatures(problem, fit, &tried);
        let mut unsure = Vec::new();
        for (i, shown) in open.into_iter().zip(shown) {
            let per_typical = shown.map_or(0.0, |raw| orthogonal(&basis, &raw).norm());
            let size = needed / per_typical * screened[i].typical();
            if size > AGREES * screened[i].least_size {
                unsure.push(i);
            }
            screened[i].least_size = size;
        }
        open = unsure;
    }
    open.into_iter().for_each(|i| screened[i].least_size = f64::INFINITY);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::Model;
    use crate::diagnose::search::candidates;
    use crate::diagnose::search::screening::screen;

    /// The bench's force hardly changes: a lag that the signature at zero shows is invisible at half a minute.
    #[test]
    fn what_levels_off_within_the_noise_is_not_visible() {
        let case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm", "force_n"]);
        let noise = [Noise::white(0.02), Noise::white(0.5)];
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let baseline = Model::baseline();
        let fit = problem.fit(&baseline, &problem.start(&baseline, None)).expect("played");
        let mut screened = screen(&problem, &fit, &candidates::variants(&case)).expect("played").screened;
        let promised: Vec<f64> = screened.iter().map(|s| s.least_size).collect();
        confirm_least_sizes(&problem, &fit, &mut screened);
        let is_lag = |s: &Screened| {
            s.variant.placed.entry.id == "sensor_lag" && s.variant.placed.channel.as_deref() == Some("force_n")
        };
        let lags: Vec<_> = screened.iter().zip(&promised).filter(|(s, _)| is_lag(s)).collect();
        for (lag, promised) in &lags {
            assert!(promised.is_finite() && lag.least_size > 1.5 * *promised, "{promised} -> {}", lag.least_size);
        }
        assert!(!lags.is_empty());
        // What is well visible keeps its size.
        let kept = screened.iter().zip(&promised).filter(|(s, promised)| s.least_size == **promised).count();
        assert!(2 * kept > screened.len(), "{kept} of {}", screened.len());
    }
}
