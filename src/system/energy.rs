//! The energy balance: where the plunger's work went.
//!
//! Powers are integrated by the trapezoid rule over the fine steps; stored energies are read off the states. What
//! is left between the two is the integrator's own error and stands in the balance as a line of its own. Effects have
//! lines of their own (`effect_energy.rs`), which a balance without them does not show.

use crate::laws::Port;

use super::effect_energy::{EffectLines, effect_flows, effect_stores};
use super::laws::law_powers;
use super::plant::{Drive, InputSpan, Instant, Plant};
use super::state::PlantState;

mod terms;

use terms::{Powers, powers, stored};

/// The balance of one run.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::Simulation;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
/// simulation.keep_energy_balance();
/// simulation.advance_to(0.5)?;
/// let lines = simulation.energy_balance().ok_or("it was kept")?.lines();
/// let line_j = |name: &str| lines.iter().find(|(n, _)| n == name).map_or(f64::NAN, |(_, j)| *j);
/// let brought = ["input_work", "load_work", "pressure_friction_exchange", "engine_and_contacts"];
/// let brought_j: f64 = brought.iter().map(|name| line_j(name)).sum();
/// let lost_j: f64 = lines.iter().filter(|(n, _)| n.starts_with("lost_")).map(|(_, j)| j).sum();
/// // What came in is stored, or lost, or the integrator's error.
/// let left_j = brought_j - line_j("stored") - lost_j - line_j("unaccounted_integrator");
/// assert!(lost_j > 0.0 && left_j.abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct EnergyBalance {
    stored_0: f64,
    stored: f64,
    sums: Powers,
    /// Work of contacts and whatever else the engine adds to the coordinates, J.
    engine: f64,
    /// Integral of the absolute plunger power, J: the scale of the run.
    turnover: f64,
    before: Powers,
    /// What flowed through effects so far, J, and before the step, W; what they held at the start and hold now, J.
    effects: EffectLines,
    effects_before: EffectLines,
    held_0: EffectLines,
    held: EffectLines,
    /// Of each law of the scene: its name, its port, what it has brought so far (J), and its power before
    /// the step (W).
    laws: Vec<LawLine>,
    /// Of each muscle, before the step: pressure at its syringe, Pa, and how far its piston is ahead, m.
    pistons_before: Vec<(f64, f64)>,
    /// Where laws of plungers have put the pistons: law, muscle, m.
    pistons_by_laws: Vec<(usize, usize, f64)>,
}

/// A law's line of the balance.
#[derive(Clone, Debug)]
struct LawLine {
    name: String,
    /// Whether the law is an effect of the catalogue.
    is_listed: bool,
    port: Port,
    brought_j: f64,
    before_w: f64,
}

impl EnergyBalance {
    /// Opens the balance at a state; `inputs` as they will be over the first step.
    #[doc(hidden)]
    pub fn open(plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) -> Self {
        let stored = stored(plant, state, inputs, 0.0);
        let held = effect_stores(plant, state, inputs, 0.0);
        Self {
            stored_0: stored,
            stored,
            sums: Powers::default(),
            engine: 0.0,
            turnover: 0.0,
            before: Powers::default(),
            effects: EffectLines::default(),
            effects_before: EffectLines::default(),
            held_0: held,
            held,
            laws: law_lines(plant),
            pistons_before: Vec::new(),
            pistons_by_laws: pistons_by_laws(plant, state, inputs, 0.0),
        }
    }

    /// To be called before each fine step.
    #[doc(hidden)]
    pub fn before(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) {
        self.before = powers(plant, state, inputs, 0.0);
        self.effects_before = effect_flows(plant, state, inputs, 0.0);
        let laws = law_powers(plant, state, inputs, 0.0);
        self.laws.iter_mut().zip(laws).for_each(|(line, power)| line.before_w = power);
        self.pistons_before.clear();
        self.pistons_before.extend(pistons(state));
    }

    /// To be called after it.
    #[doc(hidden)]
    pub fn after(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], h: f64) {
        let (b, a) = (self.before, powers(plant, state, inputs, h));
        let s = &mut self.sums;
        let mean = |x: f64, y: f64| h * (x + y) / 2.0;
        s.input += mean(b.input, a.input);
        s.loads += mean(b.loads, a.loads);
        s.line_viscosity += mean(b.line_viscosity, a.line_viscosity);
        s.muscle_damping += mean(b.muscle_damping, a.muscle_damping);
        s.muscle_friction += mean(b.muscle_friction, a.muscle_friction);
        s.pressure_friction += mean(b.pressure_friction, a.pressure_friction);
        s.cable_damping += mean(b.cable_damping, a.cable_damping);
        s.joint_damping += mean(b.joint_damping, a.joint_damping);
        s.stop_damping += mean(b.stop_damping, a.stop_damping);
        self.turnover += mean(b.input.abs(), a.input.abs());
        self.sums.input += self.work_in_play(plant, state);
        self.effects.add_scaled(&self.effects_before, h / 2.0);
        self.effects.add_scaled(&effect_flows(plant, state, inputs, h), h / 2.0);
        let laws = law_powers(plant, state, inputs, h);
        self.laws.iter_mut().zip(laws).for_each(|(line, power)| line.brought_j += mean(line.before_w, power));
        self.move_pistons_by_laws(plant, state, inputs, h);
        self.stored = stored(plant, state, inputs, h);
        self.held = effect_stores(plant, state, inputs, h);
    }

    /// Work of pistons that have play over that of plungers without, J: the piston is what the fluid sees.
    fn work_in_play(&self, plant: &Plant<f64>, state: &PlantState<f64>) -> f64 {
        let mut work_j = 0.0;
        for (muscle, (before, after)) in plant.muscles.iter().zip(self.pistons_before.iter().zip(pistons(state))) {
            if let Drive::Hydraulic { syringe_area_m2, .. } = &muscle.drive {
                work_j += (before.0 + after.0) / 2.0 * syringe_area_m2 * (after.1 - before.1);
            }
        }
        work_j
    }

    /// Work of pistons on the way that laws of their plungers make them go.
    fn move_pistons_by_laws(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], h: f64) {
        let now = pistons_by_laws(plant, state, inputs, h);
        for ((law, muscle, after), (_, _, before)) in now.iter().zip(&self.pistons_by_laws) {
            if let Drive::Hydraulic { syringe_area_m2, .. } = &plant.muscles[*muscle].drive {
                let pressure_pa = (self.pistons_before[*muscle].0 + state.line(*muscle).pressure_pa[0]) / 2.0;
                self.laws[*law].brought_j += pressure_pa * syringe_area_m2 * (after - before);
            }
        }
        self.pistons_by_laws = now;
    }

    /// Enters a change of the stored energy that the rigid-body engine made (contacts, a moved pose).
    pub(crate) fn engine_changed(
        &mut self,
        plant: &Plant<f64>,
        state: &PlantState<f64>,
        inputs: &[InputSpan],
        elapsed_s: f64,
    ) {
        let now = stored(plant, state, inputs, elapsed_s);
        let held = effect_stores(plant, state, inputs, elapsed_s);
        self.engine += now - self.stored + (self.held.net() - held.net());
        self.stored = now;
        self.held = held;
    }

    /// What is not accounted for, J: the integrator's own error.
    pub fn unaccounted_j(&self) -> f64 {
        let s = &self.sums;
        let lost = s.line_viscosity
            + s.muscle_damping
            + s.muscle_friction
            + s.cable_damping
            + s.joint_damping
            + s.stop_damping;
        let stock = s.input + s.loads + s.pressure_friction + self.engine - (self.stored - self.stored_0) - lost;
        let laws: f64 = self.laws.iter().map(|line| line.brought_j).sum();
        stock + self.effects_so_far().net() + laws
    }

    /// Laws that stand where energy is lost and have brought more than is lost there without them, each with how much, J.
    pub fn supplying_laws(&self) -> impl Iterator<Item = (&str, f64)> {
        let least = LEAST_SUPPLY * self.turnover;
        let lost_j = |port: Port| match port {
            Port::Friction => self.sums.muscle_friction,
            Port::Damping => self.sums.muscle_damping,
            Port::Resistance | Port::PressureDrop => self.sums.line_viscosity,
            Port::JointDamping => self.sums.joint_damping,
            _ => 0.0,
        };
        let is_supplying =
            move |line: &&LawLine| line.port.spec().dissipates && line.brought_j > lost_j(line.port) + least;
        let supplying = self.laws.iter().filter(is_supplying);
        supplying.map(|line| (line.name.as_str(), line.brought_j))
    }

    /// Integral of the absolute plunger power, J.
    pub fn turnover_j(&self) -> f64 {
        self.turnover
    }

    /// What flowed through effects, and by how much more they hold than at the start, J.
    fn effects_so_far(&self) -> EffectLines {
        let mut lines = self.effects;
        lines.add_scaled(&self.held, 1.0);
        lines.add_scaled(&self.held_0, -1.0);
        lines
    }

    /// Lines of laws; an effect on several elements has one line, and none where there is nothing on it.
    fn lines_of_laws(&self) -> Vec<(String, f64)> {
        let mut lines: Vec<(String, f64)> = Vec::new();
        for own in self.laws.iter().filter(|own| !own.is_listed || own.brought_j != 0.0) {
            match lines.iter_mut().find(|(name, _)| own.is_listed && *name == own.name) {
                Some((_, sum_j)) => *sum_j += own.brought_j,
                None => lines.push((own.name.clone(), own.brought_j)),
            }
        }
        lines
    }

    /// All lines, J, in a fixed order: what came in, what is stored, what was lost, what is left over.
    ///
    /// Lines of effects stand only where there is something on them.
    pub fn lines(&self) -> Vec<(String, f64)> {
        let s = &self.sums;
        let mut lines: Vec<(&str, f64)> = vec![("input_work", s.input), ("load_work", s.loads)];
        let effects = self.effects_so_far();
        lines.extend(effects.lines("_work"));
        let brought: Vec<(String, f64)> = named(lines).into_iter().chain(self.lines_of_laws()).collect();
        let mut lines: Vec<(&str, f64)> = Vec::new();
        lines.extend([
            ("pressure_friction_exchange", s.pressure_friction),
            ("engine_and_contacts", self.engine),
            ("stored", self.stored - self.stored_0),
        ]);
        lines.extend(effects.lines("stored_"));
        lines.extend([
            ("lost_line_viscosity", s.line_viscosity),
            ("lost_muscle_friction", s.muscle_friction),
            ("lost_muscle_damping", s.muscle_damping),
            ("lost_cable_damping", s.cable_damping),
            ("lost_joint_damping", s.joint_damping),
            ("lost_stop_damping", s.stop_damping),
        ]);
        lines.extend(effects.lines("lost_"));
        lines.push(("unaccounted_integrator", self.unaccounted_j()));
        brought.into_iter().chain(named(lines)).collect()
    }
}

fn named(lines: Vec<(&str, f64)>) -> Vec<(String, f64)> {
    lines.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Share of the turnover below which what a law brings is rounding.
const LEAST_SUPPLY: f64 = 1e-6;

fn law_lines(plant: &Plant<f64>) -> Vec<LawLine> {
    let laws = plant.laws.iter().flat_map(|laws| laws.laws());
    let line = |law: &crate::laws::Law| LawLine {
        name: law.energy.clone().unwrap_or_else(|| format!("law_{}", law.name)),
        is_listed: law.energy.is_some(),
        port: law.address.port,
        brought_j: 0.0,
        before_w: 0.0,
    };
    laws.map(line).collect()
}

/// Pressure at each syringe, Pa, and how far its piston is ahead of the plunger, m.
fn pistons(state: &PlantState<f64>) -> impl Iterator<Item = (f64, f64)> {
    state.piston_ahead_m.iter().enumerate().map(|(i, ahead)| (state.line(i).pressure_pa[0], *ahead))
}

fn pistons_by_laws(
    plant: &Plant<f64>,
    state: &PlantState<f64>,
    inputs: &[InputSpan],
    elapsed_s: f64,
) -> Vec<(usize, usize, f64)> {
    let laws = plant.laws.as_ref().filter(|laws| laws.moves_pistons());
    laws.map_or_else(Vec::new, |laws| laws.pistons(plant, &Instant::of(state, inputs, elapsed_s)))
}
