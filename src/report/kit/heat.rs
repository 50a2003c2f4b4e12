//! A map of numbers: a table whose cells are the darker the more they hold.

use std::fmt::Write as _;

use super::text::escaped;

/// Rows of numbers over levels of something.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatMap {
    /// What the columns are levels of, with the unit.
    pub x_label: String,
    /// Text at the head of each column.
    pub columns: Vec<String>,
    /// Name and numbers of each row; none where there is nothing to show.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
    /// Numbers from which a cell gets darker, and at which it is darkest; between them by the logarithm.
    pub scale: [f64; 2],
}

impl HeatMap {
    pub(super) fn html(&self) -> String {
        let mut text =
            format!("<div class=\"box\"><table class=\"heat\">\n<tr><th class=\"l\">{}</th>", escaped(&self.x_label));
        self.columns.iter().for_each(|head| text += &format!("<th>{}</th>", escaped(head)));
        text += "</tr>\n";
        for (name, cells) in &self.rows {
            let _ = write!(text, "<tr><th class=\"l\">{}</th>", escaped(name));
            cells.iter().for_each(|cell| text += &self.cell(*cell));
            text += "</tr>\n";
        }
        text + "</table></div>\n"
    }

    fn cell(&self, value: Option<f64>) -> String {
        let Some(value) = value.filter(|v| v.is_finite()) else { return "<td></td>".to_owned() };
        let [low, high] = self.scale;
        let share = ((value.max(low) / low).ln() / (high / low).ln()).clamp(0.0, 1.0);
        format!("<td class=\"h\" style=\"--v:{:.0}\">{value:.1}</td>", 90.0 * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_darker_and_nothing_is_empty() {
        let map = HeatMap {
            x_label: "stroke (mm)".to_owned(),
            columns: vec!["0 to <1".to_owned(), "1".to_owned(), "2".to_owned()],
            rows: vec![("rising".to_owned(), vec![Some(0.8), Some(10.0), None])],
            scale: [1.0, 100.0],
        };
        let html = map.html();
        assert!(
            html.contains("--v:0\">0.8<") && html.contains("--v:45\">10.0<") && html.contains("<td></td>"),
            "{html}"
        );
        assert!(html.contains("0 to &lt;1"));
    }
}
