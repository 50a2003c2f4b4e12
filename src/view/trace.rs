//! The points of a loop or of a way in space, thinned out so that a long run stays small.

/// Points of `N` numbers in the order of time, at most `capacity` of them.
#[derive(Clone, Debug)]
pub(super) struct Trace<const N: usize> {
    points: Vec<[f64; N]>,
    capacity: usize,
    stride: usize,
    seen: usize,
    range: Option<[[f64; 2]; N]>,
}

impl<const N: usize> Trace<N> {
    pub(super) fn new(capacity: usize) -> Self {
        Trace { points: Vec::new(), capacity: capacity.max(16), stride: 1, seen: 0, range: None }
    }

    /// Adds a point; points that are not finite are left out.
    pub(super) fn push(&mut self, point: [f64; N]) {
        if !point.iter().all(|value| value.is_finite()) {
            return;
        }
        self.widen(point);
        if self.seen.is_multiple_of(self.stride) {
            self.points.push(point);
        }
        self.seen += 1;
        if self.points.len() >= self.capacity {
            self.halve();
        }
    }

    pub(super) fn points(&self) -> &[[f64; N]] {
        &self.points
    }

    /// Smallest and largest value, along each axis, of all points ever added.
    pub(super) fn range(&self) -> Option<[[f64; 2]; N]> {
        self.range
    }

    fn widen(&mut self, point: [f64; N]) {
        let mut range = self.range.unwrap_or(point.map(|value| [value; 2]));
        for (bounds, value) in range.iter_mut().zip(point) {
            *bounds = [bounds[0].min(value), bounds[1].max(value)];
        }
        self.range = Some(range);
    }

    fn halve(&mut self) {
        let mut number = 0;
        self.points.retain(|_| {
            number += 1;
            number % 2 == 1
        });
        self.stride *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_stays_small_and_evenly_spaced() {
        let mut trace = Trace::new(64);
        for n in 0..10_000 {
            trace.push([f64::from(n), -f64::from(n)]);
        }
        let gaps: Vec<f64> = trace.points().windows(2).map(|p| p[1][0] - p[0][0]).collect();
        assert!((32..64).contains(&trace.points().len()));
        assert!(gaps.iter().all(|gap| *gap == gaps[0]));
        assert_eq!(trace.range(), Some([[0.0, 9999.0], [-9999.0, 0.0]]));
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut trace = Trace::new(64);
        trace.push([f64::NAN, 0.0]);
        assert!(trace.points().is_empty() && trace.range().is_none());
    }
}
