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
            unknown(d, &closed)
        ),
        Verdict::UnusableData => d.summary.clone(),
    }
}

/// What comes nearest, and what hypothesis takes it further.
fn unknown(d: &Diagnosis, closed: &str) -> String {
    let named = |hypothetical: bool| -> String {
        let own = d.effects.iter().filter(|e| e.hypothetical == hypothetical);
        own.map(|e| format!("{} in {}", e.name, e.element)).collect::<Vec<_>>().join(" with ")
    };
    match (named(false).as_str(), named(true).as_str()) {
        ("", "") => "No known effect explains any of it.".to_owned(),
        (known, "") => format!("The nearest known effect, {known}, leaves a part of it. {closed}"),
        ("", terms) => format!("No known effect explains any of it; a hypothesis, {terms}, does. {closed}"),
        (known, terms) => {
            format!(
                "The nearest known effect, {known}, leaves a part of it; a hypothesis, {terms}, takes more. {closed}"
            )
        }
    }
}
