//! Shows a run in Rerun: to an `.rrd` file, to a viewer on this machine, or served on loopback.
//!
//! This folder is the only user of the crate `rerun`. A [`Viewer`] is an
//! [`Observer`](crate::system::observe::Observer): it keeps the frames of a short stretch, then sends each quantity as one column, so that memory
//! stays flat and ten thousand frames cost milliseconds.
//!
//! Entities: `world/links/<link>` (poses and shapes), `world/cables/<cable>`, `world/muscles/<muscle>`,
//! `world/contacts`, `world/tip` (trace), `plots/<quantity>_<unit>/<channel>`, `joints/<n>` (degrees; sliders mm),
//! `energy/<name>`, `loops/<n>`, `headline`, `angles`, `events`, `legend`. A link that turns in a hinge carries its marker,
//! `world/links/<link>/hinge`, the tip's link its frame, `world/links/<link>/frame`. The only timeline is `time`, the simulated time.

mod angles;
mod blueprint;
mod cables;
mod channels;
mod coil;
mod colour;
mod comparison;
mod contacts;
mod diagnosis;
mod diagnosis_page;
mod error;
mod file;
mod headline;
mod layer;
mod layout;
mod legend;
mod links;
mod loops;
mod muscles;
mod options;
mod scalars;
mod scale_bar;
mod shape;
mod sink;
mod solids;
#[cfg(test)]
mod tests;
mod ticks;
mod tip;
mod trace;
mod viewer;

pub use diagnosis::show_diagnosis;
pub use error::ViewError;
pub use options::{Pace, ViewOptions};
pub use sink::{DEFAULT_PORT, ViewSink};
pub use viewer::{ViewSummary, Viewer};
