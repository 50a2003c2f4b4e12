//! The size of an effect that brings a wanted figure.

use super::ReproduceError;

/// Finds `size` in `[low, high]` with `figure(size) = wanted` (regula falsi, Illinois), to 0.01 % of the bracket's
/// figures; none where the ends of the bracket lie on one side of it.
pub fn size_for(
    wanted: f64,
    (mut low, mut high): (f64, f64),
    mut figure: impl FnMut(f64) -> Result<f64, ReproduceError>,
) -> Result<Option<f64>, ReproduceError> {
    let (mut at_low, mut at_high) = (figure(low)? - wanted, figure(high)? - wanted);
    if at_low * at_high > 0.0 {
        return Ok(None);
    }
    let close = 1e-4 * (at_high - at_low).abs();
    for _ in 0..30 {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let value = figure(middle)? - wanted;
        if value.abs() <= close {
            return Ok(Some(middle));
        }
        if value * at_high < 0.0 {
            (low, at_low) = (high, at_high);
        } else {
            // The end that stays twice counts half: else the other one creeps.
            at_low *= 0.5;
        }
        (high, at_high) = (middle, value);
    }
    Ok(Some(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_square_root_and_says_when_there_is_none() {
        let found = size_for(2.0, (0.0, 10.0), |x| Ok(x * x)).expect("no error");
        assert!((found.expect("a root") - 2.0f64.sqrt()).abs() < 0.05);
        assert_eq!(size_for(-1.0, (0.0, 10.0), |x| Ok(x * x)).expect("no error"), None);
    }
}
