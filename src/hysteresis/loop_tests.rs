//! Contract: the models draw the loops they are known for; the printed parameters give the paper's figures.

use super::*;
use std::f64::consts::TAU;

/// `1.5 - 1.5 cos(2 pi i/n)`, `periods` times, mm.
pub(super) fn plunger(periods: usize, n: usize) -> Vec<f64> {
    (0..=periods * n).map(|i| 1.5 - 1.5 * (TAU * i as f64 / n as f64).cos()).collect()
}

/// The last period's outputs.
fn steady(model: &DisplacementModel<f64>, n: usize) -> Vec<f64> {
    let (outputs, _) = model.follow(0.0, &plunger(4, n));
    outputs[3 * n..].to_vec()
}

fn travel(outputs: &[f64]) -> f64 {
    outputs.windows(2).map(|w| (w[1] - w[0]).abs()).sum()
}

fn range(outputs: &[f64]) -> f64 {
    let most = outputs.iter().copied().fold(f64::MIN, f64::max);
    most - outputs.iter().copied().fold(f64::MAX, f64::min)
}

#[test]
fn val_printed_parameters_give_the_printed_speeds() {
    let model = DisplacementModel::Paper(PaperModel::printed());
    let travelled = travel(&steady(&model, 4000));
    for (frequency_hz, speed) in [(0.1, 5.37), (0.15, 8.06), (0.2, 10.75)] {
        let found = travelled * frequency_hz;
        println!("{frequency_hz} Hz: {found:.4} mm/s");
        assert!((found - speed).abs() < 0.006, "{found} for {speed}");
    }
}

#[test]
fn val_the_digit_four_does_not() {
    let quartic = PaperModel { power: 4.0, ..PaperModel::printed() };
    let outputs = steady(&DisplacementModel::Paper(quartic), 4000);
    println!("p = 4: {:.4} mm/s, by range {:.4}", travel(&outputs) * 0.1, range(&outputs) * 0.2);
    assert!((travel(&outputs) * 0.1 - 5.34).abs() > 0.5);
}

#[test]
fn val_printed_loop() {
    let n = 4000;
    let model = DisplacementModel::Paper(PaperModel::printed());
    let (outputs, path) = (steady(&model, n), plunger(1, n));
    // The plunger is even about half a period: sample n - i of the way back is at the place of sample i.
    let widths: Vec<f64> = (0..=n / 2).map(|i| outputs[n - i] - outputs[i]).collect();
    let widest = (0..=n / 2).max_by(|&i, &j| widths[i].total_cmp(&widths[j])).unwrap();
    let area: f64 = (0..n / 2).map(|i| 0.5 * (widths[i] + widths[i + 1]) * (path[i + 1] - path[i])).sum();
    println!(
        "range {:.4} mm, width {:.4} mm at x = {:.4} mm, area {area:.4} mm2",
        range(&outputs),
        widths[widest],
        path[widest]
    );
    assert!((range(&outputs) - 26.87).abs() < 0.006);
    assert!((widths[widest] - 4.24).abs() < 0.006);
    assert!((path[widest] - 1.78).abs() < 0.006);
    assert!((area - 8.37).abs() < 0.006);
    assert!(widths.iter().all(|w| *w > -1e-9), "unloading lies above loading");
}

#[test]
fn the_gate_closes_the_loop_at_zero() {
    let ungated = PaperModel { gate: Gate::None, ..PaperModel::printed() };
    assert!(ungated.output(0.0, 0.8).abs() > 1.0);
    assert_eq!(PaperModel::printed().output(0.0, 0.8), 0.0);
    assert_eq!(PaperModel::printed().output(-0.1, 0.8), 0.0);
}

#[test]
fn val_symmetric_state_settles_at_its_limit() {
    let model = SymmetricBoucWen::from_array([1.0, 1.0, 2.0, 0.9, 0.3, 1.5]);
    let limit = (2.0f64 / 1.2).powf(1.0 / 1.5);
    assert!((model.advance(0.0, 0.0, 40.0) - limit).abs() < 1e-10);
    assert!((model.advance(0.3, 0.0, -40.0) + limit).abs() < 1e-10);
}

#[test]
fn asymmetric_model_contains_the_symmetric_one() {
    let (lambda, delta) = (1.1, 0.4);
    let symmetric = SymmetricBoucWen::from_array([1.0, -0.2, 2.0, lambda, delta, 1.0]);
    let shape = [lambda + delta, -delta, delta, 0.0, 0.0, 0.0];
    let wide = AsymmetricBoucWen { alpha_x: 1.0, alpha_z: -0.2, a: 2.0, n: 1.0, shape };
    let (mut z, mut w) = (0.0f64, 0.0f64);
    let mut x = 0.0;
    // From rest outwards and back and forth: no phase with sgn x = sgn v != sgn z occurs.
    for target in [4.0, -4.0, 3.5, -5.0] {
        z = symmetric.advance(z, x, target);
        w = wide.advance(w, x, target);
        x = target;
        assert!((z - w).abs() < 1e-12, "{z} {w}");
    }
}

#[test]
fn asymmetric_loops_are_asymmetric() {
    let shape = [1.0, 0.1, -0.1, 0.2, 0.15, 0.05];
    let model = AsymmetricBoucWen { alpha_x: 1.0, alpha_z: 1.0, a: 2.0, n: 1.0, shape };
    assert!(model.check().is_ok());
    let (up, down): (f64, f64) = (model.advance(0.0, 0.0, 50.0), model.advance(0.0, 0.0, -50.0));
    // A/(b1 + ... + b6) and A/(b1 + b2 + b3 - b4 - b5 - b6).
    assert!((up - 2.0 / 1.4).abs() < 1e-12);
    assert!((down + 2.0 / 0.6).abs() < 1e-10);
}

#[test]
fn inadmissible_parameters_are_named() {
    let runaway = DisplacementModel::Paper(PaperModel { rho: 3.2, ..PaperModel::printed() });
    assert_eq!(runaway.check().unwrap_err().to_string(), "asymmetric model: a - rho = -0.2190000000000003 must be > 0");
    let model = DisplacementModel::Paper(PaperModel::printed());
    assert!(model.check().is_ok());
    assert!(model.with_parameters(&[1.0; 6]).is_err());
    let same = model.with_parameters(&model.parameters()).unwrap();
    assert_eq!(same, model);
}

#[test]
fn parameter_sets_are_readable_text() {
    let model = DisplacementModel::Paper(PaperModel::printed());
    let text = serde_json::to_string(&model).unwrap();
    assert_eq!(serde_json::from_str::<DisplacementModel<f64>>(&text).unwrap(), model);
}

#[test]
fn val_play_loop_area() {
    // A play of half width r over a stroke s > 2r: the loop's area is 2r (s - 2r).
    let model = PrandtlIshlinskii::classical(0.0, vec![PlayElement { weight: 1.0, half_width: 0.2 }]);
    let path = plunger(3, 20_000);
    let mut state = model.rest(0.0);
    let mut area = 0.0;
    let mut last = (0.0, 0.0);
    for (i, &x) in path.iter().enumerate() {
        model.advance(&mut state, x, 0.0);
        let y = model.output(x, &state);
        if i > 40_000 {
            area -= 0.5 * (y + last.1) * (x - last.0);
        }
        last = (x, y);
    }
    assert!((area - 0.4 * (3.0 - 0.4)).abs() < 1e-5, "{area}");
}

#[test]
fn a_spring_with_slider_is_the_rest_of_a_play() {
    let play = Play { half_width: 0.3 };
    let slip = MaxwellSlip {
        offset: 0.0,
        gain: 0.0,
        curvature: 0.0,
        cubic: 0.0,
        growth: 0.0,
        gate: Gate::None,
        elements: vec![SlipElement { stiffness: 2.0, reach: 0.3 }],
    };
    let (mut w, mut x, mut state) = (0.0f64, 0.0f64, slip.rest());
    for target in [1.0, 0.6, -0.4, 0.1, 2.0, 1.9] {
        w = play.advance(w, target);
        slip.advance(&mut state, target - x);
        x = target;
        assert!((slip.output(x, &state) - 2.0 * (x - w)).abs() < 1e-14);
    }
}
