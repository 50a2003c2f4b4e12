//! The paper's models on one loop (Fig. 5), and what they make of other programmes and speeds (Fig. 6, section V).

use rayon::prelude::*;

use crate::identify::loops::{Form, Identification, LoopRun, mean_square_on};
use crate::parallel;
use crate::report::{BLUE, GREEN, ORANGE, PURPLE, Panel, Series, VERMILION};
use crate::scene::Program;

use super::identified::{fitted, recorded};
use super::rig::{program, sine, stock};
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "5";
const STROKE_M: f64 = 3.0e-3;

/// A form, what the paper counts and prints of it, and its colour.
struct Rival {
    form: Form,
    parameters: Option<f64>,
    paper_mm2: Option<f64>,
    colour: &'static str,
}

const RIVALS: [Rival; 7] = [
    Rival { form: Form::Symmetric, parameters: Some(6.0), paper_mm2: None, colour: VERMILION },
    Rival { form: Form::Asymmetric, parameters: Some(10.0), paper_mm2: Some(0.0435), colour: ORANGE },
    Rival { form: Form::Paper, parameters: Some(7.0), paper_mm2: Some(0.0215), colour: BLUE },
    Rival { form: Form::PrandtlIshlinskii, parameters: None, paper_mm2: None, colour: GREEN },
    Rival { form: Form::MaxwellSlip, parameters: None, paper_mm2: None, colour: PURPLE },
    Rival { form: Form::MaxwellSlipGrowing, parameters: None, paper_mm2: None, colour: "#404040" },
    Rival { form: Form::DahlGrowing, parameters: None, paper_mm2: None, colour: "#a05a2c" },
];

/// Runs that no model has seen, and F of the paper's model there.
const UNSEEN: [(&str, f64); 4] =
    [("0.1 and 0.2 Hz", 0.1058), ("0.1 and 0.1·√3 Hz", 0.0769), ("0.15 Hz", 0.0234), ("0.2 Hz", 0.0389)];

fn unseen_programmes() -> Result<[Program; 4], ReproduceError> {
    let two = |kind: &str, second: &str| {
        program(FIGURE, &format!("kind = \"{kind}\"\nstroke_m = {STROKE_M:e}\nfrequency_hz = 0.1\n{second}"))
    };
    Ok([
        two("two_sines", "second_frequency_hz = 0.2")?,
        two("non_harmonic", "")?,
        sine(FIGURE, STROKE_M, 0.15)?,
        sine(FIGURE, STROKE_M, 0.2)?,
    ])
}

/// Forty seconds of the stock rig recorded with noise, the first ten not counted: there the first stroke differs.
///
/// The elongation counts from `home_mm`, where the muscle stands in steady motion with the plunger home: friction
/// leaves it there, and the paper's form can only pass through zero.
fn rig(name: &str, program: Program, seed: u64, home_mm: f64) -> Result<LoopRun, ReproduceError> {
    let run = stock("muscle_bench").driven("plunger_mm", program).lasting(40.0).run()?;
    let values = |column: &str| run.channel(column).map(|c| c.values.clone());
    let elongation: Vec<f64> = values("elongation_mm")?.iter().map(|e| e - home_mm).collect();
    let mut recorded = recorded(name, run.time_s(), &values("plunger_mm")?, &elongation, seed);
    recorded.output_mm.iter_mut().zip(run.time_s()).filter(|(_, t)| **t < 10.0).for_each(|(y, _)| *y = f64::NAN);
    Ok(recorded)
}

/// Where the muscle stands with the plunger home, third cycle at 0.1 Hz, mm.
fn home_mm() -> Result<f64, ReproduceError> {
    let run = stock("muscle_bench").driven("plunger_mm", sine(FIGURE, STROKE_M, 0.1)?).lasting(30.0).run()?;
    Ok(run.channel("elongation_mm")?.values.last().copied().unwrap_or(0.0))
}

/// Every form on the 0.1 Hz loop, then on the others.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let home_mm = home_mm()?;
    let seen = [rig("0.1 Hz", sine(FIGURE, STROKE_M, 0.1)?, 1, home_mm)?];
    let unseen: Result<Vec<LoopRun>, ReproduceError> = UNSEEN
        .into_par_iter()
        .zip(unseen_programmes()?)
        .enumerate()
        .map(|(i, ((name, _), program))| rig(name, program, 2 + i as u64, home_mm))
        .collect();
    let unseen = unseen?;
    let models: Result<Vec<Identification>, ReproduceError> =
        parallel::map(&RIVALS, |r| fitted(FIGURE, &seen, r.form)).into_iter().collect();
    let models = models?;
    let text = "The stock rig stands for the paper's muscle, its elongation recorded with 0.1 % noise and \
                counted from where the muscle stands with the plunger home. Every form is \
                identified on 0.1 Hz (hybrid search) and evaluated on runs it has not seen. F is the mean squared error \
                in mm². The paper's F are about its own recordings: only their order can be compared.";
    Ok(Chapter { text: vec![text.to_owned()], panels: panels(&seen[0], &models), rows: rows(&models, &unseen) })
}

fn rows(models: &[Identification], unseen: &[LoopRun]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (rival, model) in RIVALS.iter().zip(models) {
        let name = rival.form.name();
        if let Some(count) = rival.parameters {
            let ours = model.parameters.len() as f64;
            rows.push(Row::compared(
                format!("{name}: parameters"),
                "1",
                count,
                ours,
                0.0,
                "those of the law; a redundant scale is held when identified",
            ));
        }
        let row = match rival.paper_mm2 {
            Some(paper) => Row::about_other_data(
                format!("{name}: F at 0.1 Hz"),
                "mm²",
                paper,
                Some(model.mean_square_mm2),
                "on the stock rig's loop",
            ),
            None => Row::shown(format!("{name}: F at 0.1 Hz"), "mm²", model.mean_square_mm2, "on the stock rig's loop"),
        };
        rows.push(row);
    }
    for (i, (name, paper)) in UNSEEN.into_iter().enumerate() {
        let of = |m: &Identification| mean_square_on(&m.model, &unseen[i..=i]);
        rows.push(Row::about_other_data(
            format!("paper's form, unseen, {name}: F"),
            "mm²",
            paper,
            Some(of(&models[2])),
            "parameters of 0.1 Hz kept, as in the paper",
        ));
        let others: Vec<String> =
            RIVALS.iter().zip(models).map(|(r, m)| format!("{} {:.4}", r.form.name(), of(m))).collect();
        rows.push(ordered(
            format!("order on {name}: paper's <= asymmetric <= symmetric"),
            [of(&models[2]), of(&models[1]), of(&models[0])],
            others.join(", "),
        ));
    }
    let seen = [2, 1, 0].map(|i: usize| models[i].mean_square_mm2);
    rows.push(ordered(
        "order on 0.1 Hz: paper's <= asymmetric <= symmetric".to_owned(),
        seen,
        "F of the fit".to_owned(),
    ));
    rows
}

/// Whether three F rise, as the paper found them to.
fn ordered(name: String, rising: [f64; 3], remark: String) -> Row {
    let met = rising[0] <= rising[1] && rising[1] <= rising[2];
    Row::stated(name, met, remark)
}

fn panels(seen: &LoopRun, models: &[Identification]) -> Vec<Panel> {
    let from = seen.time_s.partition_point(|t| *t < 30.0);
    let line = |label: String, colour, y: &[f64]| Series {
        label,
        colour,
        x: seen.input_mm[from..].to_vec(),
        y: y[from..].to_vec(),
    };
    let follow = |m: &Identification| m.model.follow(&seen.time_s, &seen.input_mm);
    let name = |r: &Rival, m: &Identification| format!("{}, F = {:.4} mm²", r.form.name(), m.mean_square_mm2);
    let apart = |m: &Identification| follow(m).iter().zip(&seen.output_mm).map(|(a, b)| a - b).collect::<Vec<_>>();
    let pairs = || RIVALS.iter().zip(models);
    vec![
        Panel {
            title: vec!["Forms on one loop (last cycle)".to_owned()],
            x_label: "plunger (mm)".to_owned(),
            y_label: "elongation (mm)".to_owned(),
            behind: vec![line("stock rig".to_owned(), "#bdbdbd", &seen.output_mm)],
            series: pairs().map(|(r, m)| line(name(r, m), r.colour, &follow(m))).collect(),
            ..Panel::default()
        },
        Panel {
            title: vec!["What each form leaves".to_owned()],
            x_label: "plunger (mm)".to_owned(),
            y_label: "model - rig (mm)".to_owned(),
            series: pairs().map(|(r, m)| line(r.form.name().to_owned(), r.colour, &apart(m))).collect(),
            ..Panel::default()
        },
    ]
}
