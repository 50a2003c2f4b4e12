//! Contract of the readers: no bytes make them panic, hang or fill the memory. Replays the inputs that fuzzing kept
//! (`fuzz/corpus.zip`, see fuzz/run.sh), then some thousands made of them, the same in every run.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[path = "../fuzz/src/lib.rs"]
mod readers;

/// A test build on a busy machine, with much to spare: inputs take milliseconds.
const SLOWEST: Duration = Duration::from_secs(60);

/// As fuzz/run.sh sets it.
#[cfg(target_os = "linux")]
const MOST_BYTES: u64 = 1 << 30;

/// How many inputs are made of a target's corpus: together a few seconds' work.
fn made(target: &str) -> usize {
    match target {
        "scene_built" => 200,
        "urdf" | "parquet" | "workbook" => 2000,
        _ => 5000,
    }
}

#[test]
fn csv() {
    hold("csv");
}

#[test]
fn workbook() {
    hold("workbook");
}

#[test]
fn law() {
    hold("law");
}

#[test]
fn recordings_toml() {
    hold("recordings_toml");
}

#[test]
fn scene_toml() {
    hold("scene_toml");
}

#[test]
fn scene_built() {
    hold("scene_built");
}

#[test]
fn urdf() {
    hold("urdf");
}

#[test]
fn bag() {
    hold("bag");
}

#[test]
fn parquet() {
    hold("parquet");
}

#[test]
fn every_target_is_replayed_and_has_its_program() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let mut programs: Vec<String> = names(&fuzz.join("fuzz_targets"));
    programs.iter_mut().for_each(|name| *name = name.trim_end_matches(".rs").to_owned());
    let mut targets = readers::TARGETS.map(|(name, _)| name.to_owned());
    targets.sort();
    assert_eq!(programs, targets);
    let kept: BTreeSet<String> =
        kept(&archive()).iter().filter_map(|name| Some(name.split('/').nth(1)?.to_owned())).collect();
    assert_eq!(kept.into_iter().collect::<Vec<_>>(), targets);
}

/// Feeds a target its corpus and what is made of it, on another thread, so that one that hangs is noticed.
fn hold(target: &str) {
    let (_, read) = readers::TARGETS.into_iter().find(|(name, _)| *name == target).expect("a target");
    let corpus = corpus(target);
    assert!(corpus.len() >= 5, "{target}: {} inputs in fuzz/corpus.zip", corpus.len());
    let (begun, watched) = channel();
    let count = made(target);
    let worker = thread::spawn(move || feed(read, &corpus, count, &begun));
    let (last, has_ended) = watch(&watched);
    let done = has_ended && worker.join().is_ok();
    assert!(done, "{target}: the reader panicked or took more than {SLOWEST:?}; the input:\n{}", last.escape_ascii());
    check_memory(target);
}

/// The last input that was begun, and whether the worker is through with it, for better or worse.
fn watch(begun: &Receiver<Vec<u8>>) -> (Vec<u8>, bool) {
    let mut last = Vec::new();
    loop {
        match begun.recv_timeout(SLOWEST) {
            Ok(input) => last = input,
            Err(RecvTimeoutError::Disconnected) => return (last, true),
            Err(RecvTimeoutError::Timeout) => return (last, false),
        }
    }
}

fn feed(read: fn(&[u8]), corpus: &[Vec<u8>], count: usize, begun: &Sender<Vec<u8>>) {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mutated = (0..count).map(|_| mutated(corpus, &mut random));
    for input in corpus.iter().cloned().chain(mutated) {
        // Whoever watches is gone only after a hang.
        if begun.send(input.clone()).is_err() {
            return;
        }
        read(&input);
    }
}

/// One of the corpus with up to four changes: bytes, cuts, doublings, pieces of another.
fn mutated(corpus: &[Vec<u8>], random: &mut ChaCha8Rng) -> Vec<u8> {
    const TELLING: [u8; 12] = *b"\0\x01\x7f\x80\xff \"[]<>,";
    let mut input = corpus[random.random_range(0..corpus.len())].clone();
    for _ in 0..random.random_range(1..=4) {
        let at = random.random_range(0..=input.len());
        let end = (at + random.random_range(0..16)).min(input.len());
        match random.random_range(0..5) {
            0 if at < input.len() => input[at] = random.random(),
            1 if at < input.len() => input[at] = TELLING[random.random_range(0..TELLING.len())],
            2 => drop(input.drain(at..end)),
            3 => input.splice(at..at, input[at..end].to_vec()).for_each(drop),
            _ => {
                let other = &corpus[random.random_range(0..corpus.len())];
                let from = random.random_range(0..=other.len());
                let to = (from + random.random_range(0..64)).min(other.len());
                input.splice(at..end, other[from..to].iter().copied()).for_each(drop);
            }
        }
    }
    input
}

/// What fuzzing kept: `corpus/TARGET/NAME`.
fn archive() -> zip::ZipArchive<File> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus.zip");
    zip::ZipArchive::new(File::open(path).expect("a file of the project")).expect("an archive")
}

/// Names of all that is in an archive.
fn kept(archive: &zip::ZipArchive<File>) -> Vec<String> {
    archive.file_names().map(|name| name.expect("a name").into_owned()).collect()
}

/// The inputs of a target, by name.
fn corpus(target: &str) -> Vec<Vec<u8>> {
    let mut archive = archive();
    let own = format!("corpus/{target}/");
    let mut names = kept(&archive);
    names.retain(|name| name.starts_with(&own));
    names.sort();
    let read = |name: &String| {
        let mut input = Vec::new();
        archive.by_name(name).expect("listed").read_to_end(&mut input).expect("readable");
        input
    };
    names.iter().map(read).collect()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder of the project");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The most that this program ever held, all its tests together.
#[cfg(target_os = "linux")]
fn check_memory(target: &str) {
    let status = fs::read_to_string("/proc/self/status").expect("Linux has it");
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("a line of it");
    let kib: u64 = line.trim().trim_end_matches(" kB").parse().expect("a number");
    assert!(kib * 1024 < MOST_BYTES, "{target}: {kib} KiB in memory at once");
}

#[cfg(not(target_os = "linux"))]
fn check_memory(_target: &str) {}
