//! Text on its way into a page.

/// Text as HTML takes it.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // It allows no other control characters.
            control if control.is_control() => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

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

/// A cell of a CSV file.
pub(super) fn csv_cell(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b & \"c\"\n"), "a&lt;b &amp; &quot;c&quot; ");
        assert_eq!([csv_cell("a"), csv_cell("a,\"b\"")], ["a", "\"a,\"\"b\"\"\""]);
    }

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
}
