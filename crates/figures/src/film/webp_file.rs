//! Animated WebP, lossless: the container (RFC 9649) around frames of the encoder.

use super::{Film, FilmError, stay, write_whole};
use image_webp::{ColorType, WebPEncoder};
use std::io::{self, Seek, SeekFrom, Write};

/// The bytes before the first chunk: "RIFF", the length, "WEBP".
const HEADER: usize = 12;

/// Writes frames as an animated WebP that goes round for ever.
pub(super) fn write(film: &Film<'_>) -> Result<(), FilmError> {
    let [width, height] = film.size("WebP", 16_384)?;
    write_whole(film.path, |out| {
        out.write_all(b"RIFF\0\0\0\0WEBP")?;
        const ANIMATED: u8 = 1 << 1;
        const DESCRIBED: u8 = 1 << 2;
        let canvas = [short(width - 1), short(height - 1)].concat();
        chunk(out, b"VP8X", &[&[ANIMATED | DESCRIBED, 0, 0, 0], canvas.as_slice()].concat())?;
        // Black ground; round for ever.
        chunk(out, b"ANIM", &[0, 0, 0, 255, 0, 0])?;
        for (number, frame) in film.checked([width, height]).enumerate() {
            let mut still = Vec::new();
            let encoder = WebPEncoder::new(&mut still);
            encoder.encode(frame?.as_raw(), width, height, ColorType::Rgb8)?;
            let place = [short(0), short(0)].concat();
            let delay = short(stay(number, film.rate, 1000.0));
            // Each frame replaces the one before.
            const REPLACE: [u8; 1] = [1 << 1];
            let head = [place.as_slice(), &canvas, &delay, &REPLACE].concat();
            chunk(out, b"ANMF", &[head.as_slice(), &still[HEADER..]].concat())?;
            film.done()?;
        }
        chunk(out, b"XMP ", description(film.metadata).as_bytes())?;
        let length = out.stream_position()? - 8;
        let length = u32::try_from(length)
            .map_err(|_| io::Error::other("a WebP file cannot be larger than 4 GiB"))?;
        out.seek(SeekFrom::Start(4))?;
        out.write_all(&length.to_le_bytes())?;
        out.seek(SeekFrom::End(0))?;
        Ok(())
    })
}

/// A number in 24 bits.
fn short(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

/// A chunk, filled up to an even length.
fn chunk(out: &mut (impl Write + Seek + ?Sized), name: &[u8; 4], data: &[u8]) -> io::Result<()> {
    let length = u32::try_from(data.len()).map_err(io::Error::other)?;
    out.write_all(name)?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(data)?;
    out.write_all(if data.len() % 2 == 1 { &[0] } else { &[] })
}

/// Metadata as XMP.
fn description(metadata: &[(String, String)]) -> String {
    let text: String = metadata.iter().map(|(key, text)| format!("{key}: {text}\n")).collect();
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\
         <rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\">\
         <dc:description><rdf:Alt><rdf:li xml:lang=\"x-default\">{text}</rdf:li></rdf:Alt></dc:description>\
         </rdf:Description></rdf:RDF></x:xmpmeta>"
    )
}
