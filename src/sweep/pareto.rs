//! Which points are best when several things are wanted at once.

/// What a point is worth: costs to be small, and by how much it breaks the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    pub costs: Vec<f64>,
    /// 0 within all limits; infinite where the point failed.
    pub excess: f64,
}

impl Score {
    /// Whether it is better than another: nearer to the limits, or within them no worse in any cost and less in one
    /// (Deb, IEEE Trans. Evol. Comput. 6 (2002) 182, section VI).
    pub fn beats(&self, other: &Self) -> bool {
        if self.excess > 0.0 || other.excess > 0.0 {
            return self.excess < other.excess;
        }
        let pairs = || self.costs.iter().zip(&other.costs);
        pairs().all(|(a, b)| a <= b) && pairs().any(|(a, b)| a < b)
    }
}

/// Indices of the points within the limits that no other beats, in their order; of equal ones the first.
///
/// ```
/// use smam::sweep::{Score, front};
///
/// // Weight and negative pull; the last one breaks a limit.
/// let score = |mass_g: f64, pull_n: f64, excess: f64| Score { costs: vec![mass_g, -pull_n], excess };
/// let points = [score(1.0, 2.0, 0.0), score(2.0, 5.0, 0.0), score(2.5, 4.0, 0.0), score(0.5, 9.0, 0.1)];
/// // The third is heavier than the second and pulls less.
/// assert_eq!(front(&points), [0, 1]);
/// ```
pub fn front(scores: &[Score]) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for (i, score) in scores.iter().enumerate() {
        let worse = |&j: &usize| scores[j].beats(score) || scores[j].costs == score.costs;
        if score.excess > 0.0 || found.iter().any(worse) {
            continue;
        }
        found.retain(|&j| !score.beats(&scores[j]));
        found.push(i);
    }
    found
}

/// Ranks of points: 0 if none beats it, 1 if only those of rank 0 do, and so on.
pub(super) fn ranks(scores: &[Score]) -> Vec<usize> {
    let n = scores.len();
    let beaten_by = |i: usize| (0..n).filter(|&j| scores[j].beats(&scores[i])).count();
    let mut beaten: Vec<usize> = (0..n).map(beaten_by).collect();
    let (mut ranks, mut left, mut rank) = (vec![0; n], n, 0);
    while left > 0 {
        // Nothing beats itself, so that some point is always unbeaten.
        let now: Vec<usize> = (0..n).filter(|&i| beaten[i] == 0).collect();
        for &i in &now {
            ranks[i] = rank;
            beaten[i] = usize::MAX;
        }
        for i in (0..n).filter(|&i| beaten[i] != usize::MAX).collect::<Vec<_>>() {
            beaten[i] -= now.iter().filter(|&&j| scores[j].beats(&scores[i])).count();
        }
        (left, rank) = (left - now.len(), rank + 1);
    }
    ranks
}

/// Room around each point among those of its rank: the sum over the costs of the distance of its neighbours, each over the
/// range of the rank; infinite at the ends.
pub(super) fn room(scores: &[Score], ranks: &[usize]) -> Vec<f64> {
    let mut room = vec![0.0; scores.len()];
    let costs = scores.first().map_or(0, |s| s.costs.len());
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let mut own: Vec<usize> = (0..scores.len()).filter(|&i| ranks[i] == rank).collect();
        for cost in 0..costs {
            let at = |i: usize| scores[i].costs[cost];
            own.sort_by(|&a, &b| at(a).total_cmp(&at(b)));
            let (Some(&first), Some(&last)) = (own.first(), own.last()) else { continue };
            let range = (at(last) - at(first)).max(f64::MIN_POSITIVE);
            room[first] = f64::INFINITY;
            room[last] = f64::INFINITY;
            for three in own.windows(3) {
                room[three[1]] += (at(three[2]) - at(three[0])) / range;
            }
        }
    }
    room
}

#[cfg(test)]
mod tests {
    use super::*;

    fn score(a: f64, b: f64, excess: f64) -> Score {
        Score { costs: vec![a, b], excess }
    }

    #[test]
    fn limits_come_first_then_costs() {
        let all = [
            score(1.0, 4.0, 0.0),
            score(2.0, 2.0, 0.0),
            score(4.0, 1.0, 0.0),
            score(3.0, 3.0, 0.0),
            score(0.0, 0.0, 0.5),
            score(f64::NAN, f64::NAN, f64::INFINITY),
            score(2.0, 2.0, 0.0),
        ];
        assert_eq!(front(&all), [0, 1, 2]);
        assert_eq!(ranks(&all), [0, 0, 0, 1, 2, 3, 0]);
        let room = room(&all, &ranks(&all));
        assert!(room[0].is_infinite() && room[2].is_infinite() && room[1].is_finite());
    }
}
