//! Numbers and names of a scene file.

use std::path::Path;

use crate::recording::parse_column;

use super::check_muscles::check_make;
use super::check_names::{check_name, one_of};
use super::check_standalone;
use super::{ExpectSpec, HydraulicsSpec, Measure, MuscleSpec, OutputSpec, Program, Quantity, SceneError, SceneFile};

/// Collects where in the file a value stands.
pub(super) struct Place<'a> {
    pub file: &'a Path,
    pub table: String,
}

impl Place<'_> {
    pub fn error(&self, message: impl Into<String>, remedy: impl Into<String>) -> SceneError {
        SceneError::Value {
            file: self.file.to_owned(),
            table: self.table.clone(),
            message: message.into(),
            remedy: remedy.into(),
        }
    }

    pub fn positive(&self, key: &str, value: f64) -> Result<(), SceneError> {
        if value > 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(self.error(format!("{key} = {value} must be > 0"), format!("give {key} a positive number in SI units")))
        }
    }

    pub fn not_negative(&self, key: &str, value: f64) -> Result<(), SceneError> {
        if value >= 0.0 && value.is_finite() {
            Ok(())
        } else {
            Err(self.error(
                format!("{key} = {value} must be >= 0"),
                format!("give {key} a number that is not negative, in SI units"),
            ))
        }
    }

    pub fn finite(&self, key: &str, value: f64) -> Result<(), SceneError> {
        if value.is_finite() {
            return Ok(());
        }
        Err(self.error(format!("{key} = {value} must be finite"), format!("give {key} a number in SI units")))
    }

    pub fn known(&self, key: &str, name: &str, known: &[&str]) -> Result<(), SceneError> {
        if known.contains(&name) {
            return Ok(());
        }
        Err(self.error(format!("{key} = \"{name}\" is not in this scene"), one_of(known)))
    }

    fn unique<'b>(&self, key: &str, names: impl Iterator<Item = &'b str>) -> Result<(), SceneError> {
        let mut seen: Vec<&str> = Vec::new();
        for name in names {
            if seen.contains(&name) {
                return Err(self.error(format!("{key} = \"{name}\" stands twice"), "give each its own name"));
            }
            seen.push(name);
        }
        Ok(())
    }
}

/// Checks everything that needs no mechanism and no other file; returns the input programmes.
pub(super) fn check(scene: &SceneFile, file: &Path) -> Result<Vec<Program>, SceneError> {
    let at = |table: String| Place { file, table };
    let top = at("top level".to_owned());
    if scene.format != 1 {
        return Err(top.error(format!("format = {} is unknown", scene.format), "this program reads format = 1"));
    }
    check_name(&scene.name, &top)?;
    check_simulation(scene, &at("[simulation]".to_owned()))?;
    let programs = check_inputs(scene, file)?;
    if let Some(hydraulics) = &scene.hydraulics {
        check_hydraulics(hydraulics, &at("[hydraulics]".to_owned()))?;
    }
    if let Some(muscles) = &scene.muscles {
        check_make(muscles, file, &str::to_owned)?;
    }
    at("[[muscle]]".to_owned()).unique("name", scene.muscle.iter().map(|m| m.name.as_str()))?;
    at("[[cable]]".to_owned()).unique("name", scene.cable.iter().map(|c| c.name.as_str()))?;
    for muscle in &scene.muscle {
        check_muscle(scene, muscle, &at(format!("[[muscle]] \"{}\"", muscle.name)))?;
    }
    for cable in &scene.cable {
        let place = at(format!("[[cable]] \"{}\"", cable.name));
        place.positive("stiffness_n_m", cable.stiffness_n_m)?;
        place.not_negative("damping_n_s_m", cable.damping_n_s_m)?;
        place.not_negative("pretension_n", cable.pretension_n)?;
        place.not_negative("sheath_angle_rad", cable.sheath_angle_rad)?;
        if let Some(drive) = &cable.drive {
            place.known("drive.input", &drive.input, &input_names(scene))?;
        }
    }
    for load in &scene.load {
        let place = at(format!("[[load]] \"{}\"", load.joint));
        place.finite("force_n", load.force_n.unwrap_or(0.0))?;
        place.finite("torque_n_m", load.torque_n_m.unwrap_or(0.0))?;
    }
    check_standalone::check(scene, file)?;
    for calibrate in &scene.calibrate {
        check_range(calibrate.min, calibrate.max, &at(format!("[[calibrate]] \"{}\"", calibrate.key)))?;
    }
    check_outputs(scene, file)?;
    super::check_effects::check(scene, file)?;
    Ok(programs)
}

fn check_range(min: f64, max: f64, place: &Place) -> Result<(), SceneError> {
    if min.is_finite() && max.is_finite() && min < max {
        return Ok(());
    }
    Err(place.error(
        format!("min = {min:?} must be < max = {max:?}"),
        "give the range in SI units, the smaller number as min",
    ))
}

pub(super) fn input_names(scene: &SceneFile) -> Vec<&str> {
    scene.input.iter().map(|i| i.channel.as_str()).collect()
}

fn check_simulation(scene: &SceneFile, place: &Place) -> Result<(), SceneError> {
    let s = &scene.simulation;
    place.positive("duration_s", s.duration_s)?;
    place.positive("step_s", s.step_s)?;
    place.positive("output_interval_s", s.output_interval_s)?;
    if s.substeps == 0 || s.substeps > 10_000 {
        return Err(place.error(
            format!("substeps = {} must be 1 to 10000", s.substeps),
            "choose substeps so that step_s/substeps is about 1e-4 s",
        ));
    }
    if s.duration_s / s.output_interval_s > 1e8 {
        return Err(place
            .error("duration_s / output_interval_s is more than 1e8 samples", "shorten the run or record less often"));
    }
    if s.duration_s / s.step_s > 1e9 {
        return Err(place.error(
            format!("step_s = {:e} cuts the run into more than 1e9 steps", s.step_s),
            "take a longer step, 1e-3 s is usual, or shorten the run",
        ));
    }
    Ok(())
}

pub(super) fn check_inputs(scene: &SceneFile, file: &Path) -> Result<Vec<Program>, SceneError> {
    let list = Place { file, table: "[[input]]".to_owned() };
    list.unique("channel", scene.input.iter().map(|i| i.channel.as_str()))?;
    let mut programs = Vec::new();
    for input in &scene.input {
        let place = Place { file, table: format!("[[input]] \"{}\"", input.channel) };
        let unit = si_unit(&input.channel, &place)?;
        let program = Program::parse(&input.program, unit).map_err(|message| {
            place.error(message, "docs/scene-files.md has the table of programmes with their keys")
        })?;
        programs.push(program);
    }
    Ok(programs)
}

fn si_unit(channel: &str, place: &Place) -> Result<&'static str, SceneError> {
    parse_column(channel).map(|name| name.unit.si_suffix).map_err(|_| {
        let message = format!("channel = \"{channel}\": its name ends in no known unit");
        place.error(message, "end it in its unit, for example plunger_mm; docs/recordings.md lists the units")
    })
}

fn check_hydraulics(h: &HydraulicsSpec, place: &Place) -> Result<(), SceneError> {
    place.positive("syringe.bore_m", h.syringe.bore_m)?;
    place.positive("line.length_m", h.line.length_m)?;
    place.positive("line.bore_m", h.line.bore_m)?;
    place.positive("upstream_compliance_m3_pa", h.upstream_compliance_m3_pa)?;
    place.positive("downstream_compliance_m3_pa", h.downstream_compliance_m3_pa)?;
    place.not_negative("line.compliance_m3_pa", h.line.compliance_m3_pa)?;
    place.positive("fluid.density_kg_m3", h.fluid.density_kg_m3)?;
    place.not_negative("fluid.viscosity_pa_s", h.fluid.viscosity_pa_s)?;
    place.not_negative("fluid.vapour_pressure_pa", h.fluid.vapour_pressure_pa)?;
    place.not_negative("fluid.tensile_strength_pa", h.fluid.tensile_strength_pa)?;
    place.positive("fluid.atmospheric_pressure_pa", h.fluid.atmospheric_pressure_pa)?;
    if !(1..=1000).contains(&h.line.segments) {
        return Err(place.error(
            format!("line.segments = {} must be 1 to 1000", h.line.segments),
            "start with 1; 16 are exact to 1 % up to 50 Hz",
        ));
    }
    if h.line.segments > 1 && h.line.compliance_m3_pa <= 0.0 {
        return Err(place.error(
            format!("line.segments = {} needs line.compliance_m3_pa > 0", h.line.segments),
            "give the line's own compliance, or set line.segments = 1",
        ));
    }
    if !(1.0..=4.0 / 3.0 + 1e-12).contains(&h.line.momentum_factor) {
        return Err(place.error(
            format!("line.momentum_factor = {} must be 1 to 4/3", h.line.momentum_factor),
            "give 4/3 for laminar flow, 1 for a flat profile",
        ));
    }
    Ok(())
}

fn check_muscle(scene: &SceneFile, muscle: &MuscleSpec, place: &Place) -> Result<(), SceneError> {
    let Some(make) = &scene.muscles else {
        return Err(place.error("there is no [muscles] table", "say once in [muscles] what the muscles are made like"));
    };
    place.known("input", &muscle.input, &input_names(scene))?;
    match (&muscle.joint, &muscle.cable) {
        (Some(_), None) if make.displacement.is_some() => {
            return Err(place.error(
                "a muscle of [muscles.displacement] moves its end, so it needs a cable",
                "replace `joint` by `cable`",
            ));
        }
        (Some(_), None) => {}
        (None, Some(cable)) => {
            let cables: Vec<&str> = scene.cable.iter().map(|c| c.name.as_str()).collect();
            place.known("cable", cable, &cables)?;
            if make.displacement.is_none() {
                place.positive("end_mass_kg (of [muscles])", make.end_mass_kg)?;
            }
        }
        _ => {
            return Err(place
                .error("exactly one of `joint` and `cable` is needed", "say what the muscle's free end is fixed to"));
        }
    }
    let by_pressure = si_unit(&muscle.input, place)? == "pa";
    if !by_pressure && scene.hydraulics.is_none() && make.displacement.is_none() {
        return Err(place.error(
            "it is driven by a plunger, but there is no [hydraulics] table",
            "add [hydraulics], or drive it by a pressure channel",
        ));
    }
    Ok(())
}

/// SI unit of each quantity; positions of joints may be angles or lengths.
fn units_of(quantity: Quantity) -> &'static [&'static str] {
    match quantity {
        Quantity::Elongation
        | Quantity::BodyX
        | Quantity::BodyY
        | Quantity::BodyZ
        | Quantity::ArcTipX
        | Quantity::ArcTipZ => &["m"],
        Quantity::SyringePressure | Quantity::MusclePressure | Quantity::ChamberPressure => &["pa"],
        Quantity::Pull | Quantity::Tension | Quantity::AxisForce | Quantity::StripForce => &["n"],
        Quantity::BodyRotationX | Quantity::BodyRotationY | Quantity::BodyRotationZ => &["rad"],
        Quantity::JointPosition => &["rad", "m"],
    }
}

fn check_outputs(scene: &SceneFile, file: &Path) -> Result<(), SceneError> {
    let list = Place { file, table: "[[output]]".to_owned() };
    let columns =
        || scene.input.iter().map(|i| i.channel.as_str()).chain(scene.output.iter().map(|o| o.channel.as_str()));
    list.unique("channel", columns())?;
    if scene.output.is_empty() {
        return Err(list.error("there is no output", "name at least one output channel"));
    }
    for output in &scene.output {
        check_output(scene, output, &Place { file, table: format!("[[output]] \"{}\"", output.channel) })?;
    }
    let known: Vec<&str> = columns().collect();
    for expect in &scene.expect {
        check_expect(expect, &known, &Place { file, table: format!("[[expect]] \"{}\"", expect.name) })?;
    }
    for (x, y) in &scene.view.loops {
        let place = Place { file, table: "[view]".to_owned() };
        place.known("loops", x, &known)?;
        place.known("loops", y, &known)?;
    }
    Ok(())
}

fn check_output(scene: &SceneFile, output: &OutputSpec, place: &Place) -> Result<(), SceneError> {
    let unit = si_unit(&output.channel, place)?;
    let units = units_of(output.quantity);
    if !units.contains(&unit) {
        return Err(place.error(
            format!("the channel's unit does not fit the quantity {:?}", output.quantity),
            format!("end the name in a unit of {}", units.join(" or ")),
        ));
    }
    let muscles: Vec<&str> = scene.muscle.iter().map(|m| m.name.as_str()).collect();
    let cables: Vec<&str> = scene.cable.iter().map(|c| c.name.as_str()).collect();
    let known = match output.quantity {
        Quantity::Elongation | Quantity::SyringePressure | Quantity::MusclePressure | Quantity::Pull => &muscles,
        Quantity::Tension => &cables,
        _ => return Ok(()),
    };
    match output.of.as_slice() {
        [one] => place.known("of", one, known),
        _ => Err(place.error("`of` must name exactly one", one_of(known))),
    }
}

fn check_expect(expect: &ExpectSpec, known: &[&str], place: &Place) -> Result<(), SceneError> {
    place.known("channel", &expect.channel, known)?;
    if expect.min.is_none() && expect.max.is_none() {
        return Err(place.error("neither `min` nor `max` is given", "say what passes"));
    }
    if let (Some(min), Some(max)) = (expect.min, expect.max)
        && min > max
    {
        return Err(place.error(format!("min = {min} is above max = {max}: nothing can pass"), "exchange them"));
    }
    let missing = match expect.measure {
        Measure::ValueAt => expect.at_s.is_none().then_some("at_s"),
        Measure::LoopWidth => (expect.against.is_none() || expect.at.is_none()).then_some("against and at"),
        Measure::RSquared => expect.against.is_none().then_some("against"),
        Measure::Rmse => expect.file.is_none().then_some("file"),
        _ => None,
    };
    if let Some(key) = missing {
        return Err(place.error(format!("this measure needs {key}"), format!("add {key}")));
    }
    match &expect.against {
        Some(against) => place.known("against", against, known),
        None => Ok(()),
    }
}
