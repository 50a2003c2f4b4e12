//! Parameters of an answer's effects, with intervals.

use std::collections::BTreeMap;

use crate::diagnose::diagnosis::{DiscrepancyTerm, Estimate, NamedEffect};
use crate::diagnose::fit::{Fit, Placed};
use crate::diagnose::search::Found;

/// Parameters of one effect of a fit, with intervals for fitted ones, cut at the end of the law's range.
pub(super) fn parameters(fit: &Fit, effect: usize) -> BTreeMap<String, Estimate> {
    let calibration = fit.x.len() - fit.model.effect_parameters();
    let spec = fit.model.effects[effect].spec();
    let mut parameters = BTreeMap::new();
    for (i, p) in spec.parameters.iter().enumerate() {
        let place = fit.model.places().iter().position(|&at| at == (effect, i));
        let estimate = match place {
            Some(k) => {
                let (value, half) = (fit.x[calibration + k], fit.half_width(calibration + k));
                Estimate { value, ci95: [(value - half).max(p.range.min), (value + half).min(p.range.max)] }
            }
            None => {
                let value = fit.model.numbers[effect].values[i];
                Estimate { value, ci95: [value, value] }
            }
        };
        parameters.insert(p.key.to_owned(), estimate);
    }
    parameters
}

/// Of an effect whose numbers differ from run to run: the mean of each over the runs, with an interval that holds those of all runs.
pub(super) fn over_runs(fit: &Fit, of_each: &[usize]) -> BTreeMap<String, Estimate> {
    let all: Vec<BTreeMap<String, Estimate>> = of_each.iter().map(|i| parameters(fit, *i)).collect();
    let over = |key: &String| {
        let each = || all.iter().map(|own| own[key]);
        let value = each().map(|own| own.value).sum::<f64>() / all.len() as f64;
        let low = each().fold(f64::INFINITY, |low, own| low.min(own.ci95[0]));
        let high = each().fold(f64::NEG_INFINITY, |high, own| high.max(own.ci95[1]));
        Estimate { value, ci95: [low, high] }
    };
    all.first().into_iter().flat_map(BTreeMap::keys).map(|key| (key.clone(), over(key))).collect()
}

/// The first number of an effect that differs from run to run, in each.
pub(super) fn size_in_each(fit: &Fit, of_each: &[usize]) -> BTreeMap<String, Estimate> {
    let size = |i: &usize| {
        let (model, key) = (&fit.model, &fit.model.effects[*i].spec().parameters.first()?.key);
        Some((model.numbers[*i].only_in.as_deref()?.to_owned(), parameters(fit, *i)[key.as_str()]))
    };
    of_each.iter().filter_map(size).collect()
}

/// Adds a further branch to an effect already named: its parameters get the next free number as suffix.
pub(super) fn add_branch(effect: &mut NamedEffect, parameters: BTreeMap<String, Estimate>) {
    for (key, number) in parameters {
        let free = (2..).map(|n| format!("{key}_{n}")).find(|k| !effect.parameters.contains_key(k));
        effect.parameters.extend(free.map(|k| (k, number)));
    }
}

/// The effects that describe what the named ones leave, with their parameters in a fit that has them all.
pub fn discrepancy(found: &Found, fit: &Fit) -> Vec<DiscrepancyTerm> {
    let named = found.best.model.effects.len();
    let terms = fit.model.effects.iter().enumerate().skip(named);
    let term = |(at, placed): (usize, &Placed)| DiscrepancyTerm {
        name: placed.spec().name.clone(),
        element: placed.element.to_string(),
        channel: placed.channel.clone(),
        parameters: parameters(fit, at),
        law: placed.spec().equation.clone(),
    };
    terms.map(term).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::fit::Model;
    use crate::effects::{Element, ElementKind, find};

    #[test]
    fn an_interval_ends_where_its_law_does() {
        let entry = find("plastic_set").expect("of the catalogue");
        let placed = Placed { entry, element: Element::of(ElementKind::Muscle, 0, 1), channel: None };
        let model = Model::baseline().plus(&placed, &entry.typical());
        let spec = &entry.entry().parameters[0];
        let n = model.effect_parameters();
        let x: Vec<f64> = model.places().iter().map(|&(e, i)| model.numbers[e].values[i]).collect();
        let mut loose = Fit { model, x, cost: 1.0, covariance: DMatrix::zeros(n, n), on_bound: Vec::new() };
        loose.covariance[(0, 0)] = loose.x[0].powi(2);
        let Estimate { value, ci95: [low, high] } = parameters(&loose, 0)[&spec.key];
        assert_eq!((value, low), (spec.typical, 0.0));
        assert!(value < high && high <= spec.range.max, "{high}");
    }
}
