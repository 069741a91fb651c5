#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trials::run("picture_files", bytes));
