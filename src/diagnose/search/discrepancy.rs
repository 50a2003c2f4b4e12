//! The model discrepancy of an answer, described by further effects. They bring the scene nearer to the rig; that they
//! are in it is not claimed.

use super::refits::{beside, cross_validates_runs};
use crate::diagnose::case::Noise;
use crate::diagnose::fit::{Fit, Problem, Variant};

/// What an answer leaves of a channel is described where its variance is more than this many times the noise's.
const MORE_THAN_NOISE: f64 = 1.0;
/// Every term explains this share of what is left, or more.
const WORTH: f64 = 0.1;
const MOST_TERMS: usize = 6;
/// Refits compared on runs left out, the cheapest first.
const COMPARED: usize = 4;

/// An answer with what describes its discrepancy.
#[derive(Clone, Debug)]
pub struct Described {
    /// The answer's effects come first.
    pub fit: Fit,
    /// Noise and discrepancy together: what residuals were weighed with.
    pub noise: Vec<Noise>,
}

/// The answer with effects of the catalogue behind its own, each of which predicts runs left out better than without
/// it. `None` if nothing is named, no more than noise is left, or no effect describes it.
///
/// Residuals are weighed by what is left of each channel: a channel with little noise would outweigh all others,
/// though none of them is explained.
pub(in crate::diagnose) fn described(
    open: &Problem,
    best: &Fit,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Option<Described> {
    if best.model.effects.is_empty() {
        return None;
    }
    let mut described = None;
    for _ in 0..MOST_TERMS {
        let fit = described.as_ref().map_or(best, |d: &Described| &d.fit);
        let Some(next) = with_one_more(open, fit, variants, say) else { break };
        described = Some(next);
    }
    described
}

fn with_one_more(open: &Problem, fit: &Fit, variants: &[Variant], say: &dyn Fn(String)) -> Option<Described> {
    let noise = with_discrepancy(&open.residuals(&fit.model, &fit.x)?, open.noise)?;
    let problem = Problem { noise: &noise, case: open.case, runs: open.runs.clone() };
    let from = problem.fit(&fit.model, &fit.x)?;
    let refits = beside(&problem, &from, variants).into_iter().take(COMPARED);
    let mut worthy = refits.filter(|next| next.cost < (1.0 - WORTH) * from.cost);
    let next = worthy.find(|next| cross_validates_runs(&problem, &from, next))?;
    let term = next.model.effects.last().map_or_else(String::new, |e| e.title());
    say(format!("what is left, by {term}: {:.3} of it stays", next.cost / from.cost));
    Some(Described { fit: next, noise })
}

/// The noise with what is left of each channel as white noise beside it; `None` if all is noise.
fn with_discrepancy(residuals: &[Vec<Vec<f64>>], noise: &[Noise]) -> Option<Vec<Noise>> {
    let of_channel = |(c, own): (usize, &Noise)| {
        let squares: Vec<f64> =
            residuals.iter().flat_map(|run| &run[c]).filter(|r| r.is_finite()).map(|r| r * r).collect();
        let variance = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        (variance > (1.0 + MORE_THAN_NOISE) * own.sd * own.sd).then(|| Noise::white(variance.sqrt()))
    };
    let left: Vec<Option<Noise>> = noise.iter().enumerate().map(of_channel).collect();
    let is_any = left.iter().any(Option::is_some);
    is_any.then(|| left.into_iter().zip(noise).map(|(left, own)| left.unwrap_or(*own)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Case, RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::diagnose::search::candidates;
    use crate::effects::{Element, ElementKind, find};
    use crate::scene::Override;

    const CHANNELS: [&str; 2] = ["elongation_mm", "pressure_kpa"];

    /// The bench as it is with these laws.
    fn played(laws: &[&str]) -> Case {
        let laws = laws.iter().enumerate().map(|(i, law)| Override::law(law, &format!("law_{i}")).expect("a law"));
        made::recorded("muscle_bench", &laws.collect::<Vec<_>>(), &["plunger_mm"], &CHANNELS)
    }

    /// A case explained by a leak alone, and with what describes the rest.
    fn beside_a_leak(case: &Case) -> (Fit, Option<Described>) {
        let noise = [0.01, 1.0].map(Noise::white);
        let open = Problem { case, runs: case.subset(RunSet::Open), noise: &noise };
        let entry = find("leak").expect("of the catalogue");
        let leak = Placed { entry, element: Element::of(ElementKind::Line, 0, 1), channel: None };
        let model = Model::baseline().plus(&leak, &entry.typical());
        let best = open.fit(&model, &open.start(&model, None)).expect("played");
        let described = described(&open, &best, &candidates::variants(case), &|_| {});
        (best, described)
    }

    #[test]
    fn what_stands_beside_a_named_effect_is_described_behind_it() {
        const LEAK: &str = "line.outflow adds 1e-16*pressure_pa";
        let both = played(&[LEAK, "muscle.pull adds 0.2*tanh(elongation_m/0.25e-3)"]);
        let (best, described) = beside_a_leak(&both);
        let Described { fit, noise } = described.expect("a preload is left");
        assert_eq!(fit.model.effects[0], best.model.effects[0]);
        assert!(fit.model.effects[1..].iter().any(|e| e.spec().name == "coil_preload"), "{}", fit.model.title());
        let open = Problem { case: &both, runs: both.subset(RunSet::Open), noise: &noise };
        let [was, is] = [&best, &fit].map(|fit| open.cost_at(&fit.model, &fit.x).expect("played"));
        assert!(is < 0.1 * was, "{is} of {was}");

        let (_, nothing) = beside_a_leak(&played(&[LEAK]));
        assert!(nothing.is_none(), "the leak explains all");
    }

    #[test]
    fn only_what_is_more_than_noise_is_left_to_describe() {
        let noise = [Noise::white(1.0), Noise::white(1.0)];
        let residuals = |first: f64, second: f64| vec![vec![vec![first, f64::NAN, -first], vec![second; 3]]];
        assert!(with_discrepancy(&residuals(1.0, 1.2), &noise).is_none());
        let weights = with_discrepancy(&residuals(3.0, 1.2), &noise).expect("of the first channel");
        assert_eq!(weights, [Noise::white(3.0), Noise::white(1.0)]);
    }
}
