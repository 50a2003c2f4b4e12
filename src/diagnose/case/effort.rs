//! What a diagnosis has cost so far, counted so that it is the same on every machine and any number of threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Samples that the reduced-order model has simulated.
#[derive(Debug, Default)]
pub struct Effort(Arc<AtomicU64>);

impl Effort {
    pub(in crate::diagnose) fn add(&self, samples: usize) {
        self.0.fetch_add(samples as u64, Ordering::Relaxed);
    }

    /// The same wherever no simulation is under way.
    pub fn samples(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// The same count, to look at from elsewhere.
    pub fn watched(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

/// A copy of a case is diagnosed by itself: its count begins at zero.
impl Clone for Effort {
    fn clone(&self) -> Self {
        Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_counts_by_itself_and_a_watcher_with_it() {
        let effort = Effort::default();
        let (copy, watched) = (effort.clone(), effort.watched());
        effort.add(11);
        assert_eq!([effort.samples(), watched.samples(), copy.samples()], [11, 11, 0]);
    }
}
