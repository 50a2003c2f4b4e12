//! The antagonistic pulley (Fig. 8).

use crate::recording::figures;
use crate::report::{BLUE, ORANGE, Panel, Series};

use super::rig::{pre_elongation_percent, stock};
use super::{Chapter, ReproduceError, Row};

/// Positions of the pulley as its two plungers move against each other.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let run = stock("antagonistic_pulley").run()?;
    let values = |column: &str| run.channel(column).map(|c| c.values.clone());
    let angle = values("angle_deg")?;
    let (first, second) = (values("plunger_1_mm")?, values("plunger_2_mm")?);
    let (least, greatest) = (figures::least(&angle), figures::greatest(&angle));
    let at_least = angle.iter().position(|a| *a == least).unwrap_or(0);
    let line =
        |label: &str, colour, y: Vec<f64>| Series { label: label.to_owned(), colour, x: run.time_s().to_vec(), y };
    let reversed = first[at_least] > 0.0 && second[at_least] < 0.0;
    let rows = vec![
        Row::taken(
            "pre-elongation of both muscles",
            "%",
            50.0,
            pre_elongation_percent("antagonistic_pulley")?,
            "scene antagonistic_pulley",
        ),
        Row::judged(
            "turns one way",
            "deg",
            None,
            greatest,
            greatest > 60.0,
            "muscle 1 withdrawn, 2 filled; Fig. 8b shows positions, prints no number",
        ),
        Row::judged("turns the other way", "deg", None, least, least < -60.0, "muscle 1 filled, 2 withdrawn"),
        Row::stated("first pressurised and second depressurised: the other way", reversed, "as printed"),
    ];
    let time = "time (s)".to_owned();
    let panels = vec![
        Panel {
            title: vec!["Angle of the pulley".to_owned()],
            x_label: time.clone(),
            y_label: "angle (deg)".to_owned(),
            series: vec![line("", BLUE, angle)],
            ..Panel::default()
        },
        Panel {
            title: vec!["Tension of the cables".to_owned()],
            x_label: time,
            y_label: "tension (N)".to_owned(),
            series: vec![
                line("cable 1", BLUE, values("tension_1_n")?),
                line("cable 2", ORANGE, values("tension_2_n")?),
            ],
            ..Panel::default()
        },
    ];
    Ok(Chapter { text: vec![], panels, rows })
}
