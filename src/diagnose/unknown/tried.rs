//! Laws found so far, kept for the stages that follow.

use super::hypothesis::is_explained;
use super::unlisted::Proposals;
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::search::{Bound, Found};

/// A model with a law, and the equally good alternatives.
#[derive(Clone)]
pub(in crate::diagnose) struct Lawful {
    pub best: Fit,
    pub forms: Vec<Fit>,
}

/// Laws proposed on top of the calibration.
#[derive(Default)]
pub(in crate::diagnose) struct Known {
    pub plain: Option<Proposals>,
    /// Single laws with memory, with products of variables, or of wider shapes.
    pub wide: Option<Proposals>,
    /// Second laws, and the first law that they accompany.
    pub second: Option<(Vec<Placed>, Proposals)>,
}

/// Results for one law, kept for later.
#[derive(Default)]
pub(in crate::diagnose) struct Tried {
    pub known: Known,
    /// The best law that is clearly better than any single effect.
    pub law: Option<Fit>,
    /// The law that replaces or accompanies the best single effect, whatever it leaves.
    pub instead: Option<Lawful>,
    /// Whether single laws were tried and none explains everything.
    pub is_open: bool,
}

impl Lawful {
    /// The answer with the law in its place.
    pub fn beside(self, found: &Found) -> Found {
        let rivals = vec![Vec::new(); self.best.model.effects.len()];
        let found = Found { rivals_against: self.best.cost, best: self.best, rivals, ..found.clone() };
        found.with_last_forms(self.forms)
    }
}

impl Tried {
    /// The law that several listed effects compete with.
    pub fn bound(&self, open: &Problem, baseline: &Fit) -> Bound<'_> {
        Bound { law: self.law.as_ref().or_else(|| self.known.first()), is_enough: self.is_enough(open, baseline) }
    }

    /// Whether one law leaves less than a listed effect: laws located along its runs gain nothing from those of the effect.
    pub(super) fn is_nearer(&self, effect: &Fit) -> bool {
        self.law.as_ref().into_iter().chain(self.known.first()).any(|law| law.cost < effect.cost)
    }

    /// Whether one law leaves too little to look for another.
    pub(super) fn is_enough(&self, open: &Problem, baseline: &Fit) -> bool {
        self.law.as_ref().is_some_and(|law| is_explained(open, baseline, law))
    }

    /// Keeps laws that leave less than those known before; the search for several effects is bounded by them if they are clearly better than
    /// the best effects.
    pub(super) fn takes(&mut self, lawful: Lawful, is_better: bool) {
        let leaves_less = |other: &Fit| lawful.best.cost < other.cost;
        if !self.instead.as_ref().is_none_or(|other| leaves_less(&other.best)) {
            return;
        }
        // However many listed effects, they must leave less than this.
        if is_better && self.law.as_ref().is_none_or(leaves_less) {
            self.law = Some(lawful.best.clone());
        }
        self.instead = Some(lawful);
    }
}

impl Known {
    /// The best simple law.
    pub(super) fn first(&self) -> Option<&Fit> {
        self.plain.as_ref()?.fits.first()
    }

    /// Proposals to accompany this law.
    pub(super) fn beside(&mut self, law: &Fit) -> Option<Proposals> {
        self.second.take_if(|(own, _)| *own == law.model.effects).map(|(_, proposals)| proposals)
    }
}
