//! Chunks of an MCAP file: unpacked, and held against their checksum.

use std::io::Read;

use mcap::records::ChunkHeader;

/// No chunk may be larger than this when unpacked; recorders write chunks of a few megabytes.
const LARGEST_CHUNK_BYTES: u64 = 1 << 28;

/// The records of a chunk.
pub(super) fn unpack(header: &ChunkHeader, packed: &[u8]) -> Result<Vec<u8>, String> {
    let size = header.uncompressed_size;
    if size > LARGEST_CHUNK_BYTES {
        return Err(format!(
            "a chunk of {size} bytes is more than the {LARGEST_CHUNK_BYTES} that are read; record with smaller chunks"
        ));
    }
    let damaged = |said: String| format!("a chunk cannot be unpacked: {said}; the file is damaged, copy it again");
    let records = match header.compression.as_str() {
        "" => packed.to_vec(),
        "lz4" => read_up_to(lz4_flex::frame::FrameDecoder::new(packed), size).map_err(damaged)?,
        "zstd" => unpack_zstd(packed, size).map_err(damaged)?,
        other => {
            return Err(format!("a chunk is compressed with \"{other}\"; record it with zstd, lz4 or no compression"));
        }
    };
    if records.len() as u64 != size {
        return Err(damaged(format!("{} bytes where its header says {size}", records.len())));
    }
    let checksum = header.uncompressed_crc;
    if checksum != 0 && crc32fast::hash(&records) != checksum {
        return Err(damaged("its checksum is wrong".to_owned()));
    }
    Ok(records)
}

fn unpack_zstd(packed: &[u8], size: u64) -> Result<Vec<u8>, String> {
    let mut records = Vec::new();
    let mut rest = packed;
    // A chunk may be several frames, one behind the other.
    while !rest.is_empty() {
        let decoder = ruzstd::decoding::StreamingDecoder::new(&mut rest).map_err(|e| e.to_string())?;
        records.extend(read_up_to(decoder, size)?);
        if records.len() as u64 > size {
            break;
        }
    }
    Ok(records)
}

/// What a decoder gives, but no more than one byte over `size`: a header that lies costs no memory.
fn read_up_to(decoder: impl Read, size: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    decoder.take(size + 1).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}
