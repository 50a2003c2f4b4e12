//! Figures of muscles, cables and joints, in SI units; what they look at is recorded though the scene does not show it.

use super::SweepError;
use super::measure::{Figure, Ran, time_below};
use crate::mechanism::StopSpec;
use crate::muscle::YIELD_STRETCH;
use crate::recording::figures::{greatest, least};
use crate::scene::{OutputSpec, Quantity};

/// Tension below which a cable counts as slack, N.
const SLACK_N: f64 = 1e-3;

/// Outputs that a figure of a muscle, cable or joint needs.
pub fn hidden_outputs(figure: Figure, of: &str) -> Vec<OutputSpec> {
    let quantities: &[Quantity] = match figure {
        Figure::SlackTime => &[Quantity::Tension],
        Figure::ClosedTime | Figure::YieldMargin => &[Quantity::Elongation],
        Figure::CavitationMargin => &[Quantity::SyringePressure, Quantity::MusclePressure],
        Figure::Loss => &[Quantity::SyringePressure],
        Figure::StopForce => &[Quantity::JointPosition],
        _ => &[],
    };
    let output = |quantity: &Quantity| OutputSpec {
        channel: channel(*quantity, of),
        quantity: *quantity,
        of: vec![of.to_owned()],
        arc_length_m: None,
        counts_from_start: false,
    };
    quantities.iter().map(output).collect()
}

/// Name of a hidden output; no scene would choose it.
fn channel(quantity: Quantity, of: &str) -> String {
    let unit = match quantity {
        Quantity::Elongation => "m",
        Quantity::SyringePressure | Quantity::MusclePressure => "pa",
        Quantity::JointPosition => "rad",
        _ => "n",
    };
    format!("figure.{quantity:?}.{of}_{unit}")
}

fn series<'a>(ran: Ran<'a>, quantity: Quantity, of: &str) -> Result<&'a [f64], SweepError> {
    Ok(&ran.recording.channel(&channel(quantity, of))?.values)
}

/// Time during which a cable is slack, s.
pub fn slack_time_s(ran: Ran, cable: &str) -> Result<f64, SweepError> {
    Ok(time_below(ran.recording.time_s(), series(ran, Quantity::Tension, cable)?, SLACK_N))
}

/// Time during which a muscle's coil lies on its turns, s.
pub fn closed_time_s(ran: Ran, muscle: &str) -> Result<f64, SweepError> {
    Ok(time_below(ran.recording.time_s(), series(ran, Quantity::Elongation, muscle)?, 0.0))
}

/// Stretch that is left until the coil stays bent: 3.5 [paper] less the greatest length over the rest length.
pub fn yield_margin_ratio(ran: Ran, muscle: &str) -> Result<f64, SweepError> {
    let own = ran.scene.file.muscle.iter().position(|m| m.name == muscle);
    let rest_m = own.and_then(|i| ran.scene.makes.get(i)).map_or(f64::NAN, |m| m.rest_length_m);
    Ok(YIELD_STRETCH - 1.0 - greatest(series(ran, Quantity::Elongation, muscle)?) / rest_m)
}

/// Least pressure, at the syringe or in the muscle, above that at which the fluid boils, Pa.
pub fn cavitation_margin_pa(ran: Ran, muscle: &str) -> Result<f64, SweepError> {
    let Some(hydraulics) = &ran.scene.file.hydraulics else { return Ok(f64::NAN) };
    let boils_pa = hydraulics.fluid.cavitation_gauge_pressure_pa();
    let at_syringe = least(series(ran, Quantity::SyringePressure, muscle)?);
    Ok(at_syringe.min(least(series(ran, Quantity::MusclePressure, muscle)?)) - boils_pa)
}

/// Work of a muscle's plunger on the fluid, J: what is lost, if the run ends where it began.
pub fn loss_j(ran: Ran, muscle: &str) -> Result<f64, SweepError> {
    let file = &ran.scene.file;
    let (Some(hydraulics), Some(spec)) = (&file.hydraulics, file.muscle.iter().find(|m| m.name == muscle)) else {
        return Ok(f64::NAN);
    };
    let plunger_m = ran.recording.si(&spec.input)?;
    let pressure_pa = series(ran, Quantity::SyringePressure, muscle)?;
    let strokes = plunger_m.windows(2).zip(pressure_pa.windows(2));
    Ok(hydraulics.syringe.area_m2() * strokes.map(|(x, p)| 0.5 * (x[1] - x[0]) * (p[0] + p[1])).sum::<f64>())
}

/// Greatest push of a joint on its stops at a lever from its axis, N; a slider needs none: take 1.
pub fn stop_force_n(ran: Ran, joint: &str, lever_m: f64) -> Result<f64, SweepError> {
    let position = series(ran, Quantity::JointPosition, joint)?;
    let specs = ran.scene.file.mechanism.iter().flat_map(|m| &m.joint);
    let own = specs.filter(|s| s.joints.iter().any(|j| j == joint));
    let mut push = 0.0f64;
    for spec in own {
        let below = spec.lower_stop.as_ref().map_or(0.0, |s| moment(s, |at| at - least(position)));
        let above = spec.upper_stop.as_ref().map_or(0.0, |s| moment(s, |at| greatest(position) - at));
        push = push.max(below).max(above);
    }
    Ok(push / lever_m)
}

/// Moment (or force) of a stop, given how deep a joint is in one that stands at a position.
fn moment(stop: &StopSpec, depth: impl Fn(f64) -> f64) -> f64 {
    let position = stop.position_rad.or(stop.position_m).unwrap_or(0.0);
    stop.stiffness_n_m_rad.or(stop.stiffness_n_m).unwrap_or(0.0) * depth(position).max(0.0)
}
