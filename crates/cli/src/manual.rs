//! `cloakroom manual` and `cloakroom completions`: the manual pages, and completions for shells.

use crate::arguments::{Arguments, ManualArguments};
use crate::files::{make_folder, write};
use crate::report::{self, Failure, Result};
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

/// Prints a manual page, or writes them all into a folder.
pub fn run(arguments: &ManualArguments) -> Result<()> {
    let mut command = Arguments::command();
    // Gives the subcommands their full names, as in `cloakroom-render`.
    command.build();
    let pages: Vec<&Command> = std::iter::once(&command)
        .chain(command.get_subcommands().filter(|command| command.get_name() != "help"))
        .collect();
    if let Some(folder) = &arguments.out {
        make_folder(folder)?;
        for page in pages {
            write(&folder.join(Man::new(page.clone()).get_filename()), &page_text(page)?)?;
        }
        return Ok(());
    }
    let wanted = arguments.command.as_deref().unwrap_or_else(|| command.get_name());
    let page = pages.into_iter().find(|page| page.get_name() == wanted);
    let page = page.ok_or_else(|| Failure::Usage(format!("there is no command `{wanted}`")))?;
    let text = page_text(page)?;
    report::print_with(|out| out.write_all(&text))
}

/// A page in the language of `man`.
fn page_text(command: &Command) -> Result<Vec<u8>> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text)?;
    Ok(text)
}

/// Prints the completions of a shell.
pub fn completions(shell: Shell) -> Result<()> {
    let mut command = Arguments::command();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "cloakroom", &mut script);
    report::print_with(|out| out.write_all(&script))
}
