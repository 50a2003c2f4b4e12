//! What the page of a diagnosis says in words and numbers. The answer's own texts stay as they are in the JSON.

use crate::diagnose::{Diagnosis, Estimate, NextExperiment, Verdict, size_key};

use super::quantity::{Scale, column_range, quantity};

/// The last part of a path: `rig/monday/` is monday.
pub(super) fn last_name(path: &str) -> &str {
    path.trim_end_matches(['/', '\\']).rsplit(['/', '\\']).next().filter(|name| !name.is_empty()).unwrap_or(path)
}

/// Whether nothing is left to do about the scene.
pub(super) fn is_good(verdict: Verdict) -> bool {
    verdict == Verdict::Adequate
}

/// `elongation_mm -0.0199 .. 6.6349 while loading` as `elongation 0.0 to 6.6 mm while loading`.
pub(super) fn region_words(region: &str) -> String {
    let words: Vec<&str> = region.split(' ').collect();
    if let [column, from, "..", to, way @ ..] = words.as_slice()
        && let (Ok(from), Ok(to)) = (from.parse(), to.parse())
    {
        return [&[column_range(column, from, to).as_str()], way].concat().join(" ");
    }
    region.to_owned()
}

/// What to do next, in sentences. "Settled" is said of the recordings at hand; standard errors of the run to come.
pub(super) fn next_words(d: &Diagnosis) -> String {
    let next = &d.next_experiment;
    let (Some([best, rival]), Some(promise)) = (&next.between, next.promise()) else {
        return format!("{}.", capital(&next.why));
    };
    if d.verdict == Verdict::Ambiguous {
        return format!("{best} and {rival} explain these recordings about equally well. To decide: {promise}.");
    }
    if d.verdict == Verdict::UnknownPhysics {
        return format!(
            "Of what is known these recordings prefer {best} to {rival}, but it leaves a part unexplained, which no programme settles: \
             look at where the residuals stand out, and at what the warnings say."
        );
    }
    format!(
        "Nothing must be recorded: these recordings decide for {best} against the nearest rival, {rival}. To confirm it on \
         a new run by itself, {} (5 are a clear answer).",
        promise.replacen("would set them", "would set the two", 1)
    )
}

/// What one more sensor would bring.
pub(super) fn sensor_words(next: &NextExperiment) -> Option<String> {
    let (column, sigma) = (next.sensor.as_ref()?, next.sensor_sigma?);
    Some(match next.programme.as_ref().filter(|_| next.needs_sensor()) {
        Some(programme) => {
            format!("With `{column}` recorded as well, {programme} would set them {sigma:.1} standard errors apart.")
        }
        None => format!("With `{column}` recorded as well it would be {sigma:.1} standard errors."),
    })
}

pub(super) fn capital(text: &str) -> String {
    // A key at the beginning stays as it is written.
    let is_key = text.split(' ').next().is_some_and(|word| word.contains('_'));
    let mut letters = text.chars();
    match letters.next() {
        Some(first) if !is_key => first.to_uppercase().chain(letters).collect(),
        _ => text.to_owned(),
    }
}

/// Value and interval of a number, with unit.
pub(super) fn estimate(key: &str, channel: Option<&str>, e: &Estimate) -> Vec<String> {
    let [low, high] = e.ci95;
    let greatest = if e.value == 0.0 { low.abs().max(high.abs()) } else { e.value };
    let scale = Scale::of(key, channel, greatest);
    if low == high {
        return vec![scale.text(e.value), "not fitted".to_owned()];
    }
    scale.with_interval(e.value, low, high).to_vec()
}

/// A row of what would have been seen: `leak in line`, its number, the size with its unit.
pub(super) fn smallest_words(title: &str, size: f64) -> Vec<String> {
    let name = title.split(' ').next().unwrap_or(title);
    let channel = title.split_once(" on ").map(|(_, channel)| channel);
    let key = size_key(name);
    vec![title.to_owned(), key.to_owned(), quantity(key, channel, size)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagnosis(verdict: Verdict, next_experiment: NextExperiment) -> Diagnosis {
        Diagnosis {
            format: 1,
            scene: String::new(),
            recordings: Vec::new(),
            verdict,
            modelled: None,
            summary: String::new(),
            detection: crate::diagnose::Detection::default(),
            location: crate::diagnose::Location::default(),
            effects: Vec::new(),
            withheld: Vec::new(),
            discrepancy: Vec::new(),
            calibration: std::collections::BTreeMap::new(),
            specimens: std::collections::BTreeMap::new(),
            fit: crate::diagnose::Proof::default(),
            next_experiment,
            warnings: Vec::new(),
        }
    }

    fn chirp(separation_sigma: f64, sensor_sigma: f64) -> NextExperiment {
        NextExperiment {
            separation_sigma,
            programme: Some("a chirp".to_owned()),
            between: Some(["leak in line".to_owned(), "plastic_set in muscle".to_owned()]),
            sensor: Some("pressure_kpa".to_owned()),
            sensor_sigma: Some(sensor_sigma),
            ..NextExperiment::default()
        }
    }

    #[test]
    fn a_settled_answer_is_not_called_open() {
        let d = diagnosis(Verdict::MissingPhysics, chirp(5.2, 9.1));
        let words = next_words(&d);
        assert!(
            words.starts_with("Nothing must be recorded: these recordings decide for leak in line against"),
            "{words}"
        );
        assert!(words.contains("plastic_set in muscle. To confirm it") && !words.contains("settled"), "{words}");
        assert!(words.contains("a chirp would set the two 5.2 standard errors apart (5 are"), "{words}");
        let sensor = sensor_words(&d.next_experiment).expect("a sensor");
        assert_eq!(sensor, "With `pressure_kpa` recorded as well it would be 9.1 standard errors.");
    }

    #[test]
    fn an_open_answer_says_what_it_takes() {
        let d = diagnosis(Verdict::Ambiguous, chirp(2.0, 9.1));
        assert_eq!(
            next_words(&d),
            "leak in line and plastic_set in muscle explain these recordings about equally well. To decide: no programme \
             within the recorded strokes is sure to do by itself."
        );
        let sensor = sensor_words(&d.next_experiment).expect("a sensor");
        assert_eq!(sensor, "With `pressure_kpa` recorded as well, a chirp would set them 9.1 standard errors apart.");
        let weak = diagnosis(Verdict::Ambiguous, chirp(2.0, 3.1));
        assert!(next_words(&weak).ends_with("To decide: even a chirp would set them only 2.0 standard errors apart."));
    }

    #[test]
    fn other_reasons_are_said_as_they_are() {
        let d = diagnosis(Verdict::MissingPhysics, NextExperiment::none("no other effect of the catalogue comes near"));
        assert_eq!(next_words(&d), "No other effect of the catalogue comes near.");
        assert_eq!(sensor_words(&d.next_experiment), None);
    }

    #[test]
    fn names_regions_and_sizes_read_as_words() {
        assert_eq!([last_name("../rig/monday/"), last_name("monday"), last_name("/")], ["monday", "monday", "/"]);
        let region = region_words("elongation_mm -0.0199 .. 6.6349 while loading");
        assert_eq!(region, "elongation 0.0 to 6.6 mm while loading");
        assert_eq!(region_words("everywhere"), "everywhere");
        assert_eq!(
            smallest_words("sensor_drift on pressure_kpa", 0.0123),
            ["sensor_drift on pressure_kpa", "rate_per_s", "0.0123 kPa/s"]
        );
        let e = Estimate { value: 1e-16, ci95: [0.85e-16, 1.15e-16] };
        assert_eq!(estimate("conductance_m3_s_pa", None, &e), ["1.00e-16 m³/(s Pa)", "8.5e-17 to 1.15e-16 m³/(s Pa)"]);
    }
}
