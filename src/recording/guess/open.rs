//! What a file cannot say: how its numbers become those of a channel whose unit is another quantity's, or none that is known.

use super::super::parse_column;
use super::super::table::file_unit;
use super::GuessedColumn;

/// How a value begins that a user has to write in the place of it.
pub(in crate::recording) const TO_FILL_IN: &str = "to be filled in";

impl GuessedColumn {
    /// What has to be filled in before the column can be read: `the mm of one V`.
    #[doc(hidden)]
    pub fn open_point(&self) -> Option<String> {
        let (wanted, _) = self.channel.as_ref()?;
        let own = parse_column(&wanted.column).ok()?.unit;
        match (&self.unread_unit, self.unit) {
            (Some(text), _) => Some(format!("the {} of one \"{text}\"", own.symbol)),
            (None, Some(unit)) if unit.si_suffix != own.si_suffix => {
                Some(format!("the {} of one {}", own.symbol, unit.name))
            }
            _ => None,
        }
    }
}

/// The key that keeps a recording from being read until the number stands in its place.
pub(super) fn scale_line(point: &str) -> String {
    // Quotes inside would end the text.
    format!("scale = \"{TO_FILL_IN}: {}\"\n", point.replace('"', ""))
}

/// What a text that is no known unit may be.
pub(super) fn comment(text: &str) -> String {
    let known = text.split_whitespace().next().and_then(file_unit).filter(|unit| unit.si_suffix == "pa");
    let absolute = known.map_or(String::new(), |unit| {
        format!(" If it is absolute pressure: unit = \"{}\" and zero = {:.7}.", unit.name, 101_325.0 / unit.factor)
    });
    // Of one line, whatever stands in the file.
    let text: String = text.chars().filter(|c| !c.is_control()).collect();
    format!(
        "# Its unit, \"{text}\", is none that is known. Write a known one, unit = \"...\", in the place of scale, or the factor.{absolute}\n"
    )
}
