//! A table as a Parquet file, and back.

use std::fs::File;
use std::path::Path;

use super::SweepError;
use super::plan::Plan;
use super::point::Row;
use super::table::{Table, number};
use crate::columns::{Column, NamedColumn, decode, encode};
use crate::system::ConcernsS;

/// Writes index (int64), keys and measures (double, null where a point failed) and error (text, null where not).
/// The file appears whole or not at all.
pub fn write_parquet(table: &Table, path: &Path) -> Result<(), SweepError> {
    let failed = |source: std::io::Error| SweepError::Write { file: path.to_owned(), source };
    let bytes = encode(&columns(table)).map_err(|e| failed(std::io::Error::other(e)))?;
    crate::files::write_whole_bytes(path, &bytes).map_err(failed)
}

fn columns(table: &Table) -> Vec<NamedColumn> {
    let index = Column::Whole(table.rows.iter().map(|r| r.index as i64).collect());
    let numbers = |at: usize| Column::Numbers(table.rows.iter().map(|r| number(r, at, table.columns.len())).collect());
    let errors = Column::Texts(table.rows.iter().map(|r| r.outcome.as_ref().err().cloned()).collect());
    let named = table.columns[1..].iter().enumerate().map(|(at, name)| (name.clone(), numbers(at)));
    std::iter::once(("index".to_owned(), index)).chain(named).chain([("error".to_owned(), errors)]).collect()
}

/// Reads the table of a sweep back.
///
/// # Errors
/// No Parquet file, or columns that are not those of the sweep.
pub fn read_parquet(plan: &Plan, path: &Path) -> Result<Table, SweepError> {
    let refuse = |message: String| SweepError::Table {
        file: path.to_owned(),
        message,
        remedy: "name the table.parquet that this sweep wrote".to_owned(),
    };
    let file = File::open(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
    let columns = decode(file).map_err(|e| refuse(e.lines().next().unwrap_or_default().to_owned()))?;
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let expected: Vec<String> = plan.columns().into_iter().chain(["error".to_owned()]).collect();
    if names != expected {
        return Err(refuse(format!(
            "its columns are {}, those of the sweep {}",
            names.join(", "),
            expected.join(", ")
        )));
    }
    let rows = rows(&columns, plan.design.keys()).ok_or_else(|| refuse("a column is of another kind".to_owned()))?;
    Ok(Table::new(plan, rows.into_iter().map(|r| (r.index, r)).collect()))
}

/// None where a column does not hold what it should.
fn rows(columns: &[NamedColumn], keys: usize) -> Option<Vec<Row>> {
    let ((_, index), rest) = columns.split_first()?;
    let ((_, errors), numbers) = rest.split_last()?;
    let numbers: Vec<Vec<f64>> = numbers.iter().map(|(_, c)| c.numbers()).collect::<Option<_>>()?;
    let row = |(at, index): (usize, f64)| {
        let own = |columns: &[Vec<f64>]| columns.iter().map(|c| c[at]).collect::<Vec<f64>>();
        let error = match errors {
            Column::Texts(texts) => texts[at].clone(),
            // Where no point failed the column is empty, and nothing tells its kind.
            _ => None,
        };
        let (measures, concerns) = numbers[keys..].split_at(numbers.len() - keys - ConcernsS::default().len());
        let mut concerns_s = ConcernsS::default();
        if error.is_none() {
            concerns_s.iter_mut().zip(own(concerns)).for_each(|(to, from)| *to = from);
        }
        let outcome = error.map_or_else(|| Ok(own(measures)), Err);
        Row { index: index as u64, values: own(&numbers[..keys]), outcome, concerns_s }
    };
    Some(index.numbers()?.into_iter().enumerate().map(row).collect())
}
