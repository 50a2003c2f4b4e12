//! What a corrected scene is worth on the recording that nobody saw.

use std::path::Path;

use super::ProofError;
use crate::conceal::Truth;
use crate::identify::{RecordedRun, replay};
use crate::recording::{Recording, Run, RunUse, read_recording};

/// What a corrected scene closes that cannot be run on the recording: it does harm, as much as there was to gain.
const UNPLAYABLE: f64 = -1.0;

/// Share of the gap between the calibrated scene and the noise that the corrected scene closes; -1 where that diverges, or a law of it leaves
/// the range in which it means anything.
///
/// # Errors
/// A calibrated scene that cannot be run, files that cannot be read.
pub fn gap_on_holdout(truth: &Truth, answer: &Path, holdout: &Path) -> Result<f64, ProofError> {
    let Some(errors) = errors(truth, answer, holdout)? else { return Ok(UNPLAYABLE) };
    let mean = |which: usize| errors.iter().map(|e| e[which]).sum::<f64>() / errors.len().max(1) as f64;
    // Below a few hundredths of the noise there is no gap to close.
    let gap = (mean(0) - 1.0).max(0.02);
    Ok((mean(0) - mean(1)) / gap)
}

/// Mean squared residual of each output over the noise's variance: baseline, corrected. `None` where the corrected scene diverges.
fn errors(truth: &Truth, answer: &Path, holdout: &Path) -> Result<Option<Vec<[f64; 2]>>, ProofError> {
    let recording = read_recording(holdout)?;
    let run = RecordedRun {
        run: Run { file: holdout.display().to_string(), run_use: Some(RunUse::Holdout), ..Run::default() },
        recording,
    };
    let simulate = |scene: &str| replay(&answer.join(scene).display().to_string(), &[], &run, 1);
    let baseline = simulate("baseline.toml")?;
    let corrected = match simulate("scene.toml") {
        Err(error) if error.is_breakdown() => return Ok(None),
        played => played?,
    };
    let outputs = truth.rig.outputs().iter().zip(&truth.noise);
    let shown = outputs.filter(|(o, _)| run.recording.find(o.column).is_some());
    let squared: Result<Vec<[f64; 2]>, ProofError> = shown
        .map(|(o, noise)| {
            let squares = |simulated: &Recording| mean_square(&run.recording, simulated, o.column, noise.sd);
            Ok([squares(&baseline)?, squares(&corrected)?])
        })
        .collect();
    squared.map(Some)
}

fn mean_square(measured: &Recording, simulated: &Recording, column: &str, sd: f64) -> Result<f64, ProofError> {
    let (was, is) = (&measured.channel(column)?.values, &simulated.channel(column)?.values);
    let there: Vec<f64> = was.iter().zip(is).map(|(w, s)| (w - s) / sd).filter(|r| r.is_finite()).collect();
    Ok(there.iter().map(|r| r * r).sum::<f64>() / there.len().max(1) as f64)
}
