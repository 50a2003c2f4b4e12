//! Columns to Parquet.

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
    let properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        // Nothing of the program's version in it: the same table is the same bytes.
        .set_created_by("smam".to_owned())
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(table)?, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (_, column) in table {
        if let Some(mut next) = group.next_column()? {
            fill(column, &mut next)?;
            next.close()?;
        }
    }
    group.close()?;
    writer.into_inner()
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
