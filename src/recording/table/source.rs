//! Where in a table a channel is found: the keys `name`, `unit`, `scale` and `zero` of a `[[channel]]`.

use super::super::folder_keys::Keys;
use super::super::{RecordingError, Unit};
use super::file_unit::{FileUnit, file_unit, known_file_units};
use super::label::label;

/// The keys of a `[[channel]]` for tables (`unit` and `zero` are a bag's where `topic` stands beside them).
pub(in crate::recording) const TABLE_KEYS: [&str; 4] = ["name", "unit", "scale", "zero"];

/// Where a table has a channel, and how its numbers become the channel's:
/// `value = unit(scale * (number - zero))`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableSource {
    /// The column's name in the file, if it is another.
    pub name: Option<String>,
    /// Unit of the numbers, if stated.
    pub unit: Option<&'static FileUnit>,
    /// Factor upon the numbers.
    pub scale: Option<f64>,
    /// Number that counts as zero, in the file's unit.
    pub zero: Option<f64>,
}

/// Reads the keys. `column` is the unit that the channel's name ends in.
pub(in crate::recording) fn table_source(keys: &Keys<'_>, column: Unit) -> Result<TableSource, RecordingError> {
    let source = TableSource {
        name: keys.text("name")?.map(str::to_owned),
        unit: keys.text("unit")?.map(|text| unit(keys, text)).transpose()?,
        scale: keys.number("scale")?,
        zero: keys.number("zero")?,
    };
    if source.scale == Some(0.0) {
        return Err(keys.error("scale = 0 makes every number zero\n  remedy: write the factor, or leave it out"));
    }
    if let Some(unit) = source.unit {
        source.check(unit, column).map_err(|problem| keys.error(problem))?;
    }
    Ok(source)
}

fn unit(keys: &Keys<'_>, text: &str) -> Result<&'static FileUnit, RecordingError> {
    file_unit(text.trim_start_matches('_')).ok_or_else(|| {
        keys.error(format!("unit = \"{text}\" is not known\n  remedy: write one of {}", known_file_units()))
    })
}

impl TableSource {
    /// A unit of another quantity needs a factor: volts are no newtons.
    fn check(&self, unit: &FileUnit, column: Unit) -> Result<(), String> {
        if unit.si_suffix == column.si_suffix || self.scale.is_some() {
            return Ok(());
        }
        Err(format!(
            "unit = \"{}\" cannot become the column's, {}\n  remedy: give the unit of the file's numbers, or add scale = 2.5, the \
             {} of one {}",
            unit.name, column.symbol, column.symbol, unit.name
        ))
    }

    /// Puts the numbers of the file's column `header` into the unit of the channel, whose name is `column`.
    pub(super) fn convert(&self, header: &str, column: Unit, values: &mut [f64]) -> Result<(), String> {
        let stated = self.unit.or_else(|| self.name.as_ref().and_then(|_| label(header).unit));
        if let Some(unit) = stated {
            self.check(unit, column)?;
        }
        let (zero, scale) = (self.zero.unwrap_or(0.0), self.scale.unwrap_or(1.0));
        for value in values {
            let scaled = scale * (*value - zero);
            *value = match stated.filter(|unit| unit.si_suffix == column.si_suffix) {
                Some(unit) => unit.into_column(column, scaled),
                None => scaled,
            };
        }
        Ok(())
    }
}
