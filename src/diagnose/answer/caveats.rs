//! Caveats of an answer; they are part of the verdict's sentence.

use crate::diagnose::case::{Case, Noise, noise};
use crate::diagnose::diagnosis::NamedEffect;
use crate::diagnose::fit::Fit;

/// A parameter this close to an end of its range, as a share of the range, is on it.
const ON_BOUND: f64 = 1e-6;

/// Clauses for an answer with the parameters of `fit`; `contradicted` are parameters that single runs contradict.
pub(in crate::diagnose) fn caveats(
    case: &Case,
    (fit, effects): (&Fit, &[NamedEffect]),
    noise: &[Noise],
    contradicted: &[String],
) -> Vec<String> {
    let clauses = [
        counted("what these recordings cannot distinguish from a law elsewhere (see forms)", &with_stand_ins(effects)),
        counted("channels with almost no noise, for which 1e-5 of their range is assumed", &without_noise(case, noise)),
        counted("parameters at the end of their range, where intervals say nothing", &on_bounds(case, fit)),
        counted("parameters that differ from run to run", contradicted),
        counted("runs without the samples in which slack cables leave the joint free", &slack_in(case)),
    ];
    clauses.into_iter().flatten().collect()
}

/// `WORDS: a, b and 3 more`; nothing of nothing.
fn counted(words: &str, names: &[String]) -> Option<String> {
    let (shown, more) = names.split_at(names.len().min(2));
    let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
    (!shown.is_empty()).then(|| format!("{words}: {}{more}", shown.join(", ")))
}

/// Effects of the catalogue that laws at other ports would explain as well, each with the first such law.
fn with_stand_ins(effects: &[NamedEffect]) -> Vec<String> {
    let words = |e: &NamedEffect| {
        let other = e.forms.iter().find(|form| form.port != e.port).filter(|_| !e.hypothetical)?;
        Some(format!("{} from one at {}", e.name, other.port))
    };
    effects.iter().filter_map(words).collect()
}

/// Columns whose noise is at the assumed minimum.
fn without_noise(case: &Case, noise: &[Noise]) -> Vec<String> {
    let of_channels = case.channels.iter().zip(noise).enumerate();
    let at_floor = of_channels.filter(|(c, (own, n))| own.stated_sd.is_none() && n.sd <= noise::least(case, *c));
    at_floor.map(|(_, (own, _))| own.column.clone()).collect()
}

/// Parameters at a bound, which the data would exceed. Zero is not reported.
fn on_bounds(case: &Case, fit: &Fit) -> Vec<String> {
    let calibrated = fit.on_bound.iter().filter(|&&i| fit.x[i] != 0.0).map(|&i| case.parameters[i].title());
    let first = fit.x.len() - fit.model.effect_parameters();
    let of_effects = fit.model.places().into_iter().zip(&fit.x[first..]).filter_map(|((effect, i), &value)| {
        let placed = &fit.model.effects[effect];
        let p = &placed.spec().parameters[i];
        let near = ON_BOUND * (p.range.max - p.range.min);
        let is_on = value != 0.0 && (value - p.range.min <= near || p.range.max - value <= near);
        is_on.then(|| format!("{} of {}", p.key, placed.title()))
    });
    calibrated.chain(of_effects).collect()
}

fn slack_in(case: &Case) -> Vec<String> {
    case.runs.iter().filter(|r| r.slack.iter().any(|samples| !samples.is_empty())).map(|r| r.file.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_are_named_and_the_others_counted() {
        let names = |n: usize| (0..n).map(|i| format!("n{i}")).collect::<Vec<_>>();
        assert_eq!(counted("late", &names(0)), None);
        assert_eq!(counted("late", &names(2)).as_deref(), Some("late: n0, n1"));
        assert_eq!(counted("late", &names(5)).as_deref(), Some("late: n0, n1 and 3 more"));
    }
}
