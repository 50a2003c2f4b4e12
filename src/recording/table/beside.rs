//! Remarks beside a table in a workbook.

use super::cell::Cell;
use super::options::{FileOptions, Header};

/// Where a sheet's table ends to the right: with the last name.
pub(super) struct Beside {
    width: Option<usize>,
}

impl Beside {
    /// Of a table without a row of names the width is that of the names that were declared.
    pub(super) fn new(options: &FileOptions) -> Self {
        Self { width: (options.header == Some(Header::Absent)).then_some(options.names.len()) }
    }

    /// The row without texts beside the table. Numbers there stay: a column without a name is a mistake.
    pub(super) fn without_remarks<'a>(&mut self, cells: &[Cell<'a>]) -> Vec<Cell<'a>> {
        let named = || cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
        let width = *self.width.get_or_insert_with(named);
        let is_remark = |at: usize, cell: &Cell<'_>| at >= width && matches!(cell, Cell::Text(_));
        cells.iter().enumerate().map(|(at, cell)| if is_remark(at, cell) { Cell::Text("") } else { *cell }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_beside_go_and_numbers_stay() {
        let mut beside = Beside::new(&FileOptions::default());
        let names = [Cell::Text("a"), Cell::Text("b"), Cell::Text(""), Cell::Text("")];
        assert_eq!(beside.without_remarks(&names), names);
        let row = [Cell::Number(1.0), Cell::Text("n.a."), Cell::Text("valve sticks"), Cell::Number(3.0)];
        assert_eq!(beside.without_remarks(&row), [row[0], row[1], Cell::Text(""), row[3]]);
    }
}
