//! `cloakroom-web-glue COMPILED FOLDER`: writes into a folder what browsers load of a compiled page. A program of
//! the workspace, so that it is of the version that the page was compiled with.

use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let (Some(compiled), Some(folder)) = (arguments.next(), arguments.next()) else {
        return fail("usage: cloakroom-web-glue COMPILED FOLDER");
    };
    let mut bindgen = Bindgen::new();
    // Workers that are no modules can be started from one file, too.
    let made = bindgen.input_path(compiled).no_modules(true).and_then(|bindgen| {
        bindgen
            .typescript(false)
            .remove_producers_section(true)
            .remove_name_section(true)
            .out_name("cloakroom")
            .generate(folder)
    });
    made.map_or_else(|error| fail(&format!("{error:#}")), |()| ExitCode::SUCCESS)
}

#[allow(clippy::print_stderr, reason = "it has no other words")]
fn fail(words: &str) -> ExitCode {
    eprintln!("{words}");
    ExitCode::FAILURE
}
