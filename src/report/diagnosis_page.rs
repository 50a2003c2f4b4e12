//! The page of a diagnosis: verdict, curves, where, what, how sure, what next, numbers.

use crate::diagnose::{CaseRun, DiscrepancyTerm, Estimate, NamedEffect, Outcome};
use crate::recording::parse_column;

use super::HtmlPage;
use super::axis::three_digits;
use super::channel_figure::{ComparedChannel, ComparedRun, choices};
use super::colour::{BLUE, VERMILION};
use super::diagnosis_law::laws;
use super::diagnosis_next::next;
use super::diagnosis_sure::certainty;
use super::diagnosis_where::{location, run_name};
use super::diagnosis_words::{capital, estimate, is_good, last_name, smallest_words};
use super::quantity::with;
use super::symbols::greek;

/// One self-contained page, readable by a person who was not there.
pub fn diagnosis_page(outcome: &Outcome) -> HtmlPage {
    let d = &outcome.diagnosis;
    let names: Vec<&str> = d.recordings.iter().map(|folder| last_name(folder)).collect();
    let mut page = HtmlPage::new(&format!("Diagnosis of {}", names.join(", ")));
    page.small(&format!("recordings: {}; scene: {}", d.recordings.join(", "), d.scene));
    let verdict = format!("{}.", capital(&d.verdict.to_string().replace('_', " ")));
    page.verdict(&verdict, &d.summary, is_good(d.verdict));
    curves(&mut page, outcome);
    location(&mut page, outcome);
    what(&mut page, outcome);
    if !d.fit.channels.is_empty() {
        certainty(&mut page, outcome);
    }
    next(&mut page, outcome);
    if !d.warnings.is_empty() {
        page.heading("Warnings");
        d.warnings.iter().for_each(|w| {
            page.paragraph(w);
        });
    }
    numbers(&mut page, outcome);
    page
}

/// Every run and channel as it was measured, as the calibrated scene has it, and with what was found.
fn curves(page: &mut HtmlPage, outcome: &Outcome) {
    let Some([before, after]) = &outcome.residuals else { return };
    page.heading("Measured, calibrated, corrected");
    let with_after = !outcome.diagnosis.effects.is_empty();
    let runs = outcome.case.runs.iter().enumerate();
    let compared: Vec<ComparedRun> =
        runs.map(|(i, run)| compared(outcome, run, &before[i], with_after.then_some(&after[i]))).collect();
    page.chooser(&choices(&compared), furthest_off(outcome, before));
    if outcome.diagnosis.fit.full_scene.differs() {
        page.small(
            "These curves and their errors are those of the reduced-order model, which differs from the full scene here; the errors of \
             held-out runs further down are those of the full scene.",
        );
    }
}

/// Of the figures of all runs and channels, the one in which the calibrated scene is furthest off for its noise.
fn furthest_off(outcome: &Outcome, residuals: &[Vec<Vec<f64>>]) -> usize {
    let over_noise = |(channel, residuals): (usize, &Vec<f64>)| {
        let finite: Vec<f64> = residuals.iter().copied().filter(|r| r.is_finite()).collect();
        let mean = finite.iter().map(|r| r * r).sum::<f64>() / finite.len() as f64;
        (!finite.is_empty()).then(|| mean / outcome.noise[channel].sd.powi(2))
    };
    let all = residuals.iter().flat_map(|run| run.iter().enumerate().filter_map(over_noise));
    all.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
}

fn compared(outcome: &Outcome, run: &CaseRun, before: &[Vec<f64>], after: Option<&Vec<Vec<f64>>>) -> ComparedRun {
    let is_there = |c: &usize| before[*c].iter().any(|r| r.is_finite());
    let simulated = |c: usize, residuals: &[Vec<f64>]| {
        run.measured[c].iter().zip(&residuals[c]).map(|(measured, residual)| measured - residual).collect::<Vec<f64>>()
    };
    let channel = |c: usize| ComparedChannel {
        column: outcome.case.channels[c].column.clone(),
        measured: run.measured[c].clone(),
        simulated: std::iter::once(("calibrated", VERMILION, simulated(c, before)))
            .chain(after.map(|after| ("corrected", BLUE, simulated(c, after))))
            .collect(),
        noise_sd: Some(outcome.noise[c].sd),
    };
    ComparedRun {
        name: run_name(run),
        time_s: run.times_s().to_vec(),
        channels: (0..outcome.case.channels.len()).filter(is_there).map(channel).collect(),
    }
}

fn what(page: &mut HtmlPage, outcome: &Outcome) {
    let d = &outcome.diagnosis;
    if d.effects.is_empty() && d.withheld.is_empty() {
        return;
    }
    page.heading("What");
    parameters(page, &d.effects);
    laws(page, &d.effects);
    if !d.withheld.is_empty() {
        page.paragraph("Not put into `scene.toml`, because it does not hold on other runs:");
        parameters(page, &d.withheld);
        laws(page, &d.withheld);
    }
    if !d.discrepancy.is_empty() {
        page.paragraph(
            "What that leaves is described by further effects in `scene.toml`. They predict better; that they are there \
             is not claimed:",
        );
        let rows: Vec<Vec<String>> = d.discrepancy.iter().flat_map(term_rows).collect();
        page.table(&["effect", "element", "parameter", "value", "95 % interval", "law"], &rows);
    }
}

fn parameters(page: &mut HtmlPage, effects: &[NamedEffect]) {
    let rows: Vec<Vec<String>> = effects.iter().flat_map(effect_rows).collect();
    if !rows.is_empty() {
        page.table(&["effect", "element", "probability", "parameter", "value", "95 % interval", "law"], &rows);
    }
}

fn effect_rows(e: &NamedEffect) -> Vec<Vec<String>> {
    let element = e.channel.as_ref().map_or_else(|| e.element.clone(), |c| format!("{} {c}", e.element));
    let row = |(i, (key, number)): (usize, (&String, &Estimate))| {
        let head = match i {
            0 => vec![e.name.clone(), element.clone(), format!("{:.3}", e.probability)],
            _ => vec![String::new(); 3],
        };
        // A law outside the catalogue is printed below.
        let law = if i == 0 && !e.hypothetical { greek(&e.law) } else { String::new() };
        [head, vec![key.clone()], estimate(key, e.channel.as_deref(), number), vec![law]].concat()
    };
    e.parameters.iter().enumerate().map(row).collect()
}

fn term_rows(term: &DiscrepancyTerm) -> Vec<Vec<String>> {
    let channel = term.channel.as_deref();
    let element = channel.map_or_else(|| term.element.clone(), |c| format!("{} {c}", term.element));
    let row = |(i, (key, number)): (usize, (&String, &Estimate))| {
        let [name, place, law] = match i {
            0 => [term.name.clone(), element.clone(), greek(&term.law)],
            _ => <[String; 3]>::default(),
        };
        [vec![name, place, key.clone()], estimate(key, channel, number), vec![law]].concat()
    };
    term.parameters.iter().enumerate().map(row).collect()
}

/// What nobody reads who does not look for it.
fn numbers(page: &mut HtmlPage, outcome: &Outcome) {
    let d = &outcome.diagnosis;
    page.heading("Numbers");
    page.folded("Calibrated parameters, refitted together with what was found", |page| {
        let rows: Vec<Vec<String>> =
            d.calibration.iter().map(|(k, e)| [vec![k.clone()], estimate(k, None, e)].concat()).collect();
        page.table(&["parameter", "value", "95 % interval"], &rows);
    });
    page.folded("Errors of the held-out runs", |page| {
        let header = ["channel", "RMSE calibrated", "RMSE corrected", "noise"];
        let row = |(channel, p): (&String, &crate::diagnose::ChannelProof)| {
            let symbol = parse_column(channel).map_or("", |name| name.unit.symbol);
            let errors = [p.rmse_baseline, p.rmse_corrected, p.noise_sd].map(|v| with(&three_digits(v), symbol));
            [vec![channel.clone()], errors.to_vec()].concat()
        };
        page.table(&header, &d.fit.channels.iter().map(row).collect::<Vec<_>>());
    });
    page.folded("Times at which the calibrated scene is off by more than noise", |page| {
        let windows = d.location.time_windows_s.iter();
        let rows: Vec<Vec<String>> =
            windows.map(|(file, from, to)| vec![file.clone(), format!("{from:.1}"), format!("{to:.1}")]).collect();
        page.table(&["run", "from (s)", "to (s)"], &rows);
    });
    page.folded("Detection limits: the smallest size of each effect that these recordings would have shown", |page| {
        let smallest = d.detection.smallest_detectable.iter();
        let rows: Vec<Vec<String>> = smallest.map(|(title, size)| smallest_words(title, *size)).collect();
        page.table(&["effect", "parameter", "size"], &rows);
    });
}
