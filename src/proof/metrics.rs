//! The figures of a proof.

use serde::{Deserialize, Serialize};
use statrs::distribution::{Binomial, DiscreteCDF};

use super::law_metrics::law_metrics;
use super::row::Row;
use super::settle::{After, Settled};
use crate::conceal::{Hiding, Rig};
use crate::diagnose::Verdict;

/// A share of cases, with what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metric {
    pub key: String,
    pub what: String,
    /// In words: `>= 95 %`.
    pub target: String,
    pub value: f64,
    /// 95 % interval (Wilson's, or of a mean).
    pub interval: [f64; 2],
    pub cases: usize,
    pub is_met: bool,
}

/// Misfit per sample from which a mismatch counts as there.
pub const VISIBLE: f64 = 0.1;

/// Which way a figure should go.
#[derive(Clone, Copy)]
pub(super) enum Goal {
    AtLeast(f64),
    AtMost(f64),
}

impl Goal {
    fn words(self, percent: bool) -> String {
        let (sign, value) = match self {
            Self::AtLeast(v) => (">=", v),
            Self::AtMost(v) => ("<=", v),
        };
        if percent { format!("{sign} {:.0} %", 100.0 * value) } else { format!("{sign} {value}") }
    }

    fn is_met(self, value: f64) -> bool {
        match self {
            Self::AtLeast(v) => value >= v,
            Self::AtMost(v) => value <= v,
        }
    }
}

/// All figures, in the order of the table.
///
/// ```
/// use smam::conceal::{Hiding, Rig};
/// use smam::diagnose::Verdict;
/// use smam::proof::{Row, metrics};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // Two hundred benches that hide nothing; of one it was said that something is missing.
/// let quiet = |i: usize| Row {
///     name: format!("s1_{i:05}"),
///     rig: Rig::MuscleBench,
///     hiding: Hiding::Nothing,
///     verdict: if i == 0 { Verdict::MissingPhysics } else { Verdict::Adequate },
///     seconds: Some(9.0),
/// #   secrets: Vec::new(),
/// #   is_noise_coloured: false,
/// #   is_noise_stated: true,
/// #   decoys: Vec::new(),
/// #   element: None,
/// #   effects: Vec::new(),
/// #   excess: 0.0,
/// #   gap_closed: None,
/// #   law: None,
/// #   settled: None,
/// #   decided: None,
///     // ...
/// };
/// let rows: Vec<Row> = (0..200).map(quiet).collect();
/// let figures = metrics(&rows);
/// let alarms = figures.iter().find(|m| m.key == "false_alarms").ok_or("it is a figure")?;
/// // Half a percent is within the target of one; two hundred cases do not show it yet.
/// assert_eq!((alarms.value, alarms.is_met), (0.005, true));
/// assert!(alarms.interval[1] > 0.01);
/// # Ok(())
/// # }
/// ```
pub fn metrics(rows: &[Row]) -> Vec<Metric> {
    let nothing = select(rows, |r| r.hiding == Hiding::Nothing);
    let visible = select(rows, |r| r.hiding != Hiding::Nothing && r.excess >= VISIBLE);
    let one = select(rows, |r| r.hiding == Hiding::One && r.excess >= VISIBLE && r.is_detected());
    let mut all = vec![
        share(
            ("false_alarms", "false alarms where nothing is missing"),
            &nothing,
            Row::is_detected,
            Goal::AtMost(0.01),
        ),
        share(("detection", "detected at excess chi2/n >= 0.1"), &visible, Row::is_detected, Goal::AtLeast(0.98)),
    ];
    all.extend(naming(rows, &one));
    all.extend(unknown(rows));
    let listed = select(rows, |r| matches!(r.hiding, Hiding::One | Hiding::Several));
    all.extend(gaps(&listed));
    all.extend(settled(rows));
    let wrong = ("confidently_wrong", "an effect named with > 0.9 that is not there");
    all.push(share(wrong, &select(rows, |_| true), Row::is_confidently_wrong, Goal::AtMost(0.02)));
    all.push(sizes(&one));
    all.push(times(rows));
    let laws = law_metrics(rows);
    let has_others = rows.iter().any(|r| !matches!(r.hiding, Hiding::Law | Hiding::Laws));
    if has_others { all.into_iter().chain(laws).collect() } else { laws }
}

pub(super) fn select(rows: &[Row], is: impl Fn(&Row) -> bool) -> Vec<&Row> {
    rows.iter().filter(|r| is(r)).collect()
}

/// Where and what, of one effect that was detected; then sets.
fn naming(rows: &[Row], one: &[&Row]) -> Vec<Metric> {
    let is_altered = |r: &Row| r.is_noise_coloured || r.secrets.iter().any(|s| s.is_altered);
    let altered: Vec<&Row> = one.iter().copied().filter(|r| is_altered(r)).collect();
    let several = select(rows, |r| r.hiding == Hiding::Several && r.excess >= VISIBLE);
    let sets: Vec<&Row> = one.iter().copied().filter(|r| !is_unknown(r)).collect();
    let is_effect = |r: &Row| r.first().is_some_and(|e| r.secrets.iter().any(|s| e.is(s)));
    let is_element = |r: &Row| r.secrets.iter().any(|s| r.element.as_deref() == Some(s.element.as_str()));
    let altered_words = ("effect_altered", "the same with altered form or coloured noise");
    vec![
        mean_probability(one),
        share(("element", "element right (one effect, detected)"), one, is_element, Goal::AtLeast(0.95)),
        share(("effect", "effect right (one effect, detected)"), one, is_effect, Goal::AtLeast(0.95)),
        share(altered_words, &altered, is_effect, Goal::AtLeast(0.9)),
        share(("exact_set", "exact set (two effects or three, visible)"), &several, is_exact, Goal::AtLeast(0.85)),
        share(("coverage", "truth in the set that is answered"), &sets, holds_truth, Goal::AtLeast(0.95)),
        mean_set(&sets),
    ]
}

fn unknown(rows: &[Row]) -> [Metric; 2] {
    let unlisted = select(rows, |r| r.hiding == Hiding::Unlisted && r.excess >= VISIBLE);
    let listed = select(rows, |r| matches!(r.hiding, Hiding::One | Hiding::Several));
    [
        share(("unknown_recall", "'unknown' said of what is not listed"), &unlisted, is_unknown, Goal::AtLeast(0.9)),
        share(("unknown_false", "'unknown' said of what is listed"), &listed, is_unknown, Goal::AtMost(0.05)),
    ]
}

fn is_unknown(r: &Row) -> bool {
    r.verdict == Verdict::UnknownPhysics
}

/// Each secret named and nothing else. Of an ambiguous answer the most probable one for each.
fn is_exact(r: &Row) -> bool {
    let named: Vec<_> = r.effects.iter().filter(|e| e.probability > 0.5).collect();
    r.secrets.len() == named.len() && r.secrets.iter().all(|s| named.iter().any(|e| e.is(s)))
}

fn holds_truth(r: &Row) -> bool {
    r.secrets.iter().all(|s| r.effects.iter().any(|e| e.is(s)))
}

/// A figure by key and words.
fn figure(
    (key, what): (&str, &str),
    value: f64,
    interval: [f64; 2],
    cases: usize,
    target: String,
    goal: Goal,
) -> Metric {
    Metric { key: key.to_owned(), what: what.to_owned(), target, value, interval, cases, is_met: goal.is_met(value) }
}

pub(super) fn share(names: (&str, &str), rows: &[&Row], is: impl Fn(&Row) -> bool, goal: Goal) -> Metric {
    let (count, hits) = (rows.len(), rows.iter().filter(|r| is(r)).count());
    figure(names, hits as f64 / count as f64, wilson(hits, count), count, goal.words(true), goal)
}

/// Wilson's 95 % interval of a share.
pub fn wilson(hits: usize, count: usize) -> [f64; 2] {
    if count == 0 {
        return [0.0, 1.0];
    }
    let (n, z) = (count as f64, 1.96);
    let p = hits as f64 / n;
    let middle = p + z * z / (2.0 * n);
    let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let over = 1.0 + z * z / n;
    [((middle - half) / over).max(0.0), ((middle + half) / over).min(1.0)]
}

/// Probability, both sides, of a split as uneven as this or more, were either side as likely in every pair.
pub(super) fn sign_test(a: usize, b: usize) -> f64 {
    let least = a.min(b) as u64;
    let below = Binomial::new(0.5, (a + b) as u64).map_or(1.0, |fair| fair.cdf(least));
    (2.0 * below).min(1.0)
}

/// A mean with the normal interval of its error.
fn mean(names: (&str, &str), values: &[f64], goal: Goal, percent: bool) -> Metric {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    let half = 1.96 * (variance / n).sqrt();
    // A mean of shares is no greater than 1.
    let most = if percent { 1.0 } else { f64::INFINITY };
    figure(names, mean, [mean - half, (mean + half).min(most)], values.len(), goal.words(percent), goal)
}

fn mean_probability(one: &[&Row]) -> Metric {
    let of_truth = |r: &&Row| r.secrets.first().map_or(0.0, |s| r.probability_of(s));
    let values: Vec<f64> = one.iter().map(of_truth).collect();
    mean(("probability", "mean probability on the truth (one effect, detected)"), &values, Goal::AtLeast(0.9), true)
}

fn mean_set(sets: &[&Row]) -> Metric {
    let values: Vec<f64> = sets.iter().map(|r| r.effects.len() as f64).collect();
    mean(("set_size", "mean size of that set"), &values, Goal::AtMost(1.5), false)
}

/// Median and tenth percentile of the gap closed where something listed is hidden (what is not listed no scene can hold), with the order statistics that bound them at 95 %.
fn gaps(listed: &[&Row]) -> [Metric; 2] {
    let values: Vec<f64> =
        listed.iter().filter(|r| r.is_detected() && r.excess >= VISIBLE).filter_map(|r| r.gap_closed).collect();
    [
        order(("gap_median", "gap closed on what was kept back, median"), &values, 0.5, Goal::AtLeast(0.95)),
        order(("gap_tenth", "gap closed on what was kept back, 10th percentile"), &values, 0.1, Goal::AtLeast(0.8)),
    ]
}

/// A quantile, with the order statistics that bound it at 95 %.
pub(super) fn order(names: (&str, &str), values: &[f64], q: f64, goal: Goal) -> Metric {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let count = values.len();
    let at = |q: f64| values.get(((count.max(1) - 1) as f64 * q.clamp(0.0, 1.0)) as usize).copied().unwrap_or(f64::NAN);
    let half = 1.96 * (q * (1.0 - q) / count.max(1) as f64).sqrt();
    figure(names, at(q), [at(q - half), at(q + half)], count, goal.words(true), goal)
}

/// Ambiguous answers that one more run settles rightly: the proposed one, one drawn, and the proposed one without the
/// sensor that it may ask for.
fn settled(rows: &[Row]) -> [Metric; 3] {
    let tried = select(rows, |r| r.settled.is_some());
    let by = |after: fn(&Settled) -> &After| move |r: &Row| r.settled.as_ref().is_some_and(|s| after(s).is_right);
    let none = Goal::AtLeast(0.0);
    [
        share(
            ("settled", "ambiguous, settled by the proposed experiment"),
            &tried,
            by(Settled::as_proposed),
            Goal::AtLeast(0.8),
        ),
        share(("settled_random", "the same with a random programme"), &tried, by(Settled::as_drawn), none),
        share(
            ("settled_programme", "the same without the sensor that is asked for"),
            &tried,
            by(|s| &s.proposed),
            none,
        ),
    ]
}

/// Whether true sizes lie in the intervals given for them; laws of altered form have no size of the catalogue's.
fn sizes(one: &[&Row]) -> Metric {
    let interval = |r: &Row| -> Option<([f64; 3], f64)> {
        let secret = r.secrets.first()?;
        let size = r.effects.iter().filter(|e| e.is(secret)).find_map(|e| e.size)?;
        Some((size, secret.size))
    };
    let has_size = |r: &Row| r.secrets.iter().all(|s| !s.is_altered) && interval(r).is_some();
    let own: Vec<&Row> = one.iter().copied().filter(|r| has_size(r)).collect();
    let covers = |r: &Row| interval(r).is_some_and(|(s, truth)| (s[1]..=s[2]).contains(&truth));
    share(("size_coverage", "true size in its 95 % interval (own form)"), &own, covers, Goal::AtLeast(0.9))
}

fn times(rows: &[Row]) -> Metric {
    let bench = select(rows, |r| r.rig == Rig::MuscleBench && r.seconds.is_some());
    let in_time = |r: &Row| r.seconds.is_some_and(|s| s <= 30.0);
    share(("time", "bench cases answered within 30 s"), &bench, in_time, Goal::AtLeast(0.95))
}

#[cfg(test)]
mod tests {
    use super::{sign_test, wilson};

    #[test]
    fn nine_of_ten_pairs_are_no_chance() {
        assert!((sign_test(9, 1) - 22.0 / 1024.0).abs() < 1e-12);
        assert_eq!((sign_test(0, 0), sign_test(3, 3)), (1.0, 1.0));
    }

    #[test]
    fn an_interval_of_none_of_three_hundred_ends_near_one_percent() {
        let [from, to] = wilson(0, 300);
        assert!(from == 0.0 && (0.011..0.014).contains(&to), "{to}");
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
