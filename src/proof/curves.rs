//! Shares of cases along something: probabilities given, misfit left.

use super::metrics::{VISIBLE, wilson};
use super::row::Row;
use crate::conceal::Hiding;

/// How many of the cases in a bin are right.
///
/// ```
/// use smam::proof::Share;
///
/// // None of three hundred: at most 1.26 %, z^2/(n + z^2).
/// let none = Share { from: 0.0, to: 1.0, mean: 0.5, hits: 0, count: 300 };
/// let [low, high] = none.interval();
/// assert!(low == 0.0 && (high - 1.96_f64.powi(2) / (300.0 + 1.96_f64.powi(2))).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    pub from: f64,
    /// Infinity for the last bin of misfits.
    pub to: f64,
    /// Mean of what is binned.
    pub mean: f64,
    pub hits: usize,
    pub count: usize,
}

impl Share {
    pub fn value(&self) -> f64 {
        self.hits as f64 / self.count as f64
    }

    /// Wilson's 95 % interval.
    pub fn interval(&self) -> [f64; 2] {
        wilson(self.hits, self.count)
    }
}

/// Bins of the probabilities that answers give.
const PROBABILITIES: [f64; 7] = [0.0, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0 + 1e-9];
/// Edges of the bins of misfit per sample.
const MISFITS: [f64; 8] = [0.0, 0.01, 0.03, VISIBLE, 0.3, 1.0, 10.0, f64::INFINITY];

/// Probability given to an effect against the share of such that was there. Of what is not listed nothing can be.
pub fn reliability(rows: &[Row]) -> Vec<Share> {
    let listed = rows.iter().filter(|r| r.hiding != Hiding::Unlisted);
    let named = listed.flat_map(|r| r.effects.iter().map(move |e| (e.probability, r.secrets.iter().any(|s| e.is(s)))));
    shares(&PROBABILITIES, named.collect())
}

/// Misfit against the share of cases with something missing in which that is said.
pub fn detection(rows: &[Row]) -> Vec<Share> {
    let hides = rows.iter().filter(|r| r.hiding != Hiding::Nothing);
    shares(&MISFITS, hides.map(|r| (r.excess.max(0.0), r.is_detected())).collect())
}

/// Misfit against the share of cases with one effect whose first answer is that.
pub fn naming(rows: &[Row]) -> Vec<Share> {
    let one = rows.iter().filter(|r| r.hiding == Hiding::One);
    let is_right = |r: &Row| r.first().is_some_and(|e| r.secrets.iter().any(|s| e.is(s)));
    shares(&MISFITS, one.map(|r| (r.excess.max(0.0), is_right(r))).collect())
}

/// Shares by bin, empty ones with it.
fn shares(edges: &[f64], cases: Vec<(f64, bool)>) -> Vec<Share> {
    let bin = |pair: &[f64]| {
        let own: Vec<_> = cases.iter().filter(|(x, _)| *x >= pair[0] && *x < pair[1]).collect();
        Share {
            from: pair[0],
            to: pair[1],
            mean: own.iter().map(|(x, _)| x).sum::<f64>() / own.len() as f64,
            hits: own.iter().filter(|(_, hit)| *hit).count(),
            count: own.len(),
        }
    };
    edges.windows(2).map(bin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_in_one_bin() {
        let cases = vec![(0.0, true), (0.2, false), (0.95, true), (1.0, true)];
        let bins = shares(&PROBABILITIES, cases);
        assert_eq!(bins.iter().map(|b| b.count).sum::<usize>(), 4);
        assert_eq!((bins[5].hits, bins[5].count), (2, 2));
        assert!(bins[2].mean.is_nan() && bins[2].interval() == [0.0, 1.0]);
    }
}
