//! How sure an answer is, as a page of a diagnosis shows it: rivals, run by run, held-out runs.

use crate::diagnose::{ChannelProof, Estimate, NamedEffect, Outcome};

use super::colour::{BLUE, VERMILION};
use super::diagnosis_words::estimate;
use super::kit::{Bar, BarPanel, HtmlPage};

/// Adds the section.
pub(super) fn certainty(page: &mut HtmlPage, outcome: &Outcome) {
    page.heading("How sure");
    rivals(page, outcome);
    by_run(page, &outcome.diagnosis.effects);
    held_out(page, outcome);
    placebos(page, outcome);
    full_scene(page, outcome);
}

fn rivals(page: &mut HtmlPage, outcome: &Outcome) {
    if outcome.rivals.is_empty() {
        return;
    }
    let best = outcome.corrected.as_ref().map_or(0.0, |f| f.cost);
    let rows: Vec<Vec<String>> =
        outcome.rivals.iter().map(|(title, cost)| vec![title.clone(), format!("{:.0}", cost - best)]).collect();
    page.subheading("Rivals, refitted jointly, and why they lost");
    page.paragraph(
        "chi² is the squared misfit in units of the noise, summed over all samples: with every 2 above the answer a \
         rival is 2.7 times less likely.",
    );
    page.table(&["instead", "chi² above the answer"], &rows);
}

/// The size of each effect as every run by itself would have it.
fn by_run(page: &mut HtmlPage, effects: &[NamedEffect]) {
    let with_runs: Vec<&NamedEffect> = effects.iter().filter(|e| !e.size_by_run.is_empty()).collect();
    if with_runs.is_empty() {
        return;
    }
    page.subheading("Run by run");
    page.paragraph(
        "The size of each effect as every run by itself would have it: one rig should give one value. Where \"mean\" stands for \"all\", it differs \
         from run to run, and each run has its own.",
    );
    let rows: Vec<Vec<String>> = with_runs.iter().flat_map(|e| sizes_of(e)).collect();
    page.table(&["effect", "run", "parameter", "value", "95 % interval"], &rows);
    with_runs.iter().filter(|e| !e.differs_by_run).filter_map(|e| missed(e)).for_each(|words| {
        page.paragraph(&words);
    });
}

/// The size that all runs share, then that of each.
fn sizes_of(e: &NamedEffect) -> Vec<Vec<String>> {
    let key = e.size_key();
    let row = |run: &str, size: &Estimate| {
        [vec![e.name.clone(), run.to_owned(), key.to_owned()], estimate(key, e.channel.as_deref(), size)].concat()
    };
    let of = if e.differs_by_run { "mean" } else { "all" };
    let shared = e.parameters.get(key).map(|size| row(of, size));
    shared.into_iter().chain(e.size_by_run.iter().map(|(file, size)| row(file, size))).collect()
}

/// The runs whose interval leaves out the size that all share, in words.
fn missed(e: &NamedEffect) -> Option<String> {
    let shared = e.parameters.get(e.size_key())?.value;
    let leaves_out = |size: &Estimate| !(size.ci95[0]..=size.ci95[1]).contains(&shared);
    let runs: Vec<&str> = e.size_by_run.iter().filter(|(_, s)| leaves_out(s)).map(|(file, _)| file.as_str()).collect();
    (!runs.is_empty()).then(|| {
        format!(
            "{}: {} of {} runs have an interval without the value of all ({}). Chance, a calibration that is not quite that run's, a law \
             that is an idealisation, or a rig that changed: it is worth a look where the values are far apart.",
            e.name,
            runs.len(),
            e.size_by_run.len(),
            runs.join(", ")
        )
    })
}

/// Error over noise by channel, before and after.
fn held_out(page: &mut HtmlPage, outcome: &Outcome) {
    let fit = &outcome.diagnosis.fit;
    // Where nothing was found the two are one.
    let models = if outcome.diagnosis.effects.is_empty() { 1 } else { 2 };
    let ratios = |p: &ChannelProof| [p.rmse_baseline, p.rmse_corrected].map(|rmse| Bar::plain(rmse / p.noise_sd));
    let legend = [("calibrated".to_owned(), VERMILION), ("corrected".to_owned(), BLUE)];
    let panel = BarPanel {
        title: format!("Held-out runs: {}", fit.holdout.join(", ")),
        label: "error over the noise (logarithmic)".to_owned(),
        legend: legend[..models].to_vec(),
        groups: fit.channels.iter().map(|(column, p)| (column.clone(), ratios(p)[..models].to_vec())).collect(),
        is_logarithmic: true,
    };
    let part = match outcome.diagnosis.effects.iter().any(|e| e.differs_by_run) {
        true => {
            "These runs had no part in choosing; of what was fitted they decided their own numbers of what differs from run to run. 1: noise only."
        }
        false => "These runs had no part in choosing or fitting. 1: noise only.",
    };
    page.bars(&panel, part);
    if !outcome.diagnosis.effects.is_empty() {
        page.paragraph(&format!(
            "On them {:.1} % of the gap between the calibrated scene and the noise is closed, 95 % interval {:.1} to {:.1} %.",
            100.0 * fit.gap_closed.min(1.0),
            100.0 * fit.gain_ci95[0].min(1.0),
            100.0 * fit.gain_ci95[1].min(1.0)
        ));
    }
}

fn placebos(page: &mut HtmlPage, outcome: &Outcome) {
    let placebos = &outcome.diagnosis.fit.placebo_gap_closed;
    if placebos.is_empty() {
        return;
    }
    let rows: Vec<Vec<String>> =
        placebos.iter().map(|(title, gap)| vec![title.clone(), format!("{:.1} %", 100.0 * gap.min(1.0))]).collect();
    page.paragraph("What other effects would have closed of the gap on the held-out runs:");
    page.table(&["instead", "gap closed"], &rows);
}

/// How near the reduced-order model, on which all this rests, is to the full scene.
fn full_scene(page: &mut HtmlPage, outcome: &Outcome) {
    let full = &outcome.diagnosis.fit.full_scene;
    let each: Vec<String> =
        full.rms_difference_over_noise.iter().map(|(column, d)| format!("{column} {d:.3}")).collect();
    if each.is_empty() {
        return;
    }
    let consequence = match full.agrees {
        true => "They agree",
        false => "They do not agree, and the figures of the held-out runs are those of the full scene",
    };
    page.paragraph(&format!(
        "The reduced-order model against the full scene with the values found, in units of the noise: {}. {consequence}.",
        each.join(", ")
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_without_the_value_of_all_are_named() {
        let size = |value: f64| Estimate { value, ci95: [0.9 * value, 1.1 * value] };
        let runs = [("slow.csv", 1.02e-17), ("fast.csv", 1.4e-17)];
        let mut leak = NamedEffect {
            name: "leak".to_owned(),
            parameters: [("conductance_m3_s_pa".to_owned(), size(1e-17))].into(),
            size_by_run: runs.map(|(run, value)| (run.to_owned(), size(value))).into(),
            ..NamedEffect::default()
        };
        let words = missed(&leak).expect("one is off");
        assert!(words.starts_with("leak: 1 of 2 runs have an interval without the value of all (fast.csv)"), "{words}");
        let rows = sizes_of(&leak);
        assert_eq!(rows.iter().map(|row| row[1].as_str()).collect::<Vec<_>>(), ["all", "fast.csv", "slow.csv"]);
        leak.size_by_run.remove("fast.csv");
        assert_eq!(missed(&leak), None);
    }
}
