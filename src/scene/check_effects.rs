//! `[[effect]]` tables against the scene that carries them.

use std::path::Path;

use crate::effects::{Effect, Element, ElementKind, Kind};

use super::{MuscleSpec, SceneError, SceneFile};
use crate::recording::parse_column;

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
    if let Some(answer) = on_standalone(scene, effect) {
        return answer.and_then(|()| check_channel(scene, effect));
    }
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
    if let Some(refusal) = without_effect(scene, effect) {
        return Err(refusal);
    }
    check_channel(scene, effect)
}

/// What a strip or a chamber says to an effect: it has effects of its own; those of sensors are everywhere. `None` leaves the
/// answer to what follows.
fn on_standalone(scene: &SceneFile, effect: &Effect<f64>) -> Option<Result<(), (String, String)>> {
    let of_rubber =
        matches!(effect.kind, Kind::RubberYeoh | Kind::RubberMooneyRivlin | Kind::RubberOgden | Kind::RubberGent);
    let of_gas = matches!(effect.kind, Kind::ChamberLeak | Kind::ChamberGap | Kind::ChamberOrifice);
    let refuse = |what: &str, remedy: &str| Some(Err((what.to_owned(), remedy.to_owned())));
    if effect.element.kind == ElementKind::Sensor {
        return None;
    }
    if scene.strip.is_some() && (of_rubber || effect.kind == Kind::Viscoelasticity) || scene.chamber.is_some() && of_gas
    {
        return match effect.element.index {
            0 => Some(Ok(())),
            // Of another chamber ([chamber] number): a file may hold what was found of several.
            _ if scene.chamber.is_some() => Some(Ok(())),
            _ => refuse("there is one strip", "leave the number out of `element`"),
        };
    }
    if scene.strip.is_some() {
        return refuse("it is none of a [strip]", "a strip has viscoelasticity, rubber_law and the effects of sensors");
    }
    if scene.chamber.is_some() {
        return refuse(
            "it is none of a [chamber]",
            "a chamber has leak (rate_1_s, laminar_rate_1_s, orifice_rate_1_s) and the effects of sensors",
        );
    }
    if of_rubber {
        return refuse("it needs a [strip]", "a muscle's wall has its law in [muscles.tube.material]: write it there");
    }
    if of_gas {
        return refuse("it needs a [chamber]", "a leak of a line is given by conductance_m3_s_pa");
    }
    None
}

fn check_channel(scene: &SceneFile, effect: &Effect<f64>) -> Result<(), (String, String)> {
    if let Some(channel) = &effect.channel
        && !scene.output.iter().any(|o| o.channel == *channel)
    {
        let outputs: Vec<&str> = scene.output.iter().map(|o| o.channel.as_str()).collect();
        return Err((format!("channel = \"{channel}\" is no output"), format!("use one of: {}", outputs.join(", "))));
    }
    Ok(())
}

/// Why an effect would change nothing at all on the muscles that this scene has.
fn without_effect(scene: &SceneFile, effect: &Effect<f64>) -> Option<(String, String)> {
    let is_inside = matches!(effect.element.kind, ElementKind::Syringe | ElementKind::Line | ElementKind::Muscle);
    let make = scene.muscles.as_ref().filter(|_| is_inside)?;
    let refusal = |message: &str, remedy: &str| Some((message.to_owned(), remedy.to_owned()));
    if make.displacement.is_some() {
        return refusal(
            "it changes nothing: [muscles.displacement] is a formula without fluid, wall or pull",
            "remove the effect, or put it on a scene with [muscles.tube] or [muscles.linear]",
        );
    }
    let is_fluid = matches!(effect.element.kind, ElementKind::Syringe | ElementKind::Line);
    let by_pressure = |m: &MuscleSpec| parse_column(&m.input).is_ok_and(|name| name.unit.si_suffix == "pa");
    let own = scene.muscle.get(effect.element.indices(scene.muscle.len())).unwrap_or(&[]);
    if is_fluid && !own.is_empty() && own.iter().all(by_pressure) {
        return refusal(
            "it changes nothing: the input is a pressure, no fluid is simulated before the muscle",
            "remove the effect, or drive the muscle by a plunger",
        );
    }
    match effect.kind {
        Kind::MullinsSoftening if make.linear.is_some() => refusal(
            "it changes nothing: [muscles.linear] has no wall that could soften",
            "remove the effect, or describe the muscle by [muscles.tube]; relaxation is `viscoelasticity`",
        ),
        Kind::PressureFriction if make.friction.is_none() => refusal(
            "it changes nothing: the muscles have no [muscles.friction] that pressure could raise",
            "add [muscles.friction] with m0_n and presliding_length_m, or remove the effect",
        ),
        _ => None,
    }
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
