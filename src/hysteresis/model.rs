//! The three models of the Bouc-Wen kind behind one interface; [`super::HysteresisModel`] adds those with several states.

use super::branch::Branch;
use super::error::HysteresisError;
use super::{AsymmetricBoucWen, Gate, PaperModel, SymmetricBoucWen};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// One of the paper's three models, input and output in mm, one state `z` that starts at 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "form", rename_all = "snake_case")]
pub enum DisplacementModel<D> {
    Symmetric(SymmetricBoucWen<D>),
    Asymmetric(AsymmetricBoucWen<D>),
    Paper(PaperModel<D>),
}

impl<D: Scalar> DisplacementModel<D> {
    /// Output at input `x_mm` and state `z`, mm.
    pub fn output(&self, x_mm: D, z: D) -> D {
        match self {
            Self::Symmetric(model) => model.output(x_mm, z),
            Self::Asymmetric(model) => model.output(x_mm, z),
            Self::Paper(model) => model.output(x_mm, z),
        }
    }

    /// State after the input went straight from `from_mm` to `to_mm`.
    ///
    /// Closed form for `n = 1` in plain numbers, else integrated to 1e-12 per step: how finely a recording
    /// samples the same path does not matter. NaN when inadmissible parameters let the state run away.
    pub fn advance(&self, z: D, from_mm: D, to_mm: D) -> D {
        match self {
            Self::Symmetric(model) => model.advance(z, from_mm, to_mm),
            Self::Asymmetric(model) => model.advance(z, from_mm, to_mm),
            Self::Paper(model) => model.advance(z, from_mm, to_mm),
        }
    }

    /// The state's law on one side of `x = 0` (1 or -1) while the input goes up (`way` 1) or down (-1).
    pub(super) fn branch(&self, side: f64, way: f64) -> Branch<D> {
        match self {
            Self::Symmetric(model) => model.branch(way),
            Self::Asymmetric(model) => model.branch(side, way),
            Self::Paper(model) => model.branch(way),
        }
    }

    /// What the output is a sum of, by this form alone: a curve, the input, and the state's factor.
    pub fn terms(&self, x_mm: D) -> [D; 3] {
        let [zero, one] = [0.0, 1.0].map(D::constant);
        match self {
            Self::Paper(_) if x_mm.value() < 0.0 => [zero; 3],
            Self::Paper(model) => [model.powered(x_mm), x_mm, model.gate.factor(x_mm)],
            Self::Symmetric(_) | Self::Asymmetric(_) => [zero, x_mm, one],
        }
    }

    /// The output's weights of the terms.
    pub fn gains(&self) -> [D; 3] {
        match self {
            Self::Symmetric(m) => [D::constant(0.0), m.gamma_x, m.gamma_z],
            Self::Asymmetric(m) => [D::constant(0.0), m.alpha_x, m.alpha_z],
            Self::Paper(m) => [m.alpha_x1, m.alpha_x2, m.alpha_z],
        }
    }

    /// Outputs along a piecewise linear path that starts with state `z`, mm; also the last state.
    pub fn follow(&self, mut z: D, path_mm: &[D]) -> (Vec<D>, D) {
        let mut outputs = Vec::with_capacity(path_mm.len());
        let mut before = None;
        for &x in path_mm {
            if let Some(from) = before {
                z = self.advance(z, from, x);
            }
            outputs.push(self.output(x, z));
            before = Some(x);
        }
        (outputs, z)
    }

    /// Names of the free parameters, in the order of [`DisplacementModel::parameters`].
    #[doc(hidden)]
    pub fn parameter_names(&self) -> &'static [&'static str] {
        match self {
            Self::Symmetric(_) => &SymmetricBoucWen::<f64>::PARAMETERS,
            Self::Asymmetric(_) => &AsymmetricBoucWen::<f64>::PARAMETERS,
            Self::Paper(_) => &PaperModel::<f64>::PARAMETERS,
        }
    }

    /// The free parameters.
    pub fn parameters(&self) -> Vec<D> {
        match self {
            Self::Symmetric(model) => model.to_array().to_vec(),
            Self::Asymmetric(model) => model.to_array().to_vec(),
            Self::Paper(model) => model.to_array().to_vec(),
        }
    }

    /// The same form with other parameters, perhaps of another number type.
    pub fn with_parameters<E: Scalar>(&self, values: &[E]) -> Result<DisplacementModel<E>, HysteresisError> {
        Ok(match self {
            Self::Symmetric(_) => {
                DisplacementModel::Symmetric(SymmetricBoucWen::from_array(sized("symmetric Bouc-Wen", values)?))
            }
            Self::Asymmetric(_) => {
                DisplacementModel::Asymmetric(AsymmetricBoucWen::from_array(sized("asymmetric Bouc-Wen", values)?))
            }
            Self::Paper(model) => {
                DisplacementModel::Paper(paper_like(model.power, model.gate, sized("asymmetric model", values)?))
            }
        })
    }

    /// Whether the parameters keep the state bounded.
    pub fn check(&self) -> Result<(), HysteresisError> {
        match self {
            Self::Symmetric(model) => model.check(),
            Self::Asymmetric(model) => model.check(),
            Self::Paper(model) => model.check(),
        }
    }

    /// Whether every closed loop within the range of inputs turns the same way, `∮ z dx >= 0`: the unloading branch
    /// stays above the loading one where the gain of `z` is negative, below where it is positive, and the energy that such a
    /// loop stands for is never gained.
    ///
    /// Sufficient conditions, each with its proof at the model's own `check_loops`.
    pub fn check_loops(&self, range_mm: [f64; 2]) -> Result<(), HysteresisError> {
        match self {
            Self::Symmetric(model) => model.check_loops(),
            Self::Asymmetric(model) => model.check_loops(range_mm),
            Self::Paper(model) => model.check_loops(),
        }
    }
}

fn paper_like<E: Scalar>(power: f64, gate: Gate, values: [E; 7]) -> PaperModel<E> {
    PaperModel { power, gate, ..PaperModel::from_array(values) }
}

fn sized<E: Copy, const N: usize>(model: &'static str, values: &[E]) -> Result<[E; N], HysteresisError> {
    values.try_into().map_err(|_| HysteresisError::Count { model, given: values.len(), expected: N })
}
