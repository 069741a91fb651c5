//! `cloakroom interface`: two media in, modes and powers out.

use crate::arguments::InterfaceArguments;
use crate::input;
use crate::report::{self, Failure};
use cloakroom::interface_exchange::solve_interfaces;

/// Solves the interfaces of a file.
pub fn run(arguments: &InterfaceArguments) -> Result<(), Failure> {
    let (text, name) = input::read(&arguments.interfaces)?;
    let solved =
        solve_interfaces(&text).map_err(|error| Failure::Failed(format!("{name}: {error}")))?;
    report::print_json(&solved)
}
