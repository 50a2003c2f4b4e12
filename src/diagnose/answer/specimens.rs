//! What the answer says of several specimens: the calibrated parameters of each, and which of them differ.

use std::collections::BTreeMap;

use crate::diagnose::case::Case;
use crate::diagnose::diagnosis::{Estimate, SpecimenNumber};
use crate::diagnose::fit::Fit;

/// Standard errors from which parameters of two specimens differ: one pair in a hundred does so by chance.
const DIFFERS: f64 = 2.58;

/// Every calibrated number as each specimen has it, and whether they differ by more than chance.
pub(in crate::diagnose) fn parameters(case: &Case, fit: &Fit) -> BTreeMap<String, SpecimenNumber> {
    let mut found: BTreeMap<String, SpecimenNumber> = BTreeMap::new();
    for (i, p) in case.parameters.iter().enumerate() {
        let Some(specimen) = &p.specimen else { continue };
        let (value, half) = (fit.x[i], fit.half_width(i));
        let own = found.entry(p.key.clone()).or_default();
        own.values.insert(specimen.clone(), Estimate { value, ci95: [value - half, value + half] });
    }
    for number in found.values_mut() {
        let all: Vec<&Estimate> = number.values.values().collect();
        let error = |e: &Estimate| (e.ci95[1] - e.ci95[0]) / (2.0 * 1.96);
        let is_apart = |a: &Estimate, b: &Estimate| (a.value - b.value).abs() > DIFFERS * error(a).hypot(error(b));
        number.differs = (0..all.len()).any(|i| all[..i].iter().any(|other| is_apart(all[i], other)));
    }
    found
}

/// What is said of them.
pub(in crate::diagnose) fn words(case: &Case, parameters: &BTreeMap<String, SpecimenNumber>) -> Option<String> {
    let names = case.specimens();
    if names.is_empty() {
        return None;
    }
    let value = |(name, e): (&String, &Estimate)| format!("{:.3e} ({name})", e.value);
    let differ: Vec<String> = parameters
        .iter()
        .filter(|(_, n)| n.differs)
        .map(|(key, n)| format!("{key}: {}", n.values.iter().map(value).collect::<Vec<_>>().join(", ")))
        .collect();
    let differences = match differ.is_empty() {
        true => "no calibrated parameter differs between them by more than chance".to_owned(),
        false => format!("what differs between them is {}", differ.join("; ")),
    };
    Some(format!("{} specimens ({}), one law for all: {differences}", names.len(), names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;

    #[test]
    fn nothing_is_said_of_a_single_specimen() {
        let mut case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        case.runs.iter_mut().for_each(|run| run.specimen = Some("a".to_owned()));
        assert_eq!(words(&case, &BTreeMap::new()), None);
    }
}
