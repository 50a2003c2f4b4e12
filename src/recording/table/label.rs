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
}
