//! Data from files or standard input.

use crate::report::Failure;
use cloakroom::input::read_up_to;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Longer texts are refused before they fill the memory, in bytes.
const LONGEST: u64 = 1 << 30;

/// The text of a file, or of standard input for `-`, and what to call it in messages.
pub fn read(path: &Path) -> Result<(String, String), Failure> {
    let mut bytes = Vec::new();
    let (name, read) = if path == Path::new("-") {
        ("standard input".to_owned(), read_up_to(LONGEST, io::stdin(), &mut bytes))
    } else {
        let read = File::open(path).and_then(|file| read_up_to(LONGEST, file, &mut bytes));
        (path.display().to_string(), read)
    };
    let failed = |reason: String| Failure::Failed(format!("cannot read {name}: {reason}"));
    read.map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => failed(format!("{error}; give it in parts")),
        _ => failed(error.to_string()),
    })?;
    let text = String::from_utf8(bytes).map_err(|_| failed("it is not UTF-8 text".to_owned()))?;
    Ok((text, name))
}
