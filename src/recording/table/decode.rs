//! Bytes to text.

use encoding_rs::{Encoding, UTF_8};

use super::place::Problem;

/// The text of some bytes, without its byte order mark. A mark decides; else what was said; else it is UTF-8.
pub(super) fn decode(bytes: &[u8], said: Option<&'static Encoding>) -> Result<String, Problem> {
    let (encoding, mark) = Encoding::for_bom(bytes).unwrap_or((said.unwrap_or(UTF_8), 0));
    let body = &bytes[mark..];
    let is_single = encoding.is_ascii_compatible();
    if let Some(at) = body.iter().position(|byte| *byte == 0).filter(|_| is_single) {
        let problem = "is not UTF-8 text but UTF-16 or no text at all\n  remedy: save the file as CSV in UTF-8, or say \
                       encoding = \"utf-16le\" in recordings.toml";
        return Err(Problem::at_line(line_of(body, at), problem));
    }
    if encoding == UTF_8 {
        return match std::str::from_utf8(body) {
            Ok(text) => Ok(text.to_owned()),
            Err(e) => Err(Problem::at_line(
                line_of(body, e.valid_up_to()),
                "is not UTF-8 text\n  remedy: save the file as CSV in UTF-8, or say encoding = \"windows-1252\" in recordings.toml",
            )),
        };
    }
    let (text, had_errors) = encoding.decode_without_bom_handling(body);
    if had_errors {
        let at = text.find('\u{fffd}').unwrap_or(0);
        return Err(Problem::at_line(
            line_of(text.as_bytes(), at),
            format!(
                "is no text in {}\n  remedy: say the right encoding in recordings.toml; `smam import` guesses it",
                encoding.name()
            ),
        ));
    }
    Ok(text.into_owned())
}

/// The whole lines of a text that ends in NUL bytes, as one does whose machine lost its power while it was written, and what to say
/// of it. Of the last line nobody knows how much of it is lost.
pub(in crate::recording) fn without_nul_end(bytes: &[u8]) -> (&[u8], Option<String>) {
    let end = bytes.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
    // UTF-16 has such bytes all over.
    if end == bytes.len() || end == 0 || bytes[..end].contains(&0) {
        return (bytes, None);
    }
    let whole = bytes[..end].iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    let line = if whole < end { format!(", and line {}, which they cut,", line_of(bytes, end)) } else { String::new() };
    let count = bytes.len() - end;
    (&bytes[..whole], Some(format!("ends in {count} NUL bytes, as after a loss of power: they{line} are left out")))
}

/// The line, from 1, of a byte. Ends of lines are `\n`, `\r\n` or `\r` alone.
fn line_of(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "time_s,winkel [°]\n0,1\n";

    fn utf16(big_endian: bool, mark: bool) -> Vec<u8> {
        let units = mark.then_some(0xfeff).into_iter().chain(TEXT.encode_utf16());
        units.flat_map(|u: u16| if big_endian { u.to_be_bytes() } else { u.to_le_bytes() }).collect()
    }

    #[test]
    fn nul_bytes_at_the_end_are_left_out_with_the_line_they_cut() {
        let (whole, said) = without_nul_end(b"t,a\n0,1\n0.1,2\0\0\0");
        assert_eq!(whole, b"t,a\n0,1\n");
        assert!(said.is_some_and(|said| said.contains("3 NUL bytes") && said.contains("line 3, which they cut")));
        let (whole, said) = without_nul_end(b"t,a\n0,1\n\0");
        assert_eq!((whole, said.is_some_and(|said| !said.contains("cut"))), (&b"t,a\n0,1\n"[..], true));
        for other in [&b"t,a\n0,1\n"[..], b"t\0,\0a\0\n\0", b"\0\0", b""] {
            assert_eq!(without_nul_end(other), (other, None));
        }
    }

    #[test]
    fn every_encoding_gives_the_same_text() {
        let said = |label: &str| Encoding::for_label(label.as_bytes());
        assert_eq!(decode(TEXT.as_bytes(), None).unwrap(), TEXT);
        assert_eq!(decode(format!("\u{feff}{TEXT}").as_bytes(), None).unwrap(), TEXT);
        assert_eq!(decode(&utf16(false, true), None).unwrap(), TEXT);
        assert_eq!(decode(&utf16(true, true), None).unwrap(), TEXT);
        assert_eq!(decode(&utf16(false, false), said("utf-16le")).unwrap(), TEXT);
        assert_eq!(decode(&utf16(true, false), said("utf-16be")).unwrap(), TEXT);
        let latin: Vec<u8> = TEXT.chars().map(|c| c as u8).collect();
        assert_eq!(decode(&latin, said("latin1")).unwrap(), TEXT);
        assert_eq!(decode(&[0xce, 0xbb], said("gbk")).unwrap(), "位");
    }

    #[test]
    fn what_is_no_such_text_is_refused_with_its_line() {
        let latin: Vec<u8> = format!("a\n{TEXT}").chars().map(|c| c as u8).collect();
        assert_eq!(decode(&latin, None).unwrap_err().line, Some(2));
        assert!(decode(&utf16(false, false), None).unwrap_err().text.contains("utf-16le"));
        let problem = decode(b"a\n\xff\xff", Encoding::for_label(b"gbk")).unwrap_err();
        assert!(problem.line == Some(2) && problem.text.contains("remedy: "), "{problem:?}");
    }
}
