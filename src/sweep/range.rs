//! What a key of a sweep may be: its range, values or distribution, and the value at a place in it.

use statrs::distribution::{ContinuousCDF, Normal};

use super::SweepError;
use super::sampling::Place;
use super::spec::{SamplingSpec, VarySpec};

impl VarySpec {
    /// Values it takes in a grid.
    pub(super) fn grid_count(&self) -> u64 {
        if self.values.is_empty() { self.count.unwrap_or(0) } else { self.values.len() as u64 }
    }

    /// The keys that get the value.
    #[doc(hidden)]
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.key.split('+').map(str::trim)
    }

    /// # Errors
    /// Numbers that contradict each other or lack for the sampling.
    #[doc(hidden)]
    pub fn check(&self, sampling: SamplingSpec) -> Result<(), SweepError> {
        let refuse = |message: &str, remedy: &str| {
            let (key, message, remedy) = (self.key.clone(), message.to_owned(), remedy.to_owned());
            Err(SweepError::Vary { key, message, remedy })
        };
        let is_grid = sampling == SamplingSpec::Grid;
        let bounded = matches!(sampling, SamplingSpec::Morris { .. } | SamplingSpec::Nsga2 { .. });
        if bounded && self.sd.is_some() {
            return refuse("morris and nsga2 walk over a range, a normal distribution has none", "give from and to");
        }
        let numbers = [self.from, self.to, self.mean, self.sd];
        if numbers.iter().flatten().chain(&self.values).any(|v| !v.is_finite()) {
            return refuse("a number is not finite", "give finite numbers");
        }
        match (self.from, self.to, self.mean, self.sd, self.values.is_empty()) {
            (None, None, None, None, false) if is_grid => Ok(()),
            (None, None, Some(_), Some(sd), true) if !is_grid && sd > 0.0 => Ok(()),
            (Some(from), Some(to), None, None, true) => {
                if is_grid && self.count.is_none_or(|n| n < 1) {
                    refuse("a grid needs a count", "give count = 1 or more, or values = [...]")
                } else if self.logarithmic && (from <= 0.0 || to <= 0.0) {
                    refuse("equal ratios need a range above 0", "leave logarithmic out, or give from and to above 0")
                } else if from > to {
                    refuse("from is greater than to", "swap them")
                } else {
                    Ok(())
                }
            }
            _ => refuse(
                "it is not clear what values it takes",
                "give from and to (and count in a grid), or values in a grid, or mean and sd > 0 in samples",
            ),
        }
    }

    /// The value at a place.
    #[doc(hidden)]
    pub fn value(&self, place: Place) -> f64 {
        match place {
            Place::Nth(n) if !self.values.is_empty() => self.values[n as usize],
            Place::Nth(n) => {
                let last = self.count.unwrap_or(1).saturating_sub(1);
                match self.to {
                    Some(to) if n == last && last > 0 => to,
                    _ => tidy(self.between(n as f64 / last.max(1) as f64)),
                }
            }
            Place::Share(share) => match (self.mean, self.sd) {
                (Some(mean), Some(sd)) => {
                    let inside = share.clamp(1e-12, 1.0 - 1e-12);
                    mean + sd * Normal::standard().inverse_cdf(inside)
                }
                _ => self.between(share),
            },
        }
    }

    fn between(&self, share: f64) -> f64 {
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(0.0));
        if self.logarithmic { from * (to / from).powf(share) } else { from + share * (to - from) }
    }
}

/// To twelve digits: 0.3 instead of 0.30000000000000004.
fn tidy(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}
