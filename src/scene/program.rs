//! Input programmes: what a channel does when no recording drives it.

use std::f64::consts::TAU;

use toml::{Table, Value};

/// A programme of one input channel, in SI units of the channel.
///
/// | kind | keys (`U`: the channel's SI unit, `m`, `rad` or `pa`) | value |
/// |---|---|---|
/// | `constant` | `value_U` | the value |
/// | `sine` | `stroke_U`, `frequency_hz`, `offset_U` | `offset + stroke (1 - cos 2 pi f t)/2` |
/// | `two_sines` | `stroke_U`, `frequency_hz` and `second_frequency_hz` | mean of two such sines |
/// | `non_harmonic` | `stroke_U`, `frequency_hz` | the same with the second at `sqrt(3)` times the first |
/// | `chirp` | `stroke_U`, `from_hz`, `to_hz`, `duration_s` | sine of rising frequency, then holds it |
/// | `staircase` | `steps_U` (list), `hold_s`, `rise_s` | raised-cosine rises between holds |
/// | `ramp_hold` | `to_U`, `rise_s`, optional `hold_s`, `fall_s` | up, hold, and down again if `fall_s` is given |
/// | `points` | `time_s` (list), `value_U` (list) | piecewise linear, ends held |
///
/// All but `points` have an optional `start_s` before which the value is the first one.
///
/// ```
/// use smam::scene::Program;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let table: toml::Table = "kind = 'sine'\nstroke_m = 3e-3\nfrequency_hz = 0.1".parse()?;
/// let plunger = Program::parse(&table, "m")?;
/// assert_eq!(plunger.value(0.0), 0.0);
/// assert!((plunger.value(5.0) - 3e-3).abs() < 1e-15);
/// // Fastest in the middle of the way: pi f times the stroke, 0.94 mm/s.
/// let speed_m_s = (plunger.value(2.501) - plunger.value(2.499)) / 2e-3;
/// assert!((speed_m_s / (std::f64::consts::PI * 0.1 * 3e-3) - 1.0).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    start_s: f64,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Constant(f64),
    /// Sum of `(stroke, frequency)` terms on an offset.
    Sines {
        offset: f64,
        terms: Vec<(f64, f64)>,
    },
    Chirp {
        stroke: f64,
        from_hz: f64,
        to_hz: f64,
        duration_s: f64,
    },
    Staircase {
        steps: Vec<f64>,
        hold_s: f64,
        rise_s: f64,
    },
    RampHold {
        to: f64,
        rise_s: f64,
        hold_s: f64,
        fall_s: Option<f64>,
    },
    Points {
        times_s: Vec<f64>,
        values: Vec<f64>,
    },
}

/// Keys of a programme table, checked off as they are read.
struct Keys<'a> {
    table: &'a Table,
    unit: &'a str,
    used: Vec<String>,
}

impl Keys<'_> {
    fn number(&mut self, key: &str) -> Result<f64, String> {
        self.optional(key)?.ok_or_else(|| format!("the key `{key}` is missing"))
    }

    fn optional(&mut self, key: &str) -> Result<Option<f64>, String> {
        self.used.push(key.to_owned());
        match self.table.get(key) {
            None => Ok(None),
            Some(value) => {
                as_number(value).map(Some).ok_or_else(|| format!("`{key} = {value}` is not a finite number"))
            }
        }
    }

    fn list(&mut self, key: &str) -> Result<Vec<f64>, String> {
        self.used.push(key.to_owned());
        let list = self
            .table
            .get(key)
            .and_then(Value::as_array)
            .ok_or_else(|| format!("the key `{key}` (a list) is missing"))?;
        let numbers: Option<Vec<f64>> = list.iter().map(as_number).collect();
        numbers.filter(|n| !n.is_empty()).ok_or_else(|| format!("`{key}` must be a list of numbers that is not empty"))
    }

    fn positive(&mut self, key: &str) -> Result<f64, String> {
        let value = self.number(key)?;
        if value > 0.0 { Ok(value) } else { Err(format!("`{key} = {value}` must be > 0")) }
    }

    fn with_unit(&self, stem: &str) -> String {
        format!("{stem}_{}", self.unit)
    }
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64)).filter(|x| x.is_finite())
}

impl Program {
    /// Reads a programme table; `unit` is the channel's SI unit suffix. The error says what is wrong with which key.
    pub fn parse(table: &Table, unit: &str) -> Result<Self, String> {
        let kind = table.get("kind").and_then(Value::as_str).ok_or("the key `kind` is missing")?;
        let mut keys = Keys { table, unit, used: vec!["kind".to_owned()] };
        let shape = parse_shape(kind, &mut keys)?;
        // Points carry their own times: a second clock would only make them hard to read.
        let start_s = if kind == "points" { 0.0 } else { keys.optional("start_s")?.unwrap_or(0.0) };
        match table.keys().find(|k| !keys.used.contains(k)) {
            Some(unknown) => Err(format!("unknown key `{unknown}`; a `{kind}` knows {}", keys.used.join(", "))),
            None => Ok(Self { start_s, shape }),
        }
    }

    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { start_s: 0.0, shape: Shape::Constant(value) }
    }

    /// Value at a time, in the channel's SI unit.
    pub fn value(&self, time_s: f64) -> f64 {
        let t = (time_s - self.start_s).max(0.0);
        match &self.shape {
            Shape::Constant(value) => *value,
            Shape::Sines { offset, terms } => {
                offset + terms.iter().map(|(s, f)| s * (1.0 - (TAU * f * t).cos()) / 2.0).sum::<f64>()
            }
            Shape::Chirp { stroke, from_hz, to_hz, duration_s } => {
                let swept = t.min(*duration_s);
                let cycles =
                    from_hz * swept + (to_hz - from_hz) * swept * swept / (2.0 * duration_s) + to_hz * (t - swept);
                stroke * (1.0 - (TAU * cycles).cos()) / 2.0
            }
            Shape::Staircase { steps, hold_s, rise_s } => staircase(steps, *hold_s, *rise_s, t),
            Shape::RampHold { to, rise_s, hold_s, fall_s } => match fall_s {
                Some(fall) if t > rise_s + hold_s => to * (1.0 - ((t - rise_s - hold_s) / fall).min(1.0)),
                _ => to * (t / rise_s).min(1.0),
            },
            Shape::Points { times_s, values } => interpolate(times_s, values, time_s),
        }
    }
}

fn parse_shape(kind: &str, keys: &mut Keys) -> Result<Shape, String> {
    let stroke = keys.with_unit("stroke");
    let offset = keys.with_unit("offset");
    Ok(match kind {
        "constant" => Shape::Constant(keys.number(&keys.with_unit("value"))?),
        "sine" | "two_sines" | "non_harmonic" => {
            let (s, f) = (keys.number(&stroke)?, keys.positive("frequency_hz")?);
            let offset = keys.optional(&offset)?.unwrap_or(0.0);
            let second = match kind {
                "two_sines" => Some(keys.positive("second_frequency_hz")?),
                "non_harmonic" => Some(f * 3.0_f64.sqrt()),
                _ => None,
            };
            let terms = second.map_or_else(|| vec![(s, f)], |f2| vec![(s / 2.0, f), (s / 2.0, f2)]);
            Shape::Sines { offset, terms }
        }
        "chirp" => Shape::Chirp {
            stroke: keys.number(&stroke)?,
            from_hz: keys.positive("from_hz")?,
            to_hz: keys.positive("to_hz")?,
            duration_s: keys.positive("duration_s")?,
        },
        "staircase" => Shape::Staircase {
            steps: keys.list(&keys.with_unit("steps"))?,
            hold_s: keys.positive("hold_s")?,
            rise_s: keys.positive("rise_s")?,
        },
        "ramp_hold" => Shape::RampHold {
            to: keys.number(&keys.with_unit("to"))?,
            rise_s: keys.positive("rise_s")?,
            hold_s: match keys.optional("hold_s")? {
                Some(s) if s < 0.0 => return Err(format!("`hold_s = {s}` must be >= 0")),
                held => held.unwrap_or(0.0),
            },
            fall_s: match keys.optional("fall_s")? {
                Some(s) if s <= 0.0 => return Err(format!("`fall_s = {s}` must be > 0")),
                falls => falls,
            },
        },
        "points" => points(keys.list("time_s")?, keys.list(&keys.with_unit("value"))?)?,
        other => {
            return Err(format!(
                "kind = \"{other}\" is unknown; known are constant, sine, two_sines, non_harmonic, chirp, staircase, ramp_hold, points"
            ));
        }
    })
}

fn points(times_s: Vec<f64>, values: Vec<f64>) -> Result<Shape, String> {
    if times_s.len() != values.len() {
        return Err(format!("`time_s` has {} entries, the values have {}", times_s.len(), values.len()));
    }
    if times_s.windows(2).any(|w| w[1] <= w[0]) {
        return Err("`time_s` must increase from entry to entry".to_owned());
    }
    Ok(Shape::Points { times_s, values })
}

fn interpolate(times: &[f64], values: &[f64], t: f64) -> f64 {
    let next = times.partition_point(|x| *x <= t);
    if next == 0 {
        return values[0];
    }
    if next == times.len() {
        return values[next - 1];
    }
    let (t0, t1) = (times[next - 1], times[next]);
    values[next - 1] + (values[next] - values[next - 1]) * (t - t0) / (t1 - t0)
}

fn staircase(steps: &[f64], hold_s: f64, rise_s: f64, t: f64) -> f64 {
    let period = hold_s + rise_s;
    let index = (t / period) as usize;
    if index >= steps.len() {
        return steps[steps.len() - 1];
    }
    let from = if index == 0 { 0.0 } else { steps[index - 1] };
    let within = ((t - index as f64 * period) / rise_s).min(1.0);
    from + (steps[index] - from) * (1.0 - (within * TAU / 2.0).cos()) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(text: &str) -> Result<Program, String> {
        Program::parse(&text.parse().expect("test TOML"), "m")
    }

    #[test]
    fn a_ramp_neither_waits_nor_falls_in_negative_time() {
        let ramp = |rest: &str| program(&format!("kind = 'ramp_hold'\nto_m = 1e-3\nrise_s = 1.0\n{rest}"));
        assert!(ramp("fall_s = 1.0").is_ok());
        assert!(ramp("fall_s = -1.0").expect_err("no time").contains("fall_s"));
        assert!(ramp("hold_s = -3.0").expect_err("no time").contains("hold_s"));
    }

    #[test]
    fn sine_is_the_papers_stroke() {
        let p = program("kind = 'sine'\nstroke_m = 3e-3\nfrequency_hz = 0.1").expect("valid");
        assert_eq!(p.value(0.0), 0.0);
        assert!((p.value(5.0) - 3e-3).abs() < 1e-15);
    }

    #[test]
    fn staircase_holds_each_step() {
        let p = program("kind = 'staircase'\nsteps_m = [1.0, 3.0]\nhold_s = 2.0\nrise_s = 1.0").expect("valid");
        assert_eq!((p.value(0.0), p.value(2.5), p.value(5.5), p.value(99.0)), (0.0, 1.0, 3.0, 3.0));
        assert!((p.value(3.5) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn points_have_their_own_times() {
        let error = program("kind = 'points'\ntime_s = [0, 1]\nvalue_m = [0, 1]\nstart_s = 2").expect_err("refused");
        assert_eq!(error, "unknown key `start_s`; a `points` knows kind, time_s, value_m");
    }

    #[test]
    fn wrong_unit_is_an_unknown_key() {
        let error = program("kind = 'sine'\nstroke_mm = 3\nfrequency_hz = 0.1").expect_err("wrong unit");
        assert_eq!(error, "the key `stroke_m` is missing");
    }

    #[test]
    fn chirp_is_continuous_where_it_ends() {
        let p = program("kind = 'chirp'\nstroke_m = 1\nfrom_hz = 0.1\nto_hz = 2\nduration_s = 10").expect("valid");
        assert!((p.value(10.0 - 1e-9) - p.value(10.0 + 1e-9)).abs() < 1e-7);
    }
}
