//! Stamps: a date and a time of day, or a time of day alone, in place of a number of seconds.

use chrono::{DateTime, NaiveDateTime, NaiveTime, Timelike};

/// Date and time as ISO 8601 has them (a blank in place of the T, a comma in place of the point, seconds left out), and as
/// spreadsheets of Central Europe write them. Day and month in slashes are in dispute, so they are no stamp here.
const FORMATS: [&str; 6] = [
    "%Y-%m-%dT%H:%M:%S%.f",
    "%Y-%m-%d %H:%M:%S%.f",
    "%Y-%m-%dT%H:%M",
    "%Y-%m-%d %H:%M",
    "%Y/%m/%d %H:%M:%S%.f",
    "%d.%m.%Y %H:%M:%S%.f",
];

/// What is read, for messages.
pub(in crate::recording) const READ_STAMPS: &str = "stamps are read as 2026-03-29 13:59:50.02, 29.03.2026 13:59:50.02 or 13:59:50.02, days before months and in 24 hours";

/// A moment, as a stamp gives it. Moments of different kinds have no difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Moment {
    /// Nanoseconds since 1970, with a zone.
    Zoned(i128),
    /// Nanoseconds since 1970 of a clock of unknown zone.
    Local(i128),
    /// Nanoseconds since midnight.
    OfDay(i128),
}

const DAY_NS: i128 = 86_400_000_000_000;

impl Moment {
    /// Seconds after another moment; a time of day that went back by more than half a day has passed midnight.
    pub(super) fn seconds_after(self, first: Self) -> Option<f64> {
        let nanoseconds = match (self, first) {
            (Self::Zoned(at), Self::Zoned(from)) | (Self::Local(at), Self::Local(from)) => at - from,
            (Self::OfDay(at), Self::OfDay(from)) if at - from < -DAY_NS / 2 => at - from + DAY_NS,
            (Self::OfDay(at), Self::OfDay(from)) => at - from,
            _ => return None,
        };
        // Whole milliseconds become the nearest number to them, as they would be written in seconds.
        Some(nanoseconds as f64 / 1e9)
    }
}

/// The moment of a stamp.
pub(super) fn stamp(text: &str) -> Option<Moment> {
    let text = text.trim().replace(',', ".");
    if let Ok(zoned) =
        DateTime::parse_from_rfc3339(&text).or_else(|_| DateTime::parse_from_str(&text, "%Y-%m-%d %H:%M:%S%.f%#z"))
    {
        return Some(Moment::Zoned(nanoseconds(zoned.naive_utc())));
    }
    let local = FORMATS.iter().find_map(|format| NaiveDateTime::parse_from_str(&text, format).ok());
    local.map(|at| Moment::Local(nanoseconds(at))).or_else(|| of_day(&text))
}

fn nanoseconds(at: NaiveDateTime) -> i128 {
    let utc = at.and_utc();
    i128::from(utc.timestamp()) * 1_000_000_000 + i128::from(utc.timestamp_subsec_nanos())
}

fn of_day(text: &str) -> Option<Moment> {
    let time = NaiveTime::parse_from_str(text, "%H:%M:%S%.f").ok()?;
    Some(Moment::OfDay(i128::from(time.num_seconds_from_midnight()) * 1_000_000_000 + i128::from(time.nanosecond())))
}

/// Whether a text looks like a stamp, be it one that is read or not.
pub(in crate::recording) fn is_like_a_stamp(text: &str) -> bool {
    let is_dated = ['-', '/', '.'].iter().any(|mark| text.matches(*mark).count() == 2);
    let is_of_a_stamp = |c: char| c.is_ascii_digit() || "-/.:,+ TZAMPamp".contains(c);
    text.starts_with(|c: char| c.is_ascii_digit())
        && text.chars().all(is_of_a_stamp)
        && (text.contains(':') || is_dated)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(first: &str, then: &str) -> Option<f64> {
        stamp(then)?.seconds_after(stamp(first)?)
    }

    #[test]
    fn stamps_of_one_kind_have_a_difference() {
        assert_eq!(between("2026-03-01T10:00:00Z", "2026-03-01T10:00:00.250Z"), Some(0.25));
        assert_eq!(between("2026-03-01T10:00:00+01:00", "2026-03-01T09:00:01Z"), Some(1.0));
        assert_eq!(between("2026-03-01 23:59:59,5", "2026-03-02 00:00:00,75"), Some(1.25));
        assert_eq!(between("01.03.2026 10:00:00", "01.03.2026 10:01:00.01"), Some(60.01));
        assert_eq!(between("23:59:59.9", "00:00:00.1"), Some(0.2));
        assert_eq!(between("2026-03-01T10:00", "2026-03-01T10:01"), Some(60.0));
    }

    #[test]
    fn what_has_no_difference_is_none() {
        assert_eq!(between("2026-03-01T10:00:00Z", "2026-03-01T10:00:01"), None);
        for text in ["", "10", "3/4/2026 10:00:00", "2026-13-01T10:00:00", "25:00:00", "noon"] {
            assert_eq!(stamp(text), None, "{text}");
        }
    }
}
