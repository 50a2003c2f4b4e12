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

pub use fluid::Fluid;
pub use line::{Line, Syringe};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    chain::{Chain, Port},
    chain_row::{ChainRow, ChainRowMut},
    chain_solver::ChainSolver,
    gas_leak::GasLeak,
};
