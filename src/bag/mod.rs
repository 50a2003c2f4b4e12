//! Numbers from ROS 2 bags (MCAP files with CDR messages), and such files from numbers.
//!
//! A leaf of the crate, and the only user of the crates that know MCAP. Message types are not built in: a bag brings
//! their definitions along, and a field is found by its name, as `ros2 topic echo --field` finds it.

mod cdr;
mod chunk;
mod definition;
mod read;
mod records;
mod value;
mod write;

pub use read::{Bag, Clock, Pick, Series, Topic, read};
pub use write::{BagWriter, FLOAT64};

#[cfg(test)]
mod tests;
