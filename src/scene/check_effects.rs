//! `[[effect]]` tables against the scene that carries them.

use std::path::Path;

use crate::effects::{Effect, Element, ElementKind, Kind};

use super::{SceneError, SceneFile};

/// Checks that every effect exists, has its numbers, and sits on an element that the scene has, once.
pub(super) fn check(scene: &SceneFile, file: &Path) -> Result<(), SceneError> {
    let mut seen: Vec<(Kind, Element, Option<String>)> = Vec::new();
    for (i, table) in scene.effect.iter().enumerate() {
        let refuse = |message: String, remedy: String| SceneError::Value {
            file: file.to_owned(),
            table: format!("[[effect]] {} \"{}\"", i + 1, table.name),
            message,
            remedy,
        };
        let effect = table.effect().map_err(|e| refuse(e.message, e.remedy))?;
        place(scene, &effect).map_err(|(message, remedy)| refuse(message, remedy))?;
        let key = (effect.kind, effect.element, effect.channel.clone());
        // Only relaxation has a spectrum: several branches on one muscle.
        if !effect.kind.may_repeat() && seen.contains(&key) {
            return Err(refuse("it stands twice on this element".to_owned(), "join the two tables".to_owned()));
        }
        seen.push(key);
    }
    Ok(())
}

/// Number of elements of a kind in a scene.
fn count(scene: &SceneFile, kind: ElementKind) -> usize {
    match kind {
        ElementKind::Muscle | ElementKind::Line | ElementKind::Syringe => scene.muscle.len(),
        ElementKind::Cable => scene.cable.len(),
        ElementKind::Mechanism => usize::from(scene.mechanism.is_some()),
        ElementKind::Sensor => 1,
    }
}

fn place(scene: &SceneFile, effect: &Effect<f64>) -> Result<(), (String, String)> {
    let element = effect.element;
    let count = count(scene, element.kind);
    let on_axis = scene.axis.is_some() && matches!(effect.kind, Kind::SealFriction);
    if element.index >= count && !on_axis {
        return Err((format!("element = \"{element}\" is not in this scene"), known(element.kind, count)));
    }
    if effect.kind == Kind::SealFriction && scene.axis.is_none() {
        return Err((
            "no channel of this scene shows the force on the plunger".to_owned(),
            "seal_friction needs an [axis]".to_owned(),
        ));
    }
    let turns = matches!(effect.kind, Kind::BearingFriction | Kind::ExternalContact | Kind::NotchClosure);
    if turns && scene.cable.is_empty() {
        return Err(("no joint of this scene is turned by a cable".to_owned(), "remove the effect".to_owned()));
    }
    if effect.kind == Kind::TendonCoupling && scene.cable.len() < 2 {
        return Err(("there is no second cable".to_owned(), "remove the effect".to_owned()));
    }
    let hydraulic = matches!(element.kind, ElementKind::Line | ElementKind::Syringe) && !on_axis;
    if hydraulic && scene.hydraulics.is_none() {
        return Err(("the scene has no [hydraulics]".to_owned(), "remove the effect".to_owned()));
    }
    if let Some(channel) = &effect.channel
        && !scene.output.iter().any(|o| o.channel == *channel)
    {
        let outputs: Vec<&str> = scene.output.iter().map(|o| o.channel.as_str()).collect();
        return Err((format!("channel = \"{channel}\" is no output"), format!("use one of: {}", outputs.join(", "))));
    }
    Ok(())
}

fn known(kind: ElementKind, count: usize) -> String {
    let names: Vec<String> = (0..count).map(|i| Element::of(kind, i, count).to_string()).collect();
    if names.is_empty() { format!("the scene has no {}", kind.name()) } else { format!("use {}", names.join(" or ")) }
}
