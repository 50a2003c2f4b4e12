//! Whether the recordings can be diagnosed, and whether the answer can be trusted: on held-out runs,
//! between runs, on the full scene.
//!
//! May import `unknown`, `verdict`, `search`, `grammar`, `full`, `fit`, `case`, `diagnosis` and `error`.

pub(super) mod confirm;
pub(super) mod consistency;
mod fewer;
pub(super) mod harm;
pub(super) mod preflight;
pub(super) mod prove;
