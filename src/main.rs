//! The command `smam`: arguments in, exit codes out.
//!
//! Exit codes: 0 done, 1 failed (a check, a run that diverged, a file that cannot be written), 2 wrong usage or input.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            error.exit_code()
        }
    }
}
