//! What VTK XML files have in common: their head, and arrays appended in base64.

use base64::prelude::{BASE64_STANDARD, Engine};
use std::io::{self, Write};

/// Writes the head of a file of a type of data, with metadata as comments.
pub(super) fn begin(
    out: &mut dyn Write,
    kind: &str,
    metadata: &[(String, String)],
) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    for (key, text) in metadata {
        // Two hyphens would end a comment.
        writeln!(out, "<!-- {key}: {} -->", text.replace('-', "\u{2010}"))?;
    }
    writeln!(
        out,
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )
}

/// Arrays that stand at the end of a file, in the order in which they are told of: little-endian,
/// each with its length before it, in base64.
#[derive(Debug, Default)]
pub(super) struct Appended {
    offset: usize,
}

impl Appended {
    /// Tells of an array of so many bytes, where it belongs.
    pub fn tell(
        &mut self,
        out: &mut dyn Write,
        name: &str,
        kind: &str,
        components: usize,
        bytes: usize,
    ) -> io::Result<()> {
        writeln!(
            out,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>",
            self.offset
        )?;
        // In base64 three bytes are four letters.
        self.offset += (8 + bytes).div_ceil(3) * 4;
        Ok(())
    }

    /// Begins the arrays.
    pub fn begin(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "<AppendedData encoding=\"base64\">\n_")
    }

    /// Writes the bytes of the next array.
    pub fn write(out: &mut dyn Write, bytes: Vec<u8>) -> io::Result<()> {
        let mut all = (bytes.len() as u64).to_le_bytes().to_vec();
        all.extend(bytes);
        // Whole groups of three bytes go together.
        for piece in all.chunks(3 << 20) {
            out.write_all(BASE64_STANDARD.encode(piece).as_bytes())?;
        }
        Ok(())
    }

    /// Ends the arrays, and the file.
    pub fn end(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "\n</AppendedData>\n</VTKFile>")?;
        out.flush()
    }
}
