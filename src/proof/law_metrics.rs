//! Figures of laws that nobody chose.

use super::found_law::FoundLaw;
use super::metrics::{Goal, Metric, VISIBLE, order, select, share};
use super::row::Row;
use crate::conceal::{Hiding, Rig};

/// Relative distance within which a curve is right.
const CURVE: f64 = 0.1;
/// Forms among which the truth may stand.
const SET: usize = 3;
/// By so much of the gap a scene must be worse than the calibrated one to be called so.
const WORSE: f64 = 0.02;

/// Figures over the rows that hide drawn laws; none where there are none.
pub(super) fn law_metrics(rows: &[Row]) -> Vec<Metric> {
    let all = select(rows, |r| matches!(r.hiding, Hiding::Law | Hiding::Laws));
    if all.is_empty() {
        return Vec::new();
    }
    let visible: Vec<&Row> = all.iter().copied().filter(|r| r.excess >= VISIBLE).collect();
    let one: Vec<&Row> = visible.iter().copied().filter(|r| r.hiding == Hiding::Law && r.is_detected()).collect();
    let law = |r: &Row, is: fn(&FoundLaw) -> bool| r.law.as_ref().is_some_and(is);
    let is_element = |r: &Row| r.element.as_deref() == r.secrets.first().map(|s| s.element.as_str());
    let within = |rank: Option<usize>, most: usize| rank.is_some_and(|n| n <= most);
    let names = |key, what| (key, what);
    let mut figures = vec![
        share(
            names("law_detection", "drawn laws detected at excess chi2/n >= 0.1"),
            &visible,
            Row::is_detected,
            Goal::AtLeast(0.98),
        ),
        share(names("law_element", "element right (one law, detected)"), &one, is_element, Goal::AtLeast(0.95)),
        share(
            names("law_port", "port right, first or in a set of three"),
            &one,
            |r| r.law.as_ref().is_some_and(|l| within(l.port_rank, SET)),
            Goal::AtLeast(0.85),
        ),
        share(
            names("law_first", "port and variable right, first"),
            &one,
            |r| r.law.as_ref().is_some_and(|l| within(l.rank, 1)),
            Goal::AtLeast(0.6),
        ),
        share(
            names("law_set", "port and variable right, in a set of three"),
            &one,
            |r| r.law.as_ref().is_some_and(|l| within(l.rank, SET)),
            Goal::AtLeast(0.8),
        ),
    ];
    let drawn: Vec<&Row> = one.iter().copied().filter(|r| law(r, |l| l.curve_error.is_some())).collect();
    figures.push(share(
        names("law_curve", "curve within 10 % where port and variable are right"),
        &drawn,
        |r| law(r, |l| l.curve_error.is_some_and(|e| e <= CURVE)),
        Goal::AtLeast(0.6),
    ));
    figures.push(share(
        names("law_curve_beyond", "the same over one and a half times the range"),
        &drawn,
        |r| law(r, |l| l.curve_error_beyond.is_some_and(|e| e <= CURVE)),
        Goal::AtLeast(0.6),
    ));
    let gaps = |of: &dyn Fn(&Row) -> Option<f64>| -> Vec<f64> {
        visible.iter().filter(|r| r.is_detected()).filter_map(|r| of(r)).collect()
    };
    let (same, larger) = (gaps(&|r| r.gap_closed), gaps(&|r| r.law.as_ref()?.gap_larger));
    figures.push(order(
        names("law_gap_median", "gap closed on what was kept back, median"),
        &same,
        0.5,
        Goal::AtLeast(0.97),
    ));
    figures.push(order(names("law_gap_tenth", "the same, 10th percentile"), &same, 0.1, Goal::AtLeast(0.8)));
    figures.push(order(
        names("law_gap_larger", "the same with 1.5 times the stroke, median"),
        &larger,
        0.5,
        Goal::AtLeast(0.9),
    ));
    figures.push(share(
        names("law_worse", "corrected worse than calibrated on what was kept back"),
        &all,
        |r| r.gap_closed.is_some_and(|g| g < -WORSE),
        Goal::AtMost(0.0),
    ));
    figures.push(share(
        names("law_certain", "certain (> 0.9) of what is not there"),
        &all,
        is_certainly_wrong,
        Goal::AtMost(0.02),
    ));
    figures.push(share(
        names("law_time", "answered within 30 s (bench), 90 s (others)"),
        &all,
        in_time,
        Goal::AtLeast(0.95),
    ));
    figures
}

/// Whether anything is named with certainty where neither it nor a form beside it is at the law's port, and no effect that was hidden.
fn is_certainly_wrong(r: &Row) -> bool {
    let is_found = r.law.as_ref().is_some_and(|l| l.port_rank.is_some());
    let is_hidden = |e: &super::Answered| r.secrets.iter().any(|s| e.is(s));
    r.is_detected() && !is_found && r.effects.iter().any(|e| e.probability > 0.9 && !is_hidden(e))
}

fn in_time(r: &Row) -> bool {
    let most_s = if r.rig == Rig::MuscleBench { 30.0 } else { 90.0 };
    r.seconds.is_some_and(|s| s <= most_s)
}
