#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| smam_fuzz::law(bytes));
