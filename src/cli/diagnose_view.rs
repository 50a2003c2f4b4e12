//! What a diagnosis shows in the viewer: to `diagnosis.rrd`, or in a window.

use std::path::Path;

use smam::diagnose::Outcome;

use super::CliError;

/// Where a diagnosis is to be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    pub in_file: bool,
    pub in_window: bool,
}

#[cfg(not(feature = "viz"))]
impl Shown {
    /// Refuses before anything is computed what this build cannot show.
    pub fn check(self) -> Result<(), CliError> {
        if self.in_file || self.in_window {
            return Err(CliError::Usage(
                "--rrd and --view need the viewer, which this build leaves out\n  remedy: build with the default features"
                    .to_owned(),
            ));
        }
        Ok(())
    }

    pub fn show(self, _: &Outcome, _: &Path) -> Result<(), CliError> {
        self.check()
    }
}

#[cfg(feature = "viz")]
impl Shown {
    /// Everything can be shown.
    pub fn check(self) -> Result<(), CliError> {
        Ok(())
    }

    /// Replays the runs and shows them; nothing happens when nothing was asked for.
    pub fn show(self, outcome: &Outcome, out: &Path) -> Result<(), CliError> {
        use smam::view::{ViewOptions, ViewSink, show_diagnosis};
        if !(self.in_file || self.in_window) {
            return Ok(());
        }
        let runs = smam::diagnose::side_by_side(outcome)?;
        if runs.is_empty() {
            eprintln!("note: no picture for the viewer: the recordings could not be diagnosed");
            return Ok(());
        }
        let file = self.in_file.then(|| ViewSink::File(out.join("diagnosis.rrd")));
        let scale = &outcome.case.scene.file.view;
        let options = ViewOptions {
            tension_scale_n: scale.tension_scale_n,
            pressure_scale_pa: scale.pressure_scale_pa,
            ..ViewOptions::default()
        };
        let name = format!("Diagnosis of {}", outcome.case.scene.file.name);
        for sink in file.into_iter().chain(self.in_window.then_some(ViewSink::Window)) {
            eprintln!("{}", show_diagnosis(&sink, &name, &verdict(outcome), &runs, &options)?);
        }
        Ok(())
    }
}

/// The verdict with the effects and the errors of the held-out runs, as Markdown.
#[cfg(feature = "viz")]
fn verdict(outcome: &Outcome) -> String {
    let d = &outcome.diagnosis;
    let mut text = format!("{}\n\n| held-out runs | calibrated | corrected | noise |\n|---|---|---|---|\n", d.summary);
    for (column, p) in &d.fit.channels {
        text += &format!("| {column} | {:.3} | {:.3} | {:.3} |\n", p.rmse_baseline, p.rmse_corrected, p.noise_sd);
    }
    text + "\nErrors are root mean squares in the channel's unit."
}
