//! The page and the JSON of what was reproduced.

use serde_json::{Value, json};

use crate::report::HtmlPage;

use super::chapter::YES_NO;
use super::{Chapter, Figure, Row, Standing};

/// A figure of the paper with what was made of it.
pub type Made = (&'static Figure, Chapter);

/// One HTML page: the table of all numbers, then each figure.
pub fn page(made: &[Made]) -> HtmlPage {
    let mut page = HtmlPage::new("Thai et al. 2021, made again");
    let (judged, text) = tally(made);
    page.verdict(&judged, &text, count(made, Standing::NotMet) == 0);
    page.paragraph(
        "Every number that the paper prints beside ours. The paper published no raw data: shapes are compared with its \
         printed hysteresis model and printed parameters. 'tuned' is met, but a number of the rig or the plunger's \
         trajectory was chosen for it. 'given' was taken over as an input; 'shown' has nothing to be \
         compared with, or was printed about recordings that nobody else has.",
    );
    let rows: Vec<Vec<String>> =
        made.iter().flat_map(|(f, c)| c.rows.iter().map(|r| standing_first(cells(f, r)))).collect();
    page.table(&standing_first(HEADER.to_vec()), &rows);
    for (figure, chapter) in made {
        page.heading(&format!("{}: {}", figure.name, figure.title));
        chapter.text.iter().for_each(|text| {
            page.paragraph(text);
        });
        if !chapter.panels.is_empty() {
            page.panels(&chapter.panels, "");
        }
    }
    page
}

fn count(made: &[Made], standing: Standing) -> usize {
    made.iter().flat_map(|(_, chapter)| &chapter.rows).filter(|row| row.standing == standing).count()
}

/// `58 of 70 met`, and what else there is.
fn tally(made: &[Made]) -> (String, String) {
    use Standing::{Given, Met, NotMet, Shown, Tuned};
    let [met, missed, tuned, given, shown] = [Met, NotMet, Tuned, Given, Shown].map(|standing| count(made, standing));
    let besides = format!(
        "of the numbers that can be judged, apart from {tuned} that are met because something was tuned to them; {missed} not \
         met. Besides: {given} given, {shown} shown."
    );
    (format!("{met} of {} met", met + missed), besides)
}

/// Whether it is met stands behind the figure's name: on a phone the first columns are what is seen.
fn standing_first<T>(mut cells: Vec<T>) -> Vec<T> {
    if cells.len() > STANDING {
        let standing = cells.remove(STANDING);
        cells.insert(1, standing);
    }
    cells
}

/// Place of the standing in [`HEADER`].
const STANDING: usize = 5;

/// Heads of the table of numbers.
pub const HEADER: [&str; 7] = ["figure", "quantity", "paper", "ours", "deviation", "met?", "remark"];

/// A row as text, unit included.
pub fn cells(figure: &Figure, row: &Row) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| with_unit(v, row.unit));
    vec![
        figure.name.to_owned(),
        row.quantity.clone(),
        number(row.paper),
        number(row.ours),
        match row.deviation() {
            Some(d) if row.unit != YES_NO => format!("{}{}", if d > 0.0 { "+" } else { "" }, with_unit(d, row.unit)),
            _ => "-".to_owned(),
        },
        row.standing.word().to_owned(),
        row.remark.clone(),
    ]
}

/// The unit `1` is none; `yes/no` is a word.
fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "1" => short(value),
        YES_NO => (if value == 0.0 { "no" } else { "yes" }).to_owned(),
        _ => format!("{} {unit}", short(value)),
    }
}

/// About four digits.
fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".to_owned(),
        s if !(1e-3..1e5).contains(&s) => format!("{value:.3e}"),
        s if s >= 100.0 => format!("{value:.1}"),
        s if s >= 1.0 => format!("{value:.3}"),
        _ => format!("{value:.4}"),
    }
}

/// The same as `reproduce.json`: a list of figures, each with its rows.
pub fn json(made: &[Made]) -> Value {
    let row = |r: &Row| {
        json!({
            "quantity": r.quantity, "unit": r.unit, "paper": r.paper, "ours": r.ours,
            "deviation": r.deviation(), "standing": r.standing, "remark": r.remark,
        })
    };
    let figures = made.iter().map(|(figure, chapter)| {
        let rows: Vec<Value> = chapter.rows.iter().map(row).collect();
        json!({ "figure": figure.name, "title": figure.title, "text": chapter.text, "rows": rows })
    });
    json!({ "format": 1, "source": "Thai et al. 2021, doi 10.1109/LRA.2021.3072599", "figures": figures.collect::<Vec<_>>() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_stands_on_top_and_the_standing_near_the_front() {
        let figure = &crate::reproduce::FIGURES[0];
        let rows = vec![
            Row::compared("range", "mm", 27.0, 27.5, 1.0, "near"),
            Row::compared("width", "mm", 4.0, 6.0, 1.0, "far"),
            Row::given("bore", "mm", 4.5, "scene"),
            Row::compared("mass", "g", 0.28, 0.28, 0.01, "the wire was inferred from it").tuned(),
        ];
        let text = page(&[(figure, Chapter { rows, ..Chapter::default() })]).finish();
        assert!(
            text.contains("<strong>1 of 2 met</strong> of the numbers that can be judged, apart from 1 that"),
            "{text}"
        );
        assert!(text.contains("1 not met. Besides: 1 given, 0 shown."), "{text}");
        assert!(text.contains("<td class=\"l\">not met</td><td class=\"l\">width</td><td>4.000 mm</td>"), "{text}");
        assert!(text.contains("<td>+0.5000 mm</td>"), "{text}");
    }
}
