//! Delimiter, decimal mark, names: what reads most of the rows as rows of numbers.

use super::super::table::{
    Delimiter, FileOptions, Header, cell_number, file_unit, is_stamp, labview_options, labview_units,
};
use super::preview::Preview;
use super::{Said, Sureness};

/// Lines that are looked at.
const LOOKED_AT: usize = 400;

/// A table taken apart.
pub(super) struct Layout {
    pub(super) options: FileOptions,
    pub(super) names: Vec<String>,
    pub(super) units: Vec<String>,
    /// Rows of cells below the names.
    pub(super) rows: Vec<Vec<String>>,
    pub(super) said: Vec<Said>,
}

/// A line: its number from 1 and its cells.
type Line = (usize, Vec<String>);

pub(super) fn layout(preview: &Preview) -> Option<Layout> {
    match preview {
        Preview::Cells { rows, sheet, said } => {
            let lines = numbered(rows);
            let plain = FileOptions { sheet: sheet.clone(), ..FileOptions::default() };
            let options = marked(&lines, plain);
            let found = block(&lines, &options)?;
            let marks = FileOptions { delimiter: None, ..options.clone() };
            let mut said: Vec<Said> = said.iter().cloned().chain(words(&marks)).collect();
            let rows = lines[found.clone()].to_vec();
            let layout = with_names(&lines, found, options, Vec::new());
            said.extend(remarks(&rows, layout.names.len()));
            Some(Layout { said: [said, layout.said.clone()].concat(), ..layout })
        }
        Preview::Text { text, encoding, said } => {
            let said: Vec<Said> = said.iter().cloned().collect();
            let base = FileOptions { encoding: *encoding, ..FileOptions::default() };
            let (options, lines) = match labview_options(text, &base) {
                Some(options) => (options.clone(), split(text, &options)),
                None => best(text, &base)?,
            };
            let found = block(&lines, &options)?;
            let said = said.into_iter().chain(words(&options)).collect();
            let layout = with_names(&lines, found, options, said);
            Some(with_labview_units(layout, labview_units(text)))
        }
    }
}

fn numbered(rows: &[Vec<String>]) -> Vec<Line> {
    rows.iter().cloned().enumerate().map(|(i, cells)| (i + 1, cells)).collect()
}

/// Numbers in the rows of a sheet that would be taken for its table.
pub(super) fn numbers_in(rows: &[Vec<String>]) -> usize {
    let lines = numbered(rows);
    score(&lines, &marked(&lines, FileOptions::default()))
}

/// Numbers that a workbook holds as texts may have decimal commas.
fn marked(lines: &[Line], plain: FileOptions) -> FileOptions {
    // Cells need no delimiter, but a recordings.toml whose decimal mark is that of a plain table is refused.
    let delimiter = Some(Delimiter::Character(b';'));
    let with_commas = FileOptions { decimal: Some(','), delimiter, ..plain.clone() };
    if score(lines, &with_commas) > score(lines, &plain) { with_commas } else { plain }
}

/// What stands beside a workbook's table, right of its last name.
fn remarks(rows: &[Line], width: usize) -> Option<Said> {
    let beside = |(_, cells): &Line| cells.iter().skip(width).find(|cell| !cell.is_empty()).cloned();
    let first = rows.iter().find_map(beside)?;
    let what = format!("what stands beside the table is not read: \"{first}\"");
    Some(Said { what, sureness: Sureness::Likely })
}

/// The units that LabVIEW's header states stand in the place of a row of units.
fn with_labview_units(mut layout: Layout, units: Vec<String>) -> Layout {
    if layout.units.is_empty() && units.iter().any(|unit| file_unit(unit).is_some()) {
        layout.said.push(Said { what: "units from Y_Unit_Label".to_owned(), sureness: Sureness::Sure });
        layout.units = units;
    }
    layout
}

fn words(options: &FileOptions) -> Vec<Said> {
    let sure = |what: String| Said { what, sureness: Sureness::Sure };
    let delimiter = options.delimiter.map(|d| sure(format!("columns separated by {}", named(d))));
    let decimal = options.decimal.filter(|d| *d == ',').map(|_| sure("decimal commas".to_owned()));
    let thousands =
        options.thousands.map(|t| Said { what: format!("thousands marked by \"{t}\""), sureness: Sureness::Likely });
    delimiter.into_iter().chain(decimal).chain(thousands).collect()
}

fn named(delimiter: Delimiter) -> &'static str {
    match delimiter {
        Delimiter::Character(b';') => "semicolons",
        Delimiter::Character(b'\t') => "tabs",
        Delimiter::Character(b'|') => "bars",
        Delimiter::Character(_) => "commas",
        Delimiter::Blanks => "blanks",
    }
}

/// The marks that make most cells numbers; of equal ones the earliest, so a mark that is not needed is not declared.
fn best(text: &str, base: &FileOptions) -> Option<(FileOptions, Vec<Line>)> {
    let mut best: Option<(usize, FileOptions, Vec<Line>)> = None;
    for delimiter in [b',', b';', b'\t', b'|'].map(Delimiter::Character).into_iter().chain([Delimiter::Blanks]) {
        for (decimal, thousands) in [('.', None), (',', None), (',', Some('.')), ('.', Some(',')), ('.', Some('.'))] {
            // Both are the comma only where quotes keep them apart.
            if delimiter == Delimiter::Character(decimal as u8) && !text.contains('"') {
                continue;
            }
            let options = FileOptions { delimiter: Some(delimiter), decimal: Some(decimal), thousands, ..base.clone() };
            let lines = split(text, &options);
            let score = score(&lines, &options);
            if score > best.as_ref().map_or(0, |(most, ..)| *most) {
                best = Some((score, options, lines));
            }
        }
    }
    best.map(|(_, options, lines)| (options, lines))
}

/// Cells that are numbers or missing, in the block of rows of numbers; columns alone are none.
fn score(lines: &[Line], options: &FileOptions) -> usize {
    let Some(found) = block(lines, options) else { return 0 };
    lines[found].iter().map(|(_, cells)| cells.iter().filter(|cell| is_value(cell, options)).count()).sum()
}

fn is_value(cell: &str, options: &FileOptions) -> bool {
    cell_number(cell, options).is_some_and(f64::is_finite) || is_stamp(cell)
}

fn is_row(cells: &[String], options: &FileOptions) -> bool {
    let values = cells.iter().filter(|cell| is_value(cell, options)).count();
    let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
    values >= 1 && filled >= 2 && 2 * values >= filled
}

/// The longest stretch of rows of numbers of one width.
fn block(lines: &[Line], options: &FileOptions) -> Option<std::ops::Range<usize>> {
    let mut best: Option<std::ops::Range<usize>> = None;
    let mut from = 0;
    for at in 0..=lines.len() {
        let goes_on = at < lines.len()
            && is_row(&lines[at].1, options)
            && (at == from || lines[at].1.len() == lines[from].1.len());
        if goes_on {
            continue;
        }
        if at - from > best.as_ref().map_or(0, std::iter::ExactSizeIterator::len) {
            best = Some(from..at);
        }
        let restarts = at < lines.len() && is_row(&lines[at].1, options);
        from = if restarts { at } else { at + 1 };
    }
    best
}

/// The first lines as cells, blank ones left out.
fn split(text: &str, options: &FileOptions) -> Vec<Line> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).take(LOOKED_AT);
    lines.map(|(index, line)| (index + 1, cells(line, options))).collect()
}

fn cells(line: &str, options: &FileOptions) -> Vec<String> {
    match options.delimiter {
        Some(Delimiter::Blanks) => line.split_whitespace().map(str::to_owned).collect(),
        Some(Delimiter::Character(delimiter)) => {
            let mut reader = csv::ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .trim(csv::Trim::All)
                .delimiter(delimiter)
                .from_reader(line.as_bytes());
            let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
            record.iter().map(str::to_owned).collect()
        }
        None => vec![line.to_owned()],
    }
}

/// Names, units and rows around a block.
fn with_names(lines: &[Line], found: std::ops::Range<usize>, mut options: FileOptions, mut said: Vec<Said>) -> Layout {
    let rows: Vec<Vec<String>> = lines[found.clone()].iter().map(|(_, cells)| cells.clone()).collect();
    let width = rows.first().map_or(0, Vec::len);
    let mut above = lines[..found.start].iter().rev().filter(|(_, cells)| cells.iter().any(|c| !c.is_empty()));
    let mut line = above.next().cloned();
    let units = line.as_ref().filter(|(_, cells)| are_units(cells)).map(|(_, cells)| cells.clone());
    if units.is_some() {
        options.units_row = true;
        said.push(Said { what: "a row of units below the names".to_owned(), sureness: Sureness::Sure });
        line = above.next().cloned();
    }
    let names = line.filter(|(_, cells)| cells.len() >= width.saturating_sub(1) && cells.len() > 1);
    let names = match names {
        Some((at, cells)) => {
            let is_first = lines.first().is_some_and(|(first, _)| *first == at);
            let is_comment = cells[0].starts_with(['#', '%']);
            if (!is_first || is_comment) && options.header.is_none() {
                options.header = Some(Header::Line(at));
            }
            own_names(unmarked(cells), at, &mut options, &mut said)
        }
        None => {
            options.header = Some(Header::Absent);
            said.push(Said { what: "no row of names".to_owned(), sureness: Sureness::Likely });
            options.names = (1..=width).map(|index| format!("column {index}")).collect();
            options.skip_rows = lines[found.start].0 - 1;
            options.names.clone()
        }
    };
    if options.delimiter == Some(Delimiter::Character(b',')) && options.decimal != Some(',') {
        options.delimiter = None;
    }
    options.decimal = options.decimal.filter(|decimal| *decimal != '.');
    Layout { options, names, units: units.unwrap_or_default(), rows, said }
}

/// Names of columns that stand twice get a number: then the file's own are passed over and those stand in `names`.
fn own_names(names: Vec<String>, line: usize, options: &mut FileOptions, said: &mut Vec<Said>) -> Vec<String> {
    let count = |upto: usize| names[..upto].iter().filter(|name| **name == names[upto]).count();
    let numbered = |at: usize| match count(at) {
        _ if names[at].is_empty() => String::new(),
        0 => names[at].clone(),
        earlier => format!("{} ({})", names[at], earlier + 1),
    };
    let own: Vec<String> = (0..names.len()).map(numbered).collect();
    if own == names {
        return names;
    }
    let twice: Vec<&str> = own.iter().filter(|own| !names.contains(own)).map(String::as_str).collect();
    let what = format!("names that stand twice are numbered: \"{}\"", twice.join("\", \""));
    said.push(Said { what, sureness: Sureness::Sure });
    (options.header, options.skip_rows, options.names) = (Some(Header::Absent), line, own.clone());
    own
}

/// Names in a comment, without its mark, and without the columns that a delimiter at the end makes.
fn unmarked(mut cells: Vec<String>) -> Vec<String> {
    cells[0] = cells[0].trim_start_matches(['#', '%', ' ']).to_owned();
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}

fn are_units(cells: &[String]) -> bool {
    let bare = |cell: &String| cell.trim_matches(['[', ']', '(', ')']).trim().to_owned();
    let filled: Vec<String> = cells.iter().filter(|cell| !cell.is_empty()).map(bare).collect();
    let known = filled.iter().filter(|cell| file_unit(cell).is_some() || *cell == "-").count();
    !filled.is_empty() && 2 * known > filled.len() && filled.iter().any(|cell| file_unit(cell).is_some())
}
