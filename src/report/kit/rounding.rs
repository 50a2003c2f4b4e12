//! Numbers on their way into a page: as they were recorded; what was computed, with no more digits than anybody can measure.

use serde::Serializer;
use serde::ser::SerializeSeq;

/// Decimal places that resolve a hundred-millionth of the range of some values; all of them where they are all the same.
fn places(values: &[f64]) -> i32 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let range = finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min);
    if range > 0.0 { 8 - range.log10().ceil() as i32 } else { i32::MAX }
}

/// Numbers of so many digits stay as they are: an instrument may have written them.
const RECORDED_DIGITS: usize = 9;

/// Significant digits that a number is written with.
fn digits(value: f64) -> usize {
    let text = format!("{value:e}");
    text.bytes().take_while(|c| *c != b'e').filter(u8::is_ascii_digit).count()
}

/// A value to so many decimal places, unless it was recorded so.
fn to_places(value: f64, places: i32) -> f64 {
    // Powers of ten beyond this one are no exact numbers, and a division by them would leave more digits than before.
    if !(0..=22).contains(&places) || digits(value) <= RECORDED_DIGITS {
        return value;
    }
    let power = 10f64.powi(places);
    let rounded = (value * power).round() / power;
    // -0.0 is printed with its sign.
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Writes values to a hundred-millionth of their range, recorded ones as they are; what is not finite as null.
pub(super) fn rounded<S: Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
    write(values, places(values), to)
}

/// Writes times to the nanosecond.
pub(super) fn nanoseconds<S: Serializer>(times_s: &[f64], to: S) -> Result<S::Ok, S::Error> {
    write(times_s, 9, to)
}

fn write<S: Serializer>(values: &[f64], places: i32, to: S) -> Result<S::Ok, S::Error> {
    let mut list = to.serialize_seq(Some(values.len()))?;
    for value in values {
        let value = to_places(*value, places);
        if value.fract() == 0.0 && value.abs() < 1e15 {
            // `3`, not `3.0`.
            list.serialize_element(&(value as i64))?;
        } else {
            list.serialize_element(&value)?;
        }
    }
    list.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(values: &[f64]) -> String {
        let mut bytes = Vec::new();
        rounded(values, &mut serde_json::Serializer::new(&mut bytes)).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn what_was_recorded_stays_as_it_was_and_what_was_computed_is_cut() {
        assert_eq!(text(&[0.0, 0.3066, 27.5, f64::NAN]), "[0,0.3066,27.5,null]");
        assert_eq!(text(&[-3.02716, 2500.125]), "[-3.02716,2500.125]");
        assert_eq!(text(&[0.1 + 0.2, 1.0 / 3.0, -1.234_567_890_12e-12]), "[0.3,0.33333333,0]");
        assert_eq!(text(&[2.5e-17, 5e-17]), "[2.5e-17,5e-17]");
        assert_eq!(text(&[1.0 / 3.0; 2]), "[0.3333333333333333,0.3333333333333333]");
        assert_eq!(text(&[3e20, 1.0]), "[3e20,1]".replace("3e20", "3e+20"));
    }
}
