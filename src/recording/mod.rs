//! Recordings: time x named channels with units, measured or simulated.
//!
//! It knows files and numbers, nothing of scenes. A channel keeps the unit its
//! column name ends in (`plunger_mm`), so a file is written back as it was read; [`Recording::si`]
//! gives SI values.
//!
//! ```
//! use smam::recording::{Channel, Recording, figures};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let plunger = Channel::new("plunger_mm", vec![0.0, 1.5, 3.0]);
//! let force = Channel::new("force_n", vec![0.05, f64::NAN, 0.85]);
//! let recording = Recording::new(vec![0.0, 0.5, 1.0], vec![plunger, force])?;
//! assert_eq!(recording.si("plunger_mm")?[1], 1.5e-3);
//! // Straight across what is missing, when something is driven by it.
//! assert!((recording.piecewise_si("force_n")?.value(0.5) - 0.45).abs() < 1e-12);
//! assert_eq!(figures::range(&recording.channel("plunger_mm")?.values), 3.0);
//! # Ok(())
//! # }
//! ```

mod also;
mod bag_read;
mod bag_source;
mod blocks;
mod by_size;
mod channels;
mod compare;
mod csv_read;
mod csv_write;
mod error;
pub mod figures;
mod folder;
mod folder_keys;
mod folder_load;
mod folder_tables;
mod formats;
mod guess;
mod join;
mod line_up;
mod lost;
mod noise;
mod one_clock;
mod other_zero;
mod parquet_read;
mod piecewise;
mod schema;
mod smooth;
mod source;
mod strays;
mod survey;
mod table;
mod unit;
mod writer;

pub use also::AlsoFile;
pub use channels::{Channel, Recording};
pub use compare::{ChannelFit, compare};
pub use csv_read::read_csv;
pub use error::RecordingError;
pub use folder::{LoadedRun, RecordingSet, Role, Run, RunUse};
pub use formats::read_recording;
pub use noise::noise_sd;
pub use piecewise::PiecewiseLinear;
pub use smooth::{Smoothed, smoothed};
pub use survey::{Missing, Survey, survey};

pub use crate::bag::Clock;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    bag_read::read_bag_from,
    bag_source::BagSource,
    blocks::Blocks,
    by_size::{BySize, motion_ratio, unit_by_size},
    channels::TIME_COLUMN,
    csv_read::read_csv_from,
    csv_write::{CsvWriter, RowWriter},
    folder::{ChannelSpec, SET_FILE_NAME},
    formats::FileFormat,
    guess::{AlsoGuess, Guess, GuessedColumn, OpenScene, Said, Sureness, Wanted, guess, guess_sheet, to_toml},
    join::Start,
    line_up::LinedUp,
    lost::LONGEST_LOST_S,
    other_zero::{Begun, other_zero},
    schema::recordings_schema,
    strays::strays,
    survey::{Gap, Strays, gap_limit_s, median, median_interval_s},
    table::{Delimiter, FILE_UNITS, FileOptions, FileUnit, Header, Label, TableSource, TimeSource, file_unit, label},
    unit::{ColumnName, KNOWN_UNITS, Unit, axis_label, parse_column},
    writer::RecordingWriter,
};
