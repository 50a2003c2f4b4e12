//! Routing (Fig. 4c, d): a line bent, looped and knotted, and beside it a tendon in a sheath.

use rayon::prelude::*;

use crate::parallel;
use crate::recording::figures;
use crate::report::{BLUE, GREEN, ORANGE, Panel, Series, VERMILION};

use super::loops::Loop;
use super::rig::{effect, sine, stock};
use super::{Chapter, ReproduceError, Row};

const FIGURE: &str = "4cd";
const LINE_BORE_M: f64 = 0.8e-3;
const FREQUENCY_HZ: f64 = 0.2;
const STROKE_M: f64 = 3.0e-3;
/// Friction of a tendon in its sheath, within the 0.05 to 0.2 of the literature.
const SHEATH_FRICTION: f64 = 0.1;

/// A way to lay the line: how tightly it is curved, and over how much of its length.
struct Routing {
    name: &'static str,
    curved_share: f64,
    bend_diameter_m: f64,
    colour: &'static str,
}

const ROUTINGS: [Routing; 4] = [
    Routing { name: "straight", curved_share: 0.0, bend_diameter_m: 1.0, colour: BLUE },
    Routing { name: "bent", curved_share: 0.3, bend_diameter_m: 60e-3, colour: GREEN },
    Routing { name: "looped", curved_share: 0.8, bend_diameter_m: 30e-3, colour: ORANGE },
    Routing { name: "knotted", curved_share: 0.2, bend_diameter_m: 6e-3, colour: VERMILION },
];

impl Routing {
    /// What the curvature adds to the line's laminar resistance, as a share of it.
    fn added_resistance(&self) -> f64 {
        self.curved_share * (curved_over_straight(dean_number(self.bend_diameter_m)) - 1.0)
    }
}

/// `Re sqrt(d/D)` at the plunger's greatest speed.
fn dean_number(bend_diameter_m: f64) -> f64 {
    let flow_m3_s = std::f64::consts::PI * FREQUENCY_HZ * STROKE_M * 15.904e-6;
    let speed_m_s = flow_m3_s / (std::f64::consts::PI / 4.0 * LINE_BORE_M.powi(2));
    998.0 * speed_m_s * LINE_BORE_M / 1.002e-3 * (LINE_BORE_M / bend_diameter_m).sqrt()
}

/// Friction factor of a curved tube over a straight one's, laminar: `21.5 De/(1.56 + log10 De)^5.73` for
/// 13.5 < De < 2000, else 1. Source: Ito 1959, J. Basic Eng. 81, 123.
fn curved_over_straight(dean: f64) -> f64 {
    if dean <= 13.5 { 1.0 } else { 21.5 * dean / (1.56 + dean.log10()).powf(5.73) }
}

/// Fig. 4d, and the comparator that it is set against.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let loops: Result<Vec<Loop>, ReproduceError> =
        parallel::map(&ROUTINGS, |r| line_loop(r.added_resistance(), 1.0)).into_iter().collect();
    let loops = loops?;
    let widths: Vec<f64> = loops.iter().map(|l| l.width().0).collect();
    let worst = widths.iter().map(|w| (w / widths[0] - 1.0).abs() * 100.0).fold(0.0, f64::max);
    let long = line_loop(0.0, 2.0)?.width().0;
    let doubled = line_loop(1.0, 1.0)?.width().0;
    let mut rows = vec![
        Row::judged(
            "change of the loop's width by routing",
            "%",
            Some(0.0),
            worst,
            worst < 1.0,
            format!(
                "paper: almost unchanged; a knot of 6 mm has Dean number {:.0} and adds {:.2} % to the resistance (Ito)",
                dean_number(6e-3),
                100.0 * ROUTINGS[3].added_resistance()
            ),
        ),
        Row::judged(
            "change by a line of 2 m instead of 1 m",
            "%",
            None,
            100.0 * (long / widths[0] - 1.0),
            (long / widths[0] - 1.0).abs() < 0.1,
            "paper: up to 2 m from source to muscle; tolerance 10 %",
        ),
        Row::shown(
            "change by a line of twice the resistance",
            "%",
            100.0 * (doubled / widths[0] - 1.0),
            "what it would take to see the routing",
        ),
    ];
    let sheaths = sheath_loops()?;
    for (wrap_deg, cycle) in &sheaths {
        rows.push(Row::shown(
            format!("tendon in a sheath wound by {wrap_deg:.0} degrees: width of the loop"),
            "deg",
            cycle.width().0.abs(),
            format!(
                "T_out/T_in = {:.3} sliding, mu = {SHEATH_FRICTION}",
                (-SHEATH_FRICTION * wrap_deg.to_radians()).exp()
            ),
        ));
    }
    let grows = sheaths.windows(2).all(|w| w[1].1.area() > w[0].1.area());
    rows.push(Row::stated(
        "the sheath's loop grows with every winding",
        grows,
        "the paper states it of tendon-sheath mechanisms",
    ));
    Ok(Chapter { text: text(), panels: panels(&loops, &sheaths), rows })
}

fn text() -> Vec<String> {
    vec![
        "Plunger 0 to 3 mm at 0.2 Hz. Routing acts on a hydraulic line through the resistance of its bends alone, which \
         at this flow is next to nothing. A tendon in a sheath loses a share of its force for every radian it is wound: \
         its loop grows with the way it is laid."
            .to_owned(),
    ]
}

fn line_loop(added_resistance: f64, length_m: f64) -> Result<Loop, ReproduceError> {
    let play = stock("muscle_bench")
        .driven("plunger_mm", sine(FIGURE, STROKE_M, FREQUENCY_HZ)?)
        .with("hydraulics.line.length_m", length_m)
        .lasting(20.0);
    let play = match added_resistance > 0.0 {
        true => play.and(effect("line_restriction", "line", &[("resistance_ratio", added_resistance)])),
        false => play,
    };
    play.last_loop("plunger_mm", "elongation_mm", 1.0 / FREQUENCY_HZ)
}

fn sheath_loops() -> Result<Vec<(f64, Loop)>, ReproduceError> {
    let of = |wrap_deg: f64| -> Result<(f64, Loop), ReproduceError> {
        let mut play = stock("tendon_sheath").lasting(20.0);
        for cable in ["tendon_1", "tendon_2"] {
            play = play.with(&format!("cable.{cable}.sheath_angle_rad"), wrap_deg.to_radians());
        }
        let play = play.and(effect("tendon_friction", "cable", &[("friction_coefficient", SHEATH_FRICTION)]));
        Ok((wrap_deg, play.last_loop("drive_deg", "tip_deg", 1.0 / 0.15)?))
    };
    [30.0, 90.0, 180.0, 360.0].into_par_iter().map(of).collect()
}

fn panels(loops: &[Loop], sheaths: &[(f64, Loop)]) -> Vec<Panel> {
    let line = |label: String, colour, l: &Loop| Series { label, colour, x: l.x.clone(), y: l.y.clone() };
    let colours = [BLUE, GREEN, ORANGE, VERMILION];
    let range = figures::range(&loops[0].y);
    vec![
        Panel {
            title: vec![format!("Hydraulic line, four ways to lay it: {range:.1} mm each")],
            x_label: "plunger (mm)".to_owned(),
            y_label: "elongation (mm)".to_owned(),
            series: ROUTINGS.iter().zip(loops).map(|(r, l)| line(r.name.to_owned(), r.colour, l)).collect(),
            ..Panel::default()
        },
        Panel {
            title: vec!["Tendon in a sheath, mu = 0.1".to_owned()],
            x_label: "drive (deg)".to_owned(),
            y_label: "tip (deg)".to_owned(),
            series: sheaths.iter().zip(colours).map(|((w, l), c)| line(format!("wound by {w:.0}°"), c, l)).collect(),
            ..Panel::default()
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gentle_bend_adds_nothing_and_a_tight_one_a_little() {
        assert_eq!(curved_over_straight(10.0), 1.0);
        // Ito's own figure: at De = 100 about 1.5 times the straight tube.
        assert!((curved_over_straight(100.0) - 1.49).abs() < 0.1, "{}", curved_over_straight(100.0));
    }
}
