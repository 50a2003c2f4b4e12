//! Output channels of the reduced-order model.

use std::sync::Arc;

use crate::effects::{Effect, Native, Sensor, SensorHistory};
use crate::laws::Law;
use crate::mechanism::{LinkPoint, PoseComponent};
use crate::recording::parse_column;
use crate::scalar::Scalar;
use crate::scene::{OutputSpec, Quantity, Scene};
use crate::system::PlantState;
use crate::system::SystemError;
use crate::system::arc::ArcSide;
use crate::system::channels::sensor_laws;
use crate::system::laws::{Acts, LawSensor};
use crate::system::plant::{Drive, InputSpan, Instant, Plant};
use crate::system::posed::Posture;

use super::lump::Lumped;
use super::{RomParameter, RomSetting};

/// What a channel reads.
#[derive(Clone, Debug)]
enum Reader {
    Elongation(usize),
    SyringePressure(usize),
    MusclePressure(usize),
    Pull(usize),
    Tension(usize),
    /// Coordinates and the share of each that is asked for.
    Joints(Vec<(usize, f64)>),
    Standalone,
    /// A component of a link's pose: the link, which component, and in which other link's frame, if not the world's.
    Link {
        posture: Arc<Posture>,
        link: usize,
        component: PoseComponent,
        frame: Option<usize>,
    },
    /// The tip of a rod of a length that these coordinates bend.
    ArcTip(Vec<(usize, f64)>, f64, ArcSide),
}

/// A channel with the SI units in one of its unit.
#[derive(Clone, Debug)]
pub(super) struct RomOutput {
    pub column: String,
    reader: Reader,
    factor: f64,
    /// Laws on what it shows.
    pub laws: Vec<Law>,
}

impl RomOutput {
    /// The value in the channel's unit; `room` is for what laws do, and may be kept for the next.
    pub fn read<D: Scalar>(
        &self,
        plant: &Plant<D>,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        room: &mut Option<Acts<D>>,
    ) -> D {
        let value = match &self.reader {
            Reader::Elongation(m) => plant.muscles[*m].elongation_m::<0>(state.y()),
            Reader::Pull(m) => plant.forces_in::<0>(*m, &Instant::of(state, inputs, 0.0), room).pull_n(),
            Reader::MusclePressure(m) => plant.muscle_pressure(*m, state, inputs, 0.0),
            Reader::SyringePressure(m) => match plant.muscles[*m].drive {
                Drive::Hydraulic { .. } => state.line(*m).pressure_pa[0],
                Drive::Pressure { .. } => plant.muscle_pressure(*m, state, inputs, 0.0),
            },
            Reader::Tension(c) => plant.cable_in(*c, &Instant::of(state, inputs, 0.0), room).2,
            Reader::Joints(parts) => parts.iter().map(|(i, share)| state.y()[*i] * *share).sum(),
            Reader::Link { posture, link, component, frame } => {
                let here = posture.positions(state.y());
                let placement = posture.linkage.at(&here);
                match (component, frame) {
                    (PoseComponent::Rotation(axis), frame) => placement.rotation_from(*link, *frame)[*axis],
                    (PoseComponent::Position(axis), Some(frame)) => placement.origin_in(*link, *frame)[*axis],
                    (PoseComponent::Position(axis), None) => {
                        placement.point(&LinkPoint { link: *link, point_m: [0.0; 3] })[*axis]
                    }
                }
            }
            Reader::Standalone => D::constant(f64::NAN),
            Reader::ArcTip(parts, length_m, side) => {
                side.of_tip(*length_m, parts.iter().map(|(i, share)| state.y()[*i] * *share).sum())
            }
        };
        value / self.factor
    }

    /// What an element that stands alone answers, SI, in the channel's unit.
    pub fn of_element<D: Scalar>(&self, value: D) -> D {
        value / self.factor
    }

    /// The coordinates that it shows, with the share of each; none for anything but joints.
    pub fn joints(&self) -> &[(usize, f64)] {
        match &self.reader {
            Reader::Joints(parts) | Reader::ArcTip(parts, ..) => parts,
            _ => &[],
        }
    }
}

/// Finds what an output of the scene reads.
pub(super) fn resolve(scene: &Scene, spec: &OutputSpec, lumped: &Lumped) -> Result<RomOutput, SystemError> {
    let of = spec.of.first().map_or("", String::as_str);
    let muscle = scene.file.muscle.iter().position(|m| m.name == of);
    let reader = match spec.quantity {
        Quantity::Elongation => muscle.map(Reader::Elongation),
        Quantity::SyringePressure => muscle.map(Reader::SyringePressure),
        Quantity::MusclePressure => muscle.map(Reader::MusclePressure),
        Quantity::Pull => muscle.map(Reader::Pull),
        Quantity::Tension => scene.file.cable.iter().position(|c| c.name == of).map(Reader::Tension),
        Quantity::JointPosition => Some(Reader::Joints(joints(spec, lumped))),
        Quantity::AxisForce | Quantity::StripForce | Quantity::ChamberPressure => Some(Reader::Standalone),
        Quantity::ArcTipX | Quantity::ArcTipZ => {
            let side = ArcSide::of(spec.quantity);
            side.zip(spec.arc_length_m).map(|(side, length_m)| Reader::ArcTip(joints(spec, lumped), length_m, side))
        }
        Quantity::BodyX => link(spec, lumped, PoseComponent::Position(0)),
        Quantity::BodyY => link(spec, lumped, PoseComponent::Position(1)),
        Quantity::BodyZ => link(spec, lumped, PoseComponent::Position(2)),
        Quantity::BodyRotationX => link(spec, lumped, PoseComponent::Rotation(0)),
        Quantity::BodyRotationY => link(spec, lumped, PoseComponent::Rotation(1)),
        Quantity::BodyRotationZ => link(spec, lumped, PoseComponent::Rotation(2)),
    };
    let reader = reader.ok_or_else(|| SystemError::Name {
        file: scene.path.clone(),
        table: format!("[[output]] \"{}\"", spec.channel),
        message: format!("the reduced-order model has no {:?} of {of:?}", spec.quantity),
        remedy: "leave this channel out of the recordings".to_owned(),
    })?;
    let laws = sensor_laws(&scene.laws, &spec.channel).cloned().collect();
    Ok(RomOutput { column: spec.channel.clone(), reader, factor: parse_column(&spec.channel)?.unit.factor, laws })
}

/// A component of a link's pose, if a link is what is named.
fn link(spec: &OutputSpec, lumped: &Lumped, component: PoseComponent) -> Option<Reader> {
    let find = |name: &String| lumped.link_names.iter().position(|l| l == name);
    let link = find(spec.of.first()?)?;
    let frame = match spec.of.get(1) {
        Some(name) => Some(find(name)?),
        None => None,
    };
    Some(Reader::Link { posture: lumped.posture.clone()?, link, component, frame })
}

fn joints(spec: &OutputSpec, lumped: &Lumped) -> Vec<(usize, f64)> {
    let part = |(i, names): (usize, &Vec<String>)| {
        let asked = spec.of.iter().filter(|n| names.contains(n)).count();
        (asked > 0).then(|| (i, asked as f64 / names.len() as f64))
    };
    lumped.names.iter().enumerate().filter_map(part).collect()
}

/// Whether all channels with laws on them show numbers.
pub(super) fn are_shown<D: Scalar>(outputs: &[RomOutput], setting: &RomSetting<D>, series: &[Vec<D>]) -> bool {
    let has_law = |output: &RomOutput| {
        let mut own = setting.effects.iter().filter(|e| e.channel.as_ref() == Some(&output.column));
        !output.laws.is_empty() || own.any(|e| e.entry.unlisted().is_some())
    };
    let lawful = outputs.iter().zip(series).filter(|(output, _)| has_law(output));
    lawful.flat_map(|(_, values)| values).all(Scalar::is_finite)
}

/// Sensor effects and laws on the channels.
pub(super) struct Sensors<D> {
    effects: Vec<(String, SensorHistory<D>)>,
    laws: Vec<(String, LawSensor<D>)>,
}

impl<D: Scalar> Sensors<D> {
    pub fn new(outputs: &[RomOutput], setting: &RomSetting<D>) -> Self {
        let effects = setting.effects.iter().filter_map(|e| {
            let channel = e.channel.clone().filter(|c| outputs.iter().any(|o| o.column == *c))?;
            sensor(e).map(|s| (channel, SensorHistory::new(s)))
        });
        let laws = outputs.iter().enumerate().flat_map(|(o, output)| {
            output.laws.iter().enumerate().map(move |(l, law)| {
                let mut values: Vec<D> = law.values().into_iter().map(D::constant).collect();
                for (parameter, value) in &setting.parameters {
                    if let RomParameter::SensorLaw(_, _, p) = parameter
                        && *parameter == RomParameter::SensorLaw(o, l, *p)
                    {
                        values[*p] = *value;
                    }
                }
                (output.column.clone(), LawSensor::new(law, values, output.factor))
            })
        });
        let written = setting.effects.iter().filter_map(|e| {
            let output = outputs.iter().find(|o| e.channel.as_ref() == Some(&o.column))?;
            let own = e.entry.unlisted()?;
            Some((output.column.clone(), LawSensor::new(&own.law, own.values(&e.values), output.factor)))
        });
        Self { effects: effects.collect(), laws: laws.chain(written).collect() }
    }

    /// The value as the channel's sensors show it.
    pub fn show(&mut self, output: &RomOutput, time_s: f64, value: D) -> D {
        let own = self.effects.iter_mut().filter(|(c, _)| *c == output.column);
        let shown = own.fold(value, |value, (_, sensor)| sensor.show(time_s, value));
        let laws = self.laws.iter_mut().filter(|(c, _)| *c == output.column);
        laws.fold(shown, |value, (_, law)| law.show(time_s, value))
    }
}

/// The sensor law of an effect, if it is one.
pub(in crate::system) fn sensor<D: Scalar>(effect: &Effect<D>) -> Option<Sensor<D>> {
    let size = *effect.values.first()?;
    Some(match effect.entry.native {
        Some(Native::SensorLag) => Sensor::Lag { time_constant_s: size },
        Some(Native::SensorDelay) => Sensor::Delay { delay_s: size },
        Some(Native::SensorDrift) => Sensor::Drift { rate_per_s: size },
        Some(Native::SensorGain) => Sensor::Gain { gain_error: size },
        _ => return None,
    })
}
