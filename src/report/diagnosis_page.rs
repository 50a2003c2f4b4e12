//! The page of a diagnosis: verdict, where, what, how much better, what next.

use crate::diagnose::{NamedEffect, Outcome};
use crate::recording::parse_column;

use super::HtmlPage;
use super::axis::three_digits;
use super::compare_figure::{ComparedChannel, ComparedRun, compare_svg};
use super::diagnosis_bars::bars_svg;
use super::diagnosis_law::laws;
use super::diagnosis_map::{state_map_svg, time_lines_svg};
use super::diagnosis_words::{estimate, is_good, last_name, next_words, region_words, sensor_words, smallest_words};
use super::quantity::with;
use super::symbols::greek;

/// One self-contained page, readable by a person who was not there: what it comes to and what to do stand first.
pub fn diagnosis_page(outcome: &Outcome) -> String {
    let d = &outcome.diagnosis;
    let names: Vec<&str> = d.recordings.iter().map(|folder| last_name(folder)).collect();
    let mut page = HtmlPage::new(&format!("Diagnosis of {}", names.join(", ")));
    page.small(&format!("recordings: {}; scene: {}", d.recordings.join(", "), d.scene));
    page.verdict(&d.verdict.to_string(), &d.summary, is_good(d.verdict));
    next(&mut page, outcome);
    location(&mut page, outcome);
    what(&mut page, outcome);
    better(&mut page, outcome);
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
    let by_laws = outcome.diagnosis.effects.iter().any(|e| e.hypothetical);
    let rows: Vec<Vec<String>> = location.ranked.iter().map(|(e, p)| vec![e.clone(), format!("{p:.3}")]).collect();
    page.table(
        &["element", if by_laws { "share of the misfit that a law there explains" } else { "probability" }],
        &rows,
    );
    if !location.state_region.is_empty() {
        page.paragraph(&format!("The calibrated scene is furthest off at {}.", region_words(&location.state_region)));
    }
    let windows: Vec<String> =
        location.time_windows_s.iter().take(12).map(|(f, a, b)| format!("{f} {a:.1} to {b:.1} s")).collect();
    if let Some([before, after]) = &outcome.residuals {
        page.figure(&time_lines_svg(outcome), "Marked: where the calibrated scene is off by more than noise.");
        let caption = "Calibrated scene: how far off it is (RMS of the residual over the noise), by level and motion of \
                       the first input. 1.0: noise only. Empty: nothing was recorded there.";
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
        page.table(&["effect", "element", "probability", "number", "value", "95 % interval", "law"], &rows);
    }
    laws(page, &d.effects);
    from_run_to_run(page, &d.effects);
    if !outcome.rivals.is_empty() {
        let best = outcome.corrected.as_ref().map_or(0.0, |f| f.cost);
        let rows: Vec<Vec<String>> =
            outcome.rivals.iter().map(|(title, cost)| vec![title.clone(), format!("{:.0}", cost - best)]).collect();
        page.heading("Rivals, refitted jointly, and why they lost");
        page.paragraph(
            "chi² is the squared misfit in units of the noise, summed over all samples: with every 2 above the answer a \
             rival is 2.7 times less likely.",
        );
        page.table(&["instead", "chi² above the answer"], &rows);
    }
    page.heading("Calibration with it");
    let rows: Vec<Vec<String>> =
        d.calibration.iter().map(|(k, e)| [vec![k.clone()], estimate(k, None, e)].concat()).collect();
    page.table(&["number", "value", "95 % interval"], &rows);
}

/// The size of each effect as every run by itself would have it.
fn from_run_to_run(page: &mut HtmlPage, effects: &[NamedEffect]) {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for e in effects {
        let key = e.size_key();
        let sizes = e.size_by_run.iter().map(|(file, size)| (file, estimate(key, e.channel.as_deref(), size)));
        rows.extend(sizes.map(|(file, size)| [vec![e.name.clone(), file.clone(), key.to_owned()], size].concat()));
    }
    if !rows.is_empty() {
        page.heading("From run to run");
        page.paragraph("The size of each effect as every run by itself would have it: one rig should give one number.");
        page.table(&["effect", "run", "number", "value", "95 % interval"], &rows);
    }
}

fn effect_rows(e: &NamedEffect) -> Vec<Vec<String>> {
    let element = e.channel.as_ref().map_or_else(|| e.element.clone(), |c| format!("{} {c}", e.element));
    let row = |(i, (key, number)): (usize, (&String, &crate::diagnose::Estimate))| {
        let head = match i {
            0 => vec![e.name.clone(), element.clone(), format!("{:.3}", e.probability)],
            _ => vec![String::new(); 3],
        };
        let law = if i == 0 { greek(&e.law) } else { String::new() };
        [head, vec![key.clone()], estimate(key, e.channel.as_deref(), number), vec![law]].concat()
    };
    e.parameters.iter().enumerate().map(row).collect()
}

fn better(page: &mut HtmlPage, outcome: &Outcome) {
    let d = &outcome.diagnosis;
    page.heading("How much better");
    let rows: Vec<Vec<String>> = d
        .fit
        .channels
        .iter()
        .map(|(channel, p)| {
            let symbol = parse_column(channel).map_or("", |name| name.unit.symbol);
            let numbers = [p.rmse_baseline, p.rmse_corrected, p.noise_sd].map(|v| with(&three_digits(v), symbol));
            let ratios = [p.rmse_baseline, p.rmse_corrected].map(|rmse| format!("{:.2}", rmse / p.noise_sd));
            [vec![channel.clone()], numbers.to_vec(), ratios.to_vec()].concat()
        })
        .collect();
    let header =
        ["sealed runs", "RMSE calibrated", "RMSE corrected", "noise", "calibrated / noise", "corrected / noise"];
    page.table(&header, &rows);
    page.figure(&bars_svg(outcome), "Runs that had no part in choosing or fitting.");
    full_scene(page, outcome);
    placebos(page, outcome);
    if !d.effects.is_empty() {
        page.paragraph(&format!(
            "{:.1} % of the gap between the calibrated scene and the noise is closed on sealed runs ({}), 95 % interval \
             {:.1} to {:.1} %.",
            100.0 * d.fit.gap_closed.min(1.0),
            d.fit.holdout.join(", "),
            100.0 * d.fit.gain_ci95[0].min(1.0),
            100.0 * d.fit.gain_ci95[1].min(1.0)
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
        placebos.iter().map(|(title, gap)| vec![title.clone(), format!("{:.1} %", 100.0 * gap.min(1.0))]).collect();
    page.paragraph("What other effects would have closed of the gap on the sealed runs:");
    page.table(&["instead", "gap closed"], &rows);
}

fn next(page: &mut HtmlPage, outcome: &Outcome) {
    let next = &outcome.diagnosis.next_experiment;
    page.heading("What to do next");
    page.paragraph(&next_words(&outcome.diagnosis));
    if let Some(file) = &next.file {
        page.paragraph(&format!(
            "Play `{file}` on the rig; `smam run scene.toml --input {file}` shows what the corrected scene expects."
        ));
    }
    if let Some(words) = sensor_words(next) {
        page.paragraph(&words);
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
            .filter(|(c, _)| residuals[*c].iter().any(|r| r.is_finite()))
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
    page.paragraph("The smallest size of each effect that these recordings would have shown.");
    let rows: Vec<Vec<String>> = smallest.iter().map(|(title, size)| smallest_words(title, *size)).collect();
    page.table(&["effect", "number", "size"], &rows);
}
