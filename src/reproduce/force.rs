//! Force of a muscle held at a length: its greatest (Fig. 4b), and over the plunger (Figs. 4g and 7).

use rayon::prelude::*;

use crate::identify::loops::Form;
use crate::recording::Recording;
use crate::recording::figures::{self, Line};
use crate::report::{BLUE, GREEN, ORANGE, Panel, Series};

use super::error::lacking;
use super::identified::{fitted, recorded};
use super::loops::Loop;
use super::rig::{Play, program, sine, stock};
use super::{Chapter, ReproduceError, Row};

/// Elongations at which the greatest force is taken, mm; the last is 350 %.
const HELD_MM: [f64; 8] = [10.0, 20.0, 35.0, 50.0, 70.0, 90.0, 110.0, 125.0];
/// Withdrawn plunger over the elongation: more than the compliances hold.
const WITHDRAWN_PER_MM: f64 = 0.12;

/// A muscle locked at an elongation, pressurised until it pulls with `load_n` alone.
fn locked(elongation_mm: f64, load_n: f64) -> Play {
    stock("muscle_blocked")
        .with("muscles.pre_elongation_ratio", elongation_mm / 50.0)
        .with("mechanism.joint.0.locked_m", elongation_mm * 1e-3)
        .with("muscles.initial_load_n", load_n)
}

/// Fig. 4b: pull where the pressure passes zero, over the elongation.
pub fn greatest() -> Result<Chapter, ReproduceError> {
    const FIGURE: &str = "4b";
    let forces: Result<Vec<f64>, ReproduceError> = HELD_MM
        .into_par_iter()
        .map(|held| {
            let to_m = -(WITHDRAWN_PER_MM * held) * 1e-3;
            let ramp = program(FIGURE, &format!("kind = \"ramp_hold\"\nto_m = {to_m:e}\nrise_s = 20.0"))?;
            let run = locked(held, 0.0).driven("plunger_mm", ramp).lasting(20.0).run()?;
            pull_at_no_pressure(&run)
                .ok_or_else(|| lacking(FIGURE, format!("the pressure stays above zero at {held} mm")))
        })
        .collect();
    let forces = forces?;
    let Line { slope, offset, r_squared } = figures::line_of_best_fit(&HELD_MM, &forces);
    let fitted: Vec<f64> = HELD_MM.iter().map(|e| offset + slope * e).collect();
    let line =
        |label: &str, colour, y: &[f64]| Series { label: label.to_owned(), colour, x: HELD_MM.to_vec(), y: y.to_vec() };
    let panel = Panel {
        title: vec!["Greatest force: held at a length, fluid withdrawn until no pressure is left".to_owned()],
        x_label: "elongation (mm)".to_owned(),
        y_label: "force (N)".to_owned(),
        behind: vec![line(&format!("line of best fit, R² = {r_squared:.4}"), "#bdbdbd", &fitted)],
        series: vec![line("first principles", BLUE, &forces)],
        ..Panel::default()
    };
    let rows = vec![
        Row::judged(
            "R² of force over elongation",
            "1",
            Some(0.9962),
            r_squared,
            r_squared >= 0.995,
            "goal: at least 0.995; C1 and C2 were inferred from the paper's two numbers here",
        )
        .tuned(),
        Row::compared(
            "force at 175 mm (350 %)",
            "N",
            6.06,
            forces[forces.len() - 1],
            0.06,
            "C1 and C2 were inferred from it; wall free to leave its coil, held it would be 6.31 N",
        )
        .tuned(),
        Row::shown(
            "slope of the line",
            "N/mm",
            slope,
            format!("offset {offset:.3} N; the figure prints an equation that the text layer lost"),
        ),
    ];
    Ok(Chapter { text: vec![], panels: vec![panel], rows })
}

/// Straight between the samples around the instant at which the pressure passes zero.
fn pull_at_no_pressure(run: &Recording) -> Option<f64> {
    let (p, f) = (&run.find("pressure_kpa")?.values, &run.find("force_n")?.values);
    let i = p.windows(2).position(|w| w[0] > 0.0 && w[1] <= 0.0)?;
    Some(f[i] + (f[i + 1] - f[i]) * p[i] / (p[i] - p[i + 1]))
}

/// Figs. 4g and 7: the plunger withdrawn and let back at three lengths.
pub fn held() -> Result<Chapter, ReproduceError> {
    const FIGURE: &str = "4g";
    let mut chapter = Chapter::default();
    let mut series = Vec::new();
    for (length_mm, colour) in [(65.0, BLUE), (75.0, ORANGE), (85.0, GREEN)] {
        let play = locked(length_mm - 50.0, 0.05);
        let stroke_m = emptying_stroke_m(&play)?;
        let run = play.clone().driven("plunger_mm", sine(FIGURE, -stroke_m, 0.1)?).lasting(30.0).run()?;
        let withdrawn: Vec<f64> = run.channel("plunger_mm")?.values.iter().map(|x| -x).collect();
        let force = run.channel("force_n")?.values.clone();
        let cycle = Loop::last(run.time_s(), &withdrawn, &force, 10.0);
        let (width, greatest) = (cycle.width().0.abs(), figures::greatest(&force));
        chapter.rows.push(Row::given(
            format!("length {length_mm} mm: tension at the start"),
            "N",
            0.05,
            "the pressure is set for it",
        ));
        chapter.rows.push(Row::judged(
            format!("length {length_mm} mm: width of the loop over the greatest force"),
            "%",
            None,
            100.0 * width / greatest,
            width < 0.05 * greatest,
            format!("paper: little hysteresis; greatest force {greatest:.2} N at {:.2} mm withdrawn; held still, the muscle's friction does not move", stroke_m * 1e3),
        ));
        series.push(Series { label: format!("{length_mm} mm"), colour, x: cycle.x, y: cycle.y });
    }
    let (modelled, row) = fig_7(&series[1])?;
    chapter.rows.push(row);
    let forces = Panel {
        title: vec!["Force of a muscle held at 65, 75 and 85 mm; plunger positive where fluid is withdrawn".to_owned()],
        x_label: "plunger withdrawn (mm)".to_owned(),
        y_label: "force (N)".to_owned(),
        series,
        ..Panel::default()
    };
    chapter.panels = vec![forces, modelled];
    Ok(chapter)
}

/// Fig. 7: the paper's form, identified on the loop at 75 mm; force stands in the place of elongation.
fn fig_7(cycle: &Series) -> Result<(Panel, Row), ReproduceError> {
    const FIGURE: &str = "4g";
    let time_s: Vec<f64> = (0..cycle.x.len()).map(|i| i as f64 * 0.01).collect();
    let run = recorded("75 mm", &time_s, &cycle.x, &cycle.y, 11);
    let model = fitted(FIGURE, std::slice::from_ref(&run), Form::Paper)?;
    let line = |label: &str, colour, y: Vec<f64>| Series { label: label.to_owned(), colour, x: cycle.x.clone(), y };
    let panel = Panel {
        title: vec!["The paper's form on the force at 75 mm".to_owned()],
        x_label: "plunger withdrawn (mm)".to_owned(),
        y_label: "force (N)".to_owned(),
        behind: vec![line("stock rig", "#bdbdbd", run.output_mm.clone())],
        series: vec![line("paper's form", BLUE, model.model.follow(&time_s, &cycle.x))],
        ..Panel::default()
    };
    let rms_n = model.mean_square_mm2.sqrt();
    let met = rms_n < 0.02 * figures::greatest(&cycle.y);
    let remark = "RMS; paper: fitted well, no number printed; met below 2 % of the greatest force";
    Ok((panel, Row::judged("paper's form on the force at 75 mm", "N", None, rms_n, met, remark)))
}

/// The stroke that leaves a tenth of the pressure, m: what the compliances give up.
fn emptying_stroke_m(play: &Play) -> Result<f64, ReproduceError> {
    let scene = play.scene()?;
    let run = play.clone().driven("plunger_mm", crate::scene::Program::constant(0.0)).lasting(0.01).run()?;
    let pressure_pa = run.channel("pressure_kpa")?.values[0] * 1e3;
    let h = scene.file.hydraulics.ok_or_else(|| lacking("4g", "the scene has no [hydraulics]"))?;
    let compliance = h.upstream_compliance_m3_pa + h.downstream_compliance_m3_pa;
    Ok(0.9 * compliance * pressure_pa / h.syringe.area_m2())
}
