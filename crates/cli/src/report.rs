//! Words for people: messages on standard error, results on standard output.

use std::io::Write;
use std::process::ExitCode;

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

impl Failure {
    /// A failure with the message of an error.
    pub fn from_error(error: impl std::fmt::Display) -> Self {
        Self::Failed(error.to_string())
    }

    /// Tells the user and gives the exit status.
    pub fn tell(self) -> ExitCode {
        match self {
            Self::Failed(message) => {
                say(&format!("error: {message}"));
                ExitCode::from(1)
            }
            Self::Usage(message) => {
                say(&format!("error: {message}"));
                ExitCode::from(2)
            }
            Self::Interrupted => {
                say("interrupted");
                ExitCode::from(130)
            }
        }
    }
}

/// Says something on standard error. Nobody listening is no reason to fail.
pub fn say(message: &str) {
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Prints text on standard output. A reader that has gone away (as in `| head`) ends the printing
/// without a fuss.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match written {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Failed(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints JSON on standard output, for people to read and programs to parse.
pub fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(Failure::from_error)?;
    print(&format!("{text}\n"))
}
