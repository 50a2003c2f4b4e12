//! A Parquet file whose pages are asked first how large they claim to be.
//!
//! The library makes room for what a page's header says that it will be when unpacked, up to 2 GiB, before it looks at the
//! page: a file of three kilobytes can ask for all memory there is.

use std::fs::File;
use std::io::{BufReader, Read};

use bytes::Bytes;
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};

/// The densest that Snappy gets is a copy of 64 bytes in three: 21 times.
const DENSEST: u64 = 32;
/// Room for what a page has besides.
const ALWAYS_BYTES: u64 = 1 << 16;

/// Fields of a page's header begin so: the next field, a 32-bit number.
const NEXT_NUMBER: u8 = 0x15;

/// A file that refuses to hand out a page which claims too much.
pub(super) struct Checked(pub File);

impl Length for Checked {
    fn len(&self) -> u64 {
        self.0.len()
    }
}

impl ChunkReader for Checked {
    type T = BufReader<File>;

    /// The library reads a page's header through this, and the page itself through `get_bytes`.
    fn get_read(&self, start: u64) -> Result<Self::T> {
        if let Some((unpacked, packed)) = claim(self.0.get_read(start)?)
            && unpacked > DENSEST * packed + ALWAYS_BYTES
        {
            return Err(ParquetError::General(format!(
                "a page of {packed} bytes claims to be {unpacked} when unpacked"
            )));
        }
        self.0.get_read(start)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        if start.saturating_add(length as u64) > self.len() {
            return Err(ParquetError::EOF(format!("{length} bytes from {start} on are not there")));
        }
        self.0.get_bytes(start, length)
    }
}

/// Sizes unpacked and packed, bytes, if a page's header stands here: its first three fields are kind and sizes.
fn claim(mut header: impl Read) -> Option<(u64, u64)> {
    let mut number = || -> Option<u64> {
        if byte(&mut header)? != NEXT_NUMBER {
            return None;
        }
        zigzag(&mut header)
    };
    let _kind = number()?;
    Some((number()?, number()?))
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
        // Kind 0, unpacked 300, packed 24.
        assert_eq!(claim(&[0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x30][..]), Some((300, 24)));
        assert_eq!(claim(&b"\x15\x02\x00\x00PAR1"[..]), None);
        assert_eq!(claim(&[0x15, 0x01, 0x15, 0x02, 0x15, 0x02][..]), None);
        assert_eq!(claim(&[0x15, 0x00, 0x15, 0xff, 0xff, 0xff, 0xff, 0xff][..]), None);
        let longer = [0x15, 0x00, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x8f, 0x02, 0x15, 0x02];
        assert_eq!(claim(&longer[..]), Some((0x7fff_ffff, 1)));
        assert_eq!(claim(&[0x15][..]), None);
    }
}
