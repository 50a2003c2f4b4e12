//! The pictures of a sweep's page.

use smam::recording::axis_label;
use smam::report::{
    BLUE, Bar, BarPanel, GREEN, GREY, Mark, ORANGE, PURPLE, Panel, SILVER, Scale, Series, VERMILION, quantity,
};
use smam::sweep::{LimitSpec, MeasureSpec, ObjectiveSpec, Plan, SamplingSpec, Sensitivity, Table, excess};
use smam::system::Concern;

use super::sweep_trouble::in_trouble;

/// Lines of one panel; more values of a second key are thinned to so many.
const COLOURS: [&str; 6] = [BLUE, ORANGE, GREEN, PURPLE, VERMILION, GREY];
/// Strips where a limit is broken.
const BEYOND: [&str; 4] = [VERMILION, ORANGE, PURPLE, BLUE];

/// Each measure over the first key.
pub fn panels(plan: &Plan, table: &Table, best: &[usize]) -> Vec<Panel> {
    let Some(first) = plan.file.vary.first() else { return Vec::new() };
    let si = table.column(&first.key).unwrap_or_default();
    let scale = scale_of(&first.key, &si);
    let x: Vec<f64> = si.iter().map(|v| v / scale.factor).collect();
    let panel = |m: &MeasureSpec| {
        let y = table.column(&m.name).unwrap_or_default();
        let mut marks: Vec<Mark> =
            first.mark.iter().map(|m| mark(m.label.clone(), SILVER, m.at / scale.factor)).collect();
        if let ([best], true) = (best, is_line(plan)) {
            marks.push(mark(format!("best: {}", scale.short(si[*best])), GREEN, x[*best]));
        }
        let [series, points] = lines_or_points(plan, table, &x, &y);
        Panel {
            title: [Some(m.name.clone()), Some(m.of.clone()), constant(&y)].into_iter().flatten().collect(),
            x_label: key_label(&first.key, &scale),
            y_label: axis_label(&m.name),
            behind: if is_line(plan) { beyond(plan, table, &x, &y) } else { Vec::new() },
            series,
            points,
            marks,
            ..Panel::default()
        }
    };
    plan.file.measure.iter().map(panel).collect()
}

/// How the values of a key are shown, all of them in one unit.
pub fn scale_of(key: &str, values: &[f64]) -> Scale {
    let greatest = values.iter().copied().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
    Scale::of(key, None, greatest)
}

/// A key as it stands in the scene, and the unit in which it is shown.
fn key_label(key: &str, scale: &Scale) -> String {
    if scale.symbol.is_empty() { key.to_owned() } else { format!("{key}, shown in {}", scale.symbol) }
}

/// Said of a measure that the sweep does not move by more than rounding errors.
fn constant(y: &[f64]) -> Option<String> {
    let finite = || y.iter().copied().filter(|v| v.is_finite());
    let size = finite().fold(0.0, |m: f64, v| m.max(v.abs()));
    let is_constant = finite().count() > 1 && (reach(y) <= 1e-9 * size || size == 0.0);
    is_constant
        .then(|| format!("does not change: {} at every point", quantity("", None, finite().next().unwrap_or(0.0))))
}

/// The first two objectives against each other: what was tried, and the best of it.
pub fn front_panel(plan: &Plan, table: &Table, best: &[usize]) -> Option<Panel> {
    let [one, other, ..] = plan.file.objective.as_slice() else { return None };
    let column = |o: &ObjectiveSpec| table.column(&o.measure).unwrap_or_default();
    let (x, y) = (column(one), column(other));
    let mut order = best.to_vec();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let pick = |from: &[f64]| order.iter().map(|&i| from[i]).collect::<Vec<f64>>();
    let front = line("best".to_owned(), VERMILION, pick(&x), pick(&y));
    Some(Panel {
        title: vec![format!("{} and {}", one.measure, other.measure)],
        x_label: axis_label(&one.measure),
        y_label: axis_label(&other.measure),
        points: vec![line("all points".to_owned(), SILVER, x, y), front],
        ..Panel::default()
    })
}

/// Sensitivities: one plot for each measure.
pub fn bars(plan: &Plan, found: &Sensitivity) -> Vec<BarPanel> {
    let (legend, label): (Vec<(&str, &'static str)>, &str) = match plan.file.sampling {
        SamplingSpec::Morris { .. } => {
            (vec![("μ*: mean size of the effect", BLUE), ("σ: its spread", ORANGE)], "change over the key's range")
        }
        _ => (vec![("first order: alone", BLUE), ("total: with all others", ORANGE)], "share of the variance"),
    };
    let of_measure = |m: &MeasureSpec| {
        let own = found.influences.iter().filter(|i| i.measure == m.name);
        let bars = |i: &smam::sweep::Influence| {
            let shown = i.numbers.iter().take(legend.len());
            shown.map(|n| Bar { value: n.value, low: n.low, high: n.high }).collect()
        };
        BarPanel {
            title: m.name.clone(),
            label: label.to_owned(),
            legend: legend.iter().map(|(name, colour)| ((*name).to_owned(), *colour)).collect(),
            groups: own.map(|i| (i.key.clone(), bars(i))).collect(),
            is_logarithmic: false,
        }
    };
    plan.file.measure.iter().map(of_measure).collect()
}

/// What it means to break a limit, in words.
pub fn broken(limit: &LimitSpec) -> String {
    let bounds =
        [limit.min.map(|m| format!("{} < {m}", limit.measure)), limit.max.map(|m| format!("{} > {m}", limit.measure))];
    let words = bounds.into_iter().flatten().collect::<Vec<_>>().join(" or ");
    if limit.label.is_empty() { words } else { limit.label.clone() }
}

/// Whether the sweep is one line over one key.
fn is_line(plan: &Plan) -> bool {
    plan.file.sampling == SamplingSpec::Grid && plan.file.vary.len() == 1
}

/// Strips below a measure along the values of the key at which limits are broken, or runs are in trouble, one for each.
fn beyond(plan: &Plan, table: &Table, x: &[f64], y: &[f64]) -> Vec<Series> {
    let least = y.iter().copied().filter(|v| v.is_finite()).fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { least } else { 0.0 };
    // A measure that never changes has an axis of its own.
    let step = if reach(y) > 1e-9 * least.abs().max(1e-9) { 0.06 * reach(y) } else { 0.1 };
    let is_broken = |limit: &LimitSpec| -> Vec<bool> {
        let of = table.column(&limit.measure).unwrap_or_default();
        of.iter().map(|v| excess(limit, *v) > 0.0).collect()
    };
    let limits = plan.file.limit.iter().map(|limit| (broken(limit), is_broken(limit)));
    let warned = Concern::ALL.map(|concern| {
        let at = in_trouble(plan, table, concern).iter().map(Option::is_some).collect();
        (format!("warning: {}", concern.word()), at)
    });
    let all = limits.chain(warned).filter(|(_, at): &(String, Vec<bool>)| at.contains(&true));
    let strip = |(i, ((name, at), colour)): (usize, ((String, Vec<bool>), &'static str))| {
        let (along, level) = (stretches(x, &at), least - (i + 1) as f64 * step);
        let y = along.iter().map(|x| if x.is_finite() { level } else { f64::NAN }).collect();
        line(name, colour, along, y)
    };
    all.zip(BEYOND.into_iter().cycle()).enumerate().map(strip).collect()
}

/// Ends of the stretches of a grid that belong to chosen values, half-way to those beside them, cut by NaN.
fn stretches(x: &[f64], chosen: &[bool]) -> Vec<f64> {
    let middle = |i: usize, j: usize| 0.5 * (x[i] + x[j.min(x.len() - 1)]);
    let own = (0..x.len()).filter(|&i| chosen[i]);
    own.flat_map(|i| [middle(i, i.saturating_sub(1)), middle(i, i + 1), f64::NAN]).collect()
}

/// Lines over the first key of a grid, one for each value of the second; points for samples.
fn lines_or_points(plan: &Plan, table: &Table, x: &[f64], y: &[f64]) -> [Vec<Series>; 2] {
    let all = vec![line(String::new(), BLUE, x.to_vec(), y.to_vec())];
    if plan.file.sampling != SamplingSpec::Grid || plan.file.vary.len() > 2 {
        return [Vec::new(), all];
    }
    let Some(second) = plan.file.vary.get(1) else { return [all, Vec::new()] };
    let of_second = table.column(&second.key).unwrap_or_default();
    let scale = scale_of(&second.key, &of_second);
    let mut values = of_second.clone();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let every = values.len().div_ceil(COLOURS.len()).max(1);
    let shown = values.into_iter().step_by(every).zip(COLOURS);
    let lines = shown
        .map(|(value, colour)| {
            let own: Vec<usize> = (0..x.len()).filter(|i| of_second[*i] == value).collect();
            let pick = |from: &[f64]| own.iter().map(|&i| from[i]).collect();
            line(format!("{} = {}", short(&second.key), scale.short(value)), colour, pick(x), pick(y))
        })
        .collect();
    [lines, Vec::new()]
}

fn mark(label: String, colour: &'static str, at: f64) -> Mark {
    Mark { label, colour, at }
}

/// Last words of a key.
pub fn short(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

fn line(label: String, colour: &'static str, x: Vec<f64>, y: Vec<f64>) -> Series {
    Series { label, colour, x, y }
}

fn reach(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    (finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_change_is_said_so() {
        assert_eq!(constant(&[3.0, 3.0, f64::NAN]).as_deref(), Some("does not change: 3.00 at every point"));
        assert_eq!(constant(&[0.0, 0.0]).as_deref(), Some("does not change: 0 at every point"));
        assert_eq!([constant(&[3.0, 3.1]), constant(&[3.0])], [None, None]);
    }

    #[test]
    fn keys_and_measures_carry_their_units() {
        let key = "hydraulics.line.bore_m";
        let scale = scale_of(key, &[3e-4, 8e-4, f64::NAN]);
        assert_eq!(key_label(key, &scale), "hydraulics.line.bore_m, shown in mm");
        assert_eq!(scale.short(3e-4), "0.3 mm");
        assert_eq!(
            key_label("muscles.pre_elongation_ratio", &scale_of("x_ratio", &[0.5])),
            "muscles.pre_elongation_ratio"
        );
    }

    #[test]
    fn a_single_value_has_a_stretch_of_its_own() {
        let found = stretches(&[1.0, 2.0, 4.0], &[true, false, true]);
        assert_eq!([found[0], found[1], found[3], found[4]], [1.0, 1.5, 3.0, 4.0]);
        assert!(found[2].is_nan() && found.len() == 6);
    }
}
