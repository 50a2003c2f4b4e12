//! The picture of `smam effects NAME`: what an effect does to each scene that can have it.

use svg::node::Node as _;
use svg::node::element::Group;

use super::axis::three_digits;
use super::colour::{BLUE, ORANGE, SILVER};
use super::panel::{Panel, Series};
use super::panel_svg::draw_legend;
use super::quantity::with;
use super::svg::{Rect, cut_to, document, text};
use crate::recording::{axis_label, parse_column};

const CELL_WIDTH: f64 = 450.0;
/// Between the x label of a row and the title of the next.
const GAP: f64 = 14.0;
const HEADER_HEIGHT: f64 = 110.0;
const EDGE: f64 = 10.0;

/// What the stock scene does, behind the coloured lines.
const STOCK: &str = SILVER;
/// The effect at its typical size and at twice that.
const COLOURS: [&str; 2] = [BLUE, ORANGE];

/// One scene without and with an effect; values in the columns' own units.
#[derive(Clone, Debug, PartialEq)]
pub struct AffectedScene {
    /// Its name, and where the effect sits, in the title.
    pub name: String,
    /// What differs from the numbers in the picture's header; may be empty.
    pub remark: String,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Column of the input and its samples.
    pub input: (String, Vec<f64>),
    /// Column of the output and its samples without the effect.
    pub output: (String, Vec<f64>),
    /// The output with the effect: as many as `sizes` of [`effect_svg`].
    pub with: Vec<Vec<f64>>,
    /// A pressure, where fluid drives the scene: column, samples without the effect, samples with it.
    pub pressure: Option<(String, Vec<f64>, Vec<Vec<f64>>)>,
}

/// Draws the scenes as columns: output over time, output over input, pressure over output, and what the effect changes
/// over time.
///
/// `title` names the effect, `law` (its formula, then its symbols) is written below it, `sizes` says of each coloured
/// line with which numbers.
pub fn effect_svg(title: &str, law: [&str; 2], sizes: &[String], scenes: &[AffectedScene]) -> String {
    let width = 2.0 * EDGE + CELL_WIDTH * scenes.len().max(2) as f64;
    let cell_width = (width - 2.0 * EDGE) / scenes.len().max(1) as f64;
    let mut svg = Group::new();
    draw_header(&mut svg, width, title, law, sizes);
    let mut y = HEADER_HEIGHT;
    // What changes is what there is to see: its row is the tall one. A scene may have nothing to show in a row.
    let rows: [fn(&AffectedScene) -> Option<Panel>; 4] = [over_time, change, over_input, pressure_over_output];
    for (draw, height) in rows.into_iter().zip([205.0, 290.0, 190.0, 190.0]) {
        let panels: Vec<Option<Panel>> = scenes.iter().map(draw).collect();
        for (column, panel) in panels.iter().enumerate() {
            let area = Rect { x: EDGE + cell_width * column as f64, y, width: cell_width, height };
            panel.iter().for_each(|panel| panel.draw(&mut svg, area));
        }
        if panels.iter().any(Option::is_some) {
            y += height + GAP;
        }
    }
    document(width, y + EDGE, svg)
}

fn draw_header(svg: &mut Group, width: f64, title: &str, law: [&str; 2], sizes: &[String]) {
    let left = EDGE + 12.0;
    let room = width - 2.0 * left;
    for (line, y, size) in [(title, 26.0, 16.0), (law[0], 48.0, 11.5), (law[1], 67.0, 11.5)] {
        svg.append(text((left, y), "start", size, &cut_to(line, size, room)));
    }
    let coloured = sizes.iter().map(String::as_str).zip(COLOURS).map(|(size, colour)| (size, colour, 1.0));
    let entries: Vec<_> = std::iter::once(("stock scene, without it", STOCK, 1.0)).chain(coloured).collect();
    draw_legend(svg, (left, 92.0), f64::INFINITY, &entries);
}

fn over_time(scene: &AffectedScene) -> Option<Panel> {
    Some(Panel {
        title: [&scene.name, &scene.remark].into_iter().filter(|line| !line.is_empty()).cloned().collect(),
        x_label: "time (s)".to_owned(),
        ..output_over(&scene.time_s, scene)
    })
}

/// Nothing where the input is time itself, as on a scene that nothing drives.
fn over_input(scene: &AffectedScene) -> Option<Panel> {
    (scene.input.0 != "time_s")
        .then(|| Panel { x_label: axis_label(&scene.input.0), ..output_over(&scene.input.1, scene) })
}

/// Lost fluid moves along the stock curve or nearly so; a force more leaves it.
fn pressure_over_output(scene: &AffectedScene) -> Option<Panel> {
    let (column, stock, with) = scene.pressure.as_ref()?;
    let coloured = scene.with.iter().zip(with).zip(COLOURS).map(|((x, y), colour)| line(x, y, colour));
    Some(Panel {
        x_label: axis_label(&scene.output.0),
        y_label: axis_label(column),
        behind: vec![line(&scene.output.1, stock, STOCK)],
        series: coloured.rev().collect(),
        ..Panel::default()
    })
}

/// With the effect minus without it, and the greatest change in words.
fn change(scene: &AffectedScene) -> Option<Panel> {
    let changes: Vec<Vec<f64>> =
        scene.with.iter().map(|with| with.iter().zip(&scene.output.1).map(|(a, b)| a - b).collect()).collect();
    let symbol = parse_column(&scene.output.0).map_or("", |name| name.unit.symbol);
    let series = changes.iter().zip(COLOURS).map(|(change, colour)| line(&scene.time_s, change, colour));
    Some(Panel {
        title: vec![greatest(&changes, &scene.output.1, symbol)],
        x_label: "time (s)".to_owned(),
        y_label: format!("change ({symbol})"),
        // The larger one first: the smaller must not vanish behind it.
        series: series.rev().collect(),
        ..Panel::default()
    })
}

/// `up to 2.31 and 4.50 mm (8.6 and 16.7 % of range)`.
fn greatest(changes: &[Vec<f64>], stock: &[f64], symbol: &str) -> String {
    let (low, high) = stock.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let most: Vec<f64> = changes.iter().map(|change| change.iter().fold(0.0_f64, |m, c| m.max(c.abs()))).collect();
    let list = |say: &dyn Fn(f64) -> String| most.iter().map(|m| say(*m)).collect::<Vec<_>>().join(" and ");
    // A stock output that stays where it is has no range to compare with.
    let share = match high > low {
        true => format!(" ({} % of range)", list(&|m| format!("{:.1}", 100.0 * m / (high - low)))),
        false => String::new(),
    };
    format!("up to {}{share}", with(&list(&three_digits), symbol))
}

/// The stock output broad and grey; before it the coloured ones, the larger first.
fn output_over(x: &[f64], scene: &AffectedScene) -> Panel {
    let coloured = scene.with.iter().zip(COLOURS).map(|(y, colour)| line(x, y, colour));
    Panel {
        y_label: axis_label(&scene.output.0),
        behind: vec![line(x, &scene.output.1, STOCK)],
        series: coloured.rev().collect(),
        ..Panel::default()
    }
}

fn line(x: &[f64], y: &[f64], colour: &'static str) -> Series {
    Series { label: String::new(), colour, x: x.to_vec(), y: y.to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(name: &str) -> AffectedScene {
        let time_s: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
        let stock: Vec<f64> = time_s.iter().map(|t| 10.0 * t.sin()).collect();
        let with = [0.5, 1.0].map(|more| stock.iter().map(|v| v + more).collect()).to_vec();
        AffectedScene {
            name: name.to_owned(),
            remark: String::new(),
            input: ("plunger_mm".to_owned(), time_s.clone()),
            output: ("elongation_mm".to_owned(), stock),
            pressure: None,
            with,
            time_s,
        }
    }

    #[test]
    fn every_scene_has_its_three_panels_with_units_and_the_change_in_words() {
        let sizes = ["1e-16 SI".to_owned(), "2e-16 SI".to_owned()];
        let svg = effect_svg(
            "leak",
            ["Q = G p", "G = conductance"],
            &sizes,
            &[scene("muscle_bench"), scene("antagonistic_pulley")],
        );
        assert_eq!(svg.matches("<polyline").count(), 2 * (3 + 3 + 2));
        for text in ["muscle_bench", "elongation (mm)", "plunger (mm)", "time (s)", "1e-16 SI", "Q = G p"] {
            assert!(svg.lines().any(|line| line == text), "{text}");
        }
        assert!(svg.contains("\nup to 0.500 and 1.00 mm (2.5 and 5.0 % of range)\n"), "{svg}");
    }

    #[test]
    fn a_pressure_has_a_row_of_its_own_where_there_is_one() {
        let mut bench = scene("muscle_bench");
        let stock = bench.output.1.clone();
        bench.pressure = Some(("pressure_kpa".to_owned(), stock.clone(), vec![stock.clone(), stock]));
        let sizes = ["one".to_owned(), "two".to_owned()];
        let height =
            |svg: &str| svg.split_once("height=\"").and_then(|(_, h)| h.split('"').next()?.parse::<f64>().ok());
        let [with, without] = [&[bench, scene("muscle_free")][..], &[scene("muscle_bench"), scene("muscle_free")][..]]
            .map(|scenes| effect_svg("leak", ["", ""], &sizes, scenes));
        assert!(with.contains("\npressure (kPa)\n") && !without.contains("pressure"));
        assert_eq!(with.matches("<polyline").count(), 2 * 8 + 3);
        assert!(height(&with) > height(&without));
    }

    #[test]
    fn no_scene_is_still_a_picture() {
        assert!(effect_svg("", ["", ""], &[], &[]).ends_with("</svg>\n"));
    }
}
