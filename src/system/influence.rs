//! What an effect of the catalogue does to a scene: its main output over the stock programme, and where fluid drives it
//! a pressure, without it and with it.

use crate::effects::{Effect, Element, ElementKind, EntryId, Native};
use crate::recording::parse_column;
use crate::scene::Scene;

use super::{Rom, RomRun, RomSetting, Schedule, SystemError};

/// Multiples of the typical size that are tried.
const SIZES: [f64; 2] = [1.0, 2.0];
/// A threshold that the programme does not reach is lowered so often, to this share each time.
const LOWERINGS: usize = 3;
const LOWERED: f64 = 0.7;
/// A drift that can be seen on any channel: this share of the channel's range, 1/s.
const DRIFT_SHARE_1_S: f64 = 4e-4;
/// What comes earlier is not shown, s: the scene starts at its own rest, and with a force more it first swings to another.
const SETTLED_S: f64 = 1.0;

/// An output without and with an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Influenced {
    pub column: String,
    pub stock: Vec<f64>,
    /// One for each size.
    pub with: Vec<Vec<f64>>,
}

/// A scene's first output over its stock programme, at several sizes of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    pub scene: String,
    /// Where the effect sits, and with which numbers at the first size.
    pub effect: Effect<f64>,
    pub time_s: Vec<f64>,
    /// Column of the first input with its values, in its unit; the time where nothing drives the scene.
    pub input: (String, Vec<f64>),
    /// The effect's first number at each size.
    pub sizes: Vec<f64>,
    /// The first output.
    pub output: Influenced,
    /// The first pressure among the outputs: it tells a lost fluid from a force.
    pub pressure: Option<Influenced>,
}

/// Plays the reduced-order model of a scene without and with an effect; `None` where the scene cannot have it.
///
/// Where a rig has two of an element the first one gets it. A threshold out of the programme's reach is lowered.
///
/// # Errors
/// A scene without reduced-order model, a run that diverges.
pub fn influence(scene: &Scene, entry: EntryId) -> Result<Option<Influence>, SystemError> {
    let mut effect = place(scene, entry);
    if !takes(scene, &effect) {
        return Ok(None);
    }
    let stage = Stage::new(scene)?;
    let stock = stage.play(None)?;
    if entry.native == Some(Native::SensorDrift) {
        effect.values[0] = visible_drift(&stock[0]);
    }
    let mut with = stage.play_sizes(&effect)?;
    for _ in 0..LOWERINGS {
        let is_seen = with.iter().any(|outputs| outputs[0] != stock[0]);
        if is_seen || effect.values.len() < 2 {
            break;
        }
        effect.values[1] *= LOWERED;
        with = stage.play_sizes(&effect)?;
    }
    Ok(Some(stage.influence(effect, &stock, &with)?))
}

/// A drift per second that fits a channel, to one digit.
fn visible_drift(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let rate = DRIFT_SHARE_1_S * (high - low);
    format!("{rate:.0e}").parse().unwrap_or(rate)
}

/// The effect at its typical size on the first element of its kind.
fn place(scene: &Scene, entry: EntryId) -> Effect<f64> {
    let count = match entry.element {
        ElementKind::Cable => scene.file.cable.len(),
        _ => scene.file.muscle.len(),
    };
    let channel = (entry.element == ElementKind::Sensor).then(|| scene.file.output[0].channel.clone());
    Effect { entry, element: Element::of(entry.element, 0, count), channel, values: entry.typical() }
}

/// Whether the scene takes the effect: the checks of a scene file decide.
fn takes(scene: &Scene, effect: &Effect<f64>) -> bool {
    let mut file = scene.file.clone();
    file.effect.push(effect.table());
    Scene::from_file(file, &scene.path).is_ok()
}

/// A scene's reduced-order model and its stock programme.
struct Stage<'a> {
    scene: &'a Scene,
    rom: Rom,
    run: RomRun,
}

impl<'a> Stage<'a> {
    fn new(scene: &'a Scene) -> Result<Self, SystemError> {
        let spec = scene.file.simulation;
        let run = RomRun::of_programs(scene, &Schedule::even(spec.duration_s, spec.output_interval_s));
        Ok(Self { scene, rom: Rom::new(scene)?, run })
    }

    /// All outputs with the scene's own effects and one more.
    fn play(&self, more: Option<Effect<f64>>) -> Result<Vec<Vec<f64>>, SystemError> {
        let own = self.scene.file.effect.iter().filter_map(|t| t.effect().ok());
        let setting = RomSetting { parameters: Vec::new(), effects: own.chain(more).collect() };
        let shown = self.rom.simulate(&self.run, &setting).filter(|outputs| !outputs.is_empty());
        let end_s = self.run.times_s.last().copied().unwrap_or(0.0);
        shown
            .ok_or_else(|| SystemError::Diverged { time_s: end_s, what: "the reduced-order model's motion".to_owned() })
    }

    fn play_sizes(&self, effect: &Effect<f64>) -> Result<Vec<Vec<Vec<f64>>>, SystemError> {
        let sized = |size: f64| {
            let mut sized = effect.clone();
            sized.values[0] = size;
            self.play(Some(sized))
        };
        sizes(effect).into_iter().map(sized).collect()
    }

    /// What was played from where it has settled.
    fn influence(
        &self,
        effect: Effect<f64>,
        stock: &[Vec<f64>],
        with: &[Vec<Vec<f64>>],
    ) -> Result<Influence, SystemError> {
        let times_s = &self.run.times_s;
        let from = times_s.partition_point(|t| *t < times_s[0] + SETTLED_S).min(times_s.len() - 1);
        let outputs = &self.scene.file.output;
        let of = |i: usize| Influenced {
            column: outputs[i].channel.clone(),
            stock: stock[i][from..].to_vec(),
            with: with.iter().map(|one| one[i][from..].to_vec()).collect(),
        };
        let is_pressure = |column: &str| parse_column(column).is_ok_and(|name| name.unit.si_suffix == "pa");
        let pressure = (1..outputs.len()).find(|i| is_pressure(&outputs[*i].channel));
        let (column, input) = self.input()?;
        Ok(Influence {
            scene: self.scene.file.name.clone(),
            sizes: sizes(&effect),
            effect,
            time_s: times_s[from..].to_vec(),
            input: (column, input[from..].to_vec()),
            output: of(0),
            pressure: pressure.map(of),
        })
    }

    fn input(&self) -> Result<(String, Vec<f64>), SystemError> {
        let Some((input, values)) = self.scene.file.input.first().zip(self.run.inputs.first()) else {
            return Ok(("time_s".to_owned(), self.run.times_s.clone()));
        };
        let unit = parse_column(&input.channel)?.unit;
        Ok((input.channel.clone(), values.iter().map(|&x| unit.from_si(x)).collect()))
    }
}

/// The sizes that are tried, within the law's range.
fn sizes(effect: &Effect<f64>) -> Vec<f64> {
    let range = effect.entry.parameters[0].range;
    SIZES.iter().map(|multiple| (multiple * effect.values[0]).clamp(range.min, range.max)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::find;

    fn of(scene: &str, id: &str) -> Option<Influence> {
        let scene = Scene::load(scene, &[]).unwrap_or_else(|e| panic!("{e}"));
        influence(&scene, find(id).expect("of the catalogue")).unwrap_or_else(|e| panic!("{e}"))
    }

    fn greatest_changes(shown: &Influenced) -> Vec<f64> {
        let change = |with: &Vec<f64>| with.iter().zip(&shown.stock).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        shown.with.iter().map(change).collect()
    }

    #[test]
    fn a_leak_shows_and_grows_with_its_size() {
        let leak = of("muscle_bench", "leak").expect("the bench has a line");
        let changes = greatest_changes(&leak.output);
        assert_eq!(leak.output.column, "elongation_mm");
        assert!(changes[0] > 0.1 && changes[1] > 1.5 * changes[0], "{changes:?}");
    }

    #[test]
    fn fluid_that_is_lost_shows_in_the_pressure_and_a_slow_start_does_not() {
        let leak = of("antagonistic_pulley", "leak").expect("the pulley has lines");
        let pressure = leak.pressure.expect("the pulley shows pressures");
        assert_eq!(pressure.column, "pressure_1_kpa");
        assert!(greatest_changes(&pressure)[0] > 1.0, "{:?}", greatest_changes(&pressure));
        assert!(leak.time_s[0] >= SETTLED_S && leak.time_s.len() == pressure.stock.len());
        assert_eq!(of("tendon_sheath", "cable_slack").expect("it has cables").pressure, None);
    }

    #[test]
    fn a_drift_fits_its_channel() {
        let drift = |scene: &str| of(scene, "sensor_drift").expect("a sensor").sizes[0];
        assert_eq!(drift("muscle_bench"), 0.01);
        assert!(drift("antagonistic_pulley") >= 0.03, "{}", drift("antagonistic_pulley"));
    }

    #[test]
    fn a_threshold_out_of_reach_is_lowered() {
        let closed = of("bending_catheter", "notch_closure").expect("the catheter has notches");
        assert!(closed.effect.values[1] < find("notch_closure").expect("of the catalogue").typical()[1]);
        assert!(closed.output.with.iter().all(|values| *values != closed.output.stock));
    }

    #[test]
    fn a_scene_without_the_element_shows_nothing() {
        assert_eq!(of("muscle_bench", "cable_slack"), None);
        assert!(of("driven_axis", "seal_friction").is_some());
    }

    #[test]
    fn a_scene_that_nothing_drives_is_shown_over_time() {
        let leak = of("closed_chamber", "chamber_leak").expect("a chamber leaks");
        assert_eq!(leak.input, ("time_s".to_owned(), leak.time_s.clone()));
        assert!(greatest_changes(&leak.output)[0] > 10.0, "{:?}", greatest_changes(&leak.output));
    }
}
