//! The trial's rows as a page of Markdown.

use std::fmt::Write as _;

use super::judge::{Judgement, Row};

/// Tables of all rows: by effect and size, the nulls, and every answer that is not right.
///
/// ```
/// use smam::diagnose::Verdict;
/// use smam::trial::{Judgement, Row, table};
///
/// let null = |i: u32| Row {
///     name: format!("muscle_bench nothing {i}"),
///     scene: "muscle_bench".to_owned(),
///     effect: "nothing".to_owned(),
///     judgement: if i == 0 { Judgement::Wrong } else { Judgement::Right },
///     verdict: if i == 0 { Verdict::MissingPhysics } else { Verdict::Adequate },
/// #   seed: 0,
/// #   element: String::new(),
/// #   size: String::new(),
/// #   value: 0.0,
/// #   excess_chi2_per_sample: 0.0,
/// #   answer: Vec::new(),
/// #   found: None,
/// #   ci95: None,
/// #   covered: None,
/// #   gap_closed: 0.0,
/// #   seconds: 9.0,
///     // ...
/// };
/// let rows: Vec<Row> = (0..8).map(null).collect();
/// assert!(table(&rows).contains("Nothing missing: 8 cases, 1 false alarms."));
/// ```
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    let mut scenes: Vec<&str> = rows.iter().map(|r| r.scene.as_str()).collect();
    scenes.dedup();
    scenes.sort_unstable();
    scenes.dedup();
    for scene in scenes {
        let own: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
        one_scene(&mut text, scene, &own);
    }
    not_right(&mut text, rows);
    text
}

fn one_scene(text: &mut String, scene: &str, rows: &[&Row]) {
    let nulls: Vec<&&Row> = rows.iter().filter(|r| r.effect == "nothing").collect();
    let false_alarms = nulls.iter().filter(|r| r.judgement != Judgement::Right).count();
    let _ = writeln!(text, "### {scene}\n");
    if !nulls.is_empty() {
        let _ = writeln!(text, "Nothing missing: {} cases, {false_alarms} false alarms.\n", nulls.len());
    }
    let sizes: Vec<bool> = rows.iter().filter_map(|r| r.covered).collect();
    if !sizes.is_empty() {
        let count = |judgement| rows.iter().filter(|r| r.effect != "nothing" && r.judgement == judgement).count();
        let _ = writeln!(
            text,
            "Something missing: {} cases, {} right, {} among others. The 95 % interval holds the size in {} of {}.\n",
            rows.len() - nulls.len(),
            count(Judgement::Right),
            count(Judgement::Among),
            sizes.iter().filter(|covered| **covered).count(),
            sizes.len()
        );
    }
    let _ = writeln!(text, "| effect | on | small | medium | large |\n|---|---|---|---|---|");
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for row in rows.iter().filter(|r| r.effect != "nothing") {
        let key = (row.effect.as_str(), row.element.as_str());
        if seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let cell = |size: &str| {
            let found = rows.iter().filter(|r| (r.effect.as_str(), r.element.as_str()) == key && r.size == size);
            found.map(|r| one_cell(r)).collect::<Vec<_>>().join("; ")
        };
        let _ =
            writeln!(text, "| {} | {} | {} | {} | {} |", key.0, key.1, cell("small"), cell("medium"), cell("large"));
    }
    text.push('\n');
}

/// `right 1.2e-9 (1.19e-9)`: judgement, size put in, size found.
fn one_cell(row: &Row) -> String {
    let judgement = format!("{:?}", row.judgement).to_lowercase();
    match row.found {
        Some(found) => format!("{judgement} {:.3e} ({found:.3e})", row.value),
        None => format!("{judgement} {:.3e}", row.value),
    }
}

fn not_right(text: &mut String, rows: &[Row]) {
    let wrong: Vec<&Row> = rows.iter().filter(|r| r.judgement != Judgement::Right).collect();
    if wrong.is_empty() {
        let _ = writeln!(text, "Every answer is right.");
        return;
    }
    let _ = writeln!(text, "### Answers that are not right\n\n| case | excess | answer |\n|---|---|---|");
    for row in wrong {
        let answer: Vec<String> = row.answer.iter().map(|(words, p)| format!("{words} {p:.2}")).collect();
        let verdict = format!("{:?}", row.judgement).to_lowercase();
        let _ = writeln!(
            text,
            "| {} ({:.2e}) | {:.4} | {verdict}: {} |",
            row.name,
            row.value,
            row.excess_chi2_per_sample,
            answer.join(", ")
        );
    }
}
