//! Ctrl-C: end after the present instant, with everything computed so far on disk.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);
static INSTALLED: OnceLock<()> = OnceLock::new();

/// The flag that Ctrl-C, `kill` and a closed terminal raise. A second one ends the program at once.
pub fn stop_flag() -> &'static AtomicBool {
    INSTALLED.get_or_init(|| {
        let installed = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        });
        if let Err(error) = installed {
            eprintln!("note: Ctrl-C will not leave a recording behind: {error}");
        }
    });
    &STOP
}

/// Whether the run was interrupted.
pub fn interrupted() -> bool {
    STOP.load(Ordering::Relaxed)
}
