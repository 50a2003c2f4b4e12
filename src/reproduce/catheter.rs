//! The bending catheter with its forceps (Fig. 10).

use crate::recording::Recording;
use crate::recording::figures;
use crate::report::{BLUE, GREEN, ORANGE, Panel, Series};

use super::loops::rms_apart;
use super::rig::{effect, pre_elongation_percent, stock};
use super::{Chapter, ReproduceError, Row};

/// Instants at which the stock programme holds 45, 90 and 135 degrees, s.
const HELD: [(f64, f64); 3] = [(45.0, 6.9), (90.0, 12.9), (135.0, 18.9)];
/// Lever of the forceps' cable about the bending axis, m: it runs down the tube's middle, the axis lies in the wall that
/// the cuts leave (the `ybar` of the notch).
const OFF_AXIS_M: f64 = 1.302e-3;

/// Fig. 10b and 10c.
pub fn chapter() -> Result<Chapter, ReproduceError> {
    let bends = stock("bending_catheter").run()?;
    let coupled =
        stock("bending_catheter").and(effect("tendon_coupling", "mechanism", &[("lever_m", OFF_AXIS_M)])).run()?;
    let grips = stock("grip_and_release").run()?;
    let mut rows = vec![
        Row::given("outer diameter of the arm", "mm", 3.23, "scene bending_catheter"),
        Row::taken(
            "pre-elongation of both muscles",
            "%",
            70.0,
            pre_elongation_percent("bending_catheter")?,
            "scene bending_catheter",
        ),
    ];
    for (angle_deg, at_s) in HELD {
        let ours = bends.value_at("bend_deg", at_s)?;
        rows.push(
            Row::compared(
                format!("bends to {angle_deg:.0} degrees"),
                "deg",
                angle_deg,
                ours,
                2.0,
                "plunger programme sought for it; tolerance 2 deg",
            )
            .tuned(),
        );
    }
    let (closed, open) = (bends.value_at("jaw_deg", 10.5)?, bends.value_at("jaw_deg", 12.9)?);
    rows.push(Row::judged("forceps closed at 90 degrees", "deg", None, closed, closed.abs() < 1.0, "0 is closed"));
    rows.push(Row::judged(
        "forceps open again",
        "deg",
        None,
        open,
        open > 30.0,
        "40 at rest; the muscle's hysteresis keeps a part",
    ));
    let effect_deg = rms_apart(&bends.channel("bend_deg")?.values, &coupled.channel("bend_deg")?.values);
    let bend = figures::range(&bends.channel("bend_deg")?.values);
    rows.push(Row::shown(
        "forceps' tension on the bending",
        "%",
        100.0 * effect_deg / bend,
        "RMS over the bending's range with tendon_coupling, lever 1.3 mm; paper: a slight effect, neglected",
    ));
    let (rows_of_grip, ball) = gripped(&grips)?;
    rows.extend(rows_of_grip);
    Ok(Chapter { text: vec![], panels: panels(&bends, &coupled, ball)?, rows })
}

/// The ball's way: gripped, carried, let go.
fn gripped(run: &Recording) -> Result<(Vec<Row>, Panel), ReproduceError> {
    let height = run.channel("ball_y_mm")?;
    let line = |column: &str, colour| -> Result<Series, ReproduceError> {
        let y = run.channel(column)?.values.clone();
        Ok(Series { label: column.to_owned(), colour, x: run.time_s().to_vec(), y })
    };
    let carried = figures::range(&run.channel("ball_z_mm")?.values);
    let rows = vec![
        Row::judged(
            "grip, move, release: the ball is carried",
            "mm",
            None,
            carried,
            carried > 5.0,
            "way across the catheter; no number is printed",
        ),
        Row::judged(
            "and falls when released",
            "mm",
            None,
            height.values.last().copied().unwrap_or(f64::NAN) - height.values[0],
            height.values.last().is_some_and(|h| *h < height.values[0] - 1.0),
            "along gravity, into the dish",
        ),
    ];
    let panel = Panel {
        title: vec!["The ball is gripped, carried and released".to_owned()],
        x_label: "time (s)".to_owned(),
        y_label: "position (mm)".to_owned(),
        series: vec![line("ball_x_mm", BLUE)?, line("ball_y_mm", GREEN)?, line("ball_z_mm", ORANGE)?],
        ..Panel::default()
    };
    Ok((rows, panel))
}

fn panels(bends: &Recording, coupled: &Recording, ball: Panel) -> Result<Vec<Panel>, ReproduceError> {
    let line = |label: &str, colour, run: &Recording, column: &str| -> Result<Series, ReproduceError> {
        let y = run.channel(column)?.values.clone();
        Ok(Series { label: label.to_owned(), colour, x: run.time_s().to_vec(), y })
    };
    let panel = |title: &str, y_label: &str, series| Panel {
        title: vec![title.to_owned()],
        x_label: "time (s)".to_owned(),
        y_label: y_label.to_owned(),
        series,
        ..Panel::default()
    };
    Ok(vec![
        panel(
            "Bending to 45, 90 and 135 degrees",
            "bending angle (deg)",
            vec![
                line("stock scene", BLUE, bends, "bend_deg")?,
                line("with tendon_coupling", ORANGE, coupled, "bend_deg")?,
            ],
        ),
        panel("Opening of the forceps", "jaw angle (deg)", vec![line("", BLUE, bends, "jaw_deg")?]),
        ball,
    ])
}
