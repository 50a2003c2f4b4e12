//! Contract of `smam sweep`: the same table from any number of threads and shards, and after any kill.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

/// Sixty short runs.
const SWEEP: &str = r#"
format = 1
name = "bench"
scene = "muscle_bench"
duration_s = 3.0
[sampling]
method = "latin_hypercube"
count = 60
seed = 4
[[vary]]
key = "muscles.friction.m0_n"
from = 0.05
to = 0.2
[[vary]]
key = "tube_c1_pa"
from = 0.2e6
to = 0.3e6
[[measure]]
name = "elongation_max_mm"
of = "max(elongation_mm)"
[[measure]]
name = "loop_width_mm"
of = "loop_width(plunger_mm, elongation_mm)"
"#;

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_smam"));
    command.arg("sweep").args(arguments);
    command
}

fn smam(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with the sweep file in it, and the paths of both as text.
fn sweep(file: &str) -> (tempfile::TempDir, String, impl Fn(&str) -> String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sweep.toml");
    fs::write(&path, file).expect("written");
    let base = folder.path().to_path_buf();
    (folder, path.display().to_string(), move |name| base.join(name).display().to_string())
}

fn tables(folder: &str) -> (Vec<u8>, Vec<u8>) {
    let read = |name: &str| fs::read(Path::new(folder).join(name)).unwrap_or_else(|e| panic!("{folder}/{name}: {e}"));
    (read("table.csv"), read("table.parquet"))
}

fn whole(file: &str, out: &str) -> (Vec<u8>, Vec<u8>) {
    let done = smam(&[file, "--out", out]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    tables(out)
}

#[test]
fn threads_and_shards_do_not_change_a_byte() {
    let (_folder, file, at) = sweep(SWEEP);
    let expected = whole(&file, &at("whole"));
    assert_eq!(text(&expected.0).lines().count(), 61);
    let one = smam(&[&file, "--threads", "1", "--out", &at("one")]);
    assert!(one.status.success(), "{}", text(&one.stderr));
    assert!(tables(&at("one")) == expected, "one thread");
    for count in [2, 4, 7] {
        let shards: Vec<String> = (1..=count).map(|i| at(&format!("shard_{i}_of_{count}"))).collect();
        for (i, out) in shards.iter().enumerate() {
            let done = smam(&[&file, "--shard", &format!("{}/{count}", i + 1), "--out", out]);
            assert!(done.status.success(), "{}", text(&done.stderr));
        }
        let merged = at(&format!("merged_{count}"));
        let folders: Vec<&str> = shards.iter().map(String::as_str).collect();
        let done = smam(&[&["merge", &file][..], &folders, &["--out", &merged]].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert!(tables(&merged) == expected, "{count} shards");
    }
}

#[test]
fn a_kill_at_any_moment_loses_running_points_only() {
    let (_folder, file, at) = sweep(SWEEP);
    let expected = whole(&file, &at("whole"));
    let out = at("killed");
    let mut resumed = 0;
    for round in 0..10 {
        let mut arguments = vec![file.as_str(), "--out", &out];
        if Path::new(&out).join("journal.jsonl").is_file() {
            arguments.push("--resume");
            resumed += 1;
        }
        let mut child =
            command(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts");
        // Uneven moments; the first ones fall into the start of the program.
        std::thread::sleep(Duration::from_millis(20 + 37 * round));
        child.kill().expect("killed");
        child.wait().expect("gone");
    }
    let done = smam(&[&file, "--out", &out, "--resume"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(resumed > 0 && tables(&out) == expected);
}

#[test]
fn a_cut_line_in_the_journal_is_a_point_to_do() {
    let (_folder, file, at) = sweep(SWEEP);
    let out = at("cut");
    let expected = whole(&file, &out);
    let journal = Path::new(&out).join("journal.jsonl");
    let lines = fs::read_to_string(&journal).expect("a journal");
    fs::write(&journal, &lines[..lines.len() - 25]).expect("written");
    let done = smam(&[&file, "--out", &out, "--resume"]);
    assert!(text(&done.stderr).contains("60 points, 1 of them to do"), "{}", text(&done.stderr));
    assert!(tables(&out) == expected);
}

/// A shard is the same sweep from whatever folder it is begun, by whatever path.
#[test]
fn where_a_sweep_stands_is_no_part_of_it() {
    let (folder, _, at) = sweep(SWEEP);
    let beside = SWEEP.replace("scene = \"muscle_bench\"", "scene = \"scene.toml\"");
    fs::write(folder.path().join("sweep.toml"), beside).expect("written");
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let stock = fs::read_to_string(project.join("scenes/muscle_bench.toml")).expect("a stock scene");
    let scene = stock.replace("../models", &project.join("models").display().to_string());
    fs::write(folder.path().join("scene.toml"), scene).expect("written");
    let from = |directory: &Path, file: &str, shard: &str, out: &str| {
        let done =
            command(&[file, "--shard", shard, "--out", &at(out)]).current_dir(directory).output().expect("starts");
        assert!(done.status.success(), "{}", text(&done.stderr));
    };
    from(folder.path(), "sweep.toml", "1/2", "one");
    from(folder.path().parent().expect("a parent"), &at("sweep.toml"), "2/2", "two");
    let merged = smam(&["merge", &at("sweep.toml"), &at("one"), &at("two"), "--out", &at("merged")]);
    assert!(merged.status.success(), "{}", text(&merged.stderr));
    let part = smam(&["merge", &at("sweep.toml"), &at("one"), "--out", &at("part")]);
    assert!(text(&part.stderr).contains("30 points are not done"), "{}", text(&part.stderr));
}

#[test]
fn what_lies_there_is_not_written_over() {
    let (_folder, file, at) = sweep(SWEEP);
    let out = at("out");
    whole(&file, &out);
    let again = smam(&[&file, "--out", &out]);
    assert!(!again.status.success() && text(&again.stderr).contains("--resume"), "{}", text(&again.stderr));
    fs::write(&file, SWEEP.replace("seed = 4", "seed = 5")).expect("written");
    let other = smam(&[&file, "--out", &out, "--resume"]);
    assert!(text(&other.stderr).contains("belongs to another sweep"), "{}", text(&other.stderr));
}

#[test]
fn a_point_that_fails_is_a_row_with_its_error() {
    // The tails of the tolerance reach below zero: the scene refuses those.
    let tolerance = r#"
format = 1
name = "tolerance"
scene = "muscle_bench"
duration_s = 0.5
[sampling]
method = "monte_carlo"
count = 20
seed = 1
[[vary]]
key = "muscles.friction.m0_n"
mean = 0.1
sd = 0.1
[[measure]]
name = "elongation_max_mm"
of = "max(elongation_mm)"
"#;
    let (_folder, file, at) = sweep(tolerance);
    let (csv, parquet) = whole(&file, &at("out"));
    let failed = text(&csv).lines().filter(|l| l.contains("m0_n") && l.ends_with('"')).count();
    assert!((1..15).contains(&failed), "{}", text(&csv));
    let reader = SerializedFileReader::new(bytes::Bytes::from(parquet)).expect("a Parquet file");
    let rows: Vec<_> = reader.get_row_iter(None).expect("rows").map(|r| r.expect("a row")).collect();
    assert_eq!(rows.len(), 20);
    let nulls = rows.iter().filter(|r| r.get_column_iter().any(|(n, f)| n == "elongation_max_mm" && *f == Field::Null));
    assert_eq!(nulls.count(), failed);
}

#[test]
fn a_scene_with_vary_and_measure_is_a_sweep_and_wrong_words_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out").display().to_string();
    let vary = "muscles.friction.m0_n=0.05:0.2:4";
    let base = ["muscle_bench", "--duration", "0.5", "--out", &out];
    let done = smam(&[&base[..], &["--vary", vary, "--measure", "top_mm=max(elongation_mm)"]].concat());
    assert!(done.status.success(), "{}", text(&done.stderr));
    let page = fs::read_to_string(Path::new(&out).join("sweep.html")).expect("a page");
    assert!(page.contains("top_mm"), "{page}");
    for (vary, measure, word) in [
        ("muscles.friction.m_n=1:2:3", "max(elongation_mm)", "did you mean \"muscles.friction.m0_n\"?"),
        ("muscles.friction.m0_n=2:1:3", "max(elongation_mm)", "greater"),
        ("muscles.friction.m0_n=1:2", "max(elongation_mm)", "FROM:TO:COUNT"),
        (vary, "max(elongation_m)", "did you mean \"elongation_mm\"?"),
    ] {
        let refused = smam(&[&base[..], &["--vary", vary, "--measure", measure]].concat());
        assert_eq!(refused.status.code(), Some(2), "{vary} {measure}");
        assert!(text(&refused.stderr).contains(word), "{}", text(&refused.stderr));
    }
}

/// Limits and objectives are looked at when all is run: another one needs no other run.
#[test]
fn limits_may_be_changed_afterwards() {
    let few = SWEEP.replace("count = 60", "count = 6");
    let (_folder, file, at) = sweep(&few);
    let out = at("out");
    whole(&file, &out);
    let goal = "[[objective]]\nmeasure = \"loop_width_mm\"\ngoal = \"minimise\"\n";
    let limit = "[[limit]]\nmeasure = \"elongation_max_mm\"\nmin = 1000.0\nlabel = \"too short\"\n";
    for (added, words) in [(goal.to_owned(), "Point "), (goal.to_owned() + limit, "No point keeps the limits")] {
        fs::write(&file, few.clone() + &added).expect("written");
        let done = smam(&["plot", &file, &out]);
        assert!(done.status.success(), "{}", text(&done.stderr));
        let page = fs::read_to_string(Path::new(&out).join("sweep.html")).expect("a page");
        assert!(page.contains("Best under these limits") && page.contains(words), "{page}");
    }
}

/// Short muscles let both cables hang: the greatest range of all is then one that nobody can build.
const HANGING: &str = r#"
format = 1
name = "hanging"
scene = "antagonistic_pulley"
ALLOW
[[vary]]
key = "muscles.pre_elongation_ratio"
values = [0.25, 0.6, 0.8]
[[measure]]
name = "range_deg"
of = "range(angle_deg)"
[[objective]]
measure = "range_deg"
goal = "maximise"
"#;

#[test]
fn points_in_trouble_are_columns_and_not_the_best() {
    let best = |allow: &str| {
        let text_of_file = HANGING.replace("ALLOW", allow);
        let (_folder, file, at) = sweep(&text_of_file);
        let done = smam(&[&file, "--out", &at("out")]);
        assert!(done.status.success(), "{}", text(&done.stderr));
        let best = fs::read_to_string(at("out/best.csv")).expect("best.csv");
        (text(&done.stderr), text(&tables(&at("out")).0), best.lines().nth(1).unwrap_or_default().to_owned())
    };
    let (said, table, sound) = best("");
    assert!(said.contains("1 point is beyond what the rig can do (slack at 1 point, up to 4."), "{said}");
    let header = table.lines().next().expect("a header");
    assert!(
        header.ends_with("range_deg,warning_slack_s,warning_cavitation_s,warning_yield_s,warning_penetration_s,warning_joint_limit_s,error")
    );
    assert!(sound.starts_with("1,0.6,"), "{sound}");
    let (said, _, allowed) = best("allow = [\"slack\"]");
    assert!(!said.contains("beyond"), "{said}");
    assert!(allowed.starts_with("0,0.25,"), "{allowed}");
}
