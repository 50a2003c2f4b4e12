//! The ports, each described.

use super::Acts::{self, Adds, Scales};
use super::port::{Carrier as C, Port, PortSpec};

const fn port(
    port: Port,
    (element, term, carrier): (&'static str, &'static str, C),
    (adds, scales, dissipates): (&'static [&'static str], bool, bool),
    means: &'static str,
    example: (Acts, &'static str),
) -> PortSpec {
    PortSpec { port, element, term, carrier, adds, scales, means, example, dissipates }
}

/// Every port, in the order of [`Port`].
pub const PORTS: [PortSpec; 28] = [
    port(
        Port::Plunger,
        ("plunger", "", C::Muscle),
        (&["m"], false, false),
        "how far the piston is ahead of the recorded plunger: play, a drive that yields (> 0: further in)",
        (Adds, "-compliance_m_pa * pressure_pa"),
    ),
    port(
        Port::SyringeFlow,
        ("syringe", "flow", C::Muscle),
        (&["m3/s"], false, true),
        "flow that leaves the fluid before the line: a seal that leaks",
        (Adds, "conductance_m3_s_pa * pressure_pa"),
    ),
    port(
        Port::SyringeCompliance,
        ("syringe", "compliance", C::Muscle),
        (&["m3/Pa"], true, false),
        "compliance before the line: barrel, stopper, hose",
        (Scales, "1 + a * pressure_pa / scale_pa"),
    ),
    port(
        Port::PressureDrop,
        ("line", "pressure_drop", C::Muscle),
        (&["Pa"], true, true),
        "viscous pressure drop over the line, falling towards the muscle; scaled as a whole",
        (Adds, "q_pa_s2_m6 * flow_m3_s * abs(flow_m3_s)"),
    ),
    port(
        Port::Resistance,
        ("line", "resistance", C::Muscle),
        (&["Pa s/m3"], true, true),
        "viscous resistance of the line",
        (Scales, "1 + a * (flow_m3_s < 0)"),
    ),
    port(
        Port::Inertance,
        ("line", "inertance", C::Muscle),
        (&["Pa s2/m3"], true, false),
        "inertia of the fluid in the line",
        (Scales, "1 + a"),
    ),
    port(
        Port::Outflow,
        ("line", "outflow", C::Muscle),
        (&["m3/s"], false, true),
        "flow that leaves the fluid after the line: a leak",
        (Adds, "conductance_m3_s_pa * max(pressure_pa - opening_pa, 0)"),
    ),
    port(
        Port::LineCompliance,
        ("line", "compliance", C::Muscle),
        (&["m3/Pa"], true, false),
        "compliance after the line: air, fittings, swelling",
        (Adds, "volume_m3 * atmosphere_pa / (atmosphere_pa + pressure_pa)^2"),
    ),
    port(
        Port::Pull,
        ("muscle", "pull", C::Muscle),
        (&["N"], true, false),
        "force of the muscle on its end, > 0 pulls more; scaled as a whole, without the closed coil's stop",
        (Adds, "stiffness_n_m * max(elongation_m - taut_m, 0)"),
    ),
    port(
        Port::Wall,
        ("muscle", "wall", C::Muscle),
        (&["N"], true, false),
        "pull of the rubber wall",
        (Scales, "1 - a * ln(1 + time_s / ageing_s)"),
    ),
    port(
        Port::Coil,
        ("muscle", "coil", C::Muscle),
        (&["N"], true, false),
        "pull of the coil",
        (Adds, "preload_n * tanh(elongation_m / opening_m)"),
    ),
    port(
        Port::Friction,
        ("muscle", "friction", C::Muscle),
        (&["N"], true, true),
        "level of the friction between tube and coil, m0 + m1 p; the friction state gives it its direction",
        (Scales, "1 + a * pressure_pa / scale_pa"),
    ),
    port(
        Port::Damping,
        ("muscle", "damping", C::Muscle),
        (&["N"], true, true),
        "viscous force c v, > 0 while the muscle grows longer",
        (Adds, "c3_n * (speed_m_s / speed_scale_m_s)^3"),
    ),
    port(
        Port::Area,
        ("muscle", "area", C::Muscle),
        (&["m2"], true, false),
        "effective area: what pressure adds to the pull is what motion takes from the fluid",
        (Scales, "1 + growth_1_m * elongation_m"),
    ),
    port(
        Port::RestLength,
        ("muscle", "rest_length", C::Muscle),
        (&["m"], false, false),
        "by how much wall and coil have become longer: set, swelling",
        (Adds, "rate_m_s * time_s"),
    ),
    port(
        Port::Tension,
        ("cable", "tension", C::Cable),
        (&["N"], true, false),
        "tension of a taut cable; never below zero",
        (Scales, "1 - a * angle_rad^2"),
    ),
    port(
        Port::Stretch,
        ("cable", "stretch", C::Cable),
        (&["m"], false, false),
        "stretch of the cable: < 0 is slack",
        (Adds, "-slack_m"),
    ),
    port(
        Port::CableStiffness,
        ("cable", "stiffness", C::Cable),
        (&["N"], true, false),
        "elastic part of the tension, k s",
        (Scales, "1 + a * stretch_m / scale_m"),
    ),
    port(
        Port::Lever,
        ("cable", "lever", C::Cable),
        (&["m"], true, false),
        "lever of the cable on the joints; its travel is the integral of the lever, so that no work is lost",
        (Scales, "1 + a * sin(angle_rad)"),
    ),
    port(
        Port::Transmission,
        ("cable", "transmission", C::Cable),
        (&["1"], true, true),
        "share of the tension that arrives at the joints",
        (Scales, "exp(-mu * abs(angle_rad))"),
    ),
    port(
        Port::Torque,
        ("joint", "torque", C::Joint),
        (&["N m", "N"], true, false),
        "torque on a joint (force on a slider), > 0 turns along +angle; scales: that of its own spring and damper",
        (Adds, "-torque_n_m * tanh(angular_speed_rad_s / speed_rad_s)"),
    ),
    port(
        Port::JointStiffness,
        ("joint", "stiffness", C::Joint),
        (&["N m", "N"], true, false),
        "torque of the joint's own spring, > 0 turns back",
        (Scales, "1 + a * angle_rad^2"),
    ),
    port(
        Port::JointDamping,
        ("joint", "damping", C::Joint),
        (&["N m", "N"], true, true),
        "torque of the joint's own damper, > 0 against +angle",
        (Adds, "c_n_m_s_rad * angular_speed_rad_s * abs(angle_rad)"),
    ),
    port(
        Port::AxisForce,
        ("axis", "force", C::Alone),
        (&["N"], true, false),
        "force with which the axis answers, without dry friction; > 0 as the pressure's",
        (Adds, "stiffness_n_m * position_m"),
    ),
    port(
        Port::AxisFriction,
        ("axis", "friction", C::Alone),
        (&["N"], true, true),
        "level of the dry friction of its seals; the way that the axis goes gives it its direction",
        (Adds, "friction_n * exp(-abs(speed_m_s) / stribeck_m_s)"),
    ),
    port(
        Port::StripForce,
        ("strip", "force", C::Alone),
        (&["N"], true, false),
        "force of a strip that is pulled; with it, too, a strip never pushes",
        (Scales, "1 - a * ln(1 + time_s / ageing_s)"),
    ),
    port(
        Port::ChamberOutflow,
        ("chamber", "outflow", C::Alone),
        (&["Pa/s"], false, true),
        "rate at which the pressure of a closed chamber falls: gas that leaves",
        (Adds, "rate_1_s * max(pressure_pa - opening_pa, 0)"),
    ),
    port(
        Port::Sensor,
        ("sensor", "CHANNEL", C::Sensor),
        (&[], true, false),
        "what a channel shows; added in the SI unit of the channel",
        (Scales, "1 + a * time_s / scale_s"),
    ),
];

impl Port {
    /// How it is described.
    #[doc(hidden)]
    pub fn spec(self) -> &'static PortSpec {
        &PORTS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Dimension;

    #[test]
    fn the_list_is_in_order() {
        for (i, spec) in PORTS.iter().enumerate() {
            assert_eq!(spec.port as usize, i, "{}", spec.name());
            assert!(spec.adds.iter().all(|unit| Dimension::parse(unit).is_ok()), "{}", spec.name());
        }
    }
}
