//! Fewer points, same line: those that lie on the way between their neighbours go.

/// Points off the line by no more than this are not missed, px.
pub(super) const TOLERANCE_PX: f64 = 0.1;

/// Ramer's and Douglas and Peucker's choice of points, without recursion; first and last stay.
pub(super) fn thin(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut is_kept = vec![false; points.len()];
    (is_kept[0], is_kept[points.len() - 1]) = (true, true);
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((from, to)) = spans.pop() {
        let off = (from + 1..to).map(|i| (i, distance(points[i], points[from], points[to])));
        let worst = off.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, off)| *off > tolerance);
        if let Some((at, _)) = worst {
            is_kept[at] = true;
            spans.extend([(from, at), (at, to)]);
        }
    }
    points.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// From a point to the piece of line between two others.
fn distance(point: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (x, y) = (point.0 - a.0, point.1 - a.1);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 { ((x * dx + y * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - along * dx).hypot(y - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_on_the_line_go() {
        let straight: Vec<(f64, f64)> = (0..100).map(|i| (f64::from(i), 2.0 * f64::from(i))).collect();
        assert_eq!(thin(&straight, 0.1), [(0.0, 0.0), (99.0, 198.0)]);
        let mut bent = straight.clone();
        bent[40].1 += 5.0;
        assert_eq!(thin(&bent, 0.1)[1..4], [(39.0, 78.0), (40.0, 85.0), (41.0, 82.0)]);
        // There and back again: the turn stays.
        assert_eq!(thin(&[(0.0, 0.0), (9.0, 0.0), (1.0, 0.0)], 0.1).len(), 3);
    }

    #[test]
    fn no_point_of_a_sine_is_further_off_than_allowed() {
        let sine: Vec<(f64, f64)> =
            (0..1000).map(|i| (0.5 * f64::from(i), 80.0 * (0.05 * f64::from(i)).sin())).collect();
        let kept = thin(&sine, TOLERANCE_PX);
        assert!(kept.len() < 300, "{}", kept.len());
        for p in &sine {
            let off = kept.windows(2).map(|w| distance(*p, w[0], w[1])).fold(f64::MAX, f64::min);
            assert!(off <= TOLERANCE_PX, "{off}");
        }
    }
}
