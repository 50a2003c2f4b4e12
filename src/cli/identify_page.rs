//! The page of an identification: loop, history, residual, parameters, warnings.

use smam::identify::loops::{Identification, LoopRun};
use smam::report::{HtmlPage, Line, MEASURED, Panel, Plot, Series, TimeSeries, VERMILION, quantity, to_place};

use super::identify::{Loops, unseen};

/// The whole page.
pub fn page(found: &[Identification], loops: &Loops) -> HtmlPage {
    let mut page = HtmlPage::new(&format!("Hysteresis models of {}", loops.name));
    if let Some(best) = best(found, loops) {
        page.verdict(best.form.name(), &verdict(best, found.len(), loops), false);
    }
    page.paragraph(
        "F is the mean squared error between model and measured elongation, mm². Each model starts every run at rest. \
         Noise: standard deviation of the output's white noise, from the output alone.",
    );
    page.table(
        &["model", "F (mm²)", "root (mm)", "F unseen (mm²)", "noise (mm)", "evaluations"],
        &summary(found, loops),
    );
    for identification in found {
        one(&mut page, identification, loops);
    }
    page
}

/// The model with the least error on runs that it has not seen; without such runs, on those it was fitted to.
fn best<'a>(found: &'a [Identification], loops: &Loops) -> Option<&'a Identification> {
    let error = |f: &Identification| unseen(f, loops).unwrap_or(f.mean_square_mm2);
    found.iter().min_by(|a, b| error(a).total_cmp(&error(b)))
}

/// What a reader takes along who reads no further.
fn verdict(best: &Identification, models: usize, loops: &Loops) -> String {
    let root_mm = |f: f64| quantity("", None, f.sqrt());
    let rank = if models > 1 { format!("fits best of {models} models") } else { "was fitted".to_owned() };
    let mut text = format!(
        "{rank}: F = {} mm², that is {} mm RMS",
        quantity("", None, best.mean_square_mm2),
        root_mm(best.mean_square_mm2)
    );
    if let Some(f) = unseen(best, loops) {
        text += &format!("; {} mm on runs that it has not seen", root_mm(f));
    }
    if let Some(noise_mm) = best.noise_mm {
        text += &format!("; noise {} mm", quantity("", None, noise_mm));
    }
    let alike: Vec<&str> =
        best.warnings.iter().filter_map(|w| Some(w.split_once(" cannot be told apart")?.0)).collect();
    match alike.as_slice() {
        [] => text + ". Every parameter can be told from the others.",
        pairs => format!("{text}. Cannot be told apart by this loop: {}.", pairs.join("; ")),
    }
}

fn summary(found: &[Identification], loops: &Loops) -> Vec<Vec<String>> {
    let or_dash = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.6}"));
    let row = |f: &Identification| {
        vec![
            format!("{}, {} free parameters", f.form.name(), f.free.len()),
            format!("{:.6}", f.mean_square_mm2),
            format!("{:.4}", f.mean_square_mm2.sqrt()),
            or_dash(unseen(f, loops)),
            or_dash(f.noise_mm),
            f.evaluations.to_string(),
        ]
    };
    found.iter().map(row).collect()
}

fn one(page: &mut HtmlPage, found: &Identification, loops: &Loops) {
    page.heading(found.form.name());
    page.table(&["parameter", "value", "95 % interval", "searched", "bounds because"], &parameters(found));
    found.warnings.iter().for_each(|w| {
        page.paragraph(&format!("Note: {w}."));
    });
    let runs = loops.fit.iter().map(|r| (r, "fitted")).chain(loops.holdout.iter().map(|r| (r, "not seen by the fit")));
    for (run, part) in runs {
        page.subheading(&format!("{}, {part}", run.name));
        figures(page, found, run);
    }
    page.paragraph(&how_certain(found));
    let header: Vec<&str> = std::iter::once("correlation").chain(found.free.iter().map(String::as_str)).collect();
    page.table(&header, &correlations(found));
}

/// The loop, and beside it the run over time with what is left.
fn figures(page: &mut HtmlPage, found: &Identification, run: &LoopRun) {
    let model = found.model.follow(&run.time_s, &run.input_mm);
    let over_input = |label: &str, colour, y: &[f64]| Series {
        label: label.to_owned(),
        colour,
        x: run.input_mm.clone(),
        y: y.to_vec(),
    };
    let hysteresis = Panel {
        x_label: "plunger (mm)".to_owned(),
        y_label: "elongation (mm)".to_owned(),
        behind: vec![over_input("measured", MEASURED, &run.output_mm)],
        series: vec![over_input(found.form.name(), VERMILION, &model)],
        ..Panel::default()
    };
    let line = |label: &str, colour, values: &[f64]| Line { label: label.to_owned(), colour, values: values.to_vec() };
    let history = TimeSeries {
        name: format!("{} {}", found.form.name(), run.name),
        run: run.name.clone(),
        y_label: "elongation (mm)".to_owned(),
        unit: "mm".to_owned(),
        time_s: run.time_s.clone(),
        lines: vec![line("measured", MEASURED, &run.output_mm), line(found.form.name(), VERMILION, &model)],
        noise_sd: found.noise_mm,
    };
    page.grid(|page| {
        page.figure(Plot::from(&hysteresis), "");
        page.figure(history, "");
    });
}

fn parameters(found: &Identification) -> Vec<Vec<String>> {
    let row = |p: &smam::identify::loops::Identified| {
        let searched = format!("{} to {}", quantity("", None, p.spec.min), quantity("", None, p.spec.max));
        let (interval, searched, why) = match (p.half_width, p.spec.fixed) {
            (Some(h), _) => (format!("± {}", to_place(h, h)), searched, p.spec.why),
            (None, fixed) => ("– (fixed)".to_owned(), "–".to_owned(), fixed.map_or("", |(_, why)| why)),
        };
        let value = to_place(p.value, p.half_width.unwrap_or(f64::NAN));
        vec![p.spec.name.clone(), value, interval, searched, why.to_owned()]
    };
    found.parameters.iter().map(row).collect()
}

fn how_certain(found: &Identification) -> String {
    let certainty = &found.certainty;
    let noise = if certainty.memory == 0 {
        "Residuals are white; intervals are those of least squares".to_owned()
    } else {
        format!(
            "Residuals are related (neighbours {:.3}, over {} samples); intervals use their own autocovariance, tapered to \
             zero there",
            certainty.colour, certainty.memory
        )
    };
    format!("{noise}. Condition number of JᵀJ, columns scaled: {:.2e}.", certainty.condition)
}

fn correlations(found: &Identification) -> Vec<Vec<String>> {
    let row = |(i, name): (usize, &String)| {
        let values = (0..found.free.len()).map(|j| format!("{:.2}", found.certainty.correlation[(i, j)]));
        std::iter::once(name.clone()).chain(values).collect()
    };
    found.free.iter().enumerate().map(row).collect()
}
