//! How a file is laid out, as far as it says so itself or `recordings.toml` does.

use encoding_rs::Encoding;

use super::file_unit::{FileUnit, file_unit};
use crate::recording::TIME_COLUMN;

/// What separates the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// One character; cells may be quoted.
    Character(u8),
    /// Any number of blanks and tabs.
    Blanks,
}

/// Where the names of the columns stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Header {
    /// In a line of the file, counted from 1.
    Line(usize),
    /// Nowhere in the file: [`FileOptions::names`] has them.
    Absent,
}

/// Where the time of a row comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TimeSource {
    /// A column of the file.
    #[default]
    Column,
    /// Rows at this interval, s: a clock that was even and was not written down.
    Interval(f64),
    /// The row's number times a stand-in interval, s: the order is known, the pace is not.
    Index(f64),
}

/// How a table is laid out. `None` means that the file decides, else what [`Self::default`] stands for: UTF-8, commas, points, names in
/// the first line that is neither blank nor a comment, the time in seconds in `time_s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileOptions {
    /// Of the text; a byte order mark outranks it.
    pub encoding: Option<&'static Encoding>,
    /// Between cells.
    pub delimiter: Option<Delimiter>,
    /// Decimal mark.
    pub decimal: Option<char>,
    /// Mark between groups of three digits.
    pub thousands: Option<char>,
    /// Lines at the top that do not belong to the table.
    pub skip_rows: usize,
    /// Rows at the end that are no samples: means, extremes, a closing remark.
    pub skip_last_rows: usize,
    /// Where the names of the columns are.
    pub header: Option<Header>,
    /// Names of the columns where the file has none.
    pub names: Vec<String>,
    /// The row below the names holds units.
    pub units_row: bool,
    /// Texts for a missing sample, besides the usual ones.
    pub missing: Vec<String>,
    /// Sheet of a workbook; the first one otherwise.
    pub sheet: Option<String>,
    /// Name of the time column.
    pub time_column: Option<String>,
    /// Unit of the time; what the column's name says otherwise, else seconds.
    pub time_unit: Option<&'static FileUnit>,
    /// Where the time comes from.
    pub time: TimeSource,
    /// A clock that goes back begins a new part of the run.
    pub split_at_restart: bool,
    /// Rows of one stamp become one, their mean.
    pub merge_repeated: bool,
}

/// Words for delimiters that cannot be seen.
const DELIMITER_WORDS: [(&str, Delimiter); 6] = [
    ("comma", Delimiter::Character(b',')),
    ("semicolon", Delimiter::Character(b';')),
    ("tab", Delimiter::Character(b'\t')),
    ("bar", Delimiter::Character(b'|')),
    ("blanks", Delimiter::Blanks),
    (" ", Delimiter::Blanks),
];

impl Delimiter {
    /// The delimiter that a text of `recordings.toml` means.
    pub fn of(text: &str) -> Option<Self> {
        let word = DELIMITER_WORDS.iter().find(|(word, _)| *word == text).map(|(_, delimiter)| *delimiter);
        word.or(match text.as_bytes() {
            [one @ (b',' | b';' | b'\t' | b'|' | b':')] => Some(Self::Character(*one)),
            _ => None,
        })
    }

    /// How `recordings.toml` writes it.
    pub fn word(self) -> String {
        match self {
            Self::Blanks => "blanks".to_owned(),
            Self::Character(b'\t') => "tab".to_owned(),
            Self::Character(other) => char::from(other).to_string(),
        }
    }
}

impl FileOptions {
    pub(super) fn delimiter(&self) -> Delimiter {
        self.delimiter.unwrap_or(Delimiter::Character(b','))
    }

    pub(super) fn decimal_mark(&self) -> char {
        self.decimal.unwrap_or('.')
    }

    /// The name of the time column.
    pub(crate) fn time_name(&self) -> &str {
        self.time_column.as_deref().unwrap_or(TIME_COLUMN)
    }

    /// Whether rows are only counted (`time = "index"`).
    pub(crate) fn counts_rows(&self) -> bool {
        matches!(self.time, TimeSource::Index(_))
    }

    /// Whether the time of a row is in the file.
    pub(super) fn has_clock(&self) -> bool {
        self.time == TimeSource::Column
    }
}

/// Units of time, as `time_unit` takes them.
pub(in crate::recording) const TIME_UNITS: [&str; 7] = ["s", "ms", "us", "ns", "min", "h", "day"];

/// Seconds of a time in a unit. Divided where that is exact: 30 ms are 0.03 s to the last bit.
pub(super) fn seconds(unit: &FileUnit, value: f64) -> f64 {
    if unit.factor < 1.0 { value / (1.0 / unit.factor).round() } else { value * unit.factor }
}

/// A unit of time by its name.
pub(in crate::recording) fn time_unit(text: &str) -> Option<&'static FileUnit> {
    file_unit(text).filter(|unit| unit.si_suffix == "s")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_what_would_have_been_written() {
        for ms in 0..10_000 {
            let written: f64 = format!("{}.{:03}", ms / 1000, ms % 1000).parse().unwrap();
            assert_eq!(seconds(time_unit("ms").unwrap(), f64::from(ms)), written);
        }
        assert_eq!(seconds(time_unit("us").unwrap(), 250.0), 250e-6);
        assert_eq!(seconds(time_unit("min").unwrap(), 0.5), 30.0);
        assert!(TIME_UNITS.iter().all(|name| time_unit(name).is_some_and(|unit| unit.name == *name)));
    }

    #[test]
    fn a_delimiter_is_written_as_it_is_read() {
        for text in [",", ";", "tab", "|", "blanks"] {
            assert_eq!(Delimiter::of(text).map(Delimiter::word).as_deref(), Some(text));
        }
        assert_eq!(Delimiter::of("\t"), Delimiter::of("tab"));
        assert_eq!(Delimiter::of("x"), None);
    }
}
