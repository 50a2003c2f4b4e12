//! The built program from the outside: what it says, where it points, what it leaves on disk, how it exits.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn smam(arguments: &[&str], folder: &Path) -> Output {
    // Elsewhere than in the project: scenes must be found by name from anywhere.
    Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output().expect("starts")
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("temporary folder")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml")
}

/// A stock scene with one piece of its text exchanged, in a folder beside its models.
fn changed_scene(folder: &Path, name: &str, from: &str, to: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).expect("stock scene");
    assert!(text.contains(from), "{name} has no {from}");
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let text = text.replace(from, to).replace("../models", &models.display().to_string());
    let path = folder.join("mine.toml");
    std::fs::write(&path, text).expect("written");
    path.display().to_string()
}

/// Fails with exit code 2 and says all of `words`.
fn refused(output: &Output, words: &[&str]) {
    let text = said(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    for word in words.iter().chain(&["error: ", "remedy: "]) {
        assert!(text.contains(word), "no {word:?} in: {text}");
    }
}

/// Names of what stands in a folder, hidden files included.
fn listing(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("folder");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn without_arguments_it_says_what_to_type_first() {
    let output = smam(&[], folder().path());
    assert_eq!(output.status.code(), Some(0));
    assert!(printed(&output).contains("Type first:\n  smam run bending_catheter"), "{}", printed(&output));
}

#[test]
fn wrong_usage_exits_with_two() {
    assert_eq!(smam(&["runn"], folder().path()).status.code(), Some(2));
    assert_eq!(smam(&["run"], folder().path()).status.code(), Some(2));
    let output = smam(&["run", "muscle_bench", "--duration", "0"], folder().path());
    refused(&output, &["--duration 0", "must be > 0"]);
}

#[test]
fn unknown_scene_proposes_the_nearest() {
    let output = smam(&["run", "bending_cateter"], folder().path());
    refused(&output, &["no scene named \"bending_cateter\"", "did you mean \"bending_catheter\"?"]);
    let output = smam(&["run", "nowhere/mine.toml"], folder().path());
    refused(&output, &["nowhere/mine.toml: cannot be read"]);
}

#[test]
fn unknown_key_is_named_with_its_line() {
    let here = folder();
    let path = changed_scene(here.path(), "muscle_bench", "substeps =", "substep =");
    refused(&smam(&["check", &path], here.path()), &["mine.toml", "simulation", "unknown field `substep`", "line 10"]);
}

#[test]
fn bad_numbers_are_named_with_table_and_key() {
    let here = folder();
    let path = changed_scene(here.path(), "muscle_bench", "preload_n = 0.0", "preload_n = -0.5");
    refused(&smam(&["check", &path], here.path()), &["mine.toml: [muscles.tube.coil]: preload_n = -0.5 must be >= 0"]);
}

#[test]
fn bad_overrides_are_refused() {
    let here = folder();
    let set = |text: &str| smam(&["run", "muscle_bench", "--set", text], here.path());
    refused(&set("muscles.rest_length_m"), &["--set muscles.rest_length_m", "there is no `=`"]);
    refused(&set("muscle.none.x=1"), &["--set muscle.none.x", "there is no `muscle.none`"]);
    refused(&set("muscles.rest_lenth_m=0.05"), &["muscles", "unknown field `rest_lenth_m`", "--keys"]);
    refused(&set("muscles.rest_length_m=-0.05"), &["[muscles]: rest_length_m = -0.05 must be > 0"]);
    refused(&set("muscles.rest_length_m=long"), &["muscles.rest_length_m", "invalid type", "--keys"]);
    assert!(listing(here.path()).is_empty(), "{:?}", listing(here.path()));
}

#[test]
fn missing_input_column_is_named() {
    let here = folder();
    std::fs::write(here.path().join("in.csv"), "time_s,piston_mm\n0,0\n0.1,0.1\n").expect("written");
    let output = smam(&["run", "muscle_bench", "--input", "in.csv", "--output", "out.csv"], here.path());
    refused(&output, &["in.csv", "\"plunger_mm\" is missing", "found: piston_mm"]);
    assert_eq!(listing(here.path()), ["in.csv"]);
}

#[test]
fn broken_numbers_are_named_with_their_line() {
    let here = folder();
    std::fs::write(here.path().join("in.csv"), "time_s,plunger_mm\n0,0\n0.1,oops\n").expect("written");
    let output = smam(&["run", "muscle_bench", "--input", "in.csv", "--output", "out.csv"], here.path());
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("in.csv") && text.contains("oops") && text.contains("plunger_mm"), "{text}");
    assert!(text.contains("line 3"), "{text}");
}

#[test]
fn gaps_and_missing_samples_are_reported_and_other_columns_named() {
    let here = folder();
    let mut text = "time_s,plunger_mm,remark_v\n".to_owned();
    for i in 0..60 {
        let value = if i == 20 { "NaN".to_owned() } else { format!("{}", 0.01 * f64::from(i)) };
        let time = f64::from(i) * 0.01 + if i > 40 { 0.5 } else { 0.0 };
        text += &format!("{time},{value},1\n");
    }
    std::fs::write(here.path().join("in.csv"), text).expect("written");
    let output = smam(&["run", "muscle_bench", "--input", "in.csv", "--output", "out.csv"], here.path());
    let text = said(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("gaps (1): 0.4 to 0.91 s"), "{text}");
    assert!(text.contains("plunger_mm") && text.contains("missing"), "{text}");
    assert!(text.contains("left alone: remark_v"), "{text}");
    let out = std::fs::read_to_string(here.path().join("out.csv")).expect("written");
    assert!(out.starts_with("time_s,plunger_mm,elongation_mm,pressure_kpa,force_n\n"), "{out}");
    assert_eq!(out.lines().count(), 61);
}

#[test]
fn an_output_that_cannot_be_written_fails_before_the_run() {
    let here = folder();
    std::fs::write(here.path().join("file"), "").expect("written");
    let output = smam(&["run", "muscle_bench", "--output", "file/out.csv"], here.path());
    let text = said(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("cannot be written") && text.contains("remedy: ") && text.contains("file"), "{text}");
    assert!(!text.contains("simulated in"), "it was run first: {text}");
    assert_eq!(listing(here.path()), ["file"]);
}

#[test]
fn an_unreadable_folder_of_recordings_is_named() {
    let here = folder();
    let output = smam(&["compare", "nowhere"], here.path());
    assert_eq!(output.status.code(), Some(2));
    let text = said(&output);
    assert!(text.contains("nowhere") && text.contains("recordings.toml"), "{text}");
}

#[test]
fn checks_pass_and_fail_with_their_exit_codes_and_junit() {
    let here = folder();
    let run = |extra: &[&str]| {
        let all = ["run", "muscle_bench", "--duration", "21", "--check", "--junit", "new/report.xml"];
        smam(&[&all[..], extra].concat(), here.path())
    };
    // The loop closes at 30 s: shortened, its measures cannot pass; the peak pressure does.
    let output = run(&["--set", "expect.elongation range.max=1.0", "--set", "expect.elongation range.min=0.5"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(printed(&output).contains("FAIL elongation range"), "{}", printed(&output));
    assert!(printed(&output).contains("ok   peak pressure"), "{}", printed(&output));
    let xml = std::fs::read_to_string(here.path().join("new/report.xml")).expect("written");
    let cases = xml.matches("<testcase ").count();
    let failures = xml.matches("<failure ").count();
    assert!(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"muscle_bench\""), "{xml}");
    assert!(xml.contains(&format!("tests=\"{cases}\" failures=\"{failures}\"")) && failures >= 1, "{xml}");
    assert!(balanced(&xml), "{xml}");
    assert_eq!(listing(here.path()), ["new"], "--check writes nothing else");
    assert_eq!(smam(&["run", "driven_axis", "--check"], here.path()).status.code(), Some(0));
    let onto_a_folder = smam(&["run", "muscle_bench", "--check", "--junit", "new"], here.path());
    assert_eq!((onto_a_folder.status.code(), printed(&onto_a_folder).as_str()), (Some(1), ""), "before the run");
}

/// Every opened element is closed, in order.
fn balanced(xml: &str) -> bool {
    let mut open: Vec<&str> = Vec::new();
    for tag in xml.split('<').skip(1).map(|rest| rest.split('>').next().unwrap_or("")) {
        match tag.strip_prefix('/') {
            _ if tag.starts_with('?') || tag.ends_with('/') => {}
            Some(name) if open.pop() != Some(name) => return false,
            Some(_) => {}
            None => open.push(tag.split(' ').next().unwrap_or("")),
        }
    }
    open.is_empty()
}

const RECORDINGS: &str = r#"format = 1
scene = "muscle_bench"
[[channel]]
column = "plunger_mm"
role = "input"
[[channel]]
column = "elongation_mm"
role = "output"
noise_sd = 0.02
[[channel]]
column = "pressure_kpa"
role = "output"
[[run]]
file = "sine.csv"
use = "fit"
[[run]]
file = "later.csv"
use = "holdout"
"#;

/// Two runs recorded from the simulation itself, with another friction.
fn recorded(here: &Path) {
    std::fs::create_dir(here.join("rig")).expect("folder");
    std::fs::write(here.join("rig/recordings.toml"), RECORDINGS).expect("written");
    for file in ["rig/sine.csv", "rig/later.csv"] {
        let made = ["run", "muscle_bench", "--duration", "2", "--set", "muscles.friction.m0_n=0.14", "--output", file];
        assert_eq!(smam(&made, here).status.code(), Some(0));
    }
}

#[test]
fn compare_writes_figures_and_picture() {
    let here = folder();
    recorded(here.path());
    let output = smam(&["compare", "rig", "--out", "result"], here.path());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(listing(&here.path().join("result")), ["compare.html", "compare.json"]);
    let json = std::fs::read_to_string(here.path().join("result/compare.json")).expect("written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    for channel in ["elongation_mm", "pressure_kpa"] {
        let figures = &json["channels"][channel];
        for key in ["rmse", "noise_sd", "range"] {
            assert!(figures.get(key).is_some(), "{channel} {key}: {json}");
        }
        assert!(json["runs"]["sine.csv"][channel]["rmse"].is_number(), "{json}");
    }
    assert_eq!(json["channels"]["elongation_mm"]["noise_sd"], 0.02);
    assert!(json["channels"]["elongation_mm"]["rmse"].as_f64().is_some_and(|rmse| rmse > 0.0), "{json}");
    assert_eq!(json["holdout"], serde_json::json!(["later.csv"]));
    let table = printed(&output);
    for word in ["sine.csv (fit)", "later.csv (holdout)", "all holdout"] {
        assert!(table.contains(word), "no {word:?} in: {table}");
    }
    // Undeclared columns are named once, with their file.
    assert!(
        said(&output).contains("note: sine.csv: columns that recordings.toml does not declare"),
        "{}",
        said(&output)
    );
    // Figures of the user's own stay where they are.
    let own = here.path().join("result/figures/own.csv");
    std::fs::create_dir_all(own.parent().expect("a folder")).expect("made");
    std::fs::write(&own, "t,x\n").expect("written");
    let same = smam(&["compare", "rig", "--out", "result", "--set", "friction_m0_n=0.14"], here.path());
    assert!(printed(&same).contains("      0.0000"), "its own parameters leave no difference: {}", printed(&same));
    assert!(own.is_file());
}

#[test]
fn compare_names_what_does_not_fit_together() {
    let here = folder();
    recorded(here.path());
    let compare = |extra: &[&str]| smam(&[&["compare", "rig", "--out", "result"][..], extra].concat(), here.path());
    refused(
        &compare(&["--scene", "antagonistic_pulley"]),
        &["recordings.toml", "`elongation_mm`", "antagonistic_pulley"],
    );
    let wrong = RECORDINGS.replace("use = \"holdout\"", "use = \"hold\"");
    std::fs::write(here.path().join("rig/recordings.toml"), wrong).expect("written");
    let text = said(&compare(&[]));
    assert!(text.contains("[[run]] 2") && text.contains("use = \"hold\"") && text.contains("\"holdout\""), "{text}");
    assert_eq!(listing(here.path()), ["rig"]);
}

/// Said at once, not after a diagnosis of minutes.
#[cfg(not(feature = "viz"))]
#[test]
fn a_build_without_the_viewer_says_so() {
    let here = folder();
    for flag in ["--rrd", "--view"] {
        let output = smam(&["diagnose", "nowhere", flag], here.path());
        refused(&output, &["--rrd and --view need the viewer", "build with the default features"]);
    }
    assert!(listing(here.path()).is_empty());
}

#[test]
fn an_effect_is_said_and_drawn() {
    let here = folder();
    let output = smam(&["effects", "leak"], here.path());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(printed(&output).contains("Q_leak = G p_m") && said(&output).contains("picture: out/effects/leak.svg"));
    let svg = std::fs::read_to_string(here.path().join("out/effects/leak.svg")).expect("written");
    let scenes = ["muscle_bench, leak in line", "bending_catheter, leak in line_1", "G = 2e-16 m³/(s Pa)"];
    for text in scenes.into_iter().chain(["elongation (mm)", "change (°)", "time (s)", "pressure (kPa)"]) {
        assert!(svg.lines().any(|line| line == text), "no {text}");
    }
    assert!(svg.len() < 60_000, "{} bytes", svg.len());
    // Two laws share this name: each has its picture.
    let output = smam(&["effects", "sensor_lag", "--out", "new"], here.path());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(listing(&here.path().join("new")), ["sensor_lag.svg", "sensor_lag_delay_s.svg"]);
    refused(&smam(&["effects", "leek"], here.path()), &["leek: no such effect", "`smam effects` lists them"]);
}

#[test]
fn a_law_on_the_command_line_acts_in_every_command() {
    let here = folder();
    let law = "muscle.damping adds 0.05*tanh(speed_m_s/2e-3)";
    let run = |more: &[&str]| {
        let first = ["run", "muscle_bench", "--duration", "2", "--law", law, "--output"];
        let output = smam(&[&first, more].concat(), here.path());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        output
    };
    assert!(printed(&run(&["a.csv", "--energy"])).contains("  law_law_1  "));
    let supplying = smam(
        &[
            "run",
            "muscle_bench",
            "--duration",
            "2",
            "--law",
            "muscle.damping adds -0.05",
            "--energy",
            "--output",
            "b.csv",
        ],
        here.path(),
    );
    assert!(said(&supplying).contains("warning: [[law]] \"law_1\" supplies"), "{}", said(&supplying));
    let checked = smam(&["check", "muscle_bench", "--law", law], here.path());
    assert!(printed(&checked).contains(&format!(", 1 law\n  law law_1: {law}\n")), "{}", printed(&checked));
    let vary = ["sweep", "muscle_bench", "--duration", "2", "--vary", "muscles.friction.m0_n=0.1,0.2"];
    let swept = |more: &[&str], out: &str| {
        let output =
            smam(&[&vary, ["--measure", "top=max(pressure_kpa)", "--out", out].as_slice(), more].concat(), here.path());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        std::fs::read_to_string(here.path().join(out).join("table.csv")).expect("written")
    };
    assert_ne!(swept(&["--law", law], "with"), swept(&[], "without"));
    // What was recorded with the law is explained by it.
    std::fs::create_dir(here.path().join("rig")).expect("folder");
    std::fs::write(here.path().join("rig/recordings.toml"), RECORDINGS).expect("written");
    for file in ["rig/sine.csv", "rig/later.csv"] {
        run(&[file]);
    }
    let same = smam(&["compare", "rig", "--law", law], here.path());
    assert!(printed(&same).contains("      0.0000"), "{}", printed(&same));
}

#[test]
fn a_port_is_shown_and_those_of_a_scene_are_listed() {
    let here = folder();
    let page = printed(&smam(&["laws", "muscle.friction"], here.path()));
    assert!(page.contains("speed_m_s              m/s") && page.contains("  port = \"muscle.friction\""), "{page}");
    assert_eq!(page, printed(&smam(&["laws", "--port", "muscle_2.friction"], here.path())));
    let ports = printed(&smam(&["laws", "--scene", "muscle_bench"], here.path()));
    assert!(ports.contains("muscle.friction      muscle_1.friction\n") && !ports.contains("cable."), "{ports}");
    refused(&smam(&["laws", "muscle.frction"], here.path()), &["did you mean \"muscle.friction\"?"]);
}

#[test]
fn a_model_is_written_whole() {
    let here = folder();
    let output = smam(&["model", "notched-tube", "--notches", "5", "--output", "tube.urdf"], here.path());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let urdf = std::fs::read_to_string(here.path().join("tube.urdf")).expect("written");
    assert!(urdf.contains("notch_5") && !urdf.contains("notch_6"));
    assert!(said(&output).contains("stiffness_n_m_rad = "));
    assert_eq!(listing(here.path()), ["tube.urdf", "tube_strip.stl", "tube_tube.stl"]);
}

/// Ctrl-C: whole rows up to where it got, under the file's own name, and exit code 1.
#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_what_it_computed() {
    let here = folder();
    // Long enough that no machine ends it within the test.
    let mut child = Command::new(env!("CARGO_BIN_EXE_smam"))
        .args(["run", "muscle_bench", "--duration", "100000", "--output", "long.csv"])
        .current_dir(here.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    let begun = Instant::now();
    // The rows stream into a hidden file first: none of them may stand under the final name.
    while !listing(here.path()).iter().any(|n| n.ends_with(".partial")) {
        assert!(begun.elapsed() < Duration::from_secs(30), "never began to write");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(500));
    assert!(!here.path().join("long.csv").exists());
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(killed.success());
    while child.try_wait().expect("waits").is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "does not stop");
        std::thread::sleep(Duration::from_millis(20));
    }
    let output = child.wait_with_output().expect("ended");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("interrupted at "), "{}", said(&output));
    assert_eq!(listing(here.path()), ["long.csv"]);
    let csv = std::fs::read_to_string(here.path().join("long.csv")).expect("written");
    assert!(csv.ends_with('\n') && csv.lines().count() > 10, "{} lines", csv.lines().count());
    assert!(csv.lines().all(|l| l.split(',').count() == 5), "a row was cut");
}

/// Numbers that are none are refused in a displacement form too.
#[test]
fn a_displacement_form_without_a_number_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_smam"))
        .args(["run", "muscle_printed_model", "--set", "muscles.displacement.alpha_x1=nan"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("finite"), "{output:?}");
}

/// What is asked for is written even if nobody reads what is printed; a full output is an error, not a panic.
#[test]
#[cfg(target_os = "linux")]
fn a_reader_that_goes_and_a_full_output_do_not_panic() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has it");
    let output = Command::new(env!("CARGO_BIN_EXE_smam")).arg("scenes").stdout(full).output().expect("starts");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard output: cannot be written"), "{output:?}");
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let output = Command::new(env!("CARGO_BIN_EXE_smam")).arg("scenes").stdout(writer).output().expect("starts");
    assert!(output.status.success(), "{output:?}");
    // The same of what is said beside (`2>&1 | head`).
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let here = folder();
    let output = Command::new(env!("CARGO_BIN_EXE_smam"))
        .args(["run", "muscle_bench", "--duration", "0.1", "--output", "run.csv"])
        .current_dir(here.path())
        .stderr(writer)
        .output()
        .expect("starts");
    assert!(output.status.success(), "{output:?}");
    assert_eq!(listing(here.path()), ["run.csv"]);
}

/// Commands whose help must show how they are used; `help` is clap's own.
fn commands() -> Vec<String> {
    let help = smam(&["--help"], folder().path());
    let text = printed(&help);
    let list = text.split("Commands:\n").nth(1).and_then(|t| t.split("\n\n").next()).expect("a list of commands");
    let named = list.lines().filter(|l| l.starts_with("  ") && !l.starts_with("   "));
    named.filter_map(|l| l.split_whitespace().next()).filter(|c| *c != "help").map(str::to_owned).collect()
}

#[test]
fn every_help_has_examples_and_no_colour_reaches_a_file() {
    let here = folder();
    let commands = commands();
    assert!(commands.len() > 15, "{commands:?}");
    for command in &commands {
        let help = smam(&[command, "--help"], here.path());
        let text = printed(&help);
        assert!(text.contains("Examples:"), "{command}: {text}");
        assert!(!text.contains('\u{1b}'), "{command}: colours in a file");
    }
}

#[test]
fn shells_get_their_completions() {
    for (shell, word) in [("bash", "complete -F"), ("zsh", "#compdef smam"), ("fish", "complete -c smam")] {
        let output = smam(&["completions", shell], folder().path());
        assert!(output.status.success() && printed(&output).contains(word), "{shell}");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let here = folder();
    assert!(smam(&["man", "--out", "man/man1"], here.path()).status.success());
    let pages = here.path().join("man/man1");
    for (file, word) in
        [("smam.1", "smam\\-diagnose(1)"), ("smam-diagnose.1", "Find the physics"), ("smam-man.1", "man1")]
    {
        let page = std::fs::read_to_string(pages.join(file)).expect("a page");
        assert!(page.contains(".TH") && page.contains(word), "{file}: {page}");
    }
    std::fs::write(here.path().join("file"), "").expect("written");
    let refused = smam(&["man", "--out", "file"], here.path());
    let words = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(1) && words.contains("error: file: ") && words.contains("remedy: "),
        "{words}"
    );
}

#[test]
fn angles_are_printed_at_the_end_with_their_extremes() {
    let here = folder();
    let output = smam(&["run", "antagonistic_pulley", "--duration", "5", "--angles", "--output", "a.csv"], here.path());
    let text = printed(&output);
    let row = text.lines().find(|l| l.starts_with("pulley ")).expect("the pulley's joint");
    let numbers: Vec<f64> = row.split_whitespace().filter_map(|w| w.parse().ok()).collect();
    let csv = std::fs::read_to_string(here.path().join("a.csv")).expect("written");
    let column = csv.lines().next().and_then(|h| h.split(',').position(|c| c == "angle_deg")).expect("a column");
    let last: f64 = csv.lines().last().and_then(|l| l.split(',').nth(column)?.parse().ok()).expect("a number");
    assert!(numbers.len() == 3 && (numbers[0] - last).abs() < 1e-3, "{row} beside {last}");
    assert!(numbers[1] <= numbers[0] && numbers[0] <= numbers[2], "{row}");
}

#[test]
fn a_run_in_real_time_takes_its_time() {
    let begun = std::time::Instant::now();
    let output = smam(&["run", "muscle_bench", "--duration", "1", "--real-time", "--output", "a.csv"], folder().path());
    assert!(output.status.success() && begun.elapsed().as_secs_f64() > 0.95);
}

#[test]
fn stock_scenes_run_anywhere_and_are_copied_whole() {
    let here = folder();
    let copied = smam(&["scenes", "antagonistic_pulley", "--copy-to", "mine"], here.path());
    assert!(copied.status.success(), "{}", said(&copied));
    assert!(smam(&["check", "mine/scenes/antagonistic_pulley.toml"], here.path()).status.success());
    let scene = here.path().join("mine/scenes/antagonistic_pulley.toml");
    std::fs::write(&scene, "changed").expect("written");
    let again = smam(&["scenes", "antagonistic_pulley", "--copy-to", "mine"], here.path());
    refused(&again, &["antagonistic_pulley.toml", "is there already", "remedy"]);
    assert_eq!(std::fs::read_to_string(&scene).expect("there"), "changed");
}

/// A run that diverges: the former file stays, what was computed stands beside it, in whole rows of numbers.
#[test]
fn a_run_that_diverges_leaves_the_former_file() {
    let here = folder();
    for name in ["a.csv", "a.parquet"] {
        std::fs::write(here.path().join(name), "former").expect("written");
        let short = ["--law", "muscle.pull adds 1.0/(max(0.2 - time_s, 0.0)*1e3)", "--duration", "1"];
        let output = smam(&[&["run", "muscle_bench", "--output", name], &short[..]].concat(), here.path());
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert_eq!(std::fs::read_to_string(here.path().join(name)).expect("there"), "former");
        let part = name.replace("a.", "a.partial.");
        assert!(said(&output).contains(&format!("what was computed until then: {part}")), "{}", said(&output));
        let recording = smam::recording::read_recording(&here.path().join(&part)).expect("whole rows");
        assert!(recording.sample_count() > 10 && recording.time_s().iter().all(|t| *t < 0.2));
        assert!(recording.channels().iter().all(|c| c.values.iter().all(|v| v.is_finite())), "{name}");
    }
    assert_eq!(listing(here.path()), ["a.csv", "a.parquet", "a.partial.csv", "a.partial.parquet"]);
}

/// Ctrl-C ends a command that writes nothing until it has ended, with exit code 1.
#[cfg(unix)]
#[test]
fn an_interrupted_diagnosis_exits_with_one() {
    let here = folder();
    recorded(here.path());
    let mut child = Command::new(env!("CARGO_BIN_EXE_smam"))
        .args(["diagnose", "rig", "--out", "d"])
        .current_dir(here.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    let mut first = String::new();
    let stderr = child.stderr.take().expect("piped");
    let mut lines = std::io::BufReader::new(stderr);
    std::io::BufRead::read_line(&mut lines, &mut first).expect("its first step");
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(killed.success());
    let mut rest = String::new();
    std::io::Read::read_to_string(&mut lines, &mut rest).expect("ends");
    assert_eq!(child.wait().expect("ended").code(), Some(1), "{first}{rest}");
    assert!(rest.contains("interrupted: "), "{first}{rest}");
}

/// A law that has no value is no fault of the recordings.
#[test]
fn a_law_without_a_value_is_named_by_a_diagnosis() {
    let here = folder();
    recorded(here.path());
    for (law, at) in [
        ("muscle.pull adds 0/0", "at 0.0000 s its value is NaN"),
        ("muscle.pull adds 1/max(1.0 - time_s, 0.0)*0.0", "its value is NaN"),
    ] {
        let output = smam(&["diagnose", "rig", "--law", law, "--out", "d"], here.path());
        let text = said(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(
            text.contains("[[law]] law_1 (muscle.pull): at ") && text.contains(at) && text.contains("remedy: "),
            "{text}"
        );
    }
}

/// Stock recordings, of a rig with another friction or tension: what differs is physics, no mark of a logger and no other zero.
#[test]
fn physics_is_noted_neither_as_strays_nor_as_another_zero() {
    let here = folder();
    // An output in a wrong unit ends the diagnosis after its first look.
    let notes = |scene: &str, changes: &[&str], wrong: &str, channel: &str| {
        let made = [&["run", scene, "--output", "rig/x.csv"], changes].concat();
        std::fs::create_dir_all(here.path().join("rig")).expect("folder");
        assert_eq!(smam(&made, here.path()).status.code(), Some(0));
        let _ = std::fs::remove_file(here.path().join("rig/recordings.toml"));
        assert_eq!(smam(&["import", "rig", "--scene", scene], here.path()).status.code(), Some(0));
        let file = here.path().join("rig/recordings.toml");
        let text = std::fs::read_to_string(&file).expect("written");
        let output = |column: &str| format!("column = \"{column}\"\nrole = \"output\"\n");
        let text = text.replace(&output(wrong), &(output(wrong) + "scale = 0.001\n"));
        let text = text.replace(&output("pressure_kpa"), &(output("pressure_kpa") + channel));
        std::fs::write(&file, text).expect("written");
        let output = smam(&["diagnose", "rig", "--out", "d"], here.path());
        assert!(said(&output).contains(wrong), "{}", said(&output));
        let compared = smam(&["compare", "rig", "--out", "c"], here.path());
        let [zero, same] = [&output, &compared].map(|output| said(output).contains("if its zero is another"));
        assert_eq!(zero, same, "{}", said(&compared));
        said(&output)
    };
    for (scene, changes, wrong) in [
        ("muscle_bench", &["--set", "muscles.friction.m0_n=0.3"][..], "elongation_mm"),
        (
            "muscle_bench",
            &["--set", "muscles.friction.m0_n=0.3", "--set", "simulation.output_interval_s=0.1"],
            "elongation_mm",
        ),
        ("antagonistic_pulley", &["--set", "muscles.pre_elongation_ratio=0.6"], "pressure_2_kpa"),
    ] {
        let text = notes(scene, changes, wrong, "");
        assert!(!text.contains("lie far outside") && !text.contains("if its zero is another"), "{text}");
    }
    let absolute = notes("muscle_bench", &[], "elongation_mm", "zero = -101.3\n");
    assert!(absolute.contains("pressure_kpa: begins +") && absolute.contains("if its zero is another"), "{absolute}");
}
