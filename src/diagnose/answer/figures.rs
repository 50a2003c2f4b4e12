//! What the answer says of detection and calibration.

use std::collections::BTreeMap;

use statrs::distribution::{ContinuousCDF, Normal};

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::{Detection, Estimate};
use crate::diagnose::fit::Fit;
use crate::diagnose::search::Found;
use crate::diagnose::verdict::Excess;

/// Misfit above noise, of the corrected scene as given, and detection limits.
pub(in crate::diagnose) fn detection(
    case: &Case,
    noise: &[Noise],
    found: &Found,
    (excess, corrected): (Excess, f64),
) -> Detection {
    let by_channel = |f: fn(&Noise) -> f64| -> BTreeMap<String, f64> {
        case.channels.iter().zip(noise).map(|(c, n)| (c.column.clone(), f(n))).collect()
    };
    let mut smallest = BTreeMap::new();
    for s in &found.screened {
        let size: &mut f64 = smallest.entry(s.variant.placed.title()).or_insert(f64::INFINITY);
        *size = size.min(s.least_size);
    }
    smallest.retain(|_, size| size.is_finite());
    Detection {
        excess_chi2_per_sample: excess.baseline,
        excess_chi2_per_sample_corrected: corrected,
        p_value: by_chance(excess.baseline / excess.error),
        noise_sd: by_channel(|n| n.sd),
        noise_inflation: by_channel(|n| n.inflation()),
        smallest_detectable: smallest,
    }
}

/// Probability that noise alone leaves this many standard errors or more.
fn by_chance(standard_errors: f64) -> f64 {
    Normal::standard().sf(standard_errors)
}

/// The calibrated parameters with their intervals.
pub(in crate::diagnose) fn calibration(case: &Case, fit: &Fit) -> BTreeMap<String, Estimate> {
    let estimate = |i: usize| {
        let (value, half) = (fit.x[i], fit.half_width(i));
        Estimate { value, ci95: [value - half, value + half] }
    };
    case.parameters.iter().enumerate().map(|(i, p)| (p.title(), estimate(i))).collect()
}

/// Warning about calibrated parameters at a nonzero bound.
pub(in crate::diagnose) fn on_bounds(case: &Case, fit: &Fit) -> Vec<String> {
    let parameters = fit.on_bound.iter().map(|&i| (&case.parameters[i], fit.x[i])).filter(|(_, value)| *value != 0.0);
    let words = parameters.map(|(p, value)| {
        format!(
            "{} ended on an end of its range, {value:.3e} of {:.3e} .. {:.3e}: its interval says nothing; give [[calibrate]] a \
             wider range, or look for what else makes the scene want it",
            p.title(), p.min, p.max
        )
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_noise_leaves_by_chance() {
        assert!((by_chance(0.0) - 0.5).abs() < 1e-12);
        assert!((by_chance(1.959_963_984_540_054) - 0.025).abs() < 1e-9);
        assert!(by_chance(10.0) > 0.0 && by_chance(10.0) < 1e-20);
    }
}
