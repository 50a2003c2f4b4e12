//! Bars with intervals, in groups: what each of several things contributes.

use super::axis::Axis;
use super::panel::draw_legend;
use super::svg::{Anchor, GREY, Rect, Svg, cut_to};

const WIDTH: f64 = 720.0;
const NAMES: f64 = 250.0;
const EDGE: f64 = 14.0;
const TITLE: f64 = 46.0;
const BAR: f64 = 11.0;
const GAP: f64 = 9.0;
const AXIS: f64 = 44.0;
const TEXT_SIZE: f64 = 11.0;

/// A value and the ends of its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// One plot: a group of bars for each name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BarPanel {
    pub title: String,
    /// Text below the axis, with the unit.
    pub label: String,
    /// What the bars of each group are, with their colours.
    pub legend: Vec<(String, &'static str)>,
    /// Name and bars, in the order of the legend.
    pub groups: Vec<(String, Vec<Bar>)>,
}

/// A figure of such plots below each other.
pub fn bars_svg(panels: &[BarPanel]) -> String {
    let mut svg = Svg::new(WIDTH, panels.iter().map(BarPanel::height).sum());
    let mut y = 0.0;
    for panel in panels {
        panel.draw(&mut svg, y);
        y += panel.height();
    }
    svg.finish()
}

impl BarPanel {
    fn group_height(&self) -> f64 {
        BAR * self.legend.len() as f64 + GAP
    }

    fn height(&self) -> f64 {
        TITLE + self.group_height() * self.groups.len() as f64 + AXIS
    }

    fn draw(&self, svg: &mut Svg, top: f64) {
        let height = self.group_height() * self.groups.len() as f64;
        let plot = Rect { x: NAMES, y: top + TITLE, width: WIDTH - NAMES - EDGE, height };
        let ends = self.groups.iter().flat_map(|(_, bars)| bars).flat_map(|b| [b.low, b.value, b.high]);
        let axis = Axis::over(ends.chain([0.0]), 0.02, 6);
        let at = |value: f64| plot.x + axis.share(value) * plot.width;
        svg.text((EDGE, top + 18.0), Anchor::Start, 12.0, &cut_to(&self.title, 12.0, WIDTH - 2.0 * EDGE));
        let entries: Vec<_> = self.legend.iter().map(|(name, colour)| (name.as_str(), *colour, 1.0)).collect();
        draw_legend(svg, (plot.x, top + 38.0), f64::INFINITY, &entries);
        for (value, text) in axis.ticks() {
            svg.line((at(value), plot.y), (at(value), plot.bottom()), "#e4e4e4", 1.0);
            svg.text((at(value), plot.bottom() + 14.0), Anchor::Middle, TEXT_SIZE, &text);
        }
        svg.text((plot.x + plot.width / 2.0, plot.bottom() + 31.0), Anchor::Middle, TEXT_SIZE, &self.label);
        for (i, (name, bars)) in self.groups.iter().enumerate() {
            let y = plot.y + self.group_height() * i as f64 + GAP / 2.0;
            let middle = y + BAR * self.legend.len() as f64 / 2.0 + 4.0;
            svg.text((plot.x - 8.0, middle), Anchor::End, TEXT_SIZE, &cut_to(name, TEXT_SIZE, NAMES - 16.0));
            for (j, (bar, (_, colour))) in bars.iter().zip(&self.legend).enumerate() {
                draw_bar(svg, bar, colour, y + BAR * j as f64, &at);
            }
        }
        svg.line((at(0.0), plot.y), (at(0.0), plot.bottom()), GREY, 1.0);
        svg.frame(plot, GREY);
    }
}

fn draw_bar(svg: &mut Svg, bar: &Bar, colour: &'static str, y: f64, at: &impl Fn(f64) -> f64) {
    if !bar.value.is_finite() {
        return;
    }
    let (from, to) = (at(bar.value.min(0.0)), at(bar.value.max(0.0)));
    svg.fill(Rect { x: from, y: y + 1.5, width: to - from, height: BAR - 3.0 }, colour, 0.75);
    let middle = y + BAR / 2.0;
    if bar.low.is_finite() && bar.high.is_finite() {
        svg.line((at(bar.low), middle), (at(bar.high), middle), "#222222", 1.2);
        for end in [bar.low, bar.high] {
            svg.line((at(end), middle - 3.0), (at(end), middle + 3.0), "#222222", 1.2);
        }
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
            groups: vec![("a".to_owned(), vec![bar(0.3), bar(0.4)]), ("b".to_owned(), vec![bar(f64::NAN), bar(-0.1)])],
        };
        let svg = bars_svg(&[panel]);
        // Three bars; ground and two swatches besides.
        assert_eq!(svg.matches("fill-opacity=\"0.75\"").count(), 3);
        for text in ["range &amp; co", ">share of the variance<", ">alone<", ">in all<", ">a<", ">b<"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
