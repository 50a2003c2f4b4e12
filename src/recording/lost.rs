//! What an input did while the logger lost samples.

/// A stretch without samples up to so many median intervals is taken for lost samples; what is longer is a pause, or the corner
/// points of a programme, and straight.
const MOST_LOST: f64 = 10.5;
/// And up to so long, s.
pub const LONGEST_LOST_S: f64 = 0.1;
/// An interval of so many medians lacks at least one sample.
const LEAST_LOST: f64 = 1.5;
/// What is straight on both sides bends by less than this share of what it bends in between.
const STRAIGHT: f64 = 0.1;

/// The points of a sampled signal with those put back that a logger lost, at the median interval.
///
/// They lie on Akima's curve: a cubic between two samples whose slope at each is
/// ```text
/// s_i = (|m_{i+1} - m_i| m_{i-1} + |m_{i-1} - m_{i-2}| m_i) / (|m_{i+1} - m_i| + |m_{i-1} - m_{i-2}|)
/// ```
/// with `m_i` the slope of the straight line from sample `i` to the next. Where the signal is straight before and after what was lost,
/// the two lines are carried on to where they meet: a plunger that stops or turns between two samples does so suddenly, and friction
/// would remember a corner that is cut. Times in seconds and increasing, values finite, as many of both.
///
/// A recording that begins shortly after zero has lost its first samples. Those lie on the line through the first two that are there, or,
/// where that comes from about there, on one from home: the rig was at rest there, and a simulation that rested a micrometre
/// farther would be off by ten ever after.
///
/// Source: H. Akima, A new method of interpolation and smooth curve fitting based on local procedures, J. ACM 17 (1970) 589.
pub(super) fn put_back(times_s: Vec<f64>, values: Vec<f64>, median_interval_s: f64) -> (Vec<f64>, Vec<f64>) {
    let count_lost = |i: usize| lost(times_s[i + 1] - times_s[i], median_interval_s);
    let intervals = 0..times_s.len().saturating_sub(1);
    let late = times_s.first().map_or(0, |first_s| lost_before(*first_s, median_interval_s));
    let is_whole = late == 0 && intervals.clone().all(|i| count_lost(i) == 0);
    if median_interval_s <= 0.0 || times_s.len() < 2 || is_whole {
        return (times_s, values);
    }
    let curve = Akima { times_s: &times_s, values: &values };
    let (mut all_s, mut all) = before_first(&times_s, &values, late);
    for i in intervals {
        let pieces = count_lost(i) + 1;
        all_s.push(times_s[i]);
        all.push(values[i]);
        for share in (1..pieces).map(|k| k as f64 / pieces as f64) {
            all_s.push(times_s[i] + share * (times_s[i + 1] - times_s[i]));
            all.push(curve.between(i, share));
        }
    }
    all_s.extend(times_s.last());
    all.extend(values.last());
    (all_s, all)
}

/// How many samples an interval lacks.
fn lost(interval_s: f64, median_s: f64) -> usize {
    let medians = interval_s / median_s;
    if medians > LEAST_LOST && is_short(interval_s, median_s) { medians.round() as usize - 1 } else { 0 }
}

fn is_short(interval_s: f64, median_s: f64) -> bool {
    // Clocks in floating point: ten intervals of 10 ms are a little more than 0.1 s.
    interval_s <= MOST_LOST * median_s && interval_s <= LONGEST_LOST_S * (1.0 + 1e-6)
}

/// How many samples a recording lacks between zero and its first one.
fn lost_before(first_s: f64, median_s: f64) -> usize {
    if first_s > 0.0 && is_short(first_s, median_s) { (first_s / median_s).round() as usize } else { 0 }
}

/// What is put between zero and the first sample comes from home if home is not farther than this many times the way that the line
/// through the first two samples goes in that time.
const FROM_HOME: f64 = 2.0;

/// Those samples, from zero on; of a signal of two samples or more.
fn before_first(times_s: &[f64], values: &[f64], count: usize) -> (Vec<f64>, Vec<f64>) {
    let (first_s, first) = (times_s[0], values[0]);
    let way = first_s * (values[1] - first) / (times_s[1] - first_s);
    let start = if (first - way).abs() <= FROM_HOME * way.abs() { 0.0 } else { first - way };
    let share = |k: usize| k as f64 / count as f64;
    (0..count).map(|k| (share(k) * first_s, start + share(k) * (first - start))).unzip()
}

struct Akima<'a> {
    times_s: &'a [f64],
    values: &'a [f64],
}

impl Akima<'_> {
    /// At a share of the way from sample `i` to the next.
    fn between(&self, i: usize, share: f64) -> f64 {
        let width_s = self.times_s[i + 1] - self.times_s[i];
        let (start, end) = (self.values[i], self.values[i + 1]);
        let (left, right) = (width_s * self.slope_at(i as isize), width_s * self.slope_at(i as isize + 1));
        if let Some(corner) = self.corner(i, left, right) {
            return if share < corner { start + share * left } else { end - (1.0 - share) * right };
        }
        let rest = 1.0 - share;
        start + share * (end - start) + share * rest * (rest * (left - (end - start)) - share * (right - (end - start)))
    }

    /// At which share of the way from sample `i` to the next the lines before and after it meet, if it is lines that are there.
    /// `left` and `right` are the curve's rises at the ends.
    fn corner(&self, i: usize, left: f64, right: f64) -> Option<f64> {
        let i = i as isize;
        let [far_left, near_left, near_right, far_right] = [i - 2, i - 1, i + 1, i + 2].map(|k| self.line(k));
        let bends = (near_left - far_left).abs().max((far_right - near_right).abs());
        let is_corner = bends < STRAIGHT * (near_right - near_left).abs();
        let share = (self.values[i as usize + 1] - self.values[i as usize] - right) / (left - right);
        (is_corner && (0.0..=1.0).contains(&share)).then_some(share)
    }

    /// The curve's slope at a sample.
    fn slope_at(&self, i: isize) -> f64 {
        let [before, left, right, after] = [i - 2, i - 1, i, i + 1].map(|k| self.line(k));
        let (of_left, of_right) = ((after - right).abs(), (left - before).abs());
        match of_left + of_right {
            0.0 => (left + right) / 2.0,
            sum => (of_left * left + of_right * right) / sum,
        }
    }

    /// Slope of the straight line from sample `i` to the next; beyond the ends that of the last line.
    fn line(&self, i: isize) -> f64 {
        let last = self.times_s.len() as isize - 2;
        let i = i.clamp(0, last) as usize;
        (self.values[i + 1] - self.values[i]) / (self.times_s[i + 1] - self.times_s[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.01;

    /// Every sample of 3 s but those named lost; the greatest errors of what is put back and of straight lines.
    fn errors(f: impl Fn(f64) -> f64, is_lost: impl Fn(usize) -> bool) -> [f64; 2] {
        let kept: Vec<f64> = (0..300).filter(|k| !is_lost(*k)).map(|k| k as f64 * DT_S).collect();
        let values: Vec<f64> = kept.iter().map(|t| f(*t)).collect();
        let straight = crate::recording::PiecewiseLinear::new(&kept, &values).unwrap();
        let (times_s, filled) = put_back(kept, values, DT_S);
        assert_eq!(times_s.len(), 300);
        let most = |g: &dyn Fn(usize, f64) -> f64| {
            times_s.iter().enumerate().map(|(i, t)| (g(i, *t) - f(*t)).abs()).fold(0.0, f64::max)
        };
        [most(&|i, _| filled[i]), most(&|_, t| straight.value(t))]
    }

    #[test]
    fn a_sine_is_followed() {
        let [akima, straight] = errors(|t| (6.0 * t).sin(), |k| k > 5 && k < 290 && k % 7 < 2);
        assert!(akima < 0.15 * straight && straight > 1e-4, "{akima:e} {straight:e}");
    }

    /// Where a ramp ends in a rest, or turns, samples are lost.
    #[test]
    fn a_corner_is_not_cut() {
        for end in [0.0, -1.0] {
            for at in 148..=150 {
                let [filled, straight] =
                    errors(|t| t.min(1.5) + end * (t - 1.5).max(0.0), |k| (at..at + 3).contains(&k));
                assert!(filled < 1e-12 && straight > 4e-3, "{at}: {filled:e} {straight:e}");
            }
        }
    }

    #[test]
    fn a_recording_that_begins_late_gets_its_first_samples_back() {
        let [filled, _] = errors(|t| 2.0 * t - 1.0, |k| k < 3);
        assert!(filled < 1e-12, "{filled:e}");
        // Off from home, slowly at first.
        for f in [|t: f64| t, |t: f64| t * t] {
            let times_s: Vec<f64> = (2..9).map(|k| f64::from(k) * DT_S).collect();
            let (all_s, all) = put_back(times_s.clone(), times_s.iter().map(|t| f(*t)).collect(), DT_S);
            assert_eq!((all_s.len(), all_s[0], all[0], all[2]), (9, 0.0, 0.0, f(0.02)));
        }
        // A clock that does not begin at zero.
        for first in [-0.02, 0.5, 1e6] {
            let times_s: Vec<f64> = (0..9).map(|k| first + f64::from(k) * DT_S).collect();
            assert_eq!(put_back(times_s.clone(), times_s.clone(), DT_S), (times_s.clone(), times_s));
        }
        assert_eq!(put_back(vec![0.01], vec![1.0], DT_S), (vec![0.01], vec![1.0]));
    }

    #[test]
    fn straight_lines_rests_and_pauses_stay_as_they_are() {
        let [akima, _] = errors(|t| 2.0 * t - 1.0, |k| k % 5 == 3);
        assert!(akima < 1e-12, "{akima:e}");
        // Corner points of a programme, and a pause of a logger.
        for times_s in [vec![0.0, 1.0, 2.0, 4.0, 5.0], vec![0.0, 0.01, 0.02, 0.5, 0.51, 0.52]] {
            let values: Vec<f64> = times_s.iter().map(|t| t * t).collect();
            assert_eq!(put_back(times_s.clone(), values.clone(), times_s[1]), (times_s, values));
        }
        assert_eq!(put_back(vec![3.0], vec![1.0], 0.01), (vec![3.0], vec![1.0]));
    }
}
