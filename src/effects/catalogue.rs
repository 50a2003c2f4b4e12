//! Every effect: name, element, law, parameters, ranges.

use super::{EffectSpec, ElementKind, Kind, ParameterSpec, Range};

/// A number that a scene must give and a diagnosis fits.
const fn fitted(key: &'static str, symbol: &'static str, min: f64, max: f64, typical: f64) -> ParameterSpec {
    ParameterSpec { key, symbol, range: Range { min, max }, typical, default: None, is_fitted: true }
}

/// A number with a default that a diagnosis fits.
const fn fitted_from(key: &'static str, symbol: &'static str, min: f64, max: f64, default: f64) -> ParameterSpec {
    ParameterSpec { key, symbol, range: Range { min, max }, typical: default, default: Some(default), is_fitted: true }
}

/// A number with a default that a diagnosis leaves alone.
const fn fixed(key: &'static str, symbol: &'static str, min: f64, max: f64, default: f64) -> ParameterSpec {
    ParameterSpec { key, symbol, range: Range { min, max }, typical: default, default: Some(default), is_fitted: false }
}

/// The catalogue, along the chain. The order of parameters is that of [`super::Effect::values`].
///
/// ```
/// use smam::effects::{CATALOGUE, Kind, find};
///
/// let leak = find(Kind::Leak);
/// assert_eq!((leak.name, leak.element.name(), leak.law), ("leak", "line", "Q_leak = G p_m"));
/// assert_eq!(leak.parameters[0].key, "conductance_m3_s_pa");
/// // The first parameter is the size of the effect: zero, where it is absent, is within the range of each.
/// assert!(CATALOGUE.iter().all(|e| (e.parameters[0].range.min..=e.parameters[0].range.max).contains(&0.0)));
/// ```
pub const CATALOGUE: &[EffectSpec] = &[
    EffectSpec {
        kind: Kind::PlungerBacklash,
        name: "plunger_backlash",
        title: "play between the recorded plunger and the piston",
        element: ElementKind::Syringe,
        law: "x = min(max(x, u - b/2), u + b/2)",
        source: "play operator (Krasnosel'skii and Pokrovskii)",
        parameters: &[fitted("width_m", "b", 0.0, 2e-3, 4e-5)],
    },
    EffectSpec {
        kind: Kind::SealFriction,
        name: "seal_friction",
        title: "dry friction of a seal, growing with the pressure on it",
        element: ElementKind::Syringe,
        law: "F = (F_c + f_p p) z, dz/dt = |v|/s (sgn v - z)",
        source: "Dahl's friction with a pressure-dependent level",
        parameters: &[
            fitted("friction_force_n", "F_c", 0.0, 500.0, 3.0),
            fitted_from("friction_per_pressure_n_pa", "f_p", 0.0, 1e-2, 1e-5),
            fitted_from("presliding_m", "s", 1e-6, 5e-3, 1e-4),
        ],
    },
    EffectSpec {
        kind: Kind::TrappedAir,
        name: "trapped_air",
        title: "a bubble of gas in the line",
        element: ElementKind::Line,
        law: "V = V0 (p_atm/(p_atm + p))^(1/kappa)",
        source: "ideal gas, polytropic",
        parameters: &[fitted("free_volume_m3", "V0", 0.0, 2e-7, 1e-9), fixed("kappa", "kappa", 1.0, 1.4, 1.0)],
    },
    EffectSpec {
        kind: Kind::Leak,
        name: "leak",
        title: "fluid lost after the line, in proportion to pressure",
        element: ElementKind::Line,
        law: "Q_leak = G p_m",
        source: "laminar leak",
        parameters: &[fitted("conductance_m3_s_pa", "G", 0.0, 1e-13, 1e-16)],
    },
    EffectSpec {
        kind: Kind::ChamberLeak,
        name: "leak",
        title: "gas leaves a closed chamber in proportion to the pressure difference",
        element: ElementKind::Line,
        law: "dp/dt = -k (p - p_a), k = G p_a/V",
        source: "fixed conductance, isothermal ideal gas",
        parameters: &[fitted("rate_1_s", "k", 0.0, 2.0, 1e-3)],
    },
    EffectSpec {
        kind: Kind::ChamberGap,
        name: "leak",
        title: "gas leaves a closed chamber through a long narrow gap",
        element: ElementKind::Line,
        law: "dp/dt = -k (p^2 - p_a^2)/(2 p_a), p absolute",
        source: "compressible laminar flow (Poiseuille), isothermal ideal gas",
        parameters: &[fitted("laminar_rate_1_s", "k", 0.0, 2.0, 3e-4)],
    },
    EffectSpec {
        kind: Kind::ChamberOrifice,
        name: "leak",
        title: "gas leaves a closed chamber through a short hole, choked while the pressure is high",
        element: ElementKind::Line,
        law: "dp/dt = -k p psi(p_a/p), psi = 1 where choked, p absolute",
        source: "ISO 6358-1, isothermal ideal gas",
        parameters: &[fitted("orifice_rate_1_s", "k", 0.0, 2.0, 1e-3)],
    },
    EffectSpec {
        kind: Kind::LineRestriction,
        name: "line_restriction",
        title: "more resistance than the line's bore tells",
        element: ElementKind::Line,
        law: "p_s - p_m = R (1 + r) Q + q Q |Q|",
        source: "Hagen-Poiseuille, minor losses",
        parameters: &[
            fitted_from("resistance_ratio", "r", 0.0, 1e4, 20.0),
            fixed("quadratic_pa_s2_m6", "q", 0.0, 1e22, 0.0),
        ],
    },
    EffectSpec {
        kind: Kind::ThermalExpansion,
        name: "thermal_expansion",
        title: "the fluid grows or shrinks with a drifting temperature",
        element: ElementKind::Line,
        law: "Q = dV/dt, constant",
        source: "V_line beta dT/dt with a linear drift of T",
        parameters: &[fitted("volume_rate_m3_s", "dV/dt", -1e-9, 1e-9, 5e-11)],
    },
    EffectSpec {
        kind: Kind::RubberYeoh,
        name: "rubber_law",
        title: "the rubber stiffens or softens at large stretch: Yeoh's terms beside the scene's law",
        element: ElementKind::Muscle,
        law: "P = 2 (l - l^-2) (2 C2 J + 3 C3 J^2), J = l^2 + 2/l - 3",
        source: "Yeoh 1993",
        parameters: &[fitted("c2_pa", "C2", -1e6, 1e6, 1e3), fitted_from("c3_pa", "C3", -1e5, 1e5, 0.0)],
    },
    EffectSpec {
        kind: Kind::RubberMooneyRivlin,
        name: "rubber_law",
        title: "the rubber is stiffer at small stretch than later: Mooney's term beside the scene's law",
        element: ElementKind::Muscle,
        law: "P = 2 (l - l^-2) C01/l",
        source: "Mooney 1940, Rivlin 1948",
        parameters: &[fitted("c01_pa", "C01", -1e6, 1e6, 1e4)],
    },
    EffectSpec {
        kind: Kind::RubberOgden,
        name: "rubber_law",
        title: "the rubber stiffens by a power of its stretch: a term of Ogden's beside the scene's law",
        element: ElementKind::Muscle,
        law: "P = mu (l^(alpha-1) - l^(-alpha/2-1))",
        source: "Ogden 1972",
        parameters: &[fitted("mu_pa", "mu", -1e6, 1e6, 1e3), fitted_from("alpha", "alpha", -10.0, 15.0, 4.0)],
    },
    EffectSpec {
        kind: Kind::RubberGent,
        name: "rubber_law",
        title: "the rubber locks where its chains end: Gent's factor on the scene's law",
        element: ElementKind::Muscle,
        law: "P = mu (l - l^-2) (1/(1 - J/Jm) - 1), J = l^2 + 2/l - 3",
        source: "Gent 1996",
        parameters: &[fitted("inverse_limit", "1/Jm", 0.0, 1.0, 0.01)],
    },
    EffectSpec {
        kind: Kind::Viscoelasticity,
        name: "viscoelasticity",
        title: "the silicone relaxes: a Maxwell branch beside the muscle",
        element: ElementKind::Muscle,
        law: "F = E (e - e_i), tau de_i/dt = e - e_i; over n > 0 decades: creep as the logarithm of time",
        source: "generalised Maxwell solid; over decades a constant logarithmic retardation spectrum (Ferry 1980)",
        parameters: &[
            fitted("stiffness_n_m", "E", 0.0, 1e4, 6.0),
            fitted("relaxation_time_s", "tau", 0.05, 500.0, 4.0),
            fixed("decades", "n", 0.0, 8.0, 0.0),
        ],
    },
    EffectSpec {
        kind: Kind::MullinsSoftening,
        name: "mullins_softening",
        title: "the silicone is softer below its greatest stretch so far",
        element: ElementKind::Muscle,
        law: "F_wall (1 - d tanh((W_max - W)/W_m))",
        source: "Ogden and Roxburgh 1999",
        parameters: &[fitted("softening_ratio", "d", 0.0, 0.8, 0.1), fixed("energy_scale_j", "W_m", 1e-4, 1.0, 0.02)],
    },
    EffectSpec {
        kind: Kind::CoilPreload,
        name: "coil_preload",
        title: "a close-wound coil opens under a force",
        element: ElementKind::Muscle,
        law: "F = F0 tanh(e/0.25 mm)",
        source: "initial tension of extension springs",
        parameters: &[fitted("preload_n", "F0", 0.0, 5.0, 0.05)],
    },
    EffectSpec {
        kind: Kind::PlasticSet,
        name: "plastic_set",
        title: "the muscle stays longer after a great elongation",
        element: ElementKind::Muscle,
        law: "de_p/dt = k max(0, e - e_lim), wall and coil see e - e_p",
        source: "flow beyond a threshold (Bingham)",
        parameters: &[fitted("set_rate_1_s", "k", 0.0, 1.0, 2e-3), fitted("threshold_m", "e_lim", 0.0, 0.2, 0.018)],
    },
    EffectSpec {
        kind: Kind::PressureFriction,
        name: "pressure_friction",
        title: "friction between tube and coil grows with pressure",
        element: ElementKind::Muscle,
        law: "F = m1 max(p, 0) z",
        source: "Coulomb friction under the wall's pressure on the coil",
        parameters: &[fitted("friction_per_pressure_n_pa", "m1", 0.0, 5e-6, 1e-7)],
    },
    EffectSpec {
        kind: Kind::CableSlack,
        name: "cable_slack",
        title: "free length before the cable pulls",
        element: ElementKind::Cable,
        law: "T = max(0, k (s - s0) + c ds/dt) for s > s0, else 0",
        source: "geometry",
        parameters: &[fitted("slack_length_m", "s0", 0.0, 2e-2, 5e-4)],
    },
    EffectSpec {
        kind: Kind::TendonFriction,
        name: "tendon_friction",
        title: "the cable loses tension along its wrap",
        element: ElementKind::Cable,
        law: "T_i = T_0 exp(-mu z sum |theta|), dz/dt = |v|/s0 (sgn v - z)",
        source: "Euler and Eytelwein",
        parameters: &[
            fitted("friction_coefficient", "mu", 0.0, 1.0, 0.1),
            fixed("presliding_m", "s0", 1e-6, 5e-3, super::tendon::SLIDING_LENGTH_M),
        ],
    },
    EffectSpec {
        kind: Kind::GravityLoad,
        name: "gravity_load",
        title: "a constant force: a weight that the scene does not know",
        element: ElementKind::Mechanism,
        law: "F = w along the muscle; tau = w r on a mechanism with cable lever r",
        source: "statics",
        parameters: &[fitted("weight_n", "w", -20.0, 20.0, 0.05)],
    },
    EffectSpec {
        kind: Kind::BearingFriction,
        name: "bearing_friction",
        title: "dry friction of the mechanism's bearing",
        element: ElementKind::Mechanism,
        law: "tau = tau_c z, dz/dt = |omega|/theta_pre (sgn omega - z)",
        source: "Dahl 1968",
        parameters: &[
            fitted("coulomb_torque_n_m", "tau_c", 0.0, 1e-1, 2e-4),
            fitted_from("presliding_rad", "theta_pre", 1e-4, 0.2, 0.01),
        ],
    },
    EffectSpec {
        kind: Kind::TendonCoupling,
        name: "tendon_coupling",
        title: "the forceps' cable bends the tube",
        element: ElementKind::Mechanism,
        law: "tau = lever T2 on the bending",
        source: "a cable off the neutral axis",
        parameters: &[fitted("lever_m", "lever", -3e-3, 3e-3, 3e-4)],
    },
    EffectSpec {
        kind: Kind::ExternalContact,
        name: "external_contact",
        title: "the mechanism meets something on its way",
        element: ElementKind::Mechanism,
        law: "tau = -k (theta - theta_0) beyond theta_0",
        source: "one-sided spring",
        parameters: &[fitted("stiffness_n_m_rad", "k", 0.0, 1.0, 1e-3), fitted("angle_rad", "theta_0", -4.0, 4.0, 0.6)],
    },
    EffectSpec {
        kind: Kind::NotchClosure,
        name: "notch_closure",
        title: "the notches of the tube close",
        element: ElementKind::Mechanism,
        law: "per hinge tau = -k (theta_i - theta_max) beyond theta_max",
        source: "geometry of the notch, h/(ro + ybar)",
        parameters: &[
            fitted("stiffness_n_m_rad", "k", 0.0, 1.0, 5e-2),
            fitted("angle_rad", "theta_max", 0.05, 1.0, 0.3),
        ],
    },
    EffectSpec {
        kind: Kind::SensorLag,
        name: "sensor_lag",
        title: "a channel is filtered",
        element: ElementKind::Sensor,
        law: "T dy/dt = u - y",
        source: "first-order filter",
        parameters: &[fitted("time_constant_s", "T", 0.0, 5.0, 0.05)],
    },
    EffectSpec {
        kind: Kind::SensorDelay,
        name: "sensor_lag",
        title: "a channel comes late",
        element: ElementKind::Sensor,
        law: "y(t) = u(t - d)",
        source: "pure delay",
        parameters: &[fitted("delay_s", "d", 0.0, 5.0, 0.03)],
    },
    EffectSpec {
        kind: Kind::SensorDrift,
        name: "sensor_drift",
        title: "a channel wanders in time",
        element: ElementKind::Sensor,
        law: "y = u + r (t - t0)",
        source: "linear drift",
        parameters: &[fitted("rate_per_s", "r", -1e3, 1e3, 0.01)],
    },
    EffectSpec {
        kind: Kind::SensorGain,
        name: "sensor_gain",
        title: "a channel has the wrong scale",
        element: ElementKind::Sensor,
        law: "y = (1 + g) u",
        source: "calibration error",
        parameters: &[fitted("gain_error", "g", -0.9, 5.0, 0.03)],
    },
    EffectSpec {
        kind: Kind::HypotheticalForce,
        name: "hypothetical_force",
        title: "a pull that no law of this list explains; found by regression",
        element: ElementKind::Muscle,
        law: "F = F_h (e/10 mm)^i (p/1 MPa)^j",
        source: "sparse regression, no law of nature",
        parameters: &[
            fitted("force_n", "F_h", -10.0, 10.0, 0.02),
            fixed("elongation_power", "i", 0.0, 4.0, 1.0),
            fixed("pressure_power", "j", 0.0, 4.0, 0.0),
        ],
    },
    EffectSpec {
        kind: Kind::HypotheticalFlow,
        name: "hypothetical_flow",
        title: "a flow that no law of this list explains; found by regression",
        element: ElementKind::Line,
        law: "Q = Q_h (p/1 MPa)^j",
        source: "sparse regression, no law of nature",
        parameters: &[fitted("flow_m3_s", "Q_h", -1e-8, 1e-8, 1e-11), fixed("pressure_power", "j", 0.0, 4.0, 2.0)],
    },
];

/// The entry of a law.
pub fn find(kind: Kind) -> &'static EffectSpec {
    match kind {
        Kind::Law(id) => &id.law().spec,
        kind => CATALOGUE.iter().find(|e| e.kind == kind).unwrap_or(&CATALOGUE[0]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_stands_once_and_starts_inside_its_range() {
        for (i, spec) in CATALOGUE.iter().enumerate() {
            assert!(CATALOGUE[..i].iter().all(|other| other.kind != spec.kind), "{}", spec.name);
            assert_eq!(find(spec.kind), spec);
            assert!(!spec.parameters.is_empty());
            for p in spec.parameters {
                let inside = |x: f64| x >= p.range.min && x <= p.range.max;
                assert!(inside(p.typical) && p.default.is_none_or(inside), "{} {}", spec.name, p.key);
            }
        }
    }
}
