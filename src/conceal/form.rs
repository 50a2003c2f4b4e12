//! Forms of drawn laws over a variable in its scale.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// A form; each is about 1 where it is greatest between -2 and 2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    Constant,
    /// `|x/2|^p`, and the same with the sign of `x`.
    Power(f64),
    SignedPower(f64),
    /// `x / (1 + |x|^p)^(1/p)`: saturates the sharper the greater `p`.
    Saturates(f64),
    /// `max(|x| - c, 0)^p` over its value at 2.
    Beyond {
        from: f64,
        power: f64,
    },
    /// `exp(-|x|^p)`.
    Decays(f64),
    /// `exp(-((x - c)/w)^2)`.
    Bump {
        at: f64,
        width: f64,
    },
    /// `sin(k x)`.
    Waves(f64),
    /// `ln(1 + k |x|)` over its value at 2.
    Logarithm(f64),
}

impl Form {
    pub fn draw(random: &mut ChaCha8Rng) -> Self {
        let mut between = |low: f64, high: f64| random.random_range(low..high);
        let (p, c, w) = (between(0.5, 2.8), between(0.3, 1.2), between(0.3, 0.9));
        match random.random_range(0..10) {
            0 | 1 => Self::Power(p),
            2 | 3 => Self::SignedPower(p),
            4 => Self::Saturates(1.0 + p),
            5 => Self::Beyond { from: c, power: 0.8 + 0.4 * p },
            6 => Self::Decays(p),
            7 => Self::Bump { at: c, width: w },
            8 => Self::Waves(c + 0.5),
            _ => Self::Logarithm(3.0 * c),
        }
    }

    /// Whether it is negative on one side.
    pub fn is_odd(self) -> bool {
        matches!(self, Self::SignedPower(_) | Self::Saturates(_) | Self::Waves(_))
    }

    /// As text over a variable.
    pub fn text(self, x: &str) -> String {
        match self {
            Self::Constant => "1".to_owned(),
            Self::Power(p) => format!("abs(0.5*{x})^{p:.6}"),
            Self::SignedPower(p) => format!("sign({x})*abs(0.5*{x})^{p:.6}"),
            Self::Saturates(p) => format!("{x}/(1 + abs({x})^{p:.6})^(1/{p:.6})"),
            Self::Beyond { from, power } => {
                format!("(max(abs({x}) - {from:.6}, 0)/(2 - {from:.6}))^{power:.6}")
            }
            Self::Decays(p) => format!("exp(-abs({x})^{p:.6})"),
            Self::Bump { at, width } => format!("exp(-(({x} - {at:.6})/{width:.6})^2)"),
            Self::Waves(k) => format!("sin({k:.6}*{x})"),
            Self::Logarithm(k) => format!("ln(1 + {k:.6}*abs({x}))/ln(1 + 2*{k:.6})"),
        }
    }

    pub fn value(self, x: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Power(p) => (0.5 * x).abs().powf(p),
            Self::SignedPower(p) => x.signum() * (0.5 * x).abs().powf(p),
            Self::Saturates(p) => x / (1.0 + x.abs().powf(p)).powf(1.0 / p),
            Self::Beyond { from, power } => ((x.abs() - from).max(0.0) / (2.0 - from)).powf(power),
            Self::Decays(p) => (-x.abs().powf(p)).exp(),
            Self::Bump { at, width } => (-((x - at) / width).powi(2)).exp(),
            Self::Waves(k) => (k * x).sin(),
            Self::Logarithm(k) => (k * x.abs()).ln_1p() / (2.0 * k).ln_1p(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn forms_are_about_one_where_they_are_greatest() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for _ in 0..200 {
            let form = Form::draw(&mut random);
            let greatest = (0..=200).map(|i| form.value(f64::from(i) * 0.02 - 2.0).abs()).fold(0.0, f64::max);
            assert!((0.4..1.001).contains(&greatest), "{form:?} {greatest}");
        }
    }
}
