//! Text on its way into a page.

use super::svg::escaped;

/// Escaped, with what stands between backticks marked as code. A backtick without a second one stays.
pub(super) fn code_marked(text: &str) -> String {
    let pieces: Vec<&str> = text.split('`').collect();
    let mut marked = String::new();
    for (i, piece) in pieces.iter().enumerate() {
        let is_code = i % 2 == 1;
        let has_end = i + 1 < pieces.len();
        marked += &match (is_code, has_end) {
            (true, true) => format!("<code>{}</code>", escaped(piece)),
            (true, false) => format!("`{}", escaped(piece)),
            (false, _) => escaped(piece),
        };
    }
    marked
}

/// Whether a cell of a table is a number, with or without sign and unit, or the dash that stands for none.
pub(super) fn looks_like_number(cell: &str) -> bool {
    let bare = cell.trim_start_matches(['+', '-', '−', '±', '~', ' ']);
    matches!(cell, "-" | "–") || bare.starts_with(|c: char| c.is_ascii_digit()) || matches!(bare, "NaN" | "inf")
}

/// The width that an SVG of this module gives itself, px.
pub(super) fn svg_width(svg: &str) -> Option<f64> {
    let (_, rest) = svg.split_once(" width=\"")?;
    rest.split_once('"')?.0.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backticks_become_code_in_pairs() {
        assert_eq!(code_marked("a `b < c` d"), "a <code>b &lt; c</code> d");
        assert_eq!(code_marked("one ` alone"), "one ` alone");
    }

    #[test]
    fn numbers_are_told_from_words() {
        for cell in ["1", "-2.5e-3", "+0.1 mm", "± 3", "12 %", "-", "–", "5 to 6 N"] {
            assert!(looks_like_number(cell), "{cell}");
        }
        for cell in ["met", "leak in line", "fixed", "-x"] {
            assert!(!looks_like_number(cell), "{cell}");
        }
    }

    #[test]
    fn an_svg_says_how_wide_it_is() {
        assert_eq!(svg_width("<svg xmlns=\"x\" width=\"900\" height=\"3\">"), Some(900.0));
        assert_eq!(svg_width("<svg></svg>"), None);
    }
}
