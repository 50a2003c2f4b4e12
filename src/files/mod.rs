//! Files: read with care, written whole, folders for one program at a time.
//!
//! What is no file, never ends or is far too long is refused before it is read; what is written has its name when all of
//! it is on the disk.

mod hold;
mod place;
mod read;
mod whole;

pub use hold::{Held, hold_folder};
pub use read::{open, read_text};
pub use whole::{Staged, Unfinished, part_name, place_all, still_there, write_whole, write_whole_bytes};
pub(crate) use whole::{part_place, put_in_place, temporary_beside};
