//! Contract: parameters that `check_loops` passes never make a closed loop that turns the wrong way.

use super::*;
use proptest::prelude::*;

/// `∮ h dx` over a round of a path that the state closes, `h` the hysteretic part of the output.
///
/// The rounds before bring the state to its cycle: a few of them, or thousands where a path is far too short for the
/// state to saturate. The trapezoid rule meets the integral on fine pieces.
fn round_work(model: &HysteresisModel<f64>, turns: &[f64]) -> f64 {
    const PIECES: usize = 60;
    const ROUNDS: usize = 30;
    const MOST_ROUNDS: usize = 20_000;
    let mut state = model.rest(turns[0]);
    // Straight from turn to turn: the laws are exact on a monotone piece, however long.
    for round in 0..MOST_ROUNDS {
        let before = state.clone();
        for (i, &from) in turns.iter().enumerate() {
            model.advance(&mut state, from, turns[(i + 1) % turns.len()], 0.01);
        }
        let moved = before.iter().zip(&state).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if round > ROUNDS && moved < 1e-7 {
            break;
        }
    }
    let mut work = 0.0;
    for round in 0..ROUNDS {
        for (i, &from) in turns.iter().enumerate() {
            let step = (turns[(i + 1) % turns.len()] - from) / PIECES as f64;
            for piece in 0..PIECES {
                let (x, y) = (from + step * piece as f64, from + step * (piece + 1) as f64);
                let before = model.output(x, &state);
                model.advance(&mut state, x, y, 0.01);
                if round + 1 == ROUNDS {
                    work += 0.5 * (before + model.output(y, &state)) * (y - x);
                }
            }
        }
    }
    work
}

fn turns(low: f64) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(low..3.0, 2..7)
}

/// Works are compared with this, mm²: what the trapezoid rule leaves of a path's 18 mm.
const ROUNDING: f64 = 2e-3;

fn symmetric([k, lambda, share, n]: [f64; 4], gamma_z: f64) -> HysteresisModel<f64> {
    HysteresisModel::Symmetric(SymmetricBoucWen::from_array([0.0, gamma_z, k, lambda, share * lambda, n]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn symmetric_loops(k in 0.2f64..3.0, lambda in 0.1f64..4.0, share in -1.0f64..1.0, n in 0.6f64..2.5, path in turns(-3.0)) {
        let model = symmetric([k, lambda, share, n], 1.0);
        prop_assume!(model.check_loops([-3.0, 3.0]).is_ok());
        prop_assert!(round_work(&model, &path) > -ROUNDING);
    }

    #[test]
    fn asymmetric_loops(a in 0.2f64..3.0, n in 0.6f64..2.5, shape in prop::array::uniform6(-0.4f64..0.4), b1 in 0.5f64..3.0, path in turns(-3.0)) {
        let shape = [b1, shape[1], shape[2], shape[3], shape[4], shape[5]];
        let model = HysteresisModel::Asymmetric(AsymmetricBoucWen { alpha_x: 0.0, alpha_z: 1.0, a, n, shape });
        prop_assume!(model.check_loops([-3.0, 3.0]).is_ok());
        prop_assert!(round_work(&model, &path) > -ROUNDING);
    }

    #[test]
    fn paper_loops(a in 0.2f64..3.0, share in -0.9f64..0.9, nu in 0.1f64..4.0, n in 0.6f64..2.5, gated: bool, path in turns(0.0)) {
        let gate = if gated { Gate::Tanh } else { Gate::None };
        let model = PaperModel { gate, ..PaperModel::from_array([0.0, 0.0, 1.0, a, n, nu, share * a]) };
        prop_assume!(model.check_loops().is_ok());
        prop_assert!(round_work(&HysteresisModel::Paper(model), &path) > -ROUNDING);
    }

    #[test]
    fn play_loops(kappa in 0.0f64..0.15, rate_s in 0.0f64..0.01, weights in prop::array::uniform3(0.0f64..3.0), path in turns(0.0)) {
        let elements = weights.iter().zip([0.05, 0.2, 0.6]).map(|(&weight, half_width)| PlayElement { weight, half_width });
        let model = PrandtlIshlinskii {
            asymmetry: kappa,
            rate_s,
            ..PrandtlIshlinskii::classical(0.0, elements.collect())
        };
        prop_assume!(model.check_loops(3.0).is_ok());
        // A play lags its input: it turns the other way.
        prop_assert!(-round_work(&HysteresisModel::PrandtlIshlinskii(model), &path) > -ROUNDING);
    }

    #[test]
    fn slip_loops(stiffness in prop::array::uniform3(0.0f64..3.0), gated: bool, growth in -0.3f64..3.0, path in turns(0.0)) {
        let model = slip(stiffness, if gated { Gate::Tanh } else { Gate::None }, growth);
        prop_assume!(model.check_loops([0.0, 3.0]).is_ok());
        prop_assert!(round_work(&HysteresisModel::MaxwellSlip(model), &path) > -ROUNDING);
    }

    #[test]
    fn dahl_loops(growth in -0.3f64..3.0, nu in 0.1f64..4.0, rho in -0.9f64..0.9, bend in -0.15f64..0.15, path in turns(0.0)) {
        let model = DahlGrowing::from_array([0.0, 0.0, 0.0, 0.0, 1.0, growth, nu, rho, bend]);
        prop_assume!(model.check_loops([0.0, 3.0]).is_ok());
        prop_assert!(round_work(&HysteresisModel::DahlGrowing(model), &path) > -ROUNDING);
    }
}

/// Friction that grows faster than it fades yields energy on a small loop, and is refused.
#[test]
fn dahl_friction_that_grows_too_fast_is_refused() {
    let model = |growth: f64| DahlGrowing::from_array([0.0, 0.0, 0.0, 0.0, 1.0, growth, 0.1, 0.0, 0.0]);
    assert!(model(0.1).check_loops([0.0, 3.0]).is_ok());
    assert!(model(1.0).check_loops([0.0, 3.0]).is_err());
    assert!(model(-0.5).check_loops([0.0, 3.0]).is_err());
    assert!(DahlGrowing { rho: 1.0, ..model(0.1) }.check().is_err());
}

fn slip(stiffness: [f64; 3], gate: Gate, growth: f64) -> MaxwellSlip<f64> {
    let elements = stiffness.iter().zip([0.05, 0.2, 0.6]).map(|(&stiffness, reach)| SlipElement { stiffness, reach });
    MaxwellSlip { offset: 0.0, gain: 0.0, curvature: 0.0, cubic: 0.0, growth, gate, elements: elements.collect() }
}

/// Where `1 + c x` is negative a loop turns the other way.
#[test]
fn sliders_that_grow_past_zero_are_refused_and_gain() {
    let model = slip([1.0, 1.0, 1.0], Gate::None, 1.0);
    assert!(model.check_loops([0.0, 3.0]).is_ok() && model.check_loops([-3.0, 3.0]).is_err());
    assert!(slip([1.0; 3], Gate::Tanh, 0.0).check_loops([-3.0, 3.0]).is_err());
    assert!(round_work(&HysteresisModel::MaxwellSlip(model), &[-3.0, -1.2]) < -0.1);
}

#[test]
fn a_loop_that_gains_is_refused_and_gains() {
    let gaining = symmetric([1.0, 0.5, -3.0, 1.0], 1.0);
    // Unbounded on one side, so `check` already speaks; with delta above lambda only `check_loops` does.
    assert!(gaining.check().is_err());
    let leaning = symmetric([1.0, 0.5, 3.0, 1.0], 1.0);
    assert!(leaning.check().is_ok());
    let said = leaning.check_loops([-3.0, 3.0]).unwrap_err().to_string();
    assert_eq!(said, "symmetric Bouc-Wen: lambda - |delta| = -1 must be >= 0");
    let mixed = PrandtlIshlinskii::classical(
        1.0,
        vec![PlayElement { weight: 1.0, half_width: 0.1 }, PlayElement { weight: -2.0, half_width: 0.3 }],
    );
    assert!(mixed.check().is_ok() && mixed.check_loops(3.0).is_err());
    assert!(round_work(&HysteresisModel::PrandtlIshlinskii(mixed), &[0.0, 3.0]) > 0.1);
}
