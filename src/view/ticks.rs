//! Round numbers along an axis.

/// At most `count + 1` round values (1, 2, 5 times a power of ten apart) within `[low, high]`.
pub(super) fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = round_step((high - low) / count.max(1) as f64);
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

/// A tick's text: as many decimals as tell neighbours apart.
pub(super) fn text(value: f64, values: &[f64]) -> String {
    let step = values.windows(2).map(|pair| pair[1] - pair[0]).next();
    let decimals = step.map_or(1, |step| (-step.log10().floor()).clamp(0.0, 9.0) as usize);
    format!("{value:.decimals$}")
}

/// `[low, high]` with a margin of 5 %; a single value gets room around it.
pub(super) fn padded(low: f64, high: f64) -> [f64; 2] {
    let width = high - low;
    let margin = if width > 0.0 { 0.05 * width } else { 0.5 * low.abs().max(1.0) };
    [low - margin, high + margin]
}

fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * power >= raw * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(-0.3, 10.2, 5), [0.0, 5.0, 10.0]);
        assert_eq!(ticks(0.0, 1.0, 5).len(), 6);
        assert_eq!(text(0.2, &[0.0, 0.2]), "0.2");
        assert_eq!(text(50.0, &[0.0, 50.0]), "50");
    }

    #[test]
    fn a_degenerate_range_has_room_but_no_endless_ticks() {
        assert_eq!(padded(2.0, 2.0), [1.0, 3.0]);
        assert!(ticks(1.0, 1.0, 5).is_empty());
        assert!(ticks(0.0, f64::NAN, 5).is_empty());
    }
}
