//! Fewer points, same picture: the extremes of every stretch are kept.

/// Cuts points at non-finite ones into pieces and thins each, to about `budget` points in all.
///
/// Of every stretch of samples the lowest and the highest stay, in their order, so that no peak is
/// lost; the ends of a piece stay too.
pub(in crate::report) fn decimate(x: &[f64], y: &[f64], budget: usize) -> Vec<Vec<(f64, f64)>> {
    let points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let stretch = (2 * points.len()).div_ceil(budget.max(2)).max(1);
    points
        .split(|(x, y)| !x.is_finite() || !y.is_finite())
        .filter(|piece| !piece.is_empty())
        .map(|piece| thin(piece, stretch))
        .collect()
}

fn thin(piece: &[(f64, f64)], stretch: usize) -> Vec<(f64, f64)> {
    let [first, .., last] = piece else {
        return piece.to_vec();
    };
    if stretch <= 2 {
        return piece.to_vec();
    }
    let mut kept = vec![*first];
    for part in piece[1..piece.len() - 1].chunks(stretch) {
        let height = |index: &usize| part[*index].1;
        let indices = || 0..part.len();
        let low = indices().min_by(|a, b| height(a).total_cmp(&height(b)));
        let high = indices().max_by(|a, b| height(a).total_cmp(&height(b)));
        let (low, high) = (low.unwrap_or(0), high.unwrap_or(0));
        kept.push(part[low.min(high)]);
        if low != high {
            kept.push(part[low.max(high)]);
        }
    }
    kept.push(*last);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_and_ends_survive() {
        let x: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut y: Vec<f64> = x.iter().map(|t| (t / 1e4).sin()).collect();
        y[54_321] = 9.0;
        y[54_322] = -9.0;
        let pieces = decimate(&x, &y, 1500);
        let kept = &pieces[0];
        assert!(kept.len() <= 1510, "{}", kept.len());
        assert!(kept.contains(&(54_321.0, 9.0)) && kept.contains(&(54_322.0, -9.0)));
        assert_eq!((kept[0].0, kept[kept.len() - 1].0), (0.0, 99_999.0));
        assert!(kept.windows(2).all(|w| w[0].0 < w[1].0));
    }

    #[test]
    fn missing_points_cut_the_line() {
        let pieces = decimate(&[0.0, 1.0, 2.0, 3.0], &[1.0, f64::NAN, 2.0, 3.0], 1500);
        assert_eq!(pieces, [vec![(0.0, 1.0)], vec![(2.0, 2.0), (3.0, 3.0)]]);
    }
}
