//! The help of the command as a whole: its commands in groups.

use super::Arguments;
use clap::{Command, CommandFactory, FromArgMatches};
use std::fmt::Write;
use textwrap::{Options, WordSplitter, termwidth};

/// What the commands are for.
const GROUPS: [(&str, &[&str]); 4] = [
    (
        "Make pictures",
        &["render", "animate", "flight", "view", "diagram", "figures", "gallery", "merge"],
    ),
    (
        "Measure",
        &["quality", "compare", "flux", "pulses", "trace", "interface", "verify", "export"],
    ),
    ("Look things up", &["scenes", "devices", "materials", "check", "schema"]),
    ("Set up", &["completions", "manual", "help"]),
];

/// What stands below: where to begin.
const FIRST: &str = "Example:
  cloakroom scenes --out scenes
  cloakroom render scenes/shop-window.toml --size 640x480

`cloakroom help COMMAND` says what a command does.";

impl Arguments {
    /// Reads the command line.
    pub fn read() -> Result<Self, clap::Error> {
        let mut matches = in_groups(Self::command()).try_get_matches()?;
        Self::from_arg_matches_mut(&mut matches)
    }
}

/// The command with its subcommands in groups.
fn in_groups(command: Command) -> Command {
    let mut text = String::new();
    for (title, names) in GROUPS {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{title}:");
        for name in names {
            let about = match command.find_subcommand(name).and_then(Command::get_about) {
                Some(about) => about.to_string(),
                None => "Print this, or the help of a command".to_owned(),
            };
            text += &listed(name, 11, &about);
        }
        text.push('\n');
    }
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{text}Options:\n{{options}}{{after-help}}"
    );
    command.help_template(template).after_help(FIRST)
}

/// A name and words about it, wrapped to the width of the terminal: in two columns, the first of them
/// `width` wide where the name has room in it.
pub fn listed(name: &str, width: usize, words: &str) -> String {
    let rest = " ".repeat(width + 3);
    if name.chars().count() > width {
        return format!("  {name}\n{}\n", wrapped(words, &rest, &rest));
    }
    format!("{}\n", wrapped(words, &format!("  {name:<width$} "), &rest))
}

/// Words wrapped to the width of the terminal, with what begins the first line and the others.
pub fn wrapped(words: &str, first: &str, rest: &str) -> String {
    let options = Options::new(termwidth()).initial_indent(first).subsequent_indent(rest);
    let splitter = WordSplitter::NoHyphenation;
    textwrap::fill(words, options.break_words(false).word_splitter(splitter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_command_is_in_one_group_and_has_an_example_that_can_be_read() {
        let command = Arguments::command();
        let grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        let named: BTreeSet<&str> = grouped.iter().copied().collect();
        assert_eq!(named.len(), grouped.len());
        let there: BTreeSet<&str> =
            command.get_subcommands().map(Command::get_name).chain(["help"]).collect();
        assert_eq!(named, there);
        for subcommand in command.get_subcommands() {
            let help = subcommand.get_after_help().map(ToString::to_string).unwrap_or_default();
            let example = help.strip_prefix("Example:\n  ").expect("an example");
            let words = example.split(" > ").next().unwrap_or_default().split(' ');
            let read = Arguments::command().try_get_matches_from(words);
            assert!(read.is_ok(), "{example}");
            assert!(example.starts_with(&format!("cloakroom {}", subcommand.get_name())));
        }
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        let help = in_groups(Arguments::command()).render_help().to_string();
        assert!(
            help.contains("Make pictures:\n  render") && help.contains("  cloakroom scenes --out")
        );
        assert!(help.lines().all(|line| line.chars().count() <= termwidth().max(80)), "{help}");
    }
}
