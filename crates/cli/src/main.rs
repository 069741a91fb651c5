//! The command `cloakroom`: arguments in, words and files out.
//!
//! Exit status: 0 done, 1 bad input or failed work (one message on standard error), 2 wrong usage,
//! 130 on Ctrl-C.

mod animate;
mod arguments;
mod check;
mod compare;
mod devices;
mod diagram;
mod export;
mod figures;
mod flux;
mod gallery;
mod input;
mod interface;
mod interruption;
mod manual;
mod merge;
mod mistake;
mod panels;
mod progress;
mod pulses;
mod quality;
mod render;
mod report;
mod scene;
mod scenes;
mod schema;
mod trace;
mod verify;
mod view;
mod views;

use arguments::{Arguments, Command};
use clap::Parser;
use report::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match mistake::caught(|| run(&arguments.command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}

fn run(command: &Command) -> Result<(), Failure> {
    let stop = interruption::watch()?;
    match command {
        Command::Render(arguments) => render::run(arguments, stop),
        Command::Merge(arguments) => merge::run(arguments),
        Command::Animate(arguments) => animate::run(arguments, stop),
        Command::Check(arguments) => check::run(arguments),
        Command::Trace(arguments) => trace::run(arguments, stop),
        Command::Pulses(arguments) => pulses::run(arguments),
        Command::Interface(arguments) => interface::run(arguments),
        Command::Figures(arguments) => figures::run(arguments, stop),
        Command::Gallery(arguments) => gallery::run(arguments, stop),
        Command::Flux(arguments) => flux::run(arguments, stop),
        Command::Diagram(arguments) => diagram::run(arguments, stop),
        Command::Export(arguments) => export::run(arguments, stop),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Quality(arguments) => quality::run(arguments, stop),
        Command::Verify(arguments) => verify::run(arguments, stop),
        Command::View(arguments) => view::run(arguments, stop),
        Command::Devices(arguments) => devices::run(arguments),
        Command::Scenes(arguments) => scenes::run(arguments),
        Command::Completions(arguments) => manual::completions(arguments),
        Command::Manual(arguments) => manual::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
    }
}
