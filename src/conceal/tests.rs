//! The concealing plant against closed forms and the paper's figures, and cases as a whole.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S, Wave, programme};
use super::seal::{seal, sealed_text};
use super::solve::solve;
use super::stock::{Calibration, Rig, STRING_LOAD_N};
use super::{Further, Hiding, draw};
use crate::recording::{Channel, Recording};

/// A plunger that goes to a position over three seconds and stays for seven.
fn held(to_m: f64) -> Vec<Drive> {
    let at = |k: usize| to_m * (k as f64 * SAMPLE_S / 3.0).min(1.0);
    vec![Drive { positions_m: (0..1000).map(at).collect() }]
}

/// Drawn: 3 mm of plunger give about 27 mm; unloading lies above loading.
#[test]
fn the_stock_muscle_moves_as_the_paper_says() {
    let plant = Plant::new(Rig::MuscleBench, Calibration::STOCK);
    let out = solve(&plant, &held(2.9e-3)).expect("a stock muscle");
    let end = out[0].last().copied().unwrap_or(0.0);
    assert!((25.0..30.0).contains(&end), "{end} mm");
    assert!((1900.0..2400.0).contains(&out[1][999]), "{} kPa", out[1][999]);
}

/// Fluid is not lost: what leaves the syringe fills the muscle and the compliances; a leak takes the rest.
#[test]
fn a_leak_takes_what_it_says() {
    let mut plant = Plant::new(Rig::MuscleBench, Calibration::STOCK);
    let tight = solve(&plant, &held(2.0e-3)).expect("a stock muscle");
    plant.muscles[0].leak = 2e-16;
    let leaking = solve(&plant, &held(2.0e-3)).expect("a leaking muscle");
    // Lost volume: the integral of G p; it shows as elongation and as relieved compliances.
    let lost_m3: f64 = leaking[1].iter().map(|p| 2e-16 * p * 1e3 * SAMPLE_S).sum();
    let (de, dp) = (1e-3 * (tight[0][999] - leaking[0][999]), 1e3 * (tight[1][999] - leaking[1][999]));
    let seen_m3 = super::stock::COIL_AREA_M2 * de + (8.0e-15 + 2.6e-15) * dp;
    assert!((seen_m3 / lost_m3 - 1.0).abs() < 0.02, "{seen_m3:e} {lost_m3:e}");
}

#[test]
fn mechanisms_start_in_balance_and_stay_there() {
    for rig in [Rig::AntagonisticPulley, Rig::BendingCatheter] {
        let plant = Plant::new(rig, Calibration::STOCK);
        let still = vec![Drive { positions_m: vec![0.0; 50] }; 2];
        let out = solve(&plant, &still).expect("a rig at rest");
        for channel in out {
            let moved = channel.iter().fold(0.0f64, |m, x| m.max((x - channel[0]).abs()));
            assert!(moved < 1e-3, "{rig:?} moved by {moved}");
        }
    }
}

#[test]
fn the_same_seed_hides_the_same() {
    let text =
        |seed| sealed_text(&draw("a", Rig::MuscleBench, Hiding::Nothing, seed).expect("a case").truth).expect("JSON");
    assert_eq!(seal(&text(7)), seal(&text(7)));
    assert_ne!(seal(&text(7)), seal(&text(8)));
}

/// Programmes begin at rest and stay within the stroke.
#[test]
fn programmes_stay_within_the_stroke() {
    for rig in Rig::ALL {
        for wave in [Wave::Sine, Wave::Steps, Wave::Chirp, Wave::Triangle, Wave::Wander, Wave::TwoTone] {
            let drives = programme(rig, wave, wave.duration_s(), &mut ChaCha8Rng::seed_from_u64(5));
            for (drive, (low, high)) in drives.iter().zip(rig.strokes_m()) {
                let slack = 0.06 * (high - low);
                assert!(drive.positions_m[0].abs() < 1e-12, "{rig:?} {wave:?}");
                let inside = |x: &f64| (low - slack..=high + slack).contains(x);
                assert!(drive.positions_m.iter().all(inside), "{rig:?} {wave:?}");
            }
        }
    }
}

/// The run added is the programme asked for, on a rig that has aged by all the runs before.
#[test]
fn a_run_asked_for_is_played_after_the_others() {
    let drawn = draw("a", Rig::MuscleBench, Hiding::Nothing, 3).expect("a case");
    let t: Vec<f64> = (0..300).map(|k| f64::from(k) * SAMPLE_S).collect();
    let asked_mm: Vec<f64> = t.iter().map(|t| 0.5 * t).collect();
    let asked = Recording::new(t, vec![Channel::new("plunger_mm", asked_mm)]).expect("a recording");
    let quiet = super::case::Truth {
        noise: drawn.truth.noise.iter().map(|n| super::ChannelNoise { sd: 0.0, ..*n }).collect(),
        decoys: Vec::new(),
        ..drawn.truth.clone()
    };
    let played = super::record_asked(&quiet, &asked, None, Further::default()).expect("a run");
    assert_eq!(played.time_s().len(), 300);
    assert!((played.channel("plunger_mm").expect("there").values[200] - 1.0).abs() < 1e-9);
    let plant = Plant::new(Rig::MuscleBench, quiet.calibration);
    let drive = vec![Drive { positions_m: (0..300).map(|k| 0.5e-3 * f64::from(k) * SAMPLE_S).collect() }];
    let expected = solve(&plant, &drive).expect("the same");
    let shown = &played.channel("elongation_mm").expect("there").values;
    assert!(shown.iter().zip(&expected[0]).all(|(a, b)| (a - b).abs() < 1e-4));
    let random = super::record_drawn(&drawn.truth, 20.0, None, Further::default()).expect("a run");
    assert!((random.time_s().last().copied().unwrap_or(0.0) - 20.0).abs() < 0.2);
}

/// A load cell that is added shows the string's load once the muscle rests, and leaves the other channels as they were.
#[test]
fn a_sensor_is_added_to_one_run_and_changes_nothing_else() {
    let drawn = draw("a", Rig::MuscleBench, Hiding::Nothing, 3).expect("a case");
    let t: Vec<f64> = (0..800).map(|k| f64::from(k) * SAMPLE_S).collect();
    let asked_mm: Vec<f64> = t.iter().map(|t| 0.5 * t.min(2.0)).collect();
    let asked = Recording::new(t, vec![Channel::new("plunger_mm", asked_mm)]).expect("a recording");
    let plain = super::record_asked(&drawn.truth, &asked, None, Further::default()).expect("a run");
    let with = super::record_asked(&drawn.truth, &asked, Some("force_n"), Further::default()).expect("a run");
    assert!(plain.find("force_n").is_none());
    let shown = &with.channel("force_n").expect("asked for").values;
    let rest = &shown[shown.len() / 2..];
    let mean = rest.iter().sum::<f64>() / rest.len() as f64;
    assert!((mean - STRING_LOAD_N).abs() < 5e-3, "{mean}");
    for channel in plain.channels() {
        let same = &with.channel(&channel.column).expect("there").values;
        assert!(same.iter().zip(&channel.values).all(|(a, b)| a.to_bits() == b.to_bits()), "{}", channel.column);
    }
    assert!(
        super::sensor_noise(&drawn.truth, "force_n").is_some()
            && super::sensor_noise(&drawn.truth, "tension_1_n").is_none()
    );
}

/// A lag shorter than the sampling interval is as long as it says, too.
#[test]
fn a_ramp_lags_by_the_time_constant() {
    let kind = super::secrets::KINDS.iter().find(|k| k.name == "sensor_lag").expect("listed");
    for (size, is_altered) in [(0.003, false), (0.007, true), (0.05, false), (0.05, true)] {
        let secret = super::Secret { size, is_altered, ..super::Secret::typical(kind, Rig::MuscleBench, 0, 0) };
        let mut ramp: Vec<f64> = (0..400).map(|k| f64::from(k) * SAMPLE_S).collect();
        let end = ramp[399];
        secret.corrupt(&mut ramp, SAMPLE_S, 0.0);
        assert!((end - ramp[399] - size).abs() < 1e-9, "{size} {is_altered}: {}", end - ramp[399]);
    }
}

/// A law so steep that the plant cannot be followed: the next seed's is drawn, and the truth says which that was.
#[test]
fn a_rig_that_cannot_be_followed_is_drawn_again() {
    const FLUTTERS: u64 = 18_446_723_812_521_768_211;
    let drawn = draw("a", Rig::BendingCatheter, Hiding::Law, FLUTTERS).expect("another");
    assert_ne!(drawn.truth.seed, FLUTTERS);
    let again = draw("a", Rig::BendingCatheter, Hiding::Law, drawn.truth.seed).expect("the same");
    assert_eq!(again.truth, drawn.truth);
}
