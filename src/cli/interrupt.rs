//! Ctrl-C: a run ends after the present instant, with everything computed so far on disk; any other command ends at once, with exit
//! code 1.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);
/// Whether somebody looks at [`STOP`].
static IS_WATCHED: AtomicBool = AtomicBool::new(false);

/// Takes Ctrl-C, `kill` and a closed terminal for this program.
pub fn install() {
    let installed = ctrlc::set_handler(|| {
        if !IS_WATCHED.load(Ordering::Relaxed) {
            eprintln!("interrupted: nothing is written but what is there already");
            std::process::exit(1);
        }
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    if let Err(error) = installed {
        eprintln!("note: Ctrl-C will not leave a recording behind: {error}");
    }
}

/// The flag that they raise, to be looked at from now on. A second one ends the program at once.
pub fn stop_flag() -> &'static AtomicBool {
    IS_WATCHED.store(true, Ordering::Relaxed);
    &STOP
}

/// Whether the run was interrupted.
pub fn interrupted() -> bool {
    STOP.load(Ordering::Relaxed)
}
