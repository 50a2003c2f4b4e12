//! First principles against the paper's printed model, over the 3 mm loop.

use rayon::prelude::*;

use crate::hysteresis::{DisplacementModel, PaperModel};
use crate::identify::Bounds;
use crate::parallel;
use crate::report::{BLUE, GREEN, GREY, ORANGE, Panel, Series, VERMILION};

use super::calibration::{Bench, Candidate, Knob, Lever};
use super::rig::effect;
use super::{Chapter, ReproduceError, Row};

const PERIOD_S: f64 = 10.0;
/// The paper's own distance from its data, mm: the root of F = 0.0215 mm².
const PAPERS_OWN_MM: f64 = 0.15;

/// A number of the scene, within 40 % to either side.
const fn calibrated(name: &'static str, key: &'static str, stock: f64) -> Knob {
    Knob { name, lever: Lever::Number(key), start: stock, range: Bounds { min: 0.6 * stock, max: 1.4 * stock } }
}

/// A number from nothing up to `max`.
const fn further(name: &'static str, lever: Lever, start: f64, max: f64) -> Knob {
    Knob { name, lever, start, range: Bounds { min: 0.0, max } }
}

const CALIBRATED: [Knob; 5] = [
    calibrated("C1 (Pa)", "muscles.tube.material.c1_pa", 0.255e6),
    calibrated("C_s (m³/Pa)", "hydraulics.upstream_compliance_m3_pa", 8.0e-15),
    calibrated("m0 (N)", "muscles.friction.m0_n", 0.106),
    calibrated("m1 (N/Pa)", "muscles.friction.m1_n_pa", 0.222e-6),
    calibrated("x_pre (m)", "muscles.friction.presliding_length_m", 5.2e-3),
];

/// Physics that the stock rig lacks, each by one number.
const FURTHER: [Knob; 7] = [
    further("bore that grows, b (1/m)", Lever::Number("muscles.tube.area_growth_1_m"), 0.5, 10.0),
    further(
        "trapped_air (m³)",
        Lever::Effect(|v| effect("trapped_air", "line", &[("free_volume_m3", v)])),
        1e-10,
        2e-8,
    ),
    further("coil_preload (N)", Lever::Effect(|f| effect("coil_preload", "muscle", &[("preload_n", f)])), 0.02, 1.0),
    further(
        "plunger_backlash (m)",
        Lever::Effect(|b| effect("plunger_backlash", "syringe", &[("width_m", b)])),
        2e-5,
        3e-4,
    ),
    further(
        "viscoelasticity, 3 s (N/m)",
        Lever::Effect(|e| effect("viscoelasticity", "muscle", &[("stiffness_n_m", e), ("relaxation_time_s", 3.0)])),
        2.0,
        60.0,
    ),
    further(
        "mullins_softening (1)",
        Lever::Effect(|d| effect("mullins_softening", "muscle", &[("softening_ratio", d)])),
        0.05,
        0.9,
    ),
    further("leak (m³/(s Pa))", Lever::Effect(|g| effect("leak", "line", &[("conductance_m3_s_pa", g)])), 1e-17, 5e-15),
];

/// The output of the printed model along a plunger's path from rest, mm.
pub fn printed_model(plunger_mm: &[f64]) -> Vec<f64> {
    DisplacementModel::Paper(PaperModel::printed()).follow(0.0, plunger_mm).0
}

/// The stock rig, the rig calibrated, and the rig with one or two pieces of further physics.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let bench = Bench::new(PERIOD_S, printed_model)?;
    let as_delivered = bench.set(Vec::new())?;
    let calibrated = bench.calibrated(&CALIBRATED)?;
    let from: Vec<Knob> = calibrated.settings.iter().map(|(k, x)| Knob { start: *x, ..*k }).collect();
    let with = |further: &[Knob]| bench.calibrated(&[from.clone(), further.to_vec()].concat());
    let single: Result<Vec<Candidate>, ReproduceError> = parallel::map(&FURTHER, |f| with(&[*f])).into_iter().collect();
    let single = single?;
    // From where the growing bore alone ended, so that a pair is never worse than that.
    let grown: Vec<Knob> = single[0].settings.iter().map(|(k, x)| Knob { start: *x, ..*k }).collect();
    let double: Result<Vec<Candidate>, ReproduceError> = FURTHER[1..]
        .par_iter()
        .map(|f| bench.calibrated(&[grown.clone(), vec![Knob { start: 0.0, ..*f }]].concat()))
        .collect();
    let found = Found { bench, as_delivered, calibrated, single, double: double? };
    Ok(Chapter { text: found.text(), panels: found.panels(), rows: found.rows() })
}

struct Found {
    bench: Bench,
    as_delivered: Candidate,
    calibrated: Candidate,
    /// With one of [`FURTHER`], in its order.
    single: Vec<Candidate>,
    /// With a bore that grows and each of the others.
    double: Vec<Candidate>,
}

/// What was added to the calibrated numbers, by name.
fn added(c: &Candidate) -> String {
    let beyond = c.settings.iter().skip(CALIBRATED.len());
    beyond.map(|(k, x)| format!("{} = {x:.3e}", k.name)).collect::<Vec<_>>().join(", ")
}

impl Found {
    /// Every attempt; a second piece of physics that the fit left at nothing is none of its own.
    fn attempts(&self) -> impl Iterator<Item = &Candidate> {
        let is_used = |c: &&Candidate| c.settings.last().is_some_and(|(_, size)| *size != 0.0);
        self.single.iter().chain(self.double.iter().filter(is_used))
    }

    fn best(&self) -> &Candidate {
        self.attempts().min_by(|a, b| a.rms_mm.total_cmp(&b.rms_mm)).unwrap_or(&self.calibrated)
    }

    fn text(&self) -> Vec<String> {
        let numbers = |c: &Candidate| {
            c.settings.iter().map(|(k, x)| format!("{} = {x:.3e}", k.name)).collect::<Vec<_>>().join(", ")
        };
        vec![
            "Plunger 0 to 3 mm and back at 0.1 Hz, third cycle, both counted from where the plunger is home. The \
             printed model stands for the paper's recording, to which it had 0.15 mm (root of F = 0.0215 mm²)."
                .to_owned(),
            format!("Calibrated: {}.", numbers(&self.calibrated)),
            format!("Closest: {}.", numbers(self.best())),
            "What the evidence is worth: the loop of one plunger and one elongation cannot tell apart what bends it the \
             same way, and the printed model is itself a fit. A recorded pressure would: a growing bore shows in volume \
             over length at constant pressure, friction in the pressure's own loop."
                .to_owned(),
        ]
    }

    fn panels(&self) -> Vec<Panel> {
        let line = |label: &str, colour, x: &[f64], y: &[f64]| Series {
            label: label.to_owned(),
            colour,
            x: x.to_vec(),
            y: y.to_vec(),
        };
        let target = &self.bench.target;
        let best = added(self.best());
        let shown = [
            ("stock rig", BLUE, &self.as_delivered),
            ("calibrated", GREEN, &self.calibrated),
            ("bore grows", ORANGE, &self.single[0]),
            ("closest", VERMILION, self.best()),
        ];
        let apart = |c: &Candidate| c.cycle.y.iter().zip(&target.y).map(|(a, b)| a - b).collect::<Vec<_>>();
        vec![
            Panel {
                title: vec!["One loop: first principles and the printed model".to_owned()],
                x_label: "plunger (mm)".to_owned(),
                y_label: "elongation (mm)".to_owned(),
                behind: vec![line("printed model", "#bdbdbd", &target.x, &target.y)],
                series: shown.iter().map(|(n, colour, c)| line(n, colour, &c.cycle.x, &c.cycle.y)).collect(),
                ..Panel::default()
            },
            Panel {
                title: vec!["What is left".to_owned(), format!("closest: {best}")],
                x_label: "plunger (mm)".to_owned(),
                y_label: "ours - printed (mm)".to_owned(),
                behind: vec![line("", GREY, &[0.0, 3.0], &[0.0, 0.0])],
                series: shown.iter().map(|(n, colour, c)| line(n, colour, &c.cycle.x, &apart(c))).collect(),
                ..Panel::default()
            },
        ]
    }

    fn rows(&self) -> Vec<Row> {
        let target = &self.bench.target;
        let stock = &self.as_delivered.cycle;
        let ((width, at), (our_width, our_at)) = (target.width(), stock.width());
        let model = "(printed model)";
        let mut rows = given();
        rows.extend([
            Row::compared(
                format!("elongation range of the 3 mm loop {model}"),
                "mm",
                target.range(),
                stock.range(),
                1.0,
                "stock rig, nothing fitted; tolerance 1 mm",
            ),
            Row::compared(
                format!("greatest width of the loop {model}"),
                "mm",
                width,
                our_width,
                0.5,
                format!(
                    "compliances and friction were inferred from it; at {our_at:.2} mm, the printed model's at {at:.2} mm; \
                     tolerance 0.5 mm"
                ),
            )
            .tuned(),
            Row::compared(
                format!("area of the loop {model}"),
                "mm²",
                target.area(),
                stock.area(),
                0.15 * target.area(),
                "follows from the width; tolerance 15 %",
            )
            .tuned(),
            close("stock rig".to_owned(), &self.as_delivered, 0.45),
            close("C1, C_s, m0, m1, x_pre calibrated".to_owned(), &self.calibrated, 0.25).tuned(),
        ]);
        rows.extend(self.attempts().map(|c| {
            Row::shown(format!("calibrated, {}", added(c)), "mm", c.rms_mm, "RMS from the printed model, one attempt")
        }));
        rows.push(close(format!("closest: {}", added(self.best())), self.best(), PAPERS_OWN_MM).tuned());
        rows
    }
}

/// The printed parameters, taken over by the scene `muscle_printed_model`.
fn given() -> Vec<Row> {
    let printed = DisplacementModel::Paper(PaperModel::<f64>::printed());
    let pairs = printed.parameter_names().iter().zip(printed.parameters());
    let remark = "scene muscle_printed_model; how eq. (3) is read: docs/physics.md";
    pairs.map(|(name, value)| Row::given(format!("printed parameter {name}"), "1", value, remark)).collect()
}

fn close(name: String, c: &Candidate, bound_mm: f64) -> Row {
    // A wall that all but vanishes fits well and is no silicone: the number must not stand alone.
    let wall = c.settings.iter().find(|(k, _)| k.name == CALIBRATED[0].name);
    let wall = wall.map_or_else(String::new, |(_, c1)| {
        format!("; C1 there is {:.2} of the stock value", c1 / CALIBRATED[0].start)
    });
    let remark = format!("RMS from the printed model; goal: at most {bound_mm} mm{wall}");
    Row::judged(name, "mm", None, c.rms_mm, c.rms_mm <= bound_mm, remark)
}
