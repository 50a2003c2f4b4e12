//! Words of a command line, as a user can copy them into a shell.

use std::path::Path;

/// A path as a word of a command: between quotes where a shell would take it apart.
pub fn quoted(path: &Path) -> String {
    word(&path.display().to_string())
}

/// A text as a word of a command.
pub fn word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./\\:,=+@%".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    // A quote inside quotes: closed, written on its own, opened again.
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_shell_would_take_apart_is_quoted() {
        assert_eq!(word("out/a_1.csv"), "out/a_1.csv");
        assert_eq!(word("my rig/a.csv"), "'my rig/a.csv'");
        assert_eq!(word("it's"), r"'it'\''s'");
        assert_eq!((word(""), word("a;b")), ("''".to_owned(), "'a;b'".to_owned()));
    }
}
