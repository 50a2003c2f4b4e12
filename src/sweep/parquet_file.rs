//! A table as a Parquet file.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::SweepError;
use super::table::{Table, number};

/// Writes index (int64), keys and measures (double, null where a point failed) and error (text, null where not).
/// The file appears whole or not at all.
pub fn write_parquet(table: &Table, path: &Path) -> Result<(), SweepError> {
    let failed = |source: std::io::Error| SweepError::Write { file: path.to_owned(), source };
    let bytes = encode(table).map_err(|e| failed(std::io::Error::other(e)))?;
    crate::recording::write_whole_bytes(path, &bytes).map_err(failed)
}

fn encode(table: &Table) -> Result<Vec<u8>, ParquetError> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        // Nothing of the program's version in it: the same table is the same bytes.
        .set_created_by("smam".to_owned())
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(table)?, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    let mut column = 0;
    while let Some(mut next) = group.next_column()? {
        if column == 0 {
            let index: Vec<i64> = table.rows.iter().map(|r| r.index as i64).collect();
            next.typed::<Int64Type>().write_batch(&index, None, None)?;
        } else if column < table.columns.len() {
            let all: Vec<f64> = table.rows.iter().map(|r| number(r, column - 1)).collect();
            let there: Vec<i16> = all.iter().map(|v| i16::from(v.is_finite())).collect();
            let values: Vec<f64> = all.into_iter().filter(|v| v.is_finite()).collect();
            next.typed::<DoubleType>().write_batch(&values, Some(&there), None)?;
        } else {
            let errors = table.rows.iter().map(|r| r.outcome.as_ref().err());
            let there: Vec<i16> = errors.clone().map(|e| i16::from(e.is_some())).collect();
            let values: Vec<ByteArray> = errors.flatten().map(|e| ByteArray::from(e.as_str())).collect();
            next.typed::<ByteArrayType>().write_batch(&values, Some(&there), None)?;
        }
        next.close()?;
        column += 1;
    }
    group.close()?;
    writer.into_inner()
}

fn schema(table: &Table) -> Result<Arc<Type>, ParquetError> {
    let field = |name: &str, kind: PhysicalType, repetition: Repetition| -> Result<Arc<Type>, ParquetError> {
        let mut builder = Type::primitive_type_builder(name, kind).with_repetition(repetition);
        if kind == PhysicalType::BYTE_ARRAY {
            builder = builder.with_logical_type(Some(parquet::basic::LogicalType::String));
        }
        Ok(Arc::new(builder.build()?))
    };
    let mut fields = vec![field("index", PhysicalType::INT64, Repetition::REQUIRED)?];
    for name in &table.columns[1..] {
        fields.push(field(name, PhysicalType::DOUBLE, Repetition::OPTIONAL)?);
    }
    fields.push(field("error", PhysicalType::BYTE_ARRAY, Repetition::OPTIONAL)?);
    Ok(Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?))
}
