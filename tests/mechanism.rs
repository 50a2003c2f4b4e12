//! Contract: the mechanism behind its coordinates moves as the closed forms say, whatever integrates outside.
//!
//! Every test drives [`Mechanism::advance`] the way a whole system does: implicit Euler on the coordinates outside,
//! the engine told where to arrive.

use nalgebra::{DMatrix, DVector};
use smam::mechanism::*;
use std::path::{Path, PathBuf};

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models")
}

fn spec(text: &str) -> MechanismSpec {
    toml::from_str(text).unwrap()
}

fn load_model(text: &str) -> Mechanism {
    Mechanism::load(&spec(text), &models()).unwrap()
}

/// Loads a URDF given as text.
fn load_urdf(urdf: &str, text: &str) -> Result<Mechanism, MechanismError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.urdf"), urdf).unwrap();
    Mechanism::load(&spec(&format!("urdf = \"t.urdf\"\n{text}")), folder.path())
}

/// Implicit Euler outside: (M + hD + h²K) v* = M v + h (f − K (q − rest) + f_c), stops included by their own stiffness.
struct Outer {
    known: Vec<f64>,
}

impl Outer {
    fn new(mechanism: &Mechanism) -> Self {
        Self { known: vec![0.0; mechanism.coordinates().len()] }
    }

    fn step(&mut self, mechanism: &mut Mechanism, h: f64, force: &[f64]) -> Vec<f64> {
        let n = mechanism.coordinates().len();
        let mut q = DVector::zeros(n);
        let mut v = DVector::zeros(n);
        mechanism.positions(q.as_mut_slice());
        mechanism.velocities(v.as_mut_slice());
        let mut mass = DMatrix::zeros(n, n);
        mechanism.mass_matrix(&mut mass);
        let mut right = &mass * &v;
        for (i, c) in mechanism.coordinates().iter().enumerate() {
            let mut f = force[i] + self.known[i] - c.stiffness * (q[i] - c.rest);
            let (mut k, mut d) = (c.stiffness, c.damping);
            let pressed = |s: &Stop, side: f64| side * (q[i] - s.position) > 0.0;
            for (stop, side) in [(c.lower_stop, -1.0), (c.upper_stop, 1.0)] {
                if let Some(stop) = stop.filter(|s| pressed(s, side)) {
                    f -= stop.stiffness * (q[i] - stop.position);
                    k += stop.stiffness;
                    d += stop.damping;
                }
            }
            right[i] += h * f;
            mass[(i, i)] += h * d + h * h * k;
        }
        let target = mass.lu().solve(&right).unwrap();
        mechanism.advance(h, target.as_slice(), &mut self.known);
        target.as_slice().to_vec()
    }
}

fn positions(mechanism: &Mechanism) -> Vec<f64> {
    let mut q = vec![0.0; mechanism.coordinates().len()];
    mechanism.positions(&mut q);
    q
}

fn relative(have: f64, want: f64) -> f64 {
    have / want - 1.0
}

fn rod(name: &str, mass: f64, com: f64, inertia: f64) -> String {
    format!(
        "<link name=\"{name}\"><inertial><origin xyz=\"{com} 0 0\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"{inertia}\" ixy=\"0\" ixz=\"0\" iyy=\"{inertia}\" iyz=\"0\" izz=\"{inertia}\"/></inertial></link>"
    )
}

fn joint(name: &str, kind: &str, links: [&str; 2], x: f64, extra: &str) -> String {
    let [parent, child] = links;
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><origin xyz=\"{x} 0 0\"/><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <axis xyz=\"0 0 1\"/><limit effort=\"1\" velocity=\"1\"/>{extra}</joint>"
    )
}

fn two_links() -> String {
    format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}{}{}</robot>",
        rod("upper", 2e-3, 5e-3, 1e-8),
        rod("lower", 1e-3, 4e-3, 6e-9),
        joint("j1", "revolute", ["base", "upper"], 0.0, ""),
        joint("j2", "revolute", ["upper", "lower"], 12e-3, ""),
    )
}

#[test]
fn val_hinge_under_a_constant_moment() {
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}</robot>",
        rod("arm", 1e-3, 5e-3, 1e-8),
        joint("j", "revolute", ["base", "arm"], 0.0, ""),
    );
    let text = "[[joint]]\njoints = [\"j\"]\nstiffness_n_m_rad = 1e-2\ndamping_n_m_s_rad = 1e-4\nrest_rad = 0.1";
    let mut m = load_urdf(&urdf, text).unwrap();
    let mut outer = Outer::new(&m);
    for _ in 0..400 {
        outer.step(&mut m, 1e-3, &[4e-3]);
    }
    let error = relative(positions(&m)[0], 0.1 + 0.4);
    println!("hinge: error {error:.1e}, known force {:.1e}", outer.known[0]);
    assert!(error.abs() < 1e-6);
}

const CATHETER: &str = "urdf = \"bending_catheter.urdf\"
[[joint]]
joints = [\"notch_1\", \"notch_2\", \"notch_3\", \"notch_4\", \"notch_5\", \"notch_6\", \"notch_7\", \"notch_8\"]
stiffness_n_m_rad = 8.4e-3
damping_n_m_s_rad = 1.6e-4
[[joint]]
joints = [\"jaw_left\", \"jaw_right\"]
stiffness_n_m_rad = 0.45e-3
damping_n_m_s_rad = 1e-6
rest_rad = 0.7
initial_rad = 0.7
lower_stop = { position_rad = 0.0, stiffness_n_m_rad = 0.025 }
";

fn lever_route(joints: std::ops::RangeInclusive<usize>, lever: f64) -> RouteSpec {
    let lever = |i| LeverSpec { joint: format!("notch_{i}"), lever_m: lever };
    RouteSpec { lever: joints.map(lever).collect(), ..RouteSpec::default() }
}

#[test]
fn val_eight_hinges_under_cable_tension() {
    let mut m = load_model(CATHETER);
    let route = m.route(&lever_route(1..=8, 2.62e-3)).unwrap();
    let (tension, mut outer) = (0.94, Outer::new(&m));
    let mut slope = vec![0.0; 9];
    let length = m.path_length(&route, &mut slope);
    for _ in 0..600 {
        m.path_length(&route, &mut slope);
        let force: Vec<f64> = slope.iter().map(|s| -tension * s).collect();
        outer.step(&mut m, 1e-3, &force);
    }
    let bend: f64 = positions(&m)[..8].iter().sum();
    let want = tension * 2.62e-3 / 1.05e-3;
    let (error, drawn) = (relative(bend, want), length - m.path_length(&route, &mut slope));
    println!("8 hinges: bend {:.3} deg, error {error:.1e}", bend.to_degrees());
    assert!(error.abs() < 1e-5);
    assert!(relative(drawn, 2.62e-3 * want).abs() < 1e-5);
    // The tip has turned towards +z, the side of the cutouts, by that angle.
    let tip = m.link_names().iter().position(|n| n == "segment_8").unwrap();
    let [_, y, _, w] = m.link_poses()[tip].rotation_xyzw;
    assert!((2.0 * (-y).atan2(w) - bend).abs() < 1e-9);
}

#[test]
fn val_cable_over_a_pulley() {
    let mut m =
        load_model("urdf = \"antagonistic_pulley.urdf\"\n[[joint]]\njoints = [\"pulley\"]\ndamping_n_m_s_rad = 2e-5");
    let levers =
        |lever_m| RouteSpec { lever: vec![LeverSpec { joint: "pulley".into(), lever_m }], ..RouteSpec::default() };
    let (one, two) = (m.route(&levers(8e-3)).unwrap(), m.route(&levers(-8e-3)).unwrap());
    let (stiffness, pull, mut outer) = (300.0, 1e-3, Outer::new(&m));
    let mut slope = [0.0];
    for _ in 0..20_000 {
        // Two equal springs in series with the cables; one end is drawn in by `pull`.
        let first = stiffness * (5e-3 + pull + m.path_length(&one, &mut slope));
        let second = stiffness * (5e-3 + m.path_length(&two, &mut slope));
        outer.step(&mut m, 1e-4, &[8e-3 * (first - second)]);
    }
    let error = relative(positions(&m)[0], pull / 2.0 / 8e-3);
    println!("pulley: error {error:.1e}");
    assert!(error.abs() < 1e-5);
}

#[test]
fn val_jaws_stay_symmetrical() {
    let mut m = load_model(CATHETER);
    let mut outer = Outer::new(&m);
    let names = m.link_names();
    let jaw = |name: &str| names.iter().position(|n| n == name).unwrap();
    let (left, right, tip) = (jaw("jaw_left_link"), jaw("jaw_right_link"), jaw("segment_8"));
    let mut force = vec![0.0; 9];
    force[8] = -1.5e-3 * 0.3;
    let mut worst: f64 = 0.0;
    for _ in 0..1500 {
        outer.step(&mut m, 2e-4, &force);
        let poses = m.link_poses();
        let turn = |link: usize| 2.0 * poses[link].rotation_xyzw[1].atan2(poses[link].rotation_xyzw[3]);
        worst = worst.max((turn(left) + turn(right) - 2.0 * turn(tip)).abs());
    }
    let closed = positions(&m)[8];
    let error = relative(closed, 0.7 - 0.45e-3 / 0.9e-3);
    println!("jaws: asymmetry {worst:.1e} rad, angle error {error:.1e}");
    assert!(worst < 1e-9 && error.abs() < 1e-5);
}

#[test]
fn val_mass_matrix_of_two_links() {
    for (a, b) in [(0.0, 0.0), (0.4, -1.1), (-2.0, 2.5)] {
        let text =
            format!("[[joint]]\njoints = [\"j1\"]\ninitial_rad = {a}\n[[joint]]\njoints = [\"j2\"]\ninitial_rad = {b}");
        let m = load_urdf(&two_links(), &text).unwrap();
        let mut mass = DMatrix::zeros(0, 0);
        m.mass_matrix(&mut mass);
        let (m1, c1, i1, m2, c2, i2, l) = (2e-3, 5e-3, 1e-8, 1e-3, 4e-3, 6e-9, 12e-3);
        let cross = m2 * l * c2 * f64::cos(b);
        let m22 = i2 + m2 * c2 * c2;
        let m12 = m22 + cross;
        let m11 = i1 + m1 * c1 * c1 + m2 * l * l + m12 + cross;
        for (have, want) in [(mass[(0, 0)], m11), (mass[(0, 1)], m12), (mass[(1, 1)], m22)] {
            assert!(relative(have, want).abs() < 1e-12, "{have:e} {want:e}");
        }
    }
}

#[test]
fn val_weight_of_two_links_and_a_hung_mass() {
    let text = "gravity_m_s2 = [0.0, -9.81, 0.0]\nlinks_have_weight = true\n\
                [[link_mass]]\nlink = \"lower\"\nmass_kg = 0.05\n[[joint]]\njoints = [\"j1\"]\ninitial_rad = 0.3";
    let m = load_urdf(&two_links(), text).unwrap();
    let mut weight = [0.0; 2];
    m.weight(&mut weight);
    let (g, cos) = (9.81, 0.3f64.cos());
    let lower = -g * cos * (1e-3 + 0.05) * 4e-3;
    let upper = -g * cos * (2e-3 * 5e-3 + 0.051 * 16e-3);
    assert!(relative(weight[1], lower).abs() < 1e-12, "{weight:?} {lower:e}");
    assert!(relative(weight[0], upper).abs() < 1e-12, "{weight:?} {upper:e}");
}

#[test]
fn val_via_route_slope_is_the_difference_quotient() {
    let at = |a: f64, b: f64| {
        let text =
            format!("[[joint]]\njoints = [\"j1\"]\ninitial_rad = {a}\n[[joint]]\njoints = [\"j2\"]\ninitial_rad = {b}");
        let m = load_urdf(&two_links(), &text).unwrap();
        let point = |link: &str, point_m| PointSpec { link: link.into(), point_m };
        let via = vec![
            point("base", [-5e-3, 2e-3, 1e-3]),
            point("upper", [4e-3, 2e-3, 0.0]),
            point("upper", [8e-3, 2e-3, 0.0]),
            point("lower", [3e-3, 1e-3, -1e-3]),
        ];
        let route = m.route(&RouteSpec { via, ..RouteSpec::default() }).unwrap();
        let mut slope = [0.0; 2];
        (m.path_length(&route, &mut slope), slope)
    };
    let (a, b, d) = (0.3, -0.7, 1e-6);
    let slope = at(a, b).1;
    let wanted = [(at(a + d, b).0 - at(a - d, b).0) / (2.0 * d), (at(a, b + d).0 - at(a, b - d).0) / (2.0 * d)];
    for i in 0..2 {
        assert!(relative(slope[i], wanted[i]).abs() < 1e-7, "{slope:?} {wanted:?}");
    }
}

#[test]
fn val_the_engine_arrives_where_it_is_told() {
    let mut m = load_model(CATHETER);
    let mut outer = Outer::new(&m);
    let mut force = vec![0.0; 9];
    let mut worst: f64 = 0.0;
    for i in 0..2000 {
        let t = f64::from(i) * 1e-4;
        force[..8].fill(2e-3 * (40.0 * t).sin());
        force[8] = 5e-4 * (90.0 * t).sin();
        let target = outer.step(&mut m, 1e-4, &force);
        let mut v = vec![0.0; 9];
        m.velocities(&mut v);
        let size = target.iter().fold(1e-3f64, |s, v| s.max(v.abs()));
        worst = v.iter().zip(&target).fold(worst, |w, (v, t)| w.max((v - t).abs() / size));
    }
    println!("arrival: worst relative velocity error {worst:.1e}");
    assert!(worst < 1e-3);
}

#[test]
fn val_the_slide_arrives_to_round_off() {
    let mut m = load_model("urdf = \"muscle_bench.urdf\"");
    let mut outer = Outer::new(&m);
    for _ in 0..100 {
        let target = outer.step(&mut m, 1e-3, &[0.05]);
        let mut v = [0.0];
        m.velocities(&mut v);
        assert!((v[0] - target[0]).abs() <= 1e-12 * target[0].abs());
    }
    // x = a h² n (n + 1) / 2, implicit Euler's own answer.
    assert!(relative(positions(&m)[0], 10.0 * 1e-6 * 5050.0).abs() < 1e-10);
    assert!(outer.known[0].abs() < 1e-12);
}

const GRIP: &str = "urdf = \"bending_catheter.urdf\"
[contact]
links = [\"jaw_left_link\", \"jaw_right_link\"]
friction_coefficient = 0.6
[[joint]]
joints = [\"notch_1\", \"notch_2\", \"notch_3\", \"notch_4\", \"notch_5\", \"notch_6\", \"notch_7\", \"notch_8\"]
locked_rad = 0.0
[[joint]]
joints = [\"jaw_left\", \"jaw_right\"]
stiffness_n_m_rad = 0.45e-3
damping_n_m_s_rad = 1e-6
rest_rad = 0.7
initial_rad = 0.3
[[body]]
name = \"ball\"
shape.sphere.radius_m = 0.0015
mass_kg = 20e-6
position_m = [0.0363, 0.0, 0.0]
";

fn grip(m: &mut Mechanism, steps: usize) -> Outer {
    let mut outer = Outer::new(m);
    for _ in 0..steps {
        outer.step(m, 1e-4, &[-3e-3]);
    }
    outer
}

#[test]
fn val_a_held_ball_answers_with_the_known_force() {
    let mut m = load_model(GRIP);
    let outer = grip(&mut m, 1500);
    let q = positions(&m)[0];
    let reaction = 3e-3 + 0.9e-3 * (q - 0.7);
    let error = relative(outer.known[0], reaction);
    let parallel = 1.5f64.atan2(6.5);
    let contacts = m.contacts();
    let forces: Vec<f64> = contacts.iter().map(|c| c.force_n).collect();
    let ball = m.link_poses()[m.link_names().len() - 1].translation_m;
    println!(
        "grip: q {q:.5} (parallel {parallel:.5}), known force error {error:.1e}, forces {forces:?}, ball {ball:?}"
    );
    assert!(error.abs() < 1e-3);
    assert!((q - parallel).abs() < 3e-3);
    let total: f64 = forces.iter().sum();
    // The jaws push the ball back a little until their faces are parallel; then it stays, normal forces at its middle.
    let pin = 0.0318;
    assert!(relative(total * (ball[0] - pin), reaction).abs() < 1e-3, "{total}");
    assert!(ball.iter().zip([0.0363, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 3e-4), "{ball:?}");
}

#[test]
fn val_a_slide_pressed_on_a_wall_answers_with_the_known_force() {
    let urdf = "<robot name=\"r\"><link name=\"base\"/><link name=\"cart\"><inertial><mass value=\"0.005\"/>\
        <inertia ixx=\"1e-7\" ixy=\"0\" ixz=\"0\" iyy=\"1e-7\" iyz=\"0\" izz=\"1e-7\"/></inertial>\
        <collision><geometry><sphere radius=\"0.002\"/></geometry></collision></link>\
        <joint name=\"s\" type=\"prismatic\"><parent link=\"base\"/><child link=\"cart\"/><axis xyz=\"2 0 0\"/>\
        <limit effort=\"1\" velocity=\"1\"/></joint></robot>";
    let text = "[contact]\nlinks = [\"cart\"]\n[[body]]\nname = \"wall\"\nmotion = \"fixed\"\n\
                shape.box.size_m = [0.002, 0.02, 0.02]\nposition_m = [0.004, 0.0, 0.0]";
    let mut m = load_urdf(urdf, text).unwrap();
    let mut outer = Outer::new(&m);
    for _ in 0..500 {
        outer.step(&mut m, 1e-4, &[2.0]);
    }
    let (x, known) = (positions(&m)[0], outer.known[0]);
    println!("wall: x {x:.6}, known force {known:.6}, contacts {:?}", m.contacts());
    assert!((x - 1e-3).abs() < 1e-5);
    assert!(relative(known, -2.0).abs() < 1e-3);
    assert!(relative(m.contacts()[0].force_n, 2.0).abs() < 1e-2);
}

#[test]
fn regress_two_runs_are_bit_identical() {
    let run = || {
        let mut m = load_model(GRIP);
        let outer = grip(&mut m, 400);
        (positions(&m)[0].to_bits(), outer.known[0].to_bits(), m.link_poses())
    };
    assert_eq!(run(), run());
}

#[test]
fn regress_a_copy_goes_on_bit_for_bit() {
    let mut m = load_model(GRIP);
    let mut outer = grip(&mut m, 300);
    let mut again = m.clone();
    let mut other = Outer { known: outer.known.clone() };
    for _ in 0..200 {
        outer.step(&mut m, 1e-4, &[-3e-3]);
        other.step(&mut again, 1e-4, &[-3e-3]);
    }
    assert_eq!(m.link_poses(), again.link_poses());
    assert_eq!(outer.known, other.known);
}

#[test]
fn stock_catheter_inertias() {
    let m = load_model(CATHETER);
    let mut mass = DMatrix::zeros(0, 0);
    m.mass_matrix(&mut mass);
    println!("bending inertia {:.3e}, jaws {:.3e}", mass[(0, 0)], mass[(8, 8)]);
    assert!((1.5e-8..2.5e-8).contains(&mass[(0, 0)]));
    assert!(relative(mass[(8, 8)], 2e-9).abs() < 1e-6);
    assert_eq!(m.coordinates().len(), 9);
    assert!(m.warnings().is_empty(), "{:?}", m.warnings());
}

#[test]
fn stock_pulley_and_bench_inertias() {
    let mut mass = DMatrix::zeros(0, 0);
    load_model("urdf = \"antagonistic_pulley.urdf\"").mass_matrix(&mut mass);
    assert!(relative(mass[(0, 0)], 2.5e-7).abs() < 1e-12);
    load_model("urdf = \"muscle_bench.urdf\"").mass_matrix(&mut mass);
    assert!(relative(mass[(0, 0)], 5e-3).abs() < 1e-12);
}

#[test]
fn followers_are_summed_into_their_leader() {
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}{}{}</robot>",
        rod("a", 1e-3, 1e-3, 1e-8),
        rod("b", 1e-3, 1e-3, 1e-8),
        joint("lead", "revolute", ["base", "a"], 0.0, ""),
        joint("follow", "revolute", ["base", "b"], 0.0, "<mimic joint=\"lead\" multiplier=\"-2\" offset=\"0.5\"/>"),
    );
    let text = "[[joint]]\njoints = [\"lead\"]\nstiffness_n_m_rad = 1.0\n\
                [[joint]]\njoints = [\"follow\"]\nstiffness_n_m_rad = 0.5\ndamping_n_m_s_rad = 0.025\nrest_rad = 0.1\n\
                lower_stop = { position_rad = -0.5, stiffness_n_m_rad = 3.0 }";
    let mut m = load_urdf(&urdf, text).unwrap();
    let c = m.coordinates()[0].clone();
    assert_eq!((c.stiffness, c.damping), (3.0, 0.1));
    assert!(relative(c.rest, -2.0 * 0.5 * (0.1 - 0.5) / 3.0).abs() < 1e-12);
    let stop = c.upper_stop.unwrap();
    assert_eq!((stop.position, stop.stiffness), (0.5, 12.0));
    let route = RouteSpec { lever: vec![LeverSpec { joint: "follow".into(), lever_m: 1e-3 }], ..RouteSpec::default() };
    let route = m.route(&route).unwrap();
    let mut slope = [0.0];
    assert!(relative(m.path_length(&route, &mut slope), -0.5e-3).abs() < 1e-12);
    assert!(relative(slope[0], 2e-3).abs() < 1e-12);
    let mut outer = Outer::new(&m);
    for _ in 0..3000 {
        outer.step(&mut m, 1e-3, &[0.3]);
    }
    let error = relative(positions(&m)[0], c.rest + 0.1);
    println!("mimic -2: error {error:.1e}");
    assert!(error.abs() < 1e-5);
}

#[test]
fn a_locked_slide_is_no_coordinate_but_keeps_its_cable() {
    let m = load_model("urdf = \"muscle_bench.urdf\"\n[[joint]]\njoints = [\"slide\"]\nlocked_m = 0.02");
    assert!(m.coordinates().is_empty());
    let route = RouteSpec { lever: vec![LeverSpec { joint: "slide".into(), lever_m: -1.0 }], ..RouteSpec::default() };
    assert_eq!(m.path_length(&m.route(&route).unwrap(), &mut []), 0.02);
    assert!((m.link_poses()[1].translation_m[0] - 0.07).abs() < 1e-12);
}

#[test]
fn a_dropped_ball_falls_freely() {
    let text = "urdf = \"muscle_bench.urdf\"\ngravity_m_s2 = [0.0, 0.0, -9.81]\n[[body]]\nname = \"ball\"\n\
                shape.sphere.radius_m = 0.003\nmass_kg = 0.001\nposition_m = [0.0, 0.0, 0.5]\nhas_weight = true";
    let mut m = load_model(text);
    let mut known = [0.0];
    for _ in 0..1000 {
        m.advance(1e-4, &[0.0], &mut known);
    }
    let fallen = 0.5 - m.link_poses()[2].translation_m[2];
    assert!(relative(fallen, 0.5 * 9.81 * 0.01).abs() < 2e-3, "{fallen}");
    assert_eq!(m.link_names()[2], "ball");
    assert!(positions(&m)[0].abs() < 1e-15);
}

#[test]
fn what_cannot_be_simulated_is_refused_by_name() {
    let base = "<link name=\"base\"/>";
    let arm = rod("arm", 1e-3, 1e-3, 1e-8);
    let hinge = joint("j", "revolute", ["base", "arm"], 0.0, "");
    let robot = |inside: &str| format!("<robot name=\"r\">{inside}</robot>");
    let good = robot(&format!("{base}{arm}{hinge}"));
    let cases: &[(String, &str, &str)] = &[
        (String::from("no xml"), "", "not a valid URDF"),
        (robot(""), "", "has 0 root links"),
        (robot(&format!("{base}{arm}")), "", "has 2 root links"),
        (robot(&format!("{base}{base}{arm}{hinge}")), "", "link \"base\": this name is used twice"),
        (robot(&format!("{base}{arm}{hinge}{hinge}")), "", "joint \"j\": this name is used twice"),
        (good.replace("parent link=\"base\"", "parent link=\"x\""), "", "there is no link \"x\""),
        (good.replace("revolute", "floating"), "", "type Floating is not simulated"),
        (good.replace("revolute", "planar"), "", "type Planar is not simulated"),
        (good.replace("0 0 1", "0 0 0"), "", "has no direction"),
        (good.replace("0 0 1", "0 0 nan"), "", "has no direction"),
        (good.replace("mass value=\"0.001\"", "mass value=\"-1\""), "", "mass = -1 must be > 0"),
        (good.replace("mass value=\"0.001\"", "mass value=\"0\""), "", "has no mass of its own"),
        (robot(&format!("{base}<link name=\"arm\"/>{hinge}")), "", "has no mass of its own"),
        (good.clone(), "[[joint]]\njoints = [\"k\"]", "no such joint\n  remedy: name one of \"j\""),
        (good.clone(), "[[joint]]\njoints = [\"j\"]\nstiffness_n_m = 1.0", "use stiffness_n_m_rad"),
        (good.clone(), "[[joint]]\njoints = [\"j\", \"j\"]", "appears twice"),
        (good.clone(), "[[joint]]\njoints = [\"j\"]\ndamping_n_m_s_rad = -1.0", "damping = -1 must be >= 0"),
        (good.clone(), "[[link_mass]]\nlink = \"no\"\nmass_kg = 1.0", "no such link"),
        (good.clone(), "[contact]\nlinks = [\"arm\"]", "has no <collision>"),
        (good.replace("</joint>", "<mimic joint=\"j\"/></joint>"), "", "mimics itself"),
        (good.replace("</joint>", "<mimic joint=\"k\"/></joint>"), "", "which does not exist"),
    ];
    for (urdf, text, expected) in cases {
        let message = match load_urdf(urdf, text) {
            Ok(_) => panic!("accepted, expected: {expected}"),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(expected), "{message}\nexpected: {expected}");
    }
}

/// A reader that calls itself for each would run out of stack.
#[test]
fn elements_too_deep_in_each_other_are_refused() {
    let urdf = format!("<robot name=\"r\">{}{}</robot>", "<link>".repeat(200_000), "</link>".repeat(200_000));
    let message = load_urdf(&urdf, "").err().unwrap().to_string();
    assert!(message.contains("stand 200001 deep in each other, which is more than 100\n  remedy: "), "{message}");
}

/// The reader compares each with each: 80,000 took 35 s.
#[test]
fn namespaces_without_number_are_refused() {
    let declared: String = (0..80_000).map(|i| format!(" xmlns:a{i}=\"b\"")).collect();
    let message = load_urdf(&format!("<robot name=\"r\"{declared}/>"), "").err().unwrap().to_string();
    assert!(message.contains("declares 80000 XML namespaces, which is more than 100\n  remedy: "), "{message}");
}

/// As large as a scan of somebody's whole laboratory: refused at once instead of after minutes.
#[test]
fn more_joints_than_can_be_simulated_are_refused() {
    let chain: String = (0..1001)
        .map(|i| {
            let [parent, child] = [format!("l{i}"), format!("l{}", i + 1)];
            rod(&child, 1e-3, 1e-3, 1e-8) + &joint(&format!("j{i}"), "revolute", [&parent, &child], 0.0, "")
        })
        .collect();
    let urdf = format!("<robot name=\"r\"><link name=\"l0\"/>{chain}</robot>");
    let message = load_urdf(&urdf, "").err().unwrap().to_string();
    assert!(
        message.contains("robot \"r\": has 1001 joints that move, which is more than 1000\n  remedy: "),
        "{message}"
    );
}

/// Each multiplier is finite, what the third joint makes of the first one's position is not.
#[test]
fn followers_of_followers_must_multiply_to_a_number() {
    let follows = |leader: &str| format!("<mimic joint=\"{leader}\" multiplier=\"1e200\"/>");
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}{}{}{}{}</robot>",
        rod("a", 1e-3, 1e-3, 1e-8),
        rod("b", 1e-3, 1e-3, 1e-8),
        rod("c", 1e-3, 1e-3, 1e-8),
        joint("j1", "revolute", ["base", "a"], 0.0, ""),
        joint("j2", "revolute", ["a", "b"], 0.0, &follows("j1")),
        joint("j3", "revolute", ["b", "c"], 0.0, &follows("j2")),
    );
    let message = load_urdf(&urdf, "").err().unwrap().to_string();
    assert!(message.contains("joint \"j3\": follows others with multiplier = inf"), "{message}");
    assert!(load_urdf(&urdf.replace("1e200", "1.5"), "").is_ok());
}

#[test]
fn loops_are_refused() {
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"/>{}{}{}{}</robot>",
        rod("a", 1e-3, 1e-3, 1e-8),
        rod("b", 1e-3, 1e-3, 1e-8),
        joint("j1", "revolute", ["b", "a"], 0.0, ""),
        joint("j2", "revolute", ["a", "b"], 0.0, ""),
    );
    let message = load_urdf(&urdf, "").err().unwrap().to_string();
    assert!(message.contains("in a loop"), "{message}");
}

#[test]
fn dropped_elements_become_warnings() {
    let good = two_links().replace("</robot>", "<transmission name=\"t\"/><gazebo/></robot>");
    let m = load_urdf(&good, "").unwrap();
    assert_eq!(m.warnings().len(), 2, "{:?}", m.warnings());
}

#[test]
fn mixed_up_routes_are_refused() {
    let m = load_model("urdf = \"muscle_bench.urdf\"");
    assert!(m.route(&RouteSpec::default()).is_err());
    let unknown = RouteSpec { lever: vec![LeverSpec { joint: "x".into(), lever_m: 1.0 }], ..RouteSpec::default() };
    let message = m.route(&unknown).unwrap_err().to_string();
    assert!(message.contains("name one of \"slide\""), "{message}");
}

/// Every attribute of every model in turn becomes nonsense, and the text is cut at many places.
#[test]
fn no_urdf_makes_it_panic() {
    for file in ["muscle_bench.urdf", "antagonistic_pulley.urdf", "bending_catheter.urdf"] {
        let text = std::fs::read_to_string(models().join(file)).unwrap();
        let quotes: Vec<usize> = text.match_indices('"').map(|(i, _)| i).collect();
        let mut texts: Vec<String> = (0..text.len()).step_by(397).map(|i| text[..i].to_owned()).collect();
        for (k, pair) in quotes.chunks_exact(2).enumerate() {
            let values = ["", "nan", "inf nan 0", "-1", "1e308", "1e308 0 -1e308", "0 0 0", "jaw_left"];
            texts.push(format!("{}{}{}", &text[..=pair[0]], values[k % values.len()], &text[pair[1]..]));
            texts.push(format!("{}{}{}", &text[..=pair[0]], values[(k / 3) % values.len()], &text[pair[1]..]));
        }
        for text in texts {
            let Ok(mut m) = load_urdf(&text, "") else {
                continue;
            };
            let n = m.coordinates().len();
            m.advance(1e-3, &vec![0.1; n], &mut vec![0.0; n]);
            assert!(m.link_poses().len() > 1);
        }
    }
}
