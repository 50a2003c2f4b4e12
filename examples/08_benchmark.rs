//! Writes the benchmark for other tools: recordings that hide something, the calibrated scene with its simulation of them, and the
//! truth (docs/benchmark.md).
//!
//! ```text
//! cargo run --release --example benchmark -- OUT [CASE..]      all twelve, or some by name
//! ```

use std::error::Error;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use smam::conceal::{Drawn, Hiding, Rig, Secret, draw, write_case};
use smam::diagnose::{Case, calibrated_scene};
use smam::identify::{RecordedRun, load_runs, replay};
use smam::recording::{Recording, RecordingSet, Run, RunUse};

/// Seed of the first case; the others count on from it, rig by rig.
const FIRST_SEED: u64 = 20_261_201;
const HIDDEN: [Hiding; 4] = [Hiding::Nothing, Hiding::One, Hiding::Several, Hiding::Law];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (out, wanted) = words.split_first().ok_or("where to? benchmark OUT [CASE..]")?;
    let all = Rig::ALL.iter().flat_map(|rig| HIDDEN.map(|hiding| (*rig, hiding)));
    for ((rig, hiding), seed) in all.zip(FIRST_SEED..) {
        let name = format!("case_{seed}");
        if wanted.is_empty() || wanted.contains(&name) {
            write(&draw(&name, rig, hiding, seed)?, Path::new(out))?;
            println!("{name}: {}", rig.scene());
        }
    }
    Ok(())
}

/// `cases/NAME/` for whoever answers, `truth/NAME.json` and `truth/NAME.csv` for whoever scores.
fn write(drawn: &Drawn, out: &Path) -> Result<(), Box<dyn Error>> {
    let (cases, truth) = (out.join("cases"), out.join("truth"));
    let (name, rig) = (&drawn.truth.name, drawn.truth.rig);
    let own = cases.join(name);
    for folder in [&own.join("calibrated"), &own.join("next"), &truth] {
        fs::create_dir_all(folder)?;
    }
    // What is kept back goes with the truth, so a case is drawn aside.
    let aside = tempfile::tempdir()?;
    write_case(drawn, aside.path())?;
    for file in fs::read_dir(aside.path().join(name))? {
        let file = file?;
        fs::copy(file.path(), own.join(file.file_name()))?;
    }
    let set = RecordingSet::load(&own)?;
    let runs = load_runs(&set, &set.runs, &mut |_| {})?;
    let scene = own.join("calibrated/scene.toml");
    fs::write(&scene, calibrated_scene(Case::load(&[&own], None, &[])?)?)?;
    let simulate = |run: &RecordedRun| simulate(rig, &scene, run);
    for run in &runs {
        simulate(run)?.write_csv(&own.join("calibrated").join(&run.run.file))?;
    }
    let next = Run { file: "next.csv".to_owned(), run_use: Some(RunUse::Holdout), ..Run::default() };
    let next = RecordedRun { run: next, recording: drawn.holdout.clone() };
    simulate(&next)?.write_csv(&own.join("next/calibrated.csv"))?;
    let inputs = |column: &str| rig.inputs().contains(&column);
    columns(&drawn.holdout, inputs)?.write_csv(&own.join("next/inputs.csv"))?;
    columns(&drawn.holdout, |column| !inputs(column))?.write_csv(&truth.join(format!("{name}.csv")))?;
    fs::write(truth.join(format!("{name}.json")), serde_json::to_string_pretty(&told(drawn))? + "\n")?;
    Ok(())
}

fn simulate(rig: Rig, scene: &Path, run: &RecordedRun) -> Result<Recording, Box<dyn Error>> {
    let simulated = replay(&scene.display().to_string(), &[], run, 1)?;
    columns(&simulated, |column| rig.outputs().iter().any(|o| o.column == column))
}

/// The same instants with some of the columns.
fn columns(recording: &Recording, wanted: impl Fn(&str) -> bool) -> Result<Recording, Box<dyn Error>> {
    let some = recording.channels().iter().filter(|c| wanted(&c.column)).cloned().collect();
    Ok(Recording::new(recording.time_s().to_vec(), some)?)
}

/// What is hidden, in the words of an answer.
fn told(drawn: &Drawn) -> Value {
    let truth = &drawn.truth;
    let noise = truth.rig.outputs().iter().zip(&truth.noise).map(|(o, noise)| (o.column.to_owned(), json!(noise.sd)));
    let causes: Vec<Value> = truth.secrets.iter().map(|secret| cause(truth.rig, secret)).collect();
    json!({
        "format": 1,
        "case": truth.name,
        "rig": truth.rig.scene(),
        "noise_sd": noise.collect::<serde_json::Map<_, _>>(),
        "excess_chi2_per_sample": (!causes.is_empty()).then_some(truth.wanted_excess),
        "causes": causes,
    })
}

fn cause(rig: Rig, secret: &Secret) -> Value {
    let effect = if secret.law.is_none() { json!(secret.name) } else { Value::Null };
    let law = secret.law.as_ref();
    let reads = law.map(|law| law.reads.into_iter().chain(law.times.map(|(reads, _)| reads)));
    let variables: Vec<&str> = reads.into_iter().flatten().map(|reads| reads.name()).collect();
    json!({
        "effect": effect,
        "element": secret.channel.as_ref().unwrap_or(&secret.element),
        "port": law.map(|law| law.port(rig, secret.muscle)),
        "variables": variables,
        "law": law.map(|law| law.table(rig, secret.muscle, secret.size)),
    })
}
