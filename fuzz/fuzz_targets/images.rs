#![no_main]

// The program catches what decoders panic about; libFuzzer's hook would end it first. Panics that
// nobody catches end it still.
libfuzzer_sys::fuzz_target!(
    init: drop(std::panic::take_hook()),
    |bytes: &[u8]| robustness::run("images", bytes)
);
