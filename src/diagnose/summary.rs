//! The verdict in plain words.

use super::answer::{Diagnosis, Verdict};

/// The verdict in two sentences.
pub fn summary(d: &Diagnosis) -> String {
    let effects: Vec<String> = d
        .effects
        .iter()
        .map(|e| match &e.channel {
            Some(channel) => format!("{} on {channel}", e.name),
            None => format!("{} in {}", e.name, e.element),
        })
        .collect();
    let closed = format!(
        "On the sealed runs it closes {:.0} % of the gap between the calibrated scene and the noise.",
        100.0 * d.fit.gap_closed
    );
    match d.verdict {
        Verdict::Adequate => format!(
            "The calibrated scene explains the recordings down to their noise: nothing is missing that they could show. \
             What is left is {:.4} of the noise's variance.",
            d.detection.excess_chi2_per_sample.max(0.0)
        ),
        Verdict::MissingPhysics => format!("The scene lacks {}. {closed}", effects.join(" and ")),
        Verdict::Ambiguous => format!("The scene lacks one of these: {}. {closed}", effects.join(", ")),
        Verdict::UnknownPhysics => format!(
            "Something is missing that is not in the catalogue{}. {}",
            d.location.element.as_ref().map_or(String::new(), |e| format!(", most likely in the {e}")),
            if effects.is_empty() {
                "No known effect explains any of it.".to_owned()
            } else {
                format!("The nearest known effect, {}, leaves a part of it. {closed}", effects.join(" with "))
            }
        ),
        Verdict::UnusableData => d.summary.clone(),
    }
}
