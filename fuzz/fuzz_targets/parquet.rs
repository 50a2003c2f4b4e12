#![no_main]

// Panics of the Parquet library are caught by ours: they are no finding, one that comes through still ends the program.
libfuzzer_sys::fuzz_target!(init: std::panic::set_hook(Box::new(|_| {})), |bytes: &[u8]| smam_fuzz::parquet(bytes));
