//! The verdict in plain words.

use crate::diagnose::diagnosis::{Balance, Diagnosis, Location, NamedEffect, Verdict};

/// The verdict in two sentences, with caveats.
pub fn summary(d: &Diagnosis, caveats: &[String]) -> String {
    let verdict = verdict(d) + &differing(d);
    if caveats.is_empty() { verdict } else { format!("{verdict} Read it with care: {}.", caveats.join("; ")) }
}

fn verdict(d: &Diagnosis) -> String {
    let effects: Vec<String> = d.effects.iter().map(title).collect();
    let said = said(d, &effects);
    if d.calibration.is_empty() && d.verdict != Verdict::UnusableData {
        return format!("{said} The scene names nothing to calibrate, so every number of it was taken as measured.");
    }
    said
}

fn title(e: &NamedEffect) -> String {
    placed(&e.name, &e.element, e.channel.as_deref())
}

/// What differs from run to run, in a sentence; nothing if nothing does.
fn differing(d: &Diagnosis) -> String {
    let one = |e: &NamedEffect| {
        let is_factor = e.hypothetical && e.acts == "scales";
        let what = if e.hypothetical { e.port.clone() } else { format!("{} of {}", e.size_key(), title(e)) };
        let number = |size: f64| if is_factor { format!("{:.4}", 1.0 + size) } else { format!("{size:.3e}") };
        let each: Vec<String> =
            e.size_by_run.iter().map(|(run, own)| format!("{} in {run}", number(own.value))).collect();
        format!("{what}: {}", each.join(", "))
    };
    let all: Vec<String> = d.effects.iter().filter(|e| e.differs_by_run).map(one).collect();
    if all.is_empty() {
        return String::new();
    }
    format!(
        " It differs from run to run: {}. A new recording has a number of its own: scene.toml has the mean, and a held-out run has decided its own.",
        all.join("; ")
    )
}

/// An effect with its place.
fn placed(name: &str, element: &str, channel: Option<&str>) -> String {
    match channel {
        Some(channel) => format!("{name} on {channel}"),
        None => format!("{name} in {element}"),
    }
}

fn said(d: &Diagnosis, effects: &[String]) -> String {
    let closed = closed(d);
    match d.verdict {
        Verdict::Adequate => format!(
            "The calibrated scene explains the recordings down to their noise: nothing is missing that they could show. \
             What is left is {:.4} of the noise's variance.",
            d.detection.excess_chi2_per_sample.max(0.0)
        ),
        Verdict::MissingPhysics => format!("The scene lacks {}. {closed}", effects.join(" and ")),
        Verdict::Ambiguous => format!("The scene lacks one of these: {}{}. {closed}", effects.join(", "), or_laws(d)),
        Verdict::UnknownPhysics => format!(
            "Something is missing that is not in the catalogue{}{}. {}",
            d.location.element.as_ref().map_or(String::new(), |e| format!(", most likely in the {e}")),
            place(&d.location),
            unknown(d, &closed)
        ),
        Verdict::UnusableData => d.summary.clone(),
    }
}

/// What the corrected scene predicts.
fn closed(d: &Diagnosis) -> String {
    let scene = match &described(d)[..] {
        [] => "On the held-out runs it closes".to_owned(),
        terms => format!(
            "What that leaves is described in scene.toml by {} (see discrepancy); on the held-out runs this closes",
            terms.join(" and ")
        ),
    };
    // Less than the noise can be left by chance: no more than all of a gap is closed.
    let share = 100.0 * d.fit.gap_closed.min(1.0);
    format!("{scene} {share:.0} % of the gap between the calibrated scene and the noise.")
}

/// Titles of the terms that describe the discrepancy, each once.
fn described(d: &Diagnosis) -> Vec<String> {
    let mut titles: Vec<String> = Vec::new();
    for term in &d.discrepancy {
        let title = placed(&term.name, &term.element, term.channel.as_deref());
        if !titles.contains(&title) {
            titles.push(title);
        }
    }
    titles
}

/// Ports named beside the most likely one: limit of twice the log odds, and maximum number.
const NEAR: f64 = 6.0;
const MOST_PORTS: usize = 3;

/// The places where an unknown signal closes all balances, in words; empty if there are none.
fn place(location: &Location) -> String {
    let near: Vec<&Balance> =
        location.balances.iter().filter(|b| b.closes && b.behind < NEAR).take(MOST_PORTS).collect();
    if near.is_empty() {
        return String::new();
    }
    let ports: Vec<&str> = near.iter().map(|b| b.port.as_str()).collect();
    // An answer may stand elsewhere than the balances alone would have it.
    let agrees = near.iter().any(|b| location.element.as_ref() == Some(&b.element));
    let though = if agrees { "" } else { "though " };
    format!(" ({though}something unknown at {} leaves no other balance open)", ports.join(" or "))
}

/// Probability from which laws at other ports are mentioned.
const WORTH_A_WORD: f64 = 0.05;

/// Mentions laws at other ports if an effect and its alternatives leave them a probability.
fn or_laws(d: &Diagnosis) -> &'static str {
    let is_rival = |e: &NamedEffect, own: &NamedEffect| own.rivals.contains(&title(e));
    let named = |own: &NamedEffect| -> f64 {
        d.effects.iter().filter(|e| title(e) == title(own) || is_rival(e, own)).map(|e| e.probability).sum()
    };
    let has_forms = |e: &&NamedEffect| e.forms.iter().any(|form| form.port != e.port);
    let is_open = d.effects.iter().filter(has_forms).any(|e| 1.0 - named(e) > WORTH_A_WORD);
    if is_open { ", or a law elsewhere (see forms)" } else { "" }
}

/// The closest known effect, and the law that explains more.
fn unknown(d: &Diagnosis, closed: &str) -> String {
    if let [only] = &d.effects[..]
        && let Some(number) = mere_number(only)
    {
        return format!("One parameter of the scene differs on the rig: {number} explains the misfit. {closed}");
    }
    if !d.withheld.is_empty() {
        return withheld(&d.withheld);
    }
    let (laws, listed): (Vec<&NamedEffect>, Vec<&NamedEffect>) = d.effects.iter().partition(|e| e.hypothetical);
    let known = listed.iter().map(|e| format!("{} in {}", e.name, e.element)).collect::<Vec<_>>().join(" with ");
    let law = laws.iter().map(|e| law(e)).collect::<Vec<_>>().join(", and ");
    let others: usize = laws.iter().map(|e| e.forms.len()).sum();
    let as_well = match others {
        0 => String::new(),
        1 => " (one other form explains as much: see forms)".to_owned(),
        n => format!(" ({n} other forms explain as much: see forms)"),
    };
    match (known.as_str(), law.as_str()) {
        ("", "") => "No known effect explains any of it.".to_owned(),
        (known, "") => format!("The closest known effect, {known}, explains only part of the misfit. {closed}"),
        ("", law) => format!("No known effect explains it as well as a law does: {law}{as_well}. {closed}"),
        (known, law) => {
            format!(
                "The closest known effect, {known}, explains part of the misfit; a law beside it explains more: {law}{as_well}. {closed}"
            )
        }
    }
}

/// The withheld answer.
fn withheld(effects: &[NamedEffect]) -> String {
    let one = |e: &NamedEffect| if e.hypothetical { law(e) } else { format!("{} in {}", e.name, e.element) };
    let all: Vec<String> = effects.iter().map(one).collect();
    format!(
        "Located, not modelled: {} explains the runs it was fitted to but not the others (see warnings), so scene.toml is the \
         calibrated scene.",
        all.join(" with ")
    )
}

/// Letters from which a law is not spelled out in a sentence: a curve of pieces has three hundred.
const LETTERS: usize = 160;

/// A law with where it acts and its parameters: `muscle.friction times (1 + ...)`.
fn law(effect: &NamedEffect) -> String {
    let (law, memory) = effect.law_and_memory();
    let own = match effect.acts.as_str() {
        acts if law.len() > LETTERS => {
            let does = if acts == "scales" { "times" } else { "plus" };
            format!("{} {does} a curve over {} (see law)", effect.port, effect.variables.join(" and "))
        }
        "scales" => format!("{} times ({law}){memory}", effect.port),
        _ => format!("{} plus {law}{memory}", effect.port),
    };
    effect.known_as.as_ref().map_or_else(|| own.clone(), |name| format!("{own} - {name}"))
}

/// A law that depends on nothing, as a number: `muscle_2.wall times 1.08`.
fn mere_number(effect: &NamedEffect) -> Option<String> {
    let is_one = effect.hypothetical && effect.variables.is_empty() && !effect.port.is_empty();
    let constant = effect.parameters.values().next().filter(|_| is_one)?.value;
    Some(match effect.acts.as_str() {
        _ if effect.differs_by_run => format!("{}, another in each run,", effect.port),
        "scales" => format!("{} times {:.4}", effect.port, 1.0 + constant),
        _ => format!("{} of {constant:.4e} in SI units", effect.port),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_that_no_one_reads_in_a_sentence_is_named_a_curve() {
        let effect = |law: &str| NamedEffect {
            port: "muscle.wall".to_owned(),
            acts: "scales".to_owned(),
            law: law.to_owned(),
            variables: vec!["elongation_m".to_owned()],
            ..NamedEffect::default()
        };
        assert_eq!(law(&effect("1 + 2 * elongation_m")), "muscle.wall times (1 + 2 * elongation_m)");
        let pieces =
            "1 + 9.50 * (elongation_m/0.0135)".to_owned() + &" - 14.0 * max((elongation_m/0.0135) - 0.25, 0)".repeat(7);
        assert_eq!(law(&effect(&pieces)), "muscle.wall times a curve over elongation_m (see law)");
    }

    /// The sentence does not contradict itself where an answer stands elsewhere than the balances point.
    #[test]
    fn balances_that_point_elsewhere_are_said_as_such() {
        let balance = |port: &str, element: &str, behind| Balance {
            port: port.to_owned(),
            element: element.to_owned(),
            behind,
            left_sigma: std::collections::BTreeMap::new(),
            closes: true,
        };
        let balances = vec![balance("muscle.pull", "muscle", 0.0), balance("line.outflow", "line", 50.0)];
        let at = |element: &str| Location {
            element: Some(element.to_owned()),
            balances: balances.clone(),
            ..Location::default()
        };
        let said = "something unknown at muscle.pull leaves no other balance open)";
        assert_eq!(place(&at("muscle")), format!(" ({said}"));
        assert_eq!(place(&at("line")), format!(" (though {said}"));
    }
}
