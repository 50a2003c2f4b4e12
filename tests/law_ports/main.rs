//! Contract: at every port a law does what is known by hand, in the full scene and in the reduced-order model, and the energy balance knows it.

mod cases;
mod drive;
mod effects;
mod energy;
mod memory;
mod rig;
mod several;
mod soup;

use cases::{CASES, Case, Truth};
use rayon::prelude::*;
use rig::{BOTH, Model, distance, run, scene};
use smam::laws::PORTS;

/// A law that changes less than this share of every channel's range would be none.
const LEAST: f64 = 1e-5;
const UNTIL_S: f64 = 2.5;

/// What is wrong with a case in a model; nothing, else.
fn wrong(case: &Case, model: Model) -> Option<String> {
    let stock = run(model, &scene(case.rig, case.sets, &[]), UNTIL_S);
    let law = run(model, &scene(case.rig, case.sets, case.laws), UNTIL_S);
    let moved = distance(&law, &stock, &[]);
    if moved < LEAST {
        return Some(format!("{:?} in {}: the law does nothing ({moved:.1e})", case.laws, case.rig));
    }
    match case.truth {
        Truth::Holds(check) => {
            let held = std::panic::catch_unwind(|| check(&law, &stock));
            held.err().map(|e| format!("{:?} in {}, {model:?}: {:?}", case.laws, case.rig, e.downcast_ref::<String>()))
        }
        Truth::Same(truth) => {
            let sets: Vec<&str> = case.sets.iter().chain(truth).copied().collect();
            let far = distance(&law, &run(model, &scene(case.rig, &sets, &[]), UNTIL_S), case.but_for);
            println!("{model:?} {:<20} {:?} {far:.1e} of the range, {moved:.1e} from stock", case.rig, case.laws);
            (far > case.within).then(|| format!("{:?} in {}, {model:?}: {far:.2e}", case.laws, case.rig))
        }
    }
}

#[test]
fn val_laws_do_at_their_ports_what_is_known_by_hand() {
    let all: Vec<(&Case, Model)> = CASES.iter().flat_map(|case| BOTH.map(|model| (case, model))).collect();
    let wrong: Vec<String> = all.into_par_iter().filter_map(|(case, model)| wrong(case, model)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_port_has_a_case() {
    for spec in &PORTS {
        assert!(CASES.iter().any(|case| case.port == spec.port), "{} has no case in cases.rs", spec.name());
    }
}
