//! Contract: a law that is written in a scene does what its port says, in the full scene and in the reduced-order model, and an independent
//! program that had the same laws hidden in it agrees.
//!
//! Recordings of that program are looked for in `../shared/recordings/practice_laws`; where they are not, that is said.

use std::path::{Path, PathBuf};

use serde_json::Value;
use smam::laws::LawTable;
use smam::recording::{Recording, RecordingSet, read_recording};
use smam::scene::{Override, Scene};
use smam::system::{InputSource, Schedule, Simulation, record};

mod practice_laws {
    use super::*;

    /// Greatest root mean square error, in units of the stated noise, at which a law counts as said rightly.
    const WITHIN: f64 = 1.10;

    fn folder() -> Option<PathBuf> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/recordings/practice_laws");
        folder.is_dir().then_some(folder)
    }

    /// `-0.07199 * (ln(1 + |x|)), x = time / 34.01 (SI)` as an expression of this program.
    fn expression(truth: &Value) -> String {
        let text = truth["law"].as_str().expect("a law");
        let (law, rest) = text.split_once(", x = ").expect("with its variable");
        let (variable, rest) = rest.split_once(" / ").expect("over a scale");
        let scale: f64 = rest.trim_end_matches(" (SI)").parse().expect("a number");
        let name = match variable {
            "angle" => "angle_rad",
            "time" => "time_s",
            "elongation" => "elongation_m",
            "pressure" => "pressure_pa",
            "speed" => "speed_m_s",
            other => panic!("{other}"),
        };
        let law = law.replace("tanh x", "tanh(x)").replace("|x|", "abs(x)");
        let x = format!("({name}/{scale:e})");
        let letters: Vec<char> = law.chars().collect();
        let is_word = |i: usize| letters.get(i).is_some_and(|c| c.is_ascii_alphanumeric());
        let spelled = letters.iter().enumerate().map(|(i, c)| match c {
            'x' if !(is_word(i + 1) || i > 0 && is_word(i - 1)) => x.clone(),
            c => c.to_string(),
        });
        spelled.collect()
    }

    fn law(truth: &Value) -> LawTable {
        let word = |key: &str| truth[key].as_str().expect(key).to_owned();
        let (element, port, expression) = (word("element"), word("port"), expression(truth));
        let number = element.rsplit_once('_').map(|(_, number)| number);
        let numbered = number.map(|n| port.replacen('.', &format!("_{n}."), 1));
        let law = LawTable { name: "hidden".to_owned(), port: numbered.unwrap_or(port), ..LawTable::default() };
        match truth["acts"].as_str() {
            Some("scales") => LawTable { scales: Some(format!("1 + {expression}")), ..law },
            _ => LawTable { adds: Some(expression), ..law },
        }
    }

    fn calibrated(truth: &Value) -> Scene {
        let keys = [
            ("tube_c1_pa", "c1"),
            ("upstream_compliance_m3_pa", "Cs"),
            ("friction_m0_n", "m0"),
            ("friction_m1_n_pa", "m1"),
            ("presliding_length_m", "lh"),
        ];
        let number = |key: &str| truth["calibration"][key].as_f64().expect("a number");
        let mut overrides: Vec<Override> = keys.iter().map(|(key, own)| Override::number(*key, number(own))).collect();
        // The fluid of that program never boils.
        overrides.push(Override::number("hydraulics.fluid.tensile_strength_pa", 1e9));
        Scene::load(truth["rig"].as_str().expect("a rig"), &overrides).unwrap_or_else(|e| panic!("{e}"))
    }

    fn replay(scene: Scene, recorded: &Recording) -> Recording {
        let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
        let inputs: Vec<String> = simulation.scene().file.input.iter().map(|i| i.channel.clone()).collect();
        for input in &inputs {
            let line = recorded.piecewise_si(input).unwrap_or_else(|e| panic!("{e}"));
            simulation.set_input(input, InputSource::Recorded(line));
        }
        record(&mut simulation, &Schedule::at(recorded.time_s().to_vec())).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Of each output that was recorded: its error over the noise that is stated for it.
    fn errors(simulated: &Recording, recorded: &Recording, set: &RecordingSet) -> Vec<(String, f64)> {
        let with_noise = set.channels.iter().filter_map(|c| Some((c.column.clone(), c.noise_sd?)));
        let error = |(column, noise): (String, f64)| {
            let (own, other) = (simulated.channel(&column).ok()?, recorded.channel(&column).ok()?);
            let squares: Vec<f64> = own.values.iter().zip(&other.values).map(|(a, b)| (a - b).powi(2)).collect();
            let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            Some((column, rms / noise))
        };
        with_noise.filter_map(error).collect()
    }

    #[test]
    fn laws_of_an_independent_program_predict_its_recordings() {
        let Some(folder) = folder() else {
            println!("skipped: ../shared/recordings/practice_laws is not there");
            return;
        };
        let text = std::fs::read_to_string(folder.join("truth.json")).expect("the truths");
        let truths: Value = serde_json::from_str(&text).expect("JSON");
        let mut wrong = Vec::new();
        for (name, truth) in truths.as_object().expect("by name") {
            let recorded = read_recording(&folder.join(format!("{name}.holdout.csv"))).expect("a recording");
            let set = RecordingSet::load(&folder.join(name)).expect("a folder");
            let mut scene = calibrated(truth);
            let without = errors(&replay(scene.clone(), &recorded), &recorded, &set);
            let law = law(truth);
            scene.file.law.push(law.clone());
            let scene = Scene::from_file(scene.file, &scene.path).unwrap_or_else(|e| panic!("{name}: {e}"));
            let with = errors(&replay(scene, &recorded), &recorded, &set);
            for ((column, before), (_, after)) in without.iter().zip(&with) {
                println!(
                    "{name} {column}: {before:.3} -> {after:.3} of the noise, {} {:?}{:?}",
                    law.port, law.adds, law.scales
                );
                if *after > WITHIN {
                    wrong.push(format!("{name} {column}: {after:.3}"));
                }
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
