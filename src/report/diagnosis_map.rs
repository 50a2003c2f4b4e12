//! Where, as pictures: windows of mismatch on time lines, a map over state.

use crate::diagnose::{CaseRun, Direction, Outcome};
use crate::recording::parse_column;

use super::axis::Axis;
use super::svg::{Anchor, GREY, Rect, Svg, VERMILION, cut_to, text_width};

pub(super) const WIDTH: f64 = 900.0;
pub(super) const LABELS: f64 = 220.0;
pub(super) const TEXT: f64 = 11.0;
pub(super) const ROW: f64 = 22.0;
pub(super) const EDGE: f64 = 14.0;
const PALE: &str = "#eef2f5";

/// Every run as a line over time, with the stretches marked in which the baseline is off by more than noise.
pub fn time_lines_svg(outcome: &Outcome) -> String {
    let runs = &outcome.case.runs;
    let longest_s = runs.iter().map(|r| span_s(r).1 - span_s(r).0).fold(1.0, f64::max);
    let mut svg = Svg::new(WIDTH, 2.0 * EDGE + ROW * (runs.len() as f64 + 1.0));
    let scale = (WIDTH - LABELS - 2.0 * EDGE) / longest_s;
    for (i, run) in runs.iter().enumerate() {
        let y = EDGE + ROW * i as f64;
        let (start, end) = span_s(run);
        let sealed = if run.is_sealed { " (sealed)" } else { "" };
        label(&mut svg, y, &format!("{}{sealed}", run.file));
        let bar = |from: f64, to: f64| Rect {
            x: LABELS + scale * (from - start),
            y: y + 3.0,
            width: (scale * (to - from)).max(1.0),
            height: ROW - 8.0,
        };
        svg.fill(bar(start, end), PALE, 1.0);
        let windows = outcome.diagnosis.location.time_windows_s.iter().filter(|(file, _, _)| *file == run.file);
        windows.for_each(|(_, from, to)| svg.fill(bar(from.max(start), to.min(end)), VERMILION, 0.8));
    }
    let bottom = EDGE + ROW * runs.len() as f64;
    for (t, text) in Axis::over([0.0, longest_s].into_iter(), 0.0, 10).ticks() {
        svg.line((LABELS + scale * t, bottom), (LABELS + scale * t, bottom + 4.0), GREY, 1.0);
        svg.text((LABELS + scale * t, bottom + 16.0), Anchor::Middle, TEXT, &text);
    }
    svg.text((LABELS - 12.0, bottom + 16.0), Anchor::End, TEXT, "time from the start of the run (s)");
    svg.finish()
}

fn span_s(run: &CaseRun) -> (f64, f64) {
    let times = run.times_s();
    (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0))
}

pub(super) fn label(svg: &mut Svg, y: f64, text: &str) {
    svg.text((LABELS - 12.0, y + 14.0), Anchor::End, TEXT, &cut_to(text, TEXT, LABELS - 20.0));
}

/// Levels of the first input that the map is cut into.
const LEVELS: usize = 10;

/// Residual over noise by level of the first input and direction of its motion, one row per channel and direction.
pub fn state_map_svg(outcome: &Outcome, residuals: &[Vec<Vec<f64>>]) -> String {
    let case = &outcome.case;
    let rows: Vec<(usize, Direction)> =
        (0..case.channels.len()).flat_map(|c| Direction::ALL.map(|direction| (c, direction))).collect();
    let mut svg = Svg::new(WIDTH, 2.0 * EDGE + ROW * (rows.len() as f64 + 3.0));
    let Some((low, high)) = input_range(outcome) else { return svg.finish() };
    let cell_width = (WIDTH - LABELS - 2.0 * EDGE) / LEVELS as f64;
    for (row, (channel, direction)) in rows.iter().enumerate() {
        let y = EDGE + ROW * row as f64;
        label(&mut svg, y, &format!("{}, {}", case.channels[*channel].column, direction.words()));
        let level = |run: &CaseRun, i: usize| {
            let input = run.drive.inputs[0][run.lead_in + i];
            ((input - low) / (high - low) * LEVELS as f64).clamp(0.0, LEVELS as f64 - 1.0) as usize
        };
        let mut sums = [(0.0, 0usize); LEVELS];
        for (run, residuals) in case.runs.iter().zip(residuals) {
            for (i, r) in residuals[*channel].iter().enumerate().filter(|(_, r)| r.is_finite()) {
                if run.direction(i) == *direction {
                    let sum = &mut sums[level(run, i)];
                    *sum = (sum.0 + (r / outcome.noise[*channel].sd).powi(2), sum.1 + 1);
                }
            }
        }
        for (k, (sum, count)) in sums.iter().enumerate().filter(|(_, (_, count))| *count > 10) {
            let rect = Rect { x: LABELS + cell_width * k as f64, y, width: cell_width - 1.0, height: ROW - 1.0 };
            cell(&mut svg, rect, (sum / *count as f64).sqrt());
        }
    }
    let bottom = EDGE + ROW * rows.len() as f64;
    input_axis(&mut svg, bottom, &case.scene.file.input[0].channel, (low, high));
    colour_key(&mut svg, bottom + 52.0);
    svg.finish()
}

/// The axis of the first input (SI), in the unit of its column.
fn input_axis(svg: &mut Svg, bottom: f64, column: &str, (low, high): (f64, f64)) {
    let name = parse_column(column).ok();
    let shown = |value: f64| name.as_ref().map_or(value, |n| n.unit.from_si(value));
    let axis = Axis::over([shown(low), shown(high)].into_iter(), 0.0, LEVELS);
    let width = WIDTH - LABELS - 2.0 * EDGE;
    for (value, text) in axis.ticks() {
        let x = LABELS + width * axis.share(value);
        svg.line((x, bottom), (x, bottom + 4.0), GREY, 1.0);
        svg.text((x, bottom + 16.0), Anchor::Middle, TEXT, &text);
    }
    let label = name.map_or_else(|| column.to_owned(), |n| n.axis_label());
    svg.text((LABELS + width / 2.0, bottom + 34.0), Anchor::Middle, TEXT, &label);
}

/// What the colours stand for.
fn colour_key(svg: &mut Svg, y: f64) {
    const SWATCH: f64 = 46.0;
    const SHOWN: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 30.0];
    let text = "RMS of the residual / noise (1)";
    svg.text((LABELS, y + 15.0), Anchor::Start, TEXT, text);
    let left = LABELS + text_width(text, TEXT) + 12.0;
    for (k, over_noise) in SHOWN.into_iter().enumerate() {
        let rect = Rect { x: left + SWATCH * k as f64, y, width: SWATCH - 1.0, height: ROW - 1.0 };
        paint(svg, rect, over_noise, &format!("{over_noise:.0}"));
    }
}

fn input_range(outcome: &Outcome) -> Option<(f64, f64)> {
    let all = outcome.case.runs.iter().flat_map(|r| r.drive.inputs.first()).flatten();
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    (high > low).then_some((low, high))
}

fn cell(svg: &mut Svg, rect: Rect, over_noise: f64) {
    paint(svg, rect, over_noise, &format!("{over_noise:.1}"));
}

/// Pale where there is noise only, darker by the logarithm of what is more.
fn paint(svg: &mut Svg, rect: Rect, over_noise: f64, text: &str) {
    let opacity = (over_noise.max(1.0).log10() / 1.5).clamp(0.0, 0.9);
    svg.fill(rect, PALE, 1.0);
    svg.fill(rect, VERMILION, opacity);
    svg.text((rect.x + rect.width / 2.0, rect.y + 15.0), Anchor::Middle, TEXT, text);
}
