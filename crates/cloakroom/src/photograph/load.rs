//! Reading image files into linear light.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::exr_image::ExrImage;
use super::linear_image::{LinearImage, MAX_MEMORY, MAX_PIXELS, Texels};
use super::source::{ImageSource, LoadError, LoadProblem, check};
use super::{jpeg_markers, srgb};
use crate::input::{Digest, read_up_to};
use crate::memory;

#[cfg(test)]
mod tests;

/// Whether EXR is read. A page that computes by itself would have to load what does: a tenth of all that it is.
const READS_EXR: bool = !cfg!(target_arch = "wasm32");

/// Largest image file, in bytes.
const MAX_FILE: u64 = 2 << 30;

/// Width and height of an image in pixels, as it stands upright, without decoding its pixels.
///
/// # Errors
///
/// As [`load()`], as far as the file's header tells.
pub fn dimensions(source: &ImageSource) -> Result<(u32, u32), LoadError> {
    if let ImageSource::Memory(image) = source {
        // Checked when it was made a source: far fewer than 2^32.
        return Ok((image.width as u32, image.height as u32));
    }
    let size = || {
        let bytes = read_bytes(source)?;
        if format(&bytes)? == ImageFormat::OpenExr && READS_EXR {
            let image = open_exr(&bytes, MAX_PIXELS)?;
            return Ok(image.size().into());
        }
        let mut decoder = open(&bytes, MAX_PIXELS)?;
        let (width, height) = decoder.dimensions();
        let orientation = guarded(|| Ok(orientation(&mut decoder)))?;
        // The odd half of the orientations exchanges rows and columns.
        Ok(if orientation.to_exif() >= 5 { (height, width) } else { (width, height) })
    };
    size().map_err(|problem| LoadError { image: source.clone(), problem })
}

/// Reads an image into linear light.
///
/// PNG (1 to 16 bits, gray, palette, colour) and JPEG are taken as sRGB and turned upright as
/// their EXIF orientation says; EXR (red, green and blue, or gray; of several layers the one called
/// `Combined`) is taken as linear light. Transparent pixels lie over black: the colors of EXR come
/// multiplied by their alpha already.
/// The kind of file is seen from its content, not from its name.
///
/// # Errors
///
/// [`LoadError`] where the file is missing, unreadable, no image, damaged, without pixels or too
/// large (decided before memory is taken), or where an EXR pixel is not finite or beyond 1e30: such
/// a pixel would spread over the picture as soon as it is filtered.
pub fn load(source: &ImageSource) -> Result<LinearImage, LoadError> {
    Ok(load_with_digest(source)?.0)
}

/// The same, with the digest of the file that was read.
///
/// # Errors
///
/// As [`load()`].
pub(crate) fn load_with_digest(
    source: &ImageSource,
) -> Result<(LinearImage, Option<Digest>), LoadError> {
    if let ImageSource::Memory(image) = source {
        return Ok((LinearImage::clone(image), None));
    }
    let is_file = matches!(source, ImageSource::File(_));
    read_bytes(source)
        .and_then(|bytes| Ok((read(&bytes, MAX_PIXELS)?, is_file.then(|| Digest::of(&bytes)))))
        .map_err(|problem| LoadError { image: source.clone(), problem })
}

/// Reads the bytes of an image file, as [`load()`] does; `source` is its name in messages. It may
/// have `most_pixels` pixels.
///
/// # Errors
///
/// As [`load()`].
pub fn load_bytes(
    source: &ImageSource,
    bytes: &[u8],
    most_pixels: u64,
) -> Result<LinearImage, LoadError> {
    read(bytes, most_pixels).map_err(|problem| LoadError { image: source.clone(), problem })
}

/// Linear light from the bytes of an image file.
fn read(bytes: &[u8], most_pixels: u64) -> Result<LinearImage, LoadProblem> {
    let image = if format(bytes)? == ImageFormat::OpenExr && READS_EXR {
        let image = open_exr(bytes, most_pixels)?;
        guarded(|| image.read(bytes))?
    } else {
        linear(guarded(|| decode(bytes, most_pixels))?)
    };
    check(&image)?;
    Ok(image)
}

/// The bytes of an image file, once its beginning shows that it can be one.
fn read_bytes(source: &ImageSource) -> Result<Cow<'static, [u8]>, LoadProblem> {
    let path = match source {
        ImageSource::BuiltIn(name) => {
            return ImageSource::built_in(name).map(Cow::Borrowed).ok_or(LoadProblem::Missing);
        }
        ImageSource::File(path) => path,
        // It has no file: `load` and `dimensions` look at it itself.
        ImageSource::Memory(_) => return Err(LoadProblem::NotAnImage),
    };
    let failed = |reason: io::Error| match reason.kind() {
        io::ErrorKind::NotFound => LoadProblem::Missing,
        io::ErrorKind::IsADirectory => LoadProblem::Folder,
        io::ErrorKind::FileTooLarge => LoadProblem::TooLarge,
        _ => LoadProblem::Unreadable(reason),
    };
    let mut file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if metadata.is_dir() {
        return Err(LoadProblem::Folder);
    }
    if metadata.len() > MAX_FILE {
        return Err(LoadProblem::TooLarge);
    }
    // Devices and pipes have no length: look at the beginning before reading on.
    let mut bytes = Vec::new();
    file.by_ref().take(16).read_to_end(&mut bytes).map_err(failed)?;
    format(&bytes)?;
    let length = usize::try_from(metadata.len()).unwrap_or(0);
    bytes.try_reserve(length).map_err(|_| failed(io::ErrorKind::OutOfMemory.into()))?;
    read_up_to(MAX_FILE, file, &mut bytes).map_err(failed)?;
    Ok(bytes.into())
}

/// The format, from the first bytes.
fn format(bytes: &[u8]) -> Result<ImageFormat, LoadProblem> {
    if bytes.is_empty() {
        return Err(LoadProblem::Empty);
    }
    match image::guess_format(bytes) {
        Ok(ImageFormat::OpenExr) if !READS_EXR => Err(LoadProblem::NotInBrowser),
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::OpenExr)) => Ok(format),
        Ok(other) => Err(LoadProblem::OtherFormat(format!("{other:?}").to_uppercase())),
        Err(_) => Err(LoadProblem::NotAnImage),
    }
}

/// A decoder of a PNG or JPEG that has read the header and found the size acceptable.
fn open(bytes: &[u8], most_pixels: u64) -> Result<impl ImageDecoder + use<'_>, LoadProblem> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format(bytes)?);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_MEMORY);
    reader.limits(limits);
    let decoder = guarded(|| reader.into_decoder().map_err(from_decoder))?;
    // 8-bit images stay as they are; others become floats beside their decoded form. The coarser
    // levels of the pyramid add a third.
    let color = decoder.color_type();
    let decoded = u64::from(color.bytes_per_pixel());
    let per_pixel = match color {
        image::ColorType::Rgb8 | image::ColorType::L8 => decoded + 3 + 4,
        _ => 2 * decoded + 12 + 4,
    };
    check_size(decoder.dimensions().into(), most_pixels, per_pixel)?;
    Ok(decoder)
}

/// The image in an EXR file, its size found acceptable.
fn open_exr(bytes: &[u8], most_pixels: u64) -> Result<ExrImage, LoadProblem> {
    let image = guarded(|| ExrImage::find(bytes))?;
    // Three floats, and those of the coarser levels of the pyramid.
    check_size(image.size(), most_pixels, 12 + 4)?;
    Ok(image)
}

/// Refuses an image without pixels, and one that takes more memory than is allowed or there.
fn check_size(
    [width, height]: [u32; 2],
    most_pixels: u64,
    per_pixel: u64,
) -> Result<(), LoadProblem> {
    if width == 0 || height == 0 {
        return Err(LoadProblem::NoPixels([width, height]));
    }
    let pixels = u64::from(width) * u64::from(height);
    if pixels > most_pixels.min(MAX_PIXELS) || pixels * per_pixel > MAX_MEMORY {
        return Err(LoadProblem::TooLarge);
    }
    Ok(memory::check(pixels * per_pixel, u64::MAX)?)
}

/// The decoded image of a PNG or JPEG, upright.
fn decode(bytes: &[u8], most_pixels: u64) -> Result<DynamicImage, LoadProblem> {
    let mut decoder = open(bytes, most_pixels)?;
    if format(bytes)? == ImageFormat::Jpeg && !jpeg_markers::is_complete(bytes) {
        return Err(LoadProblem::Damaged("the end-of-image marker is missing".to_owned()));
    }
    let orientation = orientation(&mut decoder);
    let mut image = DynamicImage::from_decoder(decoder).map_err(from_decoder)?;
    image.apply_orientation(orientation);
    Ok(image)
}

/// How the image lies; an orientation that cannot be read is none.
fn orientation(decoder: &mut impl ImageDecoder) -> Orientation {
    decoder.orientation().unwrap_or(Orientation::NoTransforms)
}

/// Runs a decoder; a panic inside it (a bug set off by a damaged file) becomes an error.
fn guarded<T>(work: impl FnOnce() -> Result<T, LoadProblem>) -> Result<T, LoadProblem> {
    // The decoder is dropped by the panic; nothing of it is looked at again.
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err(LoadProblem::Damaged("the decoder gave up".to_owned())))
}

fn from_decoder(error: ImageError) -> LoadProblem {
    match error {
        ImageError::Limits(_) => LoadProblem::TooLarge,
        ImageError::Unsupported(reason) => LoadProblem::Unsupported(reason.to_string()),
        other => LoadProblem::Damaged(other.to_string()),
    }
}

/// Linear light from decoded pixels; transparent pixels lie over black.
fn linear(image: DynamicImage) -> LinearImage {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let is_opaque = |pixels: &image::RgbaImage| pixels.pixels().all(|pixel| pixel.0[3] == 255);
    let texels = match image {
        DynamicImage::ImageRgb8(_) | DynamicImage::ImageLuma8(_) => {
            Texels::Srgb8(image.into_rgb8().into_raw())
        }
        DynamicImage::ImageRgba8(ref pixels) if is_opaque(pixels) => {
            Texels::Srgb8(image.into_rgb8().into_raw())
        }
        DynamicImage::ImageLumaA8(_) | DynamicImage::ImageRgba8(_) => {
            let table = srgb::decode_table();
            over_black(image.into_rgba8().as_raw(), |code| table[usize::from(code)], 1.0 / 255.0)
        }
        deep => {
            let table: Vec<f32> =
                (0..=u16::MAX).map(|code| srgb::decode(f64::from(code) / 65535.0) as f32).collect();
            over_black(deep.into_rgba16().as_raw(), |code| table[usize::from(code)], 1.0 / 65535.0)
        }
    };
    LinearImage { width, height, texels }
}

/// Linear light of pixels over black: of red, green, blue and alpha of each, row by row. `light` is
/// that of one of the colors; `unit` is one over the largest alpha.
#[must_use]
pub fn over_black<S: Copy + Into<f32>>(rgba: &[S], light: impl Fn(S) -> f32, unit: f32) -> Texels {
    let mut values = Vec::with_capacity(rgba.len() / 4 * 3);
    for texel in rgba.chunks_exact(4) {
        let alpha = texel[3].into() * unit;
        values.extend(texel[..3].iter().map(|&value| light(value) * alpha));
    }
    Texels::Linear(values)
}
