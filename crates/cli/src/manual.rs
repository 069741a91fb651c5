//! `cloakroom manual` and `cloakroom completions`: the manual pages, and completions for shells.

use crate::arguments::{Arguments, CompletionsArguments, ManualArguments};
use crate::panels::make_folder;
use crate::report::{self, Failure, say};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use cloakroom::output::write_whole;

/// Prints a manual page, or writes them all into a folder.
pub fn run(arguments: &ManualArguments) -> Result<(), Failure> {
    let mut command = Arguments::command();
    // Gives the subcommands their full names, as in `cloakroom-render`.
    command.build();
    let pages: Vec<&Command> = std::iter::once(&command)
        .chain(command.get_subcommands().filter(|command| command.get_name() != "help"))
        .collect();
    if let Some(folder) = &arguments.out {
        make_folder(folder)?;
        for page in pages {
            let path = folder.join(Man::new(page.clone()).get_filename());
            let text = page_text(page)?;
            write_whole(&path, |file| file.write_all(&text)).map_err(Failure::from_error)?;
            say(&path.display().to_string());
        }
        return Ok(());
    }
    let wanted = arguments.command.as_deref().unwrap_or_else(|| command.get_name());
    let page = pages.into_iter().find(|page| page.get_name() == wanted);
    let page = page.ok_or_else(|| Failure::Usage(format!("there is no command `{wanted}`")))?;
    report::print(&String::from_utf8_lossy(&page_text(page)?))
}

/// A page in the language of `man`.
fn page_text(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text).map_err(Failure::from_error)?;
    Ok(text)
}

/// Prints the completions of a shell.
pub fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut command = Arguments::command();
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "cloakroom", &mut script);
    report::print(&String::from_utf8_lossy(&script))
}
