//! Many runs of one scene with keys changed: grids, samples, tolerances; what each run shows as one row of a table.
//!
//! A sweep is a list of points, each known by its index alone: [`Plan::point`] needs nothing of the others. So any
//! part of it can run anywhere ([`Shard`]), a kill loses the running points only ([`Journal`]), and the table that
//! comes out ([`Table`]) is the same whoever computed it.

mod error;
mod expression;
mod journal;
mod measure;
mod parquet_file;
mod plan;
mod point;
mod sampling;
mod spec;
mod table;

pub use error::SweepError;
pub use journal::{Journal, JournalLine};
pub use plan::{Plan, Shard};
pub use point::{Row, evaluate};
pub use spec::{Mark, MeasureSpec, SamplingSpec, SweepFile, VarySpec};
pub use table::Table;
