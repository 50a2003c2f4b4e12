//! Arguments of a law's shape: a variable, its memory, or a product with another variable.

use std::collections::BTreeMap;

use crate::laws::{ParameterTable, QUANTITIES, Quantity, StateTable};

/// The argument of the shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// The variable itself.
    Plain,
    /// The variable, and the shape times another variable over that one's scale: a coefficient of the other variable that depends on this one.
    Times(Quantity, f64),
    /// The variable after a first-order lag, s, and its lead over that.
    Behind(f64),
    Ahead(f64),
    /// The greatest magnitude so far.
    Greatest,
    /// The variable while it rises, by the sign of its rate.
    Rising(Quantity),
    /// The variable's lead over a play of this width.
    Play(f64),
    /// State of dry friction: follows the variable (whose rate is given beside it) and slips at this distance.
    Slip(Quantity, f64),
}

/// Lags tried, s.
const LAGS_S: [f64; 3] = [0.5, 5.0, 50.0];
/// Widths and distances tried, in scales of the variable.
const WIDTHS: [f64; 2] = [0.1, 0.4];

/// The rate of a variable, where the rig has it as one.
fn rate(of: Quantity) -> Option<Quantity> {
    match of {
        Quantity::Elongation => Some(Quantity::Speed),
        Quantity::Angle => Some(Quantity::AngularSpeed),
        Quantity::Plunger => Some(Quantity::PlungerSpeed),
        _ => None,
    }
}

/// Whether memory of the variable adds information. The lag of a rate equals the lead of its quantity; for the flow,
/// that quantity is not among the variables.
fn has_past(of: Quantity) -> bool {
    !of.is_rate()
}

/// All arguments with memory or products for the variable `own`; all variables are given with their scales.
pub fn readings(own: Quantity, all: &[(Quantity, f64)]) -> Vec<Reading> {
    let scale = all.iter().find(|(q, _)| *q == own).map_or(1.0, |(_, scale)| *scale);
    let others = all.iter().filter(|(q, _)| *q != own);
    let mut found: Vec<Reading> = others.map(|(q, scale)| Reading::Times(*q, *scale)).collect();
    if has_past(own) || own == Quantity::Flow {
        found.extend(LAGS_S.map(Reading::Behind));
    }
    if has_past(own) {
        found.extend(LAGS_S.map(Reading::Ahead));
        found.push(Reading::Greatest);
        found.extend(WIDTHS.map(|w| Reading::Play(w * scale)));
    }
    if let Some(rate) = rate(own).filter(|r| all.iter().any(|(q, _)| q == r)) {
        found.push(Reading::Rising(rate));
        found.extend(WIDTHS.map(|w| Reading::Slip(rate, w * scale)));
    }
    found
}

impl Reading {
    /// Ending of the law's name.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Times(..) => "_product",
            Self::Behind(_) => "_behind",
            Self::Ahead(_) => "_ahead",
            Self::Greatest => "_greatest",
            Self::Rising(_) => "_rising",
            Self::Play(_) => "_play",
            Self::Slip(..) => "_slip",
        }
    }

    /// Whether it differs only in scale, which varies between elements.
    pub fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Times(a, _), Self::Times(b, _)) => a == b,
            // Widths are counted in scales.
            (Self::Play(_), Self::Play(_)) | (Self::Slip(..), Self::Slip(..)) => true,
            _ => self == other,
        }
    }

    /// The other variable that it needs.
    pub fn other(&self) -> Option<Quantity> {
        match self {
            Self::Times(q, _) | Self::Rising(q) | Self::Slip(q, _) => Some(*q),
            _ => None,
        }
    }

    /// Whether it depends on the variable's past.
    pub fn remembers(&self) -> bool {
        !matches!(self, Self::Plain | Self::Times(..) | Self::Rising(_))
    }

    /// Whether it depends on the variable's rate.
    pub fn needs_clock(&self) -> bool {
        match self {
            Self::Behind(_) | Self::Ahead(_) => true,
            Self::Times(q, _) => q.is_rate(),
            // Of the rate only the sign counts.
            Self::Plain | Self::Greatest | Self::Rising(_) | Self::Play(_) | Self::Slip(..) => false,
        }
    }

    /// Values of the argument in a run, from the variable, the other one, and their times.
    pub fn series(&self, own: &[f64], other: &[f64], times_s: &[f64]) -> Vec<f64> {
        match self {
            Self::Plain | Self::Times(..) => own.to_vec(),
            Self::Behind(lag_s) => behind(own, times_s, *lag_s),
            Self::Ahead(lag_s) => own.iter().zip(behind(own, times_s, *lag_s)).map(|(x, s)| x - s).collect(),
            Self::Greatest => {
                let mut greatest = 0.0_f64;
                own.iter()
                    .map(|x| {
                        greatest = greatest.max(x.abs());
                        greatest
                    })
                    .collect()
            }
            Self::Rising(_) => own.iter().zip(other).map(|(x, v)| if *v > 0.0 { *x } else { 0.0 }).collect(),
            Self::Play(width) => own.iter().zip(followed(own, 0.5 * width)).map(|(x, s)| x - s).collect(),
            Self::Slip(_, distance) => slipping(own, *distance),
        }
    }

    /// The argument as text: `(NAME/SCALE)`.
    pub fn text(&self, variable: &str, scale: &str) -> String {
        match self {
            Self::Plain | Self::Times(..) => format!("({variable}/{scale})"),
            Self::Behind(_) | Self::Greatest | Self::Slip(..) => format!("(s/{scale})"),
            Self::Ahead(_) | Self::Play(_) => format!("(({variable} - s)/{scale})"),
            Self::Rising(q) => format!("({variable}/{scale}*({} > 0))", q.spec().name()),
        }
    }

    /// What the shape is multiplied by in each sample of a run, if anything; `other` as in [`Reading::series`].
    pub fn factor(&self, other: &[f64]) -> Option<Vec<f64>> {
        let Self::Times(_, scale) = self else { return None };
        Some(other.iter().map(|y| y / scale).collect())
    }

    /// A shape's text with what it is multiplied by.
    pub fn times(&self, shape: String) -> String {
        match self {
            Self::Times(q, _) => format!("{shape} * ({}/other{})", q.spec().name(), ending(*q)),
            _ => shape,
        }
    }

    /// The states that the text needs.
    pub fn states(&self, variable: &str) -> BTreeMap<String, StateTable> {
        let own = match self {
            Self::Behind(_) | Self::Ahead(_) => StateTable {
                rate: Some(format!("({variable} - s)/lag_s")),
                start: Some(variable.to_owned()),
                ..StateTable::default()
            },
            Self::Play(_) => StateTable {
                play_of: Some(variable.to_owned()),
                width: Some(width(variable)),
                start: Some(variable.to_owned()),
                ..StateTable::default()
            },
            Self::Slip(rate, _) => {
                let rate = rate.spec().name();
                StateTable {
                    rate: Some(format!("{rate} - abs({rate})*s/{}", width(variable))),
                    start: Some(format!("0*{variable}")),
                    ..StateTable::default()
                }
            }
            Self::Greatest => StateTable { greatest: Some(format!("abs({variable})")), ..StateTable::default() },
            _ => return BTreeMap::new(),
        };
        BTreeMap::from([("s".to_owned(), own)])
    }

    /// The parameter that the text needs beside size and scale, whether it is fitted, and its value to begin with.
    pub fn parameter(&self, variable: &str) -> Option<(String, ParameterTable, bool)> {
        let number = |value: f64, unit: Option<&str>| ParameterTable {
            value,
            unit: unit.map(str::to_owned),
            ..ParameterTable::default()
        };
        match self {
            Self::Times(q, scale) => {
                let ending = ending(*q);
                let unit = ending.is_empty().then_some("1");
                Some((format!("other{ending}"), number(*scale, unit), false))
            }
            Self::Play(own) | Self::Slip(_, own) => Some((width(variable), number(*own, None), true)),
            Self::Behind(lag_s) | Self::Ahead(lag_s) => Some(("lag_s".to_owned(), number(*lag_s, None), true)),
            _ => None,
        }
    }
}

/// Name of a width that is counted in a variable's unit.
fn width(variable: &str) -> String {
    let of = QUANTITIES.iter().find(|q| q.name() == variable).map(|q| q.quantity);
    format!("width{}", of.map_or(String::new(), ending))
}

/// A series after a dead zone of this half width; it starts where the series does.
fn followed(series: &[f64], half: f64) -> Vec<f64> {
    let mut state = series.first().copied().unwrap_or(0.0);
    let follow = |x: &f64| {
        state = state.clamp(x - half, x + half);
        state
    };
    series.iter().map(follow).collect()
}

/// The state that follows a series and slips at a distance: `ds = dx - |dx| s/distance`, exact along straight segments.
fn slipping(series: &[f64], distance: f64) -> Vec<f64> {
    let mut state = 0.0;
    let mut before = series.first().copied().unwrap_or(0.0);
    let follow = |x: &f64| {
        let way = x - before;
        let end = distance * way.signum();
        state = end + (state - end) * (-way.abs() / distance).exp();
        before = *x;
        state
    };
    series.iter().map(follow).collect()
}

/// Ending of a variable's name with its unit: `_m_s`; empty for a plain number.
fn ending(of: Quantity) -> String {
    let ending = of.spec().ending;
    if ending.is_empty() { String::new() } else { format!("_{ending}") }
}

/// First-order lag of a series that goes straight from sample to sample; it starts where the series does.
fn behind(series: &[f64], times_s: &[f64], lag_s: f64) -> Vec<f64> {
    let mut state = series.first().copied().unwrap_or(0.0);
    let mut before = (state, times_s.first().copied().unwrap_or(0.0));
    let follow = |(&x, &t): (&f64, &f64)| {
        let h = t - before.1;
        if h > 0.0 {
            let slope = (x - before.0) / h;
            state = x - lag_s * slope + (state - before.0 + lag_s * slope) * (-h / lag_s).exp();
        }
        before = (x, t);
        state
    };
    series.iter().zip(times_s).map(follow).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_followed_by_the_lag() {
        let times: Vec<f64> = (0..2000).map(|k| f64::from(k) * 0.01).collect();
        let late = behind(&times, &times, 0.5);
        assert!((times[1999] - late[1999] - 0.5).abs() < 1e-9);
        // A step's answer is exponential, on uneven times as well.
        let step: Vec<f64> = times.iter().map(|t| f64::from(u8::from(*t > 0.0))).collect();
        let answer = behind(&step, &times, 2.0);
        assert!((answer[201] - (1.0 - (-1.0_f64).exp())).abs() < 3e-3, "{}", answer[201]);
    }

    #[test]
    fn play_lags_by_half_its_width_and_dry_friction_slips() {
        let up: Vec<f64> = (0..=100).map(f64::from).chain((0..100).rev().map(f64::from)).collect();
        let ahead = Reading::Play(10.0).series(&up, &[], &[]);
        assert_eq!((ahead[50], ahead[150], ahead[0]), (5.0, -5.0, 0.0));
        let slip = Reading::Slip(Quantity::Speed, 4.0).series(&up, &[], &[]);
        assert!((slip[100] - 4.0).abs() < 1e-6 && (slip[200] + 4.0).abs() < 1e-6);
        // Right after the turn it gives way like a spring.
        assert!((slip[100] - slip[101] - 4.0 * 2.0 * (1.0 - (-0.25_f64).exp())).abs() < 1e-6);
    }

    #[test]
    fn each_variable_is_a_coefficient_of_the_others_and_time_has_no_past() {
        let all = [(Quantity::Elongation, 0.01), (Quantity::Speed, 0.1), (Quantity::Time, 10.0)];
        let of = |q: Quantity| readings(q, &all);
        let by = [Reading::Times(Quantity::Elongation, 0.01), Reading::Times(Quantity::Speed, 0.1)];
        assert_eq!(of(Quantity::Time), by);
        assert_eq!(of(Quantity::Speed), [by[0].clone(), Reading::Times(Quantity::Time, 10.0)]);
        assert_eq!(by[1].factor(&[0.2]), Some(vec![2.0]));
        assert_eq!(by[1].times("x^2".to_owned()), "x^2 * (speed_m_s/other_m_s)");
        assert!(of(Quantity::Elongation).contains(&Reading::Rising(Quantity::Speed)));
    }
}
