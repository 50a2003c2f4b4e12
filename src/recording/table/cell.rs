//! One cell of a table: a number, a moment, or nothing.

use super::options::FileOptions;
use super::stamp::{READ_STAMPS, is_like_a_stamp};

/// A cell as its file holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell<'a> {
    Text(&'a str),
    Number(f64),
    /// Seconds since a moment of the format's own (spreadsheets).
    Moment(f64),
}

impl Cell<'_> {
    pub(super) fn is_empty(&self) -> bool {
        matches!(self, Self::Text(text) if text.trim().is_empty())
    }

    /// Its text, for a header.
    pub(super) fn words(&self) -> String {
        match self {
            Self::Text(text) => text.trim().to_owned(),
            Self::Number(number) | Self::Moment(number) => number.to_string(),
        }
    }
}

/// Texts that stand for a missing sample, whatever their case.
const MISSING: [&str; 15] = [
    "nan", "n.a.", "n/a", "na", "#n/a", "#nv", "#num!", "#div/0!", "#value!", "null", "none", "missing", "-", "--",
    "---",
];

/// Whether a text stands for a missing sample.
pub(super) fn is_missing(text: &str, options: &FileOptions) -> bool {
    let is = |mark: &str| text.eq_ignore_ascii_case(mark);
    text.is_empty() || MISSING.iter().any(|mark| is(mark)) || options.missing.iter().any(|mark| is(mark))
}

/// The number of a text, NaN where it is missing.
pub(super) fn number(text: &str, options: &FileOptions) -> Result<f64, String> {
    let text = text.trim();
    if is_missing(text, options) {
        return Ok(f64::NAN);
    }
    // Word processors and some spreadsheets write the mathematical minus.
    let signed = text.strip_prefix('\u{2212}').map_or_else(|| text.to_owned(), |digits| format!("-{digits}"));
    match plain(&signed, options).and_then(|plain| plain.parse::<f64>().ok()) {
        Some(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{} is not a finite number\n  remedy: {}", shown(text), remedy(text, options))),
    }
}

/// A text with a point as decimal mark and no other, or `None` where its marks do not stand as they should.
fn plain(text: &str, options: &FileOptions) -> Option<String> {
    let decimal = options.decimal_mark();
    let Some(thousands) = options.thousands else {
        return match decimal {
            '.' => Some(text.to_owned()),
            _ => (!text.contains('.')).then(|| text.replace(decimal, ".")),
        };
    };
    // Where one mark is both, the last one is the decimal mark: 1.203.000 is 1203.
    let at = text.rfind(decimal);
    let (whole, rest) = at.map_or((text, ""), |at| (&text[..at], &text[at + decimal.len_utf8()..]));
    let groups: Vec<&str> = whole.split(thousands).collect();
    let are_three = groups[1..].iter().all(|g| g.len() == 3 && g.bytes().all(|b| b.is_ascii_digit()));
    let is_led_by_zero = groups.len() > 1 && groups[0].trim_start_matches(['-', '+']).starts_with('0');
    (are_three && !is_led_by_zero && !rest.contains(thousands)).then(|| match at {
        None => groups.concat(),
        Some(_) => format!("{}.{rest}", groups.concat()),
    })
}

/// What to write in place of a cell that is no number.
fn remedy(text: &str, options: &FileOptions) -> String {
    let with_point = text.replace(',', ".");
    let is_number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
    if is_formula(text) {
        return "this formula has no saved value: open the file in a spreadsheet program, let it calculate, and save it".to_owned();
    }
    let marks = text.bytes().filter(|b| matches!(b, b'.' | b',')).count();
    let bare: String = text.chars().filter(|c| !matches!(c, '.' | ',' | '\'' | ' ')).collect();
    if options.decimal_mark() == '.' && text.contains(',') && is_number(&with_point) {
        format!("write decimals with a point: {with_point}; or say decimal = \",\" in recordings.toml")
    } else if options.decimal_mark() == ',' && is_number(text) {
        "write decimals with a comma throughout, or say decimal = \".\" in recordings.toml".to_owned()
    } else if marks > 1 && is_number(&bare) {
        "leave thousands marks out, or say thousands = \".\" (or \",\") in recordings.toml".to_owned()
    } else if is_like_a_stamp(text) {
        format!(
            "give the time in seconds as a number, counted from the first row or from any other moment; {READ_STAMPS}"
        )
    } else if !text.contains(|c: char| c.is_ascii_digit()) {
        format!(
            "write a number with a point as decimal mark, or leave the cell empty where the sample is missing; if {} marks missing samples, \
             say missing = [{}] in recordings.toml",
            shown(text),
            shown(text)
        )
    } else {
        "write a number with a point as decimal mark, or leave the cell empty where the sample is missing".to_owned()
    }
}

/// Whether a cell holds a formula in the place of its value.
pub(in crate::recording) fn is_formula(text: &str) -> bool {
    text.len() > 1 && text.starts_with('=')
}

/// A cell as an error shows it: its beginning (an open quote takes in the rest of the file), with what cannot be seen escaped.
pub(super) fn shown(cell: &str) -> String {
    const LONGEST: usize = 40;
    let beginning: String = cell.chars().take(LONGEST).collect();
    let more = if beginning.len() < cell.len() { "..." } else { "" };
    format!("{beginning:?}{more}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(decimal: char, thousands: Option<char>) -> FileOptions {
        FileOptions { decimal: Some(decimal), thousands, ..FileOptions::default() }
    }

    #[test]
    fn marks_are_read_as_declared() {
        assert_eq!(number("1,5", &with(',', None)), Ok(1.5));
        assert_eq!(number("-1.234.567,5", &with(',', Some('.'))), Ok(-1_234_567.5));
        assert_eq!(number("1,234.5", &with('.', Some(','))), Ok(1234.5));
        assert_eq!(number("1 234", &with('.', Some(' '))), Ok(1234.0));
        // A mark that is both: the last is the decimal one.
        assert_eq!(number("1.203.000", &with('.', Some('.'))), Ok(1203.0));
        assert_eq!(number("950.000", &with('.', Some('.'))), Ok(950.0));
    }

    /// A mark in the wrong place is a mistake, never another number.
    #[test]
    fn marks_out_of_place_are_refused() {
        for (text, options) in [
            ("1.5", with(',', None)),
            ("1,5", with('.', None)),
            ("1.23,5", with(',', Some('.'))),
            ("1,5.000", with(',', Some('.'))),
            ("0.523", with(',', Some('.'))),
            ("1.203.000", with('.', None)),
            ("inf", with('.', None)),
            ("", with('.', None)),
        ] {
            let read = number(text, &options);
            assert_eq!(read.is_ok(), text.is_empty(), "{text}: {read:?}");
        }
    }

    #[test]
    fn marks_of_missing_samples() {
        let options = FileOptions { missing: vec!["over".to_owned()], ..FileOptions::default() };
        for text in ["", " ", "NaN", "n.a.", "N/A", "-", "#N/A", "OVER"] {
            assert!(number(text, &options).is_ok_and(f64::is_nan), "{text}");
        }
        let said = number("over", &FileOptions::default()).unwrap_err();
        assert!(said.contains("missing = [\"over\"]"), "{said}");
        let formula = number("=C2*80", &options).unwrap_err();
        assert!(formula.contains("remedy: this formula has no saved value"), "{formula}");
    }

    #[test]
    fn the_mathematical_minus_is_one() {
        assert_eq!(number("\u{2212}41,5", &with(',', None)), Ok(-41.5));
        assert!(number("4\u{2212}1", &with('.', None)).is_err());
    }
}
