//! Commands that this build leaves out, asked for all the same.

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Those of the feature `validation`.
const OF_VALIDATION: [&str; 6] = ["trial", "conceal", "score", "proof", "reproduce", "bench"];

/// What to say of a command that is not known because it is left out; none of any other mistake.
pub fn left_out(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(name)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let is_left_out = error.kind() == ErrorKind::InvalidSubcommand && OF_VALIDATION.contains(&name.as_str());
    is_left_out.then(|| {
        format!(
            "smam {name} tests the program itself, which this build leaves out\n  remedy: build with the default features, or with --features validation"
        )
    })
}

#[cfg(test)]
mod tests {
    use clap::Command;

    use super::*;

    /// Of a program that runs scenes alone.
    fn said(words: &[&str]) -> Option<String> {
        let program = Command::new("smam").subcommand(Command::new("run"));
        left_out(&program.try_get_matches_from(words).expect_err("a mistake"))
    }

    #[test]
    fn a_command_that_is_left_out_is_told_from_one_that_there_never_was() {
        let proof = said(&["smam", "proof", "--cases", "20"]).expect("left out");
        assert!(proof.starts_with("smam proof ") && proof.contains("remedy: "), "{proof}");
        assert_eq!(said(&["smam", "prove"]), None);
        assert_eq!(said(&["smam", "run", "--nothing"]), None);
    }

    #[cfg(feature = "validation")]
    #[test]
    fn those_are_the_commands_that_the_feature_adds() {
        use crate::cli::validation::ValidationCommand;
        use clap::Subcommand;
        let all = ValidationCommand::augment_subcommands(Command::new("smam"));
        assert!(all.get_subcommands().map(Command::get_name).eq(OF_VALIDATION));
    }
}
