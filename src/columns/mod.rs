//! Tables of named columns as Parquet files. A leaf of the crate, and the only user of the crate `parquet`.
//!
//! ```
//! use std::io::{Seek, Write};
//!
//! use smam::columns::{Column, decode, encode};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let table = vec![
//!     ("index".to_owned(), Column::Whole(vec![0, 1])),
//!     ("force_n".to_owned(), Column::Numbers(vec![0.05, f64::NAN])),
//! ];
//! let mut file = tempfile::tempfile()?;
//! file.write_all(&encode(&table)?)?;
//! file.rewind()?;
//! let back = decode(file)?;
//! assert_eq!(back[0], table[0]);
//! // A missing sample comes back as one.
//! let force_n = back[1].1.numbers().ok_or("numbers")?;
//! assert!(force_n[0] == 0.05 && force_n[1].is_nan());
//! # Ok(())
//! # }
//! ```

mod claims;
mod parquet_shapes;
mod read;
mod thrift;
mod write;

pub use read::decode;
pub use write::{NumberRows, encode};

/// One column of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Whole numbers, one in every row.
    Whole(Vec<i64>),
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Texts, where there is one.
    Texts(Vec<Option<String>>),
}

impl Column {
    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Whole(v) => v.len(),
            Self::Numbers(v) => v.len(),
            Self::Texts(v) => v.len(),
        }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The column as numbers, if it is no text.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        match self {
            Self::Whole(v) => Some(v.iter().map(|v| *v as f64).collect()),
            Self::Numbers(v) => Some(v.clone()),
            Self::Texts(_) => None,
        }
    }
}

/// A name and its column.
pub type NamedColumn = (String, Column);

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Seek, Write};

    fn written(bytes: &[u8]) -> Result<Vec<NamedColumn>, String> {
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(bytes).and_then(|()| file.rewind()).expect("written");
        decode(file)
    }

    #[test]
    fn what_is_written_is_read_back() {
        let table = vec![
            ("index".to_owned(), Column::Whole(vec![3, 5])),
            ("force_n".to_owned(), Column::Numbers(vec![1.0 / 3.0, f64::NAN])),
            ("error".to_owned(), Column::Texts(vec![None, Some("it \"broke\"".to_owned())])),
        ];
        let back = written(&encode(&table).expect("encoded")).expect("read");
        assert_eq!((&back[0], &back[2]), (&table[0], &table[2]));
        let Column::Numbers(numbers) = &back[1].1 else { panic!("{back:?}") };
        assert!(numbers[0] == 1.0 / 3.0 && numbers[1].is_nan());
        assert!(written(b"PAR1 and then nothing").is_err());
        let encrypted = written(b"PAR1\x1c\x1c\0\0\0\x05\0\0\0PARE").expect_err("encrypted");
        assert!(encrypted.contains("encrypted"), "{encrypted}");
    }

    /// A million equal numbers take a few hundred bytes: so could any number of them, until the memory is full.
    #[test]
    fn more_rows_than_a_recording_can_have_in_so_few_bytes_are_refused() {
        let equal =
            |count: usize| written(&encode(&[("x".to_owned(), Column::Numbers(vec![1.0; count]))]).expect("encoded"));
        assert_eq!(equal(1000).expect("read")[0].1.len(), 1000);
        let said = equal(1_000_000).expect_err("too many");
        assert!(said.starts_with("it claims more than "), "{said}");
    }
}
