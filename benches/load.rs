//! Does memory stay flat over thousands of diagnoses in one process?
//!
//! Short recordings of the bench, noise anew in each: with nothing missing, and with five effects in turn, each diagnosed from
//! files as `smam diagnose` does. After every tenth of them: resident memory, and processor time. On Linux, where `/proc`
//! says what a process holds.
//!
//! ```sh
//! cargo bench --no-default-features --bench load -- 10000
//! ```

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::Path;

use cpu_time::ProcessTime;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use smam::diagnose::programme::{Stroke, sample, sine};
use smam::diagnose::{Case, Options, diagnose};
use smam::recording::{Channel, Recording};
use smam::scene::Scene;
use smam::system::{InputSource, Schedule, Simulation, record};

/// Diagnoses where no number is given.
const USUAL: usize = 100;
/// Two runs each: plunger frequency, Hz.
const RUNS_HZ: [f64; 2] = [0.2, 0.33];
const DURATION_S: f64 = 10.0;
/// Standard deviation of the noise of each column.
const NOISE: [(&str, f64); 2] = [("elongation_mm", 0.02), ("pressure_kpa", 5.0)];
const MISSING: [&str; 6] = [
    "",
    "name = \"trapped_air\"\nelement = \"line\"\nfree_volume_m3 = 4e-10\n",
    "name = \"leak\"\nelement = \"line\"\nconductance_m3_s_pa = 2e-17\n",
    "name = \"plunger_backlash\"\nelement = \"syringe\"\nwidth_m = 4e-5\n",
    "name = \"viscoelasticity\"\nelement = \"muscle\"\nstiffness_n_m = 4.0\nrelaxation_time_s = 2.0\n",
    "name = \"coil_preload\"\nelement = \"muscle\"\npreload_n = 0.05\n",
];

fn main() -> Result<(), Box<dyn Error>> {
    let asked = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    let count = asked.map_or(Ok(USUAL), |a| a.parse())?;
    let specimens = MISSING.map(specimen).into_iter().collect::<Result<Vec<_>, _>>()?;
    let (begun, folder) = (ProcessTime::now(), tempfile::tempdir()?);
    let mut verdicts: BTreeMap<String, usize> = BTreeMap::new();
    for number in 0..count {
        if number % count.div_ceil(10) == 0 {
            print_memory(number, begun);
        }
        write_set(&specimens[number % specimens.len()], number as u64, folder.path())?;
        let outcome = diagnose(Case::load(&[folder.path()], None, &[])?, Options { seed: 1 }, &|_| {})?;
        *verdicts.entry(format!("{:?}", outcome.diagnosis.verdict)).or_default() += 1;
    }
    print_memory(count, begun);
    println!("{verdicts:?}");
    Ok(())
}

/// What the bench shows with an effect, without noise.
fn specimen(effect: &str) -> Result<Vec<Recording>, Box<dyn Error>> {
    let mut scene = Scene::load("muscle_bench", &[])?;
    if !effect.is_empty() {
        scene.file.effect.push(toml::from_str(effect)?);
        scene = Scene::from_file(scene.file, &scene.path)?;
    }
    RUNS_HZ.iter().map(|hz| play(&scene, *hz)).collect()
}

fn play(scene: &Scene, frequency_hz: f64) -> Result<Recording, Box<dyn Error>> {
    let stroke = Stroke { column: "plunger_mm".to_owned(), low: 0.0, high: 3e-3, with_first: 1.0 };
    let mut recording = sample(&[stroke], DURATION_S, |t, _| sine(t, frequency_hz))?;
    let mut simulation = Simulation::new(scene.clone())?;
    simulation.set_input("plunger_mm", InputSource::Recorded(recording.piecewise_si("plunger_mm")?));
    let shown = record(&mut simulation, &Schedule::at(recording.time_s().to_vec()))?;
    for (column, _) in NOISE {
        recording.push(shown.channel(column)?.clone())?;
    }
    Ok(recording)
}

/// Writes recordings with noise of their own, as a rig would leave them.
fn write_set(runs: &[Recording], seed: u64, folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut text =
        "format = 1\nscene = \"muscle_bench\"\n\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n".to_owned();
    for (column, sd) in NOISE {
        text += &format!("\n[[channel]]\ncolumn = \"{column}\"\nrole = \"output\"\nnoise_sd = {sd}\n");
    }
    for (number, run) in runs.iter().enumerate() {
        let file = format!("run_{number}.csv");
        text += &format!("\n[[run]]\nfile = \"{file}\"\n");
        noisy(run, &mut random)?.write_csv(&folder.join(file))?;
    }
    Ok(fs::write(folder.join("recordings.toml"), text)?)
}

fn noisy(run: &Recording, random: &mut ChaCha8Rng) -> Result<Recording, Box<dyn Error>> {
    let mut channels = vec![run.channel("plunger_mm")?.clone()];
    for (column, sd) in NOISE {
        let noise = Normal::new(0.0, sd)?;
        let values = run.channel(column)?.values.iter().map(|v| v + noise.sample(random)).collect();
        channels.push(Channel::new(column, values));
    }
    Ok(Recording::new(run.time_s().to_vec(), channels)?)
}

fn print_memory(diagnoses: usize, begun: ProcessTime) {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kib = |key: &str| -> Option<f64> {
        status.lines().find(|l| l.starts_with(key))?.split_whitespace().nth(1)?.parse().ok()
    };
    let mb = |key: &str| kib(key).map_or("-".to_owned(), |kib| format!("{:.1} MB", kib * 1.024e-3));
    let (now, most) = (mb("VmRSS:"), mb("VmHWM:"));
    println!(
        "{diagnoses:>6} diagnoses: {now:>9} resident, {most:>9} at most, {:>8.1?} of processor time",
        begun.elapsed()
    );
}
