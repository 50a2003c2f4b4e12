//! Commands of `smam`. Everything they do is library code; here are only words, files and progress.

/// Prints a line on the standard output. What was asked for is done even if nobody reads (`| head`); a line that cannot be
/// written for another reason makes the command fail at its end. `println!` would panic.
macro_rules! say {
    ($($words:tt)*) => { $crate::cli::print_line(format_args!($($words)*)) };
}

mod angles;
mod changes;
mod check;
mod compare;
mod diagnose;
mod diagnose_view;
mod effects;
mod error;
mod feedforward;
mod files;
mod identify;
mod identify_page;
mod import;
mod import_also;
mod import_files;
mod interrupt;
mod junit;
mod laws;
mod left_out;
mod man;
mod model;
mod observers;
mod results;
mod run;
mod run_file;
mod scenes;
mod schema;
mod steps;
mod sweep;
mod sweep_exploration;
mod sweep_page;
mod sweep_panels;
mod sweep_trouble;
#[cfg(feature = "validation")]
mod validation;
mod words;

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, CommandFactory, Parser, Subcommand};

pub use error::CliError;

/// Hydraulic soft microtubule artificial muscles in rigid-body scenes: simulate them, and compare with recordings.
#[derive(Parser)]
#[command(name = "smam", version, arg_required_else_help = false, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

const EXAMPLES: &str = "Examples:
  smam run bending_catheter                  a catheter bends and its forceps grip; writes out/
  smam run muscle_bench --check              the paper's figures of one muscle, checked
  smam import path/to/files --scene muscle_bench   a lab's files described, whatever their layout
  smam compare path/to/recordings            your recording beside its simulation
  smam diagnose path/to/recordings           what physics the scene lacks to explain it
  smam run muscle_bench --set muscles.friction.m0_n=0.2 --output mine.csv";

#[derive(Subcommand)]
enum Command {
    /// Run a scene and record it
    Run(run::RunArguments),
    /// Look at a lab's files and write the recordings.toml that reads them
    Import(import::ImportArguments),
    /// Simulate what was recorded and show measured against simulated
    Compare(compare::CompareArguments),
    /// Find the physics that recordings show and the scene lacks
    Diagnose(diagnose::DiagnoseArguments),
    /// Identify a displacement-form hysteresis model from recorded loops
    Identify(identify::IdentifyArguments),
    /// List the physics that a scene may leave out, or show one
    Effects(effects::EffectsArguments),
    /// List the places at which a law of your own can act, or show one
    Laws(laws::LawsArguments),
    /// Read a scene and say whether it is right
    Check(check::CheckArguments),
    /// List the scenes that come with the program, or copy one
    Scenes(scenes::ScenesArguments),
    /// Print the JSON Schema of a kind of file, for editors
    Schema(schema::SchemaArguments),
    /// Run a scene at many points of its keys and tabulate what each run shows
    Sweep(sweep::SweepArguments),
    /// The plunger's programme for a wanted output, from an identified hysteresis model
    Feedforward(feedforward::FeedforwardArguments),
    /// Generate a model file
    Model(model::ModelArguments),
    /// Print a script that completes commands and options in a shell
    Completions(CompletionsArguments),
    /// Write manual pages: one for the program, one for each command
    Man(man::ManArguments),
    #[cfg(feature = "validation")]
    #[command(flatten)]
    Validation(validation::ValidationCommand),
}

#[derive(Args)]
#[command(after_help = "Examples:
  smam completions bash > ~/.local/share/bash-completion/completions/smam
  smam completions zsh > ~/.zfunc/_smam             with ~/.zfunc in $fpath
  smam completions fish > ~/.config/fish/completions/smam.fish")]
struct CompletionsArguments {
    /// The shell
    shell: clap_complete::Shell,
}

fn completions(arguments: &CompletionsArguments) -> Result<ExitCode, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "smam", &mut script);
    print_text(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}

/// Parses the arguments and runs the command.
pub fn run() -> Result<ExitCode, CliError> {
    let code = run_command()?;
    if UNPRINTED.load(Ordering::Relaxed) {
        return Err(CliError::Failed(
            "standard output: cannot be written\n  remedy: is the disk full that it goes to?".to_owned(),
        ));
    }
    Ok(code)
}

fn run_command() -> Result<ExitCode, CliError> {
    let command = match Arguments::try_parse() {
        Ok(arguments) => arguments.command,
        Err(error) => match left_out::left_out(&error) {
            Some(words) => return Err(CliError::Usage(words)),
            None => error.exit(),
        },
    };
    interrupt::install();
    match command {
        None => {
            say!("{}", first_words());
            Ok(ExitCode::SUCCESS)
        }
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Import(arguments)) => import::import(&arguments),
        Some(Command::Compare(arguments)) => compare::compare(&arguments),
        Some(Command::Diagnose(arguments)) => diagnose::diagnose(&arguments),
        Some(Command::Identify(arguments)) => identify::identify(&arguments),
        Some(Command::Effects(arguments)) => effects::effects(&arguments),
        Some(Command::Laws(arguments)) => laws::laws(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        Some(Command::Scenes(arguments)) => scenes::scenes(&arguments),
        Some(Command::Schema(arguments)) => schema::schema(&arguments),
        Some(Command::Sweep(arguments)) => sweep::sweep(&arguments),
        Some(Command::Feedforward(arguments)) => feedforward::feedforward(&arguments),
        Some(Command::Model(arguments)) => model::model(&arguments),
        Some(Command::Completions(arguments)) => completions(&arguments),
        Some(Command::Man(arguments)) => man::man(Arguments::command(), &arguments),
        #[cfg(feature = "validation")]
        Some(Command::Validation(command)) => validation::run(&command),
    }
}

/// Whether a line could not be printed, for another reason than a reader that has seen enough.
static UNPRINTED: AtomicBool = AtomicBool::new(false);

/// See `say!`.
fn print_line(words: std::fmt::Arguments<'_>) {
    use std::io::Write;
    if writeln!(std::io::stdout(), "{words}").is_err_and(|e| e.kind() != std::io::ErrorKind::BrokenPipe) {
        UNPRINTED.store(true, Ordering::Relaxed);
    }
}

/// Prints a text; a reader that has seen enough (`| head`) is no failure.
fn print_text(text: &str) -> Result<(), CliError> {
    use std::io::{ErrorKind, Write};
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(CliError::Failed(format!(
            "standard output: cannot be written: {e}\n  remedy: is the disk full that it goes to?"
        ))),
        _ => Ok(()),
    }
}

fn first_words() -> String {
    format!(
        "smam simulates hydraulic soft microtubule artificial muscles and what they move.\n\n\
         Type first:\n  smam run bending_catheter     a catheter bends and its forceps grip\n  \
         smam scenes                   what else there is\n  smam compare DIR              your own recording beside its simulation\n  \
         smam --help                   everything\n\n{EXAMPLES}"
    )
}
