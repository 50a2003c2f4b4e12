//! Reading the URDF file itself.

use std::path::Path;

use urdf_rs::Robot;

use super::error::MechanismError;
use super::xml_scan::{XmlScan, depth, scan};

/// Elements within elements; a URDF has five levels. The reader calls itself for each, and would run out of stack.
const DEEPEST: usize = 100;
/// XML namespaces that a URDF may declare; the reader's time grows with the square of their number.
const MOST_NAMESPACES: usize = 100;

/// The text of a URDF file.
pub(super) fn text(file: &Path) -> Result<String, MechanismError> {
    crate::stock::read_text(file).map_err(|error| MechanismError::Read {
        file: file.to_path_buf(),
        reason: error.to_string(),
        remedy: "check `urdf` in the scene; it is relative to the scene file".into(),
    })
}

/// The parsed URDF and what its reader dropped; `file` is where the text stands.
pub(super) fn parse(text: &str, file: &Path) -> Result<(Robot, XmlScan), MechanismError> {
    let refuse = |reason: String| MechanismError::Parse { file: file.to_path_buf(), reason };
    let depth = depth(text);
    if depth > DEEPEST {
        return Err(refuse(format!("its elements stand {depth} deep in each other, which is more than {DEEPEST}")));
    }
    let namespaces = text.matches("xmlns").count();
    if namespaces > MOST_NAMESPACES {
        return Err(refuse(format!("it declares {namespaces} XML namespaces, which is more than {MOST_NAMESPACES}")));
    }
    let robot = urdf_rs::read_from_string(text).map_err(|error| refuse(error.to_string()))?;
    Ok((robot, scan(text)))
}
