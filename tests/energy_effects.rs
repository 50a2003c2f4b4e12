//! Contract: the energy balance closes with every effect of the catalogue switched on in a full scene.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use smam::effects::{EffectTable, Element, ElementKind, EntryId, catalogue};
use smam::scene::Scene;
use smam::system::Simulation;

const RIGS: [&str; 3] = ["muscle_bench", "antagonistic_pulley", "bending_catheter"];
const DURATION_S: f64 = 10.0;
/// Of the energy turned over, at any time of the run; 4e-7 is reached.
const GREATEST_SHARE: f64 = 1e-5;

/// A rig with an effect at its typical size on the first element of its kind; `None` where it cannot have it.
fn with_effect(rig: &str, spec: EntryId) -> Option<Scene> {
    let stock = Scene::load(rig, &[]).expect("stock");
    let count = if spec.element == ElementKind::Cable { stock.file.cable.len() } else { stock.file.muscle.len() };
    let mut file = stock.file.clone();
    let parameters: BTreeMap<String, f64> =
        spec.parameters.iter().zip(spec.typical()).map(|(p, v)| (p.key.clone(), v)).collect();
    file.effect.push(EffectTable {
        name: spec.name.clone(),
        element: Element::of(spec.element, 0, count).to_string(),
        channel: (spec.element == ElementKind::Sensor).then(|| file.output[0].channel.clone()),
        parameters,
    });
    Scene::from_file(file, &stock.path).ok()
}

/// Lines that an effect must have in the balance of a rig that feels it; none for what only shows things otherwise, for
/// what is geometry, and for friction that belongs to the muscle's own.
const LINES: &[(&str, &[&str])] = &[
    ("trapped_air", &["stored_trapped_air"]),
    ("leak", &["lost_leak"]),
    ("line_restriction", &["lost_line_restriction"]),
    ("thermal_expansion", &["thermal_expansion_work"]),
    ("viscoelasticity", &["stored_relaxation_springs", "lost_relaxation"]),
    ("mullins_softening", &["stored_softened_wall", "lost_softening"]),
    ("coil_preload", &["stored_coil_preload"]),
    ("plastic_set", &["lost_plastic_set"]),
    ("gravity_load", &["gravity_load_work"]),
    ("bearing_friction", &["stored_bearing_presliding", "lost_bearing_friction"]),
    ("tendon_friction", &["lost_tendon_friction"]),
    ("tendon_coupling", &["tendon_coupling_work"]),
    ("external_contact", &["stored_contact_walls"]),
];

/// Runs a scene with its balance: the greatest share of the turnover that was ever unaccounted for, and the lines' names.
fn run(scene: Scene) -> (f64, BTreeSet<String>) {
    let mut simulation = Simulation::new(scene).expect("builds");
    simulation.keep_energy_balance();
    let (mut worst_j, mut names) = (0.0_f64, BTreeSet::new());
    for i in 1..=64 {
        simulation.advance_to(DURATION_S * f64::from(i) / 64.0).expect("runs");
        let balance = simulation.energy_balance().expect("kept");
        worst_j = worst_j.max(balance.unaccounted_j().abs());
        names.extend(balance.lines().into_iter().map(|(name, _)| name));
    }
    (worst_j / simulation.energy_balance().expect("kept").turnover_j(), names)
}

/// Every effect on every rig that can have it.
fn cases() -> Vec<(&'static str, EntryId, Scene)> {
    let all = RIGS.iter().flat_map(|rig| catalogue().map(move |spec| (*rig, spec)));
    all.filter_map(|(rig, spec)| Some((rig, spec, with_effect(rig, spec)?))).collect()
}

#[test]
fn val_the_book_closes_with_every_effect() {
    let plain: BTreeSet<String> = RIGS.iter().flat_map(|rig| run(Scene::load(rig, &[]).expect("stock")).1).collect();
    let ran: Vec<_> = cases().into_par_iter().map(|(rig, spec, scene)| (rig, spec, run(scene))).collect();
    for (rig, spec, (share, _)) in &ran {
        println!("{rig:<20} {:<20} {:<26} {share:.1e}", spec.name, spec.parameters[0].key);
        assert!(*share < GREATEST_SHARE, "{rig} with {}: {share:.2e} of the turnover is unaccounted for", spec.name);
    }
    for spec in catalogue() {
        let own = ran.iter().filter(|(_, s, _)| s.name == spec.name).flat_map(|(_, _, (_, names))| names);
        let own: BTreeSet<&str> = own.filter(|n| !plain.contains(*n)).map(String::as_str).collect();
        let wall = if spec.name == "notch_closure" { "external_contact" } else { spec.name.as_str() };
        let expected = LINES.iter().find(|(name, _)| *name == wall).map_or(&[][..], |(_, lines)| lines);
        let of_text = spec.law.as_ref().and_then(|text| text.law.energy.as_deref());
        assert!(
            ran.iter().all(|(_, s, _)| s.name != spec.name) || own == expected.iter().copied().chain(of_text).collect(),
            "{own:?}"
        );
    }
}

/// Softening beside plastic set, air beside a leak: what two effects do to each other is in the balance as well.
#[test]
fn val_the_book_closes_with_all_effects_at_once() {
    for rig in RIGS {
        let stock = Scene::load(rig, &[]).expect("stock");
        let mut file = stock.file.clone();
        file.effect = cases().into_iter().filter(|(r, ..)| *r == rig).map(|(.., s)| s.file.effect[0].clone()).collect();
        let (share, _) = run(Scene::from_file(file, &stock.path).unwrap_or_else(|e| panic!("{e}")));
        println!("{rig:<20} with all of them {share:.1e}");
        assert!(share < GREATEST_SHARE, "{rig}: {share:.2e} of the turnover is unaccounted for");
    }
}

#[test]
fn effects_of_zero_size_leave_the_book_as_it_is() {
    let lines = |scene: Scene| {
        let mut simulation = Simulation::new(scene).expect("builds");
        simulation.keep_energy_balance();
        simulation.advance_to(1.5).expect("runs");
        simulation.energy_balance().expect("kept").lines()
    };
    let plain = RIGS.map(|rig| lines(Scene::load(rig, &[]).expect("stock")));
    cases().into_par_iter().for_each(|(rig, spec, mut scene)| {
        scene.file.effect[0].parameters.insert(spec.parameters[0].key.clone(), 0.0);
        let stock = &plain[RIGS.iter().position(|r| *r == rig).expect("a rig")];
        assert_eq!(&lines(scene), stock, "{rig} with {} of zero size", spec.name);
    });
}
