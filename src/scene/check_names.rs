//! The scene's own name, and what is said of a name that is none of those there are.

use super::SceneError;
use super::check::Place;

/// The remedy for a name that is none of those there are.
pub(super) fn one_of(known: &[&str]) -> String {
    match known {
        [] => "add what it shall name first: the scene has none of the kind".to_owned(),
        known => format!("use one of: {}", known.join(", ")),
    }
}

/// Longest name, bytes: with an ending it is still one that file systems take.
const LONGEST_NAME: usize = 200;

/// The scene's name becomes that of the files in `out/`.
pub(super) fn check_name(name: &str, place: &Place) -> Result<(), SceneError> {
    let is_odd = |c: char| c.is_control() || r#"/\:*?"<>|"#.contains(c);
    let is_plain =
        !name.trim().is_empty() && !name.starts_with('.') && !name.contains(is_odd) && name.len() <= LONGEST_NAME;
    match is_plain {
        true => Ok(()),
        false => Err(place.error(
            format!("name = {name:?} cannot be that of a file"),
            "give a name of letters, digits, - and _: results are called after it, out/NAME.csv",
        )),
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};

    fn refused(change: &str) -> String {
        let change = Override::parse(change).expect("written rightly");
        Scene::load("muscle_bench", &[change]).err().map_or_else(String::new, |e| e.to_string())
    }

    #[test]
    fn a_name_that_is_no_files_is_refused() {
        for name in ["../../evil", "", " ", ".hidden", "a/b", "/abs", "c:x", &"x".repeat(300)] {
            let said = refused(&format!("name=\"{name}\""));
            assert!(
                said.contains("cannot be that of a file") && said.contains("remedy: give a name"),
                "{name}: {said}"
            );
        }
        assert_eq!(refused("name=\"Rig 2 (left), µ-bench v1.0\""), "");
    }

    #[test]
    fn a_list_of_nothing_is_no_remedy() {
        let said = refused("output=[{channel=\"force_n\", quantity=\"tension\", of=[\"x\"]}]");
        assert!(said.contains("remedy: add what it shall name first"), "{said}");
    }
}
