//! What the field calls a law: `muscle.friction` that falls with speed is breakaway friction.

use crate::laws::{Law, Memory};

/// Trend of a law as the magnitude of its variable grows from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trend {
    Grows,
    Falls,
    Either,
}
use Trend::{Either, Falls, Grows};

/// Port, variable, trend, name. The first matching row counts.
const NAMES: [(&str, &str, Trend, &str); 44] = [
    ("muscle.friction", "speed_m_s", Falls, "breakaway friction above the sliding friction (Stribeck)"),
    ("muscle.friction", "speed_m_s", Grows, "friction that grows with speed, as in a lubricated contact"),
    ("muscle.friction", "pressure_pa", Grows, "friction of a wall that pressure presses against its coil"),
    (
        "muscle.friction",
        "elongation_m",
        Either,
        "friction that depends on elongation, as of a sleeve that gets tighter or looser",
    ),
    ("muscle.friction", "time_s", Falls, "running-in"),
    ("muscle.friction", "time_s", Grows, "wear, or loss of lubricant"),
    ("muscle.wall", "elongation_m", Grows, "a wall that stiffens with elongation"),
    ("muscle.wall", "elongation_m", Falls, "a wall that softens with elongation"),
    ("muscle.wall", "time_s", Falls, "stress relaxation, or ageing, of the wall"),
    ("muscle.wall", "time_s", Grows, "hardening of the wall with time"),
    ("muscle.coil", "elongation_m", Grows, "a hardening coil"),
    ("muscle.coil", "elongation_m", Falls, "a softening coil"),
    ("muscle.coil", "time_s", Falls, "relaxation or fatigue of the coil"),
    ("muscle.pull", "speed_m_s", Falls, "drag on the muscle"),
    ("muscle.pull", "time_s", Either, "a drift of the force: creep, or temperature"),
    ("muscle.damping", "speed_m_s", Falls, "shear-thinning damping"),
    ("muscle.damping", "speed_m_s", Grows, "damping that grows with speed, as in turbulent flow"),
    ("muscle.area", "elongation_m", Falls, "a bore that narrows as the muscle lengthens"),
    ("muscle.area", "elongation_m", Grows, "a bore that widens as the muscle lengthens"),
    ("muscle.area", "pressure_pa", Grows, "a bore that pressure widens"),
    ("muscle.rest_length", "time_s", Either, "a set, or swelling, of the muscle"),
    ("line.resistance", "flow_m3_s", Grows, "losses that grow with flow: bends, fittings, turbulence"),
    ("line.resistance", "pressure_pa", Falls, "a line that pressure widens"),
    ("line.resistance", "time_s", Grows, "a line that clogs, or fluid that thickens"),
    ("line.resistance", "time_s", Falls, "fluid that warms"),
    ("line.pressure_drop", "flow_m3_s", Grows, "an orifice or a valve in the line"),
    ("line.outflow", "pressure_pa", Grows, "a leak"),
    ("line.outflow", "time_s", Either, "fluid that warms or cools"),
    ("line.compliance", "pressure_pa", Falls, "gas in the line"),
    ("line.compliance", "time_s", Grows, "gas that comes out of the fluid, or a hose that softens"),
    ("syringe.compliance", "pressure_pa", Falls, "gas in the syringe"),
    ("syringe.flow", "pressure_pa", Grows, "a leak past the stopper"),
    ("plunger", "pressure_pa", Falls, "a drive that gives way under pressure"),
    ("cable.stiffness", "tension_n", Grows, "a cable that hardens, as woven ones do"),
    ("cable.stretch", "time_s", Grows, "creep of the cable"),
    ("cable.lever", "angle_rad", Either, "a pulley that is eccentric or not round"),
    ("cable.transmission", "angle_rad", Falls, "friction of the cable along its guide (capstan)"),
    ("joint.torque", "angle_rad", Falls, "a torsion spring, or a stop, at the joint"),
    ("joint.torque", "angle_rad", Grows, "a torque that drives the joint out, as of an upright load"),
    ("joint.torque", "angular_speed_rad_s", Falls, "friction or drag of the joint"),
    ("joint.torque", "time_s", Either, "a drift of the joint's torque"),
    ("joint.stiffness", "angle_rad", Grows, "a joint that stiffens as it bends"),
    ("joint.stiffness", "angle_rad", Falls, "a joint that softens as it bends"),
    ("joint.damping", "angular_speed_rad_s", Either, "damping of the joint that depends on its speed"),
];

/// Common name of a law of one variable, or of what it remembers; `None` if there is none. `value`: the law as a
/// function of its variable.
pub fn known_as(law: &Law, values: &[f64], value: &dyn Fn(f64) -> f64) -> Option<&'static str> {
    if let Some(state) = law.states.first() {
        return Some(match state.memory {
            Memory::Greatest => "a law that the greatest value so far sets, as in Mullins' effect",
            Memory::Play => "play",
            Memory::Rate => return None,
        });
    }
    let scale = law.parameters.iter().zip(values).find(|(p, _)| p.name.starts_with("scale"))?.1;
    over(law, &[value(0.02 * scale), value(2.0 * scale)])
}

/// A law whose ends differ by less than this share of its range goes back on the way: it neither grows nor falls.
const TURNS: f64 = 0.5;

/// The same of a law without memory with its values where its variable has been, from the least in magnitude to the greatest.
pub fn over(law: &Law, values: &[f64]) -> Option<&'static str> {
    let [variable] = law.variables()[..] else { return None };
    let (port, variable) = (law.address.port.spec().name(), variable.name());
    let (near, far) = (*values.first()?, *values.last()?);
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
    let trend = match (far - near).abs() < TURNS * (high - low) {
        true => Either,
        false if far >= near => Grows,
        false => Falls,
    };
    let fits =
        |row: &&(&str, &str, Trend, &str)| row.0 == port && row.1 == variable && [Either, trend].contains(&row.2);
    NAMES.iter().find(fits).map(|row| row.3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{LawTable, PORTS, QUANTITIES, Surroundings};

    fn law(text: &str) -> Law {
        toml::from_str::<LawTable>(text).expect("TOML").law(&Surroundings::default()).expect("a law")
    }

    #[test]
    fn friction_that_falls_with_speed_is_breakaway() {
        let law = law("name = 'f'\nport = 'muscle.friction'\nscales = '1 + a * exp(-abs(speed_m_s/scale_m_s))'\n\
             parameter.a = { value = 0.4 }\nparameter.scale_m_s = { value = 2e-3 }");
        let name = |a: f64| known_as(&law, &law.values(), &|x| 1.0 + a * (-x.abs() / 2e-3).exp());
        assert!(name(0.4).expect("a name").starts_with("breakaway"));
        assert!(name(-0.4).expect("a name").contains("grows with speed"));
    }

    /// A law that rises where the rig has been may fall towards zero.
    #[test]
    fn where_the_runs_have_been_decides_on_the_name() {
        let law = law("name = 'f'\nport = 'muscle.area'\nscales = '1 + a * elongation_m/scale_m'\n\
             parameter.a = { value = 0.1 }\nparameter.scale_m = { value = 0.01 }");
        assert!(over(&law, &[0.92, 1.0]).is_some_and(|name| name.contains("widens")));
        assert!(over(&law, &[1.07, 1.0]).is_some_and(|name| name.contains("narrows")));
        // What comes back does neither.
        assert_eq!(over(&law, &[0.92, 1.1, 0.95, 0.8, 1.0]), None);
    }

    #[test]
    fn what_has_no_name_gets_none() {
        let law = law("name = 'f'\nport = 'muscle.coil'\nscales = '1 + a * pressure_pa/scale_pa'\n\
             parameter.a = { value = 0.4, unit = '1' }\nparameter.scale_pa = { value = 1e5 }");
        assert_eq!(known_as(&law, &law.values(), &|x| 1.0 + x), None);
    }

    #[test]
    fn every_row_is_of_a_port_and_a_variable_that_there_are() {
        for (port, variable, ..) in NAMES {
            assert!(PORTS.iter().any(|p| p.name() == port), "{port}");
            assert!(QUANTITIES.iter().any(|q| q.name() == variable), "{variable}");
        }
    }
}
