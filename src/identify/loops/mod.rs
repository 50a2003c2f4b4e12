//! Identification of the displacement-form hysteresis models from recorded loops: plunger in, elongation out.
//!
//! F is the mean squared error in mm², as in Thai et al. 2021. What is wrong by construction is fixed and said (a
//! scale that the data cannot hold); what the data leave open is found from the Jacobian and said too.
//!
//! ```
//! use std::f64::consts::TAU;
//!
//! use smam::identify::loops::{Form, LoopRun, LoopScale, SearchOptions, identify, mean_square_on};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Half a minute of strokes whose depth changes, and the paper's muscle, without noise.
//! let time_s: Vec<f64> = (0..1500).map(|i| f64::from(i) * 0.02).collect();
//! let depth = |&t: &f64| 1.5 - 1.1 * (TAU * 0.1 * t).cos() - 0.4 * (TAU * 0.3 * t).cos();
//! let input_mm: Vec<f64> = time_s.iter().map(depth).collect();
//! let scale = LoopScale { input_mm: [0.0, 3.0], slope: 9.0 };
//! let muscle = Form::Paper.blank(&scale).with_parameters(&Form::Paper.typical())?;
//! let output_mm = muscle.follow(&time_s, &input_mm);
//! let runs = [LoopRun { name: "made".to_owned(), time_s, input_mm, output_mm }];
//! let found = identify(&runs, Form::Paper, &SearchOptions::default())?;
//! // F below the square of a hundredth of a millimetre; the elongation goes over 27 mm.
//! assert!(found.mean_square_mm2 < 1e-4 && mean_square_on(&found.model, &runs) < 1e-4);
//! assert!((found.parameters[1].value - 9.886).abs() < 0.1);
//! # Ok(())
//! # }
//! ```

mod cma;
mod coarse;
mod data;
mod form;
mod intervals;
mod problem;
mod search;
mod swarm;
mod warnings;

#[cfg(test)]
mod recovery_tests;

pub use data::LoopRun;
pub use form::{Form, ParameterSpec};
pub use intervals::Certainty;
pub use search::{Method, SearchOptions};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    cma::CmaOptions,
    data::LoopScale,
    intervals::certainty,
    problem::Problem,
    search::{Found, search},
    swarm::SwarmOptions,
};

use crate::hysteresis::HysteresisModel;
use crate::recording::{RecordingError, noise_sd};

/// Why a loop cannot be identified.
#[derive(Debug, thiserror::Error)]
pub enum LoopError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(
        "{file}: column \"{column}\" is no length\n  remedy: name a column that ends in a unit of length, such as elongation_mm"
    )]
    Unit { file: String, column: String },
    #[error(
        "{file}: column \"{column}\" is input and output at once\n  remedy: name another one with --input or --output"
    )]
    Same { file: String, column: String },
    #[error(
        "{file}: {counted} samples to fit over {travel_mm:.3} mm of input are too little\n  \
         remedy: record whole strokes, at least 50 samples"
    )]
    TooLittle { file: String, counted: usize, travel_mm: f64 },
    #[error("{file}: time, input and output must be of one length, the input without gaps\n  remedy: cut or fill them")]
    Ragged { file: String },
    #[error(
        "recordings.toml: no run to fit: every one is held out\n  remedy: mark one with use = \"fit\" in recordings.toml"
    )]
    NoRun,
    #[error(
        "{form}: no parameters within their bounds can follow the data\n  remedy: look at the recording first; input and \
         output may be exchanged (--input, --output)"
    )]
    NoStart { form: &'static str },
}

/// One identified parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    pub spec: ParameterSpec,
    pub value: f64,
    /// Half the 95 % interval; `None` for a fixed one.
    pub half_width: Option<f64>,
    pub on_bound: bool,
}

/// An identified model and how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    pub form: Form,
    pub method: Method,
    pub model: HysteresisModel<f64>,
    /// In the order of [`HysteresisModel::parameters`].
    pub parameters: Vec<Identified>,
    /// F over all samples that count, mm².
    pub mean_square_mm2: f64,
    pub samples: usize,
    /// Model evaluations; of a Jacobian each column counts as one.
    pub evaluations: usize,
    pub certainty: Certainty,
    /// Names of the free parameters, in the order of the certainty's.
    pub free: Vec<String>,
    /// White noise of the output by its own look, mm.
    pub noise_mm: Option<f64>,
    pub warnings: Vec<String>,
}

/// Identifies one form from runs.
pub fn identify(runs: &[LoopRun], form: Form, options: &SearchOptions) -> Result<Identification, LoopError> {
    if runs.is_empty() {
        return Err(LoopError::NoRun);
    }
    runs.iter().try_for_each(LoopRun::check)?;
    let scale = LoopScale::of(runs);
    let problem = Problem::new(runs, form, &scale);
    let no_start = || LoopError::NoStart { form: form.name() };
    let found = search(&problem, options).ok_or_else(no_start)?;
    let residuals = problem.residuals(&found.parameters).ok_or_else(no_start)?;
    let jacobian = problem.jacobian(&found.parameters).ok_or_else(no_start)?;
    let model = problem.model(&found.parameters).ok_or_else(no_start)?;
    let certainty = certainty(&residuals, &jacobian);
    let mut half_widths = certainty.half_width.iter();
    let values = problem.all(&found.parameters);
    let parameters: Vec<Identified> = problem
        .specs
        .iter()
        .zip(values)
        .map(|(spec, value)| Identified {
            half_width: if spec.fixed.is_none() { half_widths.next().copied() } else { None },
            on_bound: spec.fixed.is_none() && (value - spec.min).min(spec.max - value) < 1e-6 * (spec.max - spec.min),
            spec: spec.clone(),
            value,
        })
        .collect();
    let identification = Identification {
        form,
        method: options.method,
        model,
        parameters,
        mean_square_mm2: residuals.norm_squared() / residuals.len() as f64,
        samples: residuals.len(),
        evaluations: found.evaluations,
        certainty,
        free: problem.free().iter().map(|s| s.name.clone()).collect(),
        noise_mm: runs.iter().filter_map(|r| noise_sd(&r.time_s, &r.output_mm)).reduce(f64::min),
        warnings: Vec::new(),
    };
    let warnings = warnings::warnings(&identification, &scale, runs);
    Ok(Identification { warnings, ..identification })
}

/// F of a model on runs that had no part in finding it, mm²; the model starts each at rest.
pub fn mean_square_on(model: &HysteresisModel<f64>, runs: &[LoopRun]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for run in runs {
        let outputs = model.follow(&run.time_s, &run.input_mm);
        for (y, measured) in outputs.iter().zip(&run.output_mm).filter(|(_, m)| m.is_finite()) {
            sum += (y - measured) * (y - measured);
            count += 1.0;
        }
    }
    sum / count
}
