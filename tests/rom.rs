//! Contract of the reduced-order model: it answers like the full scene, with and without effects, and its derivatives are exact.

use num_dual::Dual64;
use smam::effects::{Effect, EffectTable, ElementKind, catalogue};
use smam::recording::Recording;
use smam::scene::{Override, Scene};
use smam::system::{Rom, RomRun, RomSetting, Schedule, Simulation, record};

/// The full scene over its stock programme, and the reduced-order model driven by the same inputs.
fn both(scene: &Scene, duration_s: f64) -> (Recording, Vec<Vec<f64>>, Vec<String>) {
    let schedule = Schedule::even(duration_s, 0.01);
    let mut simulation = Simulation::new(scene.clone()).unwrap_or_else(|e| panic!("{e}"));
    let full = record(&mut simulation, &schedule).unwrap_or_else(|e| panic!("{e}"));
    let inputs = scene.file.input.iter().map(|i| full.si(&i.channel).expect("an input")).collect();
    let run = RomRun { times_s: schedule.times(), inputs, plan: None };
    let rom = Rom::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let effects: Vec<Effect<f64>> = scene.file.effect.iter().map(|t| t.effect().expect("checked")).collect();
    let fast = rom.simulate(&run, &RomSetting { parameters: Vec::new(), effects }).expect("finite");
    let columns = rom.columns().map(str::to_owned).collect();
    (full, fast, columns)
}

/// Root mean square difference of a column in percent of its range, after the start has rung out.
fn difference(full: &[f64], fast: &[f64]) -> f64 {
    let (low, high) = full.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let squares: f64 = full[50..].iter().zip(&fast[50..]).map(|(a, b)| (a - b).powi(2)).sum();
    100.0 * (squares / (full.len() - 50) as f64).sqrt() / (high - low).max(1e-9)
}

const STOCK: [&str; 3] = ["muscle_bench", "antagonistic_pulley", "bending_catheter"];

#[test]
fn val_rom_meets_the_full_scene() {
    for name in STOCK {
        let scene = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
        let (full, fast, columns) = both(&scene, 12.0);
        for (column, fast) in columns.iter().zip(&fast) {
            let percent = difference(&full.find(column).expect("a channel").values, fast);
            println!("{name} {column}: {percent:.4} %");
            assert!(percent < 0.1, "{name}: {column} differs by {percent:.4} % of its range");
        }
    }
}

/// A ball that nothing touches falls beside the catheter and changes nothing of the model; what links may touch needs the engine.
#[test]
fn bodies_count_where_links_may_touch_them() {
    let ball = "mechanism.body=[{name=\"ball\",mass_kg=1e-3,has_weight=true,position_m=[0.0,0.0,1.0],shape={sphere={radius_m=1e-3}}}]";
    let load = |changes: &[&str]| {
        let changes: Vec<Override> = changes.iter().map(|c| Override::parse(c).expect("written rightly")).collect();
        Scene::load("bending_catheter", &changes).unwrap_or_else(|e| panic!("{e}"))
    };
    let (full, fast, columns) = both(&load(&[ball]), 2.0);
    let (without, same, _) = both(&load(&[]), 2.0);
    assert_eq!(fast, same);
    for column in &columns {
        let percent =
            difference(&full.find(column).expect("a channel").values, &without.find(column).expect("a channel").values);
        assert!(percent < 1e-6, "{column}: {percent}");
    }
    let touching = load(&[ball, "mechanism.contact={links=[\"jaw_left_link\"]}"]);
    let refusal = Rom::new(&touching).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(refusal.contains("remedy: remove [mechanism.contact] if they touch nothing while recorded"), "{refusal}");
}

/// The effects of the catalogue that can sit on a scene, at their typical size: one scene text each.
fn with_each_effect(name: &str) -> Vec<(String, Scene)> {
    let stock = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut scenes = Vec::new();
    for spec in catalogue() {
        for element in [spec.element.name().to_owned(), format!("{}_1", spec.element.name())] {
            let mut scene = stock.clone();
            let channel = (spec.element == ElementKind::Sensor).then(|| stock.file.output[0].channel.clone());
            let parameters = spec.parameters.iter().zip(spec.typical()).map(|(p, v)| (p.key.clone(), v)).collect();
            scene.file.effect = vec![EffectTable { name: spec.name.clone(), element, channel, parameters }];
            if let Ok(scene) = Scene::from_file(scene.file, &scene.path) {
                scenes.push((format!("{name} with {}", spec.parameters[0].key), scene));
            }
        }
    }
    scenes
}

#[test]
fn val_rom_meets_the_full_scene_with_every_effect() {
    for name in STOCK {
        let plain = both(&Scene::load(name, &[]).expect("stock"), 8.0).1;
        for (title, scene) in with_each_effect(name) {
            let (full, fast, columns) = both(&scene, 8.0);
            // Notches close beyond what the stock programme reaches.
            let is_reached = !(name == "bending_catheter" && title.ends_with("stiffness_n_m_rad"));
            assert!(!is_reached || fast != plain, "{title}: the effect does nothing");
            for (column, fast) in columns.iter().zip(&fast) {
                let percent = difference(&full.find(column).expect("a channel").values, fast);
                println!("{title}: {column} {percent:.4} %");
                assert!(percent < 0.2, "{title}: {column} differs by {percent:.4} % of its range");
            }
        }
    }
}

#[test]
fn an_effect_of_zero_size_is_absent_to_the_bit() {
    for name in STOCK {
        let stock = Scene::load(name, &[]).expect("stock");
        let (full, fast, _) = both(&stock, 3.0);
        for (title, mut scene) in with_each_effect(name) {
            let key = title.rsplit(' ').next().expect("a key").to_owned();
            scene.file.effect[0].parameters.insert(key, 0.0);
            let scene = Scene::from_file(scene.file, &scene.path).unwrap_or_else(|e| panic!("{e}"));
            let (full_zero, fast_zero, _) = both(&scene, 3.0);
            assert!(full == full_zero, "{title}: the full scene changes");
            assert!(fast == fast_zero, "{title}: the reduced-order model changes");
        }
    }
}

/// On the bench, where nothing goes slack: at the edge of slackness exact derivatives are those of a branch alone.
#[test]
fn sensitivities_are_those_of_finite_differences() {
    for name in ["muscle_bench"] {
        let scene = Scene::load(name, &[]).expect("stock");
        let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
        let run = RomRun::of_programs(&scene, &Schedule::even(12.0, 0.01));
        for spec in &scene.file.calibrate {
            let parameter = rom.parameter(&spec.key).expect("calibrated");
            let middle = (spec.min + spec.max) / 2.0;
            let at = |x: f64| {
                let parameters = vec![(parameter.clone(), x)];
                rom.simulate(&run, &RomSetting { parameters, effects: Vec::new() }).expect("finite")
            };
            let h = 1e-4 * middle;
            let (above, below) = (at(middle + h), at(middle - h));
            let parameters = vec![(parameter.clone(), Dual64::new(middle, 1.0))];
            let dual = rom.simulate_over(&run, &RomSetting { parameters, effects: Vec::new() }).expect("finite");
            for (c, column) in rom.columns().enumerate() {
                let exact: Vec<f64> = dual[c].iter().map(|d| d.eps).collect();
                let differences = (0..exact.len()).map(|i| (above[c][i] - below[c][i]) / (2.0 * h) - exact[i]);
                let rms =
                    |x: &mut dyn Iterator<Item = f64>| (x.map(|v| v * v).sum::<f64>() / exact.len() as f64).sqrt();
                let (error, size) = (rms(&mut differences.into_iter()), rms(&mut exact.iter().copied()));
                println!("{name} {column} to {}: {:.5} of {size:.3e}", spec.key, error / size);
                assert!(error < 0.05 * size, "{name}: {column} to {}", spec.key);
            }
        }
    }
}

/// What a dual number carries through levers that follow the pose is what a difference of two runs says.
#[test]
fn val_derivatives_go_through_levers_that_follow_the_pose() {
    let scene = Scene::load("tests/finger/finger.toml", &[]).unwrap_or_else(|e| panic!("{e}"));
    let run = RomRun::of_programs(&scene, &Schedule::even(6.0, 0.02));
    let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let key = rom.parameter("tube_c1_pa").expect("a tube");
    let at = |c1: f64| RomSetting { parameters: vec![(key.clone(), c1)], effects: Vec::new() };
    let exact = RomSetting { parameters: vec![(key.clone(), Dual64::new(0.255e6, 1.0))], effects: Vec::new() };
    let exact = rom.simulate_over(&run, &exact).expect("finite");
    let step = 200.0;
    let (low, high) = (rom.simulate(&run, &at(0.255e6 - step)), rom.simulate(&run, &at(0.255e6 + step)));
    let (low, high) = (low.expect("finite"), high.expect("finite"));
    for (o, column) in rom.columns().enumerate() {
        let rough: Vec<f64> = high[o].iter().zip(&low[o]).map(|(h, l)| (h - l) / (2.0 * step)).collect();
        let greatest = rough.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = exact[o].iter().zip(&rough).map(|(e, r)| (e.eps - r).abs()).fold(0.0, f64::max);
        println!("{column}: {off:.2e} of {greatest:.2e}");
        assert!(off < 1e-3 * greatest, "{column}: {off} of {greatest}");
    }
}

/// Five settings about the effects of a scene: as they are, two parameters a little off, and each effect's numbers larger.
fn settings_about(scene: &Scene, rom: &Rom) -> Vec<RomSetting<f64>> {
    let effects: Vec<Effect<f64>> = scene.file.effect.iter().map(|t| t.effect().expect("checked")).collect();
    let parameters = |share: f64| {
        let scaled = |key: &str, number: f64| Some((rom.parameter(key)?, number * share));
        [scaled("tube_c1_pa", 0.255e6), scaled("friction_m0_n", 0.05)].into_iter().flatten().collect()
    };
    let enlarged = |share: f64| {
        let mut effects = effects.clone();
        effects.iter_mut().for_each(|e| e.values[0] *= share);
        effects
    };
    [(1.0, 1.0), (1.001, 1.0), (0.93, 1.0), (1.0, 1.02), (1.0, 1.5)]
        .map(|(share, size)| RomSetting { parameters: parameters(share), effects: enlarged(size) })
        .to_vec()
}

#[test]
fn settings_side_by_side_answer_as_each_by_itself_to_the_bit() {
    for name in STOCK {
        let stock = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
        let run = RomRun::of_programs(&stock, &Schedule::even(8.0, 0.01));
        let plain = std::iter::once((format!("{name} as it is"), stock.clone()));
        for (title, scene) in plain.chain(with_each_effect(name)) {
            let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
            let settings = settings_about(&scene, &rom);
            let together = rom.simulate_many(&run, &settings);
            for (i, (setting, many)) in settings.iter().zip(&together).enumerate() {
                let one = rom.simulate(&run, setting);
                assert!(one.is_some(), "{title}, setting {i}: diverges");
                assert!(one == *many, "{title}, setting {i}: differs");
            }
        }
    }
}

#[test]
fn one_setting_that_diverges_takes_no_other_with_it() {
    let scene = Scene::load("muscle_bench", &[]).unwrap_or_else(|e| panic!("{e}"));
    let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let run = RomRun::of_programs(&scene, &Schedule::even(2.0, 0.01));
    let c1 = rom.parameter("tube_c1_pa").expect("a tube");
    let settings: Vec<_> = [0.25e6, f64::NAN, 0.26e6]
        .map(|pa| RomSetting { parameters: vec![(c1.clone(), pa)], effects: Vec::new() })
        .to_vec();
    let together = rom.simulate_many(&run, &settings);
    assert!(together[1].is_none());
    for i in [0, 2] {
        assert!(together[i].is_some() && together[i] == rom.simulate(&run, &settings[i]), "setting {i}");
    }
}

/// Where the cables hold a joint, a third of a millinewton hardly moves it; it is let go where so little decides on which of the
/// cables it hangs.
#[test]
fn a_joint_is_slack_where_the_smallest_force_moves_it() {
    let scene = Scene::load("antagonistic_pulley", &[]).expect("stock");
    let rom = Rom::new(&scene).expect("it has a reduced-order model");
    let times_s = Schedule::even(20.0, 0.01).times();
    let plunger = |sign: f64| times_s.iter().map(|t| sign * 1.1e-3 * (0.2 * std::f64::consts::PI * t).sin()).collect();
    let run = RomRun { inputs: vec![plunger(-1.0), plunger(1.0)], times_s: times_s.clone(), plan: None };
    let table = EffectTable {
        name: "gravity_load".to_owned(),
        element: "mechanism".to_owned(),
        channel: None,
        parameters: [("weight_n".to_owned(), 3e-4)].into(),
    };
    let bare = RomSetting::default();
    let loaded = RomSetting { parameters: Vec::new(), effects: vec![table.effect().expect("right")] };
    let column = |name: &str| rom.columns().position(|c| c == name).expect("an output");
    let (angle, tensions) = (column("angle_deg"), [column("tension_1_n"), column("tension_2_n")]);
    let [is, was] = [&loaded, &bare].map(|setting| rom.simulate(&run, setting).expect("finite"));
    let slack = rom.slack_joints(&run, &bare).expect("finite");
    let (free, held): (Vec<usize>, Vec<usize>) = (0..times_s.len()).partition(|&k| slack[angle][k]);
    let moved_deg =
        |samples: &[usize]| samples.iter().map(|&k| (is[angle][k] - was[angle][k]).abs()).fold(0.0, f64::max);
    let with_a_taut_cable = free.iter().filter(|&&k| tensions.iter().any(|&c| was[c][k] > 0.0)).count();
    println!("{} of {} samples are slack, {with_a_taut_cable} with a taut cable", free.len(), times_s.len());
    println!("the weight moves the joint by {:.4} deg where held, {:.4} elsewhere", moved_deg(&held), moved_deg(&free));
    assert!(moved_deg(&held) < 0.03 && moved_deg(&free) > 0.2);
    assert!(with_a_taut_cable > 0 && free.len() < times_s.len() / 4);
    assert!(tensions.iter().all(|&c| slack[c].iter().all(|u| !u)), "a cable's tension is no joint's");
}

/// A rig whose second muscle is of another make: other rubber, length, coil, friction, damping and mass of its end.
fn unequal(more: &[Override]) -> Scene {
    let differs = "muscle.muscle_2.differs={ tube = { material = { c1_pa = 3.0e5 }, coil = { stiffness_n_m = 60.0 } }, \
                   rest_length_m = 0.06, friction = { m0_n = 0.2 }, damping_n_s_m = 0.3, end_mass_kg = 6e-3 }";
    let differs = Override::parse(differs).expect("written rightly");
    Scene::load("antagonistic_pulley", &[&[differs], more].concat()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn unequal_muscles_answer_alike_in_both_models() {
    let (full, fast, columns) = both(&unequal(&[]), 8.0);
    let stock = Scene::load("antagonistic_pulley", &[]).expect("stock");
    let (equal, ..) = both(&stock, 8.0);
    for (column, fast) in columns.iter().zip(&fast) {
        let own = &full.find(column).expect("a channel").values;
        let percent = difference(own, fast);
        assert!(percent < 0.1, "{column} differs by {percent:.4} % of its range");
        // The muscle that differs, and what it shares a pulley with, do not move as before.
        assert!(difference(&equal.find(column).expect("a channel").values, own) > 0.1, "{column}");
    }
}

#[test]
fn muscles_that_all_differ_alike_are_the_bytes_of_another_make() {
    let number = "tube.coil.stiffness_n_m=55.0";
    let all: Override = Override::parse(&format!("muscles.{number}")).expect("written rightly");
    let each =
        [1, 2].map(|i| Override::parse(&format!("muscle.muscle_{i}.differs.{number}")).expect("written rightly"));
    let of = |changes: &[Override]| both(&Scene::load("antagonistic_pulley", changes).expect("loads"), 3.0).1;
    assert_eq!(of(&[all]), of(&each));
}

#[test]
fn a_number_of_one_muscle_is_varied_alone() {
    let scene = unequal(&[]);
    let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let run = RomRun::of_programs(&scene, &Schedule::even(2.0, 0.01));
    let simulate = |rom: &Rom, key: &str, value: f64| {
        let parameters = vec![(rom.parameter(key).expect("a number"), value)];
        rom.simulate(&run, &RomSetting { parameters, effects: Vec::new() }).expect("finite")
    };
    let with = |key: &str, value: f64| {
        let changed = unequal(&[Override::number(key, value)]);
        Rom::new(&changed).expect("builds").simulate(&run, &RomSetting::default()).expect("finite")
    };
    // One muscle's own, whether it stands in the scene already or not; what all share reaches those without their own alone.
    for (key, value) in [
        ("muscle.muscle_2.differs.tube.material.c1_pa", 2.0e5),
        ("muscle.muscle_1.differs.tube.material.c1_pa", 2.0e5),
        ("muscles.tube.material.c1_pa", 2.0e5),
        ("muscle.muscle_2.differs.damping_n_s_m", 0.5),
    ] {
        assert_eq!(simulate(&rom, key, value), with(key, value), "{key}");
    }
}
