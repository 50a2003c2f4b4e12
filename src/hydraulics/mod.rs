//! Hydraulics: `plunger -> syringe -> line -> muscle port`, pressures and flows.
//!
//! Pure laws: no input or output, no mechanism. A [`Chain`] is the whole line with its compliances, lumped into
//! `N + 1` pressure nodes and `N` flow segments; the muscle is whatever takes fluid from the last node.

mod chain;
mod chain_row;
mod chain_solver;
mod fluid;
mod gas_leak;
mod line;
#[cfg(test)]
mod transmission_line_tests;

#[doc(hidden)]
pub use chain::{Chain, Port};
#[doc(hidden)]
pub use chain_row::ChainRow;
#[doc(hidden)]
pub use chain_row::ChainRowMut;
#[doc(hidden)]
pub use chain_solver::ChainSolver;
pub use fluid::Fluid;
#[doc(hidden)]
pub use gas_leak::GasLeak;
pub use line::{Line, Syringe};
