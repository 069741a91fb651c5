//! PNG: 8-bit sRGB.

use super::{OutputError, Picture, RgbImage, Samples, WriteSeek, write_whole};
use crate::photograph::decode;
use std::io::{self, Write};
use std::path::Path;

/// The image `R`, `G`, `B` of a picture as 8-bit sRGB (IEC 61966-2-1), clamped to what that can
/// show.
///
/// # Errors
///
/// [`OutputError::MissingChannel`] if the picture has no image.
pub fn to_srgb(picture: &Picture) -> Result<RgbImage, OutputError> {
    let find = |name: &str| {
        let samples = picture.channel(name).map(|channel| &channel.samples);
        samples.ok_or_else(|| OutputError::MissingChannel(name.to_owned()))
    };
    let planes: [&Samples; 3] = [find("R")?, find("G")?, find("B")?];
    let codes = Codes::new();
    let mut bytes = vec![0; 3 * picture.width * picture.height];
    for (channel, plane) in planes.into_iter().enumerate() {
        let pixels = bytes.iter_mut().skip(channel).step_by(3);
        match plane {
            Samples::F32(values) => {
                pixels.zip(values).for_each(|(byte, light)| *byte = codes.nearest((*light).into()));
            }
            other => {
                pixels.enumerate().for_each(|(i, byte)| *byte = codes.nearest(other.get(i)));
            }
        }
    }
    // Pictures are at most 65536 pixels a side, and the buffer has been made to measure.
    RgbImage::from_raw(picture.width as u32, picture.height as u32, bytes)
        .ok_or_else(|| OutputError::MissingChannel("R".to_owned()))
}

/// Linear light of pixels, red, green and blue, as 8-bit sRGB, clamped to what that can show; `None` if
/// they are not that many.
#[must_use]
pub fn light_to_srgb([width, height]: [u32; 2], pixels: &[[f32; 3]]) -> Option<RgbImage> {
    let codes = Codes::new();
    let bytes = pixels.as_flattened().iter().map(|light| codes.nearest((*light).into()));
    RgbImage::from_raw(width, height, bytes.collect())
}

/// The sRGB codes of linear light.
struct Codes {
    /// The linear light from which on the next code is nearer: entry n lies between the codes n and
    /// n + 1.
    thresholds: [f64; 255],
    /// The codes at the lower ends of equal parts of the light from 0 to 1, which hold two codes at
    /// most.
    lowest: [u8; PARTS],
}

/// More than codes a unit of light, even in the dark.
const PARTS: usize = 4096;

impl Codes {
    fn new() -> Self {
        // Half-way between the two.
        let thresholds: [f64; 255] = std::array::from_fn(|n| decode((n as f64 + 0.5) / 255.0));
        let lowest = std::array::from_fn(|part| {
            let light = part as f64 / PARTS as f64;
            thresholds.partition_point(|threshold| *threshold <= light) as u8
        });
        Self { thresholds, lowest }
    }

    /// The code nearest to linear light; NaN is black.
    fn nearest(&self, linear: f64) -> u8 {
        // Negative light and NaN become 0.
        let part = ((linear * PARTS as f64) as i32).clamp(0, PARTS as i32 - 1);
        let mut code = self.lowest[part as usize];
        while self.thresholds.get(usize::from(code)).is_some_and(|threshold| *threshold <= linear) {
            code += 1;
        }
        code
    }
}

/// Writes an image as a PNG with text metadata.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_png(
    image: &RgbImage,
    metadata: &[(String, String)],
    path: &Path,
) -> Result<(), OutputError> {
    write_whole(path, |out| encode_png(image, metadata, out))
}

/// Writes an image as the bytes of a PNG with text metadata.
///
/// # Errors
///
/// If they cannot be written.
pub fn encode_png(
    image: &RgbImage,
    metadata: &[(String, String)],
    out: &mut dyn WriteSeek,
) -> io::Result<()> {
    let mut writer = encoder(image.dimensions(), metadata, out)?.write_header()?;
    writer.write_image_data(image.as_raw())?;
    Ok(writer.finish()?)
}

/// Writes an image that comes in strips, as wide as the whole and from top to bottom, as a PNG with
/// text metadata: no more than a strip need be in memory.
///
/// # Errors
///
/// If the file cannot be written, a strip is an error, or they are not the whole image.
pub fn write_png_in_strips(
    [width, height]: [u32; 2],
    metadata: &[(String, String)],
    path: &Path,
    strips: impl IntoIterator<Item = io::Result<RgbImage>>,
) -> Result<(), OutputError> {
    write_whole(path, |out| {
        let mut writer = encoder((width, height), metadata, out)?.write_header()?;
        let mut stream = writer.stream_writer()?;
        for strip in strips {
            stream.write_all(strip?.as_raw())?;
        }
        stream.finish()?;
        Ok(writer.finish()?)
    })
}

/// An encoder of 8-bit sRGB with text metadata.
pub fn encoder<'o>(
    (width, height): (u32, u32),
    metadata: &[(String, String)],
    out: &'o mut dyn WriteSeek,
) -> Result<png::Encoder<'static, &'o mut dyn WriteSeek>, png::EncodingError> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (key, text) in metadata {
        // The keyword PNG registers is capitalized.
        let key = if key == "software" { "Software" } else { key };
        encoder.add_itxt_chunk(key.to_owned(), text.clone())?;
    }
    Ok(encoder)
}

/// The text metadata of a PNG, under the names that they have here.
pub fn texts(info: &png::Info<'_>) -> Result<Vec<(String, String)>, png::DecodingError> {
    let text = |chunk: &png::text_metadata::ITXtChunk| {
        let key = if chunk.keyword == "Software" { "software" } else { &chunk.keyword };
        Ok((key.to_owned(), chunk.get_text()?))
    };
    info.utf8_text.iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Channel;
    use super::*;

    fn gray(values: &[f32]) -> Picture {
        let channels = ["R", "G", "B"]
            .map(|name| Channel { name: name.to_owned(), samples: Samples::F32(values.to_vec()) });
        Picture {
            width: values.len(),
            height: 1,
            channels: channels.to_vec(),
            metadata: vec![("scene".to_owned(), "[camera]\nseed = 0 # µ".to_owned())],
        }
    }

    #[test]
    fn linear_light_becomes_srgb() {
        // 0.2140411 is the linear light of code 127.5, 0.5 that of 187.52.
        let image = to_srgb(&gray(&[0.0, 1.0, 0.5, 0.2139, 0.2142, -3.0, 7.0, f32::NAN]));
        let codes: Vec<u8> = image.expect("an image").pixels().map(|pixel| pixel.0[0]).collect();
        assert_eq!(codes[..7], [0, 255, 188, 127, 128, 0, 255]);
        assert_eq!(codes[7], 0);
    }

    #[test]
    fn strips_are_the_whole_image() {
        let folder = tempfile::tempdir().expect("a folder");
        let image = RgbImage::from_fn(37, 50, |x, y| image::Rgb([x as u8, y as u8, (x * y) as u8]));
        let strip = |rows: std::ops::Range<u32>| {
            Ok(image::imageops::crop_imm(&image, 0, rows.start, 37, rows.end - rows.start)
                .to_image())
        };
        let path = folder.path().join("strips.png");
        let metadata = [("seed".to_owned(), "7".to_owned())];
        write_png_in_strips([37, 50], &metadata, &path, [0..20, 20..24, 24..50].map(strip))
            .expect("a file");
        let read = image::open(&path).expect("an image").into_rgb8();
        assert_eq!(read, image);
        // What is missing or fails leaves no file.
        let path = folder.path().join("part.png");
        assert!(write_png_in_strips([37, 50], &[], &path, [0..20, 20..24].map(strip)).is_err());
        let failing = [strip(0..20), Err(io::Error::other("no more"))];
        assert!(write_png_in_strips([37, 50], &[], &path, failing).is_err());
        assert!(!path.exists());
    }

    #[test]
    fn every_code_survives_the_way_there_and_back() {
        let codes = Codes::new();
        for n in 0..=255u8 {
            assert_eq!(codes.nearest(decode(f64::from(n) / 255.0)), n);
        }
    }

    #[test]
    fn codes_change_at_the_thresholds_and_nowhere_else() {
        let codes = Codes::new();
        for (threshold, n) in codes.thresholds.into_iter().zip(0u8..) {
            assert_eq!(codes.nearest(threshold), n + 1);
            assert_eq!(codes.nearest(threshold.next_down()), n);
        }
        for i in 0..100_000 {
            let light = f64::from(i) / 90_000.0;
            let counted = codes.thresholds.iter().filter(|threshold| **threshold <= light).count();
            assert_eq!(usize::from(codes.nearest(light)), counted);
        }
    }

    #[test]
    fn a_file_can_be_read_back_with_its_metadata() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let picture = gray(&[0.0, 0.3, 1.0]);
        super::super::write(&picture, &path).expect("written");
        let decoder =
            png::Decoder::new(io::BufReader::new(std::fs::File::open(&path).expect("a file")));
        let mut reader = decoder.read_info().expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut bytes).expect("pixels");
        assert_eq!(bytes, to_srgb(&picture).expect("an image").into_raw());
        let text = &reader.info().utf8_text[0];
        assert_eq!(text.keyword, "scene");
        assert_eq!(text.get_text().expect("text"), "[camera]\nseed = 0 # µ");
    }
}
