//! A law that nobody listed, as the page of a diagnosis shows it: text, name, curve, and what would do as well.

use crate::diagnose::{Curve, NamedEffect};

use super::HtmlPage;
use super::axis::three_digits;
use super::panel::{Panel, Series, figure_svg};
use super::svg::{BLUE, GREY};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 280.0;

/// Adds a section for each law of an answer.
pub(super) fn laws(page: &mut HtmlPage, effects: &[NamedEffect]) {
    for effect in effects.iter().filter(|e| e.hypothetical || !e.forms.is_empty()) {
        if effect.hypothetical {
            page.heading(&format!("The law at {}", effect.port));
            let name = effect.known_as.as_ref().map_or_else(String::new, |n| format!(" It reads as {n}."));
            let acts = if effect.acts == "scales" { "times" } else { "plus" };
            page.paragraph(&format!(
                "{} {acts} `{}`.{name} scene.toml holds it as a [[law]] table.",
                effect.port, effect.law
            ));
        }
        if let Some(curve) = &effect.curve {
            let caption =
                "The law over its variable, as far as the runs visited it; grey: 95 % of its numbers' uncertainty.";
            page.figure(&curve_svg(curve, effect), caption);
        }
        forms(page, effect);
    }
}

fn forms(page: &mut HtmlPage, effect: &NamedEffect) {
    if effect.forms.is_empty() {
        return;
    }
    page.paragraph(&format!("What explains these recordings as well as {} at {}:", effect.name, effect.port));
    let rows = effect.forms.iter().map(|form| {
        let name = form.known_as.clone().unwrap_or_default();
        vec![form.port.clone(), form.acts.clone(), form.law.clone(), name, three_digits(form.score_difference)]
    });
    page.table(&["port", "acts", "law", "known as", "chi² above, in units of what is left"], &rows.collect::<Vec<_>>());
}

/// The curve with its band.
fn curve_svg(curve: &Curve, effect: &NamedEffect) -> String {
    let line =
        |label: &str, colour, y: &[f64]| Series { label: label.to_owned(), colour, x: curve.x.clone(), y: y.to_vec() };
    let panel = Panel {
        title: vec![format!("{} {} {}", effect.port, effect.acts, effect.law)],
        x_label: curve.variable.clone(),
        y_label: if effect.acts == "scales" { "factor".to_owned() } else { "added, SI".to_owned() },
        behind: Vec::new(),
        series: vec![line("95 %", GREY, &curve.low), line("", GREY, &curve.high), line("law", BLUE, &curve.y)],
        bands: Vec::new(),
    };
    figure_svg(&[panel], WIDTH, HEIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Form;

    #[test]
    fn a_law_is_shown_with_its_name_and_what_would_do_as_well() {
        let effect = NamedEffect {
            name: "muscle_friction".to_owned(),
            port: "muscle.friction".to_owned(),
            acts: "scales".to_owned(),
            law: "1 + 0.4 * exp(-abs(speed_m_s/0.002))".to_owned(),
            known_as: Some("breakaway friction".to_owned()),
            forms: vec![Form { port: "muscle.pull".to_owned(), score_difference: 1.25, ..Form::default() }],
            curve: Some(Curve {
                variable: "speed_m_s".to_owned(),
                x: vec![0.0, 0.01],
                y: vec![1.4, 1.0],
                low: vec![1.3, 1.0],
                high: vec![1.5, 1.0],
            }),
            hypothetical: true,
            ..NamedEffect::default()
        };
        let mut page = HtmlPage::new("x");
        laws(&mut page, &[effect]);
        let text = page.finish();
        for shown in ["breakaway friction", "muscle.friction times", "speed_m_s", ">1.25<", "muscle.pull"] {
            assert!(text.contains(shown), "{shown} in {text}");
        }
        // What the catalogue names without rivals has no section.
        let mut page = HtmlPage::new("x");
        laws(&mut page, &[NamedEffect::default()]);
        assert!(!page.finish().contains("The law at"));
    }
}
