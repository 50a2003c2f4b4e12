//! A folder for one program at a time.

use std::fs::{File, TryLockError};
use std::path::Path;

/// What came of asking for a folder.
#[derive(Debug)]
pub enum Held {
    /// It is ours until this is dropped or the program ends, be it by a kill. Without a file where folders cannot be
    /// locked (some file systems).
    Ours(Option<File>),
    /// Another program has it.
    Taken,
}

/// Takes a folder for this program alone.
///
/// ```
/// use smam::files::{Held, hold_folder};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let held = hold_folder(folder.path());
/// assert!(matches!(held, Held::Ours(Some(_))) && matches!(hold_folder(folder.path()), Held::Taken));
/// drop(held);
/// assert!(matches!(hold_folder(folder.path()), Held::Ours(_)));
/// # Ok(())
/// # }
/// ```
pub fn hold_folder(folder: &Path) -> Held {
    let Ok(file) = File::open(folder) else { return Held::Ours(None) };
    match file.try_lock() {
        Ok(()) => Held::Ours(Some(file)),
        Err(TryLockError::WouldBlock) => Held::Taken,
        Err(TryLockError::Error(_)) => Held::Ours(None),
    }
}
