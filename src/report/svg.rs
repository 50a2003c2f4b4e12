//! A minimal SVG writer: lines, rectangles, polylines, text. Lengths are pixels, y points down.

use std::fmt::Write as _;

use super::kit::escaped;

/// Width of a letter over the font size, on the wide side: room is reserved by it.
const LETTER_WIDTH: f64 = 0.6;

/// A rectangle on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    /// Left edge, px.
    pub x: f64,
    /// Upper edge, px.
    pub y: f64,
    /// Width, px.
    pub width: f64,
    /// Height, px.
    pub height: f64,
}

impl Rect {
    /// Right edge, px.
    pub fn right(&self) -> f64 {
        self.x + self.width
    }

    /// Lower edge, px.
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// Which end of a text stands at its point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn keyword(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// An SVG text in the making.
pub(super) struct Svg {
    width: f64,
    height: f64,
    body: String,
}

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new() }
    }

    /// Another size of the whole, once it is known.
    pub(super) fn resize(&mut self, width: f64, height: f64) {
        (self.width, self.height) = (width, height);
    }

    fn push(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64) {
        self.push(&format!(
            r#"<line x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" stroke="{colour}" stroke-width="{width}"/>"#,
            from.0, from.1, to.0, to.1
        ));
    }

    /// A filled rectangle without an outline.
    pub(super) fn fill(&mut self, rect: Rect, colour: &str, opacity: f64) {
        self.push(&format!(
            r#"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" fill="{colour}" fill-opacity="{opacity}"/>"#,
            rect.x, rect.y, rect.width, rect.height
        ));
    }

    pub(super) fn frame(&mut self, rect: Rect, colour: &str) {
        self.push(&format!(
            r#"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" fill="none" stroke="{colour}"/>"#,
            rect.x, rect.y, rect.width, rect.height
        ));
    }

    pub(super) fn polyline(&mut self, points: &[(f64, f64)], colour: &str, width: f64) {
        let mut list = String::with_capacity(12 * points.len());
        for (x, y) in points {
            let _ = write!(list, "{x:.1},{y:.1} "); // a String takes every write
        }
        if let [(x, y)] = points {
            // Round caps make a point of a line without length.
            let _ = write!(list, "{x:.1},{y:.1} ");
        }
        self.push(&format!(
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"/>"#,
            list.trim_end()
        ));
    }

    pub(super) fn text(&mut self, at: (f64, f64), anchor: Anchor, size: f64, text: &str) {
        self.push(&format!(
            r#"<text x="{:.1}" y="{:.1}" text-anchor="{}" font-size="{size}">{}</text>"#,
            at.0,
            at.1,
            anchor.keyword(),
            escaped(text)
        ));
    }

    /// Text running upwards, centred on a point.
    pub(super) fn text_up(&mut self, at: (f64, f64), size: f64, text: &str) {
        self.push(&format!(
            r#"<text transform="translate({:.1} {:.1}) rotate(-90)" text-anchor="middle" font-size="{size}">{}</text>"#,
            at.0,
            at.1,
            escaped(text)
        ));
    }

    pub(super) fn finish(self) -> String {
        let (width, height) = (self.width, self.height);
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif" fill="#222222">
<rect width="{width}" height="{height}" fill="#ffffff"/>
{}</svg>
"##,
            self.body
        )
    }
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
        let mut svg = Svg::new(20.0, 10.0);
        svg.polyline(&[(1.0, 2.0)], "#000000", 1.0);
        let text = svg.finish();
        assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
        assert!(text.contains(r#"viewBox="0 0 20 10""#));
        assert!(text.contains(r#"points="1.0,2.0 1.0,2.0""#));
    }
}
