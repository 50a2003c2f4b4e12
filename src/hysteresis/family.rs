//! Every displacement-form model behind one door, as scenes and identifications name them.

use super::error::{HysteresisError, finite};
use super::{
    AsymmetricBoucWen, DahlGrowing, DisplacementModel, MaxwellSlip, PaperModel, PlayElement, PrandtlIshlinskii,
    SlipElement, SymmetricBoucWen,
};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A displacement-form model of any kind: input and output in mm, one state or several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "form", rename_all = "snake_case", bound(deserialize = "D: Scalar + Deserialize<'de>"))]
pub enum HysteresisModel<D> {
    Symmetric(SymmetricBoucWen<D>),
    Asymmetric(AsymmetricBoucWen<D>),
    Paper(PaperModel<D>),
    PrandtlIshlinskii(PrandtlIshlinskii<D>),
    MaxwellSlip(MaxwellSlip<D>),
    DahlGrowing(DahlGrowing<D>),
}

impl<D> From<DisplacementModel<D>> for HysteresisModel<D> {
    fn from(model: DisplacementModel<D>) -> Self {
        match model {
            DisplacementModel::Symmetric(model) => Self::Symmetric(model),
            DisplacementModel::Asymmetric(model) => Self::Asymmetric(model),
            DisplacementModel::Paper(model) => Self::Paper(model),
        }
    }
}

impl<D: Scalar> HysteresisModel<D> {
    /// The model if it is of the Bouc-Wen kind, with the one state `z`.
    pub(crate) fn bouc_wen(&self) -> Option<DisplacementModel<D>> {
        match self {
            Self::Symmetric(model) => Some(DisplacementModel::Symmetric(*model)),
            Self::Asymmetric(model) => Some(DisplacementModel::Asymmetric(*model)),
            Self::Paper(model) => Some(DisplacementModel::Paper(*model)),
            Self::PrandtlIshlinskii(_) | Self::MaxwellSlip(_) | Self::DahlGrowing(_) => None,
        }
    }

    /// The state before any motion, at the input `x_mm`.
    pub fn rest(&self, x_mm: D) -> Vec<D> {
        match self {
            Self::PrandtlIshlinskii(model) => model.rest(x_mm),
            Self::MaxwellSlip(model) => model.rest(),
            _ => vec![D::constant(0.0)],
        }
    }

    /// Moves a state of [`HysteresisModel::rest`] along: the input goes straight from `from_mm` to `to_mm` in `duration_s`.
    ///
    /// How finely the same path is cut does not matter; only a rate-dependent model looks at the duration.
    pub fn advance(&self, state: &mut [D], from_mm: D, to_mm: D, duration_s: f64) {
        match (self, state) {
            (Self::PrandtlIshlinskii(model), state) => {
                let speed = (to_mm - from_mm).value() / duration_s;
                model.advance(state, to_mm, if speed.is_finite() { speed } else { 0.0 });
            }
            (Self::MaxwellSlip(model), state) => model.advance(state, to_mm - from_mm),
            (Self::Symmetric(model), [z, ..]) => *z = model.advance(*z, from_mm, to_mm),
            (Self::Asymmetric(model), [z, ..]) => *z = model.advance(*z, from_mm, to_mm),
            (Self::Paper(model), [z, ..]) => *z = model.advance(*z, from_mm, to_mm),
            (Self::DahlGrowing(model), [z, ..]) => *z = model.advance(*z, from_mm, to_mm),
            (_, []) => {}
        }
    }

    /// Output at input `x_mm`, mm.
    pub fn output(&self, x_mm: D, state: &[D]) -> D {
        let z = state.first().copied().unwrap_or(D::constant(0.0));
        match self {
            Self::Symmetric(model) => model.output(x_mm, z),
            Self::Asymmetric(model) => model.output(x_mm, z),
            Self::Paper(model) => model.output(x_mm, z),
            Self::PrandtlIshlinskii(model) => model.output(x_mm, state),
            Self::MaxwellSlip(model) => model.output(x_mm, state),
            Self::DahlGrowing(model) => model.output(x_mm, z),
        }
    }

    /// Outputs along a piecewise linear path, from rest, mm; as many times as places.
    ///
    /// ```
    /// use smam::hysteresis::{HysteresisModel, PaperModel};
    ///
    /// let printed = HysteresisModel::Paper(PaperModel::printed());
    /// // Two strokes of 3 mm to settle, then there and back with a look at 1.78 mm each way.
    /// let plunger_mm = [0.0, 3.0, 0.0, 3.0, 0.0, 1.78, 3.0, 1.78];
    /// let time_s: Vec<f64> = (0..plunger_mm.len()).map(|i| 2.5 * i as f64).collect();
    /// let elongation_mm = printed.follow(&time_s, &plunger_mm);
    /// // 26.83 mm where the plunger turns; unloading lies 4.24 mm above loading where the loop is widest.
    /// assert!((elongation_mm[6] - 26.83).abs() < 0.01);
    /// assert!((elongation_mm[7] - elongation_mm[5] - 4.24).abs() < 0.02);
    /// assert!(printed.check_loops([0.0, 3.0]).is_ok());
    /// ```
    pub fn follow(&self, time_s: &[f64], path_mm: &[f64]) -> Vec<D> {
        let mut state = self.rest(D::constant(path_mm.first().copied().unwrap_or(0.0)));
        let mut before = None;
        let samples = time_s.iter().zip(path_mm);
        samples
            .map(|(&time, &place)| {
                let x = D::constant(place);
                if let Some((last_s, last)) = before {
                    self.advance(&mut state, D::constant(last), x, time - last_s);
                }
                before = Some((time, place));
                self.output(x, &state)
            })
            .collect()
    }

    /// Names of the free parameters, in the order of [`HysteresisModel::parameters`].
    ///
    /// Half widths and reaches are places on a grid and belong to the form; weights and stiffnesses are parameters.
    pub(crate) fn parameter_names(&self) -> Vec<String> {
        let with = |names: &[&str], element: &str, count: usize| {
            let fixed = names.iter().map(|&name| name.to_owned());
            fixed.chain((1..=count).map(|i| format!("{element}_{i}"))).collect()
        };
        match self {
            Self::Symmetric(_) => with(&SymmetricBoucWen::<f64>::PARAMETERS, "", 0),
            Self::Asymmetric(_) => with(&AsymmetricBoucWen::<f64>::PARAMETERS, "", 0),
            Self::Paper(_) => with(&PaperModel::<f64>::PARAMETERS, "", 0),
            Self::PrandtlIshlinskii(model) => {
                with(&["gain", "curvature", "asymmetry", "rate_s"], "weight", model.elements.len())
            }
            Self::MaxwellSlip(model) => {
                with(&["offset", "gain", "curvature", "cubic", "growth"], "stiffness", model.elements.len())
            }
            Self::DahlGrowing(_) => with(&DahlGrowing::<f64>::PARAMETERS, "", 0),
        }
    }

    /// The free parameters.
    pub fn parameters(&self) -> Vec<D> {
        match self {
            Self::Symmetric(model) => model.to_array().to_vec(),
            Self::Asymmetric(model) => model.to_array().to_vec(),
            Self::Paper(model) => model.to_array().to_vec(),
            Self::PrandtlIshlinskii(m) => {
                let weights = m.elements.iter().map(|e| e.weight);
                [m.gain, m.curvature, m.asymmetry, m.rate_s].into_iter().chain(weights).collect()
            }
            Self::MaxwellSlip(m) => {
                let stiffnesses = m.elements.iter().map(|e| e.stiffness);
                [m.offset, m.gain, m.curvature, m.cubic, m.growth].into_iter().chain(stiffnesses).collect()
            }
            Self::DahlGrowing(model) => model.to_array().to_vec(),
        }
    }

    /// Whether the parameters keep the state bounded.
    pub fn check(&self) -> Result<(), HysteresisError> {
        self.parameters().iter().try_for_each(|p| finite("displacement model", "each parameter", p.value()))?;
        match self {
            Self::Symmetric(model) => model.check(),
            Self::Asymmetric(model) => model.check(),
            Self::Paper(model) => model.check(),
            Self::PrandtlIshlinskii(model) => model.check(),
            Self::MaxwellSlip(model) => model.check(),
            Self::DahlGrowing(model) => model.check(),
        }
    }

    /// Whether every closed loop within the range of inputs turns the same way, so that none ever yields the energy that
    /// others take: [`DisplacementModel::check_loops`] and its likes.
    pub fn check_loops(&self, range_mm: [f64; 2]) -> Result<(), HysteresisError> {
        match self {
            Self::Symmetric(model) => model.check_loops(),
            Self::Asymmetric(model) => model.check_loops(range_mm),
            Self::Paper(model) => model.check_loops(),
            Self::PrandtlIshlinskii(model) => model.check_loops(range_mm[0].abs().max(range_mm[1].abs())),
            Self::MaxwellSlip(model) => model.check_loops(range_mm),
            Self::DahlGrowing(model) => model.check_loops(range_mm),
        }
    }
}

impl HysteresisModel<f64> {
    /// The same form with other parameters, perhaps of another number type.
    pub fn with_parameters<E: Scalar>(&self, values: &[E]) -> Result<HysteresisModel<E>, HysteresisError> {
        if let Some(model) = self.bouc_wen() {
            return Ok(model.with_parameters(values)?.into());
        }
        let wrong = |model, expected| HysteresisError::Count { model, given: values.len(), expected };
        match (self, values) {
            (Self::PrandtlIshlinskii(m), [gain, curvature, asymmetry, rate_s, weights @ ..])
                if weights.len() == m.elements.len() =>
            {
                let own = m.elements.iter().zip(weights);
                let element = |(e, &weight): (&PlayElement<f64>, &E)| PlayElement {
                    weight,
                    half_width: E::constant(e.half_width),
                };
                let elements = own.map(element).collect();
                let (gain, curvature, asymmetry, rate_s) = (*gain, *curvature, *asymmetry, *rate_s);
                Ok(HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii {
                    gain,
                    curvature,
                    asymmetry,
                    rate_s,
                    elements,
                }))
            }
            (Self::MaxwellSlip(m), [offset, gain, curvature, cubic, growth, stiffnesses @ ..])
                if stiffnesses.len() == m.elements.len() =>
            {
                let own = m.elements.iter().zip(stiffnesses);
                let element =
                    |(e, &stiffness): (&SlipElement<f64>, &E)| SlipElement { stiffness, reach: E::constant(e.reach) };
                let elements = own.map(element).collect();
                Ok(HysteresisModel::MaxwellSlip(MaxwellSlip {
                    offset: *offset,
                    gain: *gain,
                    curvature: *curvature,
                    cubic: *cubic,
                    growth: *growth,
                    gate: m.gate,
                    elements,
                }))
            }
            (Self::DahlGrowing(_), values) => {
                let values: [E; 9] = values.try_into().map_err(|_| wrong("growing Dahl", 9))?;
                Ok(HysteresisModel::DahlGrowing(DahlGrowing::from_array(values)))
            }
            (Self::MaxwellSlip(m), _) => Err(wrong("Maxwell-slip", 5 + m.elements.len())),
            (m, _) => Err(wrong("Prandtl-Ishlinskii", m.parameters().len())),
        }
    }
}
