//! Where and how much, as pictures: windows of mismatch on time lines, a map over state, bars by channel.

use crate::diagnose::{CaseRun, Direction, Outcome};
use crate::recording::parse_column;

use super::axis::three_digits;
use super::svg::{Anchor, BLUE, GREY, Rect, Svg, VERMILION, cut_to, text_width};

const WIDTH: f64 = 900.0;
const LABELS: f64 = 220.0;
const TEXT: f64 = 11.0;
const ROW: f64 = 22.0;
const EDGE: f64 = 14.0;
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
    let step_s = tick_s(longest_s);
    for k in 0..=(longest_s / step_s) as usize {
        let t = step_s * k as f64;
        svg.line((LABELS + scale * t, bottom), (LABELS + scale * t, bottom + 4.0), GREY, 1.0);
        svg.text((LABELS + scale * t, bottom + 16.0), Anchor::Middle, TEXT, &three_digits(t));
    }
    svg.text((LABELS - 12.0, bottom + 16.0), Anchor::End, TEXT, "time from the start of the run (s)");
    svg.finish()
}

fn span_s(run: &CaseRun) -> (f64, f64) {
    let times = run.times_s();
    (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0))
}

/// A round interval that cuts a span into six to twelve.
fn tick_s(span_s: f64) -> f64 {
    let rough = span_s / 8.0;
    let ten = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * ten).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * ten)
}

fn label(svg: &mut Svg, y: f64, text: &str) {
    svg.text((LABELS - 12.0, y + 14.0), Anchor::End, TEXT, &cut_to(text, TEXT, LABELS - 20.0));
}

/// Levels of the first input that the map is cut into.
const LEVELS: usize = 10;

/// Residual over noise by level of the first input and direction of its motion, one row per channel and direction.
pub fn state_map_svg(outcome: &Outcome, residuals: &[Vec<Vec<f64>>]) -> String {
    let case = &outcome.case;
    let rows: Vec<(usize, Direction)> =
        (0..case.channels.len()).flat_map(|c| Direction::ALL.map(|direction| (c, direction))).collect();
    let mut svg = Svg::new(WIDTH, 2.0 * EDGE + ROW * (rows.len() as f64 + 2.0));
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
    let unit = parse_column(&case.scene.file.input[0].channel).ok();
    for k in 0..=LEVELS {
        let value = low + (high - low) * k as f64 / LEVELS as f64;
        let text = unit.as_ref().map_or(three_digits(value), |u| three_digits(u.unit.from_si(value)));
        svg.text((LABELS + cell_width * k as f64, bottom + 16.0), Anchor::Middle, TEXT, &text);
    }
    let name = unit.map_or_else(|| case.scene.file.input[0].channel.clone(), |u| u.axis_label());
    svg.text((LABELS + cell_width * LEVELS as f64 / 2.0, bottom + 34.0), Anchor::Middle, TEXT, &name);
    svg.finish()
}

fn input_range(outcome: &Outcome) -> Option<(f64, f64)> {
    let all = outcome.case.runs.iter().flat_map(|r| r.drive.inputs.first()).flatten();
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    (high > low).then_some((low, high))
}

/// White where there is noise only, darker by the logarithm of what is more.
fn cell(svg: &mut Svg, rect: Rect, over_noise: f64) {
    let opacity = (over_noise.max(1.0).log10() / 1.5).clamp(0.0, 0.9);
    svg.fill(rect, PALE, 1.0);
    svg.fill(rect, VERMILION, opacity);
    let at = (rect.x + rect.width / 2.0, rect.y + 15.0);
    svg.text(at, Anchor::Middle, TEXT, &format!("{over_noise:.1}"));
}

/// Error over noise on the sealed runs by channel, before and after, on a logarithmic axis.
pub fn bars_svg(outcome: &Outcome) -> String {
    let channels = &outcome.diagnosis.fit.channels;
    let mut svg = Svg::new(WIDTH, 2.0 * EDGE + 2.0 * ROW * (channels.len() as f64 + 1.0));
    let ratios = |p: &crate::diagnose::ChannelProof| [p.rmse_baseline / p.noise_sd, p.rmse_corrected / p.noise_sd];
    let greatest = channels.values().flat_map(ratios).fold(10.0, f64::max);
    let room = WIDTH - LABELS - 2.0 * EDGE - 60.0;
    let (low, high) = (0.5f64.log10(), greatest.log10());
    let x = |ratio: f64| LABELS + room * ((ratio.max(0.5).log10() - low) / (high - low));
    for (i, (column, proof)) in channels.iter().enumerate() {
        let y = EDGE + 2.0 * ROW * i as f64;
        label(&mut svg, y + ROW / 2.0, column);
        for (k, (ratio, colour)) in ratios(proof).into_iter().zip([VERMILION, BLUE]).enumerate() {
            let y = y + ROW * 0.85 * k as f64;
            svg.fill(Rect { x: LABELS, y: y + 3.0, width: x(ratio) - LABELS, height: ROW - 7.0 }, colour, 0.8);
            svg.text((x(ratio) + 6.0, y + 15.0), Anchor::Start, TEXT, &format!("{ratio:.2}"));
        }
    }
    let bottom = EDGE + 2.0 * ROW * channels.len() as f64;
    svg.line((x(1.0), EDGE), (x(1.0), bottom), GREY, 1.0);
    svg.text((x(1.0), bottom + 14.0), Anchor::Middle, TEXT, "noise");
    let mut at = LABELS + 60.0;
    for (text, colour) in [("calibrated scene", VERMILION), ("corrected scene", BLUE)] {
        svg.fill(Rect { x: at, y: bottom + 22.0, width: 12.0, height: 12.0 }, colour, 0.8);
        svg.text((at + 18.0, bottom + 32.0), Anchor::Start, TEXT, text);
        at += 40.0 + text_width(text, TEXT);
    }
    svg.text((at + 10.0, bottom + 32.0), Anchor::Start, TEXT, "error of sealed runs in units of the noise (log)");
    svg.finish()
}
