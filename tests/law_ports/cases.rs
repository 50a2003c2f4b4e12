//! What a law does at each port of a rig where that is known by hand.

use smam::laws::Port;

use crate::rig::{SAMPLE_S, Series};

/// What must come out.
pub enum Truth {
    /// The same as of a scene without the law and with these settings.
    Same(&'static [&'static str]),
    /// What holds of the run with the law, and of the same without.
    Holds(fn(&Series, &Series)),
}

pub struct Case {
    pub port: Port,
    pub rig: &'static str,
    /// Settings of both scenes.
    pub sets: &'static [&'static str],
    pub laws: &'static [&'static str],
    pub truth: Truth,
    /// Channels that show the law itself, and are not compared.
    pub but_for: &'static [&'static str],
    /// Of the channels' ranges.
    pub within: f64,
}

/// A muscle at a fixed length with its plunger still: its wall held, so that the fluid has but two compliances.
const HELD: &[&str] = &["muscles.tube.wall=held", "input.0.program={kind=\"constant\",value_m=0.0}", MUSCLE_PRESSURE];
const MUSCLE_PRESSURE: &str = "output=[{channel=\"pressure_kpa\",quantity=\"syringe_pressure\",of=[\"muscle\"]},{channel=\"muscle_kpa\",quantity=\"muscle_pressure\",of=[\"muscle\"]},{channel=\"force_n\",quantity=\"pull\",of=[\"muscle\"]}]";
/// The bench with a ramp that starts at once.
const BENCH: &[&str] = &[];
/// Cables that a drive moves at once.
const SHEATH: &[&str] = &[];

const fn same(
    port: Port,
    (rig, sets): (&'static str, &'static [&'static str]),
    laws: &'static [&'static str],
    truth: &'static [&'static str],
) -> Case {
    Case { port, rig, sets, laws, truth: Truth::Same(truth), but_for: &[], within: 1e-9 }
}

const fn holds(
    port: Port,
    (rig, sets): (&'static str, &'static [&'static str]),
    laws: &'static [&'static str],
    truth: fn(&Series, &Series),
) -> Case {
    Case { port, rig, sets, laws, truth: Truth::Holds(truth), but_for: &[], within: 0.0 }
}

const HELD_RIG: (&str, &[&str]) = ("muscle_blocked", HELD);
const BENCH_RIG: (&str, &[&str]) = ("muscle_bench", BENCH);
const SHEATH_RIG: (&str, &[&str]) = ("tendon_sheath", SHEATH);
const PULLEY_RIG: (&str, &[&str]) = ("antagonistic_pulley", &[]);
const AXIS_RIG: (&str, &[&str]) = ("driven_axis", &[]);
const STRIP_RIG: (&str, &[&str]) = ("tensile_test", &[]);
const CATHETER_RIG: (&str, &[&str]) = ("bending_catheter", &[]);

/// Every port, most of them more than once.
pub const CASES: &[Case] = &[
    // A plunger that goes on by itself: half a millimetre in 2.5 s.
    Case {
        within: 1e-6,
        ..same(
            Port::Plunger,
            ("muscle_bench", &["input.0.program={kind=\"ramp_hold\",to_m=1.0e-3,rise_s=10.0}"]),
            &["plunger adds 1e-4 * time_s"],
            &["input.0.program={kind=\"ramp_hold\",to_m=2.0e-3,rise_s=10.0}"],
        )
    },
    // A yielding drive is a compliance A c, A the syringe's 15.904 mm2; of a drive that follows the commanded position, half of it.
    same(
        Port::Plunger,
        BENCH_RIG,
        &["plunger adds -1e-10 * pressure_pa"],
        &["hydraulics.upstream_compliance_m3_pa=9.590431280879833e-15"],
    ),
    Case {
        within: 1e-6,
        ..same(
            Port::Plunger,
            BENCH_RIG,
            &["plunger adds -0.5 * plunger_m"],
            &["input.0.program={kind=\"sine\",stroke_m=1.5e-3,frequency_hz=0.1}"],
        )
    },
    holds(Port::SyringeFlow, HELD_RIG, &["syringe.flow adds 1e-15 * pressure_pa"], |law, _| {
        decays(law, 1.06e-14 / 1e-15)
    }),
    same(
        Port::SyringeCompliance,
        BENCH_RIG,
        &["syringe.compliance scales 1.25"],
        &["hydraulics.upstream_compliance_m3_pa=10e-15"],
    ),
    same(
        Port::SyringeCompliance,
        BENCH_RIG,
        &["syringe.compliance adds 2e-15"],
        &["hydraulics.upstream_compliance_m3_pa=10e-15"],
    ),
    // At rest the pressures differ by what is added.
    holds(Port::PressureDrop, HELD_RIG, &["line.pressure_drop adds 2.0e4"], |law, _| {
        near(law.last("pressure_kpa") - law.last("muscle_kpa"), 20.0, 1e-6);
    }),
    same(
        Port::PressureDrop,
        BENCH_RIG,
        &["line.pressure_drop scales 200.0"],
        &["hydraulics.fluid.viscosity_pa_s=0.2004"],
    ),
    same(Port::Resistance, BENCH_RIG, &["line.resistance scales 200.0"], &["hydraulics.fluid.viscosity_pa_s=0.2004"]),
    same(
        Port::Resistance,
        BENCH_RIG,
        &["line.resistance scales 100.0", "line.resistance scales 2.0"],
        &["hydraulics.fluid.viscosity_pa_s=0.2004"],
    ),
    same(
        Port::Inertance,
        ("muscle_bench", &["hydraulics.line.segments=3", "hydraulics.line.compliance_m3_pa=1e-15"]),
        &["line.inertance scales 0.75"],
        &["hydraulics.line.momentum_factor=1.0"],
    ),
    holds(Port::Outflow, HELD_RIG, &["line.outflow adds 1e-15 * pressure_pa"], |law, _| decays(law, 1.06e-14 / 1e-15)),
    same(
        Port::LineCompliance,
        BENCH_RIG,
        &["line.compliance scales 2.0"],
        &["hydraulics.downstream_compliance_m3_pa=5.2e-15"],
    ),
    same(
        Port::LineCompliance,
        BENCH_RIG,
        &["line.compliance adds 2.6e-15"],
        &["hydraulics.downstream_compliance_m3_pa=5.2e-15"],
    ),
    Case {
        but_for: &["force_n"],
        ..same(Port::Pull, BENCH_RIG, &["muscle.pull adds -0.02"], &["load.0.force_n=0.07"])
    },
    // As the fluid is withdrawn the muscle, held, begins to pull.
    holds(Port::Pull, ("muscle_blocked", &[]), &["muscle.pull scales 0.9"], |law, stock| {
        near(law.last("force_n"), 0.9 * stock.last("force_n"), 1e-9);
    }),
    same(
        Port::Wall,
        BENCH_RIG,
        &["muscle.wall scales 1.1"],
        &["muscles.tube.material={law=\"yeoh\",c1_pa=0.2805e6,c2_pa=0.01705e6,c3_pa=0.0}"],
    ),
    same(Port::Coil, BENCH_RIG, &["muscle.coil scales 1.2"], &["muscles.tube.coil.stiffness_n_m=33.96"]),
    same(Port::Coil, BENCH_RIG, &["muscle.coil adds 5.66 * elongation_m"], &["muscles.tube.coil.stiffness_n_m=33.96"]),
    same(
        Port::Friction,
        BENCH_RIG,
        &["muscle.friction scales 1.5"],
        &["muscles.friction.m0_n=0.159", "muscles.friction.m1_n_pa=0.333e-6"],
    ),
    same(Port::Friction, BENCH_RIG, &["muscle.friction adds 0.053"], &["muscles.friction.m0_n=0.159"]),
    same(Port::Damping, BENCH_RIG, &["muscle.damping scales 50"], &["muscles.damping_n_s_m=5.0"]),
    // Where a law makes force of speed, tangents are taken at every step: no longer the same steps to rounding.
    Case {
        within: 2e-6,
        ..same(Port::Damping, BENCH_RIG, &["muscle.damping adds 4.9 * speed_m_s"], &["muscles.damping_n_s_m=5.0"])
    },
    same(Port::Area, BENCH_RIG, &["muscle.area scales 1 + 2.0 * elongation_m"], &["muscles.tube.area_growth_1_m=1.0"]),
    // 0.866 mm2 of 7.2 MPa, and a tenth of it.
    holds(Port::Area, HELD_RIG, &["muscle.area scales 1.1"], |law, stock| {
        let area_m2 = std::f64::consts::FRAC_PI_4 * 1.05e-3_f64.powi(2);
        let more_n = 0.1 * area_m2 * 1e3 * stock.last("muscle_kpa");
        near(stock.last("force_n") - law.last("force_n"), more_n, 1e-9);
    }),
    // Once all has come to rest, a muscle without friction is longer by just so much.
    Case {
        sets: &[
            "muscles.friction.m0_n=0.0",
            "muscles.friction.m1_n_pa=0.0",
            "input.0.program={kind=\"ramp_hold\",to_m=1.0e-3,rise_s=1.0}",
            "muscles.damping_n_s_m=3.0",
        ],
        ..holds(Port::RestLength, BENCH_RIG, &["muscle.rest_length adds 1e-3"], |law, stock| {
            // The fluid is where it was: what the piston has brought in fills 1 mm more of the bore at a lower pressure.
            let more_mm = law.last("elongation_mm") - stock.last("elongation_mm");
            let area_m2 = std::f64::consts::FRAC_PI_4 * 1.05e-3_f64.powi(2);
            let lower_pa = 1e3 * (stock.last("pressure_kpa") - law.last("pressure_kpa"));
            near(1.06e-14 * lower_pa, area_m2 * more_mm * 1e-3, 1e-5);
            assert!(more_mm > 0.02 && more_mm < 1.0, "{more_mm}");
        })
    },
    same(
        Port::Tension,
        PULLEY_RIG,
        &["cable.tension scales 1.5"],
        &[
            "cable.cable_1.stiffness_n_m=6000.0",
            "cable.cable_2.stiffness_n_m=6000.0",
            "cable.cable_1.damping_n_s_m=0.6",
            "cable.cable_2.damping_n_s_m=0.6",
        ],
    ),
    // Cable 1 turns the pulley along +angle on 8 mm.
    Case {
        but_for: &["tension_1_n"],
        ..same(
            Port::Tension,
            SHEATH_RIG,
            &["cable_1.tension adds 0.5"],
            &["load=[{joint=\"pulley\",torque_n_m=0.004}]"],
        )
    },
    same(Port::Stretch, SHEATH_RIG, &["cable_2.stretch adds 1e-3"], &["cable.tendon_2.pretension_n=6.5"]),
    same(
        Port::CableStiffness,
        PULLEY_RIG,
        &["cable.stiffness scales 1.5"],
        &["cable.cable_1.stiffness_n_m=6000.0", "cable.cable_2.stiffness_n_m=6000.0"],
    ),
    same(
        Port::Lever,
        SHEATH_RIG,
        &["cable.lever scales 1.25"],
        &["cable.tendon_1.route.lever.0.lever_m=0.010", "cable.tendon_2.route.lever.0.lever_m=-0.010"],
    ),
    same(
        Port::Lever,
        SHEATH_RIG,
        &["cable.lever adds 0.002"],
        &["cable.tendon_1.route.lever.0.lever_m=0.010", "cable.tendon_2.route.lever.0.lever_m=-0.010"],
    ),
    // At rest the tip's spring holds what arrives of the tensions.
    holds(
        Port::Transmission,
        ("tendon_sheath", &["input.0.program={kind=\"ramp_hold\",to_rad=0.5,rise_s=1.0}"]),
        &["cable_1.transmission scales 0.8", "cable_1.transmission adds 0.05"],
        |law, _| {
            let torque_n_m = 0.008 * (0.85 * law.last("tension_1_n") - law.last("tension_2_n"));
            near(0.05 * law.last("tip_deg").to_radians(), torque_n_m, 1e-6);
        },
    ),
    same(Port::Torque, PULLEY_RIG, &["joint.torque adds 1e-3"], &["load=[{joint=\"pulley\",torque_n_m=1e-3}]"]),
    same(Port::Torque, BENCH_RIG, &["joint.torque adds 0.02"], &["load.0.force_n=0.07"]),
    same(
        Port::Torque,
        SHEATH_RIG,
        &["joint.torque scales 2.0"],
        &["mechanism.joint.0.stiffness_n_m_rad=0.1", "mechanism.joint.0.damping_n_m_s_rad=2.0e-3"],
    ),
    same(
        Port::JointStiffness,
        SHEATH_RIG,
        &["joint.stiffness scales 2.0"],
        &["mechanism.joint.0.stiffness_n_m_rad=0.1"],
    ),
    // Its cables begin with no tension at all: rounding decides in which step they first pull.
    Case {
        within: 1e-5,
        ..same(
            Port::JointStiffness,
            CATHETER_RIG,
            &["joint.stiffness scales 1.5"],
            &["mechanism.joint.0.stiffness_n_m_rad=12.6e-3"],
        )
    },
    same(
        Port::JointDamping,
        SHEATH_RIG,
        &["joint.damping scales 5.0"],
        &["mechanism.joint.0.damping_n_m_s_rad=5.0e-3"],
    ),
    Case {
        within: 1e-5,
        ..same(
            Port::JointDamping,
            CATHETER_RIG,
            &["joint.damping scales 5.0"],
            &["mechanism.joint.0.damping_n_m_s_rad=8.0e-4"],
        )
    },
    same(Port::AxisForce, AXIS_RIG, &["axis.force adds 50.0 * speed_m_s"], &["axis.damping_n_s_m=50.0"]),
    same(Port::AxisForce, AXIS_RIG, &["axis.force scales 1.5"], &["axis.piston_area_m2=7.5e-4"]),
    same(
        Port::AxisFriction,
        AXIS_RIG,
        &["axis.friction adds 2.0 + 1e-5 * pressure_pa"],
        &["effect=[{name=\"seal_friction\",element=\"syringe\",friction_force_n=2.0,friction_per_pressure_n_pa=1e-5}]"],
    ),
    same(
        Port::AxisFriction,
        ("driven_axis", &["effect=[{name=\"seal_friction\",element=\"syringe\",friction_force_n=2.0}]"]),
        &["axis.friction scales 1.5"],
        &[
            "effect=[{name=\"seal_friction\",element=\"syringe\",friction_force_n=3.0,friction_per_pressure_n_pa=1.5e-5}]",
        ],
    ),
    // Memory goes on from sample to sample: the force of a spring whose end follows with a play.
    holds(
        Port::AxisForce,
        AXIS_RIG,
        &[
            "port = 'axis.force'\nname = 'play'\nadds = '100.0 * s'\nstate.s = { play_of = 'position_m', width = '4e-3' }",
        ],
        |law, stock| near(law.last("force_n") - stock.last("force_n"), 100.0 * (0.025 - 2e-3), 1e-6),
    ),
    same(Port::StripForce, STRIP_RIG, &["strip.force scales 1.5"], &["strip.material.c1_pa=7.5e4"]),
    holds(Port::StripForce, STRIP_RIG, &["strip.force adds -1.0"], |law, stock| {
        let pairs = law.of("force_n").iter().zip(stock.of("force_n"));
        assert!(pairs.clone().all(|(a, b)| (a - (b - 1.0).max(0.0)).abs() < 1e-12));
    }),
    Case {
        within: 1e-6,
        ..same(
            Port::ChamberOutflow,
            ("closed_chamber", &[]),
            &["chamber.outflow adds 0.2 * pressure_pa"],
            &["effect=[{name=\"leak\",element=\"line\",rate_1_s=0.2}]"],
        )
    },
    // Beside a leak of the catalogue the rates add up.
    Case {
        within: 1e-6,
        ..same(
            Port::ChamberOutflow,
            ("closed_chamber", &["effect=[{name=\"leak\",element=\"line\",rate_1_s=0.2}]"]),
            &["chamber.outflow adds 0.3 * pressure_pa"],
            &["effect=[{name=\"leak\",element=\"line\",rate_1_s=0.5}]"],
        )
    },
    holds(Port::Sensor, SHEATH_RIG, &["sensor.tip_deg scales 1.1", "sensor.tip_deg adds 0.1"], |law, stock| {
        let pairs = law.of("tip_deg").iter().zip(stock.of("tip_deg"));
        let offset_deg = 0.1_f64.to_degrees();
        assert!(pairs.clone().all(|(a, b)| (a - 1.1 * b - offset_deg).abs() < 1e-9));
    }),
];

/// A pressure that goes down with one time constant; the drop over the line, a ten thousandth of it, is left out.
fn decays(law: &Series, time_constant_s: f64) {
    let pressures = law.of("pressure_kpa");
    for (i, p) in pressures.iter().enumerate().skip(20) {
        let expected = pressures[0] * (-SAMPLE_S * i as f64 / time_constant_s).exp();
        near(*p, expected, 5e-4);
    }
}

/// To a share of what is expected.
fn near(found: f64, expected: f64, share: f64) {
    assert!((found / expected - 1.0).abs() <= share, "{found} instead of {expected}");
}
