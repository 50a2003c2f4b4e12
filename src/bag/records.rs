//! The records of an MCAP file, one after the other; only one is in memory at a time.

use std::io::{BufReader, Read, Seek};

use mcap::MAGIC;
use mcap::records::{Record, op};

use super::chunk::unpack;

const CUT_SHORT: &str = "the file ends before its end mark: recording was cut short, or the copy was; repair it with \
                         `mcap recover BAG.mcap -o REPAIRED.mcap`";

/// Calls `see` with every schema, channel and message of the file, in the file's order.
pub(super) fn for_each(
    source: impl Read + Seek,
    see: &mut dyn FnMut(Record<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let mut source = BufReader::new(source);
    let mut magic = [0; MAGIC.len()];
    if source.read_exact(&mut magic).is_err() || magic != MAGIC {
        return Err("is no MCAP file; name the .mcap file of the bag".to_owned());
    }
    let mut body = Vec::new();
    loop {
        let mut head = [0; 9];
        source.read_exact(&mut head).map_err(|_| CUT_SHORT)?;
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        if is_needed(opcode) {
            body.clear();
            // Grows with what is there: a length that lies costs no memory.
            source.by_ref().take(length).read_to_end(&mut body).map_err(|e| e.to_string())?;
        }
        match opcode {
            _ if is_needed(opcode) && body.len() as u64 != length => return Err(CUT_SHORT.to_owned()),
            op::FOOTER => return end(&mut source, length),
            op::CHUNK => records_of_chunk(&body, see)?,
            _ if is_needed(opcode) => see(parsed(opcode, &body)?)?,
            // Indexes, statistics, attachments: passed over.
            _ => source.seek_relative(i64::try_from(length).map_err(|_| CUT_SHORT)?).map_err(|e| e.to_string())?,
        }
    }
}

fn is_needed(opcode: u8) -> bool {
    matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK)
}

fn parsed(opcode: u8, body: &[u8]) -> Result<Record<'_>, String> {
    mcap::parse_record(opcode, body).map_err(|e| format!("a record is damaged: {e}; copy the file again"))
}

/// After the footer the file closes with the mark it began with.
fn end(source: &mut impl Read, footer_bytes: u64) -> Result<(), String> {
    let mut rest = Vec::new();
    source.take(footer_bytes.saturating_add(MAGIC.len() as u64)).read_to_end(&mut rest).map_err(|e| e.to_string())?;
    let is_whole = rest.len() as u64 == footer_bytes.saturating_add(MAGIC.len() as u64) && rest.ends_with(MAGIC);
    if is_whole { Ok(()) } else { Err(CUT_SHORT.to_owned()) }
}

fn records_of_chunk(body: &[u8], see: &mut dyn FnMut(Record<'_>) -> Result<(), String>) -> Result<(), String> {
    let Record::Chunk { header, data } = parsed(op::CHUNK, body)? else { return Ok(()) };
    let records = unpack(&header, &data)?;
    let mut rest = records.as_slice();
    while let Some((head, after)) = rest.split_first_chunk::<9>() {
        let [opcode, length @ ..] = *head;
        let length = usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX);
        let inside = after.get(..length).ok_or("a record of a chunk is damaged; copy the file again")?;
        if is_needed(opcode) && opcode != op::CHUNK {
            see(parsed(opcode, inside)?)?;
        }
        rest = &after[length..];
    }
    if rest.is_empty() { Ok(()) } else { Err("a chunk ends in the middle of a record; copy the file again".to_owned()) }
}
