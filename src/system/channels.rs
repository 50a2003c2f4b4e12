//! Channels of a running scene: what each output column reads.

use crate::effects::{Effect, SensorHistory};
use crate::laws::{Law, Port};
use crate::mechanism::{Coordinate, CoordinateKind, Pose, PoseComponent};
use crate::recording::parse_column;
use crate::scene::{OutputSpec, Quantity, Scene};

use super::arc::ArcSide;
use super::inputs::InputSource;
use super::laws::LawSensor;
use super::plant::Drive;
use super::rom::sensor;
use super::standalone::{Answering, Standalone};
use super::{Simulation, SystemError};

/// What one output column reads from the state.
#[derive(Clone, Debug)]
enum Reader {
    Elongation(usize),
    SyringePressure(usize),
    MusclePressure(usize),
    Pull(usize),
    Tension(usize),
    Joints(Vec<usize>, f64),
    /// A component of a body's pose, in the world or in another link's frame.
    Body {
        body: usize,
        component: PoseComponent,
        frame: Option<usize>,
    },
    Standalone(Box<Answering<f64>>),
    /// Tip of a rod bent to an arc by the joints' angle: its length, m, and whether sideways or along.
    ArcTip(Vec<usize>, f64, ArcSide),
    /// Elongation of a displacement model: the pseudo-input that carries it.
    Displacement(usize),
}

/// What a column reads, SI units in one of its unit, its sensors' effects and their laws.
type Shown = (Reader, f64, Vec<SensorHistory<f64>>, Vec<LawSensor<f64>>);

/// The columns of a scene with their units.
#[derive(Clone, Debug)]
pub(super) struct Channels {
    /// Of each input: SI units in one of its unit.
    input_factors: Vec<f64>,
    readers: Vec<Shown>,
    pub names: Vec<String>,
}

impl Channels {
    /// Resolves the names of a scene's outputs.
    pub(super) fn new(simulation: &Simulation) -> Result<Self, SystemError> {
        let scene = &simulation.scene;
        let mut names = Vec::new();
        let mut input_factors = Vec::new();
        for input in &scene.file.input {
            input_factors.push(parse_column(&input.channel)?.unit.factor);
            names.push(input.channel.clone());
        }
        let mut readers = Vec::new();
        for output in &scene.file.output {
            let sensors = sensors(scene, &output.channel);
            let factor = parse_column(&output.channel)?.unit.factor;
            let laws = sensor_laws(&scene.laws, &output.channel).map(|law| LawSensor::new(law, law.values(), factor));
            readers.push((reader(simulation, output)?, factor, sensors, laws.collect()));
            names.push(output.channel.clone());
        }
        Ok(Self { input_factors, readers, names })
    }

    /// Values of all columns now, inputs first, each in its own unit.
    ///
    /// Instants must come in order: sensors and frictions remember.
    pub(super) fn read(&mut self, simulation: &Simulation, out: &mut Vec<f64>) {
        out.clear();
        for (input, factor) in simulation.inputs.iter().zip(&self.input_factors) {
            out.push(input.value(simulation.time_s) / factor);
        }
        for (reader, factor, sensors, laws) in &mut self.readers {
            let value = reader.value_si(simulation) / *factor;
            let shown = sensors.iter_mut().fold(value, |value, s| s.show(simulation.time_s, value));
            out.push(laws.iter_mut().fold(shown, |value, law| law.show(simulation.time_s, value)));
        }
    }
}

impl Channels {
    /// Stops a run whose sensors' laws show what is no number.
    pub(super) fn check(&self, simulation: &Simulation, values: &[f64]) -> Result<(), SystemError> {
        let outputs = self.readers.iter().zip(values.iter().skip(self.input_factors.len()));
        let mut wrong =
            outputs.zip(&self.names[self.input_factors.len()..]).filter(|((_, value), _)| !value.is_finite());
        let time_s = simulation.time_s;
        match wrong.next() {
            None => Ok(()),
            Some((((reader, .., laws), value), name)) => {
                Err(match laws.last().map(LawSensor::title).or(reader.law()) {
                    Some(law) => SystemError::Law {
                        file: simulation.scene.path.clone(),
                        time_s,
                        law,
                        what: format!("its channel shows {value}"),
                    },
                    None => SystemError::Diverged { time_s, what: format!("the channel {name}") },
                })
            }
        }
    }
}

impl Reader {
    /// Name and port of a law on the element that it reads, if that stands alone.
    fn law(&self) -> Option<String> {
        match self {
            Self::Standalone(element) => element.laws().title(),
            _ => None,
        }
    }

    fn value_si(&mut self, simulation: &Simulation) -> f64 {
        let (plant, state) = (&simulation.built.plant, &simulation.built.state);
        let spans = &simulation.end_spans();
        match self {
            Self::Elongation(m) => plant.muscles[*m].elongation_m::<0>(state.y()),
            Self::Pull(m) => plant.muscle_forces(*m, state, spans, 0.0).pull_n(),
            Self::MusclePressure(m) => plant.muscle_pressure(*m, state, spans, 0.0),
            Self::SyringePressure(m) => match plant.muscles[*m].drive {
                Drive::Hydraulic { .. } => state.line(*m).pressure_pa[0],
                Drive::Pressure { .. } => plant.muscle_pressure(*m, state, spans, 0.0),
            },
            Self::Tension(c) => plant.cable(*c, state, spans, 0.0).2,
            Self::Joints(joints, constant) => *constant + joints.iter().map(|&j| state.y()[j]).sum::<f64>(),
            Self::Body { body, component, frame } => simulation.mechanism.as_ref().map_or(f64::NAN, |mechanism| {
                let poses = mechanism.link_poses();
                let (pose, frame) = (poses[*body], frame.map(|f| poses[f]));
                match component {
                    PoseComponent::Position(axis) => {
                        frame.map_or(pose.translation_m, |f| f.to_local(pose.translation_m))[*axis]
                    }
                    PoseComponent::Rotation(axis) => pose.rotation_from(frame.unwrap_or(Pose::IDENTITY))[*axis],
                }
            }),
            Self::Standalone(element) => {
                let span_s = simulation.inputs.first().and_then(InputSource::span_s);
                element.show(|i, t| simulation.inputs[i].value(t), span_s, simulation.time_s)
            }
            Self::ArcTip(joints, length_m, side) => side.of_tip(*length_m, joints.iter().map(|&j| state.y()[j]).sum()),
            Self::Displacement(input) => spans[*input].value,
        }
    }
}

fn reader(simulation: &Simulation, output: &OutputSpec) -> Result<Reader, SystemError> {
    let scene = &simulation.scene;
    let of = output.of.first().map_or("", String::as_str);
    let scene_muscle = scene.file.muscle.iter().position(|m| m.name == of);
    let muscle = scene_muscle.and_then(|i| simulation.built.muscle_index[i]);
    Ok(match output.quantity {
        Quantity::Elongation => match (muscle, scene_muscle) {
            (Some(m), _) => Reader::Elongation(m),
            (None, Some(i)) => simulation
                .built
                .displacements
                .iter()
                .find(|d| d.muscle == i)
                .map(|d| Reader::Displacement(d.input))
                .ok_or_else(|| no_such(scene, output, "this muscle"))?,
            (None, None) => return Err(no_such(scene, output, "this muscle")),
        },
        Quantity::SyringePressure => {
            Reader::SyringePressure(muscle.ok_or_else(|| no_such(scene, output, "a pressure"))?)
        }
        Quantity::MusclePressure => Reader::MusclePressure(muscle.ok_or_else(|| no_such(scene, output, "a pressure"))?),
        Quantity::Pull => Reader::Pull(muscle.ok_or_else(|| no_such(scene, output, "a pull"))?),
        Quantity::Tension => {
            let cable = scene.file.cable.iter().position(|c| c.name == of);
            Reader::Tension(cable.ok_or_else(|| no_such(scene, output, "this cable"))?)
        }
        Quantity::JointPosition => joints(simulation, output)?,
        Quantity::BodyX => body(simulation, output, PoseComponent::Position(0))?,
        Quantity::BodyY => body(simulation, output, PoseComponent::Position(1))?,
        Quantity::BodyZ => body(simulation, output, PoseComponent::Position(2))?,
        Quantity::BodyRotationX => body(simulation, output, PoseComponent::Rotation(0))?,
        Quantity::BodyRotationY => body(simulation, output, PoseComponent::Rotation(1))?,
        Quantity::BodyRotationZ => body(simulation, output, PoseComponent::Rotation(2))?,
        Quantity::AxisForce | Quantity::StripForce | Quantity::ChamberPressure => {
            let element =
                Standalone::of(scene).ok_or_else(|| no_such(scene, output, "an element that stands alone"))?;
            Reader::Standalone(Box::new(element.begin(std::iter::empty(), &effects(scene))))
        }
        Quantity::ArcTipX | Quantity::ArcTipZ => arc_tip(simulation, output)?,
    })
}

/// Effects of a scene; it has been checked that each table is one.
fn effects(scene: &Scene) -> Vec<Effect<f64>> {
    scene.file.effect.iter().filter_map(|t| t.effect().ok()).collect()
}

/// Laws on what a channel shows.
pub(super) fn sensor_laws<'a>(laws: &'a [Law], channel: &'a str) -> impl Iterator<Item = &'a Law> {
    laws.iter().filter(move |law| law.address.port == Port::Sensor && law.address.of.as_deref() == Some(channel))
}

fn sensors(scene: &Scene, channel: &str) -> Vec<SensorHistory<f64>> {
    let own = effects(scene).into_iter().filter(|e| e.channel.as_deref() == Some(channel));
    own.filter_map(|e| sensor(&e)).map(SensorHistory::new).collect()
}

/// The tip of a rod that a joint bends.
fn arc_tip(simulation: &Simulation, output: &OutputSpec) -> Result<Reader, SystemError> {
    let coordinates: Vec<&Coordinate> = simulation.mechanism.iter().flat_map(|m| m.coordinates()).collect();
    let turns = |name: &String| coordinates.iter().position(|c| c.name == *name && c.kind == CoordinateKind::Angle);
    let found: Option<Vec<usize>> = output.of.iter().map(turns).collect();
    let side = ArcSide::of(output.quantity);
    match (found, output.arc_length_m, side) {
        (Some(found), Some(length_m), Some(side)) if !found.is_empty() => Ok(Reader::ArcTip(found, length_m, side)),
        _ => Err(no_such(&simulation.scene, output, "these turning joints")),
    }
}

fn joints(simulation: &Simulation, output: &OutputSpec) -> Result<Reader, SystemError> {
    let coordinates: Vec<&Coordinate> = simulation.mechanism.iter().flat_map(|m| m.coordinates()).collect();
    let names: Vec<&str> = coordinates.iter().map(|c| c.name.as_str()).collect();
    let found: Option<Vec<usize>> = output.of.iter().map(|name| names.iter().position(|n| n == name)).collect();
    match found {
        Some(found) if !found.is_empty() => {
            let odd = found.iter().map(|&i| coordinates[i]).find(|c| !fits(&output.channel, c.kind));
            odd.map_or(Ok(Reader::Joints(found, 0.0)), |joint| Err(wrong_unit(&simulation.scene, output, joint)))
        }
        _ => Err(no_such(&simulation.scene, output, &format!("these joints (free joints: {})", names.join(", ")))),
    }
}

/// Whether a column's unit is one of what a joint of this kind moves in.
fn fits(column: &str, kind: CoordinateKind) -> bool {
    let wanted = if kind == CoordinateKind::Angle { "rad" } else { "m" };
    parse_column(column).is_ok_and(|name| name.unit.si_suffix == wanted)
}

fn wrong_unit(scene: &Scene, output: &OutputSpec, joint: &Coordinate) -> SystemError {
    let (kind, units) = match joint.kind {
        CoordinateKind::Angle => ("turns", "_deg or _rad"),
        CoordinateKind::Length => ("slides", "_mm or _m"),
    };
    SystemError::Name {
        file: scene.path.clone(),
        table: format!("[[output]] \"{}\"", output.channel),
        message: format!("the joint \"{}\" {kind}: the channel's unit does not fit", joint.name),
        remedy: format!("end the channel's name in {units}"),
    }
}

fn body(simulation: &Simulation, output: &OutputSpec, component: PoseComponent) -> Result<Reader, SystemError> {
    let links = simulation.mechanism.as_ref().map_or(&[][..], |m| m.link_names());
    let find = |name: Option<&String>| links.iter().position(|l| Some(l) == name);
    match (find(output.of.first()), output.of.get(1), find(output.of.get(1))) {
        (Some(body), None, _) => Ok(Reader::Body { body, component, frame: None }),
        (Some(body), Some(_), Some(frame)) => Ok(Reader::Body { body, component, frame: Some(frame) }),
        _ => Err(no_such(&simulation.scene, output, &format!("these bodies or links (known: {})", links.join(", ")))),
    }
}

fn no_such(scene: &Scene, output: &OutputSpec, what: &str) -> SystemError {
    SystemError::Name {
        file: scene.path.clone(),
        table: format!("[[output]] \"{}\"", output.channel),
        message: format!("of = {:?}: the scene does not have {what}", output.of),
        remedy: "name a muscle, cable, joint or body of this scene in `of`".to_owned(),
    }
}
