//! Films read back by decoders that know nothing of their writers.

use super::*;
use image::{AnimationDecoder, Rgb};
use std::fs::File;
use std::io::BufReader;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering;

mod video;

/// The scene that the films say they show.
const SCENE: &str = "[camera] # <&>\nsamples = 4 ; a\\b\n";

/// Frames in which a bright square walks over a ramp.
fn frames(folder: &Path, count: usize) -> FrameFolder {
    let frames = FrameFolder::new(&folder.join("frames"), count).expect("a folder");
    for number in 0..count {
        output::write_png(&picture(number as u32), &[], &frames.file(number)).expect("written");
    }
    frames
}

fn picture(number: u32) -> RgbImage {
    RgbImage::from_fn(37, 24, |x, y| {
        if (5 * number..5 * number + 6).contains(&x) && (8..14).contains(&y) {
            Rgb([250, 40, 10])
        } else {
            Rgb([6 * x as u8, 9 * y as u8, 90])
        }
    })
}

fn film(name: &str, format: FilmFormat, count: usize, folder: &Path) -> PathBuf {
    let frames = frames(folder, count);
    let done = AtomicUsize::new(0);
    let metadata = [("scene".to_owned(), SCENE.to_owned())];
    let path = folder.join(name);
    assert_eq!(FilmFormat::of(&path), Ok(format));
    let film = Film {
        frames: &frames,
        path: &path,
        rate: 30,
        metadata: &metadata,
        frame_done: &|| {
            done.fetch_add(1, Ordering::Relaxed);
        },
        stop: &AtomicBool::new(false),
    };
    film.write(format).expect("a film");
    assert_eq!(done.into_inner(), count);
    path
}

/// The frames of a film and how long each stays, ms.
fn read(decoder: impl for<'a> AnimationDecoder<'a>) -> Vec<(RgbImage, u32)> {
    let frames = decoder.into_frames().collect_frames().expect("frames");
    let frame = |frame: image::Frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        (image::DynamicImage::from(frame.into_buffer()).into_rgb8(), numerator / denominator)
    };
    frames.into_iter().map(frame).collect()
}

/// Largest mean difference of a color of the frames from what they should be, in codes.
fn difference(frames: &[(RgbImage, u32)]) -> f64 {
    let mean = |(number, frame): (usize, &(RgbImage, u32))| {
        let wanted = picture(number as u32);
        let sum: u32 =
            frame.0.iter().zip(wanted.iter()).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
        f64::from(sum) / wanted.len() as f64
    };
    frames.iter().enumerate().map(mean).fold(0.0, f64::max)
}

fn open(path: &Path) -> BufReader<File> {
    BufReader::new(File::open(path).expect("a file"))
}

#[test]
fn frames_keep_the_rate() {
    for rate in [1, 7, 24, 25, 30, 60, 100] {
        let all: u32 = (0..600).map(|number| stay(number, rate, 100.0)).sum();
        assert!((f64::from(all) - 60_000.0 / f64::from(rate)).abs() <= 0.5, "{rate}: {all}");
    }
}

#[test]
fn animated_png_is_exact() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = film("a.apng", FilmFormat::Apng, 4, folder.path());
    let decoder = image::codecs::png::PngDecoder::new(open(&path)).expect("a PNG");
    let frames = read(decoder.apng().expect("an animation"));
    assert_eq!((frames.len(), difference(&frames)), (4, 0.0));
    assert!(frames.iter().all(|(_, ms)| *ms == 33));
    let bytes = std::fs::read(&path).expect("bytes");
    assert!(String::from_utf8_lossy(&bytes).contains("[camera] # <&>"));
}

#[test]
fn animated_webp_is_exact() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = film("a.webp", FilmFormat::WebP, 4, folder.path());
    let mut decoder = image_webp::WebPDecoder::new(open(&path)).expect("a WebP");
    assert_eq!((decoder.is_animated(), decoder.num_frames()), (true, 4));
    assert_eq!((decoder.dimensions(), decoder.loop_duration()), ((37, 24), 133));
    let mut frames = Vec::new();
    for _ in 0..4 {
        let mut bytes = vec![0; decoder.output_buffer_size().expect("a size")];
        let ms = decoder.read_frame(&mut bytes).expect("a frame");
        let bytes = if decoder.has_alpha() {
            bytes.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect()
        } else {
            bytes
        };
        frames.push((RgbImage::from_raw(37, 24, bytes).expect("an image"), ms));
    }
    assert_eq!(difference(&frames), 0.0);
    let xmp = decoder.xmp_metadata().expect("readable").expect("there");
    let text = String::from_utf8(xmp).expect("text");
    let document = roxmltree::Document::parse(&text).expect("XML");
    let said: String = document.descendants().filter_map(|node| node.text()).collect();
    assert!(said.contains("scene: [camera] # <&>"), "{said}");
}

#[test]
fn animated_gif_is_near() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = film("a.gif", FilmFormat::Gif, 6, folder.path());
    let frames = read(image::codecs::gif::GifDecoder::new(open(&path)).expect("a GIF"));
    assert_eq!(frames.len(), 6);
    assert!(difference(&frames) < 8.0, "{}", difference(&frames));
    assert_eq!(frames.iter().map(|(_, ms)| ms).sum::<u32>(), 200);
    let bytes = std::fs::read(&path).expect("bytes");
    assert!(String::from_utf8_lossy(&bytes).contains("scene: [camera] # <&>"));
}

#[test]
fn stopped_and_broken_films_leave_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = frames(folder.path(), 3);
    let stop = AtomicBool::new(true);
    let (path, frame_done) = (Path::new(""), &|| {});
    let film = Film { frames: &frames, path, rate: 25, metadata: &[], frame_done, stop: &stop };
    for (name, format) in
        [("a.gif", FilmFormat::Gif), ("a.png", FilmFormat::Apng), ("a.webp", FilmFormat::WebP)]
    {
        let path = folder.path().join(name);
        let stopped = Film { path: &path, ..film }.write(format);
        assert!(matches!(stopped, Err(FilmError::Render(RenderError::Stopped(_)))));
        assert!(!path.exists());
    }
    output::write_png(&RgbImage::new(5, 5), &[], &frames.file(2)).expect("written");
    stop.store(false, Ordering::Relaxed);
    let path = folder.path().join("a.gif");
    let error = Film { path: &path, ..film }.write(FilmFormat::Gif).expect_err("two sizes");
    assert!(error.to_string().contains("5 x 5 pixels, the first one 37 x 24"), "{error}");
    assert!(!path.exists());
}

#[test]
fn endings_choose_the_format() {
    let of = |name: &str| FilmFormat::of(Path::new(name));
    assert_eq!(of("a.MP4"), Ok(FilmFormat::Mp4));
    assert_eq!(of("b/a.webm"), Ok(FilmFormat::WebM));
    assert_eq!(of("turning"), Ok(FilmFormat::Frames));
    assert!(of("a.avi").is_err_and(|message| message.contains(".webm")));
}
