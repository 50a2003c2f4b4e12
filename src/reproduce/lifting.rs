//! Loads lifted: 50 g by 0.28 g (Fig. 1c), 4.72 kg by the 6.35 mm muscle (Fig. 1d).

use crate::recording::Recording;
use crate::recording::figures;
use crate::report::{BLUE, ORANGE, Panel, Series};

use super::rig::{Play, sine, stock};
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "lift";
const GRAVITY_M_S2: f64 = 9.80665;
/// How much thicker the large muscle is, and how much longer: 51 g at the same density are 475 mm.
const THICKER: f64 = 6.35 / 1.45;
const LARGE_REST_M: f64 = 0.475;
const LARGE_LOAD_KG: f64 = 4.72;
/// Stretch that the large muscle starts from: there its wall and coil pull more than 4.72 kg.
const LARGE_PRE_ELONGATION: f64 = 1.5;

/// Both lifts.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let (small, large) = (stock("muscle_lift").run()?, large()?.run()?);
    let height = |run: &Recording| -> Result<f64, ReproduceError> {
        let values = &run.channel("elongation_mm")?.values;
        Ok(values[0] - figures::least(values))
    };
    let (small_mm, large_mm) = (height(&small)?, height(&large)?);
    let rows = vec![
        Row::judged(
            "50 g lifted by 0.28 g",
            "mm",
            None,
            small_mm,
            small_mm > 1.0,
            "height; plunger withdrawn 1 mm, 50 % pre-elongation; the paper prints no height",
        ),
        Row::compared("load over mass, small muscle", "1", 178.0, 50.0 / 0.28, 1.0, "arithmetic"),
        Row::judged(
            "4.72 kg lifted by 51 g",
            "mm",
            None,
            large_mm,
            large_mm > 10.0,
            "height; the small muscle scaled to 6.35 mm and 475 mm, 150 % pre-elongation",
        ),
        Row::shown("load over mass, large muscle", "1", LARGE_LOAD_KG / 0.051, "the paper prints both masses only"),
        Row::shown(
            "greatest pressure, large muscle",
            "MPa",
            figures::greatest(&large.channel("pressure_kpa")?.values) * 1e-3,
            "no pressure is printed",
        ),
    ];
    let text = "The mass hangs on a pressurised muscle and rises as the plunger is withdrawn. The large muscle has the \
                small one's cross-section scaled by 6.35/1.45 and the length that gives 51 g; forces grow with the \
                square of the diameter.";
    Ok(Chapter { text: vec![text.to_owned()], panels: vec![panel(&small, &large)?], rows })
}

/// The stock muscle scaled: cross-section by `THICKER`, length to `LARGE_REST_M`.
fn large() -> Result<Play, ReproduceError> {
    let (s, longer) = (THICKER, LARGE_REST_M / 0.05);
    let area = s * s;
    // Turns of a thicker wire: fewer to the length. A turn's stiffness grows with its size.
    let coil_n_m = 28.3 * s * s / longer;
    let play = stock("muscle_lift")
        .with("muscles.rest_length_m", LARGE_REST_M)
        .with("muscles.pre_elongation_ratio", LARGE_PRE_ELONGATION)
        .with("muscles.tube.inner_diameter_m", 0.51e-3 * s)
        .with("muscles.tube.outer_diameter_m", 1.05e-3 * s)
        .with("muscles.tube.coil.stiffness_n_m", coil_n_m)
        .with("muscles.tube.coil.outer_diameter_m", 6.35e-3)
        .with("muscles.damping_n_s_m", 0.1 * area / longer)
        .with("muscles.friction.m0_n", 0.106 * area)
        .with("muscles.friction.m1_n_pa", 0.222e-6 * area)
        .with("muscles.friction.presliding_length_m", 5.2e-3 * longer)
        .with("muscles.initial_load_n", LARGE_LOAD_KG * GRAVITY_M_S2)
        .with("mechanism.link_mass.0.mass_kg", LARGE_LOAD_KG)
        // A syringe and compliances in proportion to the muscle's volume; the line stays 1 m long.
        .with("hydraulics.syringe.bore_m", 4.5e-3 * (area * longer).sqrt())
        .with("hydraulics.line.bore_m", 0.8e-3 * s)
        .with("hydraulics.upstream_compliance_m3_pa", 8.0e-15 * area * longer)
        .with("hydraulics.downstream_compliance_m3_pa", 2.6e-15 * area * longer);
    Ok(play.driven("plunger_mm", sine(FIGURE, -1.0e-3, 0.1)?))
}

fn panel(small: &Recording, large: &Recording) -> Result<Panel, ReproduceError> {
    let line = |label: &str, colour, run: &Recording| -> Result<Series, ReproduceError> {
        let values = &run.channel("elongation_mm")?.values;
        let y = values.iter().map(|e| values[0] - e).collect();
        Ok(Series { label: label.to_owned(), colour, x: run.time_s().to_vec(), y })
    };
    Ok(Panel {
        title: vec!["Height of the mass".to_owned()],
        x_label: "time (s)".to_owned(),
        y_label: "height (mm)".to_owned(),
        series: vec![line("50 g by 0.28 g", BLUE, small)?, line("4.72 kg by 51 g", ORANGE, large)?],
        ..Panel::default()
    })
}
