//! The reduced-order model of a scene: the same elements on a mechanism reduced to its few coordinates.
//!
//! Hinges in series with equal lever, spring and damper become one coordinate, their sum; inertia is that of the start
//! pose, and so are weights where no cable runs over via points (`posed.rs`). Everything else - line, muscles, cables, effects, the integrator - is the code of the full scene, so the two
//! differ only by what the engine adds: pose-dependent inertia and contacts. Generic over [`Scalar`], so that
//! sensitivities to calibrated parameters and effects are exact.

mod alone;
mod course;
mod directions;
mod inject;
mod linear;
mod lump;
mod many;
mod output;
mod parameter;
mod plan;
mod slack;
mod steady;

use nalgebra::{DMatrix, DVector};

use crate::effects::Effect;
use crate::laws::Law;
use crate::mechanism::Mechanism;
use crate::scalar::Scalar;
use crate::scene::{MuscleSpec, Scene};

use super::build::{build, wrong_law};
use super::install::{Site, install, install_laws, settle_memory};
use super::laws::Visit;
use super::plant::{Drive, InputSpan, Plant, dot};
use super::posed;
use super::state::PlantState;
use super::{Schedule, SystemError};

use course::Course;
pub use inject::{Change, Signals};
pub use linear::{Block, Linear};
pub(super) use output::sensor;
use output::{RomOutput, Sensors};
pub use parameter::{MuscleNumber, RomParameter};
pub use plan::StepPlan;

/// What drives a [`Rom`]: times (s, increasing) and each input of the scene there, SI, straight between samples.
#[derive(Clone, Debug, PartialEq)]
pub struct RomRun {
    pub times_s: Vec<f64>,
    pub inputs: Vec<Vec<f64>>,
    /// Steps between samples; without a plan the model's own rule decides.
    pub plan: Option<StepPlan>,
}

impl RomRun {
    /// The scene's own programmes at the times of a schedule.
    pub fn of_programs(scene: &Scene, schedule: &Schedule) -> Self {
        let times_s = schedule.times();
        let inputs = scene.programs.iter().map(|p| times_s.iter().map(|&t| p.value(t)).collect()).collect();
        Self { times_s, inputs, plan: None }
    }
}

/// Parameters that differ from the scene's, and the effects.
#[derive(Clone, Debug, PartialEq)]
pub struct RomSetting<D> {
    pub parameters: Vec<(RomParameter, D)>,
    pub effects: Vec<Effect<D>>,
}

impl<D> Default for RomSetting<D> {
    fn default() -> Self {
        Self { parameters: Vec::new(), effects: Vec::new() }
    }
}

/// The reduced-order model of one scene (with one set of known conditions).
///
/// ```
/// use num_dual::Dual64;
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Rom, RomRun, RomSetting};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = Scene::load("muscle_bench", &[])?;
/// let rom = Rom::new(&scene)?;
/// let run = RomRun::of_programs(&scene, &Schedule::even(1.0, 0.01));
/// let c1 = rom.parameter("tube_c1_pa").ok_or("the bench has a tube")?;
/// let setting = RomSetting { parameters: vec![(c1, Dual64::new(0.255e6, 1.0))], effects: Vec::new() };
/// let series = rom.simulate_over(&run, &setting).ok_or("it diverges")?;
/// let elongation = rom.columns().position(|c| c == "elongation_mm").ok_or("an output")?;
/// let end = series[elongation].last().ok_or("there are samples")?;
/// // 2.6 mm, and 2.9 um less for each kPa of the silicone's C1.
/// assert!((end.re - 2.58).abs() < 0.05 && (end.eps + 2.9e-6).abs() < 0.3e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Rom {
    plant: Plant<f64>,
    state: PlantState<f64>,
    site: Site,
    outputs: Vec<RomOutput>,
    /// Of each joint coordinate: the scene's [[mechanism.joint]] table that sets its spring.
    spring_table: Vec<Option<usize>>,
    muscles: Vec<MuscleSpec>,
    cable_names: Vec<String>,
    pretension_n: Vec<f64>,
    initial_load_n: Vec<f64>,
    standalone: Option<super::standalone::Standalone>,
    /// Greatest step, s.
    pub step_s: f64,
}

/// Greatest step, s, and the angle by which the fastest cable may swing in one step, rad: beyond them the error passes
/// a thousandth of the range (`cargo bench --bench rom`).
const GREATEST_STEP_S: f64 = 2.0e-3;
const STEP_ANGLE: f64 = 2.7;

/// Steps are this much shorter over the first moments, where what was let go at once still rings.
const RINGING_S: f64 = 0.5;
const RINGING_STEPS: f64 = 4.0;

/// Angular frequency of the fastest swing of taut cables on their inertias, rad/s.
fn fastest_rad_s(plant: &Plant<f64>) -> f64 {
    let n = plant.dim();
    if n == 0 {
        return f64::MIN_POSITIVE;
    }
    let mut stiffness = DMatrix::<f64>::zeros(n, n);
    for cable in &plant.cables {
        let lever = DVector::from_column_slice(&cable.jacobian);
        stiffness += &lever * lever.transpose() * cable.stiffness_n_m;
    }
    let inertia = DMatrix::from_row_slice(n, n, &plant.coordinates.inertia);
    let Some(factor) = inertia.cholesky().map(|c| c.l()) else { return f64::MIN_POSITIVE };
    let Some(inverse) = factor.try_inverse() else { return f64::MIN_POSITIVE };
    let scaled = &inverse * stiffness * inverse.transpose();
    scaled.symmetric_eigenvalues().max().max(f64::MIN_POSITIVE).sqrt()
}

impl Rom {
    /// The reduced-order model of a scene.
    ///
    /// # Errors
    /// Scenes that have none: free bodies (their contacts need the engine), displacement models.
    pub fn new(scene: &Scene) -> Result<Self, SystemError> {
        let mut bare = scene.clone();
        bare.file.effect.clear();
        // Laws are put on the few coordinates below.
        let laws = std::mem::take(&mut bare.laws);
        let mechanism = match &bare.file.mechanism {
            Some(spec) => {
                let loaded = Mechanism::load(spec, bare.folder());
                Some(loaded.map_err(|source| SystemError::Mechanism { file: bare.path.clone(), source })?)
            }
            None => None,
        };
        let built = build(&bare, mechanism.as_ref())?;
        lump::refuse_what_has_none(&bare, &built)?;
        let mut lumped = lump::lump(scene, mechanism.as_ref(), built)?;
        let wraps = bare.file.cable.iter().map(|c| c.sheath_angle_rad).collect();
        let joints = (lumped.names.clone(), lumped.slides.clone());
        let site = Site::of(&lumped.plant, joints, lumped.hinges.clone(), wraps);
        install_laws(&mut lumped.plant, &site, &laws).map_err(|wrong| wrong_law(scene, wrong))?;
        let outputs = bare.file.output.iter().map(|o| output::resolve(scene, o, &lumped)).collect::<Result<_, _>>()?;
        Ok(Self {
            site,
            outputs,
            spring_table: lumped.spring_table,
            muscles: bare.file.muscle.clone(),
            cable_names: bare.file.cable.iter().map(|c| c.name.clone()).collect(),
            pretension_n: bare.file.cable.iter().map(|c| c.pretension_n).collect(),
            initial_load_n: bare.makes.iter().map(|m| m.initial_load_n).collect(),
            standalone: super::standalone::Standalone::of(scene),
            step_s: GREATEST_STEP_S.min(STEP_ANGLE / fastest_rad_s(&lumped.plant)),
            plant: lumped.plant,
            state: lumped.state,
        })
    }

    /// Columns of the outputs, in order.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.outputs.iter().map(|o| o.column.as_str())
    }

    /// Names of the joints that are coordinates of their own and share a cable with another one.
    pub(crate) fn joints_that_share_a_cable(&self) -> Vec<&str> {
        let joints = self.site.joints;
        let turns = |jacobian: &[f64], i: usize| jacobian[i] != 0.0;
        let shares = |i: usize| {
            let mut cables = self.plant.cables.iter().map(|cable| &cable.jacobian[..joints]);
            cables.any(|own| turns(own, i) && (0..joints).any(|other| other != i && turns(own, other)))
        };
        let names = self.site.names.iter().enumerate().filter(|(i, _)| shares(*i));
        names.filter_map(|(_, names)| if let [name] = names.as_slice() { Some(name.as_str()) } else { None }).collect()
    }

    /// The parameter behind a scene key; `None` when the reduced-order model cannot vary it.
    pub fn parameter(&self, key: &str) -> Option<RomParameter> {
        parameter::resolve(self, &crate::scene::calibration_key(key))
    }

    /// Simulates; returns each output at the run's times, in the unit of its column. `None` when it diverges.
    pub fn simulate(&self, run: &RomRun, setting: &RomSetting<f64>) -> Option<Vec<Vec<f64>>> {
        self.simulate_over(run, setting)
    }

    /// The same over another type of number, as dual numbers, which carry derivatives.
    pub fn simulate_over<D: Scalar>(&self, run: &RomRun, setting: &RomSetting<D>) -> Option<Vec<Vec<D>>> {
        if let Some(element) = &self.standalone {
            return self.alone(element, run, setting, |_, _| {});
        }
        let mut sensors = Sensors::new(&self.outputs, setting);
        let mut series: Vec<Vec<D>> = vec![Vec::with_capacity(run.times_s.len()); self.outputs.len()];
        let mut room = None;
        self.watch(run, setting, |k, plant, state, spans| {
            for (output, series) in self.outputs.iter().zip(&mut series) {
                series.push(sensors.show(output, run.times_s[k], output.read(plant, state, spans, &mut room)));
            }
        })?;
        output::are_shown(&self.outputs, setting, &series).then_some(series)
    }

    /// Series of the first variable of each law over a run, SI; empty where the rig cannot have the law. `None` when the model
    /// diverges.
    pub fn visited(&self, run: &RomRun, setting: &RomSetting<f64>, laws: &[Law]) -> Option<Vec<Vec<f64>>> {
        if let Some(element) = &self.standalone {
            return Some(self.visited_alone(element, run, setting, laws));
        }
        let (plant, _) = self.prepare(setting);
        let mut visit = Visit::new(&plant, &self.site, laws);
        self.watch(run, setting, |_, plant, state, inputs| visit.see(plant, state, inputs))?;
        Some(visit.series)
    }

    /// Simulates and shows plant, state and inputs at every sample. `None` when it diverges.
    fn watch<D: Scalar>(
        &self,
        run: &RomRun,
        setting: &RomSetting<D>,
        mut show: impl FnMut(usize, &Plant<D>, &PlantState<D>, &[InputSpan]),
    ) -> Option<()> {
        let (mut plant, state) = self.prepare(setting);
        let mut course = Course::new(&mut plant, state, run);
        for k in 0..run.times_s.len() {
            if k > 0 {
                course.advance(&mut plant, run, k, self.steps_in(run, k));
                if !course.is_sound(&plant) {
                    return None;
                }
            }
            show(k, &plant, &course.state, &course.spans);
        }
        Some(())
    }

    /// The same model with sensors as they are made.
    fn without_laws_of_sensors(&self) -> Self {
        let mut bare = self.clone();
        bare.outputs.iter_mut().for_each(|output| output.laws.clear());
        bare
    }

    /// The plant with its parameters and effects, at its start.
    fn prepare<D: Scalar>(&self, setting: &RomSetting<D>) -> (Plant<D>, PlantState<D>) {
        let mut plant: Plant<D> = self.plant.lift();
        let mut state: PlantState<D> = self.state.lift();
        for (parameter, value) in &setting.parameters {
            parameter.put(*value, &mut plant);
        }
        self.settle_start(&mut plant, &mut state);
        for effect in &setting.effects {
            install(&mut plant, &self.site, effect);
        }
        settle_memory(&mut plant, &mut state);
        posed::begin(&mut plant, &state);
        (plant, state)
    }

    /// Pressures that hold the start elongations, and cables at their pretension, with the parameters as they are.
    fn settle_start<D: Scalar>(&self, plant: &mut Plant<D>, state: &mut PlantState<D>) {
        for (i, muscle) in plant.muscles.iter().enumerate() {
            if let Drive::Hydraulic { .. } = muscle.drive {
                let elongation = dot::<_, 0>(&muscle.jacobian, state.y()) + muscle.elongation_0_m;
                let pressure = muscle.elastic.holding_pressure_pa(elongation, D::constant(self.initial_load_n[i]));
                state.pressures_mut(i).fill(pressure);
            }
        }
        for (i, cable) in plant.cables.iter_mut().enumerate() {
            let stretch = dot::<_, 0>(&cable.jacobian, state.y());
            cable.stretch_0_m = cable.stiffness_n_m.recip() * self.pretension_n[i] - stretch;
        }
    }
}
