//! Columns to Parquet.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::{Column, NamedColumn};

/// Columns of equal length as the bytes of a Parquet file: int64, double and text, null where there is no value.
///
/// # Errors
/// What the Parquet library says.
pub fn encode(table: &[NamedColumn]) -> Result<Vec<u8>, String> {
    bytes(table).map_err(|e| e.to_string())
}

fn bytes(table: &[NamedColumn]) -> Result<Vec<u8>, ParquetError> {
    let mut writer = begin(Vec::new(), table)?;
    put_group(&mut writer, table)?;
    writer.into_inner()
}

fn begin<W: Write + Send>(target: W, table: &[NamedColumn]) -> Result<SerializedFileWriter<W>, ParquetError> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        // Nothing of the program's version in it: the same table is the same bytes.
        .set_created_by("smam".to_owned())
        .build();
    SerializedFileWriter::new(target, schema(table)?, Arc::new(properties))
}

fn put_group<W: Write + Send>(writer: &mut SerializedFileWriter<W>, table: &[NamedColumn]) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (_, column) in table {
        if let Some(mut next) = group.next_column()? {
            fill(column, &mut next)?;
            next.close()?;
        }
    }
    group.close()?;
    Ok(())
}

/// Rows that are held before they go to the file together.
const ROWS_OF_A_GROUP: usize = 1 << 16;

/// Writes a table of numbers row by row; memory does not grow with the rows.
///
/// ```
/// use smam::columns::{NumberRows, decode};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut rows = NumberRows::new(tempfile::tempfile()?, &["time_s", "force_n"])?;
/// rows.row(&[0.0, 0.05])?;
/// rows.row(&[0.01, f64::NAN])?;
/// let mut file = rows.finish()?;
/// std::io::Seek::rewind(&mut file)?;
/// assert_eq!(decode(file)?[0].1.numbers(), Some(vec![0.0, 0.01]));
/// # Ok(())
/// # }
/// ```
pub struct NumberRows<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    /// Rows that are not in the file yet.
    held: Vec<(String, Vec<f64>)>,
    has_group: bool,
}

impl<W: Write + Send> NumberRows<W> {
    /// Begins a file with these columns.
    ///
    /// # Errors
    /// What the target says.
    pub fn new(target: W, columns: &[&str]) -> io::Result<Self> {
        let held: Vec<(String, Vec<f64>)> = columns.iter().map(|name| ((*name).to_owned(), Vec::new())).collect();
        let writer = begin(target, &table(held.clone())).map_err(io_error)?;
        Ok(Self { writer, held, has_group: false })
    }

    /// One number for each column; NaN where there is none.
    ///
    /// # Errors
    /// What the target says.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.held.iter_mut().zip(values).for_each(|((_, column), value)| column.push(*value));
        if self.held.first().is_some_and(|(_, column)| column.len() >= ROWS_OF_A_GROUP) { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        let rows = self.held.iter_mut().map(|(name, column)| (name.clone(), std::mem::take(column))).collect();
        self.has_group = true;
        put_group(&mut self.writer, &table(rows)).map_err(io_error)
    }

    /// Ends the file and gives the target back.
    ///
    /// # Errors
    /// What the target says.
    pub fn finish(mut self) -> io::Result<W> {
        if !self.has_group || self.held.iter().any(|(_, column)| !column.is_empty()) {
            self.flush()?;
        }
        self.writer.into_inner().map_err(io_error)
    }
}

fn table(columns: Vec<(String, Vec<f64>)>) -> Vec<NamedColumn> {
    columns.into_iter().map(|(name, values)| (name, Column::Numbers(values))).collect()
}

/// A full disk stays one.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(source) => *source,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

fn fill(column: &Column, writer: &mut SerializedColumnWriter) -> Result<usize, ParquetError> {
    match column {
        Column::Whole(values) => writer.typed::<Int64Type>().write_batch(values, None, None),
        Column::Numbers(all) => {
            let there: Vec<i16> = all.iter().map(|v| i16::from(!v.is_nan())).collect();
            let values: Vec<f64> = all.iter().copied().filter(|v| !v.is_nan()).collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&there), None)
        }
        Column::Texts(all) => {
            let there: Vec<i16> = all.iter().map(|v| i16::from(v.is_some())).collect();
            let values: Vec<ByteArray> = all.iter().flatten().map(|v| ByteArray::from(v.as_str())).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&there), None)
        }
    }
}

fn schema(table: &[NamedColumn]) -> Result<Arc<Type>, ParquetError> {
    let field = |(name, column): &NamedColumn| -> Result<Arc<Type>, ParquetError> {
        let (kind, repetition) = match column {
            Column::Whole(_) => (Physical::INT64, Repetition::REQUIRED),
            Column::Numbers(_) => (Physical::DOUBLE, Repetition::OPTIONAL),
            Column::Texts(_) => (Physical::BYTE_ARRAY, Repetition::OPTIONAL),
        };
        let mut builder = Type::primitive_type_builder(name, kind).with_repetition(repetition);
        if kind == Physical::BYTE_ARRAY {
            builder = builder.with_logical_type(Some(LogicalType::String));
        }
        Ok(Arc::new(builder.build()?))
    };
    let fields = table.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Ok(Arc::new(Type::group_type_builder("table").with_fields(fields).build()?))
}
