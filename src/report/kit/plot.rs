//! Lines and points over a pair of axes, as a page shows them.

use serde::{Serialize, Serializer};

use super::decimate::decimate;
use super::rounding::rounded;
use super::text::csv_cell;
use crate::report::colour::COLOUR_NAMES;
use crate::report::{Panel, Series};

/// Points of a line that a page holds at most; see [`MOST_KEPT`].
const MOST: usize = 4000;
/// What remains of a line that has more.
const MOST_KEPT: usize = 2000;

/// The area between two lines over the same x, an interval for instance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Area {
    pub label: String,
    #[serde(serialize_with = "colour_name")]
    pub colour: &'static str,
    #[serde(serialize_with = "rounded")]
    pub x: Vec<f64>,
    #[serde(serialize_with = "rounded")]
    pub low: Vec<f64>,
    #[serde(serialize_with = "rounded")]
    pub high: Vec<f64>,
}

/// A plot that a reader can zoom and read values from.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Plot {
    pub title: String,
    /// Said below the title.
    pub notes: Vec<String>,
    pub x_label: String,
    pub y_label: String,
    traces: Vec<Trace>,
    #[serde(skip_serializing_if = "Option::is_none")]
    area: Option<Area>,
    marks: Vec<Mark>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Trace {
    label: String,
    #[serde(serialize_with = "colour_name")]
    colour: &'static str,
    style: Style,
    /// None: that of the trace before.
    #[serde(serialize_with = "rounded_or_null")]
    x: Option<Vec<f64>>,
    #[serde(serialize_with = "rounded")]
    y: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Style {
    Broad,
    Thin,
    Points,
}

/// An upright line at a place, or a strip across the plot.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Mark {
    label: String,
    #[serde(serialize_with = "colour_name")]
    colour: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    strip: Option<[f64; 2]>,
}

impl From<&Panel> for Plot {
    fn from(panel: &Panel) -> Self {
        let styled = |style, all: &[Series]| all.iter().map(move |s| Trace::of(s, style)).collect::<Vec<_>>();
        let traces = [
            styled(Style::Broad, &panel.behind),
            styled(Style::Thin, &panel.series),
            styled(Style::Points, &panel.points),
        ];
        let strips = panel.bands.iter().map(|b| Mark {
            label: b.label.clone(),
            colour: b.colour,
            at: None,
            strip: Some([b.low, b.high]),
        });
        let uprights =
            panel.marks.iter().map(|m| Mark { label: m.label.clone(), colour: m.colour, at: Some(m.at), strip: None });
        Self {
            title: panel.title.first().cloned().unwrap_or_default(),
            notes: panel.title.iter().skip(1).cloned().collect(),
            x_label: panel.x_label.clone(),
            y_label: panel.y_label.clone(),
            traces: traces.concat().into_iter().filter(|t| !t.y.is_empty()).collect(),
            area: None,
            marks: strips.chain(uprights).collect(),
        }
    }
}

impl Plot {
    /// The same with an area behind its lines.
    pub(crate) fn with_area(self, area: Area) -> Self {
        Self { area: Some(area), ..self }
    }

    /// Whether every line runs to the right throughout: then one upright cursor reads all of them.
    pub(super) fn is_curve(&self) -> bool {
        let runs_right = |x: &[f64]| x.windows(2).all(|w| w[0] < w[1]);
        self.traces.iter().all(|t| t.style != Style::Points && t.x.as_ref().is_some_and(|x| runs_right(x)))
    }

    /// The same with no more points than a page holds; `true` if some were left out.
    pub(super) fn for_page(&self) -> (Self, bool) {
        let is_long = |t: &Trace| t.style != Style::Points && t.y.len() > MOST;
        let is_less = self.traces.iter().any(is_long);
        let mut traces: Vec<Trace> =
            self.traces.iter().map(|t| if is_long(t) { t.decimated() } else { t.clone() }).collect();
        for i in (1..traces.len()).rev() {
            if traces[i].x == traces[i - 1].x {
                traces[i].x = None;
            }
        }
        (Self { traces, ..self.clone() }, is_less)
    }

    /// Every point with all of its digits, a line each.
    pub(super) fn csv(&self) -> String {
        let mut text = String::from("series,x,y\n");
        for trace in &self.traces {
            let label = csv_cell(&trace.label);
            for (x, y) in trace.x.iter().flatten().zip(&trace.y).filter(|(x, y)| x.is_finite() && y.is_finite()) {
                text += &format!("{label},{x},{y}\n");
            }
        }
        text
    }
}

impl Trace {
    fn of(series: &Series, style: Style) -> Self {
        let Series { label, colour, x, y } = series.clone();
        Self { label, colour, style, x: Some(x), y }
    }

    fn decimated(&self) -> Self {
        let (mut x, mut y): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        for piece in decimate(self.x.as_deref().unwrap_or_default(), &self.y, MOST_KEPT) {
            // What cut the line cuts it still.
            if let (Some(last), Some((next, _))) = (x.last(), piece.first()) {
                x.push(0.5 * (last + next));
                y.push(f64::NAN);
            }
            x.extend(piece.iter().map(|(x, _)| x));
            y.extend(piece.iter().map(|(_, y)| y));
        }
        Self { x: Some(x), y, ..self.clone() }
    }
}

/// The name that the page's style has for a colour, so that it suits light and dark.
fn name_of(colour: &'static str) -> &'static str {
    COLOUR_NAMES.iter().find(|(hex, _)| *hex == colour).map_or(colour, |(_, name)| name)
}

/// A colour in the page's style.
pub(super) fn css_colour(colour: &'static str) -> String {
    match name_of(colour) {
        name if name.starts_with('#') => name.to_owned(),
        name => format!("var(--{name})"),
    }
}

pub(super) fn colour_name<S: Serializer>(colour: &&'static str, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(name_of(colour))
}

fn rounded_or_null<S: Serializer>(values: &Option<Vec<f64>>, to: S) -> Result<S::Ok, S::Error> {
    match values {
        Some(values) => rounded(values, to),
        None => to.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::BLUE;

    fn panel(x: Vec<f64>, y: Vec<f64>) -> Panel {
        Panel { series: vec![Series { label: "a, b".to_owned(), colour: BLUE, x, y }], ..Panel::default() }
    }

    #[test]
    fn a_loop_is_no_curve_and_points_are_none() {
        let curve = panel(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 0.0]);
        assert!(Plot::from(&curve).is_curve());
        assert!(!Plot::from(&panel(vec![0.0, 1.0, 0.5], vec![0.0, 1.0, 0.0])).is_curve());
        let points = Panel { points: curve.series.clone(), ..Panel::default() };
        assert!(!Plot::from(&points).is_curve());
    }

    #[test]
    fn long_lines_are_decimated_and_their_cuts_stay() {
        let x: Vec<f64> = (0..20_000).map(f64::from).collect();
        let mut y: Vec<f64> = x.iter().map(|x| (0.01 * x).sin()).collect();
        (y[5000], y[7000]) = (f64::NAN, 9.0);
        let whole = Plot::from(&panel(x, y));
        let (shown, is_less) = whole.for_page();
        let trace = &shown.traces[0];
        assert!(is_less && trace.y.len() < MOST && trace.y.contains(&9.0));
        assert_eq!(trace.y.iter().filter(|y| y.is_nan()).count(), 1);
        assert!(shown.is_curve());
        assert_eq!(whole.csv().lines().count(), 20_000);
        assert!(whole.csv().starts_with("series,x,y\n\"a, b\",0,0\n"));
    }

    #[test]
    fn lines_over_the_same_x_hold_it_once() {
        let mut two = panel(vec![0.0, 1.0], vec![3.0, 4.0]);
        two.series.push(two.series[0].clone());
        let (shown, _) = Plot::from(&two).for_page();
        assert_eq!((shown.traces[0].x.is_some(), shown.traces[1].x.is_some()), (true, false));
        let json = serde_json::to_string(&shown).unwrap();
        assert!(json.contains(r#""colour":"blue","style":"thin","x":[0,1],"y":[3,4]"#), "{json}");
    }
}
