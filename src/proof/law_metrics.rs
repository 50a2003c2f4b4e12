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
    let detected = ("law_detection", "drawn laws detected at excess chi2/n >= 0.1");
    let mut figures = vec![share(detected, &visible, Row::is_detected, Goal::AtLeast(0.98))];
    figures.extend(places(&one));
    figures.extend(forms(&one));
    figures.extend(gaps(&visible));
    figures.extend(harms(&all));
    figures.extend(decided(&all));
    figures
}

/// Places that were open, and what further runs made of them; none where none was tried.
fn decided(all: &[&Row]) -> Vec<Metric> {
    let tried: Vec<&Row> = all.iter().copied().filter(|r| r.decided.is_some()).collect();
    if tried.is_empty() {
        return Vec::new();
    }
    let by = |runs: usize, which: usize| move |r: &Row| r.decided.as_ref().is_some_and(|d| d.is_decided(runs)[which]);
    let goal = Goal::AtLeast;
    let two = ("law_decided", "place open, decided by runs as proposed, up to two");
    let two_drawn = ("law_decided_drawn", "the same by drawn runs");
    vec![
        share(two, &tried, by(2, 0), goal(0.9)),
        share(("law_decided_first", "the same by the first alone"), &tried, by(1, 0), goal(0.0)),
        share(two_drawn, &tried, by(2, 1), goal(0.0)),
    ]
}

/// Whether the answer says where the law acts, and on what it depends.
fn places(one: &[&Row]) -> [Metric; 4] {
    let is_element = |r: &Row| r.element.as_deref() == r.secrets.first().map(|s| s.element.as_str());
    let within = |rank: fn(&FoundLaw) -> Option<usize>, most: usize| {
        move |r: &Row| r.law.as_ref().and_then(rank).is_some_and(|n| n <= most)
    };
    let goal = Goal::AtLeast;
    let port = ("law_port", "port right, first or in a set of three");
    let set = ("law_set", "port and variable right, in a set of three");
    [
        share(("law_element", "element right (one law, detected)"), one, is_element, goal(0.95)),
        share(port, one, within(|l| l.port_rank, SET), goal(0.85)),
        share(("law_first", "port and variable right, first"), one, within(|l| l.rank, 1), goal(0.6)),
        share(set, one, within(|l| l.rank, SET), goal(0.8)),
    ]
}

/// How near its curve is, where port and variable are right.
fn forms(one: &[&Row]) -> [Metric; 2] {
    let error = |of: fn(&FoundLaw) -> Option<f64>| move |r: &Row| r.law.as_ref().and_then(of);
    let near = |of: fn(&FoundLaw) -> Option<f64>| move |r: &Row| error(of)(r).is_some_and(|e| e <= CURVE);
    let drawn: Vec<&Row> = one.iter().copied().filter(|r| error(|l| l.curve_error)(r).is_some()).collect();
    let goal = Goal::AtLeast(0.6);
    let curve = ("law_curve", "curve within 10 % where port and variable are right");
    let beyond = ("law_curve_beyond", "the same over one and a half times the range");
    [share(curve, &drawn, near(|l| l.curve_error), goal), share(beyond, &drawn, near(|l| l.curve_error_beyond), goal)]
}

/// What the corrected scene is worth on the recordings kept back.
fn gaps(visible: &[&Row]) -> [Metric; 3] {
    let of = |gap: fn(&Row) -> Option<f64>| -> Vec<f64> {
        visible.iter().filter(|r| r.is_detected()).filter_map(|r| gap(r)).collect()
    };
    let (same, larger) = (of(|r| r.gap_closed), of(|r| r.law.as_ref()?.gap_larger));
    let goal = Goal::AtLeast;
    [
        order(("law_gap_median", "gap closed on what was kept back, median"), &same, 0.5, goal(0.97)),
        order(("law_gap_tenth", "the same, 10th percentile"), &same, 0.1, goal(0.8)),
        order(("law_gap_larger", "the same with 1.5 times the stroke, median"), &larger, 0.5, goal(0.9)),
    ]
}

/// How often it harms, misleads or keeps waiting.
fn harms(all: &[&Row]) -> [Metric; 3] {
    let is_worse = |r: &Row| r.gap_closed.is_some_and(|g| g < -WORSE);
    let worse = ("law_worse", "corrected worse than calibrated on what was kept back");
    let certain = ("law_certain", "certain (> 0.9) of what is not there");
    let time = ("law_time", "answered within 30 s (bench), 90 s (others)");
    [
        share(worse, all, is_worse, Goal::AtMost(0.0)),
        share(certain, all, is_certainly_wrong, Goal::AtMost(0.02)),
        share(time, all, in_time, Goal::AtLeast(0.95)),
    ]
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
