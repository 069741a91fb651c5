//! MP4 and WebM, by the program `ffmpeg` where it is installed.

use super::{Film, FilmError};
use cloakroom::output::{self, OutputError, check_writable};
use cloakroom::render::RenderError;
use cloakroom::trace::Stopped;
use std::fmt::Display;
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How a video is coded: H.264 in MP4.
pub(super) const H264: &[&str] =
    &["-c:v", "libx264", "-preset", "slow", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"];

/// VP9 in WebM.
pub(super) const VP9: &[&str] =
    &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"];

/// The frames in their folder, as `ffmpeg` takes them: see [`super::FrameFolder::file`].
const FRAMES: &str = "frame-%06d.png";

/// How often `ffmpeg` is looked after.
const LOOK: Duration = Duration::from_millis(50);

/// Whether `ffmpeg` can be run.
pub(super) fn ffmpeg_is_there() -> bool {
    let mut command = Command::new("ffmpeg");
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Lets `ffmpeg` make a video of frames, into a temporary file that is renamed at the end.
pub(super) fn write(film: &Film<'_>, codec: &[&str]) -> Result<(), FilmError> {
    let path = film.path;
    check_writable(path)?;
    for frame in film.checked(film.size("video", 16_384)?) {
        frame?;
        film.done()?;
    }
    let unwritable = |error: io::Error| {
        let (path, reason) = (path.to_owned(), error.to_string());
        FilmError::Output(OutputError::Write { path, reason })
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let part = tempfile::Builder::new()
        .prefix(".cloakroom-")
        .tempdir_in(folder.unwrap_or(Path::new(".")))
        .map_err(unwritable)?;
    // It works in the folder of the frames.
    let inside = std::path::absolute(part.path()).map_err(unwritable)?;
    let (file, metadata) = (inside.join("film"), inside.join("metadata"));
    std::fs::write(&metadata, ffmetadata(film.metadata)).map_err(unwritable)?;
    let failed = |reason: &dyn Display| FilmError::failed("ffmpeg could not make", path, reason);
    let command = command(film, [&metadata, &file], codec).spawn();
    let mut child = command.map_err(|error| match error.kind() {
        ErrorKind::NotFound => FilmError::NoFfmpeg,
        _ => failed(&error),
    })?;
    let done = wait(&mut child, film.stop);
    let said = child.stderr.take().map(|mut stderr| {
        let mut said = Vec::new();
        // What cannot be read is not said.
        let _ = stderr.read_to_end(&mut said);
        String::from_utf8_lossy(&said).into_owned()
    });
    match done.map_err(|error| failed(&error))? {
        None => Err(RenderError::from(Stopped).into()),
        Some(true) => Ok(output::write_whole(path, |out| {
            io::copy(&mut std::fs::File::open(&file)?, out).map(drop)
        })?),
        Some(false) => {
            let said = said.unwrap_or_default();
            Err(failed(&said.lines().last().unwrap_or("it has failed")))
        }
    }
}

/// Waits for the end, and says whether it has succeeded; or ends it and says nothing.
fn wait(child: &mut Child, stop: &AtomicBool) -> io::Result<Option<bool>> {
    loop {
        let ended = child.try_wait()?;
        // Ctrl-C in a terminal ends both.
        if stop.load(Ordering::Relaxed) {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
            return Ok(None);
        }
        if let Some(status) = ended {
            return Ok(Some(status.success()));
        }
        std::thread::sleep(LOOK);
    }
}

/// The metadata of a film in a form that `ffmpeg` reads, of any length; the scene is the film's
/// comment.
fn ffmetadata(metadata: &[(String, String)]) -> String {
    let mut text = ";FFMETADATA1\n".to_owned();
    for (key, value) in metadata {
        let key = if key == "scene" { "comment" } else { key };
        for (part, end) in [(key, '='), (value, '\n')] {
            for character in part.chars() {
                if "=;#\\\n".contains(character) {
                    text.push('\\');
                }
                text.push(character);
            }
            text.push(end);
        }
    }
    text
}

fn command(film: &Film<'_>, [metadata, file]: [&Path; 2], codec: &[&str]) -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"]);
    // In their folder: a `%` or a `:` in its name would mean something.
    command.current_dir(&film.frames.folder);
    command.args(["-framerate", &film.rate.to_string(), "-start_number", "0", "-i"]);
    command.args([FRAMES, "-f", "ffmetadata", "-i"]).arg(metadata);
    command.args(["-map", "0:v", "-map_metadata", "1"]);
    command.args(["-frames:v", &film.frames.count.to_string()]);
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
    command.args(codec).arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}
