//! Contract: what the library offers to others is the list in `tests/public_api.txt`, and no more than a reader can survey.
//!
//! Items that are hidden from the documentation belong to the program and its tests. Where the list changes on purpose:
//! `SMAM_WRITE_PUBLIC_API=1 cargo test --test public_api`, and an entry in the changelog.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Modules, types, traits, functions and constants, methods of types among them, at most. Fields, variants and what a trait asks for
/// belong to their type or trait.
const MOST: usize = 400;

#[test]
fn what_is_offered_is_listed() {
    let listed = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/public_api.txt");
    let api = public_api::Builder::from_rustdoc_json(rustdoc_json())
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build()
        .expect("what rustdoc wrote");
    let items: Vec<String> = api.items().map(ToString::to_string).collect();
    let text = items.join("\n") + "\n";
    if std::env::var_os("SMAM_WRITE_PUBLIC_API").is_some() {
        std::fs::write(&listed, &text).expect("the list can be written");
    }
    let known = std::fs::read_to_string(&listed).expect("the list");
    let (known, now): (Vec<&str>, Vec<&str>) = (known.lines().collect(), text.lines().collect());
    let gone: Vec<&&str> = known.iter().filter(|line| !now.contains(line)).collect();
    let new: Vec<&&str> = now.iter().filter(|line| !known.contains(line)).collect();
    assert!(gone.is_empty() && new.is_empty(), "gone: {gone:#?}\nnew: {new:#?}\nsee the head of this file");
    let count = count(&items);
    println!("{count} items");
    assert!(count <= MOST, "{count} items: hide what is the program's own (#[doc(hidden)])");
}

/// How many of the listed lines are items of their own.
fn count(items: &[String]) -> usize {
    const KINDS: [&str; 8] = ["mod ", "struct ", "enum ", "trait ", "type ", "const ", "static ", "fn "];
    let (mut count, mut owner) = (0, String::new());
    for item in items {
        let Some(item) = item.strip_prefix("pub ") else {
            // What implements a trait for a type.
            owner = if item.contains(" for ") { "::".to_owned() } else { String::new() };
            continue;
        };
        let item = item.strip_prefix("const ").filter(|rest| rest.starts_with("fn ")).unwrap_or(item);
        let Some((kind, path)) = KINDS.iter().find_map(|kind| Some((*kind, item.strip_prefix(kind)?))) else {
            continue;
        };
        match kind {
            "fn " | "const " | "type " if !owner.is_empty() && path.contains(&owner) => continue,
            "trait " => owner = format!("{}::", path.split([' ', '<']).next().unwrap_or(path).trim_end_matches(':')),
            "fn " | "const " | "type " => {}
            _ => owner.clear(),
        }
        count += 1;
    }
    count
}

#[test]
fn traits_and_what_implements_them_count_once() {
    let lines = [
        "pub mod smam",
        "pub trait smam::scalar::Scalar: core::marker::Copy",
        "pub const smam::scalar::Scalar::DERIVATIVES: usize",
        "pub fn smam::scalar::Scalar::abs(self) -> Self",
        "impl smam::scalar::Scalar for f64",
        "pub fn f64::abs(self) -> Self",
        "pub struct smam::scene::Scene",
        "pub smam::scene::Scene::path: std::path::PathBuf",
        "impl smam::scene::Scene",
        "pub fn smam::scene::Scene::load(&str) -> Self",
        "pub const fn smam::scene::Scene::folder(&self) -> Self",
        "pub fn smam::scene::schema() -> alloc::string::String",
    ];
    assert_eq!(count(&lines.map(str::to_owned)), 6);
}

/// The library without default features as JSON. Only rustdoc itself is told that the format is unstable: told to cargo, it
/// would build everything anew.
fn rustdoc_json() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("below the target folder").to_path_buf();
    let wrapper = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rustdoc.sh");
    std::fs::write(&wrapper, "#!/bin/sh\nRUSTC_BOOTSTRAP=1 exec rustdoc \"$@\"\n").expect("written");
    std::fs::set_permissions(&wrapper, std::fs::Permissions::from_mode(0o755)).expect("made executable");
    let said = Command::new(env!("CARGO"))
        .args(["rustdoc", "--quiet", "--release", "--lib", "--no-default-features", "--target-dir"])
        .arg(&target)
        .args(["--", "-Z", "unstable-options", "--output-format", "json"])
        .env("RUSTDOC", &wrapper)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo starts");
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    target.join("doc/smam.json")
}
