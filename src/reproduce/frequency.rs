//! Frequency: the response to 3 Hz (Fig. 4a) and the loop from 0.2 to 1.5 Hz (Fig. 4e).

use rayon::prelude::*;

use crate::effects::EffectTable;
use crate::parallel;
use crate::recording::figures;
use crate::report::{BLUE, GREEN, ORANGE, PURPLE, Panel, Series, VERMILION};

use super::loops::Loop;
use super::rig::{Fast, Play, effect, sine, stock};
use super::search::size_for;
use super::{Chapter, ReproduceError, Row};

const STROKE_M: f64 = 3.0e-3;
const FREQUENCIES_HZ: [f64; 9] = [0.1, 0.2, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0];
const PAPER_DB: f64 = -0.4;
/// Key and value that take one cause of widening away.
const WITHOUT: [(&str, &str, f64); 2] = [
    ("axial damping", "muscles.damping_n_s_m", 0.0),
    // 1 m of 3 mm bore: a two-hundredth of the resistance.
    ("resistance of the line", "hydraulics.line.bore_m", 3.0e-3),
];

/// Five cycles of a sine, of at least 400 samples each.
fn play(figure: &'static str, frequency_hz: f64) -> Result<Play, ReproduceError> {
    let interval_s = (1.0 / (400.0 * frequency_hz)).min(0.01);
    Ok(stock("muscle_bench")
        .driven("plunger_mm", sine(figure, STROKE_M, frequency_hz)?)
        .with("simulation.output_interval_s", interval_s)
        .lasting(5.0 / frequency_hz))
}

/// Range of the last cycle over the stroke, in dB over that of another.
fn decibel(range_mm: f64, reference_mm: f64) -> f64 {
    20.0 * (range_mm / reference_mm).log10()
}

fn last_range(figure: &'static str, frequency_hz: f64) -> Result<f64, ReproduceError> {
    Ok(last_loop(&play(figure, frequency_hz)?, frequency_hz)?.range())
}

fn last_loop(play: &Play, frequency_hz: f64) -> Result<Loop, ReproduceError> {
    play.last_loop("plunger_mm", "elongation_mm", 1.0 / frequency_hz)
}

/// Gains of the reduced-order model at the least and the greatest frequency, with an effect.
struct Ends {
    slow: Fast,
    quick: Fast,
}

impl Ends {
    fn new(figure: &'static str) -> Result<Self, ReproduceError> {
        Ok(Self { slow: play(figure, 0.1)?.fast()?, quick: play(figure, 3.0)?.fast()? })
    }

    /// Gain at 3 Hz over that at 0.1 Hz, dB.
    fn drop_db(&self, effects: &[EffectTable]) -> Result<f64, ReproduceError> {
        let range = |fast: &Fast, hz: f64| -> Result<f64, ReproduceError> {
            let y = fast.channel("elongation_mm", &[], effects)?;
            let from = fast.times_s().partition_point(|t| *t < fast.times_s()[y.len() - 1] - 1.0 / hz - 1e-9);
            Ok(figures::range(&y[from..]))
        };
        Ok(decibel(range(&self.quick, 3.0)?, range(&self.slow, 0.1)?))
    }
}

/// An effect that could lower the gain at 3 Hz, by one number between two bounds.
struct Suspect {
    name: &'static str,
    number: &'static str,
    unit: &'static str,
    bracket: (f64, f64),
    colour: &'static str,
    make: fn(f64) -> EffectTable,
}

const SUSPECTS: [Suspect; 3] = [
    Suspect {
        name: "line_restriction",
        number: "r",
        unit: "1",
        bracket: (0.0, 20.0),
        colour: ORANGE,
        make: |r| effect("line_restriction", "line", &[("resistance_ratio", r)]),
    },
    Suspect {
        name: "viscoelasticity (0.05 s)",
        number: "E_1",
        unit: "N/m",
        bracket: (0.0, 200.0),
        colour: GREEN,
        make: |e| effect("viscoelasticity", "muscle", &[("stiffness_n_m", e), ("relaxation_time_s", 0.05)]),
    },
    Suspect {
        name: "sensor_lag",
        number: "time constant",
        unit: "s",
        bracket: (0.0, 0.1),
        colour: PURPLE,
        make: |tau| EffectTable {
            channel: Some("elongation_mm".to_owned()),
            ..effect("sensor_lag", "sensor", &[("time_constant_s", tau)])
        },
    },
];

/// Fig. 4a.
pub fn response() -> Result<Chapter, ReproduceError> {
    const FIGURE: &str = "4a";
    let ranges: Result<Vec<f64>, _> = parallel::map(&FREQUENCIES_HZ, |f| last_range(FIGURE, *f)).into_iter().collect();
    let ranges = ranges?;
    let gains: Vec<f64> = ranges.iter().map(|r| decibel(*r, ranges[0])).collect();
    let last = gains[gains.len() - 1];
    let mut rows = vec![Row::compared(
        "gain at 3 Hz over that at 0.1 Hz, stock rig",
        "dB",
        PAPER_DB,
        last,
        0.1,
        "the stock rig lacks what lowers it: the fluid's inertia alone raises the gain",
    )];
    let mut series = vec![line("stock rig", BLUE, &FREQUENCIES_HZ, &gains)];
    let ends = Ends::new(FIGURE)?;
    for suspect in &SUSPECTS {
        let (row, with) = suspected(suspect, &ends)?;
        rows.push(row);
        if let Some(with) = with {
            let ranges: Result<Vec<f64>, ReproduceError> = FREQUENCIES_HZ
                .into_par_iter()
                .map(|f| Ok(last_loop(&play(FIGURE, f)?.and(with.clone()), f)?.range()))
                .collect();
            let ranges = ranges?;
            let gains: Vec<f64> = ranges.iter().map(|r| decibel(*r, ranges[0])).collect();
            series.push(line(&format!("with {}", suspect.name), suspect.colour, &FREQUENCIES_HZ, &gains));
        }
    }
    let panel = Panel {
        title: vec!["Gain over that at 0.1 Hz, 3 mm of stroke".to_owned()],
        x_label: "frequency (Hz)".to_owned(),
        y_label: "gain (dB)".to_owned(),
        behind: vec![line("paper at 3 Hz: -0.4 dB", "#bdbdbd", &[0.1, 3.0], &[PAPER_DB; 2])],
        series,
        ..Panel::default()
    };
    let text = "Five cycles at each frequency, the last one measured. The paper prints -0.4 dB between 0 and 3 Hz and \
                lays it to noise and soft material; the sizes of the effects that would bring it are sought here, one \
                effect at a time.";
    Ok(Chapter { text: vec![text.to_owned()], panels: vec![panel], rows })
}

/// The size of an effect that brings the printed gain, as a row; and the effect.
fn suspected(s: &Suspect, ends: &Ends) -> Result<(Row, Option<EffectTable>), ReproduceError> {
    let size = size_for(PAPER_DB, s.bracket, |size| ends.drop_db(&[(s.make)(size)]))?;
    let Some(size) = size else {
        let most = ends.drop_db(&[(s.make)(s.bracket.1)])?;
        let remark = format!("an attempt: {} up to {} {} does not bring it", s.number, s.bracket.1, s.unit);
        return Ok((Row::about_other_data(format!("with {}", s.name), "dB", PAPER_DB, Some(most), remark), None));
    };
    let with = (s.make)(size);
    let remark = format!("{} = {size:.4} {}, sought for it; tolerance 0.02 dB", s.number, s.unit);
    let ours = ends.drop_db(std::slice::from_ref(&with))?;
    Ok((Row::compared(format!("with {}", s.name), "dB", PAPER_DB, ours, 0.02, remark).tuned(), Some(with)))
}

/// Fig. 4e.
pub fn loops() -> Result<Chapter, ReproduceError> {
    const FIGURE: &str = "4e";
    let frequencies = [0.2, 0.5, 1.0, 1.5];
    let colours = [BLUE, GREEN, ORANGE, VERMILION];
    let loops: Result<Vec<Loop>, _> =
        frequencies.into_par_iter().map(|f| last_loop(&play(FIGURE, f)?, f).map(|l| l.zeroed())).collect();
    let loops = loops?;
    let widths: Vec<f64> = loops.iter().map(|l| l.width().0).collect();
    let mut rows: Vec<Row> = frequencies
        .iter()
        .zip(&widths)
        .map(|(f, w)| Row::shown(format!("width of the loop at {f} Hz"), "mm", *w, "no number is printed: 'similar'"))
        .collect();
    let ratio = widths[3] / widths[0];
    rows.push(Row::judged(
        "width at 1.5 Hz over that at 0.2 Hz",
        "1",
        Some(1.0),
        ratio,
        (ratio - 1.0).abs() < 0.1,
        "paper: similar loops from 0.2 to 1.5 Hz; tolerance 10 %",
    ));
    for (name, key, value) in WITHOUT {
        let width = |f: f64| -> Result<f64, ReproduceError> {
            Ok(last_loop(&play(FIGURE, f)?.with(key, value), f)?.zeroed().width().0)
        };
        let ratio = width(1.5)? / width(0.2)?;
        rows.push(Row::shown(
            format!("the same without {name}"),
            "1",
            ratio,
            "what is left of the widening tells what brings it",
        ));
    }
    let panel = Panel {
        title: vec!["The loop at four frequencies, 3 mm of stroke".to_owned()],
        x_label: "plunger (mm)".to_owned(),
        y_label: "elongation (mm)".to_owned(),
        series: frequencies
            .iter()
            .zip(&loops)
            .zip(colours)
            .map(|((f, l), c)| line(&format!("{f} Hz"), c, &l.x, &l.y))
            .collect(),
        ..Panel::default()
    };
    let text = "The last of five cycles, counted from where the plunger is home.";
    Ok(Chapter { text: vec![text.to_owned()], panels: vec![panel], rows })
}

fn line(label: &str, colour: &'static str, x: &[f64], y: &[f64]) -> Series {
    Series { label: label.to_owned(), colour, x: x.to_vec(), y: y.to_vec() }
}
