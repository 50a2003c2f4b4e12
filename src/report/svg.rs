//! What static figures are drawn with. Lengths are pixels, y points down.

use svg::Document;
use svg::node::element::{Group, Line, Polyline, Rectangle, Text};

/// Width of a letter over the font size, on the wide side: room is reserved by it.
const LETTER_WIDTH: f64 = 0.6;
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// A rectangle: left and upper edge, width and height, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Rect {
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// A tenth of a pixel is as fine as anybody sees.
fn px(length: f64) -> f64 {
    (10.0 * length).round() / 10.0
}

pub(super) fn line(from: (f64, f64), to: (f64, f64), colour: &str, width: f64) -> Line {
    let ends = Line::new().set("x1", px(from.0)).set("y1", px(from.1)).set("x2", px(to.0)).set("y2", px(to.1));
    ends.set("stroke", colour).set("stroke-width", width)
}

/// Filled with a colour, or with `none`.
pub(super) fn rectangle(rect: Rect, fill: &str) -> Rectangle {
    let corner = Rectangle::new().set("x", px(rect.x)).set("y", px(rect.y));
    corner.set("width", px(rect.width)).set("height", px(rect.height)).set("fill", fill)
}

pub(super) fn polyline(points: &[(f64, f64)], colour: &str, width: f64) -> Polyline {
    // Round caps make a point of a line without length.
    let again = points.first().filter(|_| points.len() == 1);
    let list: Vec<_> = points.iter().chain(again).map(|(x, y)| format!("{},{}", px(*x), px(*y))).collect();
    let drawn = Polyline::new().set("points", list).set("fill", "none").set("stroke", colour);
    drawn.set("stroke-width", width).set("stroke-linejoin", "round").set("stroke-linecap", "round")
}

/// `anchor`: which end of the text stands at its point, `start`, `middle` or `end`.
pub(super) fn text(at: (f64, f64), anchor: &str, size: f64, text: &str) -> Text {
    // The format allows no control characters.
    let placed = Text::new(text.replace(char::is_control, " ")).set("x", px(at.0)).set("y", px(at.1));
    placed.set("text-anchor", anchor).set("font-size", size)
}

/// Running upwards, centred on a point.
pub(super) fn text_up(at: (f64, f64), size: f64, words: &str) -> Text {
    text(at, "middle", size, words).set("transform", format!("rotate(-90 {} {})", px(at.0), px(at.1)))
}

/// The whole, on white.
pub(super) fn document(width: f64, height: f64, drawn: Group) -> String {
    let (width, height) = (px(width), px(height));
    let sized = Document::new().set("width", width).set("height", height).set("viewBox", (0, 0, width, height));
    let paper = rectangle(Rect { x: 0.0, y: 0.0, width, height }, "#ffffff");
    format!("{}\n", sized.add(paper).add(drawn.set("font-family", FONTS).set("fill", "#222222")))
}

/// Width that a text needs at most, roughly, px.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * LETTER_WIDTH * size
}

/// A text cut to a width (px), with an ellipsis where it was cut.
pub(super) fn cut_to(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let letters = (width / (LETTER_WIDTH * size)) as usize;
    let mut cut: String = text.chars().take(letters.saturating_sub(1)).collect();
    cut.push('…');
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_cut() {
        assert_eq!(cut_to("abcdefghij", 10.0, 30.0), "abcd…");
        assert_eq!(cut_to("abc", 10.0, 30.0), "abc");
    }

    #[test]
    fn file_is_closed_and_sized() {
        let text = document(20.0, 10.0, Group::new().add(polyline(&[(1.0, 2.0)], "#000000", 1.0)));
        assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
        assert!(text.contains(r#"viewBox="0 0 20 10""#), "{text}");
        assert!(text.contains(r#"points="1,2 1,2""#), "{text}");
    }
}
