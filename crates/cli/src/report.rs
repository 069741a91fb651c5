//! Words for people: messages on standard error, results on standard output.

use cloakroom::trace::Stopped;
use std::error::Error;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a command comes to.
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// Why the command ends without success.
#[derive(Debug)]
pub enum Failure {
    /// Bad input or failed work: one message.
    Failed(String),
    /// The command line asks for something that does not exist.
    Usage(String),
    /// Ctrl-C.
    Interrupted,
}

/// Whether it has been told that the command was interrupted.
static TOLD: AtomicBool = AtomicBool::new(false);

impl Failure {
    /// Both of two; the messages of failed work are told together.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Failed(one), Self::Failed(other)) => Self::Failed(format!("{one}; {other}")),
            (Self::Interrupted, _) | (_, Self::Interrupted) => Self::Interrupted,
            (first, _) => first,
        }
    }

    /// Tells the user and gives the exit status.
    pub fn tell(self) -> u8 {
        let (words, status) = match self {
            Self::Failed(message) => (format!("error: {message}"), 1),
            Self::Usage(message) => (format!("error: {message}"), 2),
            // The command may end as a second signal comes: it is told once.
            Self::Interrupted if TOLD.swap(true, Ordering::SeqCst) => return 130,
            Self::Interrupted => ("interrupted".to_owned(), 130),
        };
        say(&words);
        status
    }
}

impl<E: Error + 'static> From<E> for Failure {
    /// What work ends with that Ctrl-C has stopped, else a failure with the message of the error.
    fn from(error: E) -> Self {
        if Stopped::is_in(&error) { Self::Interrupted } else { Self::Failed(error.to_string()) }
    }
}

/// Does all of some work, whether or not a part of it fails; what has failed is one failure.
pub fn all(parts: impl IntoIterator<Item = Result<()>>) -> Result<()> {
    let failures: Vec<Failure> = parts.into_iter().filter_map(Result::err).collect();
    failures.into_iter().reduce(Failure::and).map_or(Ok(()), Err)
}

/// Says something on standard error. Nobody listening is no reason to fail.
pub fn say(message: &str) {
    let _ = writeln!(io::stderr(), "{}", printable(message));
}

/// Longer messages are cut: what they quote comes from files of any length, in bytes.
const LONGEST_MESSAGE: usize = 2000;

/// A message that a terminal shows as it is: characters that would command it, or turn the order of
/// others, are written as escapes.
pub fn printable(message: &str) -> String {
    let mut shown = String::new();
    for c in message.chars() {
        if shown.len() >= LONGEST_MESSAGE - 16 {
            shown.push_str(" …");
            break;
        }
        push_escaped(&mut shown, c);
    }
    shown
}

fn push_escaped(shown: &mut String, c: char) {
    let turns =
        matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if (c.is_control() && c != '\n') || turns {
        shown.extend(c.escape_default());
    } else {
        shown.push(c);
    }
}

/// Says that a file has been written.
pub fn wrote(path: &Path) {
    say(&path.display().to_string());
}

/// A number with so many decimals; no zero has a sign.
pub fn decimals(number: f64, places: usize) -> String {
    let text = format!("{number:.places$}");
    let is_zero =
        |digits: &str| digits.starts_with('0') && !digits.contains(|c| ('1'..='9').contains(&c));
    match text.strip_prefix('-') {
        Some(digits) if is_zero(digits) => digits.to_owned(),
        _ => text,
    }
}

/// Prints text for people on standard output, with the escapes of [`printable`], for it may quote a
/// scene. A reader that has gone away (as in `| head`) ends the printing without a fuss.
pub fn print(text: &str) -> Result<()> {
    let mut shown = String::with_capacity(text.len());
    text.chars().for_each(|c| push_escaped(&mut shown, c));
    print_with(|out| out.write_all(shown.as_bytes()))
}

/// Prints JSON on standard output, for people to read and programs to parse.
pub fn print_json(value: &impl serde::Serialize) -> Result<()> {
    print_with(|out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

/// Prints on standard output what `write` writes, as it comes.
pub fn print_with(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Failed(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_short_and_do_not_command_terminals() {
        assert_eq!(printable("a \u{1b}[2J\u{7}\u{9b}é\nb"), "a \\u{1b}[2J\\u{7}\\u{9b}é\nb");
        assert_eq!(printable("\u{202e}gnp.exe"), "\\u{202e}gnp.exe");
        for c in ["a", "é", "\u{1}", "\u{2066}", "𝔸"] {
            let shown = printable(&c.repeat(5000));
            assert!(shown.len() <= LONGEST_MESSAGE && shown.ends_with(" …"), "{}", shown.len());
        }
    }
}
