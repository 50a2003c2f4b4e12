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

/// Every figure and table of the paper, in its order.
pub const FIGURES: &[Figure] = &[
    Figure { name: "1", title: "sizes, and elongation to 245 %", make: sizes::chapter },
    Figure { name: "lift", title: "loads lifted (Fig. 1c, d)", make: lifting::chapter },
    Figure { name: "3", title: "three programmes of the plunger", make: programmes::chapter },
    Figure { name: "4a", title: "frequency response to 3 Hz", make: frequency::response },
    Figure { name: "4b", title: "greatest force over elongation", make: force::greatest },
    Figure { name: "4cd", title: "routing of the line, and a tendon in a sheath", make: routing::chapter },
    Figure { name: "4e", title: "the loop from 0.2 to 1.5 Hz", make: frequency::loops },
    Figure { name: "4f", title: "2000 s at 80 % and 0.1 Hz", make: endurance::chapter },
    Figure {
        name: "4g",
        title: "force over the plunger at 65, 75 and 85 mm, and its model (Fig. 7)",
        make: force::held,
    },
    Figure { name: "printed", title: "first principles against the printed model", make: printed::chapter },
    Figure { name: "5", title: "three models on one loop, and on others (Figs. 5, 6)", make: models::chapter },
    Figure { name: "8", title: "the pulley's positions", make: pulley::chapter },
    Figure { name: "10", title: "the catheter bends, grips, moves, releases", make: catheter::chapter },
    Figure {
        name: "feedforward",
        title: "tracking with the model inverted (announced in section VII)",
        make: tracking::chapter,
    },
];
