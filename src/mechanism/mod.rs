//! (placeholder: filled by the next commits)
pub mod geometry;
