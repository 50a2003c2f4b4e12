//! Playing stock scenes: the full scene, and its reduced-order model where a figure needs many runs.

use crate::effects::EffectTable;
use crate::recording::Recording;
use crate::scene::{Override, Program, Scene};
use crate::system::{InputSource, Rom, RomRun, RomSetting, Schedule, Simulation, record};

use super::ReproduceError;
use super::error::lacking;
use super::loops::Loop;

/// One run of a stock scene, with what differs from it.
#[derive(Clone, Default)]
pub struct Play {
    pub scene: &'static str,
    pub overrides: Vec<Override>,
    pub effects: Vec<EffectTable>,
    /// Channel and programme.
    pub inputs: Vec<(&'static str, Program)>,
    /// Of the scene, if none is given.
    pub duration_s: Option<f64>,
}

/// A run of a scene as delivered.
pub fn stock(scene: &'static str) -> Play {
    Play { scene, ..Play::default() }
}

/// A programme from its TOML, lengths in m.
pub fn program(figure: &'static str, toml: &str) -> Result<Program, ReproduceError> {
    let table = toml.parse::<toml::Table>().map_err(|e| lacking(figure, e.to_string()))?;
    Program::parse(&table, "m").map_err(|e| lacking(figure, e))
}

/// A raised cosine, `stroke/2 (1 - cos 2 pi f t)`.
pub fn sine(figure: &'static str, stroke_m: f64, frequency_hz: f64) -> Result<Program, ReproduceError> {
    program(figure, &format!("kind = \"sine\"\nstroke_m = {stroke_m:e}\nfrequency_hz = {frequency_hz:e}"))
}

/// An effect of the catalogue.
pub fn effect(name: &str, element: &str, parameters: &[(&str, f64)]) -> EffectTable {
    EffectTable {
        name: name.to_owned(),
        element: element.to_owned(),
        channel: None,
        parameters: parameters.iter().map(|(k, v)| ((*k).to_owned(), *v)).collect(),
    }
}

/// Elongation of a scene's muscles at the start, %.
pub fn pre_elongation_percent(scene: &'static str) -> Result<f64, ReproduceError> {
    let muscles = stock(scene).scene()?.file.muscles;
    Ok(muscles.map_or(0.0, |m| m.pre_elongation_ratio * 100.0))
}

impl Play {
    /// With a number of the scene changed.
    pub fn with(mut self, key: &str, value: f64) -> Self {
        self.overrides.push(Override::number(key, value));
        self
    }

    /// With an effect.
    pub fn and(mut self, effect: EffectTable) -> Self {
        self.effects.push(effect);
        self
    }

    /// Driven by a programme.
    pub fn driven(mut self, channel: &'static str, program: Program) -> Self {
        self.inputs.push((channel, program));
        self
    }

    /// For so long.
    pub fn lasting(mut self, duration_s: f64) -> Self {
        self.duration_s = Some(duration_s);
        self
    }

    /// The scene as it is played, programmes apart.
    pub fn scene(&self) -> Result<Scene, ReproduceError> {
        let mut scene = Scene::load(self.scene, &self.overrides)?;
        scene.file.effect.extend(self.effects.iter().cloned());
        Ok(scene)
    }

    fn schedule(&self, scene: &Scene) -> Schedule {
        let spec = &scene.file.simulation;
        Schedule::even(self.duration_s.unwrap_or(spec.duration_s), spec.output_interval_s)
    }

    /// Plays the full scene, rigid bodies included.
    pub fn run(&self) -> Result<Recording, ReproduceError> {
        let scene = self.scene()?;
        let schedule = self.schedule(&scene);
        let mut simulation = Simulation::new(scene)?;
        for (channel, program) in &self.inputs {
            simulation.set_input(channel, InputSource::Program(program.clone()));
        }
        Ok(record(&mut simulation, &schedule)?)
    }

    /// The last period of a full run, one channel over another.
    pub fn last_loop(&self, input: &str, output: &str, period_s: f64) -> Result<Loop, ReproduceError> {
        let run = self.run()?;
        Ok(Loop::last(run.time_s(), &run.channel(input)?.values, &run.channel(output)?.values, period_s))
    }

    /// The scene's reduced-order model with the inputs of this run.
    pub fn fast(&self) -> Result<Fast, ReproduceError> {
        let scene = self.scene()?;
        let rom = Rom::new(&scene)?;
        let times_s = self.schedule(&scene).times();
        let given = |channel: &str| self.inputs.iter().find(|(c, _)| *c == channel).map(|(_, p)| p.clone());
        let programs =
            scene.file.input.iter().zip(&scene.programs).map(|(i, p)| given(&i.channel).unwrap_or_else(|| p.clone()));
        let inputs = programs.map(|p| times_s.iter().map(|t| p.value(*t)).collect()).collect();
        Ok(Fast { rom, run: RomRun { times_s, inputs, plan: None } })
    }
}

/// A reduced-order model and what drives it.
pub struct Fast {
    rom: Rom,
    run: RomRun,
}

impl Fast {
    pub fn times_s(&self) -> &[f64] {
        &self.run.times_s
    }

    /// An input of the scene along the run, mm.
    pub fn input_mm(&self, index: usize) -> Vec<f64> {
        self.run.inputs[index].iter().map(|x| x * 1e3).collect()
    }

    /// One output channel with numbers of the scene changed and effects added; none where it diverges.
    pub fn channel(
        &self,
        column: &str,
        numbers: &[(&str, f64)],
        effects: &[EffectTable],
    ) -> Result<Vec<f64>, ReproduceError> {
        let index = self.rom.columns().position(|c| c == column);
        let index = index.ok_or_else(|| lacking("-", format!("the scene has no channel {column}")))?;
        let parameters = numbers.iter().map(|(key, value)| {
            let parameter = self.rom.parameter(key);
            parameter
                .map(|p| (p, *value))
                .ok_or_else(|| lacking("-", format!("the reduced-order model cannot vary {key}")))
        });
        let effects = effects.iter().map(|e| e.effect().map_err(|error| lacking("-", error.to_string())));
        let setting = RomSetting {
            parameters: parameters.collect::<Result<_, _>>()?,
            effects: effects.collect::<Result<_, _>>()?,
        };
        let mut series =
            self.rom.simulate(&self.run, &setting).ok_or_else(|| lacking("-", "the reduced-order model diverges"))?;
        Ok(series.swap_remove(index))
    }
}
