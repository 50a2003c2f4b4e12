//! The page of a diagnosis: verdict, where, what, how much better, what next.

use crate::diagnose::{Estimate, NamedEffect, Outcome};

use super::HtmlPage;
use super::axis::three_digits;
use super::compare_figure::{ComparedChannel, ComparedRun, compare_svg};
use super::diagnosis_map::{bars_svg, state_map_svg, time_lines_svg};

/// One self-contained page, readable by a person who was not there.
pub fn diagnosis_page(outcome: &Outcome) -> String {
    let d = &outcome.diagnosis;
    let mut page = HtmlPage::new(&format!("Diagnosis of {} ({})", d.recordings.join(", "), d.scene));
    page.paragraph(&d.summary);
    location(&mut page, outcome);
    what(&mut page, outcome);
    better(&mut page, outcome);
    next(&mut page, outcome);
    detectable(&mut page, outcome);
    if !d.warnings.is_empty() {
        page.heading("What to know besides");
        d.warnings.iter().for_each(|w| {
            page.paragraph(w);
        });
    }
    page.finish()
}

fn location(page: &mut HtmlPage, outcome: &Outcome) {
    let location = &outcome.diagnosis.location;
    if location.element.is_none() {
        return;
    }
    page.heading("Where");
    let rows: Vec<Vec<String>> = location.ranked.iter().map(|(e, p)| vec![e.clone(), format!("{p:.3}")]).collect();
    page.table(&["element", "probability"], &rows);
    if !location.state_region.is_empty() {
        page.paragraph(&format!("The calibrated scene is furthest off at {}.", location.state_region));
    }
    let windows: Vec<String> =
        location.time_windows_s.iter().take(12).map(|(f, a, b)| format!("{f} {a:.1} to {b:.1} s")).collect();
    if let Some([before, after]) = &outcome.residuals {
        page.figure(&time_lines_svg(outcome), "Marked: where the calibrated scene is off by more than noise.");
        let caption = "Calibrated scene: residual in units of the noise, by level and motion of the first input.";
        page.figure(&state_map_svg(outcome, before), caption);
        if !outcome.diagnosis.effects.is_empty() {
            page.figure(&state_map_svg(outcome, after), "The same with what was found in place.");
        }
    }
    if let Some(set) = location.indistinguishable.first() {
        page.paragraph(&format!("With these channels, effects in {} can look the same.", set.join(" and ")));
    }
    if !windows.is_empty() {
        let more = location.time_windows_s.len().saturating_sub(windows.len());
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        page.paragraph(&format!("More than noise in: {}{rest}.", windows.join("; ")));
    }
}

fn what(page: &mut HtmlPage, outcome: &Outcome) {
    let d = &outcome.diagnosis;
    if !d.effects.is_empty() {
        page.heading("What");
        let rows: Vec<Vec<String>> = d.effects.iter().flat_map(effect_rows).collect();
        page.table(&["effect", "element", "probability", "number (SI)", "value", "95 % interval", "law"], &rows);
    }
    from_run_to_run(page, &d.effects);
    if !outcome.rivals.is_empty() {
        let best = outcome.corrected.as_ref().map_or(0.0, |f| f.cost);
        let rows: Vec<Vec<String>> =
            outcome.rivals.iter().map(|(title, cost)| vec![title.clone(), format!("{:.0}", cost - best)]).collect();
        page.heading("Rivals, refitted jointly, and why they lost");
        page.table(&["instead", "chi² above the answer"], &rows);
    }
    page.heading("Calibration with it");
    let rows: Vec<Vec<String>> = d.calibration.iter().map(|(k, e)| [vec![k.clone()], estimate(e)].concat()).collect();
    page.table(&["number (SI)", "value", "95 % interval"], &rows);
}

/// The size of each effect as every run by itself would have it.
fn from_run_to_run(page: &mut HtmlPage, effects: &[NamedEffect]) {
    let row = |e: &NamedEffect, (file, size): (&String, &Estimate)| {
        [vec![e.name.clone(), file.clone()], estimate(size)].concat()
    };
    let rows: Vec<Vec<String>> =
        effects.iter().flat_map(|e| e.size_by_run.iter().map(move |one| row(e, one))).collect();
    if !rows.is_empty() {
        page.heading("From run to run");
        page.table(&["effect", "by itself", "size (SI)", "95 % interval"], &rows);
    }
}

fn effect_rows(e: &NamedEffect) -> Vec<Vec<String>> {
    let element = e.channel.as_ref().map_or_else(|| e.element.clone(), |c| format!("{} {c}", e.element));
    let row = |(i, (key, number)): (usize, (&String, &Estimate))| {
        let head = match i {
            0 => vec![e.name.clone(), element.clone(), format!("{:.3}", e.probability)],
            _ => vec![String::new(); 3],
        };
        let law = if i == 0 { e.law.clone() } else { String::new() };
        [head, vec![key.clone()], estimate(number), vec![law]].concat()
    };
    e.parameters.iter().enumerate().map(row).collect()
}

fn estimate(e: &Estimate) -> Vec<String> {
    let fixed = e.ci95[0] == e.ci95[1];
    let interval = if fixed { "not fitted".to_owned() } else { format!("{:.3e} to {:.3e}", e.ci95[0], e.ci95[1]) };
    vec![format!("{:.4e}", e.value), interval]
}

fn better(page: &mut HtmlPage, outcome: &Outcome) {
    let d = &outcome.diagnosis;
    page.heading("How much better");
    let rows: Vec<Vec<String>> = d
        .fit
        .channels
        .iter()
        .map(|(channel, p)| {
            let numbers = [p.rmse_baseline, p.rmse_corrected, p.noise_sd, p.rmse_corrected / p.noise_sd];
            [vec![channel.clone()], numbers.map(three_digits).to_vec()].concat()
        })
        .collect();
    page.table(&["sealed runs", "RMSE calibrated", "RMSE corrected", "noise", "corrected / noise"], &rows);
    page.figure(&bars_svg(outcome), "Runs that had no part in choosing or fitting.");
    full_scene(page, outcome);
    placebos(page, outcome);
    if !d.effects.is_empty() {
        page.paragraph(&format!(
            "{:.1} % of the gap between the calibrated scene and the noise is closed on sealed runs ({}), 95 % interval \
             {:.1} to {:.1} %.",
            100.0 * d.fit.gap_closed,
            d.fit.holdout.join(", "),
            100.0 * d.fit.gain_ci95[0],
            100.0 * d.fit.gain_ci95[1]
        ));
    }
    let Some([before, after]) = &outcome.residuals else { return };
    let figure =
        |title: &str, residuals| compare_svg(title, "runs held back are marked (sealed)", &runs(outcome, residuals));
    page.figure(&figure("Measured and calibrated scene", before), "Before: the scene, its calibration refitted.");
    if !d.effects.is_empty() {
        page.figure(&figure("Measured and corrected scene", after), "After: the scene with what was found.");
    }
}

/// How near the fast model, on which all this rests, is to the full scene.
fn full_scene(page: &mut HtmlPage, outcome: &Outcome) {
    let full = &outcome.diagnosis.fit.full_scene;
    let each: Vec<String> =
        full.rms_difference_over_noise.iter().map(|(column, d)| format!("{column} {d:.3}")).collect();
    let consequence = match full.agrees {
        true => "They agree",
        false => "They do not agree, and the figures of the sealed runs are those of the full scene",
    };
    page.paragraph(&format!(
        "The fast model against the full scene with the numbers found, in units of the noise: {}. {consequence}.",
        each.join(", ")
    ));
}

fn placebos(page: &mut HtmlPage, outcome: &Outcome) {
    let placebos = &outcome.diagnosis.fit.placebo_gap_closed;
    if placebos.is_empty() {
        return;
    }
    let rows: Vec<Vec<String>> =
        placebos.iter().map(|(title, gap)| vec![title.clone(), format!("{:.1} %", 100.0 * gap)]).collect();
    page.paragraph("What other effects would have closed of the gap on the sealed runs:");
    page.table(&["instead", "gap closed"], &rows);
}

fn next(page: &mut HtmlPage, outcome: &Outcome) {
    let next = &outcome.diagnosis.next_experiment;
    page.heading("What to do next");
    page.paragraph(&format!("{}.", next.why));
    if let Some(file) = &next.file {
        page.paragraph(&format!(
            "{file} holds the inputs for the rig; `smam run scene.toml --input {file}` shows what the corrected scene \
             expects."
        ));
    }
}

/// The runs with their residuals taken off the measured values.
fn runs(outcome: &Outcome, residuals: &[Vec<Vec<f64>>]) -> Vec<ComparedRun> {
    let case = &outcome.case;
    let compared = case.runs.iter().zip(residuals).map(|(run, residuals)| ComparedRun {
        name: if run.is_sealed { format!("{} (sealed)", run.file) } else { run.file.clone() },
        time_s: run.times_s().to_vec(),
        channels: case
            .channels
            .iter()
            .enumerate()
            .map(|(c, channel)| {
                let finite: Vec<f64> = residuals[c].iter().copied().filter(|r| r.is_finite()).collect();
                ComparedChannel {
                    column: channel.column.clone(),
                    measured: run.measured[c].clone(),
                    simulated: run.measured[c].iter().zip(&residuals[c]).map(|(m, r)| m - r).collect(),
                    noise_sd: Some(outcome.noise[c].sd),
                    rmse: (finite.iter().map(|r| r * r).sum::<f64>() / finite.len().max(1) as f64).sqrt(),
                }
            })
            .collect(),
    });
    compared.collect()
}

fn detectable(page: &mut HtmlPage, outcome: &Outcome) {
    let smallest = &outcome.diagnosis.detection.smallest_detectable;
    if smallest.is_empty() {
        return;
    }
    page.heading("What would have been seen");
    page.paragraph("The smallest size (SI) of each effect that these recordings would have shown.");
    let rows: Vec<Vec<String>> =
        smallest.iter().map(|(title, size)| vec![title.clone(), format!("{size:.2e}")]).collect();
    page.table(&["effect", "size"], &rows);
}
