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
mod files;
mod flight;
mod flux;
mod gallery;
mod interruption;
mod manual;
mod materials;
mod merge;
mod panels;
mod panic_report;
mod progress;
mod pulses;
mod quality;
mod render;
mod report;
mod scene;
mod scenes;
mod schema;
mod strips;
mod trace;
mod verify;
mod view;

use arguments::{Arguments, Command};
use report::Result;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Arguments::read() {
        Ok(arguments) => arguments,
        Err(error) => return refuse(&error),
    };
    match panic_report::caught(|| run(&arguments.command)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failure.tell()),
    }
}

/// Says what is wrong with the command line, or what was asked of it: help, the version.
fn refuse(error: &clap::Error) -> ExitCode {
    let message = error.to_string();
    let message = message.trim_end();
    // In colors where the terminal can show them, but never what an argument would do to it.
    if error.use_stderr() && report::printable(message) != message {
        report::say(message);
        return ExitCode::from(2);
    }
    error.exit()
}

fn run(command: &Command) -> Result<()> {
    interruption::watch()?;
    match command {
        Command::Render(arguments) => render::run(arguments),
        Command::Merge(arguments) => merge::run(arguments),
        Command::Animate(arguments) => animate::run(arguments),
        Command::Flight(arguments) => flight::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Trace(arguments) => trace::run(arguments),
        Command::Pulses(arguments) => pulses::run(arguments),
        Command::Interface { interfaces } => trace::interfaces(interfaces),
        Command::Figures(arguments) => figures::run(arguments),
        Command::Gallery(arguments) => gallery::run(arguments),
        Command::Flux(arguments) => flux::run(arguments),
        Command::Diagram(arguments) => diagram::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Quality(arguments) => quality::run(arguments),
        Command::Verify(arguments) => verify::run(arguments),
        Command::View(arguments) => view::run(arguments),
        Command::Devices { kind, json } => devices::run(kind.as_deref(), *json),
        Command::Materials(arguments) => materials::run(arguments),
        Command::Scenes(arguments) => scenes::run(arguments),
        Command::Completions { shell } => manual::completions(*shell),
        Command::Manual(arguments) => manual::run(arguments),
        Command::Schema { markdown } => schema::run(*markdown),
    }
}
