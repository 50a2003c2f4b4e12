//! Feedforward compensation, which the paper announces: tracking without it, with it, and with feedback on top.

use crate::feedforward::{Inverse, Limits, Trim};
use crate::identify::loops::{Form, Identification, LoopRun};
use crate::parallel;
use crate::recording::figures::{self, Line};
use crate::report::{BLUE, GREY, Panel, Series, VERMILION};
use crate::scene::{Override, Program};
use crate::system::{Driver, InputSource, Schedule, Simulation, record_driven};

use super::identified::{fitted, recorded};
use super::loops::rms_apart;
use super::rig::{Play, program, stock};
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "feedforward";
const DURATION_S: f64 = 30.0;
const INTERVAL_S: f64 = 0.01;
const FORMS: [Form; 5] =
    [Form::Paper, Form::Asymmetric, Form::PrandtlIshlinskiiRate, Form::MaxwellSlip, Form::DahlGrowing];
/// From rest into the wanted motion, s.
const LEAD_IN_S: f64 = 3.0;
/// The training run: three sines, Hz, with their shares of the range; none of them is a motion's.
const TRAINING: [(f64, f64); 3] = [(0.13, 0.5), (0.053, 0.3), (0.21, 0.2)];
const TRAINING_S: f64 = 70.0;
const TRAINING_INTERVAL_S: f64 = 0.05;
/// Time constant of the trim, s.
const TRIM_S: f64 = 0.15;
/// Numbers of another muscle than the one identified: stiffer, with more friction.
const OTHER_MUSCLE: [(&str, f64); 2] =
    [("muscles.tube.material.c1_pa", 0.306e6), ("muscles.friction.m1_n_pa", 0.28e-6)];

/// A rig: what drives it, and what of it is wanted.
struct Rig {
    name: &'static str,
    scene: &'static str,
    /// Channels of plungers, each with its sign: 1 goes with the input.
    plungers: &'static [(&'static str, f64)],
    output: &'static str,
    /// mm of travel per unit of the output: 1 for an elongation, lever times radian for an angle.
    travel_mm: f64,
    /// Range of the input while training, mm.
    training_mm: [f64; 2],
    /// Least and greatest wanted output, in its unit. The least stays clear of where the rig itself cannot follow: what
    /// friction leaves of an elongation or a bend takes suction to go.
    wanted: [f64; 2],
    /// How many times the error must shrink.
    goal: f64,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

const RIGS: [Rig; 3] = [
    Rig {
        name: "muscle",
        scene: "muscle_bench",
        plungers: &[("plunger_mm", 1.0)],
        output: "elongation_mm",
        travel_mm: 1.0,
        training_mm: [0.0, 2.8],
        wanted: [3.0, 22.0],
        goal: 10.0,
    },
    Rig {
        name: "pulley",
        scene: "antagonistic_pulley",
        plungers: &[("plunger_1_mm", -1.0), ("plunger_2_mm", 1.0)],
        output: "angle_deg",
        travel_mm: 8.0 * DEGREE,
        training_mm: [-1.1, 1.1],
        wanted: [-50.0, 50.0],
        goal: 5.0,
    },
    Rig {
        name: "catheter",
        scene: "bending_catheter",
        plungers: &[("plunger_1_mm", -1.0)],
        output: "bend_deg",
        travel_mm: 2.62 * DEGREE,
        training_mm: [0.0, 1.35],
        wanted: [25.0, 115.0],
        goal: 5.0,
    },
];

/// Motions that are wanted, none of them used to identify: frequencies of equal parts, Hz.
const MOTIONS: [(&str, &[f64]); 3] = [
    ("periodic, 0.12 Hz", &[0.12]),
    ("two tones, 0.1 and 0.2 Hz", &[0.1, 0.2]),
    ("non-harmonic, 0.1 and 0.1·√3 Hz", &[0.1, 0.173_205_080_756_887_74]),
];

impl Rig {
    /// The wanted output, in its unit: from rest into the motion within [`LEAD_IN_S`].
    fn wanted(&self, frequencies_hz: &[f64]) -> Vec<f64> {
        let [low, high] = self.wanted;
        let part = |f: f64, t: f64| 0.5 * (1.0 - (std::f64::consts::TAU * f * t).cos());
        let share = (high - low) / frequencies_hz.len() as f64;
        let motion = |t: f64| low + frequencies_hz.iter().map(|f| share * part(*f, t)).sum::<f64>();
        let lead = |t: f64| 0.5 * (1.0 - (std::f64::consts::PI * (t / LEAD_IN_S).min(1.0)).cos());
        times().iter().map(|t| lead(*t) * motion(*t)).collect()
    }

    fn play(&self) -> Play {
        // The forceps' muscle stays where it is.
        let play = stock(self.scene);
        match self.scene {
            "bending_catheter" => play.driven("plunger_2_mm", Program::constant(0.0)),
            _ => play,
        }
    }

    /// The training input, mm: from home to the middle of its range, then strokes of changing size about it.
    fn training_input_mm(&self) -> (Vec<f64>, Vec<f64>) {
        let [low, high] = self.training_mm;
        let times = Schedule::even(TRAINING_S, TRAINING_INTERVAL_S).times();
        let wave = |f: f64, t: f64| (std::f64::consts::TAU * f * t).sin();
        let shape = |t: f64| TRAINING.iter().map(|(f, share)| share * wave(*f, t)).sum::<f64>();
        let lead = |t: f64| 0.5 * (1.0 - (std::f64::consts::PI * (t / LEAD_IN_S).min(1.0)).cos());
        let input = times.iter().map(|t| lead(*t) * (0.5 * (low + high) + 0.5 * (high - low) * shape(*t))).collect();
        (times, input)
    }

    /// The training run, the output as mm of travel.
    fn training(&self) -> Result<LoopRun, ReproduceError> {
        let (times, input) = self.training_input_mm();
        let mut play = self.play().with("simulation.output_interval_s", TRAINING_INTERVAL_S).lasting(TRAINING_S);
        for (channel, sign) in self.plungers {
            let values: Vec<f64> = input.iter().map(|x| x * sign * 1e-3).collect();
            let points = format!("kind = \"points\"\ntime_s = {times:?}\nvalue_m = {values:?}");
            play = play.driven(channel, program(FIGURE, &points)?);
        }
        let run = play.run()?;
        let (channel, sign) = self.plungers[0];
        let input: Vec<f64> = run.channel(channel)?.values.iter().map(|x| x * sign).collect();
        let travel: Vec<f64> = run.channel(self.output)?.values.iter().map(|y| y * self.travel_mm).collect();
        Ok(recorded(self.name, run.time_s(), &input, &travel, 7))
    }

    /// A run with a controller; the output in its unit.
    fn tracked(&self, other_muscle: bool, control: Control<'_>, wanted: &[f64]) -> Result<Vec<f64>, ReproduceError> {
        let mut play = self.play();
        if other_muscle {
            play.overrides.extend(OTHER_MUSCLE.map(|(key, value)| Override::number(key, value)));
        }
        let mut simulation = Simulation::new(play.scene()?)?;
        for (channel, program) in &play.inputs {
            simulation.set_input(channel, InputSource::Program(program.clone()));
        }
        let mut driver = Tracking { rig: self, control, wanted, at: 0 };
        let run = record_driven(&mut simulation, &Schedule::even(DURATION_S, INTERVAL_S), &mut driver)?;
        Ok(run.channel(self.output)?.values.clone())
    }
}

fn times() -> Vec<f64> {
    Schedule::even(DURATION_S, INTERVAL_S).times()
}

/// How the input is chosen.
struct Control<'a> {
    base: Base<'a>,
    trim: Option<Trim>,
}

enum Base<'a> {
    /// The line of best fit turned round: no knowledge of the hysteresis.
    Line {
        slope: f64,
        offset_mm: f64,
    },
    Inverse(Inverse<'a>),
}

/// A controller on a rig, walking along a wanted output.
struct Tracking<'a> {
    rig: &'a Rig,
    control: Control<'a>,
    wanted: &'a [f64],
    at: usize,
}

impl Driver for Tracking<'_> {
    fn start(&self) -> Vec<(String, f64)> {
        self.rig.plungers.iter().map(|(channel, _)| ((*channel).to_owned(), 0.0)).collect()
    }

    fn watched(&self) -> &str {
        self.rig.output
    }

    fn choose(&mut self, _next_s: f64, measured: f64) -> Vec<f64> {
        let travel = self.rig.travel_mm;
        let error = (self.wanted[self.at] - measured) * travel;
        self.at += 1;
        let wanted_mm = self.wanted[self.at] * travel;
        let base = match &mut self.control.base {
            Base::Line { slope, offset_mm } => (wanted_mm - *offset_mm) / *slope,
            Base::Inverse(inverse) => inverse.step(wanted_mm, INTERVAL_S),
        };
        let trim = self.control.trim.as_mut().map_or(0.0, |t| t.step(error, INTERVAL_S));
        let [low, high] = self.rig.training_mm;
        let input_mm = (base + trim).clamp(low - 0.2, high + 0.2);
        self.rig.plungers.iter().map(|(_, sign)| input_mm * sign * 1e-3).collect()
    }
}

/// What a rig taught: a line and a model.
struct Taught {
    slope: f64,
    offset_mm: f64,
    model: Identification,
    limits: Limits,
}

impl Taught {
    fn from(rig: &Rig) -> Result<Self, ReproduceError> {
        let run = rig.training()?;
        let models: Result<Vec<Identification>, ReproduceError> =
            parallel::map(&FORMS, |form| fitted(FIGURE, std::slice::from_ref(&run), *form)).into_iter().collect();
        let best = models?.into_iter().min_by(|a, b| a.mean_square_mm2.total_cmp(&b.mean_square_mm2));
        let Line { slope, offset: offset_mm, .. } = figures::line_of_best_fit(&run.input_mm, &run.output_mm);
        let [low, high] = rig.training_mm;
        let limits =
            Limits { input_mm: [low, high + 0.1 * (high - low)], speed_mm_s: 4.0 * (high - low), least_slope: 0.15 };
        let model = best.ok_or_else(|| super::error::lacking(FIGURE, "no form could be identified"))?;
        Ok(Self { slope, offset_mm, model, limits })
    }

    fn line(&self) -> Control<'_> {
        Control { base: Base::Line { slope: self.slope, offset_mm: self.offset_mm }, trim: None }
    }

    fn feedforward(&self) -> Control<'_> {
        Control { base: Base::Inverse(Inverse::new(&self.model.model, self.limits, 0.0)), trim: None }
    }

    fn with_feedback(&self) -> Control<'_> {
        let most_mm = 0.5 * (self.limits.input_mm[1] - self.limits.input_mm[0]);
        Control { trim: Some(Trim::new(self.slope, TRIM_S, most_mm)), ..self.feedforward() }
    }
}

/// Three rigs, three motions each.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let made: Result<Vec<(Vec<Row>, Panel)>, ReproduceError> = parallel::map(&RIGS, of_rig).into_iter().collect();
    let (rows, panels): (Vec<Vec<Row>>, Vec<Panel>) = made?.into_iter().unzip();
    let text = "A model is identified from a training run of three sines, none of them wanted later, and inverted along the \
                wanted motion, which keeps clear of the closed coil and of the straight tube: what friction leaves there \
                takes suction to go. Without: the line of best fit turned round. The error is the root mean square over 30 s. \
                Feedback adds an integral trim; it is also tried on a muscle that is not the one identified (C1 a fifth \
                stiffer, a quarter more pressure-borne friction), where feedforward alone must fall short.";
    Ok(Chapter { text: vec![text.to_owned()], panels, rows: rows.concat() })
}

fn of_rig(rig: &Rig) -> Result<(Vec<Row>, Panel), ReproduceError> {
    let taught = Taught::from(rig)?;
    let unit = if rig.output.ends_with("_deg") { "deg" } else { "mm" };
    let mut rows = Vec::new();
    let mut panel = None;
    for (name, frequencies) in MOTIONS {
        let wanted = rig.wanted(frequencies);
        let run = |other, control| rig.tracked(other, control, &wanted);
        let without = run(false, taught.line())?;
        let with = run(false, taught.feedforward())?;
        let error = |run: &[f64]| rms_apart(run, &wanted);
        let ratio = error(&without) / error(&with);
        let remark = format!(
            "{:.3} to {:.3} {unit} RMS by the form {}; goal: {} times",
            error(&without),
            error(&with),
            taught.model.form.name(),
            rig.goal
        );
        rows.push(Row::judged(
            format!("{}, {name}: feedforward shrinks the error", rig.name),
            "x",
            None,
            ratio,
            ratio >= rig.goal,
            remark,
        ));
        let trimmed = error(&run(false, taught.with_feedback())?);
        let remark = format!("integral trim, 0.15 s; {:.0} times less than without", error(&without) / trimmed);
        rows.push(Row::shown(format!("{}, {name}: error with feedback on top", rig.name), unit, trimmed, remark));
        let (alone, both) = (error(&run(true, taught.feedforward())?), error(&run(true, taught.with_feedback())?));
        rows.push(Row::shown(
            format!("{}, {name}: another muscle, with feedback", rig.name),
            unit,
            both,
            format!("{alone:.3} {unit} by feedforward alone"),
        ));
        panel.get_or_insert_with(|| errors(rig, name, unit, &wanted, &without, &with));
    }
    Ok((rows, panel.unwrap_or_default()))
}

fn errors(rig: &Rig, motion: &str, unit: &str, wanted: &[f64], without: &[f64], with: &[f64]) -> Panel {
    let line = |label: &str, colour, run: &[f64]| Series {
        label: label.to_owned(),
        colour,
        x: times(),
        y: run.iter().zip(wanted).map(|(a, b)| a - b).collect(),
    };
    Panel {
        title: vec![format!("{}: error on the wanted motion, {motion}", rig.name)],
        x_label: "time (s)".to_owned(),
        y_label: format!("is - wanted ({unit})"),
        behind: vec![Series { label: String::new(), colour: GREY, x: vec![0.0, DURATION_S], y: vec![0.0, 0.0] }],
        series: vec![line("line turned round", VERMILION, without), line("feedforward", BLUE, with)],
        ..Panel::default()
    }
}
