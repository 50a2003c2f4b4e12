//! Reads what a changed table says.

use serde::de::DeserializeOwned;
use toml::Table;

/// What a table cannot be read for, and the key.
#[derive(Debug)]
pub(super) struct Misread {
    pub key: String,
    pub message: String,
}

/// Reads a table by way of its text. A second reader beside that of text is a fourteenth of what the library is compiled to (by `cargo
/// llvm-lines`), for what happens once a scene.
pub(super) fn from_table<T: DeserializeOwned>(table: &Table) -> Result<T, Misread> {
    let broken = |message: String| Misread { key: ".".to_owned(), message };
    let text = toml::to_string(table).map_err(|e| broken(e.to_string()))?;
    let reader = toml::Deserializer::parse(&text).map_err(|e| broken(e.message().to_owned()))?;
    serde_path_to_error::deserialize(reader)
        .map_err(|e| Misread { key: e.path().to_string(), message: e.inner().message().to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFile;

    /// Every number and word of a stock scene comes back, and what is wrong is said of its key.
    #[test]
    fn a_table_is_read_as_its_text() {
        let path = crate::stock::builtin("scenes/bending_catheter.toml").expect("it is carried");
        let text = crate::stock::read_text(&path).expect("text");
        let mut table: Table = text.parse().expect("a table");
        let direct: SceneFile = toml::from_str(&text).expect("a scene");
        let read: SceneFile = from_table(&table).expect("a scene");
        assert_eq!(Table::try_from(&direct), Table::try_from(&read));
        table["muscles"].as_table_mut().expect("a table").insert("damping_n_s_m".to_owned(), "much".into());
        let misread = from_table::<SceneFile>(&table).expect_err("no number");
        assert_eq!(misread.key, "muscles.damping_n_s_m");
        assert!(misread.message.contains("invalid type: string \"much\""), "{}", misread.message);
    }
}
