//! Makes cloakroom's default photograph, a person before a bookshelf, and the panorama of the room
//! around it.
//!
//! `bookshelf [--panorama] [--width N] [--samples N] [-o FILE]` builds a scene from
//! geometry and procedural materials and traces light through it. The photograph
//! stands for a plane 110 cm wide and 137.5 cm high; the panorama is what a device 50 cm before
//! it sees, all around, and continues the photograph over its edges. It is the same, byte for
//! byte, however many threads work on it.

mod books;
mod clothes;
mod complexion;
mod fields;
mod film;
mod hair;
mod head;
mod hierarchy;
mod light;
mod materials;
mod panorama;
mod person;
mod random;
mod room;
mod scene;
mod shapes;
mod shelf;
mod spine;
mod tracer;

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;

use crate::scene::{Detail, Scene};
use crate::tracer::Effort;

/// Quality of the JPEG: high enough that edges stay crisp.
const QUALITY: u8 = 93;

/// What the command line asks for.
struct Request {
    /// All around instead of the photograph.
    panorama: bool,
    /// Pixels a row.
    width: usize,
    /// Samples of a pixel.
    effort: Effort,
    /// Where the picture goes; `.png` or else JPEG.
    output: PathBuf,
}

impl Request {
    /// Reads the command line.
    fn read(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let effort = Effort { least: 6, most: 24 };
        let mut output = None;
        let mut request = Self { panorama: false, width: 2048, effort, output: PathBuf::new() };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--panorama" => request.panorama = true,
                "--width" => request.width = value()?.parse()?,
                "--samples" => request.effort.most = value()?.parse()?,
                "-o" => output = Some(value()?.into()),
                _ => return Err(format!(
                    "unknown argument {word}; usage: bookshelf [--panorama] [--width N] [--samples N] [-o FILE]"
                )
                .into()),
            }
        }
        let name = if request.panorama { "room.jpg" } else { "bookshelf.jpg" };
        request.output = output.unwrap_or_else(|| name.into());
        if request.panorama {
            // Its ceiling and walls show the noise that books hide.
            request.effort.least = 10;
        }
        let effort = &mut request.effort;
        effort.least = effort.least.min(effort.most);
        if request.width == 0 || effort.most == 0 {
            return Err("the width and the samples must be at least 1".into());
        }
        Ok(request)
    }
}

/// Writes the picture beside its place first, so that no one reads half of it.
fn write(picture: &RgbImage, path: &Path) -> Result<(), Box<dyn Error>> {
    let partial = path.with_extension("partial");
    let mut file = BufWriter::new(File::create(&partial)?);
    if path.extension().is_some_and(|e| e == "png") {
        picture.write_with_encoder(PngEncoder::new(&mut file))?;
    } else {
        picture.write_with_encoder(JpegEncoder::new_with_quality(&mut file, QUALITY))?;
    }
    file.flush()?;
    drop(file);
    fs::rename(partial, path)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let request = Request::read(std::env::args().skip(1))?;
    let film = if request.panorama {
        tracer::render_panorama(&Scene::with_room(Detail::FINE), request.width, request.effort)
    } else {
        tracer::render(&Scene::new(Detail::FINE), request.width, request.effort)
    };
    write(&film.develop(), &request.output)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a command line written as one string.
    fn read(line: &str) -> Result<Request, Box<dyn Error>> {
        Request::read(line.split_whitespace().map(String::from))
    }

    #[test]
    fn the_command_line_is_read() -> Result<(), Box<dyn Error>> {
        let request = read("--width 64 --samples 3 -o shelf.png")?;
        assert_eq!((request.width, request.effort.most, request.effort.least), (64, 3, 3));
        assert_eq!(request.output, Path::new("shelf.png"));
        assert_eq!(read("")?.width, 2048);
        assert_eq!(read("--width 64")?.output, Path::new("bookshelf.jpg"));
        assert_eq!(read("--panorama")?.output, Path::new("room.jpg"));
        Ok(())
    }

    #[test]
    fn nonsense_is_refused() {
        for line in ["--width", "--width 0", "--width many", "--samples 0", "shelf.png"] {
            assert!(read(line).is_err(), "{line}");
        }
    }
}
