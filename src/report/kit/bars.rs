//! Bars with intervals, in groups: what each of several things contributes. HTML, so that text keeps its size.

use std::fmt::Write as _;

use super::plot::css_colour;
use super::text::escaped;
use crate::report::quantity::quantity;

/// A value and the ends of its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

impl Bar {
    /// A value without an interval.
    pub fn plain(value: f64) -> Self {
        Self { value, low: f64::NAN, high: f64::NAN }
    }
}

/// A group of bars for each name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BarPanel {
    pub title: String,
    /// What the bars measure, with the unit.
    pub label: String,
    /// What the bars of each group are, with their colours.
    pub legend: Vec<(String, &'static str)>,
    /// Name and bars, in the order of the legend.
    pub groups: Vec<(String, Vec<Bar>)>,
    /// Lengths go by the logarithm.
    pub is_logarithmic: bool,
}

impl BarPanel {
    /// A table: name, what it is, bar, number.
    pub(super) fn html(&self) -> String {
        let mut text = format!("<h3>{}</h3>\n<div class=\"box\"><table>\n", escaped(&self.title));
        text += &format!("<tr><th></th><th></th><th class=\"l\">{}</th><th></th></tr>\n", escaped(&self.label));
        let (low, high) = self.ends();
        let at = |value: f64| 100.0 * ((self.length(value) - low) / (high - low)).clamp(0.0, 1.0);
        for (name, bars) in &self.groups {
            for (i, (bar, (what, colour))) in bars.iter().zip(&self.legend).enumerate() {
                let name = if i == 0 { escaped(name) } else { String::new() };
                let drawn = if bar.value.is_finite() { drawn(bar, colour, &at) } else { String::new() };
                text += &format!(
                    "<tr><td class=\"l\">{name}</td><td class=\"l\">{}</td><td class=\"span\"><div>{drawn}</div></td><td>{}</td></tr>\n",
                    escaped(what),
                    number(bar)
                );
            }
        }
        text + "</table></div>\n"
    }

    fn length(&self, value: f64) -> f64 {
        if self.is_logarithmic { value.max(1e-300).log10() } else { value }
    }

    /// What the bars reach, from zero on; of a logarithmic panel from a half on.
    fn ends(&self) -> (f64, f64) {
        let zero = self.length(if self.is_logarithmic { 0.5 } else { 0.0 });
        let bars = self.groups.iter().flat_map(|(_, bars)| bars).flat_map(|b| [b.low, b.value, b.high]);
        let finite = bars.filter(|v| v.is_finite()).map(|v| self.length(v));
        let (low, high) = finite.fold((zero, zero), |(l, h), v| (l.min(v), h.max(v)));
        if high > low { (if self.is_logarithmic { zero } else { low }, high) } else { (low, low + 1.0) }
    }
}

/// The bar from zero (or the left end), and the interval as a line over it.
fn drawn(bar: &Bar, colour: &'static str, at: &impl Fn(f64) -> f64) -> String {
    let (zero, end) = (at(0.0), at(bar.value));
    let (from, width) = (zero.min(end), (end - zero).abs());
    let mut text = format!("<u style=\"--k:{};left:{from:.2}%;width:{width:.2}%\"></u>", css_colour(colour));
    if bar.low.is_finite() && bar.high.is_finite() {
        let (low, high) = (at(bar.low), at(bar.high));
        let _ = write!(text, "<s style=\"left:{low:.2}%;width:{:.2}%\"></s>", high - low);
    }
    text
}

fn number(bar: &Bar) -> String {
    let digits = |v: f64| quantity("", None, v);
    match bar.low.is_finite() && bar.high.is_finite() {
        true => format!("{} ({} to {})", digits(bar.value), digits(bar.low), digits(bar.high)),
        false => digits(bar.value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{BLUE, ORANGE};

    #[test]
    fn every_bar_with_a_value_is_drawn_and_named() {
        let bar = |value: f64| Bar { value, low: value - 0.1, high: value + 0.1 };
        let panel = BarPanel {
            title: "range & co".to_owned(),
            label: "share of the variance".to_owned(),
            legend: vec![("alone".to_owned(), BLUE), ("in all".to_owned(), ORANGE)],
            groups: vec![
                ("a".to_owned(), vec![bar(0.3), bar(0.4)]),
                ("b".to_owned(), vec![Bar::plain(f64::NAN), bar(-0.1)]),
            ],
            is_logarithmic: false,
        };
        let html = panel.html();
        assert_eq!([html.matches("<u ").count(), html.matches("<s ").count()], [3, 3]);
        for text in
            ["range &amp; co", ">share of the variance<", ">alone<", ">in all<", ">a<", ">b<", "--k:var(--blue)"]
        {
            assert!(html.contains(text), "{text}");
        }
        // From -0.2 to 0.5: zero lies at two sevenths.
        assert!(html.contains("left:28.57%;width:42.86%"), "{html}");
    }

    #[test]
    fn logarithmic_bars_begin_at_a_half() {
        let panel = BarPanel {
            legend: vec![("error".to_owned(), BLUE)],
            groups: vec![("x".to_owned(), vec![Bar::plain(50.0)]), ("y".to_owned(), vec![Bar::plain(5.0)])],
            is_logarithmic: true,
            ..BarPanel::default()
        };
        let html = panel.html();
        assert!(html.contains("left:0.00%;width:100.00%") && html.contains("left:0.00%;width:50.00%"), "{html}");
    }
}
