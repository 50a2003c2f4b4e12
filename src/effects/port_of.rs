//! Where each entry of the catalogue acts, in the words of laws.

use super::Kind;
use crate::laws::Acts;

/// Port, whether it adds or scales, and the variables that it depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortOf {
    pub port: &'static str,
    pub acts: Acts,
    pub variables: &'static [&'static str],
}

const fn at(port: &'static str, acts: Acts, variables: &'static [&'static str]) -> PortOf {
    PortOf { port, acts, variables }
}

/// Where an entry of the catalogue acts. A law that was written down says so itself.
pub fn port_of(kind: Kind) -> PortOf {
    use Acts::{Adds, Scales};
    match kind {
        Kind::TrappedAir => at("line.compliance", Adds, &["pressure_pa"]),
        Kind::Leak => at("line.outflow", Adds, &["pressure_pa"]),
        Kind::ChamberLeak | Kind::ChamberGap | Kind::ChamberOrifice => at("line.outflow", Adds, &["pressure_pa"]),
        Kind::RubberYeoh | Kind::RubberMooneyRivlin | Kind::RubberOgden | Kind::RubberGent => {
            at("muscle.wall", Adds, &["elongation_m"])
        }
        Kind::LineRestriction => at("line.resistance", Scales, &["flow_m3_s"]),
        Kind::ThermalExpansion => at("line.outflow", Adds, &["time_s"]),
        Kind::PlungerBacklash => at("plunger", Adds, &["plunger_m"]),
        Kind::SealFriction => at("plunger", Adds, &["plunger_speed_m_s", "pressure_pa"]),
        Kind::Viscoelasticity => at("muscle.pull", Adds, &["elongation_m", "time_s"]),
        Kind::MullinsSoftening => at("muscle.wall", Scales, &["elongation_m"]),
        Kind::CoilPreload => at("muscle.coil", Adds, &["elongation_m"]),
        Kind::PlasticSet => at("muscle.rest_length", Adds, &["elongation_m", "time_s"]),
        Kind::PressureFriction => at("muscle.friction", Adds, &["pressure_pa"]),
        Kind::GravityLoad => at("joint.torque", Adds, &[]),
        Kind::BearingFriction => at("joint.torque", Adds, &["angular_speed_rad_s"]),
        Kind::CableSlack => at("cable.stretch", Adds, &[]),
        Kind::TendonFriction => at("cable.transmission", Scales, &["angle_rad", "angular_speed_rad_s"]),
        Kind::TendonCoupling => at("joint.torque", Adds, &["tension_n"]),
        Kind::ExternalContact | Kind::NotchClosure => at("joint.torque", Adds, &["angle_rad"]),
        Kind::SensorLag | Kind::SensorDelay => at("sensor", Adds, &["reading", "time_s"]),
        Kind::SensorDrift => at("sensor", Adds, &["time_s"]),
        Kind::SensorGain => at("sensor", Scales, &[]),
        Kind::HypotheticalForce => at("muscle.pull", Adds, &["elongation_m", "pressure_pa"]),
        Kind::HypotheticalFlow => at("line.outflow", Adds, &["pressure_pa"]),
        Kind::Law(id) => at("", id.law().law.acts, &[]),
    }
}
