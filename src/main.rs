//! The command `smam`: arguments in, exit codes out.
//!
//! Exit codes: 0 done, 1 failed (a check, a run that diverged, a file that cannot be written), 2 wrong usage or input.

/// In place of std's, which panics where nobody reads any more (`smam ... 2>&1 | head`): what is said is then lost, not the run.
macro_rules! eprintln {
    ($($words:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($words)*);
    }};
}

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
