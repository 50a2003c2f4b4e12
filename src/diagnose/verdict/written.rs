//! Describes the laws of an answer: port, variables, alternatives, curve.

use crate::effects::WrittenLaw;
use crate::laws::{Acts, Law, Symbol};

use super::known_as;
use crate::diagnose::case::Case;
use crate::diagnose::diagnosis::{Curve, Form, NamedEffect};
use crate::diagnose::fit::{Fit, Placed};

/// Points of a curve.
const POINTS: usize = 101;

/// The law of an effect, if it is a written one.
fn written(placed: &Placed) -> Option<&'static WrittenLaw> {
    placed.spec().unlisted()
}

/// Fills in port and variables of an effect; for a written law also its text with fitted values.
pub fn describe(effect: &mut NamedEffect, placed: &Placed, fit: &Fit, at: usize) {
    effect.port = port(placed);
    if let Some(own) = written(placed) {
        effect.element = own.law.address.element();
        effect.acts = own.law.acts.word().to_owned();
        effect.variables = own.law.variables().iter().map(|v| v.name()).collect();
        effect.law = text(own, &values(fit, at));
        effect.known_as = known_as(own, &values(fit, at));
        return;
    }
    effect.acts = placed.spec().acts.word().to_owned();
    effect.variables.clone_from(&placed.spec().variables);
}

/// Adds a further law at the same port to an effect already named: what both do together.
pub fn add_law(effect: &mut NamedEffect, placed: &Placed, fit: &Fit, at: usize) {
    let Some(own) = written(placed).filter(|own| own.law.acts.word() == effect.acts) else { return };
    let more = text(own, &values(fit, at));
    let is_plain = ![&effect.law, &more].iter().any(|law| law.contains(';'));
    effect.law = match own.law.acts {
        Acts::Adds if is_plain => match more.strip_prefix('-') {
            Some(less) => format!("{} - {less}", effect.law),
            None => format!("{} + {more}", effect.law),
        },
        Acts::Scales if is_plain => format!("({}) * ({more})", effect.law),
        _ => format!("{}; and {more}", effect.law),
    };
    for variable in own.law.variables().iter().map(|v| v.name()) {
        if !effect.variables.contains(&variable) {
            effect.variables.push(variable);
        }
    }
    effect.known_as = None;
}

/// The curve of what two laws at one port do together; `None` if they are over different variables.
pub fn together(one: &Curve, other: &Curve, acts: &str) -> Option<Curve> {
    if one.variable != other.variable || one.x != other.x {
        return None;
    }
    let is_sum = acts == Acts::Adds.word();
    let half = |curve: &Curve, i: usize| 0.5 * (curve.high[i] - curve.low[i]);
    let (mut y, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (a, b)) in one.y.iter().zip(&other.y).enumerate() {
        let (value, slopes) = if is_sum { (a + b, [1.0, 1.0]) } else { (a * b, [*b, *a]) };
        let width = (half(one, i) * slopes[0]).hypot(half(other, i) * slopes[1]);
        y.push(value);
        low.push(value - width);
        high.push(value + width);
    }
    Some(Curve { variable: one.variable.clone(), x: one.x.clone(), y, low, high, freehand: None })
}

/// The port of an effect, as answers write it.
pub fn port(placed: &Placed) -> String {
    if let Some(own) = written(placed) {
        return own.law.address.to_string();
    }
    let port = &placed.spec().port;
    match (&placed.channel, port.split_once('.')) {
        (Some(channel), _) => format!("{port}.{channel}"),
        (None, Some((element, term))) if placed.element.is_numbered && placed.element.kind.name() == element => {
            format!("{}.{term}", placed.element)
        }
        _ => port.clone(),
    }
}

/// All parameters of an effect of a fit.
fn values(fit: &Fit, effect: usize) -> Vec<f64> {
    let calibration = fit.x.len() - fit.model.effect_parameters();
    fit.model.values_of(effect, &fit.x[calibration..])
}

/// A law with fitted values: its expression, then its states.
fn text(own: &WrittenLaw, parameters: &[f64]) -> String {
    let values = own.values(parameters);
    let number = |expression: &Option<String>| {
        expression.as_ref().map(|expression| with_parameters(&own.law, expression, &values))
    };
    let mut text = with_parameters(&own.law, &own.law.expression, &values);
    for (name, state) in &own.table.state {
        if let Some(rate) = number(&state.rate) {
            text += &format!("; d{name}/dt = {rate}");
        }
        if let Some(greatest) = number(&state.greatest) {
            text += &format!("; {name} = greatest {greatest} so far");
        }
        if let Some((followed, width)) = number(&state.play_of).zip(number(&state.width)) {
            text += &format!("; {name} follows {followed} with a play of {width}");
        }
    }
    text
}

/// An expression of a law with values in place of its parameters.
fn with_parameters(law: &Law, expression: &str, values: &[f64]) -> String {
    let mut text = String::new();
    let mut word = String::new();
    for c in expression.chars().chain([' ']) {
        if c.is_ascii_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        match law.parameter(&word) {
            Some(p) => push_number(&mut text, values[p]),
            None => text += &word,
        }
        word.clear();
        text.push(c);
    }
    text.trim_end().to_owned()
}

/// Appends a number with six significant digits; after a plus, a negative one becomes a difference.
fn push_number(text: &mut String, value: f64) {
    let is_difference = value < 0.0 && text.ends_with("+ ");
    if is_difference {
        text.truncate(text.len() - 2);
        text.push_str("- ");
    }
    let value = if is_difference { -value } else { value };
    // What was written with six digits is read as a number.
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    *text += &match rounded.abs() {
        size if size == 0.0 || (1e-3..1e6).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    };
}

/// The alternative laws, with their difference in chi² in units of `unit`.
pub fn forms(fits: &[Fit], against: f64, unit: f64) -> Vec<Form> {
    let form = |fit: &Fit| {
        let at = fit.model.effects.len().checked_sub(1)?;
        let own = written(&fit.model.effects[at])?;
        Some(Form {
            port: own.law.address.to_string(),
            acts: own.law.acts.word().to_owned(),
            law: text(own, &values(fit, at)),
            known_as: known_as(own, &values(fit, at)),
            score_difference: (fit.cost - against) / unit,
        })
    };
    fits.iter().filter_map(form).collect()
}

/// The curve of a written law over the visited range, with the band from its own parameters.
pub fn curve(case: &Case, fit: &Fit, at: usize) -> Option<Curve> {
    let (variable, x, y) = line(case, fit, at)?;
    let own = written(&fit.model.effects[at])?;
    let over = |parameters: &[f64]| -> Vec<f64> { x.iter().map(|&x| value(own, parameters, x)).collect() };
    let half = band(fit, at, &values(fit, at), &y, &over);
    let low = y.iter().zip(&half).map(|(y, h)| y - h).collect();
    let high = y.iter().zip(&half).map(|(y, h)| y + h).collect();
    Some(Curve { variable, x, y, low, high, freehand: None })
}

/// The variable of a written law, where the runs have been, and the law there; `None` of several variables or with memory.
fn line(case: &Case, fit: &Fit, at: usize) -> Option<(String, Vec<f64>, Vec<f64>)> {
    let own = written(&fit.model.effects[at])?;
    let [variable] = own.law.variables()[..] else { return None };
    let visited = case.runs.iter().filter_map(|run| {
        let setting = fit.model.setting(case, run, &fit.x);
        run.rom.visited(&run.drive, &setting, std::slice::from_ref(&own.law))
    });
    let (low, high) = visited
        .flatten()
        .flatten()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low >= high || !own.law.states.is_empty() {
        return None;
    }
    let x: Vec<f64> = (0..POINTS).map(|i| low + (high - low) * i as f64 / (POINTS - 1) as f64).collect();
    let best = values(fit, at);
    let y = x.iter().map(|&x| value(own, &best, x)).collect();
    Some((variable.name(), x, y))
}

/// Names an effect, or a form, by its curve where the runs have been.
pub fn name_over(placed: &Placed, (x, y): (&[f64], &[f64]), known_as: &mut Option<String>) {
    let Some(own) = written(placed) else { return };
    let mut pairs: Vec<(f64, f64)> = x.iter().map(|x| x.abs()).zip(y.iter().copied()).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let values: Vec<f64> = pairs.into_iter().map(|(_, y)| y).collect();
    *known_as = known_as::over(&own.law, &values).map(str::to_owned);
}

/// The same of the alternatives to an effect.
pub fn name_forms(case: &Case, fits: &[Fit], forms: &mut [Form]) {
    let laws = fits.iter().filter_map(|fit| Some((fit, fit.model.effects.len().checked_sub(1)?)));
    let written = laws.filter(|(fit, at)| written(&fit.model.effects[*at]).is_some());
    for ((fit, at), form) in written.zip(forms) {
        if let Some((_, x, y)) = line(case, fit, at) {
            name_over(&fit.model.effects[at], (&x, &y), &mut form.known_as);
        }
    }
}

/// Common name of a law.
fn known_as(own: &WrittenLaw, parameters: &[f64]) -> Option<String> {
    known_as::known_as(&own.law, &own.values(parameters), &|x| value(own, parameters, x)).map(str::to_owned)
}

/// Value of a law at its variable, with the parameters of an effect.
fn value(own: &WrittenLaw, parameters: &[f64], x: f64) -> f64 {
    let values = own.values(parameters);
    let read = |symbol: &Symbol| match symbol {
        Symbol::Parameter(p) => values[*p],
        Symbol::Constant(c) => *c,
        Symbol::Variable(_) | Symbol::State(_) => x,
    };
    let by_symbol: Vec<f64> = own.law.symbols.iter().map(read).collect();
    own.law.programs.value.value(&by_symbol)
}

/// Half of the 95 % band of a curve, from the covariance of the law's fitted parameters.
fn band(fit: &Fit, at: usize, best: &[f64], y: &[f64], over: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let calibration = fit.x.len() - fit.model.effect_parameters();
    let own = fit.model.places().into_iter().enumerate().filter(|(_, (effect, _))| *effect == at);
    let fitted: Vec<(usize, usize)> = own.map(|(k, (_, i))| (calibration + k, i)).collect();
    let slopes: Vec<Vec<f64>> = fitted
        .iter()
        .map(|&(_, i)| {
            let step = 1e-4 * best[i].abs().max(f64::MIN_POSITIVE);
            let mut moved = best.to_vec();
            moved[i] += step;
            over(&moved).iter().zip(y).map(|(a, b)| (a - b) / step).collect()
        })
        .collect();
    let variance = |k: usize| -> f64 {
        let pairs = fitted.iter().enumerate().flat_map(|(a, &(row, _))| {
            let slopes = &slopes;
            fitted
                .iter()
                .enumerate()
                .map(move |(b, &(column, _))| slopes[a][k] * slopes[b][k] * fit.covariance[(row, column)])
        });
        pairs.sum()
    };
    (0..y.len()).map(|k| 1.96 * variance(k).max(0.0).sqrt()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{EntryId, Fitted, Range};
    use crate::laws::{LawTable, Surroundings};

    /// A law with a size `a`, absent at zero, as answers write it with these parameters.
    fn written(table: &str, values: &[f64]) -> String {
        let table: LawTable = toml::from_str(table).expect("TOML");
        let law = table.law(&Surroundings::default()).expect("a law");
        let range = Range { min: -1e9, max: 1e9 };
        let parameters = law.parameters.iter().map(|p| Fitted { typical: p.value, range, is_fitted: true });
        let entry = EntryId::write(&table, &law, 0, &parameters.collect::<Vec<_>>());
        text(entry.entry().unlisted().expect("it was written"), values)
    }

    #[test]
    fn a_law_is_written_with_its_numbers() {
        let table = "name = 'x'\nport = 'muscle.wall'\nscales = '1 + a * exp(-abs(time_s/scale_s))'\n\
             parameter.a = { value = 1.0 }\nparameter.scale_s = { value = 1.0 }";
        assert_eq!(written(table, &[0.5, 20.0]), "1 + 0.5 * exp(-abs(time_s/20))");
        assert_eq!(written(table, &[-1.0 / 3.0, 2e-7]), "1 - 0.333333 * exp(-abs(time_s/2e-7))");
    }

    /// Two laws that scale multiply, two that add are a sum; the band is that of two independent ones.
    #[test]
    fn two_laws_at_one_port_have_one_curve() {
        let curve = |y: [f64; 2], half: f64| Curve {
            variable: "time_s".to_owned(),
            x: vec![0.0, 1.0],
            y: y.to_vec(),
            low: y.map(|y| y - half).to_vec(),
            high: y.map(|y| y + half).to_vec(),
            freehand: None,
        };
        let (one, other) = (curve([1.0, 2.0], 0.3), curve([3.0, 4.0], 0.4));
        let both = |acts: Acts| together(&one, &other, acts.word()).expect("over the same variable");
        assert_eq!((both(Acts::Adds).y, both(Acts::Scales).y), (vec![4.0, 6.0], vec![3.0, 8.0]));
        assert!((both(Acts::Adds).high[0] - 4.5).abs() < 1e-12);
        assert!((both(Acts::Scales).low[1] - (8.0 - f64::hypot(0.3 * 4.0, 0.4 * 2.0))).abs() < 1e-12);
        assert_eq!(together(&one, &Curve { variable: "speed_m_s".to_owned(), ..other.clone() }, "adds"), None);
    }

    /// States follow the expression: without them its variables are unknown.
    #[test]
    fn what_a_law_remembers_is_written_with_it() {
        let with = |unit: &str, state: &str, more: &str| {
            let size = format!("parameter.a = {{ value = 1.0, unit = '{unit}' }}");
            format!("name = 'x'\nport = 'muscle.wall'\nscales = '1 + a * s'\n{size}\n{more}\n{state}")
        };
        let lag = "parameter.lag_s = { value = 1.0 }";
        let behind = with("1/s", "state.s = { rate = '(time_s - s)/lag_s', start = 'time_s' }", lag);
        assert_eq!(written(&behind, &[0.5, 20.0]), "1 + 0.5 * s; ds/dt = (time_s - s)/20");
        let greatest = with("1/m", "state.s = { greatest = 'abs(elongation_m)' }", "");
        assert_eq!(written(&greatest, &[0.5]), "1 + 0.5 * s; s = greatest abs(elongation_m) so far");
        let width = "parameter.width_m = { value = 1.0 }";
        let play = with("1/m", "state.s = { play_of = 'elongation_m', width = 'width_m' }", width);
        assert_eq!(written(&play, &[0.5, 2e-3]), "1 + 0.5 * s; s follows elongation_m with a play of 0.002");
    }
}
