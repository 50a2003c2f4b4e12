//! Recordings that the full scene plays itself, for tests.

use std::fmt::Write as _;

use super::Case;
use crate::scene::{Override, Scene};
use crate::system::{Schedule, Simulation, record};

/// 20 s of a scene's stock programme, with some parameters changed and without noise, as a case of the stock scene.
pub(in crate::diagnose) fn recorded(scene: &str, set: &[Override], inputs: &[&str], outputs: &[&str]) -> Case {
    recorded_for(scene, [set, &[]], inputs, outputs)
}

/// The same as a case of a scene that differs as well: what was changed where it was played, and where it is diagnosed.
pub(in crate::diagnose) fn recorded_for(
    scene: &str,
    [played, diagnosed]: [&[Override]; 2],
    inputs: &[&str],
    outputs: &[&str],
) -> Case {
    let folder = tempfile::tempdir().expect("a folder");
    let mut simulation = Simulation::new(Scene::load(scene, played).expect("stock")).expect("stock");
    let recording = record(&mut simulation, &Schedule::even(20.0, 0.02)).expect("a run");
    recording.write_csv(&folder.path().join("run.csv")).expect("written");
    let mut text = format!("format = 1\nscene = \"{scene}\"\nrun = [{{ file = \"run.csv\" }}]\n");
    for (columns, role) in [(inputs, "input"), (outputs, "output")] {
        for column in columns {
            let _ = write!(text, "[[channel]]\ncolumn = \"{column}\"\nrole = \"{role}\"\n");
        }
    }
    std::fs::write(folder.path().join("recordings.toml"), text).expect("written");
    Case::load(&[folder.path()], None, diagnosed).expect("a case")
}
