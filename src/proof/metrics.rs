//! The figures of a proof.

use serde::{Deserialize, Serialize};

use super::row::Row;
use crate::conceal::Hiding;
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
enum Goal {
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
pub fn metrics(rows: &[Row]) -> Vec<Metric> {
    let of = |hiding: Hiding| rows.iter().filter(move |r| r.hiding == hiding);
    let visible = |r: &&Row| r.excess >= VISIBLE;
    let hides: Vec<&Row> = rows.iter().filter(|r| r.hiding != Hiding::Nothing).collect();
    let one: Vec<&Row> = of(Hiding::One).filter(visible).filter(|r| r.is_detected()).collect();
    let altered = |r: &&&Row| r.is_noise_coloured || r.secrets.iter().any(|s| s.is_altered);
    let several: Vec<&Row> = of(Hiding::Several).filter(visible).collect();
    let listed: Vec<&Row> = rows.iter().filter(|r| matches!(r.hiding, Hiding::One | Hiding::Several)).collect();
    let unlisted: Vec<&Row> = of(Hiding::Unlisted).filter(visible).collect();
    let sets: Vec<&Row> = one.iter().copied().filter(|r| r.verdict != Verdict::UnknownPhysics).collect();
    let is_hidden_effect = |r: &Row| r.first().is_some_and(|e| r.secrets.iter().any(|s| e.is(s)));
    let is_element = |r: &Row| r.secrets.iter().any(|s| r.element.as_deref() == Some(s.element.as_str()));
    let mut all = vec![
        share(
            "false_alarms",
            "false alarms where nothing is missing",
            of(Hiding::Nothing),
            Row::is_detected,
            Goal::AtMost(0.01),
        ),
        share(
            "detection",
            "detected at excess chi2/n >= 0.1",
            hides.iter().copied().filter(visible),
            Row::is_detected,
            Goal::AtLeast(0.98),
        ),
        mean_probability(&one),
        share("element", "element right (one effect, detected)", one.iter().copied(), is_element, Goal::AtLeast(0.95)),
        share(
            "effect",
            "effect right (one effect, detected)",
            one.iter().copied(),
            is_hidden_effect,
            Goal::AtLeast(0.95),
        ),
        share(
            "effect_altered",
            "the same with altered form or coloured noise",
            one.iter().filter(altered).copied(),
            is_hidden_effect,
            Goal::AtLeast(0.9),
        ),
        share(
            "exact_set",
            "exact set (two effects or three, visible)",
            several.iter().copied(),
            is_exact,
            Goal::AtLeast(0.85),
        ),
        share("coverage", "truth in the set that is answered", sets.iter().copied(), holds_truth, Goal::AtLeast(0.95)),
        mean_set(&sets),
        share(
            "unknown_recall",
            "'unknown' said of what is not listed",
            unlisted.iter().copied(),
            is_unknown,
            Goal::AtLeast(0.9),
        ),
        share(
            "unknown_false",
            "'unknown' said of what is listed",
            listed.iter().copied(),
            is_unknown,
            Goal::AtMost(0.05),
        ),
    ];
    all.extend(gaps(&hides));
    all.push(share(
        "confidently_wrong",
        "an effect named with > 0.9 that is not there",
        rows.iter(),
        Row::is_confidently_wrong,
        Goal::AtMost(0.02),
    ));
    all.push(sizes(&one));
    all.push(times(rows));
    all
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

fn share<'a>(
    key: &str,
    what: &str,
    rows: impl Iterator<Item = &'a Row>,
    is: impl Fn(&Row) -> bool,
    goal: Goal,
) -> Metric {
    let of: Vec<bool> = rows.map(is).collect();
    let (count, hits) = (of.len(), of.iter().filter(|h| **h).count());
    let value = hits as f64 / count as f64;
    Metric {
        key: key.to_owned(),
        what: what.to_owned(),
        target: goal.words(true),
        value,
        interval: wilson(hits, count),
        cases: count,
        is_met: goal.is_met(value),
    }
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

fn mean_metric(key: &str, what: &str, values: &[f64], goal: Goal, percent: bool) -> Metric {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    let half = 1.96 * (variance / n).sqrt();
    Metric {
        key: key.to_owned(),
        what: what.to_owned(),
        target: goal.words(percent),
        value: mean,
        interval: [mean - half, mean + half],
        cases: values.len(),
        is_met: goal.is_met(mean),
    }
}

fn mean_probability(one: &[&Row]) -> Metric {
    let of_truth = |r: &&Row| r.secrets.first().map_or(0.0, |s| r.probability_of(s));
    let values: Vec<f64> = one.iter().map(of_truth).collect();
    mean_metric(
        "probability",
        "mean probability on the truth (one effect, detected)",
        &values,
        Goal::AtLeast(0.9),
        true,
    )
}

fn mean_set(sets: &[&Row]) -> Metric {
    let values: Vec<f64> = sets.iter().map(|r| r.effects.len() as f64).collect();
    mean_metric("set_size", "mean size of that set", &values, Goal::AtMost(1.5), false)
}

/// Median and tenth percentile of the gap closed, with the order statistics that bound them at 95 %.
fn gaps(hides: &[&Row]) -> [Metric; 2] {
    let mut values: Vec<f64> =
        hides.iter().filter(|r| r.is_detected() && r.excess >= VISIBLE).filter_map(|r| r.gap_closed).collect();
    values.sort_by(f64::total_cmp);
    let at = |q: f64| values.get(((values.len().max(1) - 1) as f64 * q.clamp(0.0, 1.0)) as usize).copied();
    let one = |key: &str, what: &str, q: f64, goal: Goal| {
        let half = 1.96 * (q * (1.0 - q) / values.len().max(1) as f64).sqrt();
        let value = at(q).unwrap_or(f64::NAN);
        Metric {
            key: key.to_owned(),
            what: what.to_owned(),
            target: goal.words(true),
            value,
            interval: [at(q - half).unwrap_or(f64::NAN), at(q + half).unwrap_or(f64::NAN)],
            cases: values.len(),
            is_met: goal.is_met(value),
        }
    };
    [
        one("gap_median", "gap closed on what was kept back, median", 0.5, Goal::AtLeast(0.95)),
        one("gap_tenth", "gap closed on what was kept back, 10th percentile", 0.1, Goal::AtLeast(0.8)),
    ]
}

/// Whether true sizes lie in their intervals; laws of altered form have no size of the catalogue's.
fn sizes(one: &[&Row]) -> Metric {
    let of = |r: &&&Row| r.secrets.iter().all(|s| !s.is_altered) && r.effects.iter().any(|e| e.size.is_some());
    let covers = |r: &Row| {
        let secret = r.secrets.first();
        r.effects.iter().filter_map(|e| e.size).any(|s| secret.is_some_and(|t| (s[1]..=s[2]).contains(&t.size)))
    };
    share(
        "size_coverage",
        "true size in its 95 % interval (own form)",
        one.iter().filter(of).copied(),
        covers,
        Goal::AtLeast(0.9),
    )
}

fn times(rows: &[Row]) -> Metric {
    let bench = rows.iter().filter(|r| r.rig == crate::conceal::Rig::MuscleBench);
    share("time", "bench cases answered within 30 s", bench, |r| r.seconds <= 30.0, Goal::AtLeast(0.95))
}

#[cfg(test)]
mod tests {
    use super::wilson;

    #[test]
    fn an_interval_of_none_of_three_hundred_ends_near_one_percent() {
        let [from, to] = wilson(0, 300);
        assert!(from == 0.0 && (0.011..0.014).contains(&to), "{to}");
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
