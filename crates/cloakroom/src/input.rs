//! What comes from outside, read up to a limit, for more is refused before it fills the memory, and
//! told apart by its content.

use sha2::{Digest as _, Sha256};
use std::fmt;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Reads to the end, onto the bytes that are there; with them there may be `longest`.
///
/// # Errors
///
/// If it cannot be read, or is longer: [`ErrorKind::FileTooLarge`].
pub fn read_up_to(longest: u64, from: impl Read, bytes: &mut Vec<u8>) -> io::Result<()> {
    from.take(longest + 1).read_to_end(bytes)?;
    if bytes.len() as u64 > longest {
        let message = format!("it is longer than {} MiB", longest >> 20);
        return Err(io::Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(())
}

/// The bytes of a file, `longest` of them at most.
///
/// # Errors
///
/// As [`read_up_to`].
// Inlined: where no file can ever be opened, as in a browser, what would read its bytes is found to be of no use, and left out.
#[inline(always)]
pub fn read_file(longest: u64, path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    read_up_to(longest, File::open(path)?, &mut bytes)?;
    Ok(bytes)
}

/// Why a file cannot be read, for people.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::IsADirectory => "it is a folder".to_owned(),
        ErrorKind::PermissionDenied => "reading it is not permitted".to_owned(),
        _ => error.to_string(),
    }
}

/// What tells the contents of files apart: their SHA-256, written as `sha256:` and 64 digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest([u8; 32]);

impl Digest {
    /// Of some bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("sha256:")?;
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_are_those_of_the_standard() {
        // FIPS 180-2, B.1.
        let digest = Digest::of(b"abc").to_string();
        assert_eq!(
            digest,
            "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }

    #[test]
    fn endless_input_is_refused() {
        let mut bytes = Vec::new();
        let refused = read_up_to(1 << 20, io::repeat(b' '), &mut bytes).expect_err("endless");
        assert_eq!(refused.kind(), ErrorKind::FileTooLarge);
        assert_eq!(refused.to_string(), "it is longer than 1 MiB");
        let mut bytes = b"some ".to_vec();
        read_up_to(9, &b"text"[..], &mut bytes).expect("short");
        assert_eq!(bytes, b"some text");
        assert!(read_up_to(9, &b"."[..], &mut bytes).is_err());
    }
}
