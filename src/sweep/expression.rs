//! A measure as text: arithmetic over figures of channels, `max(tension_1_n) - max(tension_2_n)`.

use exmex::{Express, FlatEx};

use super::SweepError;
use super::measure::{Call, FIGURES};
use super::spec::MeasureSpec;
use crate::recording::{Recording, did_you_mean};

/// A measure ready to be taken of runs.
#[derive(Clone, Debug)]
pub struct Measure {
    pub name: String,
    calls: Vec<Call>,
    arithmetic: FlatEx<f64>,
}

impl Measure {
    /// Reads a measure; `channels` are those that a run has.
    ///
    /// # Errors
    /// Unknown figures or channels (with the nearest right name), arithmetic that cannot be read.
    pub fn new(spec: &MeasureSpec, channels: &[&str]) -> Result<Self, SweepError> {
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
            calls.push(call(word, &rest[open + 1..close], channels).map_err(|(m, r)| refuse(m, r))?);
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

    /// The measure of a run.
    ///
    /// # Errors
    /// Channels that the run does not have.
    pub fn of(&self, run: &Recording) -> Result<f64, SweepError> {
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
type Wrong = (String, String);

fn call(word: &str, inside: &str, channels: &[&str]) -> Result<Call, Wrong> {
    let names: Vec<&str> = FIGURES.iter().map(|f| f.0).collect();
    let Some((_, figure, wanted, numbers)) = FIGURES.iter().find(|f| f.0 == word) else {
        return Err((
            format!("there is no figure \"{word}\"{}", did_you_mean(word, &names)),
            format!("take one of {}", names.join(", ")),
        ));
    };
    let arguments: Vec<&str> = inside.split(',').map(str::trim).collect();
    if arguments.len() != wanted + numbers {
        return Err((
            format!("{word} takes {wanted} channels and {numbers} numbers"),
            "see docs/sweeps.md for each figure".to_owned(),
        ));
    }
    for channel in &arguments[..*wanted] {
        if !channels.contains(channel) {
            return Err((
                format!("the scene has no channel \"{channel}\"{}", did_you_mean(channel, channels)),
                format!("its channels are {}; add one with [[output]]", channels.join(", ")),
            ));
        }
    }
    let number = |text: &&str| text.parse::<f64>().map_err(|e| (format!("{text}: {e}"), "give a number".to_owned()));
    Ok(Call {
        figure: *figure,
        channels: arguments[..*wanted].iter().map(|c| (*c).to_owned()).collect(),
        numbers: arguments[*wanted..].iter().map(number).collect::<Result<_, _>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;

    fn measure(of: &str) -> Result<Measure, SweepError> {
        Measure::new(&MeasureSpec { name: "m".to_owned(), of: of.to_owned() }, &["a_n", "b_n"])
    }

    #[test]
    fn arithmetic_over_figures() {
        let channels = vec![Channel::new("a_n", vec![1.0, 5.0]), Channel::new("b_n", vec![2.0, 3.0])];
        let run = Recording::new(vec![0.0, 1.0], channels).expect("a recording");
        let value = |of: &str| measure(of).expect("readable").of(&run).expect("a value");
        assert_eq!(value("max(a_n)"), 5.0);
        assert_eq!(value("2 * (max(a_n) - min(b_n)) / range(a_n)"), 1.5);
        assert_eq!(value("final(b_n)-final(a_n)"), -2.0);
    }

    #[test]
    fn wrong_words_are_refused_with_the_nearest_right_one() {
        let message = |of: &str| measure(of).expect_err("wrong").to_string();
        assert!(message("maxx(a_n)").contains("did you mean \"max\"?"), "{}", message("maxx(a_n)"));
        assert!(message("max(a_m)").contains("did you mean \"a_n\"?"), "{}", message("max(a_m)"));
        for of in ["a_n", "max(a_n", "max()", "max(a_n, b_n)", "max(a_n) +", "1 + 2", "max(a_n) * a_n", ""] {
            assert!(measure(of).is_err(), "{of}");
        }
    }
}
