//! What a diagnosis has cost so far, counted so that it is the same on every machine and any number of threads; and what it
//! does not begin any more once it has cost enough.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Time steps of the reduced-order model after which no optional step of the search begins: some two minutes on two cores for a pulley
/// (ADR 0022). What has begun goes on to its end, and what checks an answer is never optional.
const ENOUGH: u64 = 240_000_000;
/// The same for steps that try effects of the catalogue: a search for laws that used up the effort is not to keep these from their turn.
const ENOUGH_OF_LISTED: u64 = 300_000_000;

/// A step that a search can do without, at the risk of another answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::diagnose) enum Optional {
    WiderLaws,
    SecondLaw,
    SeveralAtOnce,
    OtherBeginnings,
    LawsBeside,
}

impl Optional {
    fn is_begun_before(self) -> u64 {
        match self {
            Self::SeveralAtOnce | Self::OtherBeginnings => ENOUGH_OF_LISTED,
            Self::WiderLaws | Self::SecondLaw | Self::LawsBeside => ENOUGH,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::WiderLaws => "laws with memory or of two variables",
            Self::SecondLaw => "a second law beside the first",
            Self::SeveralAtOnce => "effects that explain something only together",
            Self::OtherBeginnings => "effects in another order",
            Self::LawsBeside => "laws beside the effects that were found",
        }
    }
}

/// Time steps that the reduced-order model has taken, and optional steps of the search that were not begun.
#[derive(Debug, Default)]
pub struct Effort {
    time_steps: Arc<AtomicU64>,
    not_begun: Arc<Mutex<BTreeSet<Optional>>>,
    is_thorough: bool,
}

impl Effort {
    pub(in crate::diagnose) fn add(&self, time_steps: u64) {
        self.time_steps.fetch_add(time_steps, Ordering::Relaxed);
    }

    /// The same wherever no simulation is under way.
    pub fn time_steps(&self) -> u64 {
        self.time_steps.load(Ordering::Relaxed)
    }

    /// The same count, to look at from elsewhere.
    pub fn watched(&self) -> Self {
        let (time_steps, not_begun) = (Arc::clone(&self.time_steps), Arc::clone(&self.not_begun));
        Self { time_steps, not_begun, is_thorough: self.is_thorough }
    }

    /// Every step is worth its cost.
    pub(in crate::diagnose) fn be_thorough(&mut self) {
        self.is_thorough = true;
    }

    /// Whether an optional step may begin; if not, it is noted. Asked only where no simulation is under way.
    pub(in crate::diagnose) fn allows(&self, step: Optional) -> bool {
        let is_allowed = self.is_thorough || self.time_steps() < step.is_begun_before();
        if !is_allowed {
            self.not_begun.lock().unwrap_or_else(PoisonError::into_inner).insert(step);
        }
        is_allowed
    }

    /// What was not begun, for the reader of the answer; `None` if nothing.
    pub(in crate::diagnose) fn note(&self) -> Option<String> {
        let steps = self.not_begun.lock().unwrap_or_else(PoisonError::into_inner);
        let words: Vec<&str> = steps.iter().map(|step| step.words()).collect();
        let first = steps.iter().map(|step| step.is_begun_before()).min()?;
        Some(format!(
            "the search ended after {} million time steps without {}: --thorough goes on to the end",
            first / 1_000_000,
            words.join(", ")
        ))
    }
}

/// A copy of a case is diagnosed by itself: its count begins at zero.
impl Clone for Effort {
    fn clone(&self) -> Self {
        Self { is_thorough: self.is_thorough, ..Self::default() }
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
        assert_eq!([effort.time_steps(), watched.time_steps(), copy.time_steps()], [11, 11, 0]);
    }

    #[test]
    fn what_is_not_begun_is_said_unless_all_is_wanted() {
        let mut effort = Effort::default();
        assert!(effort.allows(Optional::SecondLaw) && effort.note().is_none());
        effort.add(ENOUGH);
        assert!(!effort.allows(Optional::SecondLaw) && !effort.allows(Optional::WiderLaws));
        assert!(effort.allows(Optional::OtherBeginnings), "laws leave effects of the catalogue their turn");
        effort.add(ENOUGH_OF_LISTED - ENOUGH);
        assert!(!effort.allows(Optional::OtherBeginnings));
        let note = effort.note().expect("something was left out");
        assert!(
            note.contains("laws with memory or of two variables, a second law") && note.contains("--thorough"),
            "{note}"
        );
        effort.be_thorough();
        let copy = effort.clone();
        assert!(effort.allows(Optional::SeveralAtOnce) && copy.is_thorough && copy.note().is_none());
    }
}
