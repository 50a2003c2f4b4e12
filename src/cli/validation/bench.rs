//! `smam bench`.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use clap::Args;
use smam::bench::{CASES, Growth, ROMS, RomSpeed, SceneCase, grow, worst_errors};

use crate::cli::CliError;

/// Arguments of `smam bench`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam bench                                             the program alone, a minute or two
  smam bench --peers benches/peers --python venv/bin/python   MuJoCo's twins of the scenes in the same minutes")]
pub struct BenchArguments {
    /// Runs of which each figure is the median
    #[arg(long, default_value_t = 5)]
    times: usize,
    /// Run MuJoCo's twins as well: the folder with bench_mujoco.py
    #[arg(long, value_name = "DIR", requires = "python")]
    peers: Option<PathBuf>,
    /// A Python with mujoco==4.0.0
    #[arg(long, value_name = "PROGRAM", requires = "peers")]
    python: Option<PathBuf>,
}

/// Twins of the scenes in `benches/peers`.
const PEER_OF: [(&str, &str); 3] = [
    ("antagonistic_pulley", "antagonistic_pulley"),
    ("bending_catheter", "bending_catheter"),
    ("grip_and_release", "bending_catheter_ball"),
];

/// Runs the command.
pub fn bench(arguments: &BenchArguments) -> Result<ExitCode, CliError> {
    if arguments.times == 0 {
        return Err(CliError::Usage("--times 0: a figure needs a run\n  remedy: give 1 or more".to_owned()));
    }
    say!(
        "CPU time on one core, medians of {}; the error is that of the worst output, in % of its range\n",
        arguments.times
    );
    say!(
        "| scene | engine step | fine steps in it | error | a fine step | an engine step apart from them | x real time | goal | MuJoCo | ours over it |"
    );
    say!("|---|---|---|---|---|---|---|---|---|---|");
    for case in &CASES {
        say!("{}", scene_row(case, arguments)?);
    }
    say!("\n| reduced-order model of | step | x real time, sets one by one | side by side | ratio | goal |");
    say!("|---|---|---|---|---|---|");
    for (scene, goal) in ROMS {
        say!("{}", rom_row(&format!("`{scene}`"), RomSpeed::of(scene, arguments.times)?, goal));
    }
    let (bench, goal) = ROMS[0];
    say!("{}", rom_row(&format!("`{bench}` with one law"), RomSpeed::with_law(bench, arguments.times)?, goal / 1.5));
    let folder = tempfile::tempdir().map_err(|source| CliError::Write { file: std::env::temp_dir(), source })?;
    say!("\n| with more | CPU time of | from | to | exponent | on paper |");
    say!("|---|---|---|---|---|---|");
    grow(folder.path(), arguments.times)?.iter().for_each(|growth| say!("{}", growth_row(growth)));
    Ok(ExitCode::SUCCESS)
}

fn rom_row(name: &str, speed: RomSpeed, goal: f64) -> String {
    let RomSpeed { step_s, singly, side_by_side } = speed;
    let ratio = side_by_side / singly;
    format!("| {name} | {:.1} ms | {singly:.0} | {side_by_side:.0} | {ratio:.2} | {goal:.0} |", 1e3 * step_s)
}

fn scene_row(case: &SceneCase, arguments: &BenchArguments) -> Result<String, CliError> {
    let errors = worst_errors(&case.recorded(1.0, 1)?, &case.recorded(4.0, 4)?);
    // A ball is judged in micrometres (`cargo bench --bench scenes`): its range in the jaws is nothing.
    let judged = errors.iter().filter(|(column, _)| !column.starts_with("ball_"));
    let (worst, percent) = judged.fold(("", 0.0), |worst, (c, e)| if *e > worst.1 { (c.as_str(), *e) } else { worst });
    let speed = case.speed(arguments.times)?;
    let peer = match PEER_OF.iter().find(|(scene, _)| *scene == case.scene) {
        Some((_, twin)) => peer_speed(twin, arguments)?,
        None => None,
    };
    let beside = peer.map_or("- | -".to_owned(), |p| format!("{p:.0} | {:.2}", speed.times_real_time / p));
    Ok(format!(
        "| `{}` | {} ms | {} | {percent:.3} % ({worst}) | {:.2} us | {:.1} us | {:.0} | {:.0} | {beside} |",
        case.scene,
        1e3 * case.step_s,
        case.substeps,
        1e6 * speed.fine_step_s,
        1e6 * speed.engine_step_s,
        speed.times_real_time,
        case.goal
    ))
}

/// What MuJoCo reaches on its twin, times real time, at the best of its integrators' largest accurate steps.
fn peer_speed(twin: &str, arguments: &BenchArguments) -> Result<Option<f64>, CliError> {
    let (Some(folder), Some(python)) = (&arguments.peers, &arguments.python) else { return Ok(None) };
    let script = folder.join("bench_mujoco.py");
    let failed = |message: String| {
        CliError::Usage(format!(
            "{}: {message}\n  remedy: give a Python with mujoco==4.0.0, and the folder benches/peers",
            script.display()
        ))
    };
    let case = format!("--case={twin}");
    let output = Command::new(python).arg(&script).args(["--time-only", &case, &arguments.times.to_string()]).output();
    let output = output.map_err(|e| failed(format!("{} cannot be started: {e}", python.display())))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(failed(said.lines().last().unwrap_or("it failed").to_owned()));
    }
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).map_err(|e| failed(e.to_string()))?;
    let integrators = result["cases"][twin]["integrators"].as_object();
    let speeds = integrators.into_iter().flat_map(|all| all.values()).filter_map(|row| {
        let speed = &row["speed"];
        Some(speed["steps_per_cpu_s_median"].as_f64()? * speed["dt_s"].as_f64()?)
    });
    let best = speeds.fold(0.0, f64::max);
    if best > 0.0 { Ok(Some(best)) } else { Err(failed(format!("it gave no speed for {twin}"))) }
}

fn growth_row(growth: &Growth) -> String {
    let ms = |cost: Option<&(f64, f64)>| cost.map_or(String::new(), |(n, t)| format!("{n:.0}: {:.2} ms", 1e3 * t));
    format!(
        "| {} | {} | {} | {} | {:.2} | {:.0} ({}) |",
        growth.part,
        growth.of,
        ms(growth.costs.first()),
        ms(growth.costs.last()),
        growth.exponent(),
        growth.expected,
        growth.reason
    )
}
