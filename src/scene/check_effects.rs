//! `[[effect]]` tables against the scene that carries them.

use std::path::Path;

use crate::effects::{Effect, Element, ElementKind, EntryId, Part};

use super::{MuscleSpec, SceneError, SceneFile};
use crate::recording::parse_column;

/// Checks that every effect exists, has its numbers, and sits on an element that the scene has, once.
pub(super) fn check(scene: &SceneFile, file: &Path) -> Result<(), SceneError> {
    let mut seen: Vec<(EntryId, Element, Option<String>)> = Vec::new();
    for (i, table) in scene.effect.iter().enumerate() {
        let refuse = |message: String, remedy: String| SceneError::Value {
            file: file.to_owned(),
            table: format!("[[effect]] {} \"{}\"", i + 1, table.name),
            message,
            remedy,
        };
        let effect = table.effect().map_err(|e| refuse(e.message, e.remedy))?;
        place(scene, &effect).map_err(|(message, remedy)| refuse(message, remedy))?;
        let key = (effect.entry, effect.element, effect.channel.clone());
        if !effect.entry.may_repeat && seen.contains(&key) {
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

/// Message and remedy.
type Refusal = (String, String);

fn refuse(message: &str, remedy: &str) -> Result<(), Refusal> {
    Err((message.to_owned(), remedy.to_owned()))
}

fn place(scene: &SceneFile, effect: &Effect<f64>) -> Result<(), Refusal> {
    let element = effect.element;
    if let Some(answer) = on_standalone(scene, effect) {
        return answer.and_then(|()| check_channel(scene, effect));
    }
    let count = count(scene, element.kind);
    let on_axis = scene.axis.is_some() && needs(effect, Part::Axis);
    let is_there = element.index < count || on_axis;
    match effect.entry.needs.iter().find(|need| !has(scene, need.scene, element)) {
        Some(need) if is_there || effect.entry.stands_on.is_some() => return refuse(&need.message, &need.remedy),
        _ if !is_there => {
            return Err((format!("element = \"{element}\" is not in this scene"), known(element.kind, count)));
        }
        _ => {}
    }
    let hydraulic = matches!(element.kind, ElementKind::Line | ElementKind::Syringe) && !on_axis;
    if hydraulic && scene.hydraulics.is_none() {
        return refuse("the scene has no [hydraulics]", "remove the effect");
    }
    without_effect(scene, effect)?;
    check_channel(scene, effect)
}

fn needs(effect: &Effect<f64>, part: Part) -> bool {
    effect.entry.needs.iter().any(|need| need.scene == part)
}

/// Whether a scene has what an effect on this element acts on.
fn has(scene: &SceneFile, part: Part, element: Element) -> bool {
    // A formula in place of the muscles has no parts: that it changes nothing is said below.
    let make = scene.muscles.as_ref().filter(|make| make.displacement.is_none());
    match part {
        Part::Axis => scene.axis.is_some(),
        Part::Strip => scene.strip.is_some(),
        Part::Chamber => scene.chamber.is_some(),
        Part::Cable => !scene.cable.is_empty(),
        Part::DrivenCable => element.indices(scene.cable.len()).all(|i| scene.cable[i].drive.is_some()),
        Part::SecondCable => scene.cable.len() >= 2,
        Part::Wall => make.is_none_or(|make| make.linear.is_none()),
        Part::MuscleFriction => make.is_none_or(|make| make.friction.is_some()),
    }
}

/// What a strip or a chamber says to an effect: it has effects of its own; those of sensors are everywhere. `None` leaves the
/// answer to what follows.
fn on_standalone(scene: &SceneFile, effect: &Effect<f64>) -> Option<Result<(), Refusal>> {
    let own = [Part::Strip, Part::Chamber].into_iter().find(|part| has(scene, *part, effect.element))?;
    if effect.element.kind == ElementKind::Sensor {
        return None;
    }
    Some(match (effect.entry.stands_on == Some(own), own) {
        (true, Part::Strip) if effect.element.index > 0 => {
            refuse("there is one strip", "leave the number out of `element`")
        }
        // Of another chamber ([chamber] number): a file may hold what was found of several.
        (true, _) => Ok(()),
        (false, Part::Strip) => {
            refuse("it is none of a [strip]", "a strip has viscoelasticity, rubber_law and the effects of sensors")
        }
        (false, _) => refuse(
            "it is none of a [chamber]",
            "a chamber has leak (rate_1_s, laminar_rate_1_s, orifice_rate_1_s) and the effects of sensors",
        ),
    })
}

fn check_channel(scene: &SceneFile, effect: &Effect<f64>) -> Result<(), Refusal> {
    if let Some(channel) = &effect.channel
        && !scene.output.iter().any(|o| o.channel == *channel)
    {
        let outputs: Vec<&str> = scene.output.iter().map(|o| o.channel.as_str()).collect();
        return Err((format!("channel = \"{channel}\" is no output"), super::check_names::one_of(&outputs)));
    }
    Ok(())
}

/// Refuses an effect that would change nothing at all on the muscles that this scene has.
fn without_effect(scene: &SceneFile, effect: &Effect<f64>) -> Result<(), Refusal> {
    let is_fluid = matches!(effect.element.kind, ElementKind::Syringe | ElementKind::Line);
    let is_inside = is_fluid || effect.element.kind == ElementKind::Muscle;
    let Some(make) = scene.muscles.as_ref().filter(|_| is_inside) else { return Ok(()) };
    if make.displacement.is_some() {
        return refuse(
            "it changes nothing: [muscles.displacement] is a formula without fluid, wall or pull",
            "remove the effect, or put it on a scene with [muscles.tube] or [muscles.linear]",
        );
    }
    let by_pressure = |m: &MuscleSpec| parse_column(&m.input).is_ok_and(|name| name.unit.si_suffix == "pa");
    let own = scene.muscle.get(effect.element.indices(scene.muscle.len())).unwrap_or(&[]);
    if is_fluid && !own.is_empty() && own.iter().all(by_pressure) {
        return refuse(
            "it changes nothing: the input is a pressure, no fluid is simulated before the muscle",
            "remove the effect, or drive the muscle by a plunger",
        );
    }
    Ok(())
}

fn known(kind: ElementKind, count: usize) -> String {
    let names: Vec<String> = (0..count).map(|i| Element::of(kind, i, count).to_string()).collect();
    if names.is_empty() { format!("the scene has no {}", kind.name()) } else { format!("use {}", names.join(" or ")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// What a stock scene says to an effect; `without` is a table that it loses first.
    fn answer(scene: &str, without: &str, effect: &str) -> Result<(), String> {
        let mut file = Scene::load(scene, &[]).unwrap_or_else(|e| panic!("{e}")).file;
        if without == "friction" {
            file.muscles.as_mut().expect("muscles").friction = None;
        }
        file.effect.push(toml::from_str(effect).expect("TOML"));
        check(&file, Path::new("mine.toml")).map_err(|e| e.to_string())
    }

    #[test]
    fn effects_that_would_change_nothing_are_refused_with_place_and_remedy() {
        let relaxes = "name = \"viscoelasticity\"\nelement = \"muscle\"\nstiffness_n_m = 6\nrelaxation_time_s = 4";
        let pulls = "name = \"hypothetical_force\"\nelement = \"muscle\"\nforce_n = 0.1";
        let softens = "name = \"mullins_softening\"\nelement = \"muscle\"\nsoftening_ratio = 0.1";
        let rubs = "name = \"pressure_friction\"\nelement = \"muscle\"\nfriction_per_pressure_n_pa = 1e-7";
        let cases = [
            ("muscle_printed_model", "", relaxes, "[muscles.displacement] is a formula"),
            ("muscle_printed_model", "", pulls, "[muscles.displacement] is a formula"),
            ("pressure_muscle", "", softens, "no wall that could soften"),
            ("muscle_bench", "friction", rubs, "no [muscles.friction]"),
        ];
        for (scene, without, effect, why) in cases {
            let said = answer(scene, without, effect).expect_err(effect);
            assert!(said.contains("mine.toml") && said.contains("[[effect]] 1") && said.contains(why), "{said}");
            assert!(said.contains("remove the effect"), "{said}");
        }
    }

    #[test]
    fn the_same_effects_are_taken_where_they_act() {
        let relaxes = "name = \"viscoelasticity\"\nelement = \"muscle\"\nstiffness_n_m = 6\nrelaxation_time_s = 4";
        let softens = "name = \"mullins_softening\"\nelement = \"muscle\"\nsoftening_ratio = 0.1";
        let rubs = "name = \"pressure_friction\"\nelement = \"muscle\"\nfriction_per_pressure_n_pa = 1e-7";
        for (scene, effect) in [("pressure_muscle", relaxes), ("muscle_bench", softens), ("muscle_bench", rubs)] {
            assert_eq!(answer(scene, "", effect), Ok(()), "{scene}");
        }
    }
}
