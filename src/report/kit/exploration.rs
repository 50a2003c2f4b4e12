//! A table of points that a reader can search: plots, a map, parallel coordinates, sorting, and the command of each point.

use serde::Serialize;

use super::rounding::rounded;

/// Points that a page holds at most; the table's file has them all.
const MOST: usize = 4000;

/// What was varied.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Key {
    pub name: String,
    /// Keys of the scene that get the value.
    pub sets: Vec<String>,
    /// Text at an axis, with the unit shown.
    pub label: String,
    /// Units of the scene in one of the unit shown.
    pub factor: f64,
    /// In the scene's units, with all digits: they go into commands.
    pub values: Vec<f64>,
    /// Values to be marked, in the unit shown, and what they are.
    pub marks: Vec<(String, f64)>,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measure {
    pub name: String,
    /// Text at an axis, with the unit.
    pub label: String,
    #[serde(serialize_with = "rounded")]
    pub values: Vec<f64>,
}

/// Points with keys and measures, a value for each point.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Exploration {
    pub name: String,
    /// What runs the scene: words of a command line.
    pub command: Vec<String>,
    pub keys: Vec<Key>,
    pub measures: Vec<Measure>,
    /// Numbers of the points.
    pub index: Vec<u64>,
    /// Measures (by their number) that are to be greatest or least, where there are two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objectives: Option<[usize; 2]>,
    /// Rows that no other beats.
    pub best: Vec<usize>,
    /// Rows that do not count.
    pub faint: Vec<usize>,
    /// Whether the points are all combinations of the keys' values.
    pub is_grid: bool,
    /// The file beside the page that has all points.
    pub table: String,
}

impl Exploration {
    /// The same with no more points than a page holds: evenly fewer, but all of the best as far as they fit. `true` if some
    /// were left out.
    pub(super) fn for_page(&self) -> (Self, bool) {
        let count = self.index.len();
        if count <= MOST {
            return (self.clone(), false);
        }
        let every = |of: usize, room: usize| of.div_ceil(room.max(1)).max(1);
        let mut rows: Vec<usize> = self.best.iter().copied().step_by(every(self.best.len(), MOST / 2)).collect();
        rows.extend((0..count).step_by(every(count, MOST - rows.len())));
        rows.sort_unstable();
        rows.dedup();
        let pick = |values: &[f64]| rows.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let places = |of: &[usize]| -> Vec<usize> { of.iter().filter_map(|i| rows.binary_search(i).ok()).collect() };
        let shown = Self {
            keys: self.keys.iter().map(|k| Key { values: pick(&k.values), ..k.clone() }).collect(),
            measures: self.measures.iter().map(|m| Measure { values: pick(&m.values), ..m.clone() }).collect(),
            index: rows.iter().map(|&i| self.index[i]).collect(),
            best: places(&self.best),
            faint: places(&self.faint),
            is_grid: false,
            ..self.clone()
        };
        (shown, true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_very_many_points_a_part_is_shown_and_the_best_with_them() {
        let values: Vec<f64> = (0..50_000).map(f64::from).collect();
        let whole = Exploration {
            measures: vec![Measure { name: "m".to_owned(), label: "m".to_owned(), values }],
            index: (0..50_000).collect(),
            best: vec![7, 49_998],
            is_grid: true,
            ..Exploration::default()
        };
        let (shown, is_less) = whole.for_page();
        assert!(is_less && !shown.is_grid && (MOST / 2..=MOST).contains(&shown.index.len()), "{}", shown.index.len());
        let best: Vec<f64> = shown.best.iter().map(|&i| shown.measures[0].values[i]).collect();
        assert_eq!(best, [7.0, 49_998.0]);
        assert!(shown.measures[0].values.len() == shown.index.len() && shown.index.is_sorted());
    }
}
