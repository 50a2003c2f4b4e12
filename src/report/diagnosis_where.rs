//! Where, as a page of a diagnosis shows it: elements, stretches of time, states.

use crate::diagnose::{Balance, CaseRun, Direction, Location, Outcome};
use crate::recording::{axis_label, parse_column};

use super::axis::three_digits;
use super::colour::VERMILION;
use super::diagnosis_words::region_words;
use super::kit::{Bar, BarPanel, HeatMap, HtmlPage, Lane, Window};

/// Adds the section.
pub(super) fn location(page: &mut HtmlPage, outcome: &Outcome) {
    let location = &outcome.diagnosis.location;
    if location.element.is_none() {
        return;
    }
    page.heading("Where");
    if !location.state_region.is_empty() {
        page.paragraph(&format!("The calibrated scene is furthest off at {}.", region_words(&location.state_region)));
    }
    let by_laws = outcome.diagnosis.effects.iter().any(|e| e.hypothetical);
    let label = if by_laws { "share of the misfit that a law there explains" } else { "probability" };
    let elements = BarPanel {
        title: "Element".to_owned(),
        label: label.to_owned(),
        legend: vec![(String::new(), VERMILION)],
        groups: location.ranked.iter().map(|(element, p)| (element.clone(), vec![Bar::plain(*p)])).collect(),
        is_logarithmic: false,
    };
    page.bars(&elements, "");
    balances(page, location);
    if let Some(set) = location.indistinguishable.first() {
        page.paragraph(&format!("With these channels, effects in {} can look the same.", set.join(" and ")));
    }
    if let Some([before, after]) = &outcome.residuals {
        page.subheading("Time");
        page.lanes(&lanes(outcome));
        page.small(
            "Marked: the calibrated scene is off by more than noise. Press a mark to see it in the curves above.",
        );
        states(page, outcome, before, after);
    }
}

/// Ports that the table of balances shows, at most.
const PORTS: usize = 10;

/// What something unknown at each port would leave, the likeliest first.
fn balances(page: &mut HtmlPage, location: &Location) {
    if location.balances.is_empty() {
        return;
    }
    page.subheading("Balances");
    page.small(
        "If something unknown acts at a port, whatever it does over time: twice the logarithm of how much less likely the recordings are than \
         with the first port, and what is left of the worst run, in standard errors of noise. Where that is noise, the balances of all other elements close.",
    );
    let row = |balance: &Balance| -> Vec<String> {
        let worst = balance.left_sigma.values().copied().fold(f64::NEG_INFINITY, f64::max);
        let left = if balance.closes { "noise".to_owned() } else { format!("{worst:.0}") };
        vec![format!("`{}`", balance.port), format!("{:.0}", balance.behind), left]
    };
    let rows: Vec<Vec<String>> = location.balances.iter().take(PORTS).map(row).collect();
    page.table(&["port", "behind", "left, sigma"], &rows);
}

/// Every run, with the stretches in which the calibrated scene is off by more than noise.
fn lanes(outcome: &Outcome) -> Vec<Lane> {
    let windows = &outcome.diagnosis.location.time_windows_s;
    let lane = |run: &CaseRun| {
        let times = run.times_s();
        let own = windows.iter().filter(|(file, ..)| *file == run.file);
        Lane {
            name: run_name(run),
            whole: Window { from_s: times.first().copied().unwrap_or(0.0), to_s: times.last().copied().unwrap_or(0.0) },
            marked: own.map(|(_, from_s, to_s)| Window { from_s: *from_s, to_s: *to_s }).collect(),
        }
    };
    outcome.case.runs.iter().map(lane).collect()
}

/// A run's file, and whether it was held out.
pub(super) fn run_name(run: &CaseRun) -> String {
    if run.is_held_out { format!("{} (held out)", run.file) } else { run.file.clone() }
}

fn states(page: &mut HtmlPage, outcome: &Outcome, before: &[Vec<Vec<f64>>], after: &[Vec<Vec<f64>>]) {
    let Some(range) = input_range(outcome) else { return };
    page.subheading("State");
    let words = "how far off (RMS of the residual over the noise), by level and motion of the first input. 1.0: noise only. \
                 Empty: nothing was recorded there.";
    page.heat_map(&state_map(outcome, before, range), &format!("Calibrated scene: {words}"));
    if !outcome.diagnosis.effects.is_empty() {
        page.heat_map(&state_map(outcome, after, range), "The same with what was found in place.");
    }
}

/// Levels of the first input that the map is cut into.
const LEVELS: usize = 10;
/// A cell of fewer samples says nothing.
const FEWEST: usize = 10;

/// Residual over noise by level of the first input (SI) and direction of its motion, a row for each channel and direction.
fn state_map(outcome: &Outcome, residuals: &[Vec<Vec<f64>>], range: (f64, f64)) -> HeatMap {
    let case = &outcome.case;
    let rows = (0..case.channels.len()).flat_map(|channel| {
        Direction::ALL.map(|direction| {
            let name = format!("{}, {}", case.channels[channel].column, direction.words());
            (name, state_row(outcome, residuals, channel, direction, range))
        })
    });
    let column = &case.scene.file.input[0].channel;
    let name = parse_column(column).ok();
    let middle = |level: usize| {
        let value = range.0 + (level as f64 + 0.5) * (range.1 - range.0) / LEVELS as f64;
        three_digits(name.as_ref().map_or(value, |n| n.unit.from_si(value)))
    };
    HeatMap {
        x_label: axis_label(column),
        columns: (0..LEVELS).map(middle).collect(),
        rows: rows.collect(),
        scale: [1.0, 30.0],
    }
}

fn state_row(
    outcome: &Outcome,
    residuals: &[Vec<Vec<f64>>],
    channel: usize,
    direction: Direction,
    (low, high): (f64, f64),
) -> Vec<Option<f64>> {
    let mut sums = [(0.0, 0usize); LEVELS];
    for (run, residuals) in outcome.case.runs.iter().zip(residuals) {
        let level = |i: usize| {
            let input = run.drive.inputs[0][run.lead_in + i];
            ((input - low) / (high - low) * LEVELS as f64).clamp(0.0, LEVELS as f64 - 1.0) as usize
        };
        for (i, r) in residuals[channel].iter().enumerate().filter(|(_, r)| r.is_finite()) {
            if run.direction(i) == direction {
                let sum = &mut sums[level(i)];
                *sum = (sum.0 + (r / outcome.noise[channel].sd).powi(2), sum.1 + 1);
            }
        }
    }
    sums.map(|(sum, count)| (count > FEWEST).then(|| (sum / count as f64).sqrt())).to_vec()
}

fn input_range(outcome: &Outcome) -> Option<(f64, f64)> {
    let all = outcome.case.runs.iter().flat_map(|r| r.drive.inputs.first()).flatten();
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    (high > low).then_some((low, high))
}
