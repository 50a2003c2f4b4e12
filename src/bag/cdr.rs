//! The wire format of ROS 2 messages: plain CDR, of either byte order.

/// What stands before a message: two bytes that say how it is encoded, two that say nothing.
const ENCAPSULATION_BYTES: usize = 4;

/// Texts and messages within one message: each takes many times the memory that it has bytes. A robot's state has hundreds.
pub(super) const MOST_PARTS: usize = 1_000_000;

/// Reads aligned values from a message. Nothing is taken that is not there.
pub(super) struct Cdr<'a> {
    /// What follows the encapsulation header; values are aligned from here.
    bytes: &'a [u8],
    at: usize,
    is_little: bool,
    /// Texts and messages so far.
    parts: usize,
}

impl<'a> Cdr<'a> {
    pub(super) fn new(message: &'a [u8]) -> Result<Self, String> {
        let is_little = match message {
            [0, 0, _, _, ..] => false,
            [0, 1, _, _, ..] => true,
            [a, b, _, _, ..] => {
                return Err(format!(
                    "its encoding {a:#04x} {b:#04x} is not plain CDR; record it with a ROS 2 middleware that writes \
                     plain CDR (the usual ones do)"
                ));
            }
            _ => return Err("it ends before its encapsulation header".to_owned()),
        };
        Ok(Self { bytes: &message[ENCAPSULATION_BYTES..], at: 0, is_little, parts: 0 })
    }

    /// Bytes not read yet.
    pub(super) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Counts a text or a message within the message.
    pub(super) fn count_part(&mut self) -> Result<(), String> {
        self.parts += 1;
        if self.parts > MOST_PARTS {
            return Err(format!(
                "it holds more than {MOST_PARTS} texts and messages; record what is measured on a topic of its own"
            ));
        }
        Ok(())
    }

    /// The next `N` bytes as they stand in a little-endian message, aligned to `N`.
    pub(super) fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let start = self.at.next_multiple_of(N);
        let mut taken: [u8; N] = self.slice(start, N)?.try_into().map_err(|_| past_end())?;
        if !self.is_little {
            taken.reverse();
        }
        Ok(taken)
    }

    /// A text: its length with the closing zero, then its bytes.
    pub(super) fn text(&mut self) -> Result<String, String> {
        let length = self.length()?;
        let bytes = self.slice(self.at, length)?;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        Ok(String::from_utf8_lossy(text).into_owned())
    }

    /// The length of a sequence or a text.
    pub(super) fn length(&mut self) -> Result<usize, String> {
        usize::try_from(u32::from_le_bytes(self.take()?)).map_err(|_| past_end())
    }

    fn slice(&mut self, start: usize, length: usize) -> Result<&'a [u8], String> {
        let end = start.checked_add(length).ok_or_else(past_end)?;
        let slice = self.bytes.get(start..end).ok_or_else(past_end)?;
        self.at = end;
        Ok(slice)
    }
}

/// A value would reach beyond the message.
pub(super) fn past_end() -> String {
    "it ends in the middle of a value".to_owned()
}

/// Builds a little-endian message.
pub(super) struct CdrWriter {
    bytes: Vec<u8>,
}

impl CdrWriter {
    pub(super) fn new() -> Self {
        Self { bytes: vec![0, 1, 0, 0] }
    }

    /// Little-endian bytes of a value, aligned to their number.
    pub(super) fn put<const N: usize>(&mut self, value: [u8; N]) {
        let position = self.bytes.len() - ENCAPSULATION_BYTES;
        self.bytes.resize(ENCAPSULATION_BYTES + position.next_multiple_of(N), 0);
        self.bytes.extend(value);
    }

    pub(super) fn text(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.bytes.extend(text.as_bytes());
        self.bytes.push(0);
    }

    /// The length of what follows. A sequence of this program is never longer than 32 bits tell.
    pub(super) fn length(&mut self, length: usize) {
        self.put(u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes());
    }

    pub(super) fn numbers(&mut self, numbers: &[f64]) {
        self.length(numbers.len());
        numbers.iter().for_each(|v| self.put(v.to_le_bytes()));
    }

    pub(super) fn finish(self) -> Vec<u8> {
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_aligned_from_the_header_on() {
        // uint8 7, three bytes of padding, a text of two letters, five of padding, float64 0.5.
        let mut writer = CdrWriter::new();
        writer.put([7]);
        writer.text("ab");
        writer.put(0.5f64.to_le_bytes());
        let bytes = writer.finish();
        assert_eq!(bytes[..15], [0, 1, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0, b'a', b'b', 0]);
        assert_eq!(bytes.len(), 4 + 16 + 8);
        let mut reader = Cdr::new(&bytes).unwrap();
        assert_eq!((reader.take::<1>().unwrap(), reader.text().unwrap()), ([7], "ab".to_owned()));
        assert_eq!((f64::from_le_bytes(reader.take().unwrap()), reader.remaining()), (0.5, 0));
        assert_eq!(reader.take::<1>().unwrap_err(), "it ends in the middle of a value");
    }

    #[test]
    fn big_endian_is_read_and_other_encodings_are_refused() {
        let mut big = vec![0, 0, 0, 0];
        big.extend(2.5f64.to_be_bytes());
        assert_eq!(f64::from_le_bytes(Cdr::new(&big).unwrap().take().unwrap()), 2.5);
        assert!(Cdr::new(&[0, 1]).is_err_and(|e| e.contains("encapsulation")));
        assert!(Cdr::new(&[0, 3, 0, 0]).is_err_and(|e| e.contains("0x00 0x03 is not plain CDR")));
        // A text that claims four gigabytes: refused before anything is made for it.
        assert!(Cdr::new(&[0, 1, 0, 0, 255, 255, 255, 255, b'a']).unwrap().text().is_err());
    }
}
