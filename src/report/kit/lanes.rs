//! Runs as lines over time, with stretches marked in each; a press on one shows it in the page's chooser.

use std::fmt::Write as _;

use super::text::escaped;

/// A stretch of time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub from_s: f64,
    pub to_s: f64,
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    pub name: String,
    /// All of it.
    pub whole: Window,
    pub marked: Vec<Window>,
}

/// Lanes of one scale; `i` of the lanes is choice `i` of the chooser that the page holds.
pub(super) fn html(lanes: &[Lane]) -> String {
    let length_s = |w: &Window| (w.to_s - w.from_s).max(f64::MIN_POSITIVE);
    let longest_s = lanes.iter().map(|lane| length_s(&lane.whole)).fold(f64::MIN_POSITIVE, f64::max);
    let mut text = String::from("<div class=\"lanes\">\n");
    for (i, lane) in lanes.iter().enumerate() {
        let share = 100.0 * length_s(&lane.whole) / longest_s;
        let _ = write!(
            text,
            "<div class=\"lane\"><span>{}</span><div><div class=\"track\" style=\"width:{share:.2}%\">",
            escaped(&lane.name)
        );
        for window in &lane.marked {
            let at = |t: f64| 100.0 * ((t - lane.whole.from_s) / length_s(&lane.whole)).clamp(0.0, 1.0);
            let (from, to) = (at(window.from_s), at(window.to_s));
            let words = format!("{:.1} to {:.1} s", window.from_s, window.to_s);
            let _ = write!(
                text,
                "<button data-run=\"{i}\" data-from=\"{}\" data-to=\"{}\" title=\"{words}\" aria-label=\"show {words}\" \
                 style=\"left:{from:.2}%;width:{:.2}%\"></button>",
                window.from_s,
                window.to_s,
                to - from
            );
        }
        text += "</div></div></div>\n";
    }
    text + "</div>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_have_one_scale_and_windows_their_place() {
        let window = |from_s, to_s| Window { from_s, to_s };
        let lanes = [
            Lane { name: "a<b".to_owned(), whole: window(0.0, 40.0), marked: vec![window(10.0, 20.0)] },
            Lane { name: "b".to_owned(), whole: window(5.0, 15.0), marked: Vec::new() },
        ];
        let html = html(&lanes);
        assert!(
            html.contains("a&lt;b")
                && html.contains("left:25.00%;width:25.00%")
                && html.contains("title=\"10.0 to 20.0 s\"")
        );
        assert!(html.contains("style=\"width:25.00%\""), "{html}");
    }
}
