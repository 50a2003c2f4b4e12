//! Commands that put the program itself to the test: what the feature `validation` adds.

mod bench;
mod ceiling;
mod conceal;
mod error;
mod markdown_page;
mod proof;
mod proof_figure;
mod reproduce;
mod score;
mod trial;

use std::process::ExitCode;

use clap::Subcommand;

use crate::cli::CliError;

pub use error::ValidationError;

#[derive(Subcommand)]
pub enum ValidationCommand {
    /// Put the diagnosis on trial: every effect at three sizes, and scenes that lack nothing
    Trial(trial::TrialArguments),
    /// Make recordings of a rig that hides something, with the answer under seal
    Conceal(conceal::ConcealArguments),
    /// Open the seals of concealed cases and score what was answered
    Score(score::ScoreArguments),
    /// Conceal, diagnose and score many cases: the proof, repeated on your own seed
    Proof(proof::ProofArguments),
    /// Make the paper's figures again, each printed number beside ours
    Reproduce(reproduce::ReproduceArguments),
    /// Measure what simulating costs
    Bench(bench::BenchArguments),
}

pub fn run(command: &ValidationCommand) -> Result<ExitCode, CliError> {
    match command {
        ValidationCommand::Trial(arguments) => trial::trial(arguments),
        ValidationCommand::Conceal(arguments) => conceal::conceal(arguments),
        ValidationCommand::Score(arguments) => score::score(arguments),
        ValidationCommand::Proof(arguments) => proof::proof(arguments),
        ValidationCommand::Reproduce(arguments) => reproduce::reproduce(arguments),
        ValidationCommand::Bench(arguments) => bench::bench(arguments),
    }
}
