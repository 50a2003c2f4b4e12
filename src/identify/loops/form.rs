//! The forms that can be identified, and for each parameter: where it is searched, and why there.

use serde::{Deserialize, Serialize};

use crate::hysteresis::{
    AsymmetricBoucWen, DahlGrowing, Gate, HysteresisModel, MaxwellSlip, PaperModel, PlayElement, PrandtlIshlinskii,
    SlipElement, SymmetricBoucWen,
};

use super::data::LoopScale;

/// A form by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    Symmetric,
    Asymmetric,
    Paper,
    PrandtlIshlinskii,
    /// With half widths that grow with speed.
    PrandtlIshlinskiiRate,
    MaxwellSlip,
    /// With friction that grows, or falls, along the input.
    MaxwellSlipGrowing,
    /// The same with one state that fades instead of sliders.
    DahlGrowing,
}

/// A parameter in a search.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSpec {
    pub name: String,
    pub min: f64,
    pub max: f64,
    /// Its value where no data can tell it, and why.
    pub fixed: Option<(f64, &'static str)>,
    /// The output is linear in it and the state does not depend on it.
    pub is_gain: bool,
    /// Positive and of unknown magnitude: searched by its logarithm.
    pub is_scale: bool,
    /// What stands behind its bounds.
    pub why: &'static str,
}

/// Half widths of the plays, and reaches of the sliders, as shares of the stroke: close together where a loop of
/// a tenth of the stroke bends, none beyond a third, where a play hardly moves.
const GRID: [f64; 4] = [0.02, 0.06, 0.12, 0.25];

/// The same for friction that grows: up to half of the stroke, as its sliders share out one exponential.
const WIDE_GRID: [f64; 5] = [0.03, 0.08, 0.17, 0.32, 0.55];

const GAIN: &str = "three times the mean slope of the data: beyond that two gains only cancel each other";
const CURVE: &str = "over the whole stroke no more than the line gives";
const FADING: &str = "the state forgets over a 200th of the stroke (a kink) to three strokes (a line)";
const LEAN: &str = "as far as the fading itself: beyond that the state is unbounded or the loop gains energy";
const GROWING: &str = "from friction that fades over the stroke to eleven times as much at its end";
const POWER: &str = "0.5 is a kink at reversal, 4 nearly a slope with a stop";
const SCALE: &str =
    "the data hold only products with the gain of z: z twice as large with half the gain is the same output";
const ONE_SIDED: &str = "the input stays at x >= 0, where this term cannot be told from another one";

impl Form {
    pub const ALL: [Self; 8] = [
        Self::Symmetric,
        Self::Asymmetric,
        Self::Paper,
        Self::PrandtlIshlinskii,
        Self::PrandtlIshlinskiiRate,
        Self::MaxwellSlip,
        Self::MaxwellSlipGrowing,
        Self::DahlGrowing,
    ];

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Symmetric => "symmetric",
            Self::Asymmetric => "asymmetric",
            Self::Paper => "paper",
            Self::PrandtlIshlinskii => "prandtl-ishlinskii",
            Self::PrandtlIshlinskiiRate => "prandtl-ishlinskii-rate",
            Self::MaxwellSlip => "maxwell-slip",
            Self::MaxwellSlipGrowing => "maxwell-slip-growing",
            Self::DahlGrowing => "dahl-growing",
        }
    }

    /// The form without numbers; grids of half widths are laid over the stroke of the data.
    pub fn blank(self, scale: &LoopScale) -> HysteresisModel<f64> {
        let grid = GRID.map(|share| share * scale.stroke_mm());
        match self {
            Self::Symmetric => HysteresisModel::Symmetric(SymmetricBoucWen::from_array([0.0; 6])),
            Self::Asymmetric => HysteresisModel::Asymmetric(AsymmetricBoucWen::from_array([0.0; 10])),
            Self::Paper => HysteresisModel::Paper(PaperModel::from_array([0.0; 7])),
            Self::PrandtlIshlinskii | Self::PrandtlIshlinskiiRate => {
                let plays = grid.map(|half_width| PlayElement { weight: 0.0, half_width });
                HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii::classical(0.0, plays.to_vec()))
            }
            Self::MaxwellSlip => slipping(Gate::Tanh, &grid),
            Self::MaxwellSlipGrowing => slipping(Gate::None, &WIDE_GRID.map(|share| share * scale.stroke_mm())),
            Self::DahlGrowing => HysteresisModel::DahlGrowing(DahlGrowing::from_array([0.0; 9])),
        }
    }

    /// Parameters at the size of the paper's muscle (3 mm of stroke, about 9 mm per mm), a redundant scale at 1; those of the
    /// paper's form are the printed ones.
    pub fn typical(self) -> Vec<f64> {
        match self {
            Self::Symmetric => vec![9.0, -4.0, 1.0, 1.6, 0.5, 1.2],
            Self::Asymmetric => vec![9.0, -4.0, 1.0, 1.2, 1.8, 0.3, -0.2, 0.0, 0.0, 0.4],
            Self::Paper => vec![-0.082, 9.886, -5.393, 1.0, 1.035, 2.263, -0.1436],
            Self::PrandtlIshlinskii => vec![5.0, -0.1, 0.04, 0.0, 1.0, 1.2, 0.8, 1.0],
            Self::PrandtlIshlinskiiRate => vec![5.0, -0.1, 0.04, 0.03, 1.0, 1.2, 0.8, 1.0],
            Self::MaxwellSlip => vec![0.0, 9.0, -0.1, 0.0, 0.0, -1.0, -1.5, -1.0, -0.8],
            Self::MaxwellSlipGrowing => vec![0.5, 9.0, -0.1, 0.05, 0.4, -0.6, -0.9, -0.7, -0.6, -0.5],
            Self::DahlGrowing => vec![0.3, 9.8, 0.9, -0.15, -1.2, 2.0, 1.5, 0.17, -0.08],
        }
    }

    /// Where each parameter is searched, in the order of [`HysteresisModel::parameters`]; bounds follow the data's size.
    pub fn parameters(self, scale: &LoopScale) -> Vec<ParameterSpec> {
        let names = self.blank(scale).parameter_names();
        names.into_iter().map(|name| self.parameter(name, scale)).collect()
    }

    fn parameter(self, name: String, scale: &LoopScale) -> ParameterSpec {
        let (slope, stroke) = (scale.slope, scale.stroke_mm());
        let plain = |min: f64, max: f64, why| ParameterSpec {
            name: name.clone(),
            min,
            max,
            fixed: None,
            is_gain: false,
            is_scale: false,
            why,
        };
        let gain = |size: f64, why| ParameterSpec { is_gain: true, ..plain(-size, size, why) };
        let fixed = |value: f64, why| ParameterSpec { fixed: Some((value, why)), ..plain(value, value, why) };
        let (slowest, fastest) = (1.0 / (3.0 * stroke), 200.0 / stroke);
        match name.as_str() {
            "gamma_x" | "gamma_z" | "alpha_x" | "alpha_x2" | "alpha_z" | "gain" => gain(3.0 * slope.abs(), GAIN),
            "alpha_x1" | "curvature" => gain(slope.abs() / stroke, CURVE),
            "k" | "a" => fixed(1.0, SCALE),
            "n" => plain(0.5, 4.0, POWER),
            "nu" | "lambda" | "b1" => ParameterSpec { is_scale: true, ..plain(slowest, fastest, FADING) },
            "rho" => plain(-0.95, 0.95, "|rho| < a: else the state leaves on its own"),
            "b4" | "b5" if scale.is_one_sided() => fixed(0.0, ONE_SIDED),
            "delta" | "b2" | "b3" | "b4" | "b5" | "b6" => plain(-fastest, fastest, LEAN),
            "asymmetry" => {
                plain(0.0, 0.45 / scale.input_mm[0].abs().max(scale.input_mm[1].abs()), "the edges of a play must rise")
            }
            "rate_s" if self == Self::PrandtlIshlinskii => fixed(0.0, "the form without dependence on speed"),
            "rate_s" => plain(0.0, 1.0, "half a stroke of widening at a stroke in half a second"),
            "offset" | "cubic" if self == Self::MaxwellSlip => fixed(0.0, "the form without it"),
            "offset" => gain(3.0 * slope.abs() * stroke, "three times the range of the data"),
            "cubic" => gain(slope.abs() / (stroke * stroke), CURVE),
            "growth" if self == Self::MaxwellSlip => fixed(0.0, "the form whose friction only the gate changes"),
            // Friction stays above zero within the data; at the other end it may be far greater.
            "growth" => {
                let [low, high] = scale.input_mm;
                let most = if low < 0.0 { (0.9 / -low).min(10.0 / stroke) } else { 10.0 / stroke };
                plain(-0.9 / high.abs().max(0.1 * stroke), most, GROWING)
            }
            "bend" => {
                let most = 0.45 / scale.input_mm[0].abs().max(scale.input_mm[1].abs());
                plain(-most, most, "the way that friction slides must not turn")
            }
            _ => gain(3.0 * slope.abs(), GAIN),
        }
    }
}

/// Sliders of given reaches, without numbers.
fn slipping(gate: Gate, reaches_mm: &[f64]) -> HysteresisModel<f64> {
    let elements = reaches_mm.iter().map(|&reach| SlipElement { stiffness: 0.0, reach }).collect();
    HysteresisModel::MaxwellSlip(MaxwellSlip {
        offset: 0.0,
        gain: 0.0,
        curvature: 0.0,
        cubic: 0.0,
        growth: 0.0,
        gate,
        elements,
    })
}

impl std::str::FromStr for Form {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|f| f.name() == text).ok_or_else(|| format!("no model `{text}`; known: {}", known()))
    }
}
