//! What a header says of its column: `Pressure [bar]` is a quantity and a unit.

use super::file_unit::{FileUnit, file_unit};

/// A header's text taken apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The text without its unit: `Pressure`.
    pub quantity: String,
    /// The unit that it states.
    pub unit: Option<&'static FileUnit>,
}

/// Takes a header's text apart. Units stand in brackets, behind a slash, a comma or an underscore, or as a last word.
///
/// ```
/// use smam::recording::label;
///
/// for text in ["Force [N]", "Force (N)", "Force / N", "Force, N", "force_n", "Force in N", "Force N"] {
///     let label = label(text);
///     assert_eq!((label.quantity.to_lowercase().as_str(), label.unit.map(|u| u.name)), ("force", Some("N")), "{text}");
/// }
/// // No unit: a word of its own is none.
/// assert_eq!(label("in").unit, None);
/// ```
pub fn label(text: &str) -> Label {
    let text = text.trim();
    in_brackets(text)
        .or_else(|| behind(text, '/'))
        .or_else(|| behind(text, ','))
        .or_else(|| after_underscore(text))
        .or_else(|| last_word(text))
        .unwrap_or_else(|| Label { quantity: text.to_owned(), unit: None })
}

/// The text in a unit's place that is no known unit: `steps` of `Plunger [steps]`. Round brackets may hold any remark, so there it must
/// look like a unit.
pub(in crate::recording) fn unread_unit(text: &str) -> Option<&str> {
    let text = text.trim();
    let close = text.chars().last()?;
    let open = match close {
        ']' => '[',
        ')' => '(',
        _ => return None,
    };
    let at = text.rfind(open).filter(|at| !text[..*at].trim().is_empty())?;
    let inside = text[at + 1..text.len() - 1].trim();
    let is_unit = close == ']' || is_like_a_unit(inside);
    (is_unit && is_unread(inside)).then_some(inside)
}

/// Whether a text in the place of a unit says one that is not known; a dash or a one says that there is none.
pub(in crate::recording) fn is_unread(text: &str) -> bool {
    !matches!(text, "" | "-" | "--" | "1") && file_unit(text).is_none()
}

/// Counts of devices that have no size of their own.
const COUNTS: [&str; 10] =
    ["step", "steps", "count", "counts", "digit", "digits", "pulse", "pulses", "increments", "lsb"];

fn is_like_a_unit(text: &str) -> bool {
    let is_word = |word: &str| COUNTS.contains(&word.to_lowercase().as_str()) || word == "at";
    let begins = |mark: char| text.split(mark).next().is_some_and(|first| file_unit(first).is_some());
    is_word(text) || begins('/') || begins(' ')
}

fn found(quantity: &str, unit: &str) -> Option<Label> {
    let unit = file_unit(unit)?;
    let quantity = quantity.trim().trim_end_matches([':', '_', '-']).trim();
    (!quantity.is_empty()).then(|| Label { quantity: quantity.to_owned(), unit: Some(unit) })
}

fn in_brackets(text: &str) -> Option<Label> {
    let close = text.chars().last().filter(|c| matches!(c, ']' | ')' | '}'))?;
    let open = match close {
        ']' => '[',
        ')' => '(',
        _ => '{',
    };
    let at = text.rfind(open)?;
    found(&text[..at], &text[at + 1..text.len() - 1])
}

fn behind(text: &str, mark: char) -> Option<Label> {
    let (quantity, unit) = text.split_once(mark)?;
    found(quantity, unit)
}

/// The longest unit behind an underscore: `rate_deg_s` is degrees per second.
fn after_underscore(text: &str) -> Option<Label> {
    let marks = text.match_indices('_').map(|(at, _)| at);
    marks.into_iter().find_map(|at| found(&text[..at], &text[at + 1..]))
}

fn last_word(text: &str) -> Option<Label> {
    let (quantity, unit) = text.rsplit_once(char::is_whitespace)?;
    let quantity = quantity.trim_end().strip_suffix(" in").unwrap_or(quantity);
    found(quantity, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_no_unit_stay_with_the_quantity() {
        for text in ["Motor position", "Test (left)", "a_b", "", "Run 3/4", "[bar]"] {
            assert_eq!(label(text), Label { quantity: text.to_owned(), unit: None }, "{text}");
        }
        assert_eq!(label("drive_deg_s").unit.map(|u| u.name), Some("deg/s"));
        assert_eq!(label("Weg µm").unit.map(|u| u.name), Some("um"));
        assert_eq!(label("Winkel [°]").quantity, "Winkel");
    }

    #[test]
    fn what_stands_in_a_units_place_and_is_none() {
        for (text, unit) in [
            ("Plunger [steps]", Some("steps")),
            ("Plunger (steps)", Some("steps")),
            ("Pressure [bar a]", Some("bar a")),
            ("Pressure (bar abs)", Some("bar abs")),
            ("Pressure [at]", Some("at")),
            ("Stress (N/furlong)", Some("N/furlong")),
            ("Pressure [N/mm²]", None),
            ("Pressure [atm]", None),
            ("Test (left)", None),
            ("Share [-]", None),
            ("[steps]", None),
            ("plunger_mm", None),
        ] {
            assert_eq!(unread_unit(text), unit, "{text}");
        }
    }
}
