//! The points of a sweep, for a reader to search.

use smam::recording::axis_label;
use smam::report::{Exploration, Key, Measure};
use smam::sweep::{MeasureSpec, Plan, SamplingSpec, Table, VarySpec};

use super::sweep_page::plain;
use super::sweep_panels::scale_of;
use super::sweep_trouble::is_sound;

/// Every point that ran, with the words that run its scene again.
pub fn exploration(plan: &Plan, table: &Table, best: &[usize]) -> Exploration {
    let file = &plan.file;
    let ran: Vec<usize> = (0..table.rows.len()).filter(|&i| table.rows[i].outcome.is_ok()).collect();
    let pick = |name: &str| {
        let all = table.column(name).unwrap_or_default();
        ran.iter().map(|&i| all[i]).collect::<Vec<f64>>()
    };
    let key = |v: &VarySpec| {
        let values = pick(&v.key);
        let scale = scale_of(&v.key, &values);
        Key {
            name: v.key.clone(),
            sets: v.keys().map(str::to_owned).collect(),
            label: if scale.symbol.is_empty() { v.key.clone() } else { format!("{} ({})", v.key, scale.symbol) },
            factor: scale.factor,
            values,
            marks: v.mark.iter().map(|m| (m.label.clone(), m.at / scale.factor)).collect(),
        }
    };
    let measure = |m: &MeasureSpec| Measure { name: m.name.clone(), label: axis_label(&m.name), values: pick(&m.name) };
    let place = |row: &usize| ran.binary_search(row).ok();
    Exploration {
        name: file.name.clone(),
        command: command(plan),
        keys: file.vary.iter().map(key).collect(),
        measures: file.measure.iter().map(measure).collect(),
        index: ran.iter().map(|&i| table.rows[i].index).collect(),
        objectives: objectives(plan),
        best: best.iter().filter_map(place).collect(),
        faint: ran.iter().enumerate().filter(|(_, row)| !is_sound(plan, &table.rows[**row])).map(|(i, _)| i).collect(),
        is_grid: file.sampling == SamplingSpec::Grid,
        table: "table.csv".to_owned(),
    }
}

/// The first two objectives, as numbers of measures.
fn objectives(plan: &Plan) -> Option<[usize; 2]> {
    let [one, other, ..] = plan.file.objective.as_slice() else { return None };
    let place = |name: &str| plan.file.measure.iter().position(|m| m.name == name);
    Some([place(&one.measure)?, place(&other.measure)?])
}

/// What all points have in common.
fn command(plan: &Plan) -> Vec<String> {
    let file = &plan.file;
    let mut words = vec!["smam".to_owned(), "run".to_owned(), plain(&file.scene)];
    if let Some(duration_s) = file.duration_s {
        words.extend(["--duration".to_owned(), duration_s.to_string()]);
    }
    for text in &file.set {
        words.extend(["--set".to_owned(), text.clone()]);
    }
    words
}
