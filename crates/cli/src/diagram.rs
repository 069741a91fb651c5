//! `cloakroom diagram`: ray diagrams, pulses on their way through them, and settings.

use crate::animate::Written;
use crate::arguments::{DiagramArguments, PulseTimes};
use crate::files::{check_outputs, formats, write_each};
use crate::interruption::{self, STOP};
use crate::progress::supervised;
use crate::report::{Failure, Result, all, say};
use crate::scene;
use cloakroom::render::{Delay, Gate, metadata};
use cloakroom::scene_file::Loaded;
use cloakroom_figures::film::{FilmFormat, FrameFolder, pulse_frames};
use cloakroom_figures::{
    DiagramError, DiagramSettings, Drawing, DrawingFormat, Pulse, RayDiagram, Source,
};
use std::path::Path;

/// Frames of a film whose times are not given, about.
const FRAMES: usize = 100;

/// How exact the clock of a single drawing is, ns.
const CLOCK: f64 = 1e-3;

/// Draws a scene and writes every file asked for.
pub fn run(arguments: &DiagramArguments) -> Result<()> {
    match arguments.pulse {
        None => draw(arguments, None),
        Some(PulseTimes::At(time)) => {
            draw(arguments, Some(Pulse { time, delay: arguments.delay.into(), step: CLOCK }))
        }
        Some(PulseTimes::Seen) => film(arguments, None),
        Some(PulseTimes::Bins(gate)) => film(arguments, Some(gate)),
    }
}

/// Draws it once.
fn draw(arguments: &DiagramArguments, pulse: Option<Pulse>) -> Result<()> {
    let formats = formats(&arguments.outputs, DrawingFormat::of).map_err(|failure| {
        match (failure, arguments.outputs.iter().any(|path| FilmFormat::of(path).is_ok())) {
            (Failure::Failed(message), true) => Failure::Failed(format!(
                "{message}; for a film, give --pulse without a time, or times as in -0.5..1.5:0.02"
            )),
            (failure, _) => failure,
        }
    })?;
    let loaded = scene::load(&arguments.scene, &[])?;
    check_outputs(&arguments.outputs, &scene::inputs(&arguments.scene, &loaded))?;
    let _busy = interruption::busy();
    let (drawing, title): (Drawing, _) = if arguments.setting {
        let setting = cloakroom_figures::setting(&loaded.scene, arguments.size);
        (setting.map_err(|error| scene::located(&loaded, &error))?.drawing, "Setting")
    } else {
        let diagram = diagram(arguments, &loaded)?;
        if let Some((z, beside)) = diagram.beside_rays().filter(|(_, beside)| !beside.is_empty()) {
            let names = beside.iter().map(|number| loaded.scene.device_name(*number).to_string());
            let names = names.collect::<Vec<_>>().join(", ");
            say(&format!(
                "note: the rays start in z = {z} cm; beside that plane is, though drawn: {names} (--z moves it, show = \
                 \"empty\" takes devices away)"
            ));
        }
        (diagram.draw(pulse.as_ref()), "Ray diagram")
    };
    let mut metadata = metadata(&loaded.scene);
    if let Some(Pulse { time, delay, .. }) = pulse {
        metadata.extend(words(&time.to_string(), delay));
    }
    write_each(formats, |path, format| {
        Ok(drawing.write(format, title, &metadata, arguments.size, path)?)
    })
}

/// Makes films of a pulse on its way: at the times of a gate, or while it is seen.
fn film(arguments: &DiagramArguments, gate: Option<Gate>) -> Result<()> {
    let format = |path| -> Result<(&Path, FilmFormat)> {
        let format = FilmFormat::of(path).map_err(|message| {
            Failure::Failed(format!(
                "{message}; for a drawing, give --pulse a single time, as in 1.2"
            ))
        })?;
        format.check()?;
        Ok((path, format))
    };
    let outputs = arguments.outputs.iter().map(|path| format(path));
    let formats: Vec<(&Path, FilmFormat)> = outputs.collect::<Result<_>>()?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let files = arguments.outputs.iter().zip(&formats);
    let files = files.filter(|(_, (_, format))| *format != FilmFormat::Frames);
    check_outputs(files.map(|(path, _)| path), &scene::inputs(&arguments.scene, &loaded))?;
    let _busy = interruption::busy();
    let diagram = diagram(arguments, &loaded)?;
    let delay = arguments.delay.into();
    let gate = match gate {
        Some(gate) => gate,
        None => {
            let times = diagram.seen(delay).ok_or_else(|| {
                let message = "the pulse is never seen: no ray comes into what is shown, or, behind media \
                               that absorb, nobody knows when; give --pulse START..END:STEP in ns, or --delay phase";
                Failure::Failed(message.to_owned())
            })?;
            let gate = Gate::around(times, FRAMES);
            say(&format!("--pulse={gate}"));
            gate
        }
    };
    let mut metadata = metadata(&loaded.scene);
    metadata.extend(words(&gate.to_string(), delay));
    all(formats.into_iter().map(|(path, format)| {
        let frames = FrameFolder::of_film(path, format, gate.bins())?;
        supervised(gate.bins() as u64, "frames", |_, supervision| {
            pulse_frames(&diagram, (&gate, delay), arguments.size, &frames, &metadata, supervision)
        })?;
        if format == FilmFormat::Frames {
            return Ok(());
        }
        let (rate, keep_frames) = (arguments.fps, arguments.keep_frames);
        Written { path, format, rate, metadata: &metadata, keep_frames }.write(&frames)
    }))
}

/// Follows the rays of a diagram.
fn diagram(arguments: &DiagramArguments, loaded: &Loaded) -> Result<RayDiagram> {
    let diagram = RayDiagram::new(&loaded.scene, &settings(arguments), &STOP);
    diagram.map_err(|error| match error {
        DiagramError::Scene(error) => scene::located(loaded, &error),
        error => error.into(),
    })
}

/// What a file carries beside what a picture does.
fn words(times: &str, delay: Delay) -> [(String, String); 2] {
    [("pulse", times), ("delay", delay.name())].map(|(key, word)| (key.to_owned(), word.to_owned()))
}

fn settings(arguments: &DiagramArguments) -> DiagramSettings {
    let source = match (arguments.point, arguments.camera) {
        (Some(point), _) => Source::Point(point.into()),
        (None, true) => Source::Camera,
        (None, false) => Source::Parallel { degrees: arguments.parallel.unwrap_or(0.0) },
    };
    DiagramSettings {
        source,
        rays: arguments.rays,
        layers: arguments.layers,
        z: arguments.z,
        width: arguments.width,
        window: arguments.window.map(|[x0, y0, x1, y1]| [[x0, y0].into(), [x1, y1].into()]),
        polarization: match arguments.polarization.as_str() {
            "horizontal" => [1.0, 0.0],
            "vertical" => [0.0, 1.0],
            _ => [0.5, 0.5],
        },
        wavefronts: arguments.wavefronts,
        min_power: arguments.min_power,
        space: arguments.space,
        size: arguments.size,
    }
}
