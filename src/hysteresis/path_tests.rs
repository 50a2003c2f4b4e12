//! Contract: a state depends on the input's path, not on its sampling; the integrator meets the closed form; dual
//! numbers give the derivatives to the parameters.

use super::branch::Branch;
use super::*;
use num_dual::Dual64;
use proptest::prelude::*;

fn models() -> [DisplacementModel<f64>; 4] {
    let shape = [1.0, 0.1, -0.1, 0.2, 0.15, 0.05];
    [
        DisplacementModel::Symmetric(SymmetricBoucWen::from_array([8.0, -1.0, 2.0, 1.4, 0.5, 1.3])),
        DisplacementModel::Asymmetric(AsymmetricBoucWen { alpha_x: 9.0, alpha_z: -1.2, a: 2.0, n: 1.1, shape }),
        DisplacementModel::Paper(PaperModel::printed()),
        DisplacementModel::Paper(PaperModel { n: 1.0, ..PaperModel::printed() }),
    ]
}

const TURNS: [f64; 8] = [0.0, 3.0, 0.4, 2.1, -0.5, 1.0, -2.0, 3.0];

fn refined(pieces: usize) -> Vec<f64> {
    let mut path = vec![TURNS[0]];
    for ends in TURNS.windows(2) {
        let step = (ends[1] - ends[0]) / pieces as f64;
        path.extend((1..pieces).map(|i| ends[0] + step * i as f64));
        path.push(ends[1]);
    }
    path
}

#[test]
fn sampling_does_not_matter() {
    for model in models() {
        let (_, coarse) = model.follow(0.0, &TURNS);
        for pieces in [7, 300, 3_000] {
            let (_, fine) = model.follow(0.0, &refined(pieces));
            assert!((fine - coarse).abs() < 1e-8, "{model:?}: {}", fine - coarse);
        }
    }
}

/// Places and times of the same path, each straight piece cut into equal parts.
fn timed(pieces: usize) -> (Vec<f64>, Vec<f64>) {
    let path = refined(pieces);
    let time = (0..path.len()).map(|i| i as f64 / pieces as f64).collect();
    (time, path)
}

#[test]
fn sampling_does_not_matter_to_plays_sliders_and_growing_friction() {
    let plays = [(1.0, 0.05), (2.0, 0.2)].map(|(weight, half_width)| PlayElement { weight, half_width });
    let sliders = [(-2.0, 0.1), (-1.0, 0.4)].map(|(stiffness, reach)| SlipElement { stiffness, reach });
    let sum = PrandtlIshlinskii { curvature: 0.1, asymmetry: 0.1, ..PrandtlIshlinskii::classical(7.0, plays.to_vec()) };
    let slip = MaxwellSlip {
        offset: 0.2,
        gain: 7.0,
        curvature: 0.1,
        cubic: 0.01,
        growth: 0.3,
        gate: Gate::Tanh,
        elements: sliders.to_vec(),
    };
    for model in [
        HysteresisModel::PrandtlIshlinskii(sum.clone()),
        HysteresisModel::PrandtlIshlinskii(PrandtlIshlinskii { rate_s: 0.02, ..sum }),
        HysteresisModel::MaxwellSlip(slip),
        HysteresisModel::DahlGrowing(DahlGrowing::from_array([0.3, 9.8, 0.9, -0.15, -1.2, 2.0, 1.5, 0.17, -0.08])),
    ] {
        let last = |pieces: usize| -> f64 {
            let (time, path) = timed(pieces);
            model.follow(&time, &path).last().copied().unwrap()
        };
        for pieces in [7, 300] {
            assert!((last(pieces) - last(1)).abs() < 1e-9, "{model:?}: {} {}", last(pieces), last(1));
        }
        let again = model.with_parameters(&model.parameters()).unwrap();
        assert_eq!(again, model);
        assert_eq!(model.parameter_names().len(), model.parameters().len());
        assert!(model.with_parameters(&[1.0]).is_err());
    }
}

#[test]
fn a_faster_path_makes_a_wider_loop() {
    let width = |duration_s: f64| {
        let plays = vec![PlayElement { weight: 1.0, half_width: 0.1 }];
        let model = PrandtlIshlinskii { rate_s: 0.02, ..PrandtlIshlinskii::classical(0.0, plays) };
        let model = HysteresisModel::PrandtlIshlinskii(model);
        let mut state = model.rest(0.0);
        let mut at = |from: f64, to: f64| {
            model.advance(&mut state, from, to, duration_s);
            model.output(to, &state)
        };
        let up = at(0.0, 1.5);
        at(1.5, 3.0);
        at(3.0, 1.5) - up
    };
    // 2 (r + tau v)
    assert!((width(1.0) - 2.0 * (0.1 + 0.02 * 1.5)).abs() < 1e-12);
    assert!((width(0.5) - 2.0 * (0.1 + 0.02 * 3.0)).abs() < 1e-12);
}

#[test]
fn a_runaway_state_is_not_a_number() {
    let model = SymmetricBoucWen::from_array([1.0f64, 1.0, 1.0, -3.0, 0.0, 2.0]);
    assert!(model.advance(1.0, 0.0, 10.0_f64).is_nan());
}

#[test]
fn parameter_derivatives_meet_differences() {
    for model in models() {
        let values = model.parameters();
        let end = |p: &[f64]| {
            let (outputs, _) = model.with_parameters(p).unwrap().follow(0.0, &TURNS);
            outputs[3]
        };
        for i in 0..values.len() {
            let mut dual: Vec<Dual64> = values.iter().map(|&v| Dual64::from(v)).collect();
            dual[i] = dual[i].derivative();
            let path = TURNS.map(Dual64::from);
            let (outputs, _) = model.with_parameters(&dual).unwrap().follow(Dual64::from(0.0), &path);
            let h = 1e-5;
            let (mut low, mut high) = (values.clone(), values.clone());
            low[i] -= h;
            high[i] += h;
            let slope = (end(&high) - end(&low)) / (2.0 * h);
            assert!(
                (outputs[3].eps - slope).abs() < 2e-6 * (1.0 + slope.abs()),
                "{}: {} for {slope}",
                model.parameter_names()[i],
                outputs[3].eps
            );
        }
    }
}

proptest! {
    #[test]
    fn integrator_meets_the_closed_form(
        z in -2.0f64..2.0, drive in -3.0f64..3.0, above in -0.3f64..3.0, below in -0.3f64..3.0,
        length in 0.0f64..5.0,
    ) {
        let branch = Branch { drive, decay_above: above, decay_below: below, exponent: 1.0 };
        let exact = branch.closed_form(z, length);
        let found = branch.integrate(z, length);
        prop_assert!((found - exact).abs() < 1e-8 * exact.abs().max(1.0), "{found} {exact}");
    }

    /// Prandtl-Ishlinskii plays also forget how finely they were moved.
    #[test]
    fn play_semigroup(w in -1.0f64..1.0, x in -3.0f64..3.0, y in -3.0f64..3.0, share in 0.0f64..1.0) {
        let play = Play { half_width: 0.4 };
        let start = play.advance(w, x);
        let direct = play.advance(start, y);
        let halfway = play.advance(start, x + share * (y - x));
        prop_assert!((play.advance(halfway, y) - direct).abs() < 1e-12);
    }
}
