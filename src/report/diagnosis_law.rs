//! A law outside the catalogue, as the page of a diagnosis shows it: symbols, name, curve, and what would do as well.

use crate::diagnose::{Curve, Freehand, NamedEffect};
use crate::recording::axis_label;

use super::axis::three_digits;
use super::colour::{BLUE, ORANGE};
use super::formula::Formula;
use super::kit::{Area, HtmlPage, Plot};
use super::panel::{Panel, Series};

/// Adds a part for each law of an answer.
pub(super) fn laws(page: &mut HtmlPage, effects: &[NamedEffect]) {
    for effect in effects.iter().filter(|e| e.hypothetical || !e.forms.is_empty()) {
        if effect.hypothetical {
            law(page, effect);
        }
        if let Some(curve) = &effect.curve {
            let caption = "The law over its variable, as far as the runs visited it, in SI units; orange: what the recordings say \
                           of it whatever its shape.";
            page.figure(plot(curve, effect), caption);
        }
        forms(page, effect);
    }
}

fn law(page: &mut HtmlPage, effect: &NamedEffect) {
    page.subheading(&format!("The law at {}", effect.port));
    let formula = Formula::of(&effect.law);
    let [own, memory] = <[&str; 2]>::from(effect.law_and_memory()).map(|part| Formula::of(part).text);
    page.law(&match effect.acts.as_str() {
        "scales" => format!("{} × ({own}){memory}", effect.port),
        _ => format!("{} + {own}{memory}", effect.port),
    });
    let name = effect.known_as.as_ref().map_or_else(String::new, |n| format!(" It reads as {n}."));
    let letters = if formula.letters.is_empty() { String::new() } else { format!("; {}", formula.legend()) };
    page.paragraph(&format!(
        "SI units{letters}.{name} In `scene.toml` it is a `[[law]]` table that {} `{}`.",
        effect.acts, effect.law
    ));
}

fn forms(page: &mut HtmlPage, effect: &NamedEffect) {
    if effect.forms.is_empty() {
        return;
    }
    page.paragraph(&format!("What explains these recordings as well as {} at {}:", effect.name, effect.port));
    let rows = effect.forms.iter().map(|form| {
        let name = form.known_as.clone().unwrap_or_default();
        let law = Formula::of(&form.law).text;
        vec![form.port.clone(), form.acts.clone(), law, name, three_digits(form.score_difference)]
    });
    page.table(&["port", "acts", "law", "known as", "chi² above, in units of what is left"], &rows.collect::<Vec<_>>());
}

/// What the recordings say of the law whatever its shape, and both ends of its interval.
fn freehand(freehand: &Freehand) -> Vec<Series> {
    let line = |label: &str, y: &[f64]| Series {
        label: label.to_owned(),
        colour: ORANGE,
        x: freehand.x.clone(),
        y: y.to_vec(),
    };
    let ends = [("95 % interval of that", &freehand.low), ("", &freehand.high)];
    let ends = ends.map(|(label, y)| line(label, y));
    [vec![line("whatever its shape", &freehand.y)], ends.to_vec()].concat()
}

/// The curve with its band.
fn plot(curve: &Curve, effect: &NamedEffect) -> Plot {
    let law = Series { label: "law".to_owned(), colour: BLUE, x: curve.x.clone(), y: curve.y.clone() };
    let panel = Panel {
        title: vec![format!("{} {}", effect.port, effect.acts)],
        x_label: axis_label(&curve.variable),
        y_label: if effect.acts == "scales" { "factor".to_owned() } else { "added (SI)".to_owned() },
        series: [vec![law], curve.freehand.as_ref().map_or_else(Vec::new, freehand)].concat(),
        ..Panel::default()
    };
    let band = Area {
        label: "95 % interval".to_owned(),
        colour: BLUE,
        x: curve.x.clone(),
        low: curve.low.clone(),
        high: curve.high.clone(),
    };
    Plot::from(&panel).with_area(band)
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
                freehand: Some(Freehand {
                    x: vec![0.0, 0.01],
                    y: vec![1.42, 1.01],
                    low: vec![1.37, 0.92],
                    high: vec![1.47, 1.1],
                }),
            }),
            hypothetical: true,
            ..NamedEffect::default()
        };
        let mut page = HtmlPage::new("x");
        laws(&mut page, &[effect]);
        let text = page.finish();
        let printed = "muscle.friction × (1 + 0.4\u{a0}exp(-|v/0.002|))";
        for shown in [
            "breakaway friction",
            printed,
            "v: <code>speed_m_s",
            ">1.25<",
            "muscle.pull",
            r#""low":[1.3,1]"#,
            "1.42",
            "0.92",
        ] {
            assert!(text.contains(shown), "{shown} in {text}");
        }
        // What the catalogue names without rivals has no section.
        let mut page = HtmlPage::new("x");
        laws(&mut page, &[NamedEffect::default()]);
        assert!(!page.finish().contains("The law at"));
    }
}
