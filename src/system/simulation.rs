//! A scene in time: fine steps of the plant inside steps of the rigid-body engine.

use nalgebra::DMatrix;

use crate::mechanism::Mechanism;
use crate::recording::LONGEST_LOST_S;
use crate::scene::Scene;

use super::build::{Built, build};
use super::energy::EnergyBalance;
use super::laws::PlantLaws;
use super::plant::InputSpan;
use super::rosenbrock::Stepper;
use super::{InputSource, SystemError};

mod engine;

/// A scene that runs.
///
/// Over one engine step `h` the plant is integrated at `h/substeps` with the mechanism's inertia and levers taken at
/// the start of the step. The engine is then given the mean generalised force that carries it to the same positions;
/// what contacts add comes back as a change of velocity and, for the next step, as a known force.
///
/// A clone is a snapshot: it goes on as the original would, bit for bit.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::Simulation;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
/// simulation.keep_energy_balance();
/// simulation.advance_to(1.0)?;
/// let elongation_m = simulation.joint_position("slide").ok_or("the carriage slides")?;
/// assert!((2e-3..3e-3).contains(&elongation_m));
/// let balance = simulation.energy_balance().ok_or("it was kept")?;
/// assert!(balance.unaccounted_j().abs() < 1e-3 * balance.turnover_j());
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct Simulation {
    pub(super) scene: Scene,
    pub(super) mechanism: Option<Mechanism>,
    pub(super) built: Built,
    stepper: Stepper<f64>,
    pub(super) inputs: Vec<InputSource>,
    pub(super) spans: Vec<InputSpan>,
    pub(super) time_s: f64,
    /// Reaction of contacts (and Coriolis forces) on the joint coordinates over the last step.
    known_force: Vec<f64>,
    /// Whether a link touched something at the end of the last step.
    touching: bool,
    /// Impulse of the foreseen contact over the step so far, along its direction.
    contact_impulse: f64,
    weight: Vec<f64>,
    loads: Vec<f64>,
    inertia: DMatrix<f64>,
    positions: Vec<f64>,
    target: Vec<f64>,
    /// States of the displacement models, in the order of `built.displacements`.
    hysteresis: Vec<Vec<f64>>,
    has_stepped: bool,
    pub(super) energy: Option<EnergyBalance>,
    /// Where muscles are drawn, m.
    pub(super) anchors_m: Vec<[f64; 3]>,
}

impl Simulation {
    /// Builds a scene at its start, driven by its stock programmes.
    pub fn new(scene: Scene) -> Result<Self, SystemError> {
        let mechanism = match &scene.file.mechanism {
            Some(spec) => {
                let loaded = Mechanism::load(spec, scene.folder());
                Some(loaded.map_err(|source| SystemError::Mechanism { file: scene.path.clone(), source })?)
            }
            None => None,
        };
        let built = build(&scene, mechanism.as_ref())?;
        let joints = mechanism.as_ref().map_or(0, |m| m.coordinates().len());
        let stepper = Stepper::new(&built.plant, &built.state);
        let inputs: Vec<_> = scene.programs.iter().cloned().map(InputSource::Program).collect();
        let mut simulation = Self {
            stepper,
            spans: vec![InputSpan::default(); inputs.len() + built.displacements.len()],
            inputs,
            time_s: 0.0,
            known_force: vec![0.0; joints],
            touching: false,
            contact_impulse: 0.0,
            weight: vec![0.0; joints],
            loads: vec![0.0; joints],
            inertia: DMatrix::zeros(joints, joints),
            positions: vec![0.0; joints],
            target: vec![0.0; joints],
            hysteresis: vec![Vec::new(); built.displacements.len()],
            has_stepped: false,
            energy: None,
            anchors_m: Vec::new(),
            scene,
            mechanism,
            built,
        };
        simulation.resolve_loads()?;
        simulation.hold_spans();
        simulation.anchors_m = simulation.place_muscles();
        simulation.check_laws()?;
        Ok(simulation)
    }

    fn resolve_loads(&mut self) -> Result<(), SystemError> {
        for load in self.scene.file.load.clone() {
            self.add_load(&load.joint, load.force_n.or(load.torque_n_m).unwrap_or(0.0))?;
        }
        Ok(())
    }

    /// Loads a joint with so much more, N of a slider or N m of a hinge, from the next step on.
    ///
    /// # Errors
    /// A joint that is none, or not free.
    pub fn add_load(&mut self, joint: &str, load: f64) -> Result<(), SystemError> {
        let coordinates = self.mechanism.as_ref().map_or(&[][..], Mechanism::coordinates);
        let Some(i) = coordinates.iter().position(|c| c.name == joint) else {
            let known: Vec<&str> = coordinates.iter().map(|c| c.name.as_str()).collect();
            return Err(SystemError::Name {
                file: self.scene.path.clone(),
                table: "[[load]]".to_owned(),
                message: format!("joint = \"{joint}\" is no free joint of the mechanism"),
                remedy: match known.is_empty() {
                    true => "unlock a joint, or remove this table: the mechanism has no free one".to_owned(),
                    false => format!("use one of: {}", known.join(", ")),
                },
            });
        };
        self.loads[i] += load;
        Ok(())
    }

    /// Position of a free joint, rad or m; none of a joint that is not one.
    pub fn joint_position(&self, joint: &str) -> Option<f64> {
        let coordinates = self.mechanism.as_ref()?.coordinates();
        coordinates.iter().position(|c| c.name == joint).map(|i| self.built.state.y()[i])
    }

    /// Replaces the programme of an input; nothing happens if there is no such channel.
    pub fn set_input(&mut self, channel: &str, source: InputSource) {
        if let Some(i) = self.scene.file.input.iter().position(|c| c.channel == channel) {
            self.inputs[i] = source;
            self.hold_spans();
        }
    }

    /// Starts the clock elsewhere than at zero: a recording's first instant, or that of an input of which the first samples were lost
    /// and put back ([`crate::recording::Recording::piecewise_si`]).
    pub(crate) fn start_at(&mut self, time_s: f64) {
        let begin_s = self.inputs.iter().filter_map(InputSource::begins_s).fold(time_s, f64::min);
        self.time_s = if time_s - begin_s <= LONGEST_LOST_S { begin_s } else { time_s };
        self.built.state.time_s = self.time_s;
        self.hold_spans();
    }

    /// Opens the energy balance; call before the first step.
    pub fn keep_energy_balance(&mut self) {
        self.energy = Some(EnergyBalance::open(&self.built.plant, &self.built.state, &self.spans));
    }

    /// The inputs at the present instant.
    pub(super) fn end_spans(&self) -> Vec<InputSpan> {
        let mut spans = self.spans.clone();
        for (span, input) in spans.iter_mut().zip(&self.inputs) {
            span.value = input.value(self.time_s);
        }
        if let Some(model) = self.scene.file.muscles.as_ref().and_then(|m| m.displacement.as_ref()) {
            for (d, state) in self.built.displacements.iter().zip(&self.hysteresis) {
                spans[d.input].value = model.output(spans[d.plunger].value * 1e3, state) * 1e-3;
            }
        }
        spans
    }

    /// The energy balance, if kept.
    pub fn energy_balance(&self) -> Option<&EnergyBalance> {
        self.energy.as_ref()
    }

    /// The scene being run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What the mechanism's files hold that has no effect here, one line each.
    pub fn warnings(&self) -> &[String] {
        self.mechanism.as_ref().map_or(&[], Mechanism::warnings)
    }

    /// Present time, s.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    fn hold_spans(&mut self) {
        for (span, input) in self.spans.iter_mut().zip(&self.inputs) {
            *span = InputSpan { value: input.value(self.time_s), slope: 0.0 };
        }
        // A run under way keeps the branch it is on; before the first step there is none.
        if self.has_stepped {
            return;
        }
        PlantLaws::begin(&self.built.plant, &mut self.built.state, &self.spans);
        if let Some(model) = self.scene.file.muscles.as_ref().and_then(|m| m.displacement.as_ref()) {
            for (d, state) in self.built.displacements.iter().zip(&mut self.hysteresis) {
                *state = model.rest(self.spans[d.plunger].value * 1e3);
            }
        }
    }

    /// Advances to a time in equal engine steps no longer than the scene's.
    pub fn advance_to(&mut self, time_s: f64) -> Result<(), SystemError> {
        let start = self.time_s;
        let steps = ((time_s - start) / self.scene.file.simulation.step_s - 1e-9).ceil().max(1.0) as usize;
        for i in 0..steps {
            let end = if i + 1 == steps { time_s } else { start + (time_s - start) * (i + 1) as f64 / steps as f64 };
            self.engine_step(end);
            self.check_laws()?;
        }
        self.check_finite()
    }

    /// Stops where a law has left the range in which its port means anything.
    pub(super) fn check_laws(&self) -> Result<(), SystemError> {
        let Built { plant, state, .. } = &self.built;
        let fault = plant.laws.as_ref().and_then(|laws| laws.fault(plant, state, &self.spans));
        fault.map_or(Ok(()), |fault| {
            Err(SystemError::Law {
                file: self.scene.path.clone(),
                time_s: self.time_s,
                law: fault.law,
                what: fault.what,
            })
        })
    }

    fn check_finite(&self) -> Result<(), SystemError> {
        let state = &self.built.state;
        let laws: Vec<String> = self.scene.laws.iter().map(|law| format!("{} ({})", law.name, law.address)).collect();
        // A law can be stiffer than any step.
        let under = if laws.is_empty() { String::new() } else { format!(" under the laws {}", laws.join(", ")) };
        let diverged =
            |what: String| Err(SystemError::Diverged { time_s: self.time_s, what: format!("{what}{under}") });
        if let Some(i) = state.y().iter().chain(state.w()).position(|x| !x.is_finite()) {
            let names = self.mechanism.iter().flat_map(|m| m.coordinates()).map(|c| c.name.clone());
            let ends = self.scene.file.muscle.iter().map(|m| format!("end of {}", m.name));
            let name = names.chain(ends).nth(i % state.y().len().max(1));
            return diverged(format!("the motion of {}", name.unwrap_or_else(|| "a coordinate".to_owned())));
        }
        for i in 0..self.built.plant.muscles.len() {
            let line = state.line(i);
            if line.pressure_pa.iter().chain(line.flow_m3_s).any(|x| !x.is_finite()) {
                return diverged(format!("the pressure of {}", self.scene.file.muscle[i].name));
            }
        }
        Ok(())
    }
}
