//! A structure of Thrift's compact protocol, walked through before the library reads it.
//!
//! Elements of a list of booleans take no byte when the library skips a list that it does not know: eighteen bytes can claim two
//! thousand million of them. Parquet's own structures have no such list outside its page index, which is not read.
//!
//! A field that the library knows it reads as what Parquet says that it is, whatever the file says; only of others does it go by
//! the file. The walk would come out elsewhere than the library if a known field said to be something else: so none may.

use std::io::{self, Read};
use std::ops::RangeInclusive;

/// Structures within structures, at most, as in the library.
const DEEPEST: u8 = 64;

const STOP: u8 = 0;
/// Yes and no; as elements of a list either stands for both.
const BOOLEANS: RangeInclusive<u8> = 1..=2;

/// What a structure holds: fields that the library knows, by their numbers.
pub(super) struct Shape(pub &'static [(i16, Kind)]);

impl Shape {
    fn kind(&self, number: i16) -> &'static Kind {
        self.0.iter().find(|(known, _)| *known == number).map_or(&Kind::Any, |(_, kind)| kind)
    }
}

/// What a field or an element of a list is.
pub(super) enum Kind {
    /// Whatever the file says: the library does not know it.
    Any,
    /// A boolean, as a field.
    Boolean,
    /// A number of eight bits. Some writers say more of it; the library takes one byte all the same, or passes over what they
    /// say: it must be one byte either way.
    Byte,
    /// A whole number of 16, 32 or 64 bits. All are written alike, and some writers call one the other.
    Whole,
    Double,
    /// Bytes or a text.
    Bytes,
    List(&'static Kind),
    Structure(&'static Shape),
}

impl Kind {
    /// Whether a file may say so of a value of this kind.
    fn is_called(&self, said: u8) -> bool {
        match self {
            Self::Any => true,
            Self::Boolean => BOOLEANS.contains(&said),
            Self::Byte => (3..=6).contains(&said),
            Self::Whole => (4..=6).contains(&said),
            Self::Double => said == 7,
            Self::Bytes => said == 8,
            Self::List(_) => said == 9,
            Self::Structure(_) => said == 12,
        }
    }

    /// Of a list's elements.
    fn element(&self) -> &'static Self {
        if let Self::List(element) = self { element } else { &Self::Any }
    }

    /// Of a structure.
    fn shape(&self) -> &'static Shape {
        if let Self::Structure(shape) = self { shape } else { &Shape(&[]) }
    }
}

/// Walks through one structure, all that it holds included.
///
/// # Errors
/// An end of file in its middle, an unknown type, a known field of another type than its own, a list or map of booleans.
pub(super) fn walk(from: &mut impl Read, shape: &Shape) -> Result<(), &'static str> {
    structure(from, shape, DEEPEST)
}

fn structure(from: &mut impl Read, shape: &Shape, depth: u8) -> Result<(), &'static str> {
    let mut number = 0;
    loop {
        let head = byte(from)?;
        let said = head & 0x0f;
        if said == STOP {
            return Ok(());
        }
        number = field_number(from, head >> 4, number)?;
        let kind = shape.kind(number);
        check(kind, said)?;
        // The value of a boolean field is its type.
        if !BOOLEANS.contains(&said) {
            value(from, said, kind, depth)?;
        }
    }
}

/// A field's number: so many after the last one's, or its own after the head.
fn field_number(from: &mut impl Read, further: u8, last: i16) -> Result<i16, &'static str> {
    if further != 0 {
        return last.checked_add(i16::from(further)).ok_or("the number of a field in it is too large");
    }
    let number = varint(from)?;
    // Of a longer one the library takes the lower 16 bits.
    Ok((number >> 1) as i16 ^ -((number & 1) as i16))
}

const OTHER: &str = "a value in it is of another kind than Parquet says";

fn check(kind: &Kind, said: u8) -> Result<(), &'static str> {
    if kind.is_called(said) { Ok(()) } else { Err(OTHER) }
}

fn value(from: &mut impl Read, said: u8, kind: &Kind, depth: u8) -> Result<(), &'static str> {
    let depth = depth.checked_sub(1).ok_or("its structures are nested too deeply")?;
    match said {
        1 | 2 => Err("it holds a list of booleans, which no Parquet file needs"),
        3 => byte(from).map(|_| ()),
        4..=6 if matches!(kind, Kind::Byte) => match byte(from)? {
            0..0x80 => Ok(()),
            _ => Err(OTHER),
        },
        4..=6 => varint(from).map(|_| ()),
        7 => skip(from, 8),
        8 => {
            let length = varint(from)?;
            skip(from, length)
        }
        9 | 10 => list(from, kind.element(), depth),
        11 => map(from, depth),
        12 => structure(from, kind.shape(), depth),
        13 => skip(from, 16),
        _ => Err("it holds a value of an unknown kind"),
    }
}

fn list(from: &mut impl Read, element: &Kind, depth: u8) -> Result<(), &'static str> {
    let head = byte(from)?;
    let said = head & 0x0f;
    let count = if head >> 4 == 15 { varint(from)? } else { u64::from(head >> 4) };
    // Some writers say nothing of the elements of an empty list, or anything.
    if count != 0 {
        check(element, said)?;
    }
    (0..count).try_for_each(|_| value(from, said, element, depth))
}

fn map(from: &mut impl Read, depth: u8) -> Result<(), &'static str> {
    let count = varint(from)?;
    if count == 0 {
        return Ok(());
    }
    let kinds = byte(from)?;
    (0..count).try_for_each(|_| {
        value(from, kinds >> 4, &Kind::Any, depth)?;
        value(from, kinds & 0x0f, &Kind::Any, depth)
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
    use super::super::parquet_shapes::{FILE, PAGE};
    use super::*;

    const UNKNOWN: Shape = Shape(&[]);

    /// How many bytes are left.
    fn said(shape: &Shape, mut bytes: &[u8]) -> Result<usize, &'static str> {
        walk(&mut bytes, shape).map(|()| bytes.len())
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
        assert_eq!(said(&UNKNOWN, &structure.concat()), Ok(1));
        assert_eq!(said(&UNKNOWN, &[0x15]), Err(ENDS));
        assert_eq!(said(&UNKNOWN, &[0x18, 5, b'a']), Err(ENDS));
        assert!(said(&UNKNOWN, &[0x1e, 0]).is_err());
        assert!(said(&UNKNOWN, &[0x1c; 100]).is_err());
    }

    /// Found by fuzzing: two thousand million booleans in nine bytes took the library twelve seconds.
    #[test]
    fn lists_and_maps_of_booleans_are_refused() {
        let list = [0x99, 0xf2, 0xff, 0xff, 0xff, 0xde, 0x07, 0x26, 0xfb];
        assert!(said(&UNKNOWN, &list).expect_err("booleans").contains("list of booleans"));
        assert!(said(&UNKNOWN, &[0x1b, 0xff, 0xff, 0x07, 0x11, 0]).is_err());
    }

    /// Found by fuzzing: a version that says to be a boolean. The library reads a number there, and takes what was walked through
    /// as a text for a list of two thousand million booleans.
    #[test]
    fn a_known_field_of_another_kind_does_not_hide_a_list_of_booleans() {
        let hidden = [0x12, 0x18, 9, 0x28, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x07, 0, 0, 0];
        assert_eq!(said(&UNKNOWN, &hidden), Ok(0));
        assert_eq!(said(&FILE, &hidden), Err(OTHER));
        assert!(said(&FILE, &[&[0x15, 0x02][..], &hidden[2..]].concat()).is_err());
    }

    #[test]
    fn known_fields_are_of_their_own_kind() {
        // Version 1; a schema of one element, its name "a"; three rows; no row groups, of no kind.
        let file = [0x15, 2, 0x19, 0x1c, 0x48, 1, b'a', 0, 0x16, 6, 0x19, 0, 0];
        assert_eq!(said(&FILE, &file), Ok(0));
        // The version as text, the schema as structure, as list of texts, the name of its element as number.
        let other = [&[0x18, 0, 0][..], &[0x2c, 0, 0], &[0x29, 0x18, 0, 0], &[0x29, 0x1c, 0x45, 2, 0, 0]];
        assert!(other.iter().all(|bytes| said(&FILE, bytes) == Err(OTHER)));

        // A data page: kind and sizes, then four numbers and statistics.
        let page = [0x15, 0, 0x15, 8, 0x15, 8, 0x2c, 0x15, 2, 0x15, 0, 0x15, 6, 0x15, 6, 0x1c, 0, 0, 0];
        assert_eq!(said(&PAGE, &page), Ok(0));
        // A size as boolean, the page's own header as list, a number of values as byte, whether it is packed as number.
        let other = [&[0x25, 0, 0x11, 0][..], &[0x59, 0, 0], &[0x5c, 0x13, 1, 0, 0], &[0x8c, 0x75, 2, 0, 0]];
        assert!(other.iter().all(|bytes| said(&PAGE, bytes) == Err(OTHER)));
        assert_eq!(said(&PAGE, &[0x8c, 0x71, 0, 0]), Ok(0));
    }

    /// Some writers say 64 bits of each number, 32 of a byte, or nothing of an empty list's elements.
    #[test]
    fn what_writers_get_wrong_without_harm_is_let_through() {
        assert_eq!(said(&FILE, &[0x16, 2, 0]), Ok(0));
        // The schema's only element is a whole number of 8 bits, which are 16 if said to be a number of 32.
        let width = |bytes: &[u8]| said(&FILE, &[&[0x29, 0x1c, 0xac, 0xac][..], bytes, &[0x11, 0, 0, 0, 0]].concat());
        assert_eq!((width(&[0x13, 0x10]), width(&[0x15, 0x10])), (Ok(0), Ok(0)));
        // Of two bytes the library would take one, or both where it passes over a second schema.
        assert_eq!((width(&[0x15, 0x80, 0x01]), width(&[0x15, 0x80, 0x00])), (Err(OTHER), Err(OTHER)));
        for element in [0, 1, 3, 8, 12] {
            assert_eq!(said(&FILE, &[0x29, element, 0]), Ok(0));
        }
    }

    #[test]
    fn numbers_of_fields_are_followed() {
        // The field's own number after the head: 1, then one further; of a longer one the lower 16 bits.
        assert_eq!(said(&FILE, &[0x05, 2, 2, 0x18, 0, 0]), Err(OTHER));
        assert_eq!(said(&FILE, &[0x08, 0x82, 0x80, 0x08, 0, 0]), Err(OTHER));
        // Minus one, then two further.
        assert_eq!(said(&FILE, &[0x01, 1, 0x28, 0, 0]), Err(OTHER));
        assert!(said(&UNKNOWN, &[0x01, 0xfe, 0xff, 0x03, 0x11, 0]).is_err());
    }
}
