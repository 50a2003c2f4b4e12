//! Plots drawn as SVG: for documents and slides.

use svg::node::Node as _;
use svg::node::element::Group;

use super::axis::Axis;
use super::colour::GREY;
use super::kit::decimate;
use super::panel::{Panel, Series};
use super::svg::{Rect, cut_to, document, line, polyline, rectangle, text, text_up, text_width};
use super::thin::{TOLERANCE_PX, thin};

const TITLE_SIZE: f64 = 12.0;
const TEXT_SIZE: f64 = 11.0;
/// Room for the y label and ticks of five letters; longer ones take more.
const LEFT_MARGIN: f64 = 66.0;
const Y_LABEL_ROOM: f64 = 24.0;
const RIGHT_MARGIN: f64 = 14.0;
const LINE_HEIGHT: f64 = 16.0;
const TICK_ROOM: f64 = 18.0;
const POINTS_PER_LINE: usize = 1500;
/// Size of a dot, px.
const DOT: f64 = 5.0;
const MOST_DOTS: usize = 2000;
const GRID: &str = "#e4e4e4";

impl Panel {
    /// Draws title, axes and lines within a rectangle.
    pub(super) fn draw(&self, svg: &mut Group, outer: Rect) {
        let (plot, y_axis) = self.plot_area(outer);
        // Dots are not cut by the frame.
        let margin = if self.points.is_empty() { 0.0 } else { 0.02 };
        let x_values = self.all().flat_map(|s| s.x.iter().copied());
        let x_axis = Axis::over(x_values, margin, (plot.width / 70.0) as usize);
        self.draw_text(svg, outer, plot);
        draw_x_ticks(svg, plot, &x_axis);
        draw_y_ticks(svg, plot, &y_axis);
        let at = |x: f64, y: f64| {
            let right = plot.x + x_axis.share(x) * plot.width;
            (right, plot.bottom() - y_axis.share(y) * plot.height)
        };
        for band in &self.bands {
            let (top, bottom) = (at(0.0, band.high).1, at(0.0, band.low).1);
            let rect = Rect { y: top, height: bottom - top, ..plot };
            svg.append(rectangle(rect, band.colour).set("fill-opacity", 0.25));
        }
        for mark in &self.marks {
            let x = at(mark.at, 0.0).0;
            svg.append(line((x, plot.y), (x, plot.bottom()), mark.colour, 1.5));
        }
        for (series, width) in self.lines() {
            for piece in decimate(&series.x, &series.y, POINTS_PER_LINE) {
                let points: Vec<_> = piece.into_iter().map(|(x, y)| at(x, y)).collect();
                svg.append(polyline(&thin(&points, TOLERANCE_PX), series.colour, width));
            }
        }
        for (series, x, y) in self.points.iter().flat_map(dots) {
            svg.append(polyline(&[at(x, y)], series.colour, DOT));
        }
        svg.append(rectangle(plot, "none").set("stroke", GREY));
    }

    /// Every line with its width, px, in the order of drawing.
    fn lines(&self) -> impl Iterator<Item = (&Series, f64)> {
        self.behind.iter().map(|s| (s, 3.6)).chain(self.series.iter().map(|s| (s, 1.2)))
    }

    /// The plot within the panel, and its y axis: how long the ticks are decides what room is left of them.
    fn plot_area(&self, outer: Rect) -> (Rect, Axis) {
        let above = LINE_HEIGHT * self.title.len() as f64 + 8.0;
        let label_room = if self.x_label.is_empty() { 0.0 } else { LINE_HEIGHT };
        let height = outer.height - above - TICK_ROOM - label_room;
        let edges = self.bands.iter().flat_map(|b| [b.low, b.high]);
        let y_values = self.all().flat_map(|s| s.y.iter().copied()).chain(edges);
        let y_axis = Axis::over(y_values, 0.05, (height / 32.0) as usize);
        let widest = y_axis.ticks().iter().map(|(_, text)| text_width(text, TEXT_SIZE)).fold(0.0, f64::max);
        let left = LEFT_MARGIN.max(widest + Y_LABEL_ROOM);
        let plot = Rect { x: outer.x + left, y: outer.y + above, width: outer.width - left - RIGHT_MARGIN, height };
        (plot, y_axis)
    }

    fn draw_text(&self, svg: &mut Group, outer: Rect, plot: Rect) {
        for (index, title) in self.title.iter().enumerate() {
            let y = outer.y + LINE_HEIGHT * (index as f64 + 1.0) - 2.0;
            let size = if index == 0 { TITLE_SIZE } else { TEXT_SIZE };
            svg.append(text((plot.x, y), "start", size, &cut_to(title, size, plot.width)));
        }
        let below = (plot.x + plot.width / 2.0, plot.bottom() + TICK_ROOM + LINE_HEIGHT - 4.0);
        svg.append(text(below, "middle", TEXT_SIZE, &self.x_label));
        let label = cut_to(&self.y_label, TEXT_SIZE, plot.height + 24.0);
        svg.append(text_up((outer.x + 12.0, plot.y + plot.height / 2.0), TEXT_SIZE, &label));
    }
}

/// Where the dots of a series are: evenly fewer of very many, which would be a blot.
fn dots(series: &Series) -> impl Iterator<Item = (&Series, f64, f64)> {
    let every = series.x.len().div_ceil(MOST_DOTS).max(1);
    let there = series.x.iter().zip(&series.y).filter(|(x, y)| x.is_finite() && y.is_finite());
    there.step_by(every).map(move |(x, y)| (series, *x, *y))
}

fn draw_x_ticks(svg: &mut Group, plot: Rect, axis: &Axis) {
    for (value, words) in axis.ticks() {
        let x = plot.x + axis.share(value) * plot.width;
        svg.append(line((x, plot.y), (x, plot.bottom()), GRID, 1.0));
        // At an end the text stays within the panel.
        let centre = x.min(plot.right() + RIGHT_MARGIN - text_width(&words, TEXT_SIZE) / 2.0);
        svg.append(text((centre, plot.bottom() + 14.0), "middle", TEXT_SIZE, &words));
    }
}

fn draw_y_ticks(svg: &mut Group, plot: Rect, axis: &Axis) {
    for (value, words) in axis.ticks() {
        let y = plot.bottom() - axis.share(value) * plot.height;
        svg.append(line((plot.x, y), (plot.right(), y), GRID, 1.0));
        svg.append(text((plot.x - 5.0, y + 4.0), "end", TEXT_SIZE, &words));
    }
}

/// Draws a legend from a point (px) to the right, in a new row where the next entry would pass `right`; returns the
/// height of all rows after the first.
pub(super) fn draw_legend(svg: &mut Group, at: (f64, f64), right: f64, entries: &[(&str, &'static str, f64)]) -> f64 {
    let (mut x, mut y) = at;
    for (label, colour, opacity) in entries {
        let width = 28.0 + text_width(label, TEXT_SIZE);
        if x > at.0 && x + width > right {
            (x, y) = (at.0, y + LINE_HEIGHT);
        }
        let height = if *opacity >= 1.0 { 3.0 } else { 12.0 };
        let swatch = Rect { x, y: y - 4.0 - height / 2.0, width: 22.0, height };
        svg.append(rectangle(swatch, colour).set("fill-opacity", *opacity));
        svg.append(text((x + 28.0, y), "start", TEXT_SIZE, label));
        x += width + 20.0;
    }
    y - at.1
}

/// A figure of panels below each other, each with its legend under its title.
///
/// `width` and `panel_height` in pixels; 640 by 300 is legible on a page.
///
/// ```
/// use smam::report::{BLUE, Panel, Series, figure_svg};
///
/// let loading = Series { label: "loading".to_owned(), colour: BLUE, x: vec![0.0, 3.0], y: vec![0.0, 26.9] };
/// let panel = Panel {
///     x_label: "plunger (mm)".to_owned(),
///     y_label: "elongation (mm)".to_owned(),
///     series: vec![loading],
///     ..Panel::default()
/// };
/// let svg = figure_svg(&[panel], 640.0, 300.0);
/// assert!(["plunger (mm)", "elongation (mm)", "loading"].iter().all(|text| svg.contains(text)));
/// // Nothing is fetched.
/// assert!(!svg.contains("href"));
/// ```
pub fn figure_svg(panels: &[Panel], width: f64, panel_height: f64) -> String {
    const GAP: f64 = 10.0;
    const LEGEND_HEIGHT: f64 = 20.0;
    let mut svg = Group::new();
    let mut y = GAP;
    for panel in panels {
        let legend_at = (LEFT_MARGIN, y + panel_height + 12.0);
        let more_rows = draw_legend(&mut svg, legend_at, width - RIGHT_MARGIN, &panel.legend());
        panel.draw(&mut svg, Rect { x: 0.0, y, width, height: panel_height });
        y += panel_height + LEGEND_HEIGHT + more_rows + GAP;
    }
    document(width, y, svg)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::BLUE;

    #[test]
    fn a_long_legend_takes_another_row() {
        let mut svg = Group::new();
        let entries = [("first line", BLUE, 1.0), ("second line", BLUE, 1.0), ("third line", BLUE, 1.0)];
        assert_eq!(draw_legend(&mut svg, (0.0, 20.0), 1000.0, &entries), 0.0);
        assert_eq!(draw_legend(&mut svg, (0.0, 20.0), 150.0, &entries), 2.0 * LINE_HEIGHT);
    }

    #[test]
    fn long_ticks_stand_clear_of_the_label() {
        let with = |y: Vec<f64>| Panel {
            series: vec![Series { label: String::new(), colour: BLUE, x: vec![0.0, 1.0], y }],
            ..Panel::default()
        };
        let left = |y: Vec<f64>| with(y).plot_area(Rect { x: 0.0, y: 0.0, width: 600.0, height: 300.0 }).0.x;
        assert_eq!(left(vec![0.0, 1.0]), LEFT_MARGIN);
        assert!(left(vec![0.123_456_78, 0.123_456_9]) > LEFT_MARGIN + 10.0);
    }

    #[test]
    fn figure_names_axes_and_lines_and_cuts_at_missing_points() {
        let panel = Panel {
            title: vec!["Force & stroke".to_owned()],
            x_label: "stroke (mm)".to_owned(),
            y_label: "force (N)".to_owned(),
            series: vec![Series {
                label: "measured".to_owned(),
                colour: BLUE,
                x: vec![0.0, 1.0, 2.0, 3.0],
                y: vec![1.0, f64::NAN, 2.0, 3.0],
            }],
            ..Panel::default()
        };
        let svg = figure_svg(&[panel], 640.0, 300.0);
        for text in ["Force &amp; stroke", "stroke (mm)", "force (N)", "measured"] {
            assert!(svg.lines().any(|line| line == text), "{text}");
        }
        assert_eq!(svg.matches("<polyline").count(), 2);
    }
}
