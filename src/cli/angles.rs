//! Positions of the joints and of the tip, as `smam run --angles` prints them and the viewer shows them.

use std::fmt::Write as _;

use smam::system::observe::{Frame, SceneGraph};

/// What the joints did during a run.
#[derive(Default)]
pub struct Angles {
    graph: SceneGraph,
    rows: Vec<Row>,
    end_s: f64,
}

struct Row {
    name: String,
    unit: &'static str,
    now: f64,
    least: f64,
    greatest: f64,
}

impl Angles {
    /// Takes note of the joints.
    pub fn begin(&mut self, graph: &SceneGraph) {
        self.graph = graph.clone();
    }

    /// Looks at an instant.
    pub fn frame(&mut self, frame: &Frame) {
        self.end_s = frame.time_s;
        for (i, (name, now, unit)) in self.graph.readings(frame).into_iter().enumerate() {
            match self.rows.get_mut(i) {
                Some(row) => (row.now, row.least, row.greatest) = (now, row.least.min(now), row.greatest.max(now)),
                None => self.rows.push(Row { name, unit, now, least: now, greatest: now }),
            }
        }
    }

    /// One line per joint, then the tip's place.
    pub fn table(&self) -> String {
        if self.rows.is_empty() {
            return "no joints in this scene\n".to_owned();
        }
        let width = self.rows.iter().map(|r| r.name.chars().count()).max().unwrap_or(0);
        let mut text =
            format!("{:<width$} {:>12} {:>12} {:>12}\n", "", format!("at {} s", self.end_s), "least", "greatest");
        for r in &self.rows {
            let _ =
                writeln!(text, "{:<width$} {:>12.3} {:>12.3} {:>12.3} {}", r.name, r.now, r.least, r.greatest, r.unit);
        }
        text
    }
}
