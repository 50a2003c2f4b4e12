//! Sizes and elongation: what the paper prints about the muscle itself (section II, Figs. 1b and 2).

use crate::muscle::{SAFE_STRETCH, YIELD_STRETCH};
use crate::recording::Recording;
use crate::recording::figures;
use crate::report::{BLUE, Panel, Series, VERMILION};

use super::rig::{Play, effect, program, stock};
use super::search::size_for;
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "1";
const REST_MM: f64 = 50.0;
const STEEL_KG_M3: f64 = 7.9e3;
const SILICONE_KG_M3: f64 = 1.1e3;
/// Rise, hold and fall of the plunger, s.
const TIMES_S: (f64, f64, f64) = (20.0, 2.0, 20.0);

/// Elongation to 245 % and back, past 350 %, and the numbers of section II.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let safe = stretched_to(SAFE_STRETCH)?;
    let beyond = stretched_to(YIELD_STRETCH + 0.2)?;
    let rows = [given()?, derived(), stretches(&safe, &beyond)?].concat();
    let panel = Panel {
        title: vec!["To 245 % and back, and past 350 % with a coil that yields".to_owned()],
        x_label: "time (s)".to_owned(),
        y_label: "length over rest length (%)".to_owned(),
        series: vec![
            length_percent("to 245 %", BLUE, &safe)?,
            length_percent("to 370 %, yielding from 350 % on", VERMILION, &beyond)?,
        ],
        ..Panel::default()
    };
    let text = "A free muscle is stretched by its plunger in 20 s, held for 2 s and let back in 20 s. Past 350 % the \
                coil yields: the effect plastic_set with its threshold at 125 mm.";
    Ok(Chapter { text: vec![text.to_owned()], panels: vec![panel], rows })
}

fn given() -> Result<Vec<Row>, ReproduceError> {
    let file = stock("muscle_bench").scene()?.file;
    let missing = || super::error::lacking(FIGURE, "the scene muscle_bench has no tube, hydraulics or load");
    let muscles = file.muscles.as_ref().ok_or_else(missing)?;
    let coil = muscles.tube.as_ref().ok_or_else(missing)?.coil;
    let bore_m = file.hydraulics.ok_or_else(missing)?.syringe.bore_m;
    let string_n = file.load.first().and_then(|l| l.force_n).ok_or_else(missing)?.abs();
    let scene = "scene muscle_bench";
    Ok(vec![
        Row::taken("outer diameter of the muscle", "mm", 1.45, coil.outer_diameter_m * 1e3, scene),
        Row::taken("rest length", "mm", 50.0, muscles.rest_length_m * 1e3, scene),
        Row::taken("bore of the syringe", "mm", 4.5, bore_m * 1e3, scene),
        Row::taken("load of the string", "N", 0.05, string_n, scene),
        Row::given("outer diameter it scales down to", "mm", 0.84, "a key of the scene; fabrication is not simulated"),
        Row::given("outer diameter it scales up to", "mm", 6.35, "simulated as the lift of 4.72 kg"),
    ])
}

fn derived() -> Vec<Row> {
    let line_ml = std::f64::consts::PI / 4.0 * 0.8f64.powi(2) * 1.0e3 * 1e-3;
    vec![
        Row::compared(
            "mass of the muscle",
            "g",
            0.28,
            mass_g(),
            0.005,
            "wire 0.20 mm of steel and tube; the wire was inferred from this number",
        )
        .tuned(),
        Row::compared("length over diameter, 3000 mm long", "1", 2069.0, 3000.0 / 1.45, 0.5, "arithmetic"),
        Row::judged(
            "fluid in the line",
            "mL",
            Some(0.5),
            line_ml,
            line_ml < 0.5,
            "paper: normally less than 0.5 mL; the stock line, 1 m of 0.8 mm bore, is our estimate and holds 0.6 % more",
        ),
    ]
}

/// Steel of the coil and silicone of the tube, g.
fn mass_g() -> f64 {
    let pi = std::f64::consts::PI;
    let wire = 250.0 * pi * 1.25e-3 * pi / 4.0 * 0.20e-3f64.powi(2);
    let tube = pi / 4.0 * (1.05e-3f64.powi(2) - 0.51e-3f64.powi(2)) * REST_MM * 1e-3;
    (wire * STEEL_KG_M3 + tube * SILICONE_KG_M3) * 1e3
}

fn stretches(safe: &Recording, beyond: &Recording) -> Result<Vec<Row>, ReproduceError> {
    let stretch =
        |run: &Recording| run.channel("elongation_mm").map(|c| figures::greatest(&c.values) / REST_MM * 100.0 + 100.0);
    let left = |run: &Recording| {
        run.channel("elongation_mm").map(|c| c.values.last().map_or(f64::NAN, |e| e / REST_MM * 100.0))
    };
    let pressure = figures::greatest(&safe.channel("pressure_kpa")?.values) * 1e-3;
    Ok(vec![
        Row::compared(
            "stretched to, of its length",
            "%",
            245.0,
            stretch(safe)?,
            0.5,
            "the plunger's stroke was sought for it; Fig. 1b says about 247 % for a muscle of 47 mm",
        )
        .tuned(),
        Row::judged(
            "longer than at first after 245 %",
            "%",
            Some(0.0),
            left(safe)?,
            left(safe)?.abs() < 2.0,
            "paper: safely returns to its original length; what is left is friction's, within 2 %",
        ),
        Row::shown("greatest pressure on the way to 245 %", "MPa", pressure, "paper: above 1.2 bar"),
        Row::judged(
            "longer than at first after 370 %",
            "%",
            None,
            left(beyond)?,
            left(beyond)? > 2.0,
            "paper: plastic deformation at 350 %; the rate of the set is a guess, its threshold is the paper's",
        ),
    ])
}

/// A run in which the muscle reaches a stretch; past yield with a coil that takes a set.
fn stretched_to(stretch: f64) -> Result<Recording, ReproduceError> {
    let wanted_mm = (stretch - 1.0) * REST_MM;
    let reached = |stroke_m: f64| -> Result<f64, ReproduceError> {
        let fast = play(stroke_m)?.fast()?;
        Ok(figures::greatest(&fast.channel("elongation_mm", &[], &[])?))
    };
    let stroke = size_for(wanted_mm, (2e-3, 25e-3), reached)?;
    play(stroke.ok_or_else(|| super::error::lacking(FIGURE, format!("no stroke stretches the muscle to {stretch}")))?)?
        .run()
}

fn play(stroke_m: f64) -> Result<Play, ReproduceError> {
    let (rise, hold, fall) = TIMES_S;
    let ramp = program(
        FIGURE,
        &format!("kind = \"ramp_hold\"\nto_m = {stroke_m:e}\nrise_s = {rise}\nhold_s = {hold}\nfall_s = {fall}"),
    )?;
    let threshold_m = (YIELD_STRETCH - 1.0) * REST_MM * 1e-3;
    let yields = effect("plastic_set", "muscle", &[("set_rate_1_s", 0.3), ("threshold_m", threshold_m)]);
    Ok(stock("muscle_free").driven("plunger_mm", ramp).and(yields).lasting(rise + hold + fall + 3.0))
}

fn length_percent(label: &str, colour: &'static str, run: &Recording) -> Result<Series, ReproduceError> {
    let y = run.channel("elongation_mm")?.values.iter().map(|e| 100.0 + e / REST_MM * 100.0).collect();
    Ok(Series { label: label.to_owned(), colour, x: run.time_s().to_vec(), y })
}
