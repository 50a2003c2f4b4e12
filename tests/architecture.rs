//! Contract: imports point down, between folders and between the steps of a diagnosis; engine and viewer stay behind their folders; the
//! map shows every folder.
//!
//! The sources are read as text: no compiler, no crates. `cargo test --test architecture`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders (or files), and what each may import from the others. Whatever is not listed is upward.
type Table = [(&'static str, &'static [&'static str])];

/// The top-level folders of `src/`.
const ALLOWED: &Table = &[
    ("scalar", &[]),
    ("columns", &[]),
    ("files", &[]),
    ("nearest", &[]),
    ("parallel", &[]),
    ("stock", &["files"]),
    ("bag", &[]),
    ("recording", &["bag", "columns", "files", "nearest"]),
    ("mechanism", &["scalar", "stock"]),
    ("hydraulics", &["scalar"]),
    ("muscle", &["scalar"]),
    ("hysteresis", &["scalar"]),
    ("feedforward", &["hysteresis"]),
    ("laws", &["nearest", "scalar"]),
    ("effects", &["laws", "scalar"]),
    (
        "scene",
        &[
            "effects",
            "hydraulics",
            "hysteresis",
            "laws",
            "mechanism",
            "muscle",
            "nearest",
            "recording",
            "scalar",
            "stock",
        ],
    ),
    (
        "system",
        &[
            "effects",
            "hydraulics",
            "hysteresis",
            "laws",
            "mechanism",
            "muscle",
            "parallel",
            "recording",
            "scalar",
            "scene",
        ],
    ),
    ("identify", &["effects", "hysteresis", "parallel", "recording", "scalar", "scene", "system"]),
    (
        "diagnose",
        &["effects", "files", "identify", "laws", "parallel", "recording", "scalar", "scene", "stock", "system"],
    ),
    // Nothing of the simulation, so that the proof is one.
    ("conceal", &["files", "recording"]),
    ("proof", &["conceal", "diagnose", "files", "identify", "laws", "recording", "scene"]),
    (
        "sweep",
        &["columns", "files", "mechanism", "muscle", "nearest", "parallel", "recording", "scene", "stock", "system"],
    ),
    ("trial", &["diagnose", "effects", "files", "recording", "scene", "system"]),
    ("report", &["diagnose", "recording"]),
    ("bench", &["files", "laws", "recording", "scene", "stock", "system"]),
    (
        "reproduce",
        &[
            "effects",
            "feedforward",
            "hysteresis",
            "identify",
            "muscle",
            "parallel",
            "recording",
            "report",
            "scene",
            "system",
        ],
    ),
    ("view", &["files", "mechanism", "system"]),
    (
        "cli",
        &[
            "bench",
            "conceal",
            "diagnose",
            "effects",
            "feedforward",
            "files",
            "hysteresis",
            "identify",
            "laws",
            "mechanism",
            "nearest",
            "proof",
            "recording",
            "report",
            "reproduce",
            "scene",
            "stock",
            "sweep",
            "system",
            "trial",
            "view",
        ],
    ),
];

/// The steps of a diagnosis: the folders of `src/diagnose/`.
const STEPS: &Table = &[
    ("error", &[]),
    ("diagnosis", &[]),
    ("case", &["error"]),
    ("fit", &["case", "error"]),
    ("full", &["case", "diagnosis", "error", "fit"]),
    ("grammar", &["case", "fit"]),
    ("latent", &["case", "fit", "grammar"]),
    ("search", &["case", "fit", "grammar"]),
    ("verdict", &["case", "diagnosis", "fit", "search"]),
    ("unknown", &["case", "diagnosis", "fit", "grammar", "latent", "search", "verdict"]),
    ("validation", &["case", "diagnosis", "error", "fit", "full", "grammar", "search", "unknown", "verdict"]),
    ("experiment", &["case", "diagnosis", "fit", "verdict"]),
    ("answer", &["case", "diagnosis", "error", "fit", "full", "latent", "search", "verdict"]),
];

/// Crates that belong to one folder: names as they stand in Rust paths, and the folder.
const OWNED: &[(&str, &str)] = &[
    ("rapier3d_f64", "mechanism"),
    ("urdf_rs", "mechanism"),
    ("rerun", "view"),
    ("diffsol", "conceal"),
    ("parquet", "columns"),
    ("mcap", "bag"),
    ("lz4_flex", "bag"),
    ("ruzstd", "bag"),
    ("crc32fast", "bag"),
    ("pulp", "hysteresis"),
    ("calamine", "recording"),
    ("encoding_rs", "recording"),
    ("chrono", "recording"),
];

/// Roots of the crate, and of the diagnosis; they name every folder and stand outside the order.
const ROOTS: [&str; 2] = ["lib", "main"];
const STEP_ROOTS: [&str; 2] = ["mod", "explained"];

/// How paths begin that lead to another top-level folder, and to another step: by its full name, or by climbing up to it.
const CRATE: [&str; 2] = ["crate::", "smam::"];
const DIAGNOSE: [&str; 2] = ["crate::diagnose::", "super::"];

fn root() -> PathBuf {
    PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"))
}

/// A source file: path from `src/`, folder (or file) of the first level, and text without comments.
struct Source {
    path: String,
    module: String,
    code: String,
}

/// All sources, by top-level folder.
fn sources() -> Vec<Source> {
    sources_below("")
}

/// The sources of the diagnosis, by step.
fn steps() -> Vec<Source> {
    sources_below("diagnose")
}

fn sources_below(folder: &str) -> Vec<Source> {
    let (src, mut files) = (root().join("src"), Vec::new());
    collect(&src.join(folder), &mut files);
    files.sort();
    files.iter().map(|file| read(&src, folder, file)).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

fn read(src: &Path, folder: &str, file: &Path) -> Source {
    let inside = file.strip_prefix(src).expect("below src");
    let first = inside.strip_prefix(folder).expect("below the folder").iter().next().expect("a name").to_string_lossy();
    let text = fs::read_to_string(file).expect("UTF-8");
    Source {
        path: inside.display().to_string(),
        module: first.trim_end_matches(".rs").to_owned(),
        code: text.lines().map(without_comment).collect::<Vec<_>>().join("\n"),
    }
}

/// The line up to its `//`. One inside a text literal cuts too much: harmless here, imports hold no literals.
fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or("")
}

/// Names after any of these beginnings of a path (`crate::`), grouped imports (`crate::{a, b::c}`) included.
fn imports(code: &str, prefixes: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for prefix in prefixes {
        for (at, _) in code.match_indices(prefix) {
            if is_word_before(code, at) {
                continue;
            }
            let rest = &code[at + prefix.len()..];
            match rest.strip_prefix('{') {
                Some(group) => found.extend(group_heads(group)),
                None => found.extend(Some(word(rest)).filter(|w| !w.is_empty())),
            }
        }
    }
    found
}

/// Whether the character before `at` continues a name or a path (`othercrate::`, `x::crate::`).
fn is_word_before(code: &str, at: usize) -> bool {
    code[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_')
}

fn word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// First names of a brace group's entries, up to its closing brace.
fn group_heads(group: &str) -> Vec<String> {
    let mut heads = Vec::new();
    let (mut depth, mut entry) = (0, String::new());
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => heads.push(word(std::mem::take(&mut entry).trim_start())),
            _ if depth == 0 => entry.push(c),
            _ => {}
        }
    }
    heads.push(word(entry.trim_start()));
    heads.retain(|h| !h.is_empty());
    heads
}

/// Whether `name` stands in the code as a crate path (`name::`, `use name`) and not as part of another name.
fn names_crate(code: &str, name: &str) -> bool {
    code.match_indices(name).any(|(at, _)| {
        let after = code[at + name.len()..].chars().next().unwrap_or(' ');
        let is_path = after == ':' || code[..at].ends_with("use ") || code[..at].ends_with("extern crate ");
        is_path && !is_word_before(code, at) && !after.is_alphanumeric() && after != '_'
    })
}

/// Imports of these sources that their table does not list; `prefixes` begin the paths from one folder to another.
fn upward(sources: &[Source], table: &Table, roots: &[&str], prefixes: &[&str]) -> Vec<String> {
    let modules: BTreeSet<&str> = sources.iter().map(|s| s.module.as_str()).collect();
    let mut wrong = Vec::new();
    for Source { path, module, code } in sources.iter().filter(|s| !roots.contains(&s.module.as_str())) {
        let Some((_, allowed)) = table.iter().find(|(name, _)| name == module) else {
            wrong.push(format!("src/{path}: the folder `{module}` is not in the table of allowed imports"));
            continue;
        };
        for import in imports(code, prefixes) {
            let is_module = modules.contains(import.as_str()) && import != *module;
            if is_module && !allowed.contains(&import.as_str()) {
                wrong.push(format!("src/{path}: `{module}` must not import `{import}`"));
            }
        }
    }
    wrong.dedup();
    wrong
}

#[test]
fn imports_point_down() {
    let wrong = upward(&sources(), ALLOWED, &ROOTS, &CRATE);
    assert!(wrong.is_empty(), "upward imports:\n  {}", wrong.join("\n  "));
}

#[test]
fn imports_between_steps_of_a_diagnosis_point_down() {
    let wrong = upward(&steps(), STEPS, &STEP_ROOTS, &DIAGNOSE);
    assert!(wrong.is_empty(), "upward imports:\n  {}", wrong.join("\n  "));
}

/// What `diagnose` exports would hide from which step it comes.
#[test]
fn steps_of_a_diagnosis_import_from_steps() {
    for Source { path, module, code } in steps().iter().filter(|s| !STEP_ROOTS.contains(&s.module.as_str())) {
        for import in imports(code, &DIAGNOSE[..1]) {
            let is_step = STEPS.iter().any(|(name, _)| *name == import);
            assert!(is_step, "src/{path}: `{module}` must import `{import}` from the step that has it");
        }
    }
}

/// The tables themselves have an order: every folder comes after all that it may import.
#[test]
fn allowed_imports_have_no_cycle() {
    for table in [ALLOWED, STEPS] {
        for (i, (name, allowed)) in table.iter().enumerate() {
            for import in *allowed {
                let earlier = table[..i].iter().any(|(other, _)| other == import);
                assert!(earlier, "`{name}` may import `{import}`, which does not stand above it in the table");
            }
        }
    }
}

#[test]
fn engine_and_viewer_stay_in_their_folders() {
    let mut wrong = Vec::new();
    for source in sources() {
        for (name, owner) in OWNED {
            if source.module != *owner && names_crate(&source.code, name) {
                wrong.push(format!("src/{}: only `{owner}` may use the crate `{name}`", source.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_map_shows_every_folder() {
    let map = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let folders = sources().into_iter().chain(steps().into_iter().filter(|s| s.module != "mod"));
    let modules: BTreeSet<String> = folders.map(|s| s.module).collect();
    let known = |m: &String| map.contains(&format!("`{m}/`")) || map.contains(&format!("`{m}.rs`"));
    let missing: Vec<&String> = modules.iter().filter(|m| !known(m)).collect();
    assert!(missing.is_empty(), "ARCHITECTURE.md does not show: {missing:?}");
    let lines = map.lines().count();
    assert!(lines < 150, "ARCHITECTURE.md has {lines} lines; fewer than 150 are enough");
}

#[test]
fn the_map_shows_no_folder_that_is_gone() {
    let map = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let rows = map.lines().filter_map(|line| line.strip_prefix("| `"));
    for name in rows.filter_map(|row| row.split('`').next()) {
        let path = root().join("src").join(name.trim_end_matches('/'));
        assert!(path.exists(), "ARCHITECTURE.md shows `{name}`, which is not in src/");
    }
}

/// Pages for whoever changes the code point at files; these move.
#[test]
fn pages_for_developers_name_places_that_exist() {
    let page = fs::read_to_string(root().join("docs/extending.md")).expect("docs/extending.md");
    let is_place = |text: &&str| text.starts_with("src/") || text.starts_with("tests/");
    let quoted = page.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
    // `ID` stands for a name of the reader's.
    let places: BTreeSet<&str> = quoted.filter(is_place).filter(|place| !place.contains("ID")).collect();
    assert!(places.len() > 30, "{places:?}");
    let gone: Vec<&&str> = places.iter().filter(|place| !root().join(place).exists()).collect();
    assert!(gone.is_empty(), "docs/extending.md names what is not there: {gone:?}");
}

#[test]
fn the_reader_of_imports_sees_what_it_should() {
    let code =
        "use crate::scene::{A, B};\nlet x = crate::muscle::Wall;\nuse crate::{view::V, report};\nuse othercrate::cli;";
    let set = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<BTreeSet<String>>();
    assert_eq!(imports(code, &CRATE), set(&["scene", "muscle", "view", "report"]));
    let code =
        "use crate::diagnose::{fit::Fit, case};\npub(super) fn f() {}\nuse super::super::search::{Found, settled};";
    assert_eq!(imports(code, &DIAGNOSE), set(&["fit", "case", "super", "search"]));
    assert!(names_crate("use rerun::Vec3D;", "rerun") && names_crate("let a = rerun::X;", "rerun"));
    assert!(!names_crate("let rerun_path = 1; prerun::x()", "rerun"));
}
