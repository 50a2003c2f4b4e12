//! Scenes with laws, run by both simulators.

use smam::laws::LawTable;
use smam::scene::{Override, Scene};
use smam::system::{Rom, RomRun, RomSetting, Schedule, Simulation, record};

/// Between samples, s.
pub const SAMPLE_S: f64 = 0.01;
/// Steps of the reduced-order model in each.
const FAST_STEPS: u16 = 10;

/// Who simulates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
    Full,
    Fast,
}

pub const BOTH: [Model; 2] = [Model::Full, Model::Fast];

/// A scene with other numbers and laws: each a line `PORT adds EXPRESSION`, or a TOML table.
pub fn scene(rig: &str, sets: &[&str], laws: &[&str]) -> Scene {
    let overrides: Vec<Override> =
        sets.iter().map(|set| Override::parse(set).unwrap_or_else(|e| panic!("{set}: {e}"))).collect();
    let stock = Scene::load(rig, &overrides).unwrap_or_else(|e| panic!("{sets:?}: {e}"));
    let mut file = stock.file;
    file.law.extend(laws.iter().enumerate().map(|(i, text)| law(text, i)));
    Scene::from_file(file, &stock.path).unwrap_or_else(|e| panic!("{laws:?}: {e}"))
}

pub fn law(text: &str, number: usize) -> LawTable {
    if text.contains('=') && text.contains("port") {
        return toml::from_str(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    }
    LawTable::parse(text, &format!("law_{number}")).unwrap_or_else(|e| panic!("{e:?}"))
}

/// Columns of a run.
#[derive(Clone, Debug)]
pub struct Series(Vec<(String, Vec<f64>)>);

impl Series {
    pub fn of(&self, column: &str) -> &[f64] {
        let found = self.0.iter().find(|(name, _)| name == column);
        found.map(|(_, values)| values.as_slice()).unwrap_or_else(|| panic!("no {column}"))
    }

    pub fn columns(&self) -> impl Iterator<Item = (&str, &[f64])> {
        self.0.iter().map(|(name, values)| (name.as_str(), values.as_slice()))
    }

    /// At the end.
    pub fn last(&self, column: &str) -> f64 {
        *self.of(column).last().expect("samples")
    }
}

/// Runs a scene's own programmes; the outputs.
pub fn run(model: Model, scene: &Scene, until_s: f64) -> Series {
    run_by(model, scene, until_s, FAST_STEPS)
}

/// The same with so many steps of the reduced-order model between samples.
pub fn run_by(model: Model, scene: &Scene, until_s: f64, steps: u16) -> Series {
    let schedule = Schedule::even(until_s, SAMPLE_S);
    let outputs = || scene.file.output.iter().map(|o| o.channel.clone());
    match model {
        Model::Full => {
            let mut simulation = Simulation::new(scene.clone()).unwrap_or_else(|e| panic!("{e}"));
            let recording = record(&mut simulation, &schedule).unwrap_or_else(|e| panic!("{e}"));
            Series(outputs().map(|c| (c.clone(), recording.channel(&c).expect("an output").values.clone())).collect())
        }
        Model::Fast => {
            let rom = Rom::new(scene).unwrap_or_else(|e| panic!("{e}"));
            let mut run = RomRun::of_programs(scene, &schedule);
            run.plan = Some(vec![steps; run.times_s.len() - 1].into());
            // The reduced-order model takes effects from its setting.
            let effects = scene.file.effect.iter().map(|e| e.effect().expect("checked")).collect();
            let setting = RomSetting::<f64> { parameters: Vec::new(), effects };
            let values = rom.simulate(&run, &setting).expect("it does not diverge");
            Series(rom.columns().map(str::to_owned).zip(values).collect())
        }
    }
}

/// Greatest difference of two runs in the ranges of the second one's channels, but for some of them.
pub fn distance(one: &Series, other: &Series, but_for: &[&str]) -> f64 {
    let channels = other.columns().filter(|(name, _)| !but_for.contains(name));
    channels.map(|(name, b)| apart(one.of(name), b)).fold(0.0, f64::max)
}

/// Greatest difference over the range; over the size of what does not move.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let (low, high) = b.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    let size = low.abs().max(high.abs());
    let range = if high - low > 1e-9 * size { high - low } else { size };
    let greatest = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if greatest == 0.0 { 0.0 } else { greatest / range }
}
