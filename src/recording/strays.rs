//! Samples that lie far outside all others: a logger's mark for "not measured", a loose contact.

/// How far outside the bulk of a channel a sample lies to be a stray, in widths of the bulk.
const FAR: f64 = 20.0;
/// How far outside the bulk a stray's neighbours lie at most, in the same widths.
const NEAR: f64 = 2.0;
/// How far outside at least, as a share of the bulk's distance from zero: what hardly leaves a steady value is no mark and no loose
/// contact.
const OF_LEVEL: f64 = 0.2;
/// Share of the samples on each side that need not belong to the bulk.
const OUTSIDE_BULK: f64 = 0.2;
/// Strays in a row that differ from each other, at most: more are a motion. A mark may be repeated as often as it likes.
const IN_A_ROW: usize = 3;

/// Indices of the samples that lie twenty widths of a channel's bulk outside it, up to three in a row or all alike, with neighbours
/// that do not.
///
/// ```
/// use smam::recording::strays;
///
/// let mut force_n: Vec<f64> = (0..100).map(|i| f64::from(i % 7)).collect();
/// force_n[40..50].fill(-999.0);
/// assert_eq!(strays(&force_n), (40..50).collect::<Vec<_>>());
/// ```
pub fn strays(values: &[f64]) -> Vec<usize> {
    let known: Vec<(usize, f64)> = values.iter().copied().enumerate().filter(|(_, v)| v.is_finite()).collect();
    let Some((low, high)) = bulk(&known) else { return Vec::new() };
    let width = (high - low).max(OF_LEVEL / FAR * low.abs().max(high.abs()));
    let outside = |v: f64| (low - v).max(v - high).max(0.0) / width;
    let stretches: Vec<&[(usize, f64)]> = known.chunk_by(|a, b| (outside(a.1) > FAR) == (outside(b.1) > FAR)).collect();
    // A peak, however steep, has flanks.
    let is_bare = |neighbour: Option<&(usize, f64)>| neighbour.is_none_or(|(_, v)| outside(*v) < NEAR);
    let is_stray = |i: usize| {
        let stretch = stretches[i];
        let before = i.checked_sub(1).and_then(|before| stretches[before].last());
        let after = stretches.get(i + 1).and_then(|after| after.first());
        let is_brief = stretch.len() <= IN_A_ROW || stretch.iter().all(|(_, v)| *v == stretch[0].1);
        outside(stretch[0].1) > FAR && is_brief && is_bare(before) && is_bare(after)
    };
    (0..stretches.len()).filter(|i| is_stray(*i)).flat_map(|i| stretches[i]).map(|(index, _)| *index).collect()
}

/// Between which values all but a fifth on each side lie. `None` of a channel that stays at one value for so long: whatever it
/// does else would be far outside.
fn bulk(known: &[(usize, f64)]) -> Option<(f64, f64)> {
    let mut sorted: Vec<f64> = known.iter().map(|(_, v)| *v).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied();
    at(OUTSIDE_BULK).zip(at(1.0 - OUTSIDE_BULK)).filter(|(low, high)| low < high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quick_motion_out_of_rest_is_no_stray() {
        let mut jaw_deg: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i % 5)).collect();
        for (i, angle) in jaw_deg[500..530].iter_mut().enumerate() {
            *angle = 2.0 * (i as f64 - 15.0);
        }
        assert!(strays(&jaw_deg).is_empty());
        // Nor is a peak of three samples with flanks.
        let mut force_n: Vec<f64> = (0..1000).map(|i| 0.001 * f64::from(i % 5)).collect();
        force_n[500..507].copy_from_slice(&[0.02, 0.05, 0.1, 0.2, 0.1, 0.05, 0.02]);
        assert!(strays(&force_n).is_empty());
        assert!(strays(&[0.0; 50]).is_empty());
        assert!(strays(&[]).is_empty());
    }

    /// A string's pull, steady but for the moments in which the muscle turns.
    #[test]
    fn what_hardly_leaves_a_steady_value_is_no_stray() {
        let mut force_n: Vec<f64> = (0..1000).map(|i| 0.05 + 1e-9 * f64::from(i % 5)).collect();
        force_n[300..303].copy_from_slice(&[0.0501, 0.0509, 0.0502]);
        assert!(strays(&force_n).is_empty());
        force_n[600] = 0.0;
        assert_eq!(strays(&force_n), [600]);
    }

    #[test]
    fn single_spikes_and_missing_samples() {
        let mut values: Vec<f64> = (0..200).map(|i| (0.1 * f64::from(i)).sin()).collect();
        values[3] = f64::NAN;
        values[50] = 1e4;
        values[90] = -1e4;
        assert_eq!(strays(&values), [50, 90]);
    }
}
