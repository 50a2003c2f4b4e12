//! The paper's figures again: each one played on the stock scenes, each printed number beside ours.
//!
//! A [`Chapter`] is one figure of Thai et al. 2021: what was played, panels, and a [`Row`] for every number printed
//! there. There are no raw data of the paper: shapes are compared with its *printed model* (eqs. 3-4 with the printed
//! parameters), numbers with the printed numbers, and a row says so where neither exists.

mod calibration;
mod catheter;
mod chapter;
mod endurance;
mod error;
mod force;
mod frequency;
mod identified;
mod lifting;
mod loops;
mod models;
mod page;
mod printed;
mod programmes;
mod pulley;
mod rig;
mod routing;
mod search;
mod sizes;
mod tracking;

pub use chapter::{Chapter, Row, Standing};
pub use error::ReproduceError;
pub use page::{HEADER, Made, cells, json, page};

/// One figure: its name, and how it is made.
pub struct Figure {
    /// As on the command line: `4a`.
    pub name: &'static str,
    pub title: &'static str,
    pub make: fn() -> Result<Chapter, ReproduceError>,
}

const fn figure(name: &'static str, title: &'static str, make: fn() -> Result<Chapter, ReproduceError>) -> Figure {
    Figure { name, title, make }
}

/// Every figure and table of the paper, in its order.
///
/// ```
/// use smam::reproduce::FIGURES;
///
/// let frequency = FIGURES.iter().find(|figure| figure.name == "4a").map(|figure| figure.title);
/// assert_eq!(frequency, Some("frequency response to 3 Hz"));
/// ```
pub const FIGURES: &[Figure] = &[
    figure("1", "sizes, and elongation to 245 %", sizes::chapter),
    figure("lift", "loads lifted (Fig. 1c, d)", lifting::chapter),
    figure("3", "three programmes of the plunger", programmes::chapter),
    figure("4a", "frequency response to 3 Hz", frequency::response),
    figure("4b", "greatest force over elongation", force::greatest),
    figure("4cd", "routing of the line, and a tendon in a sheath", routing::chapter),
    figure("4e", "the loop from 0.2 to 1.5 Hz", frequency::loops),
    figure("4f", "2000 s at 80 % and 0.1 Hz", endurance::chapter),
    figure("4g", "force over the plunger at 65, 75 and 85 mm, and its model (Fig. 7)", force::held),
    figure("printed", "first principles against the printed model", printed::chapter),
    figure("5", "three models on one loop, and on others (Figs. 5, 6)", models::chapter),
    figure("8", "the pulley's positions", pulley::chapter),
    figure("10", "the catheter bends, grips, moves, releases", catheter::chapter),
    figure("feedforward", "tracking with the model inverted (announced in section VII)", tracking::chapter),
];
