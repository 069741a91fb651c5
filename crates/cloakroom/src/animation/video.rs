//! MP4 and WebM, by the program `ffmpeg` where it is installed.

use super::{FilmError, FilmSettings, FrameFolder, Size};
use crate::output::{OutputError, check_writable};
use crate::render::RenderError;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering;
use std::time::Duration;

/// How a video is coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    /// H.264 in MP4.
    H264,
    /// VP9 in WebM.
    Vp9,
}

/// How often `ffmpeg` is looked after.
const LOOK: Duration = Duration::from_millis(50);

/// Whether `ffmpeg` can be run.
pub(super) fn ffmpeg_is_there() -> bool {
    let mut command = Command::new("ffmpeg");
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Lets `ffmpeg` make a video of frames, into a temporary file that is renamed at the end.
pub(super) fn write(
    frames: &FrameFolder,
    path: &Path,
    codec: Codec,
    settings: &FilmSettings<'_>,
) -> Result<(), FilmError> {
    check_writable(path)?;
    let size = Size::of(frames, "video", 16_384)?;
    for frame in size.checked(frames) {
        frame?;
        settings.done()?;
    }
    let unwritable = |error: std::io::Error| {
        let (path, reason) = (path.to_owned(), error.to_string());
        FilmError::Output(OutputError::Write { path, reason })
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let part = tempfile::Builder::new()
        .prefix(".cloakroom-")
        .tempdir_in(folder.unwrap_or(Path::new(".")))
        .map_err(unwritable)?;
    let file = part.path().join("film");
    let mut child = command(frames, &file, codec, settings).spawn().map_err(|error| {
        if error.kind() == std::io::ErrorKind::NotFound {
            FilmError::NoFfmpeg
        } else {
            FilmError::Ffmpeg { path: path.to_owned(), reason: error.to_string() }
        }
    })?;
    let done = wait(&mut child, settings);
    let said = child.stderr.take().map(|mut stderr| {
        let mut said = Vec::new();
        // What cannot be read is not said.
        let _ = stderr.read_to_end(&mut said);
        String::from_utf8_lossy(&said).into_owned()
    });
    if !done? {
        let said = said.unwrap_or_default();
        let reason = said.lines().last().unwrap_or("it has failed").to_owned();
        return Err(FilmError::Ffmpeg { path: path.to_owned(), reason });
    }
    std::fs::rename(&file, path).map_err(unwritable)
}

/// Waits for the end, or ends it; whether it has succeeded.
fn wait(child: &mut Child, settings: &FilmSettings<'_>) -> Result<bool, FilmError> {
    let failed = |error: std::io::Error| FilmError::Ffmpeg {
        path: "a video".into(),
        reason: error.to_string(),
    };
    loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            return Ok(status.success());
        }
        if settings.stop.load(Ordering::Relaxed) {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
            return Err(RenderError::Stopped.into());
        }
        std::thread::sleep(LOOK);
    }
}

fn command(
    frames: &FrameFolder,
    file: &Path,
    codec: Codec,
    settings: &FilmSettings<'_>,
) -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"]);
    command.args(["-framerate", &settings.rate.to_string(), "-start_number", "0", "-i"]);
    command.arg(frames.pattern());
    command.args(["-frames:v", &frames.count().to_string()]);
    // sRGB to BT.709, told in the file; colors are halved in size, so sides must be even.
    command.args([
        "-vf",
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
        "-colorspace",
        "bt709",
        "-color_primaries",
        "bt709",
        "-color_trc",
        "iec61966-2-1",
    ]);
    for (key, text) in settings.metadata {
        let key = if key == "scene" { "comment" } else { key };
        command.arg("-metadata").arg(format!("{key}={text}"));
    }
    match codec {
        Codec::H264 => {
            command.args(["-c:v", "libx264", "-preset", "slow", "-crf", "18"]);
            command.args(["-movflags", "+faststart", "-f", "mp4"]);
        }
        Codec::Vp9 => {
            command.args(["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1"]);
            command.args(["-f", "webm"]);
        }
    }
    command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}
