//! Videos read back by ffmpeg, where it is installed.

use super::*;
use std::io::{self, Write};
use std::process::Command;

/// How many frames: in each the square is somewhere else.
const COUNT: usize = 8;

/// The output of a program that comes with ffmpeg.
fn output(program: &str, arguments: &[&str], path: &Path) -> Vec<u8> {
    let mut command = Command::new(program);
    command.args(["-loglevel", "error"]).args(arguments);
    if program == "ffmpeg" {
        command.arg("-i").arg(path).args(["-f", "rawvideo", "-pix_fmt", "rgb24", "-"]);
    } else {
        command.arg(path);
    }
    let output = command.output().expect(program);
    assert!(output.status.success(), "{output:?}");
    output.stdout
}

/// Makes a video, and compares what comes back with what went in.
fn check(name: &str, format: FilmFormat, codec: &str) {
    if format.check().is_err() {
        // Past the harness, which shows nothing of tests that pass.
        let _ =
            writeln!(io::stderr(), "SKIPPED: {name} is not tested, for ffmpeg is not installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    // To ffmpeg such names would mean something.
    let inner = folder.path().join("data:50%d");
    std::fs::create_dir(&inner).expect("a folder");
    let path = film(name, format, COUNT, &inner);
    let entries = "stream=codec_name,width,height,pix_fmt,color_space,color_transfer,avg_frame_rate,nb_read_frames\
                   :format=duration:format_tags=comment:stream_tags";
    let arguments = ["-count_frames", "-show_entries", entries, "-of", "json"];
    let said: serde_json::Value =
        serde_json::from_slice(&output("ffprobe", &arguments, &path)).expect("JSON");
    let stream = &said["streams"][0];
    assert_eq!(said["streams"].as_array().map(Vec::len), Some(1));
    for (key, value) in [
        ("codec_name", codec),
        ("pix_fmt", "yuv420p"),
        ("color_space", "bt709"),
        ("color_transfer", "iec61966-2-1"),
        ("avg_frame_rate", "30/1"),
        ("nb_read_frames", "8"),
    ] {
        assert_eq!(stream[key], value, "{key}: {said}");
    }
    // The sides are even.
    assert_eq!((&stream["width"], &stream["height"]), (&38.into(), &24.into()));
    let duration: f64 =
        said["format"]["duration"].as_str().expect("text").parse().expect("a number");
    assert!((duration - COUNT as f64 / 30.0).abs() < 1.5e-3, "{duration}");
    let tags = said["format"]["tags"].as_object().expect("tags");
    let (_, comment) =
        tags.iter().find(|(key, _)| key.eq_ignore_ascii_case("comment")).expect("a comment");
    assert_eq!(comment, SCENE);
    let bytes = output("ffmpeg", &[], &path);
    let frames: Vec<(RgbImage, u32)> = bytes
        .chunks_exact(38 * 24 * 3)
        .map(|frame| RgbImage::from_raw(38, 24, frame.to_vec()).expect("a frame"))
        .map(|frame| (image::imageops::crop_imm(&frame, 0, 0, 37, 24).to_image(), 0))
        .collect();
    assert_eq!(frames.len(), COUNT);
    // Half the colors are gone; each frame is nearest to the one it was made of.
    let far = difference(&frames);
    assert!(far < 8.0, "{far}");
    for (number, frame) in frames.iter().enumerate() {
        let apart = |other: usize| {
            let other = picture(other as u32);
            frame.0.iter().zip(other.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>()
        };
        assert_eq!((0..COUNT).min_by_key(|other| apart(*other)), Some(number));
    }
    let left = std::fs::read_dir(&inner).expect("a folder").count();
    assert_eq!(left, 2, "the film and its frames");
}

#[test]
fn mp4_has_every_frame_and_lasts_as_long() {
    check("a.mp4", FilmFormat::Mp4, "h264");
}

#[test]
fn webm_has_every_frame_and_lasts_as_long() {
    check("a.webm", FilmFormat::WebM, "vp9");
}
