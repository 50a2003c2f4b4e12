//! What to do next, as a page of a diagnosis says it.

use crate::diagnose::Outcome;

use super::diagnosis_words::{next_words, sensor_words};
use super::kit::HtmlPage;

/// Adds the section.
pub(super) fn next(page: &mut HtmlPage, outcome: &Outcome) {
    let next = &outcome.diagnosis.next_experiment;
    page.heading("What to do next");
    page.paragraph(&next_words(&outcome.diagnosis));
    if let Some(file) = &next.file {
        page.paragraph(&format!(
            "Play `{file}` on the rig; `smam run scene.toml --input {file}` shows what the corrected scene expects."
        ));
    }
    if let Some(words) = sensor_words(next) {
        page.paragraph(&words);
    }
}
