//! Reading the URDF file itself.

use std::path::Path;

use urdf_rs::Robot;

use super::error::MechanismError;
use super::xml_scan::{XmlScan, scan};

/// The parsed URDF and what its reader dropped.
pub(super) fn read(file: &Path) -> Result<(Robot, XmlScan), MechanismError> {
    let text = crate::stock::read_text(file).map_err(|error| MechanismError::Read {
        file: file.to_path_buf(),
        reason: error.to_string(),
        remedy: "check `urdf` in the scene; it is relative to the scene file".into(),
    })?;
    let robot = urdf_rs::read_from_string(&text)
        .map_err(|error| MechanismError::Parse { file: file.to_path_buf(), reason: error.to_string() })?;
    Ok((robot, scan(&text)))
}
