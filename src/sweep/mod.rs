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
pub use error::SweepError;
pub use plan::{Plan, Shard};
pub use point::{Row, evaluate};
pub use run::{Watch, run};
pub use sensitivity::{Influence, Sensitivity, sensitivity};
pub use spec::{Goal, LimitSpec, MeasureSpec, ObjectiveSpec, SamplingSpec, SweepFile, VarySpec};
pub use table::Table;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    best::{excess, trouble, write_best},
    bootstrap::Estimate,
    design::Design,
    journal::{Journal, JournalLine},
    morris::{MorrisEffects, Trajectories},
    nsga2::Evolution,
    pareto::{Score, front},
    run::check_shard,
    sobol_indices::{SobolIndices, sobol_indices},
    spec::{Mark, concern_column},
};
