//! Parquet to columns.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use super::claims::Checked;
use super::{Column, NamedColumn};

/// So many rows may stand in a byte: a run of equal or of evenly increasing numbers takes next to none.
const DENSEST_ROWS_PER_BYTE: u64 = 100;

/// The columns of a Parquet file: numbers of any width, and texts. Uncompressed, or compressed by Snappy.
///
/// # Errors
/// No Parquet file, another compression, columns that are neither numbers nor texts, a damaged file.
pub fn decode(file: File) -> Result<Vec<NamedColumn>, String> {
    // On some damaged files the library panics instead of saying so.
    let read = catch_unwind(AssertUnwindSafe(|| table(file)));
    read.unwrap_or_else(|_| Err("it is damaged inside".to_owned()))
}

fn table(file: File) -> Result<Vec<NamedColumn>, String> {
    let file_bytes = file.metadata().map_err(|e| e.to_string())?.len();
    let reader = SerializedFileReader::new(Checked(file)).map_err(|e| said(&e))?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let fields = schema.root_schema().get_fields();
    if let Some(nested) = fields.iter().find(|f| f.is_group()) {
        let name = nested.name();
        return Err(format!("column \"{name}\" holds lists or records\n  remedy: leave the column out"));
    }
    let names: Vec<String> = fields.iter().map(|f| f.name().to_owned()).collect();
    let mut cells: Vec<Vec<Field>> = vec![Vec::new(); names.len()];
    let most_rows = file_bytes.saturating_mul(DENSEST_ROWS_PER_BYTE);
    for (index, row) in (0u64..).zip(reader.get_row_iter(None).map_err(|e| said(&e))?) {
        if index >= most_rows {
            return Err(format!("it claims more than {most_rows} rows in {file_bytes} bytes"));
        }
        let row = row.map_err(|e| said(&e))?;
        for (column, (_, field)) in cells.iter_mut().zip(row.get_column_iter()) {
            column.push(field.clone());
        }
    }
    names.into_iter().zip(cells).map(|(name, cells)| Ok((name.clone(), column(&name, cells)?))).collect()
}

/// What the library says, or which codec it was built without: its own words for that are of its build, not of the file.
fn said(error: &ParquetError) -> String {
    let text = error.to_string();
    match codec(&text) {
        Some(codec) => format!(
            "compressed with {codec}, which is not read here\n  remedy: write it with compression=\"snappy\" (as pandas and DuckDB do unless told otherwise; Polars writes zstd), or uncompressed"
        ),
        None => text,
    }
}

/// The codec in the library's "Disabled feature at compile time: flate2", by the name that writers give it.
fn codec(text: &str) -> Option<&str> {
    let (_, feature) = text.split_once("Disabled feature at compile time: ")?;
    Some(if feature == "flate2" { "gzip" } else { feature })
}

fn column(name: &str, cells: Vec<Field>) -> Result<Column, String> {
    let is_whole = cells.iter().all(|c| matches!(c, Field::Long(_)));
    if is_whole && !cells.is_empty() {
        let whole = |c| if let Field::Long(v) = c { v } else { 0 };
        return Ok(Column::Whole(cells.into_iter().map(whole).collect()));
    }
    if cells.iter().any(|c| matches!(c, Field::Str(_))) {
        let text = |c| match c {
            Field::Str(text) => Ok(Some(text)),
            Field::Null => Ok(None),
            other => Err(format!("column \"{name}\": {other} among texts")),
        };
        return Ok(Column::Texts(cells.into_iter().map(text).collect::<Result<_, _>>()?));
    }
    let number =
        |c| number(&c).ok_or_else(|| format!("column \"{name}\": {c} is no number\n  remedy: leave the column out"));
    Ok(Column::Numbers(cells.into_iter().map(number).collect::<Result<_, _>>()?))
}

fn number(cell: &Field) -> Option<f64> {
    Some(match *cell {
        Field::Null => f64::NAN,
        Field::Double(v) => v,
        Field::Float(v) => f64::from(v),
        Field::Byte(v) => f64::from(v),
        Field::Short(v) => f64::from(v),
        Field::Int(v) => f64::from(v),
        Field::Long(v) => v as f64,
        Field::UByte(v) => f64::from(v),
        Field::UShort(v) => f64::from(v),
        Field::UInt(v) => f64::from(v),
        Field::ULong(v) => v as f64,
        _ => return None,
    })
}
