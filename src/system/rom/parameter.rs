//! Calibrated parameters of the reduced-order model, by scene key.

use std::borrow::Cow;

use crate::muscle::Material;
use crate::scalar::Scalar;
use crate::scene::{MuscleSpec, muscles_set_by};
use crate::system::plant::{Drive, MusclePlant, Plant};
use crate::system::standalone::Standalone;
use crate::system::{Elastic, StandaloneNumber};

use super::Rom;

/// A number of the scene that the reduced-order model can vary, with derivatives.
#[derive(Clone, Debug, PartialEq)]
pub enum RomParameter {
    /// A number of muscles, and of which.
    Muscle(MuscleNumber, Vec<usize>),
    CableStiffness(usize),
    /// Coordinates whose springs it sets, each with the share of one hinge in the coordinate.
    JointStiffness(Vec<(usize, f64)>),
    Standalone(StandaloneNumber),
    /// A parameter of a law of the scene: both by index.
    Law(usize, usize),
    /// A parameter of a law on what a channel shows: output, law on it, parameter.
    SensorLaw(usize, usize, usize),
}

/// A number of a muscle or of the line before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MuscleNumber {
    TubeC1,
    CoilStiffness,
    AreaGrowth,
    UpstreamCompliance,
    DownstreamCompliance,
    FrictionM0,
    FrictionM1,
    Presliding,
    Damping,
    LinearStiffness,
    PressureGain,
}

/// The number of muscles that a scene key stands for, with the muscles that it sets.
fn muscle_number(muscles: &[MuscleSpec], key: &str) -> Option<(MuscleNumber, Vec<usize>)> {
    use MuscleNumber as P;
    let all = || ((0..muscles.len()).collect(), Cow::Borrowed(key));
    let (set, key) = muscles_set_by(muscles, key).unwrap_or_else(all);
    let number = match key.as_ref() {
        "muscles.tube.material.c1_pa" => P::TubeC1,
        "muscles.tube.coil.stiffness_n_m" => P::CoilStiffness,
        "muscles.tube.area_growth_1_m" => P::AreaGrowth,
        "hydraulics.upstream_compliance_m3_pa" => P::UpstreamCompliance,
        "hydraulics.downstream_compliance_m3_pa" => P::DownstreamCompliance,
        "muscles.friction.m0_n" => P::FrictionM0,
        "muscles.friction.m1_n_pa" => P::FrictionM1,
        "muscles.friction.presliding_length_m" => P::Presliding,
        "muscles.damping_n_s_m" => P::Damping,
        "muscles.linear.stiffness_n_m" => P::LinearStiffness,
        "muscles.linear.pressure_gain_m2" => P::PressureGain,
        _ => return None,
    };
    Some((number, set))
}

/// The parameter of a full scene key.
pub(super) fn resolve(rom: &Rom, key: &str) -> Option<RomParameter> {
    use RomParameter as P;
    if let Some((number, muscles)) = muscle_number(&rom.muscles, key) {
        return Some(P::Muscle(number, muscles));
    }
    if let Some(number) = Standalone::number(key) {
        return Some(P::Standalone(number));
    }
    resolve_named(rom, key)
}

/// Keys with a name or a number in them: cables, joint springs.
fn resolve_named(rom: &Rom, key: &str) -> Option<RomParameter> {
    let words: Vec<&str> = key.split('.').collect();
    match words.as_slice() {
        ["cable", name, "stiffness_n_m"] => {
            let by_name = rom.cable_names.iter().position(|n| n == name);
            let by_number = name.parse().ok().filter(|i| *i < rom.cable_names.len());
            Some(RomParameter::CableStiffness(by_name.or(by_number)?))
        }
        ["law", name, "parameter", parameter, "value"] => {
            let laws = rom.plant.laws.as_ref().map_or(&[][..], |laws| laws.laws());
            if let Some(law) = laws.iter().position(|law| law.name == *name) {
                return Some(RomParameter::Law(law, laws[law].parameter(parameter)?));
            }
            if let Some(number) = rom.standalone.as_ref().and_then(|alone| alone.number_of_law(name, parameter)) {
                return Some(RomParameter::Standalone(number));
            }
            let shown = rom.outputs.iter().enumerate().find_map(|(o, output)| {
                let law = output.laws.iter().position(|law| law.name == *name)?;
                Some((o, law, &output.laws[law]))
            });
            let (output, at, law) = shown?;
            Some(RomParameter::SensorLaw(output, at, law.parameter(parameter)?))
        }
        ["mechanism", "joint", number, "stiffness_n_m_rad" | "stiffness_n_m"] => {
            let number: usize = number.parse().ok()?;
            let springs = rom.spring_table.iter().enumerate().filter(|(_, t)| **t == Some(number));
            let springs: Vec<_> = springs.map(|(i, _)| (i, 1.0 / rom.site.hinges[i] as f64)).collect();
            (!springs.is_empty()).then_some(RomParameter::JointStiffness(springs))
        }
        _ => None,
    }
}

impl RomParameter {
    /// Puts a value into a plant.
    pub(super) fn put<D: Scalar>(&self, value: D, plant: &mut Plant<D>) {
        match self {
            Self::CableStiffness(i) => plant.cables[*i].stiffness_n_m = value,
            Self::JointStiffness(springs) => {
                springs.iter().for_each(|(i, share)| plant.coordinates.stiffness[*i] = value * *share);
            }
            Self::Standalone(_) | Self::SensorLaw(..) => {}
            Self::Law(law, parameter) => {
                if let Some(laws) = &mut plant.laws {
                    laws.set(*law, *parameter, value);
                }
            }
            Self::Muscle(number, muscles) => muscles.iter().for_each(|m| number.put(value, &mut plant.muscles[*m])),
        }
    }
}

impl MuscleNumber {
    fn put<D: Scalar>(self, value: D, muscle: &mut MusclePlant<D>) {
        match (self, &mut muscle.elastic, &mut muscle.friction, &mut muscle.drive) {
            (Self::TubeC1, Elastic::Tube { wall, .. }, _, _) => {
                let material = match *wall.material() {
                    Material::NeoHookean { .. } => Material::NeoHookean { c1_pa: value },
                    Material::Yeoh { c2_pa, c3_pa, .. } => Material::Yeoh { c1_pa: value, c2_pa, c3_pa },
                    other => other,
                };
                *wall = wall.with_material(material);
            }
            (Self::CoilStiffness, Elastic::Tube { coil, .. }, _, _) => coil.stiffness_n_m = value,
            (Self::AreaGrowth, Elastic::Tube { area_growth_1_m, .. }, _, _) => *area_growth_1_m = value,
            (Self::LinearStiffness, Elastic::Linear { stiffness_n_m, .. }, _, _) => *stiffness_n_m = value,
            (Self::PressureGain, Elastic::Linear { pressure_gain_m2, .. }, _, _) => *pressure_gain_m2 = value,
            (Self::FrictionM0, _, Some(friction), _) => friction.m0_n = value,
            (Self::FrictionM1, _, Some(friction), _) => friction.m1_n_pa = value,
            (Self::Presliding, _, Some(friction), _) => friction.presliding_length_m = value,
            (Self::Damping, ..) => muscle.damping_n_s_m = value,
            (Self::UpstreamCompliance, _, _, Drive::Hydraulic { chain, .. }) => chain.set_upstream(value),
            (Self::DownstreamCompliance, _, _, Drive::Hydraulic { chain, .. }) => chain.set_downstream(value),
            _ => {}
        }
    }
}
