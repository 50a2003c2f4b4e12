//! Laws in a plant: which port of which element each acts on, evaluated at every instant that the integrator asks for.
//!
//! A plant without laws does not come here. With laws, [`PlantLaws::act`] evaluates all of them once per stage into [`Acts`];
//! the equations then ask what acts on each of their terms. Laws of cables come first, since others may depend on tensions.

mod acts;
mod apply;
mod evaluate;
mod fault;
mod memory;
mod pistons;
mod place;
mod power;
mod sampled;
mod sensor;
mod shown;
mod slopes;
mod tangents;
mod visited;

use std::sync::Arc;

use crate::laws::{Acts as Sense, Carrier, Law, Port, Program, Programs, Quantity};
use crate::scalar::Scalar;

use super::install::Site;
use super::plant::{InputSpan, Instant, Plant};
use super::state::PlantState;

pub use acts::{Act, Acts, CableActs, JointActs, MuscleActs};
pub use fault::LawFault;
pub use place::{Rig, Source, Wrong};
pub use power::law_powers;
pub(super) use power::line_drop;
pub(super) use sampled::LawSampled;
pub(super) use sensor::LawSensor;
pub(super) use slopes::MuscleSlopes;
pub(super) use tangents::LawTangents;
pub(super) use visited::Visit;

/// A law at one element.
#[derive(Clone, Debug, PartialEq)]
struct Instance {
    /// Index of the law, how it acts, and its port.
    law: usize,
    sense: Sense,
    port: Port,
    /// The port's: asked for at every stage.
    carrier: Carrier,
    /// Whether no other law acts there.
    is_alone: bool,
    /// Muscle, cable or direction.
    at: usize,
    /// Where each symbol of the law is read, and those that its value needs, in the order of the program.
    sources: Vec<Source>,
    reads: Vec<Source>,
    programs: Arc<Programs>,
    /// Where the registers of its value begin among those of all.
    registers_at: usize,
    /// Where its states begin among those of all laws.
    state_at: usize,
}

/// The laws of a plant.
#[derive(Clone, Debug)]
pub struct PlantLaws<D> {
    rig: Rig,
    laws: Vec<Law>,
    /// Values of each law's parameters.
    values: Vec<Vec<D>>,
    instances: Vec<Instance>,
    /// Number of coordinates that are joints: what follows are ends of muscles.
    joints: usize,
    /// Where the extra travels of the cables begin among the states, if a law changes a lever.
    travel_at: Option<usize>,
    /// Whether a law moves a piston, whether one acts on a cable, and the directions on which some act.
    on_plungers: bool,
    on_cables: bool,
    rubs: bool,
    joint_sites: Vec<usize>,
    states: usize,
    /// Number of registers that all values need.
    registers: usize,
}

impl<D: Scalar> PlantLaws<D> {
    /// None yet, on this rig.
    pub(super) fn new(plant: &Plant<D>, site: &Site) -> Self {
        let rig = Rig::of(plant, site);
        Self {
            rig,
            laws: Vec::new(),
            values: Vec::new(),
            instances: Vec::new(),
            joints: site.joints,
            travel_at: None,
            on_plungers: false,
            on_cables: false,
            rubs: false,
            joint_sites: Vec::new(),
            states: 0,
            registers: 0,
        }
    }

    /// One law more, with the values of its parameters.
    ///
    /// # Errors
    /// A port or a variable that the rig does not have; nothing is changed then.
    pub fn add(&mut self, law: &Law, values: Vec<D>, cables: usize) -> Result<(), Wrong> {
        let index = self.laws.len();
        let places = self.rig.places(&law.address)?;
        let sources = places.iter().map(|&at| self.rig.sources(law, at)).collect::<Result<Vec<_>, _>>()?;
        for (at, sources) in places.into_iter().zip(sources) {
            if law.address.port.spec().carrier == Carrier::Joint && !self.joint_sites.contains(&at) {
                self.joint_sites.push(at);
            }
            let (port, carrier) = (law.address.port, law.address.port.spec().carrier);
            let is_alone = !self.instances.iter().any(|i| i.port == port && i.at == at);
            self.instances.iter_mut().filter(|i| i.port == port && i.at == at).for_each(|i| i.is_alone = false);
            self.instances.push(Instance {
                law: index,
                sense: law.acts,
                port,
                carrier,
                is_alone,
                at,
                reads: law.programs.value.symbols().iter().map(|symbol| sources[*symbol]).collect(),
                sources,
                programs: law.programs.clone(),
                registers_at: self.registers,
                state_at: self.states,
            });
            self.registers += law.programs.value.registers();
            self.states += law.states.len();
        }
        if law.address.port == Port::Lever && self.travel_at.is_none() {
            self.travel_at = Some(self.states);
            self.states += cables;
        }
        self.on_plungers |= law.address.port == Port::Plunger;
        self.rubs |= makes_force_of_speed(law);
        self.on_cables |= law.address.port.spec().carrier == Carrier::Cable;
        self.laws.push(law.clone());
        self.values.push(values);
        Ok(())
    }

    /// Gives a parameter another value.
    pub fn set(&mut self, law: usize, parameter: usize, value: D) {
        self.values[law][parameter] = value;
    }

    pub fn laws(&self) -> &[Law] {
        &self.laws
    }

    /// The same over another number type.
    pub fn lift<E: Scalar>(&self) -> PlantLaws<E> {
        let constants = |values: &Vec<D>| values.iter().map(|x| E::constant(x.value())).collect();
        PlantLaws {
            rig: self.rig.clone(),
            laws: self.laws.clone(),
            values: self.values.iter().map(constants).collect(),
            instances: self.instances.clone(),
            joints: self.joints,
            travel_at: self.travel_at,
            on_plungers: self.on_plungers,
            on_cables: self.on_cables,
            rubs: self.rubs,
            joint_sites: self.joint_sites.clone(),
            states: self.states,
            registers: self.registers,
        }
    }

    /// Room for what they do.
    pub fn room(&self, plant: &Plant<D>) -> Acts<D> {
        let mut acts = Acts::new(plant.muscles.len(), plant.cables.len(), self.rig.directions.len());
        acts.registers.resize(self.registers, D::constant(0.0));
        for instance in &self.instances {
            let (port, at) = (instance.port, instance.at);
            match instance.carrier {
                Carrier::Muscle => acts.muscles[at].note(port),
                Carrier::Cable => acts.cables[at].note(port),
                Carrier::Joint => acts.joints[at].note(port),
                Carrier::Alone | Carrier::Sensor => {}
            }
            let scratch = instance.programs.of_states().map(Program::registers).into_iter().max().unwrap_or(0);
            acts.scratch.resize(scratch.max(acts.scratch.len()), D::constant(0.0));
        }
        acts
    }

    /// The joints of a direction.
    pub fn direction(&self, site: usize) -> &[f64] {
        &self.rig.directions[site].direction
    }

    /// Whether some law remembers anything.
    #[inline]
    pub(super) fn remembers(&self) -> bool {
        self.states > 0
    }

    /// Whether some law acts on a cable.
    #[inline]
    pub(super) fn on_cables(&self) -> bool {
        self.on_cables
    }

    /// Tensions of all cables under their laws. Kept apart: a stock scene has none.
    #[cold]
    #[inline(never)]
    pub(super) fn tensions<'a, const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        room: &'a mut Option<Acts<D>>,
    ) -> &'a [D] {
        &self.acting(plant, now, room).tension_n
    }

    /// Whether a law makes forces of speeds: its slope can turn within a step, and tangents must not be kept.
    #[inline]
    pub(super) fn rubs(&self) -> bool {
        self.rubs
    }

    /// What laws do to the plant at an instant, in a room that is made if there is none.
    pub(super) fn acting<'a, const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        room: &'a mut Option<Acts<D>>,
    ) -> &'a Acts<D> {
        let acts = room.get_or_insert_with(|| self.room(plant));
        self.act(plant, now, acts);
        acts
    }

    /// What laws do to the state's plant, evaluated afresh.
    pub(super) fn afresh<const N: usize>(&self, plant: &Plant<D>, now: &Instant<D, N>) -> Acts<D> {
        let mut acts = self.room(plant);
        self.act(plant, now, &mut acts);
        acts
    }

    /// Gives a state the memory that they need, as it starts with all inputs at zero.
    pub fn settle(plant: &Plant<D>, state: &mut PlantState<D>) {
        if let Some(laws) = &plant.laws {
            state.set_law_states(&vec![D::constant(0.0); laws.states]);
            Self::begin(plant, state, &vec![InputSpan::default(); plant.inputs()]);
        }
    }

    /// Starts the memory at a run's first instant: where inputs and clock are there.
    pub fn begin(plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan]) {
        if let Some(laws) = &plant.laws {
            memory::start(laws, plant, state, inputs);
            laws.place_pistons(plant, state, inputs);
        }
    }
}

fn makes_force_of_speed(law: &Law) -> bool {
    let is_force = matches!(law.address.port, Port::Torque | Port::JointDamping | Port::Pull | Port::Damping);
    let is_speed = |v: &crate::laws::Variable| matches!(v.quantity, Quantity::Speed | Quantity::AngularSpeed);
    is_force && law.variables().iter().any(is_speed)
}

/// The play operator: `before` moved by as little as keeps it within half a width of `followed`.
fn play<D: Scalar>(before: D, followed: D, half: D) -> D {
    let low = (followed - half).select_above(before, followed - half, before);
    low.select_above(followed + half, followed + half, low)
}
