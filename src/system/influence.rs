//! What an effect of the catalogue does to a scene: its main output over the stock programme, without it and with it.

use crate::effects::{Effect, EffectSpec, Element, ElementKind};
use crate::recording::parse_column;
use crate::scene::Scene;

use super::{Schedule, SystemError, Twin, TwinRun, TwinSetting};

/// Multiples of the typical size that are tried.
const SIZES: [f64; 2] = [1.0, 2.0];
/// A threshold that the programme does not reach is lowered so often, to this share each time.
const LOWERINGS: usize = 3;
const LOWERED: f64 = 0.7;

/// A scene's first output over its stock programme, at several sizes of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    pub scene: String,
    /// Where the effect sits, and with which numbers at the first size.
    pub effect: Effect<f64>,
    pub time_s: Vec<f64>,
    /// Column of the first input with its values, in its unit.
    pub input: (String, Vec<f64>),
    /// Column of the first output, and its values without the effect.
    pub output: (String, Vec<f64>),
    /// The effect's first number, and the output with it.
    pub with: Vec<(f64, Vec<f64>)>,
}

/// Plays the fast model of a scene without and with an effect; `None` where the scene cannot have it.
///
/// Where a rig has two of an element the first one gets it. A threshold out of the programme's reach is lowered.
///
/// # Errors
/// A scene without fast model, a run that diverges.
pub fn influence(scene: &Scene, spec: &'static EffectSpec) -> Result<Option<Influence>, SystemError> {
    let mut effect = place(scene, spec);
    if !takes(scene, &effect) {
        return Ok(None);
    }
    let stage = Stage::new(scene)?;
    let stock = stage.play(None)?;
    let mut with = stage.play_sizes(&effect)?;
    for _ in 0..LOWERINGS {
        let is_seen = with.iter().any(|(_, values)| *values != stock);
        if is_seen || effect.values.len() < 2 {
            break;
        }
        effect.values[1] *= LOWERED;
        with = stage.play_sizes(&effect)?;
    }
    Ok(Some(Influence {
        scene: scene.file.name.clone(),
        effect,
        input: stage.input()?,
        output: (scene.file.output[0].channel.clone(), stock),
        with,
        time_s: stage.run.times_s,
    }))
}

/// The effect at its typical size on the first element of its kind.
fn place(scene: &Scene, spec: &'static EffectSpec) -> Effect<f64> {
    let count = match spec.element {
        ElementKind::Cable => scene.file.cable.len(),
        _ => scene.file.muscle.len(),
    };
    let channel = (spec.element == ElementKind::Sensor).then(|| scene.file.output[0].channel.clone());
    Effect { kind: spec.kind, element: Element::of(spec.element, 0, count), channel, values: spec.typical() }
}

/// Whether the scene takes the effect: the checks of a scene file decide.
fn takes(scene: &Scene, effect: &Effect<f64>) -> bool {
    let mut file = scene.file.clone();
    file.effect.push(effect.table());
    Scene::from_file(file, &scene.path).is_ok()
}

/// A scene's fast model and its stock programme.
struct Stage<'a> {
    scene: &'a Scene,
    twin: Twin,
    run: TwinRun,
}

impl<'a> Stage<'a> {
    fn new(scene: &'a Scene) -> Result<Self, SystemError> {
        let spec = scene.file.simulation;
        let times_s = Schedule::even(spec.duration_s, spec.output_interval_s).0;
        let inputs = scene.programs.iter().map(|p| times_s.iter().map(|&t| p.value(t)).collect()).collect();
        Ok(Self { scene, twin: Twin::new(scene)?, run: TwinRun { times_s, inputs, plan: None } })
    }

    /// The first output with the scene's own effects and one more.
    fn play(&self, more: Option<Effect<f64>>) -> Result<Vec<f64>, SystemError> {
        let own = self.scene.file.effect.iter().filter_map(|t| t.effect().ok());
        let setting = TwinSetting { parameters: Vec::new(), effects: own.chain(more).collect() };
        let shown = self.twin.simulate(&self.run, &setting).and_then(|outputs| outputs.into_iter().next());
        let end_s = self.run.times_s.last().copied().unwrap_or(0.0);
        shown.ok_or_else(|| SystemError::Diverged { time_s: end_s, what: "the fast model's motion".to_owned() })
    }

    fn play_sizes(&self, effect: &Effect<f64>) -> Result<Vec<(f64, Vec<f64>)>, SystemError> {
        let range = effect.spec().parameters[0].range;
        let at = |multiple: &f64| {
            let mut sized = effect.clone();
            sized.values[0] = (multiple * effect.values[0]).clamp(range.min, range.max);
            Ok((sized.values[0], self.play(Some(sized))?))
        };
        SIZES.iter().map(at).collect()
    }

    fn input(&self) -> Result<(String, Vec<f64>), SystemError> {
        let column = self.scene.file.input[0].channel.clone();
        let unit = parse_column(&column)?.unit;
        Ok((column, self.run.inputs[0].iter().map(|&x| unit.from_si(x)).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Kind, find};

    fn of(scene: &str, kind: Kind) -> Option<Influence> {
        let scene = Scene::load(scene, &[]).unwrap_or_else(|e| panic!("{e}"));
        influence(&scene, find(kind)).unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn a_leak_shows_and_grows_with_its_size() {
        let leak = of("muscle_bench", Kind::Leak).expect("the bench has a line");
        let change = |values: &[f64]| {
            let pairs = values.iter().zip(&leak.output.1);
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let changes: Vec<f64> = leak.with.iter().map(|(_, values)| change(values)).collect();
        assert_eq!(leak.output.0, "elongation_mm");
        assert!(changes[0] > 0.1 && changes[1] > 1.5 * changes[0], "{changes:?}");
    }

    #[test]
    fn a_threshold_out_of_reach_is_lowered() {
        let closed = of("bending_catheter", Kind::NotchClosure).expect("the catheter has notches");
        assert!(closed.effect.values[1] < find(Kind::NotchClosure).typical()[1]);
        assert!(closed.with.iter().all(|(_, values)| *values != closed.output.1));
    }

    #[test]
    fn a_scene_without_the_element_shows_nothing() {
        assert_eq!(of("muscle_bench", Kind::CableSlack), None);
        assert!(of("driven_axis", Kind::SealFriction).is_some());
    }
}
