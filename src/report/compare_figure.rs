//! The picture of `smam compare`: every run and output, measured and simulated, with the residual.

use super::axis::three_digits;
use super::panel::{Band, Panel, Series, draw_legend};
use super::quantity::with;
use super::svg::{Anchor, BLUE, GREY, Rect, Svg, VERMILION, cut_to};
use crate::recording::{gap_limit_s, parse_column};

/// Runs beside each other; more wrap to the next row.
const RUNS_PER_ROW: usize = 4;
const CELL_WIDTH: f64 = 430.0;
const SIGNAL_HEIGHT: f64 = 252.0;
const RESIDUAL_HEIGHT: f64 = 140.0;
const CELL_HEIGHT: f64 = SIGNAL_HEIGHT + RESIDUAL_HEIGHT + 18.0;
const HEADER_HEIGHT: f64 = 76.0;
const EDGE: f64 = 10.0;
/// Measured lines are broad and pale: the simulated ones lie on them and must not hide them.
const MEASURED: &str = "#8fc4e8";

/// One run of the figure.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedRun {
    /// Its name, in the titles.
    pub name: String,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Its output channels.
    pub channels: Vec<ComparedChannel>,
}

/// One output channel of a run; all values in the column's own unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedChannel {
    /// Its column, with the unit as suffix.
    pub column: String,
    /// Measured samples, NaN where missing.
    pub measured: Vec<f64>,
    /// Simulated samples at the same times.
    pub simulated: Vec<f64>,
    /// Standard deviation of the measurement noise; `None`: no band is drawn.
    pub noise_sd: Option<f64>,
    /// Root mean square of measured minus simulated.
    pub rmse: f64,
}

/// Draws the runs as columns and their channels as rows, as one self-contained SVG; what a run lacks is said in its place.
///
/// A cell shows measured and simulated over time, and below measured minus simulated with the band of
/// +- 2 noise standard deviations. Lines are cut where samples are missing and at gaps. `title` says what is compared
/// with what, `remark` what the reader must know to judge it (what was fitted); it may be empty.
pub fn compare_svg(title: &str, remark: &str, runs: &[ComparedRun]) -> String {
    let groups: Vec<(&[ComparedRun], Vec<&str>)> = runs.chunks(RUNS_PER_ROW).map(|g| (g, columns_of(g))).collect();
    let row_count: usize = groups.iter().map(|(_, columns)| columns.len()).sum();
    let width = CELL_WIDTH * runs.len().clamp(2, RUNS_PER_ROW) as f64 + 2.0 * EDGE;
    let height = HEADER_HEIGHT + CELL_HEIGHT * row_count as f64 + EDGE;
    let mut svg = Svg::new(width, height);
    draw_header(&mut svg, width, title, remark);
    let mut y = HEADER_HEIGHT;
    for (group, columns) in groups {
        for column in columns {
            for (i, run) in group.iter().enumerate() {
                let corner = (EDGE + CELL_WIDTH * i as f64, y);
                match run.channels.iter().find(|c| c.column == column) {
                    Some(channel) => draw_cell(&mut svg, corner, run, channel),
                    None => draw_absent(&mut svg, corner, run, column),
                }
            }
            y += CELL_HEIGHT;
        }
    }
    svg.finish()
}

/// The channels of several runs, each once, in the order in which they come.
fn columns_of(runs: &[ComparedRun]) -> Vec<&str> {
    let mut columns = Vec::new();
    for channel in runs.iter().flat_map(|run| &run.channels) {
        if !columns.contains(&channel.column.as_str()) {
            columns.push(&channel.column);
        }
    }
    columns
}

fn draw_header(svg: &mut Svg, width: f64, title: &str, remark: &str) {
    let room = width - 2.0 * (EDGE + 12.0);
    svg.text((EDGE + 12.0, 24.0), Anchor::Start, 15.0, &cut_to(title, 15.0, room));
    svg.text((EDGE + 12.0, 43.0), Anchor::Start, 11.0, &cut_to(remark, 11.0, room));
    let entries = [
        ("measured (broad, pale)", MEASURED, 1.0),
        ("simulated", VERMILION, 1.0),
        ("measured - simulated", GREY, 1.0),
        ("± 2 noise sd", BLUE, 0.25),
    ];
    draw_legend(svg, (EDGE + 12.0, 64.0), f64::INFINITY, &entries);
}

fn draw_cell(svg: &mut Svg, corner: (f64, f64), run: &ComparedRun, channel: &ComparedChannel) {
    let signal_area = Rect { x: corner.0, y: corner.1, width: CELL_WIDTH, height: SIGNAL_HEIGHT };
    let residual_area = Rect { y: signal_area.bottom(), height: RESIDUAL_HEIGHT, ..signal_area };
    signal_panel(run, channel).draw(svg, signal_area);
    residual_panel(run, channel).draw(svg, residual_area);
}

fn draw_absent(svg: &mut Svg, corner: (f64, f64), run: &ComparedRun, column: &str) {
    let middle = (corner.0 + CELL_WIDTH / 2.0, corner.1 + SIGNAL_HEIGHT / 2.0);
    svg.text(middle, Anchor::Middle, 11.0, &format!("{}: {column} was not recorded", run.name));
}

fn signal_panel(run: &ComparedRun, channel: &ComparedChannel) -> Panel {
    let name = parse_column(&channel.column).ok();
    Panel {
        title: [vec![format!("{}: {}", run.name, channel.column)], accuracy(channel)].concat(),
        y_label: name.map_or(channel.column.clone(), |n| n.axis_label()),
        behind: vec![line(&run.time_s, &channel.measured, MEASURED)],
        series: vec![line(&run.time_s, &channel.simulated, VERMILION)],
        ..Panel::default()
    }
}

/// `RMSE 0.0312 mm = 0.116 % of the range` and `= 1.56 x noise (sd 0.0200 mm)`.
fn accuracy(channel: &ComparedChannel) -> Vec<String> {
    let symbol = parse_column(&channel.column).map_or("", |name| name.unit.symbol);
    let values = channel.measured.iter().filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let mut text = format!("RMSE {}", with(&three_digits(channel.rmse), symbol));
    if high > low {
        text += &format!(" = {} % of the range", three_digits(100.0 * channel.rmse / (high - low)));
    }
    let noise = match channel.noise_sd {
        Some(sd) => {
            format!("= {} × noise (sd {})", three_digits(channel.rmse / sd), with(&three_digits(sd), symbol))
        }
        None => "noise unknown".to_owned(),
    };
    vec![text, noise]
}

fn residual_panel(run: &ComparedRun, channel: &ComparedChannel) -> Panel {
    let pairs = channel.measured.iter().zip(&channel.simulated);
    let residual: Vec<f64> = pairs.map(|(was, is)| was - is).collect();
    let symbol = parse_column(&channel.column).map_or("", |name| name.unit.symbol);
    let band = channel.noise_sd.map(|sd| Band { label: String::new(), colour: BLUE, low: -2.0 * sd, high: 2.0 * sd });
    Panel {
        x_label: "time (s)".to_owned(),
        y_label: format!("residual ({symbol})"),
        series: vec![line(&run.time_s, &residual, GREY)],
        bands: band.into_iter().collect(),
        ..Panel::default()
    }
}

/// A line over time, cut at gaps.
fn line(time_s: &[f64], values: &[f64], colour: &'static str) -> Series {
    let limit_s = gap_limit_s(time_s);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (time, value) in time_s.iter().zip(values) {
        if x.last().is_some_and(|last| time - last > limit_s) {
            x.push(*time);
            y.push(f64::NAN);
        }
        x.push(*time);
        y.push(*value);
    }
    Series { label: String::new(), colour, x, y }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(name: &str, columns: &[&str]) -> ComparedRun {
        let time_s: Vec<f64> = (0..50).map(|i| f64::from(i) * 0.1).collect();
        let channel = |column: &&str| ComparedChannel {
            column: (*column).to_owned(),
            measured: time_s.iter().map(|t| t.sin()).collect(),
            simulated: time_s.iter().map(|t| t.sin() + 0.03).collect(),
            noise_sd: Some(0.02),
            rmse: 0.03,
        };
        ComparedRun { name: name.to_owned(), channels: columns.iter().map(channel).collect(), time_s: time_s.clone() }
    }

    #[test]
    fn every_run_and_channel_has_its_two_panels() {
        let svg = compare_svg(
            "Rig",
            "",
            &[run("sine", &["elongation_mm", "pressure_kpa"]), run("steps", &["elongation_mm"])],
        );
        assert_eq!(svg.matches("<polyline").count(), 3 * 3);
        assert!(svg.contains(">sine: pressure_kpa<") && svg.contains(">steps: elongation_mm<"));
        assert!(svg.contains(">RMSE 0.0300 mm = 1.50 % of the range<"));
        assert!(svg.contains(">= 1.50 × noise (sd 0.0200 mm)<"));
        assert!(svg.contains(">elongation (mm)<") && svg.contains(">residual (kPa)<"));
        assert!(svg.contains(">time (s)<"));
    }

    #[test]
    fn a_channel_has_its_row_in_every_run() {
        let both = ["elongation_mm", "pressure_kpa"];
        let svg = compare_svg("Rig", "", &[run("sine", &both), run("steps", &both[1..]), run("hold", &both[..1])]);
        assert_eq!(svg.matches("<polyline").count(), 4 * 3);
        for absent in ["steps: elongation_mm was not recorded", "hold: pressure_kpa was not recorded"] {
            assert!(svg.contains(absent), "{absent}");
        }
        let height = HEADER_HEIGHT + 2.0 * CELL_HEIGHT + EDGE;
        assert!(svg.contains(&format!("height=\"{height}\"")));
    }

    #[test]
    fn fifth_run_wraps() {
        let runs: Vec<ComparedRun> = (0..5).map(|i| run(&format!("r{i}"), &["bend_deg"])).collect();
        let svg = compare_svg("Rig", "nothing fitted", &runs);
        let width = 4.0 * CELL_WIDTH + 2.0 * EDGE;
        let height = HEADER_HEIGHT + 2.0 * CELL_HEIGHT + EDGE;
        assert!(svg.contains(&format!("width=\"{width}\" height=\"{height}\"")));
    }

    #[test]
    fn lines_are_cut_at_gaps() {
        let series = line(&[0.0, 1.0, 2.0, 9.0], &[1.0; 4], BLUE);
        assert_eq!(series.x, [0.0, 1.0, 2.0, 9.0, 9.0]);
        assert!(series.y[3].is_nan());
    }

    #[test]
    fn nothing_to_compare_is_still_a_picture() {
        assert!(compare_svg("", "", &[]).ends_with("</svg>\n"));
    }
}
