//! The size of an effect that brings a wanted figure.

use super::ReproduceError;

/// Finds `size` in `[low, high]` with `figure(size) = wanted` (regula falsi, Illinois), to 0.01 % of the bracket's
/// figures; none where the ends of the bracket lie on one side of it,
/// or the search does not settle.
pub fn size_for(
    wanted: f64,
    (mut low, mut high): (f64, f64),
    mut figure: impl FnMut(f64) -> Result<f64, ReproduceError>,
) -> Result<Option<f64>, ReproduceError> {
    let (mut at_low, mut at_high) = (figure(low)? - wanted, figure(high)? - wanted);
    for (end, error) in [(low, at_low), (high, at_high)] {
        if error == 0.0 {
            return Ok(Some(end));
        }
    }
    // Not `> 0`: a figure that is no number has no size either.
    let is_bracket = at_low * at_high < 0.0;
    if !is_bracket {
        return Ok(None);
    }
    let close = 1e-4 * (at_high - at_low).abs();
    for _ in 0..60 {
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
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_square_root_and_says_when_there_is_none() {
        let found = size_for(2.0, (0.0, 10.0), |x| Ok(x * x)).expect("no error");
        assert!((found.expect("a root") - 2.0f64.sqrt()).abs() < 0.05);
        assert_eq!(size_for(-1.0, (0.0, 10.0), |x| Ok(x * x)).expect("no error"), None);
        assert_eq!(size_for(1.0, (0.0, 10.0), |_| Ok(f64::NAN)).expect("no error"), None);
        assert_eq!(size_for(0.0, (0.0, 0.0), Ok).expect("no error"), Some(0.0));
    }
}
