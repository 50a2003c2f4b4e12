//! Numbers of the stock rigs, written down here once more: the concealing side shares no code with the scenes.

use std::f64::consts::PI;

pub const ATMOSPHERE_PA: f64 = 101_325.0;
/// Gauge pressure at which water boils at 20 degC, Pa.
pub const BOILING_PA: f64 = 2.3e3 - ATMOSPHERE_PA;

pub const REST_LENGTH_M: f64 = 0.05;
pub const INNER_RADIUS_M: f64 = 0.255e-3;
pub const OUTER_RADIUS_M: f64 = 0.525e-3;
pub const COIL_AREA_M2: f64 = PI * OUTER_RADIUS_M * OUTER_RADIUS_M;
pub const COIL_STIFFNESS_N_M: f64 = 28.3;
pub const YEOH_C2_PA: f64 = 0.0155e6;

pub const SYRINGE_AREA_M2: f64 = PI * 4.5e-3 * 4.5e-3 / 4.0;
pub const DOWNSTREAM_COMPLIANCE_M3_PA: f64 = 2.6e-15;
const LINE_LENGTH_M: f64 = 1.0;
const LINE_BORE_M: f64 = 0.8e-3;
const VISCOSITY_PA_S: f64 = 1.002e-3;
const DENSITY_KG_M3: f64 = 998.0;

pub const END_MASS_KG: f64 = 5.0e-3;
pub const AXIAL_DAMPING_N_S_M: f64 = 0.1;
pub const STRING_LOAD_N: f64 = 0.05;
pub const CLOSED_COIL_N_M: f64 = 2.0e4;
pub const CLOSED_COIL_N_S_M: f64 = 3.0;

pub const CABLE_N_M: f64 = 4000.0;
pub const CABLE_N_S_M: f64 = 0.4;

/// Hagen-Poiseuille resistance of the line, Pa s/m³.
pub fn line_resistance() -> f64 {
    128.0 * VISCOSITY_PA_S * LINE_LENGTH_M / (PI * LINE_BORE_M.powi(4))
}

/// Inertance of laminar flow in the line, Pa s²/m³.
pub fn line_inertance() -> f64 {
    4.0 / 3.0 * DENSITY_KG_M3 * LINE_LENGTH_M / (PI * LINE_BORE_M * LINE_BORE_M / 4.0)
}

/// What a lab cannot know: the numbers that a rig's own copies differ in.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Calibration {
    pub tube_c1_pa: f64,
    pub upstream_compliance_m3_pa: f64,
    pub friction_m0_n: f64,
    pub friction_m1_n_pa: f64,
    pub presliding_length_m: f64,
}

impl Calibration {
    pub const STOCK: Self = Self {
        tube_c1_pa: 0.255e6,
        upstream_compliance_m3_pa: 8.0e-15,
        friction_m0_n: 0.106,
        friction_m1_n_pa: 0.222e-6,
        presliding_length_m: 5.2e-3,
    };
    pub const COUNT: usize = 5;

    /// Each number times its factor.
    pub fn scaled(&self, by: [f64; Self::COUNT]) -> Self {
        Self {
            tube_c1_pa: self.tube_c1_pa * by[0],
            upstream_compliance_m3_pa: self.upstream_compliance_m3_pa * by[1],
            friction_m0_n: self.friction_m0_n * by[2],
            friction_m1_n_pa: self.friction_m1_n_pa * by[3],
            presliding_length_m: self.presliding_length_m * by[4],
        }
    }
}

/// The rigs.
///
/// ```
/// use smam::conceal::Rig;
/// use smam::scene::Scene;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // Both sides agree on what goes in and on what is shown, and on nothing else.
/// for rig in Rig::ALL {
///     let scene = Scene::load(rig.scene(), &[])?;
///     assert!(scene.file.input.iter().map(|i| i.channel.as_str()).eq(rig.inputs().iter().copied()));
///     let is_known = |shown: &smam::conceal::Output| scene.file.output.iter().any(|o| o.channel == shown.column);
///     assert!(rig.outputs().iter().chain(rig.more_sensors()).all(is_known));
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rig {
    MuscleBench,
    AntagonisticPulley,
    BendingCatheter,
}

/// One column that a rig records, and the standard deviation of its sensor's noise, in the column's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    pub column: &'static str,
    pub noise_sd: f64,
}

const fn output(column: &'static str, noise_sd: f64) -> Output {
    Output { column, noise_sd }
}

impl Rig {
    pub const ALL: [Self; 3] = [Self::MuscleBench, Self::AntagonisticPulley, Self::BendingCatheter];

    /// Name of its scene.
    pub fn scene(self) -> &'static str {
        match self {
            Self::MuscleBench => "muscle_bench",
            Self::AntagonisticPulley => "antagonistic_pulley",
            Self::BendingCatheter => "bending_catheter",
        }
    }

    pub fn muscles(self) -> usize {
        self.inputs().len()
    }

    pub fn inputs(self) -> &'static [&'static str] {
        match self {
            Self::MuscleBench => &["plunger_mm"],
            _ => &["plunger_1_mm", "plunger_2_mm"],
        }
    }

    pub fn outputs(self) -> &'static [Output] {
        const P1: Output = output("pressure_1_kpa", 5.0);
        const P2: Output = output("pressure_2_kpa", 5.0);
        const BENCH: [Output; 2] = [output("elongation_mm", 0.02), output("pressure_kpa", 5.0)];
        const PULLEY: [Output; 3] = [output("angle_deg", 0.08), P1, P2];
        const CATHETER: [Output; 4] = [output("bend_deg", 0.15), output("jaw_deg", 0.15), P1, P2];
        match self {
            Self::MuscleBench => &BENCH,
            Self::AntagonisticPulley => &PULLEY,
            Self::BendingCatheter => &CATHETER,
        }
    }

    /// What it can be given more, for a further run: load cells.
    pub fn more_sensors(self) -> &'static [Output] {
        const BENCH: [Output; 1] = [output("force_n", 0.02)];
        const PULLEY: [Output; 2] = [output("tension_1_n", 0.02), output("tension_2_n", 0.02)];
        match self {
            Self::MuscleBench => &BENCH,
            Self::AntagonisticPulley => &PULLEY,
            Self::BendingCatheter => &[],
        }
    }

    /// Elongation at which the muscles start, m.
    pub fn start_elongation_m(self) -> f64 {
        match self {
            Self::MuscleBench => 0.0,
            Self::AntagonisticPulley => 0.025,
            Self::BendingCatheter => 0.035,
        }
    }

    /// Plunger strokes, m: from, to, of each input.
    pub fn strokes_m(self) -> &'static [(f64, f64)] {
        match self {
            Self::MuscleBench => &[(0.0, 2.9e-3)],
            Self::AntagonisticPulley => &[(-0.9e-3, 0.9e-3), (-0.9e-3, 0.9e-3)],
            Self::BendingCatheter => &[(-1.2e-3, 0.0), (-0.7e-3, 0.0)],
        }
    }
}
