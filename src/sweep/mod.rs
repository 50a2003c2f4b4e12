//! Many runs of one scene with keys changed: grids, samples, tolerances; what each run shows as one row of a table.
//!
//! A sweep is a list of points, each known by its index alone: [`Plan::point`] needs nothing of the others. So any
//! part of it can run anywhere ([`Shard`]), a kill loses the running points only ([`Journal`]), and the table that
//! comes out ([`Table`]) is the same whoever computed it.

mod best;
mod bootstrap;
mod built_in;
mod design;
mod error;
mod expression;
mod journal;
mod measure;
mod morris;
mod nsga2;
mod pareto;
mod parquet_file;
mod plan;
mod plan_checks;
mod point;
mod probe;
mod range;
mod run;
mod sampling;
mod sensitivity;
mod sobol_indices;
mod spec;
mod table;
mod vocabulary;

pub use best::best;
#[doc(hidden)]
pub use best::write_best;
#[doc(hidden)]
pub use best::{excess, trouble};
#[doc(hidden)]
pub use bootstrap::Estimate;
#[doc(hidden)]
pub use design::Design;
pub use error::SweepError;
#[doc(hidden)]
pub use journal::{Journal, JournalLine};
#[doc(hidden)]
pub use morris::MorrisEffects;
#[doc(hidden)]
pub use morris::Trajectories;
#[doc(hidden)]
pub use nsga2::Evolution;
#[doc(hidden)]
pub use pareto::Score;
#[doc(hidden)]
pub use pareto::front;
pub use plan::{Plan, Shard};
pub use point::{Row, evaluate};
#[doc(hidden)]
pub use run::check_shard;
pub use run::{Watch, run};
pub use sensitivity::{Influence, Sensitivity, sensitivity};
#[doc(hidden)]
pub use sobol_indices::SobolIndices;
#[doc(hidden)]
pub use sobol_indices::sobol_indices;
#[doc(hidden)]
pub use spec::Mark;
#[doc(hidden)]
pub use spec::concern_column;
pub use spec::{Goal, LimitSpec, MeasureSpec, ObjectiveSpec, SamplingSpec, SweepFile, VarySpec};
pub use table::Table;
