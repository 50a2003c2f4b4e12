//! A measure as text: arithmetic over figures of channels, `max(tension_1_n) - max(tension_2_n)`.

use exmex::{Express, FlatEx};

use super::SweepError;
use super::measure::{Argument, Call, FIGURES, Ran};
use super::spec::MeasureSpec;
use super::vocabulary::Vocabulary;
use crate::nearest::did_you_mean;
use crate::scene::OutputSpec;

/// A measure ready to be taken of runs.
#[derive(Clone, Debug)]
pub struct Measure {
    pub name: String,
    calls: Vec<Call>,
    arithmetic: FlatEx<f64>,
}

impl Measure {
    /// Reads a measure of runs whose channels, muscles, cables and joints are known.
    ///
    /// # Errors
    /// Unknown figures or names (with the nearest right one), arithmetic that cannot be read.
    pub fn new(spec: &MeasureSpec, known: &Vocabulary) -> Result<Self, SweepError> {
        let refuse =
            |message: String, remedy: String| SweepError::Measure { measure: spec.of.clone(), message, remedy };
        let (mut calls, mut text, mut rest) = (Vec::new(), String::new(), spec.of.as_str());
        while let Some(open) = rest.find('(') {
            let before = rest[..open].trim_end();
            let from = before.rfind(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).map_or(0, |i| i + 1);
            let (ahead, word) = (&rest[..from], &before[from..]);
            if word.is_empty() {
                text.push_str(&rest[..=open]);
                rest = &rest[open + 1..];
                continue;
            }
            let Some(close) = rest[open..].find(')').map(|i| open + i) else {
                return Err(refuse("a bracket is not closed".to_owned(), "close it: max(angle_deg)".to_owned()));
            };
            calls.push(call(word, &rest[open + 1..close], known).map_err(|(m, r)| refuse(m, r))?);
            text.push_str(ahead);
            text.push_str(&format!("{{figure_{:04}}}", calls.len() - 1));
            rest = &rest[close + 1..];
        }
        text.push_str(rest);
        let remedy = || "write figures of channels with + - * / and brackets: max(a_n) - min(a_n)".to_owned();
        let arithmetic = FlatEx::parse(&text).map_err(|e| refuse(e.to_string(), remedy()))?;
        if arithmetic.var_names().len() != calls.len() || calls.is_empty() {
            return Err(refuse("a word stands outside of a figure's brackets".to_owned(), remedy()));
        }
        Ok(Self { name: spec.name.clone(), calls, arithmetic })
    }

    /// Outputs that the measure needs besides those of the scene.
    pub fn outputs(&self) -> impl Iterator<Item = OutputSpec> {
        self.calls.iter().flat_map(Call::outputs)
    }

    /// The measure of a run.
    ///
    /// # Errors
    /// Channels that the run does not have.
    pub fn of(&self, run: Ran) -> Result<f64, SweepError> {
        // Names are numbered with four digits: their order by alphabet is that of the calls.
        let figures = self.calls.iter().map(|c| c.value(run)).collect::<Result<Vec<f64>, _>>()?;
        self.arithmetic.eval(&figures).map_err(|e| SweepError::Measure {
            measure: self.name.clone(),
            message: e.to_string(),
            remedy: "write it with + - * / and brackets".to_owned(),
        })
    }
}

/// Message and remedy of what is wrong.
pub(super) type Wrong = (String, String);

fn call(word: &str, inside: &str, known: &Vocabulary) -> Result<Call, Wrong> {
    let names: Vec<&str> = FIGURES.iter().map(|f| f.0).collect();
    let Some((_, figure, wanted)) = FIGURES.iter().find(|f| f.0 == word) else {
        return Err((
            format!("there is no figure \"{word}\"{}", did_you_mean(word, &names)),
            format!("take one of {}", names.join(", ")),
        ));
    };
    let arguments: Vec<&str> = inside.split(',').map(str::trim).collect();
    if arguments.len() != wanted.len() {
        let words: Vec<&str> = wanted.iter().map(|a| a.word()).collect();
        return Err((format!("{word} takes {}: {word}({})", wanted.len(), words.join(", ")), SEE.to_owned()));
    }
    let mut call = Call { figure: *figure, names: Vec::new(), numbers: Vec::new() };
    for (text, argument) in arguments.into_iter().zip(*wanted) {
        match argument {
            Argument::Number => call.numbers.push(number(text)?),
            other => call.names.push(known.checked(*other, text)?),
        }
    }
    known.check(&call)?;
    Ok(call)
}

const SEE: &str = "see docs/sweeps.md for each figure";

fn number(text: &str) -> Result<f64, Wrong> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err((format!("\"{text}\" is no number"), "give a finite number".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, Recording};
    use crate::scene::Scene;

    fn measure(of: &str) -> Result<Measure, SweepError> {
        let spec = MeasureSpec { name: "m".to_owned(), of: of.to_owned() };
        Measure::new(&spec, &Vocabulary::of(&scene()))
    }

    fn scene() -> Scene {
        Scene::load("muscle_bench", &[]).expect("a stock scene")
    }

    #[test]
    fn arithmetic_over_figures() {
        let channels = vec![Channel::new("force_n", vec![1.0, 5.0]), Channel::new("pressure_kpa", vec![2.0, 3.0])];
        let recording = Recording::new(vec![0.0, 1.0], channels).expect("a recording");
        let value = |of: &str| {
            let ran = Ran { scene: &scene(), recording: &recording };
            measure(of).expect("readable").of(ran).expect("a value")
        };
        assert_eq!(value("max(force_n)"), 5.0);
        assert_eq!(value("2 * (max(force_n) - min(pressure_kpa)) / range(force_n)"), 1.5);
        assert_eq!(value("final(pressure_kpa)-final(force_n)"), -2.0);
    }

    #[test]
    fn wrong_words_are_refused_with_the_nearest_right_one() {
        let message = |of: &str| measure(of).expect_err("wrong").to_string();
        for (of, nearest) in [
            ("maxx(force_n)", "did you mean \"max\"?"),
            ("max(force_m)", "did you mean \"force_n\"?"),
            ("closed_time(muscl)", "did you mean \"muscle\"?"),
            ("slack_time(cable)", "the scene has no cable"),
            ("stop_force(slide, 0.01)", "no joint with a stop"),
            ("stiffness(pressure_kpa, 1, 0)", "joint_position"),
        ] {
            assert!(message(of).contains(nearest), "{}", message(of));
        }
        for of in [
            "force_n",
            "max(force_n",
            "max()",
            "max(force_n, pressure_kpa)",
            "max(force_n) +",
            "1 + 2",
            "max(force_n) * force_n",
            "",
            "time_below(force_n, x)",
            "bandwidth(plunger_mm, force_n, inf, 0)",
        ] {
            assert!(measure(of).is_err(), "{of}");
        }
    }
}
