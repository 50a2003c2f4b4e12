//! A structure of Thrift's compact protocol, walked through before the library reads it.
//!
//! Elements of a list of booleans take no byte when the library skips a list that it does not know: eighteen bytes can claim two
//! thousand million of them. Parquet's own structures have no such list outside its page index, which is not read.

use std::io::{self, Read};

/// Structures within structures, at most, as in the library.
const DEEPEST: u8 = 64;

const STOP: u8 = 0;

/// Walks through one structure, all that it holds included.
///
/// # Errors
/// An end of file in its middle, an unknown type, a list or map of booleans.
pub(super) fn walk(from: &mut impl Read) -> Result<(), &'static str> {
    structure(from, DEEPEST)
}

fn structure(from: &mut impl Read, depth: u8) -> Result<(), &'static str> {
    loop {
        let head = byte(from)?;
        if head & 0x0f == STOP {
            return Ok(());
        }
        if head & 0xf0 == 0 {
            varint(from)?;
        }
        match head & 0x0f {
            // The value of a boolean field is its type.
            1 | 2 => {}
            kind => value(from, kind, depth)?,
        }
    }
}

fn value(from: &mut impl Read, kind: u8, depth: u8) -> Result<(), &'static str> {
    let depth = depth.checked_sub(1).ok_or("its structures are nested too deeply")?;
    match kind {
        1 | 2 => Err("it holds a list of booleans, which no Parquet file needs"),
        3 => byte(from).map(|_| ()),
        4..=6 => varint(from).map(|_| ()),
        7 => skip(from, 8),
        8 => {
            let length = varint(from)?;
            skip(from, length)
        }
        9 | 10 => list(from, depth),
        11 => map(from, depth),
        12 => structure(from, depth),
        13 => skip(from, 16),
        _ => Err("it holds a value of an unknown kind"),
    }
}

fn list(from: &mut impl Read, depth: u8) -> Result<(), &'static str> {
    let head = byte(from)?;
    let count = if head >> 4 == 15 { varint(from)? } else { u64::from(head >> 4) };
    (0..count).try_for_each(|_| value(from, head & 0x0f, depth))
}

fn map(from: &mut impl Read, depth: u8) -> Result<(), &'static str> {
    let count = varint(from)?;
    if count == 0 {
        return Ok(());
    }
    let kinds = byte(from)?;
    (0..count).try_for_each(|_| {
        value(from, kinds >> 4, depth)?;
        value(from, kinds & 0x0f, depth)
    })
}

const ENDS: &str = "it ends in the middle of a structure";

fn byte(from: &mut impl Read) -> Result<u8, &'static str> {
    let mut one = [0];
    from.read_exact(&mut one).map_err(|_| ENDS)?;
    Ok(one[0])
}

/// A number in groups of seven bits, the lowest first.
fn varint(from: &mut impl Read) -> Result<u64, &'static str> {
    let mut number = 0_u64;
    for shift in (0..64).step_by(7) {
        let byte = byte(from)?;
        number |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Ok(number);
        }
    }
    Err("a number in it has more than 64 bits")
}

fn skip(from: &mut impl Read, bytes: u64) -> Result<(), &'static str> {
    let skipped = io::copy(&mut from.by_ref().take(bytes), &mut io::sink()).map_err(|_| ENDS)?;
    if skipped == bytes { Ok(()) } else { Err(ENDS) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(mut bytes: &[u8]) -> Result<usize, &'static str> {
        walk(&mut bytes).map(|()| bytes.len())
    }

    #[test]
    fn every_kind_of_value_is_walked_through() {
        // Booleans, a byte, a number, a double, a text, a list of two texts, a map, a structure, a long field name; a byte is left.
        let structure = [
            &[0x11, 0x12, 0x13, 7, 0x15, 0x80, 0x01, 0x17][..],
            &[0; 8],
            &[0x18, 2, b'a', b'b', 0x19, 0x28, 1, b'a', 1, b'b', 0x1b, 1, 0x85, 1, b'k', 3],
            &[0x1c, 0x15, 2, 0, 0x05, 0x40, 9, 0x1b, 0, 0, 0xee],
        ];
        assert_eq!(said(&structure.concat()), Ok(1));
        assert_eq!(said(&[0x15]), Err(ENDS));
        assert_eq!(said(&[0x18, 5, b'a']), Err(ENDS));
        assert!(said(&[0x1e, 0]).is_err());
        assert!(said(&[0x1c; 100]).is_err());
    }

    /// Found by fuzzing: two thousand million booleans in nine bytes took the library twelve seconds.
    #[test]
    fn lists_and_maps_of_booleans_are_refused() {
        let list = [0x99, 0xf2, 0xff, 0xff, 0xff, 0xde, 0x07, 0x26, 0xfb];
        assert!(said(&list).expect_err("booleans").contains("list of booleans"));
        assert!(said(&[0x1b, 0xff, 0xff, 0x07, 0x11, 0]).is_err());
    }
}
