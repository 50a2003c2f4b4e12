//! `[[law]]` tables against the scene that carries them.

use std::path::Path;

use toml::Table;

use crate::laws::{Address, Carrier, Dimension, Law, LawTable, Port, Surroundings};
use crate::recording::parse_column;

use super::overrides::child;
use super::{SceneError, SceneFile, calibration_key};

/// Reads every law and checks that the scene has its port.
pub(super) fn check(scene: &SceneFile, file: &Path) -> Result<SceneLaws, SceneError> {
    let (mut laws, mut candidates) = (Vec::new(), Vec::new());
    for (i, table) in scene.law.iter().enumerate() {
        let refuse = |message: String, remedy: String| SceneError::Value {
            file: file.to_owned(),
            table: format!("[[law]] {} \"{}\"", i + 1, table.name),
            message,
            remedy,
        };
        if scene.law[..i].iter().any(|other| other.name == table.name) {
            return Err(refuse("the name stands twice".to_owned(), "give each law its own name".to_owned()));
        }
        let law = read(scene, table).map_err(|(message, remedy)| refuse(message, remedy))?;
        check_port(scene, &law.address).map_err(|(message, remedy)| refuse(message, remedy))?;
        if !table.candidate {
            laws.push(law);
            continue;
        }
        let size = law.size().ok_or_else(|| {
            refuse(
                "candidate = true: there is no parameter at whose zero the law vanishes".to_owned(),
                "give it a size: adds = \"a_n * ...\", or scales = \"1 + a * ...\"".to_owned(),
            )
        })?;
        candidates.push(Candidate { table: table.clone(), law, size });
    }
    Ok(SceneLaws { laws, candidates })
}

/// The laws of a scene, and what it only proposes.
pub(super) struct SceneLaws {
    pub laws: Vec<Law>,
    pub candidates: Vec<Candidate>,
}

/// A law that a diagnosis weighs against everything else.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub table: LawTable,
    pub law: Law,
    /// The parameter at whose zero it vanishes.
    pub size: usize,
}

/// A law of a scene, a candidate too.
pub(super) fn read(scene: &SceneFile, table: &LawTable) -> Result<Law, (String, String)> {
    let channel = table.port.trim().strip_prefix("sensor.").map(str::to_owned);
    let own = channel.as_deref().map(on_channel).unwrap_or_default();
    let around = Surroundings { conditions: conditions(scene), ..own };
    table.law(&around).map_err(|e| (e.message, e.remedy))
}

/// What a law may know that acts on what a channel shows.
pub fn on_channel(column: &str) -> Surroundings {
    let unit = parse_column(column).ok().map(|name| name.unit);
    let channel = unit.and_then(|unit| Dimension::of_name(&format!("x_{}", unit.si_suffix)));
    Surroundings { channel, ..Surroundings::default() }
}

/// The run's conditions that set one number, each with the value that the scene has for it.
fn conditions(scene: &SceneFile) -> Vec<(String, f64)> {
    if scene.condition.is_empty() {
        return Vec::new();
    }
    let Ok(table) = Table::try_from(scene) else { return Vec::new() };
    let root = &mut toml::Value::Table(table);
    let number = |key: &str| {
        let mut here = &mut *root;
        for segment in calibration_key(key).split('.') {
            here = child(here, segment)?;
        }
        here.as_float().or_else(|| here.as_integer().map(|i| i as f64))
    };
    let mut number = number;
    let known = scene.condition.iter().filter_map(|c| Some((c.name.clone(), number(c.keys.first()?)?)));
    known.collect()
}

/// Whether the scene has what the port belongs to; what needs the mechanism is checked when it is there.
fn check_port(scene: &SceneFile, address: &Address) -> Result<(), (String, String)> {
    let lacks = |what: &str, remedy: String| Err((format!("port = \"{address}\": {what}"), remedy));
    let fluid = "add [hydraulics] and drive the muscle by a plunger, or take another port".to_owned();
    let count = match address.port.spec().carrier {
        Carrier::Muscle => scene.muscle.len(),
        Carrier::Cable => scene.cable.len(),
        Carrier::Joint if scene.mechanism.is_none() => {
            return lacks("the scene has no mechanism", "add [mechanism] with a URDF, or take another port".to_owned());
        }
        Carrier::Joint => return Ok(()),
        Carrier::Alone => return check_alone(scene, address),
        Carrier::Sensor => return check_channel(scene, address),
    };
    let element = address.port.spec().element;
    if count == 0 {
        return lacks(&format!("the scene has no {element}"), "take another port, or another scene".to_owned());
    }
    if address.number.is_some_and(|n| n >= count) {
        return lacks(
            &format!("the scene has {count}"),
            format!("number it from 1 to {count}, or leave the number out for all"),
        );
    }
    if scene.muscles.as_ref().is_some_and(|m| m.displacement.is_some())
        && address.port.spec().carrier == Carrier::Muscle
    {
        let remedy = "describe the muscle by [muscles.tube] or [muscles.linear]".to_owned();
        return lacks("[muscles.displacement] is a formula without fluid, wall or pull", remedy);
    }
    if address.port < Port::Pull && scene.hydraulics.is_none() {
        return lacks("the scene has no [hydraulics]", fluid);
    }
    if address.port == Port::Friction && scene.muscles.as_ref().is_some_and(|m| m.friction.is_none()) {
        let remedy = "add [muscles.friction] with m0_n and presliding_length_m, or act on muscle.pull".to_owned();
        return lacks("the muscles have no [muscles.friction]", remedy);
    }
    Ok(())
}

/// Whether the scene has the element that stands alone.
fn check_alone(scene: &SceneFile, address: &Address) -> Result<(), (String, String)> {
    let element = address.port.spec().element;
    let here = [("axis", scene.axis.is_some()), ("strip", scene.strip.is_some()), ("chamber", scene.chamber.is_some())];
    match here.into_iter().find(|(_, is_here)| *is_here) {
        Some((own, _)) if own == element => Ok(()),
        own => {
            let remedy = match own {
                Some((own, _)) => format!("take a port of the {own}: `smam laws --scene NAME` lists those of a scene"),
                None => format!("take another port, or a scene with [{element}]"),
            };
            Err((format!("port = \"{address}\": the scene has no {element}"), remedy))
        }
    }
}

fn check_channel(scene: &SceneFile, address: &Address) -> Result<(), (String, String)> {
    let channel = address.of.as_deref().unwrap_or("");
    if scene.output.iter().any(|o| o.channel == channel) {
        return Ok(());
    }
    let outputs: Vec<&str> = scene.output.iter().map(|o| o.channel.as_str()).collect();
    let near = crate::nearest::did_you_mean(channel, &outputs);
    Err((
        format!("port = \"{address}\": \"{channel}\" is no output{near}"),
        format!("use one of: {}", outputs.join(", ")),
    ))
}
