//! What a diagnosis has cost so far, counted so that it is the same on every machine and any number of threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Samples that the fast model has simulated. The count decides nothing but where a search ends that finds no end.
#[derive(Debug, Default)]
pub struct Effort(Arc<Counts>);

#[derive(Debug, Default)]
struct Counts {
    samples: AtomicU64,
    has_cut: AtomicBool,
}

impl Effort {
    pub(in crate::diagnose) fn add(&self, samples: usize) {
        self.0.samples.fetch_add(samples as u64, Ordering::Relaxed);
    }

    /// To be asked where no simulation is under way.
    pub fn samples(&self) -> u64 {
        self.0.samples.load(Ordering::Relaxed)
    }

    /// Remembers that a step has been left out.
    pub(in crate::diagnose) fn cut(&self) {
        self.0.has_cut.store(true, Ordering::Relaxed);
    }

    /// Whether a step has been left out.
    pub(in crate::diagnose) fn has_cut(&self) -> bool {
        self.0.has_cut.load(Ordering::Relaxed)
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
        watched.cut();
        assert!(effort.has_cut() && !copy.has_cut());
    }
}
