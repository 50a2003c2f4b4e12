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
