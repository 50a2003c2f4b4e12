//! Two recordings of one motion whose clocks were started by hand: by how much one lies behind the other.
//!
//! Whatever the two measure, it moves when the rig moves: compared is how fast each changes, either way round (a triangle goes at one speed
//! and differs in direction alone), and without its sign (what is bent goes one way twice). The shift is that at which these speeds are most
//! alike. What truly lags behind the motion is taken for a late clock: that is said to the user.

use super::median_interval_s;

/// Points of the longer recording at most.
const MOST_POINTS: f64 = 4000.0;
/// Speeds are differences over so many points to each side: noise counts for less.
const REACH: usize = 2;
/// Speeds less alike than this say nothing.
const LEAST_LIKENESS: f64 = 0.5;
/// Another shift is as good if the variance that is not in common is at most so many times the best's, or this share.
const AS_GOOD: f64 = 2.0;
const LEAST_APART: f64 = 0.02;

/// Something that was seen to move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<'a> {
    pub(super) time_s: &'a [f64],
    pub(super) values: &'a [f64],
}

/// Where a recording lies in the time of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinedUp {
    /// Its time 0 in the time of the other, s.
    pub starts_s: f64,
    /// Correlation of the speeds there, at most 1.
    pub likeness: f64,
    /// Another place that is as good: the motion repeats itself.
    pub or_s: Option<f64>,
}

/// Where the second motion lies in the time of the first; `None` where no place is better than another.
pub(super) fn line_up(first: Motion<'_>, second: Motion<'_>) -> Option<LinedUp> {
    let (from_s, to_s) = (extent(first)?, extent(second)?);
    let longest_s = (from_s.1 - from_s.0).max(to_s.1 - to_s.0);
    let interval_s =
        median_interval_s(first.time_s)?.max(median_interval_s(second.time_s)?).max(longest_s / MOST_POINTS);
    let (a, b) = (speeds(first, interval_s), speeds(second, interval_s));
    let least = (a.len().min(b.len()) / 2).max(4) as isize;
    let shifts: Vec<isize> = (least - b.len() as isize..=a.len() as isize - least).collect();
    let [a_without, b_without] = [&a, &b].map(|speeds| speeds.iter().map(|v| v.abs()).collect::<Vec<_>>());
    let likest = |shift: &isize| likeness(&a, &b, *shift).abs().max(likeness(&a_without, &b_without, *shift));
    let likeness: Vec<f64> = shifts.iter().map(likest).collect();
    let best = (0..likeness.len()).max_by(|i, j| likeness[*i].total_cmp(&likeness[*j]))?;
    if likeness[best] < LEAST_LIKENESS {
        return None;
    }
    let at = |index: usize| from_s.0 - to_s.0 + (shifts[index] as f64 + vertex(&likeness, index)) * interval_s;
    let or_s = as_good(&likeness, best).map(at);
    Some(LinedUp { starts_s: at(best), likeness: likeness[best], or_s })
}

/// Begin and end of what is known of a motion.
fn extent(motion: Motion<'_>) -> Option<(f64, f64)> {
    let known = || motion.time_s.iter().zip(motion.values).filter(|(_, v)| !v.is_nan()).map(|(t, _)| *t);
    let (from, to) = (known().next()?, known().next_back()?);
    (to > from).then_some((from, to))
}

/// How fast it changes at even instants.
fn speeds(motion: Motion<'_>, interval_s: f64) -> Vec<f64> {
    let known: Vec<(f64, f64)> =
        motion.time_s.iter().copied().zip(motion.values.iter().copied()).filter(|(_, v)| !v.is_nan()).collect();
    let (Some(from), Some(to)) = (known.first(), known.last()) else { return Vec::new() };
    let points = ((to.0 - from.0) / interval_s) as usize + 1;
    let value = |point: usize| {
        let t = from.0 + point as f64 * interval_s;
        let after = known.partition_point(|(at, _)| *at < t).clamp(1, known.len() - 1);
        let ((t0, v0), (t1, v1)) = (known[after - 1], known[after]);
        v0 + (v1 - v0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0)
    };
    let values: Vec<f64> = (0..points).map(value).collect();
    let speed = |at: usize| values[(at + REACH).min(points - 1)] - values[at.saturating_sub(REACH)];
    (0..points).map(speed).collect()
}

/// Correlation of what the two have in common where the second begins `shift` points after the first.
fn likeness(a: &[f64], b: &[f64], shift: isize) -> f64 {
    let (from_a, from_b) = (shift.max(0) as usize, (-shift).max(0) as usize);
    let both = a.iter().skip(from_a).zip(b.iter().skip(from_b));
    let (mut n, mut sa, mut sb, mut saa, mut sbb, mut sab) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in both {
        n += 1.0;
        sa += x;
        sb += y;
        saa += x * x;
        sbb += y * y;
        sab += x * y;
    }
    let (va, vb) = (n * saa - sa * sa, n * sbb - sb * sb);
    if va > 0.0 && vb > 0.0 { (n * sab - sa * sb) / (va * vb).sqrt() } else { 0.0 }
}

/// Where between its neighbours a greatest value lies, in points: the vertex of the parabola through the three.
fn vertex(values: &[f64], at: usize) -> f64 {
    let (Some(left), Some(right)) = (at.checked_sub(1).and_then(|i| values.get(i)), values.get(at + 1)) else {
        return 0.0;
    };
    let bend = left - 2.0 * values[at] + right;
    if bend < 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// A peak elsewhere that is as high as the best one.
fn as_good(values: &[f64], best: usize) -> Option<usize> {
    let apart = |index: usize| 1.0 - values[index].powi(2);
    let most = (AS_GOOD * apart(best)).max(LEAST_APART);
    let is_high = |index: usize| apart(index) <= most;
    let left = (0..best).rev().find(|i| !is_high(*i)).unwrap_or(0);
    let right = (best..values.len()).find(|i| !is_high(*i)).unwrap_or(values.len());
    let others = (0..left).chain(right..values.len()).filter(|i| is_high(*i));
    others.max_by(|i, j| values[*i].total_cmp(&values[*j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(from_s: f64, interval_s: f64, count: usize, of: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..count).map(|i| from_s + i as f64 * interval_s).collect();
        let values = time_s.iter().map(|t| of(*t)).collect();
        (time_s, values)
    }

    fn chirp(t: f64) -> f64 {
        if (0.0..30.0).contains(&t) { (0.15 * t * (1.0 + 0.2 * t)).sin() } else { 0.0 }
    }

    /// Noise of a hash: the same each time.
    fn noise(i: usize) -> f64 {
        let x = (i as f64 * 12.9898).sin() * 43758.547;
        x - x.floor() - 0.5
    }

    #[test]
    fn a_camera_started_by_hand_is_lined_up_to_a_fraction_of_its_interval() {
        let (t, plunger) = sampled(0.0, 0.01, 4000, chirp);
        for starts_s in [-3.4, 0.0, 1.237, 8.0] {
            // The camera's time 0 is `starts_s`; it sees the motion mirrored, larger, bent, with noise.
            let (own_s, mut seen) =
                sampled(0.0, 1.0 / 30.0, 1000, |t| -40.0 * chirp(t + starts_s) - 4.0 * chirp(t + starts_s).powi(2));
            seen.iter_mut().enumerate().for_each(|(i, v)| *v += 0.3 * noise(i));
            let found = line_up(Motion { time_s: &t, values: &plunger }, Motion { time_s: &own_s, values: &seen })
                .expect("alike");
            assert!((found.starts_s - starts_s).abs() < 0.02, "{starts_s}: {found:?}");
            assert!(found.or_s.is_none() && found.likeness > 0.9, "{starts_s}: {found:?}");
        }
    }

    /// Which goes up and down at one speed, once higher than the other time.
    #[test]
    fn a_triangle_is_lined_up_by_its_turns() {
        let triangle = |t: f64| 6.0 - (t - 6.0).abs().min((t - 21.0).abs() - 3.0).min(6.0);
        let (t, plunger) = sampled(0.0, 0.01, 3200, triangle);
        let (own_s, mut seen) = sampled(0.0, 0.04, 760, |t| 9.0 * triangle(t + 1.3));
        seen.iter_mut().enumerate().for_each(|(i, v)| *v += 0.3 * noise(i));
        let found = line_up(Motion { time_s: &t, values: &plunger }, Motion { time_s: &own_s, values: &seen });
        let found = found.expect("alike");
        assert!((found.starts_s - 1.3).abs() < 0.02 && found.likeness > 0.9, "{found:?}");
    }

    #[test]
    fn a_motion_that_repeats_itself_has_several_places() {
        let (t, plunger) = sampled(0.0, 0.01, 4000, |t| (2.0 * t).sin());
        let (own_s, seen) = sampled(5.0, 0.02, 1500, |t| 3.0 * (2.0 * t).sin());
        let found =
            line_up(Motion { time_s: &t, values: &plunger }, Motion { time_s: &own_s, values: &seen }).expect("alike");
        assert!(found.or_s.is_some(), "{found:?}");
    }

    #[test]
    fn what_has_nothing_in_common_or_stands_still_has_no_place() {
        let (t, plunger) = sampled(0.0, 0.01, 4000, chirp);
        let (own_s, other) = sampled(0.0, 0.01, 4000, |t| noise((t * 100.0) as usize));
        let motion = Motion { time_s: &t, values: &plunger };
        assert_eq!(line_up(motion, Motion { time_s: &own_s, values: &other }), None);
        assert_eq!(line_up(motion, Motion { time_s: &own_s, values: &vec![1.0; 4000] }), None);
        assert_eq!(line_up(motion, Motion { time_s: &own_s, values: &vec![f64::NAN; 4000] }), None);
        assert_eq!(line_up(motion, Motion { time_s: &[0.0], values: &[1.0] }), None);
    }
}
