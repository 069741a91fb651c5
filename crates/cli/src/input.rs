//! Data from files or standard input.

use crate::report::Failure;
use std::io::Read;
use std::path::Path;

/// The text of a file, or of standard input for `-`, and what to call it in messages.
pub fn read(path: &Path) -> Result<(String, String), Failure> {
    let mut text = String::new();
    let (name, read) = if path == Path::new("-") {
        ("standard input".to_owned(), std::io::stdin().read_to_string(&mut text))
    } else {
        let read = std::fs::File::open(path).and_then(|mut file| file.read_to_string(&mut text));
        (path.display().to_string(), read)
    };
    read.map_err(|error| Failure::Failed(format!("cannot read {name}: {error}")))?;
    Ok((text, name))
}
