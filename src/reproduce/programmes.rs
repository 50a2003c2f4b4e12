//! Three programmes of the plunger (Fig. 3), and the printed velocities (section V).

use crate::recording::figures;
use crate::report::{BLUE, Panel, Series};
use crate::scene::Program;

use super::loops::{Loop, mean_speed, rms_apart};
use super::printed::printed_model;
use super::rig::{program, sine, stock};
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "3";
const STROKE_M: f64 = 3.0e-3;

/// A programme's run: time, plunger and elongation, and what the printed model makes of the plunger.
struct Played {
    name: &'static str,
    time_s: Vec<f64>,
    plunger_mm: Vec<f64>,
    elongation_mm: Vec<f64>,
    printed_mm: Vec<f64>,
}

/// Figs. 3a to 3c, and the three velocities.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let two = |kind: &str| {
        let second = if kind == "two_sines" { "second_frequency_hz = 0.2" } else { "" };
        program(FIGURE, &format!("kind = \"{kind}\"\nstroke_m = {STROKE_M:e}\nfrequency_hz = 0.1\n{second}"))
    };
    let played = [
        play("3a: sine of 0.1 Hz", sine(FIGURE, STROKE_M, 0.1)?)?,
        play("3b: sines of 0.1 and 0.2 Hz", two("two_sines")?)?,
        play("3c: sines of 0.1 and 0.1·√3 Hz", two("non_harmonic")?)?,
    ];
    let rows = played.iter().flat_map(rows_of).chain(velocities()?);
    let text = "Thirty seconds each, 3 mm of stroke. The printed model with its printed parameters stands behind as a \
                broad grey line; both are counted from the start. Loops are those of the whole run.";
    Ok(Chapter { text: vec![text.to_owned()], rows: rows.collect(), panels: played.iter().flat_map(panels).collect() })
}

fn play(name: &'static str, program: Program) -> Result<Played, ReproduceError> {
    let run = stock("muscle_bench").driven("plunger_mm", program).lasting(30.0).run()?;
    let plunger_mm = run.channel("plunger_mm")?.values.clone();
    Ok(Played {
        name,
        time_s: run.time_s().to_vec(),
        elongation_mm: run.channel("elongation_mm")?.values.clone(),
        printed_mm: printed_model(&plunger_mm),
        plunger_mm,
    })
}

fn rows_of(p: &Played) -> Vec<Row> {
    let settled = p.time_s.partition_point(|t| *t < 10.0);
    let whole = |y: &[f64]| Loop { x: p.plunger_mm[settled..].to_vec(), y: y[settled..].to_vec() }.zeroed();
    let (ours, printed) = (whole(&p.elongation_mm), whole(&p.printed_mm));
    vec![
        Row::compared(
            format!("{}: range (printed model)", p.name),
            "mm",
            printed.range(),
            ours.range(),
            1.0,
            "from 10 s on; tolerance 1 mm",
        ),
        Row::shown(
            format!("{}: distance from the printed model", p.name),
            "mm",
            rms_apart(&ours.y, &printed.y),
            "RMS, nothing fitted",
        ),
    ]
}

/// Mean speeds of the output at three frequencies: of the printed model, which settles how eq. (3) reads, and ours.
fn velocities() -> Result<Vec<Row>, ReproduceError> {
    let mut rows = Vec::new();
    for (frequency, paper) in [(0.1, 5.34), (0.15, 8.07), (0.2, 10.75)] {
        let p = play("velocity", sine(FIGURE, STROKE_M, frequency)?)?;
        let from = p.time_s.partition_point(|t| *t < 30.0 - 2.0 / frequency - 1e-9);
        let speed = |y: &[f64]| mean_speed(&p.time_s[from..], &y[from..]);
        rows.push(Row::compared(
            format!("mean speed at {frequency} Hz, printed model"),
            "mm/s",
            paper,
            speed(&p.printed_mm),
            0.05,
            "evidence for the exponent 2 in eq. (3): 4 gives 4.54 mm/s at 0.1 Hz",
        ));
        rows.push(Row::compared(
            format!("mean speed at {frequency} Hz, first principles"),
            "mm/s",
            paper,
            speed(&p.elongation_mm),
            0.05 * paper,
            "tolerance 5 %",
        ));
    }
    Ok(rows)
}

fn panels(p: &Played) -> Vec<Panel> {
    let line = |label: &str, colour, x: &[f64], y: &[f64]| {
        let zero = y[0];
        Series { label: label.to_owned(), colour, x: x.to_vec(), y: y.iter().map(|y| y - zero).collect() }
    };
    let range = figures::range(&p.elongation_mm);
    let panel = |title: String, x_label: &str, x: &[f64]| Panel {
        title: vec![title],
        x_label: x_label.to_owned(),
        y_label: "elongation (mm)".to_owned(),
        behind: vec![line("printed model", "#bdbdbd", x, &p.printed_mm)],
        series: vec![line("first principles", BLUE, x, &p.elongation_mm)],
        ..Panel::default()
    };
    vec![
        panel(format!("{}: elongation, {range:.1} mm", p.name), "time (s)", &p.time_s),
        panel(format!("{}: loop", p.name), "plunger (mm)", &p.plunger_mm),
    ]
}
