#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trials::run("trace_json", bytes));
