//! Every message that a user can provoke, as it stands in `tests/messages/`: `TRYCMD=overwrite cargo test --test messages`
//! writes them anew after a change, for the difference to be read.

use std::fs;
use std::path::Path;

#[test]
fn messages_are_as_written() {
    let cases = trycmd::TestCases::new();
    cases.register_bin("smam", Path::new(env!("CARGO_BIN_EXE_smam")));
    cases.case("tests/messages/*.trycmd");
    if cfg!(feature = "viz") {
        cases.skip("tests/messages/without-viewer.trycmd");
    }
}

/// A command with what it says, from a snapshot.
struct Said {
    command: String,
    exit_code: i32,
    text: String,
}

fn snapshots() -> Vec<Said> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages");
    let mut all: Vec<Said> = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder").map(|e| e.expect("an entry").path()) {
        if entry.extension().is_none_or(|e| e != "trycmd") {
            continue;
        }
        let mut in_block = false;
        for line in fs::read_to_string(&entry).expect("a snapshot").lines() {
            if line.starts_with("```") {
                in_block = line != "```";
            } else if let Some(command) = line.strip_prefix("$ ").filter(|_| in_block) {
                all.push(Said { command: command.to_owned(), exit_code: 0, text: String::new() });
            } else if let Some(said) = all.last_mut().filter(|_| in_block) {
                match line.strip_prefix("? ") {
                    Some(code) => said.exit_code = code.parse().expect("an exit code"),
                    None => said.text += &format!("{line}\n"),
                }
            }
        }
    }
    all
}

/// A file, an option, a key, a table, a quoted name, or a word of the command line, before the colon.
fn names_a_place(error: &str, command: &str) -> bool {
    let head = error.split(": ").next().unwrap_or_default();
    let is_given = |word: &str| command.split([' ', '\'', '=', '/']).skip(1).any(|given| given == word);
    head.contains(['.', '/', '"', '[', '`']) || head.starts_with("--") || head.split(' ').any(is_given)
}

#[test]
fn every_error_has_a_place_and_one_remedy() {
    let all = snapshots();
    let mut refused = 0;
    for Said { command, exit_code, text } in &all {
        for word in ["panicked", "unwrap", "Os {", "called `"] {
            assert!(!text.contains(word), "{command}: {text}");
        }
        assert!((0..=2).contains(exit_code), "{command}: {text}");
        let error = text.lines().find_map(|line| line.strip_prefix("error: "));
        let Some(error) = error.filter(|_| *exit_code != 0) else {
            // A verdict (a check, recordings that cannot be diagnosed, points to do), or help where a command is missing.
            assert!(*exit_code < 2 || text.contains("Usage: "), "{command}: {text}");
            continue;
        };
        refused += 1;
        // What the reader of the command line says itself.
        if text.contains("For more information, try '--help'") {
            continue;
        }
        assert!(names_a_place(error, command), "{command}: {text}");
        let remedies = text.lines().filter(|line| line.starts_with("  remedy: ")).count();
        assert_eq!(remedies, 1, "{command}: {text}");
    }
    assert!(refused > 300, "only {refused} of {} snapshots are errors", all.len());
}
