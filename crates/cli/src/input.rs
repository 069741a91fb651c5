//! Data from files or standard input.

use crate::report::Failure;
use std::io::{self, Read};
use std::path::Path;

/// Longer texts are refused before they fill the memory, in bytes.
const LONGEST: u64 = 1 << 30;

/// The text of a file, or of standard input for `-`, and what to call it in messages.
pub fn read(path: &Path) -> Result<(String, String), Failure> {
    let (name, read) = if path == Path::new("-") {
        ("standard input".to_owned(), up_to(io::stdin(), LONGEST))
    } else {
        let read = std::fs::File::open(path).and_then(|file| up_to(file, LONGEST));
        (path.display().to_string(), read)
    };
    let text = read.map_err(|error| Failure::Failed(format!("cannot read {name}: {error}")))?;
    Ok((text, name))
}

fn up_to(from: impl Read, longest: u64) -> io::Result<String> {
    let mut text = String::new();
    from.take(longest + 1).read_to_string(&mut text)?;
    if text.len() as u64 > longest {
        return Err(io::Error::other(format!(
            "it is longer than {} MiB; give it in parts",
            longest >> 20
        )));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endless_input_is_refused() {
        let refused = up_to(io::repeat(b' '), 1 << 20).expect_err("must be refused");
        assert!(refused.to_string().contains("longer than 1 MiB"), "{refused}");
        assert_eq!(up_to(&b"text"[..], 4).expect("short"), "text");
    }
}
