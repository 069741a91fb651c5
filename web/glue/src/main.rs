//! `cloakroom-web-glue compiled COMPILED FOLDER` writes into a folder what browsers load of a compiled page;
//! `cloakroom-web-glue one-file FOLDER FILE` makes one page of the folder. A program of the workspace, so that it is of the version
//! that the page was compiled with.

mod one_file;
mod order;

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    let [what, from, to] = &arguments[..] else { return fail("three arguments are needed") };
    let done = match what.to_str() {
        Some("compiled") => compiled(Path::new(from), Path::new(to)),
        Some("one-file") => {
            one_file::write(Path::new(from), Path::new(to)).map_err(|error| error.to_string())
        }
        _ => Err("the first argument is `compiled` or `one-file`".to_owned()),
    };
    done.map_or_else(|problem| fail(&problem), |()| ExitCode::SUCCESS)
}

/// Writes what is compiled, and the JavaScript that calls it.
fn compiled(compiled: &Path, folder: &Path) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    // Workers that are no modules can be started from one file, too.
    let made = bindgen.input_path(compiled).no_modules(true).and_then(|bindgen| {
        bindgen
            .typescript(false)
            .remove_producers_section(true)
            .demangle(false)
            .out_name("cloakroom")
            .generate(folder)
    });
    made.map_err(|error| format!("{error:#}"))?;
    let path = folder.join("cloakroom_bg.wasm");
    let module = fs::read(&path).map_err(|error| error.to_string())?;
    fs::write(&path, order::by_name(&module)?).map_err(|error| error.to_string())
}

#[allow(clippy::print_stderr, reason = "it has no other words")]
fn fail(words: &str) -> ExitCode {
    eprintln!("{words}");
    ExitCode::FAILURE
}
