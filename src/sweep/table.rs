//! The table of a sweep: one row per point in the order of their index, as CSV and as Parquet.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::SweepError;
use super::journal::read;
use super::parquet_file::{read_parquet, write_parquet};
use super::plan::Plan;
use super::point::Row;
use crate::files::write_whole;

/// All rows of a sweep that are there.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
    /// Points that the sweep has.
    pub points: u64,
}

impl Table {
    #[doc(hidden)]
    pub fn new(plan: &Plan, rows: BTreeMap<u64, Row>) -> Self {
        Self { columns: plan.columns(), rows: rows.into_values().collect(), points: plan.count() }
    }

    /// Reads the journals of folders; a point that several have counts once.
    ///
    /// # Errors
    /// Folders without a journal, or with that of another sweep.
    #[doc(hidden)]
    pub fn of_folders(plan: &Plan, folders: &[&Path]) -> Result<Self, SweepError> {
        let mut rows = BTreeMap::new();
        for folder in folders {
            rows.extend(read(folder, &plan.fingerprint)?);
        }
        Ok(Self::new(plan, rows))
    }

    /// Reads `table.parquet` back.
    ///
    /// # Errors
    /// No Parquet file, or columns that are not those of the sweep.
    pub fn of_parquet(plan: &Plan, path: &Path) -> Result<Self, SweepError> {
        read_parquet(plan, path)
    }

    /// Whether a point has a row.
    #[doc(hidden)]
    pub fn has(&self, index: u64) -> bool {
        self.rows.binary_search_by_key(&index, |r| r.index).is_ok()
    }

    /// Rows whose point failed.
    pub fn failed(&self) -> impl Iterator<Item = (u64, &str)> {
        self.rows.iter().filter_map(|r| Some((r.index, r.outcome.as_ref().err()?.as_str())))
    }

    /// The numbers of a column but the index; NaN where a point failed.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.columns.iter().position(|c| c == name)?.checked_sub(1)?;
        Some(self.rows.iter().map(|r| number(r, at, self.columns.len())).collect())
    }

    /// The numbers of a column at every point of the sweep; NaN where it failed or is not done.
    pub(crate) fn by_index(&self, name: &str) -> Vec<f64> {
        let mut all = vec![f64::NAN; self.points as usize];
        for (row, value) in self.rows.iter().zip(self.column(name).unwrap_or_default()) {
            if let Some(slot) = all.get_mut(row.index as usize) {
                *slot = value;
            }
        }
        all
    }

    /// Refuses a folder whose `table.csv` is none of this sweep's: somebody else's would be lost.
    ///
    /// # Errors
    /// Such a table.
    #[doc(hidden)]
    pub fn check_place(plan: &Plan, folder: &Path) -> Result<(), SweepError> {
        let file = folder.join("table.csv");
        let own = Self::new(plan, BTreeMap::new()).csv();
        match std::fs::read_to_string(&file) {
            Ok(there) if there.lines().next() != own.lines().next() => Err(SweepError::Table {
                file,
                message: "is a table of something else, it would be lost".to_owned(),
                remedy: "give another folder with --out, or move the table away".to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// Writes `table.csv` and `table.parquet`.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), SweepError> {
        let csv = folder.join("table.csv");
        write_whole(&csv, &self.csv()).map_err(|source| SweepError::Write { file: csv, source })?;
        write_parquet(self, &folder.join("table.parquet"))
    }

    pub(super) fn csv(&self) -> String {
        let names: Vec<String> = self.columns.iter().map(|name| quoted(name)).collect();
        let mut text = names.join(",") + ",error\n";
        for row in &self.rows {
            let _ = write!(text, "{}", row.index);
            for at in 0..self.columns.len() - 1 {
                let value = number(row, at, self.columns.len());
                let _ = if value.is_finite() { write!(text, ",{value}") } else { write!(text, ",") };
            }
            let error = row.outcome.as_ref().err().map_or("", String::as_str);
            let _ = if error.is_empty() { writeln!(text, ",") } else { writeln!(text, ",{}", quoted(error)) };
        }
        text
    }
}

/// A cell as CSV takes it: quoted where it must be, on one line.
pub(super) fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\"").replace('\n', " "))
    } else {
        cell.to_owned()
    }
}

/// The number of a row in a column after the index, of so many columns.
pub(super) fn number(row: &Row, at: usize, columns: usize) -> f64 {
    let measures = columns - 1 - row.values.len() - row.concerns_s.len();
    row.numbers(measures).nth(at).unwrap_or(f64::NAN)
}
