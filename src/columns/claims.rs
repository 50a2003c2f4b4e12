//! A Parquet file whose pages are asked first how large they claim to be.
//!
//! The library makes room for what a page's header says that it will be when unpacked, up to 2 GiB, and for as many values as a
//! dictionary's says that it has, before it looks at the page: a file of three kilobytes can ask for all memory there is.

use std::fs::File;
use std::io::{self, BufReader, Read};

use bytes::Bytes;
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};

use super::parquet_shapes::{FILE, PAGE};
use super::thrift::walk;

/// The densest that Snappy gets is a copy of 64 bytes in three: 21 times.
const DENSEST: u64 = 32;
/// Room for what a page has besides.
const ALWAYS_BYTES: u64 = 1 << 16;

/// Fields of a page's header begin so: the next field, a 32-bit number.
const NEXT_NUMBER: u8 = 0x15;
/// Lower half of a field that is a structure.
const STRUCTURE: u8 = 0x0c;
/// Kind of a page that is a dictionary.
const DICTIONARY: u64 = 2;
/// Length of a file's end, which is read as pages' headers are.
const END_BYTES: u64 = 8;
/// The very end of a file whose description is encrypted: another structure, which the library refuses unread.
const ENCRYPTED: &[u8] = b"PARE";

/// A file that refuses to hand out a page which claims too much.
pub(super) struct Checked(pub File);

/// Reading on at the end of the file is an error: the library asks two thousand million times for a header's text that is not
/// there.
pub(super) struct UpToTheEnd(BufReader<File>);

impl Read for UpToTheEnd {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        match self.0.read(to)? {
            0 if !to.is_empty() => Err(io::ErrorKind::UnexpectedEof.into()),
            count => Ok(count),
        }
    }
}

impl Length for Checked {
    fn len(&self) -> u64 {
        self.0.len()
    }
}

impl ChunkReader for Checked {
    type T = UpToTheEnd;

    /// The library reads a page's header through this, and the page itself through `get_bytes`.
    fn get_read(&self, start: u64) -> Result<Self::T> {
        if start.saturating_add(END_BYTES) != self.len() {
            check(claim(self.0.get_read(start)?)).map_err(ParquetError::General)?;
            walk(&mut self.0.get_read(start)?, &PAGE).map_err(|e| damaged("a page's header", e))?;
        }
        Ok(UpToTheEnd(self.0.get_read(start)?))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        if start.saturating_add(length as u64) > self.len() {
            return Err(ParquetError::EOF(format!("{length} bytes from {start} on are not there")));
        }
        let bytes = self.0.get_bytes(start, length)?;
        // What describes the whole file stands right before its end.
        if start + length as u64 + END_BYTES == self.len() && !self.is_encrypted()? {
            walk(&mut bytes.as_ref(), &FILE).map_err(|e| damaged("its description", e))?;
        }
        Ok(bytes)
    }
}

impl Checked {
    fn is_encrypted(&self) -> Result<bool> {
        let start = self.len().saturating_sub(ENCRYPTED.len() as u64);
        Ok(self.0.get_bytes(start, ENCRYPTED.len())? == ENCRYPTED)
    }
}

fn damaged(what: &str, how: &str) -> ParquetError {
    ParquetError::General(format!("{what} is damaged: {how}"))
}

/// What a page's header says.
#[derive(Debug, PartialEq, Eq)]
struct Claim {
    /// Sizes in bytes.
    unpacked: u64,
    packed: u64,
    /// Of a dictionary.
    values: Option<u64>,
}

/// Why a page is not to be read.
fn check(claim: Option<Claim>) -> std::result::Result<(), String> {
    // All writers write the fields in order and none of them negative; another order would get past this check.
    let Some(Claim { unpacked, packed, values }) = claim else {
        return Err("a page's header does not begin with kind and sizes".to_owned());
    };
    if unpacked > DENSEST * packed + ALWAYS_BYTES {
        return Err(format!("a page of {packed} bytes claims to be {unpacked} when unpacked"));
    }
    match values.filter(|values| *values > unpacked) {
        Some(values) => Err(format!("a dictionary of {unpacked} bytes claims to have {values} values")),
        None => Ok(()),
    }
}

/// What the first fields of a page's header say: kind and sizes, a checksum if there is one, and of a dictionary's own header
/// the number of values.
fn claim(mut header: impl Read) -> Option<Claim> {
    let kind = number(&mut header)?;
    let (unpacked, packed) = (number(&mut header)?, number(&mut header)?);
    if kind != DICTIONARY {
        return Some(Claim { unpacked, packed, values: None });
    }
    let mut next = byte(&mut header)?;
    if next == NEXT_NUMBER {
        // A checksum may be any number.
        while byte(&mut header)? & 0x80 != 0 {}
        next = byte(&mut header)?;
    }
    let values = if next & 0x0f == STRUCTURE { number(&mut header)? } else { return None };
    Some(Claim { unpacked, packed, values: Some(values) })
}

/// The next field, if it is a 32-bit number.
fn number(header: &mut impl Read) -> Option<u64> {
    if byte(header)? == NEXT_NUMBER { zigzag(header) } else { None }
}

fn byte(from: &mut impl Read) -> Option<u8> {
    let mut one = [0];
    from.read_exact(&mut one).ok()?;
    Some(one[0])
}

/// A 32-bit number of Thrift's compact protocol that is not negative; of a longer one the lower 32 bits, as the library takes
/// it.
fn zigzag(from: &mut impl Read) -> Option<u64> {
    let mut value = 0_u64;
    for shift in (0..64).step_by(7) {
        let byte = byte(from)?;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            let signed = (value >> 1) as i64 ^ -((value & 1) as i64);
            return u64::try_from(signed as i32).ok();
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kind_and_sizes_are_read_and_nothing_else() {
        let said = |unpacked, packed| Some(Claim { unpacked, packed, values: None });
        // Kind 0, unpacked 300, packed 24.
        assert_eq!(claim(&[0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x30][..]), said(300, 24));
        assert_eq!(claim(&b"\x15\x02\x00\x00PAR1"[..]), None);
        assert_eq!(claim(&[0x15, 0x01, 0x15, 0x02, 0x15, 0x02][..]), None);
        assert_eq!(claim(&[0x15, 0x00, 0x15, 0xff, 0xff, 0xff, 0xff, 0xff][..]), None);
        let longer = [0x15, 0x00, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x8f, 0x02, 0x15, 0x02];
        assert_eq!(claim(&longer[..]), said(0x7fff_ffff, 1));
        assert_eq!(claim(&[0x15][..]), None);
    }

    #[test]
    fn a_dictionary_has_no_more_values_than_bytes() {
        // Kind 2, unpacked 16, packed 16; its header, the fourth field on, has 2 values; the same after a checksum.
        let bare = [0x15, 0x04, 0x15, 0x20, 0x15, 0x20, 0x4c, 0x15, 0x04];
        let summed = [0x15, 0x04, 0x15, 0x20, 0x15, 0x20, 0x15, 0xff, 0x01, 0x3c, 0x15, 0x04];
        for header in [&bare[..], &summed[..]] {
            assert_eq!(claim(header), Some(Claim { unpacked: 16, packed: 16, values: Some(2) }));
        }
        assert!(check(claim(&bare[..])).is_ok());
        let many = check(Some(Claim { unpacked: 16, packed: 16, values: Some(17) }));
        assert_eq!(many, Err("a dictionary of 16 bytes claims to have 17 values".to_owned()));
        assert!(check(None).is_err());
    }
}
