//! What comes from outside, read up to a limit: more is refused before it fills the memory.

use std::io::{self, ErrorKind, Read};

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

#[cfg(test)]
mod tests {
    use super::*;

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
