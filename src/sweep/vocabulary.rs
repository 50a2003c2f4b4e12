//! What a measure may name: channels, and the muscles, cables and joints of the scene.

use super::expression::Wrong;
use super::measure::{Argument, Call, Figure};
use crate::nearest::did_you_mean;
use crate::scene::{Quantity, Scene};

/// The names of a scene.
#[derive(Clone, Debug, Default)]
pub struct Vocabulary {
    inputs: Vec<String>,
    outputs: Vec<String>,
    /// Outputs that show joints.
    joint_channels: Vec<String>,
    muscles: Vec<String>,
    /// Muscles that have a syringe.
    driven: Vec<String>,
    /// Muscles whose elongation is computed from a tube.
    tubes: Vec<String>,
    cables: Vec<String>,
    /// Joints that have a stop.
    joints: Vec<String>,
}

impl Argument {
    /// As it stands in an error.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Channel => "channel",
            Self::Input => "input",
            Self::Muscle => "muscle",
            Self::Cable => "cable",
            Self::Joint => "joint with a stop",
            Self::Number => "number",
        }
    }
}

impl Vocabulary {
    /// Names of a scene.
    pub fn of(scene: &Scene) -> Self {
        let file = &scene.file;
        let muscles: Vec<String> = file.muscle.iter().map(|m| m.name.clone()).collect();
        let make = file.muscles.as_ref();
        let having = |yes: bool| if yes { muscles.clone() } else { Vec::new() };
        let joint = |o: &&crate::scene::OutputSpec| o.quantity == Quantity::JointPosition;
        let joints = file.mechanism.iter().flat_map(|m| &m.joint);
        let stopped = joints.filter(|j| j.lower_stop.is_some() || j.upper_stop.is_some());
        Self {
            inputs: file.input.iter().map(|i| i.channel.clone()).collect(),
            outputs: file.output.iter().map(|o| o.channel.clone()).collect(),
            joint_channels: file.output.iter().filter(joint).map(|o| o.channel.clone()).collect(),
            driven: having(file.hydraulics.is_some() && make.is_some_and(|m| m.displacement.is_none())),
            tubes: having(make.is_some_and(|m| m.tube.is_some())),
            muscles,
            cables: file.cable.iter().map(|c| c.name.clone()).collect(),
            joints: stopped.flat_map(|j| j.joints.clone()).collect(),
        }
    }

    fn names(&self, argument: Argument) -> Vec<&str> {
        let names: &[String] = match argument {
            Argument::Channel => return self.inputs.iter().chain(&self.outputs).map(String::as_str).collect(),
            Argument::Input => &self.inputs,
            Argument::Muscle => &self.muscles,
            Argument::Cable => &self.cables,
            Argument::Joint => &self.joints,
            Argument::Number => &[],
        };
        names.iter().map(String::as_str).collect()
    }

    /// All channels, as an error lists them.
    pub fn channels(&self) -> String {
        self.names(Argument::Channel).join(", ")
    }

    /// A name that is there, or what is wrong with it.
    pub(super) fn checked(&self, argument: Argument, name: &str) -> Result<String, Wrong> {
        let names = self.names(argument);
        if names.contains(&name) {
            return Ok(name.to_owned());
        }
        let message = format!("the scene has no {} \"{name}\"{}", argument.word(), did_you_mean(name, &names));
        let remedy = match (argument, names.is_empty()) {
            (Argument::Channel, _) => format!("its channels are {}; add one with [[output]]", names.join(", ")),
            (_, true) => "take a figure that this scene has; see docs/sweeps.md".to_owned(),
            _ => format!("take one of {}", names.join(", ")),
        };
        Err((message, remedy))
    }

    /// Whether what a figure needs is there.
    pub(super) fn check(&self, call: &Call) -> Result<(), Wrong> {
        let (have, what) = match call.figure {
            Figure::CavitationMargin | Figure::Loss => {
                (self.driven.contains(&call.names[0]), "a muscle with a syringe")
            }
            Figure::YieldMargin | Figure::ClosedTime => {
                (self.tubes.contains(&call.names[0]), "a muscle of a tube in a coil")
            }
            Figure::Stiffness => (self.joint_channels.contains(&call.names[0]), "an output of quantity joint_position"),
            _ => (true, ""),
        };
        let positive = match call.figure {
            Figure::StopForce | Figure::Stiffness | Figure::Bandwidth => call.numbers[0] > 0.0,
            _ => true,
        };
        if !have {
            return Err((format!("\"{}\" is not {what}", call.names[0]), format!("name {what}")));
        }
        if !positive {
            return Err((format!("{} must be > 0", call.numbers[0]), "give lever, load or stroke above 0".to_owned()));
        }
        Ok(())
    }
}
