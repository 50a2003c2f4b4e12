//! Figures of a loop: its last period, range, width, and how far two loops lie apart.

use crate::recording::figures;

/// A closed loop: one period of an input and an output.
#[derive(Clone, Debug)]
pub struct Loop {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
}

/// Points of one way through a loop, by rising input.
type Way = Vec<(f64, f64)>;

impl Loop {
    /// The last `period_s` of a run.
    pub fn last(time_s: &[f64], x: &[f64], y: &[f64], period_s: f64) -> Self {
        let end = time_s.last().copied().unwrap_or(0.0);
        let from = time_s.partition_point(|t| *t < end - period_s - 1e-9);
        Self { x: x[from..].to_vec(), y: y[from..].to_vec() }
    }

    /// Greatest less least output.
    pub fn range(&self) -> f64 {
        figures::range(&self.y)
    }

    /// The output counted from where the input is least.
    pub fn zeroed(&self) -> Self {
        let least = self.x.iter().zip(&self.y).min_by(|a, b| a.0.total_cmp(b.0));
        let zero = least.map_or(0.0, |(_, y)| *y);
        Self { x: self.x.clone(), y: self.y.iter().map(|y| y - zero).collect() }
    }

    /// Greatest distance of the two ways, positive where the way back lies above, and the input there.
    pub fn width(&self) -> (f64, f64) {
        let (there, back) = self.ways();
        let (low, high) = (figures::least(&self.x), figures::greatest(&self.x));
        let grid = (1..200).map(|i| low + (high - low) * f64::from(i) / 200.0);
        let widths = grid.map(|x| (at(&back, x) - at(&there, x), x)).filter(|w| w.0.is_finite());
        widths.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or((f64::NAN, f64::NAN))
    }

    /// Area enclosed, in units of the output times those of the input.
    pub fn area(&self) -> f64 {
        figures::enclosed(&self.x, &self.y).abs()
    }

    /// The way up from the least input to the greatest, and the way back, both by rising input.
    fn ways(&self) -> (Way, Way) {
        let pairs: Vec<(f64, f64)> = self.x.iter().copied().zip(self.y.iter().copied()).collect();
        let way = |rising: bool| {
            let steps = pairs.windows(2).filter(|w| (w[1].0 > w[0].0) == rising && w[1].0 != w[0].0);
            let mut way: Way = steps.flat_map(|w| [w[0], w[1]]).collect();
            way.sort_by(|a, b| a.0.total_cmp(&b.0));
            way
        };
        (way(true), way(false))
    }
}

/// Straight between points that rise in x; NaN outside.
fn at(way: &[(f64, f64)], x: f64) -> f64 {
    let above = way.partition_point(|p| p.0 < x);
    if above == 0 || above == way.len() {
        return f64::NAN;
    }
    let (a, b) = (way[above - 1], way[above]);
    if b.0 > a.0 { a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0) } else { a.1 }
}

/// Root of the mean square of a difference.
pub fn rms_apart(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len()) as f64;
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n).sqrt()
}

/// Mean of `|dy/dt|`.
pub fn mean_speed(time_s: &[f64], y: &[f64]) -> f64 {
    let way: f64 = y.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    way / (time_s[time_s.len() - 1] - time_s[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `y = 3 (1 - cos) - sin/2`: 6 high, 1 wide in the middle, the way back above.
    fn ellipse() -> Loop {
        let t = (0..=400).map(|i| f64::from(i) / 400.0 * std::f64::consts::TAU);
        let (x, y) = t.map(|t| (1.0 - t.cos(), 3.0 * (1.0 - t.cos()) - 0.5 * t.sin())).unzip();
        Loop { x, y }
    }

    #[test]
    fn figures_of_an_ellipse() {
        let (width, middle) = ellipse().width();
        assert!((width - 1.0).abs() < 1e-3 && (middle - 1.0).abs() < 0.02, "{width} at {middle}");
        assert!((ellipse().area() - std::f64::consts::PI * 0.5).abs() < 1e-3);
        assert!((ellipse().range() - 6.08).abs() < 0.02);
        assert!(ellipse().zeroed().y[0].abs() < 1e-12);
    }

    #[test]
    fn speed_of_a_saw() {
        assert_eq!(mean_speed(&[0.0, 1.0, 2.0], &[0.0, 3.0, 0.0]), 3.0);
    }
}
