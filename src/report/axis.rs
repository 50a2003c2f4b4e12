//! Axes: range, ticks at round numbers, and how the numbers print.

/// A stretch of numbers with ticks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    step: f64,
}

impl Axis {
    /// An axis over all finite values, with a margin (a share of the range) at both ends and about
    /// `tick_count` ticks.
    pub(super) fn over(values: impl Iterator<Item = f64>, margin: f64, tick_count: usize) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|v| v.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // A constant signal gets room around it; so does one that varies by rounding errors only.
        let smallest = 1e-9 * low.abs().max(high.abs());
        if high - low <= smallest {
            let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
            (low, high) = (low - half, high + half);
        }
        let room = margin * (high - low);
        let (low, high) = (low - room, high + room);
        let mut step = round_step((high - low) / tick_count.max(1) as f64);
        // Rounding up can leave a single tick, from which no scale can be read.
        for _ in 0..3 {
            if (high / step).floor() - (low / step).ceil() < 2.0 {
                // Below 0.4 by more than rounding errors: the next smaller of the round steps.
                step = round_step(0.39 * step);
            }
        }
        Self { low, high, step }
    }

    /// Where a value lies on the axis: 0 at `low`, 1 at `high`.
    pub(super) fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The ticks and their texts.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let first = (self.low / self.step).ceil() as i64;
        let last = (self.high / self.step).floor() as i64;
        (first..=last)
            .map(|index| {
                let value = index as f64 * self.step;
                (value, self.text(value))
            })
            .collect()
    }

    fn text(&self, value: f64) -> String {
        let largest = self.low.abs().max(self.high.abs());
        if !(1e-3..1e5).contains(&largest) {
            let digits = (largest.log10().floor() - self.step.log10().floor()).max(0.0) as usize;
            return if value == 0.0 { "0".to_owned() } else { format!("{value:.digits$e}") };
        }
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    }
}

/// The next of 1, 2, 5, 10, 20 ... at or above a step.
fn round_step(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    let rounded = [1.0, 2.0, 5.0].into_iter().find(|m| m * decade >= step);
    rounded.unwrap_or(10.0) * decade
}

/// A number with three significant digits, for text: `0.0213`, `12.5`, `1830`.
pub(super) fn three_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&magnitude) {
        return format!("{value:.2e}");
    }
    format!("{value:.*}", (2.0 - magnitude).max(0.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64, count: usize) -> Vec<String> {
        let axis = Axis::over([low, high].into_iter(), 0.0, count);
        axis.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(texts(0.0, 42.0, 5), ["0", "10", "20", "30", "40"]);
        assert_eq!(texts(-0.07, 0.06, 4), ["-0.05", "0.00", "0.05"]);
        assert_eq!(texts(-0.3, 0.19, 2), ["-0.2", "-0.1", "0.0", "0.1"]);
        assert_eq!(texts(0.0, 2.4e6, 3), ["0", "1e6", "2e6"]);
        assert_eq!(texts(1830.0, 1835.0, 5), ["1830", "1831", "1832", "1833", "1834", "1835"]);
    }

    #[test]
    fn constant_and_absent_values_have_an_axis() {
        for values in [vec![], vec![f64::NAN], vec![0.0, 0.0], vec![7.0], vec![1e5, 1e5]] {
            let axis = Axis::over(values.iter().copied(), 0.05, 4);
            assert!(axis.low < axis.high, "{values:?}");
            assert!((2..12).contains(&axis.ticks().len()), "{values:?}");
        }
    }

    #[test]
    fn three_digits_are_kept() {
        let texts = [0.021_34, 12.54, 1830.4, 0.0, 3e-9].map(three_digits);
        assert_eq!(texts, ["0.0213", "12.5", "1830", "0", "3.00e-9"]);
    }
}
