//! A proof as a page of Markdown.

use std::fmt::Write as _;

use super::curves::{detection, naming, reliability};
use super::decide::{Decided, Step};
use super::metrics::{Metric, VISIBLE, sign_test, wilson};
use super::row::Row;
use crate::conceal::{Hiding, Secret};
use crate::diagnose::Verdict;

/// Table of the figures, results by misfit, reliability, and every wrong answer.
pub fn page(rows: &[Row], metrics: &[Metric]) -> String {
    let mut text = String::from("| figure | target | reached | 95 % interval | cases | |\n|---|---|---|---|---|---|\n");
    for m in metrics {
        let number = |v: f64| said(m, v);
        let mark = if m.cases == 0 {
            "none"
        } else if m.is_met {
            "met"
        } else {
            "**not met**"
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} to {} | {} | {mark} |",
            m.what,
            m.target,
            number(m.value),
            number(m.interval[0]),
            number(m.interval[1]),
            m.cases
        );
    }
    by_misfit(&mut text, rows);
    by_effect(&mut text, rows);
    drawn_laws(&mut text, rows);
    further_runs(&mut text, rows);
    reliability_table(&mut text, rows);
    wrong(&mut text, rows);
    text
}

/// A figure as the table prints it: of no case there is none.
fn said(m: &Metric, v: f64) -> String {
    match m.key.as_str() {
        _ if !v.is_finite() => "-".to_owned(),
        "set_size" => format!("{v:.2}"),
        _ => format!("{:.1} %", 100.0 * v),
    }
}

fn by_misfit(text: &mut String, rows: &[Row]) {
    text.push_str("\n### By misfit per sample after the baseline's refit\n\n");
    text.push_str(
        "| excess chi2/n | cases with something missing | detected | one effect: right |\n|---|---|---|---|\n",
    );
    for (all, one) in detection(rows).iter().zip(naming(rows)) {
        let name =
            if all.to.is_finite() { format!("{} to {}", all.from, all.to) } else { format!("above {}", all.from) };
        let _ =
            writeln!(text, "| {name} | {} | {} | {} |", all.count, of(all.hits, all.count), of(one.hits, one.count));
    }
}

fn of(hits: usize, count: usize) -> String {
    if count == 0 {
        return "-".to_owned();
    }
    let [from, to] = wilson(hits, count);
    format!("{hits}/{count} ({:.0} to {:.0} %)", 100.0 * from, 100.0 * to)
}

fn by_effect(text: &mut String, rows: &[Row]) {
    text.push_str("\n### By what was hidden, alone (visible cases)\n\n| hidden | cases | detected | named | said to be unknown |\n|---|---|---|---|---|\n");
    let alone = |r: &&Row| matches!(r.hiding, Hiding::One | Hiding::Unlisted) && r.excess >= VISIBLE;
    let mut names: Vec<&str> = rows.iter().filter(alone).flat_map(|r| &r.secrets).map(|s| s.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let own: Vec<&Row> = rows.iter().filter(alone).filter(|r| r.secrets[0].name == name).collect();
        let count = |is: &dyn Fn(&Row) -> bool| own.iter().filter(|r| is(r)).count();
        let named = count(&|r| r.first().is_some_and(|e| e.is(&r.secrets[0])));
        let unknown = count(&|r| r.verdict == Verdict::UnknownPhysics);
        let listed = if own[0].secrets[0].in_catalogue { "" } else { " (not listed)" };
        let _ =
            writeln!(text, "| {name}{listed} | {} | {} | {named} | {unknown} |", own.len(), count(&Row::is_detected));
    }
}

fn reliability_table(text: &mut String, rows: &[Row]) {
    text.push_str("\n### Reliability: probability given against share that was right\n\n| probability | effects named | right |\n|---|---|---|\n");
    for bin in reliability(rows) {
        let _ = writeln!(text, "| {} to {:.2} | {} | {} |", bin.from, bin.to, bin.count, of(bin.hits, bin.count));
    }
}

fn wrong(text: &mut String, rows: &[Row]) {
    text.push_str("\n### Answers that are wrong\n\n| case | hidden | excess | answer |\n|---|---|---|---|\n");
    for r in rows.iter().filter(|r| is_wrong(r)) {
        let hidden: Vec<String> = r.secrets.iter().map(secret_words).collect();
        let named: Vec<String> = r
            .effects
            .iter()
            .map(|e| format!("{} {} {:.2}", e.name, place(&e.element, &e.channel), e.probability))
            .collect();
        let verdict = format!("{:?}", r.verdict);
        let _ = writeln!(
            text,
            "| {} {} | {} | {:.3} | {verdict}: {} |",
            r.name,
            r.rig.scene(),
            hidden.join(", "),
            r.excess,
            named.join(", ")
        );
    }
}

/// A false alarm, something visible that was missed, or something named that is not there and nothing that is.
fn is_wrong(r: &Row) -> bool {
    match r.hiding {
        Hiding::Nothing => r.is_detected(),
        _ if r.excess >= VISIBLE && !r.is_detected() => true,
        Hiding::Unlisted => r.is_confidently_wrong(),
        Hiding::One => r.is_detected() && !r.first().is_some_and(|e| e.is(&r.secrets[0])),
        Hiding::Several => r.is_confidently_wrong(),
        Hiding::Law | Hiding::Laws => r.is_confidently_wrong(),
    }
}

/// Every law that nobody chose, with what was found of it.
fn drawn_laws(text: &mut String, rows: &[Row]) {
    if rows.iter().all(|r| r.law.is_none()) {
        return;
    }
    text.push_str(
        "\n### Laws that nobody chose\n\n| case | excess | hidden | answered | place | both | curve | gap | larger | s |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (r, law) in rows.iter().filter_map(|r| Some((r, r.law.as_ref()?))) {
        let rank = |rank: Option<usize>| rank.map_or("-".to_owned(), |n| n.to_string());
        let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.3}"));
        let _ = writeln!(
            text,
            "| {} {} | {:.2} | `{}` | {:?}: {} | {} | {} | {} | {} | {} | {} |",
            r.name,
            r.rig.scene(),
            r.excess,
            law.hidden,
            r.verdict,
            law.answered.as_ref().map_or("nothing".to_owned(), |a| format!("`{a}`")),
            rank(law.port_rank),
            rank(law.rank),
            number(law.curve_error),
            number(r.gap_closed),
            number(law.gap_larger),
            r.seconds.map_or("-".to_owned(), |s| format!("{s:.0}"))
        );
    }
}

/// What runs that answers proposed made of places that were open, beside drawn ones.
fn further_runs(text: &mut String, rows: &[Row]) {
    let tried: Vec<(&Row, &Decided)> = rows.iter().filter_map(|r| Some((r, r.decided.as_ref()?))).collect();
    if tried.is_empty() {
        return;
    }
    text.push_str(
        "\n### Further runs where the place of a law was open\n\n\
         | case | promised, sigma | sensor | proposed | drawn |\n|---|---|---|---|---|\n",
    );
    let words = |steps: &[Step]| -> String {
        let one = |s: &Step| {
            let mark = if s.is_right { "right" } else { "not" };
            format!("{:.0} s: {mark} (`{}` {:.2})", s.added_s, s.port, s.probability)
        };
        steps.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    for (r, d) in &tried {
        let sensor = d.proposed.first().and_then(|s| s.sensor.as_deref()).unwrap_or("-");
        let (proposed, drawn) = (words(&d.proposed), words(&d.drawn));
        let _ = writeln!(text, "| {} | {:.1} | {sensor} | {proposed} | {drawn} |", r.name, d.promised_sigma);
    }
    let minutes = |which: usize| tried.iter().map(|(_, d)| d.rig_s()[which]).sum::<f64>() / 60.0;
    let only =
        |which: usize| tried.iter().filter(|(_, d)| d.is_decided(2)[which] && !d.is_decided(2)[1 - which]).count();
    let (ours, theirs) = (only(0), only(1));
    let _ = writeln!(
        text,
        "\nMinutes on the rig until decided or given up: {:.0} as proposed, {:.0} drawn. Decided by the proposed runs alone: {ours}, \
         by the drawn ones alone: {theirs} (sign test, p = {:.3}).",
        minutes(0),
        minutes(1),
        sign_test(ours, theirs)
    );
}

fn secret_words(s: &Secret) -> String {
    let form = if s.is_altered { ", altered" } else { "" };
    format!("{} {} {:.2e}{form}", s.name, place(&s.element, &s.channel), s.size)
}

fn place(element: &str, channel: &Option<String>) -> String {
    channel.clone().unwrap_or_else(|| element.to_owned())
}
