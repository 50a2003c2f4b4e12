//! Steps 0 and 7: whether recordings can carry a diagnosis, and what was found can be trusted: on held-out runs, from run to run, on
//! the full scene.
//!
//! May import `unknown`, `verdict`, `search`, `grammar`, `full`, `fit`, `case`, `diagnosis` and `error`.

pub(super) mod confirm;
pub(super) mod consistency;
pub(super) mod harm;
pub(super) mod preflight;
pub(super) mod prove;
