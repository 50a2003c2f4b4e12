//! The rows that are looked at.

use std::path::Path;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::super::source::{read_settled, read_whole};
use super::super::table::{check_labview, is_formula, parquet_rows, sheet_names, without_nul_end, workbook_rows};
use super::super::{FileFormat, RecordingError};
use super::layout::numbers_in;
use super::{Said, Sureness};

/// What a file holds, before any row is taken apart.
pub(super) enum Preview {
    Text {
        text: String,
        encoding: Option<&'static Encoding>,
        said: Option<Said>,
    },
    /// Cells as texts: no delimiter, points as decimal marks.
    Cells {
        rows: Vec<Vec<String>>,
        sheet: Option<String>,
        said: Option<Said>,
    },
}

impl Preview {
    /// Whether some cells hold formulas in the place of numbers.
    pub(super) fn has_formulas(&self) -> bool {
        match self {
            Self::Text { .. } => false,
            Self::Cells { rows, .. } => rows.iter().flatten().any(|cell| is_formula(cell)),
        }
    }
}

/// `sheet` is that of a workbook; where none is named, the first one with about as many numbers as any.
pub(super) fn preview(file: &Path, sheet: Option<&str>) -> Result<Preview, RecordingError> {
    let format = FileFormat::of(file)?;
    if let Some(sheet) = sheet.filter(|_| format != FileFormat::Workbook) {
        return Err(RecordingError::Format {
            file: file.to_owned(),
            problem: format!(
                "is no workbook, so it has no sheet \"{sheet}\"\n  remedy: leave --sheet out, or name a file that ends in .xlsx"
            ),
        });
    }
    match format {
        FileFormat::Workbook => workbook(&read_whole(file)?, file, sheet),
        FileFormat::Parquet => Ok(Preview::Cells { rows: parquet_rows(file)?, sheet: None, said: None }),
        FileFormat::Mcap => Err(RecordingError::Format {
            file: file.to_owned(),
            problem: "is a bag: its topics are not guessed\n  remedy: declare them as docs/formats.md says (topic = \"/syringe\")".to_owned(),
        }),
        FileFormat::Csv => {
            let (text, encoding, said) = text(&read_settled(file)?);
            check_labview(&text, file)?;
            Ok(Preview::Text { text, encoding, said })
        }
    }
}

/// A sheet with so small a share of another's numbers describes them: a title, masses, a summary.
const DESCRIBES: f64 = 0.1;

fn workbook(bytes: &[u8], file: &Path, sheet: Option<&str>) -> Result<Preview, RecordingError> {
    let sheets = sheet_names(bytes, file)?;
    if sheet.is_some() || sheets.len() < 2 {
        let rows = workbook_rows(bytes, sheet, file)?;
        return Ok(Preview::Cells { rows, sheet: sheet.map(str::to_owned), said: None });
    }
    let mut all: Vec<_> = sheets.iter().map(|name| workbook_rows(bytes, Some(name), file)).collect();
    // A sheet that cannot be read, a diagram perhaps, is not asked for.
    let numbers: Vec<usize> = all.iter().map(|rows| rows.as_ref().map_or(0, |rows| numbers_in(rows))).collect();
    let most = numbers.iter().max().copied().unwrap_or(0) as f64;
    let at = numbers.iter().position(|own| *own as f64 >= DESCRIBES * most).unwrap_or(0);
    let others: Vec<&str> = sheets.iter().map(String::as_str).filter(|name| *name != sheets[at]).collect();
    let which = if at == 0 { "the first" } else { "the first that is a table of numbers" };
    let what = format!("sheet \"{}\", {which}; --sheet takes another: \"{}\"", sheets[at], others.join("\", \""));
    let said = Some(Said { what, sureness: Sureness::Assumed });
    // The first sheet is read where none is named.
    Ok(Preview::Cells { rows: all.swap_remove(at)?, sheet: (at > 0).then(|| sheets[at].clone()), said })
}

/// The text, its encoding where that has to be declared, and what is to be said of it.
fn text(bytes: &[u8]) -> (String, Option<&'static Encoding>, Option<Said>) {
    // That some bytes are left out is said when what was written is read.
    let (bytes, _) = without_nul_end(bytes);
    let (encoding, sureness) = encoding(bytes);
    let (text, actual, _) = encoding.decode(bytes);
    let is_plain = encoding == UTF_8 || Encoding::for_bom(bytes).is_some();
    let said = (encoding != UTF_8).then(|| Said { what: format!("encoding {}", actual.name()), sureness });
    let text = text.trim_start_matches('\u{feff}').to_owned();
    (text, (!is_plain).then_some(encoding), said)
}

/// The encoding of a text: by its mark, by where its zeros are, by whether it is UTF-8; else what Windows writes in the west.
fn encoding(bytes: &[u8]) -> (&'static Encoding, Sureness) {
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return (encoding, Sureness::Sure);
    }
    let zeros = |at: usize| bytes.iter().skip(at).step_by(2).filter(|byte| **byte == 0).count();
    match (zeros(0), zeros(1)) {
        (0, 0) if std::str::from_utf8(bytes).is_ok() => (UTF_8, Sureness::Sure),
        (0, 0) => (single_or_gbk(bytes), Sureness::Likely),
        (even, odd) if even > odd => (UTF_16BE, Sureness::Likely),
        _ => (UTF_16LE, Sureness::Likely),
    }
}

/// Chinese text comes in pairs of high bytes; a degree sign or an umlaut stands alone among letters.
fn single_or_gbk(bytes: &[u8]) -> &'static Encoding {
    let runs = bytes.chunk_by(|a, b| (*a >= 0x80) == (*b >= 0x80)).filter(|run| run[0] >= 0x80);
    let (mut pairs, mut singles) = (0, 0);
    runs.for_each(|run| if run.len() % 2 == 0 { pairs += 1 } else { singles += 1 });
    let is_gbk = pairs > singles && !encoding_rs::GBK.decode_without_bom_handling(bytes).1;
    if is_gbk { encoding_rs::GBK } else { WINDOWS_1252 }
}
