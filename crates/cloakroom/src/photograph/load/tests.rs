use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{ImageBuffer, ImageEncoder, Luma, LumaA, Rgb, Rgba};

use super::*;
use crate::keys::BUILT_IN_IMAGES;

/// A folder with one file.
fn with_file<T>(name: &str, bytes: &[u8], test: impl FnOnce(&ImageSource) -> T) -> T {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("a temporary file");
    test(&ImageSource::File(path))
}

fn load_bytes(name: &str, bytes: &[u8]) -> Result<LinearImage, LoadError> {
    with_file(name, bytes, load)
}

fn message(name: &str, bytes: &[u8]) -> String {
    load_bytes(name, bytes).expect_err("an error").to_string()
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("an encoded image");
    bytes.into_inner()
}

/// A smooth colour picture that JPEG keeps well.
fn gradient(width: u32, height: u32) -> DynamicImage {
    let pixel = |x, y| Rgb([(x * 255 / width) as u8, (y * 255 / height) as u8, 100]);
    ImageBuffer::from_fn(width, height, pixel).into()
}

fn floats(image: &LinearImage) -> Vec<f32> {
    match &image.texels {
        Texels::Srgb8(codes) => {
            codes.iter().map(|&code| srgb::decode_table()[usize::from(code)]).collect()
        }
        Texels::Linear(values) => values.clone(),
    }
}

#[test]
fn eight_bit_png_keeps_its_codes() {
    let picture = gradient(20, 10);
    let image = load_bytes("a.png", &encoded(&picture, ImageFormat::Png)).expect("an image");
    assert_eq!((image.width, image.height), (20, 10));
    assert_eq!(image.texels, Texels::Srgb8(picture.into_rgb8().into_raw()));
}

#[test]
fn sixteen_bit_png_keeps_its_precision() {
    let picture =
        ImageBuffer::from_fn(3, 1, |x, _| Rgb([[0u16, 1, 65535][x as usize], 40_000, 257]));
    let bytes = encoded(&DynamicImage::ImageRgb16(picture), ImageFormat::Png);
    let values = floats(&load_bytes("a.png", &bytes).expect("an image"));
    let expected = |code: f64| srgb::decode(code / 65535.0) as f32;
    assert_eq!(values[0..3], [0.0, expected(40_000.0), expected(257.0)]);
    assert_eq!(values[3], expected(1.0));
    assert_eq!(values[6], 1.0);
    // 257 of 65535 is 1 of 255.
    assert!((values[2] - srgb::decode_table()[1]).abs() < 1e-9);
}

#[test]
fn gray_and_alpha_become_light_over_black() {
    let gray = DynamicImage::ImageLuma8(ImageBuffer::from_pixel(2, 2, Luma([128])));
    let image = load_bytes("a.png", &encoded(&gray, ImageFormat::Png)).expect("an image");
    assert_eq!(image.texels, Texels::Srgb8(vec![128; 12]));

    let half = DynamicImage::ImageRgba8(ImageBuffer::from_pixel(1, 1, Rgba([255, 128, 0, 51])));
    let values = floats(&load_bytes("a.png", &encoded(&half, ImageFormat::Png)).expect("an image"));
    let table = srgb::decode_table();
    for (value, expected) in values.iter().zip([0.2, table[128] * 0.2, 0.0]) {
        assert!((value - expected).abs() < 1e-6, "{values:?}");
    }

    let deep = DynamicImage::ImageLumaA16(ImageBuffer::from_pixel(1, 1, LumaA([65535, 32768])));
    let values = floats(&load_bytes("a.png", &encoded(&deep, ImageFormat::Png)).expect("an image"));
    assert!(values.iter().all(|value| (value - 0.500_007).abs() < 1e-5), "{values:?}");
}

#[test]
fn palette_png() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Two);
    encoder.set_palette(vec![10, 20, 30, 40, 50, 60]);
    let mut writer = encoder.write_header().expect("a header");
    // Index 1, then index 0.
    writer.write_image_data(&[0b0100_0000]).expect("pixels");
    writer.finish().expect("an end");
    let image = load_bytes("a.png", &bytes).expect("an image");
    assert_eq!(image.texels, Texels::Srgb8(vec![40, 50, 60, 10, 20, 30]));
}

#[test]
fn jpeg_is_close_to_what_was_written() {
    let picture = gradient(64, 48);
    let image = load_bytes("a.jpg", &encoded(&picture, ImageFormat::Jpeg)).expect("an image");
    let Texels::Srgb8(codes) = image.texels else { panic!("8-bit codes") };
    let expected = picture.into_rgb8().into_raw();
    let mean = codes.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b) as f64).sum::<f64>()
        / codes.len() as f64;
    assert!(mean < 4.0, "{mean}");
}

/// A JPEG with an EXIF segment that says how it lies.
fn oriented_jpeg(picture: &DynamicImage, orientation: u8) -> Vec<u8> {
    let jpeg = encoded(picture, ImageFormat::Jpeg);
    let mut exif = b"Exif\0\0MM\0\x2A\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
    let mut bytes = jpeg[..2].to_vec();
    bytes.extend([0xFF, 0xE1]);
    bytes.extend((exif.len() as u16 + 2).to_be_bytes());
    bytes.extend(exif);
    bytes.extend(&jpeg[2..]);
    bytes
}

#[test]
fn exif_orientation_turns_the_picture_upright() {
    // Red grows to the right, green downwards; where does the stored top left corner end?
    let picture = gradient(64, 32);
    for (orientation, (width, height), (right, bottom)) in [
        (1, (64, 32), (false, false)),
        (2, (64, 32), (true, false)),
        (3, (64, 32), (true, true)),
        (4, (64, 32), (false, true)),
        (5, (32, 64), (false, false)),
        (6, (32, 64), (true, false)),
        (7, (32, 64), (true, true)),
        (8, (32, 64), (false, true)),
    ] {
        let bytes = oriented_jpeg(&picture, orientation);
        let size = with_file("a.jpg", &bytes, dimensions).expect("a size");
        assert_eq!(size, (width, height), "orientation {orientation}");
        let image = load_bytes("a.jpg", &bytes).expect("an image");
        assert_eq!((image.width, image.height), (width as usize, height as usize));
        let values = floats(&image);
        let x = if right { image.width - 1 } else { 0 };
        let y = if bottom { image.height - 1 } else { 0 };
        let corner = &values[(y * image.width + x) * 3..][..2];
        assert!(corner[0] < 0.02 && corner[1] < 0.02, "orientation {orientation}: {corner:?}");
    }
}

#[test]
fn exr_is_linear_light() {
    let values = vec![0.0, 1.5, -0.25, 1e-3, 1000.0, 0.5];
    let picture = ImageBuffer::from_raw(2, 1, values.clone()).expect("two pixels");
    let bytes = encoded(&DynamicImage::ImageRgb32F(picture), ImageFormat::OpenExr);
    let image = load_bytes("a.exr", &bytes).expect("an image");
    assert_eq!(image.texels, Texels::Linear(values));
}

#[test]
fn exr_pixels_that_are_not_finite_are_refused() {
    for (bad, said) in [
        (f32::NAN, "not a finite number, in column 1 and row 2"),
        (f32::INFINITY, "not a finite number, in column 1 and row 2"),
        (-3e38, "beyond 1e30, in column 1 and row 2"),
    ] {
        let mut picture: ImageBuffer<Rgb<f32>, _> = ImageBuffer::new(4, 3);
        picture.get_pixel_mut(1, 2).0[2] = bad;
        let bytes = encoded(&DynamicImage::ImageRgb32F(picture), ImageFormat::OpenExr);
        let message = message("a.exr", &bytes);
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn built_in_images() {
    for name in BUILT_IN_IMAGES {
        let source = ImageSource::named(Path::new(name));
        assert_eq!(source.to_string(), name);
        let image = load(&source).expect("an image");
        let (width, height) = dimensions(&source).expect("a size");
        assert_eq!((image.width, image.height), (width as usize, height as usize));
        assert!(matches!(image.texels, Texels::Srgb8(_)));
    }
    let file = ImageSource::named(Path::new("scenes/photo.png"));
    assert_eq!(file, ImageSource::File("scenes/photo.png".into()));
}

#[test]
fn what_is_no_image_is_named() {
    let missing = load(&ImageSource::File("/no/such/photo.png".into())).expect_err("missing");
    assert_eq!(missing.to_string(), "there is no image file /no/such/photo.png");
    let folder = load(&ImageSource::File("/".into())).expect_err("a folder");
    assert_eq!(folder.to_string(), "/ is a folder, not an image file");
    assert!(
        message("text.png", b"a text file called .png")
            .contains("is not an image that can be read")
    );
    assert!(message("empty.png", b"").contains("is empty"));
    let gif = message("a.png", b"GIF89a\x01\0\x01\0\0\0\0;");
    assert!(gif.contains("is a GIF image; only PNG, JPEG and EXR"), "{gif}");
    let file_in_file = with_file("a.png", b"x", |source| {
        let ImageSource::File(path) = source else { panic!("a file") };
        load(&ImageSource::File(path.join("b.png"))).expect_err("no folder").to_string()
    });
    assert!(file_in_file.contains("cannot read"), "{file_in_file}");
}

#[cfg(unix)]
#[test]
fn endless_devices_are_refused() {
    let zeros = load(&ImageSource::File("/dev/zero".into())).expect_err("no image");
    assert!(matches!(zeros.problem, LoadProblem::NotAnImage), "{zeros}");
    let null = load(&ImageSource::File("/dev/null".into())).expect_err("no image");
    assert!(matches!(null.problem, LoadProblem::Empty), "{null}");
}

#[test]
fn content_counts_more_than_the_name() {
    let bytes = encoded(&gradient(4, 4), ImageFormat::Jpeg);
    assert!(load_bytes("really-a-jpeg.png", &bytes).is_ok());
}

#[test]
fn cut_short_files_are_noticed() {
    let png = encoded(&gradient(40, 40), ImageFormat::Png);
    let jpeg = encoded(&gradient(40, 40), ImageFormat::Jpeg);
    let exr =
        encoded(&DynamicImage::ImageRgb32F(gradient(40, 40).into_rgb32f()), ImageFormat::OpenExr);
    for (name, bytes) in [("a.png", png), ("a.jpg", jpeg), ("a.exr", exr)] {
        assert!(load_bytes(name, &bytes).is_ok());
        // PNG may end at the last pixel: the end chunk carries nothing.
        let most = bytes.len() - if name == "a.png" { 17 } else { 1 };
        for length in (16..40).chain((40..most).step_by(17)).chain([most]) {
            let error = load_bytes(name, &bytes[..length]).expect_err("cut short");
            assert!(
                matches!(error.problem, LoadProblem::Damaged(_)),
                "{name} cut to {length} of {}: {error}",
                bytes.len()
            );
        }
    }
}

#[test]
fn scrambled_files_never_panic() {
    let png = encoded(&gradient(24, 24), ImageFormat::Png);
    let jpeg = oriented_jpeg(&gradient(24, 24), 6);
    let exr =
        encoded(&DynamicImage::ImageRgb32F(gradient(24, 24).into_rgb32f()), ImageFormat::OpenExr);
    for (name, bytes) in [("a.png", png), ("a.jpg", jpeg), ("a.exr", exr)] {
        for at in (4..bytes.len()).step_by(bytes.len() / 60 + 1) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x5A;
            // Not every damage can be seen; none may do harm.
            let _ = load_bytes(name, &damaged);
        }
    }
}

#[test]
fn huge_dimensions_are_refused_before_memory_is_taken() {
    let mut png = Vec::new();
    let mut writer = png::Encoder::new(&mut png, 60_000, 60_000).write_header().expect("a header");
    writer.write_chunk(png::chunk::IDAT, &[0x78, 0x9C, 0, 0]).expect("a chunk");
    drop(writer);
    assert!(message("a.png", &png).contains("is too large: at most 400 million pixels"));

    let mut jpeg = encoded(&gradient(16, 16), ImageFormat::Jpeg);
    let frame = jpeg.windows(2).position(|pair| pair == [0xFF, 0xC0]).expect("a frame header");
    jpeg[frame + 5..frame + 9].fill(0xFF);
    assert!(message("a.jpg", &jpeg).contains("is too large"), "{}", message("a.jpg", &jpeg));
}

#[test]
fn a_jpeg_without_rows_is_refused() {
    let mut jpeg = encoded(&gradient(16, 16), ImageFormat::Jpeg);
    let frame = jpeg.windows(2).position(|pair| pair == [0xFF, 0xC0]).expect("a frame header");
    jpeg[frame + 5..frame + 7].fill(0);
    let error = load_bytes("a.jpg", &jpeg).expect_err("no rows");
    assert!(matches!(error.problem, LoadProblem::Damaged(_) | LoadProblem::NoPixels(_)), "{error}");
}

#[test]
fn an_encoder_of_another_color_type_is_read_too() {
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new(&mut bytes)
        .write_image(&[90; 64], 8, 8, image::ExtendedColorType::L8)
        .expect("a gray JPEG");
    let image = load_bytes("a.jpg", &bytes).expect("an image");
    let Texels::Srgb8(codes) = image.texels else { panic!("8-bit codes") };
    assert!(codes.iter().all(|code| code.abs_diff(90) <= 2));
}
