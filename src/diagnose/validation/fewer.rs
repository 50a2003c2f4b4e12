//! What stays of an answer of several effects that does harm as a whole.

use super::harm::left_out;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::search::Found;
use crate::parallel;

/// The answer without the effect that the open runs miss least, the samples that were left out of the fit included: slack cables show
/// there what a wrong force does. `None` where nothing would stay.
pub(super) fn with_one_less(open: &Problem, found: &Found) -> Option<Found> {
    let count = found.best.model.effects.len();
    if count < 2 {
        return None;
    }
    let without = |index| {
        let fit = open.fit(&found.best.model.without(index), &open.start_without(&found.best, index))?;
        let distance = fit.cost + left_out(open, &fit)?;
        Some((distance, fit))
    };
    let fits: Vec<(f64, Fit)> = parallel::map_indices(count, without).into_iter().flatten().collect();
    let (_, best) = fits.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let rivals = vec![Vec::new(); best.model.effects.len()];
    Some(Found { rivals_against: best.cost, best, rivals, forms: Vec::new(), described: None, ..found.clone() })
}
