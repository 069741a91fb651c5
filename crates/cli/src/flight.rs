//! `cloakroom flight`: what a camera with a time gate sees when the photograph flashes.

use crate::animate::Written;
use crate::arguments::FlightArguments;
use crate::files::check_outputs;
use crate::interruption;
use crate::progress::supervised;
use crate::render::warn_of_cut_branches;
use crate::report::{Failure, Result, all, say};
use crate::scene;
use cloakroom::output::{self, FlightOrder, FlightStore};
use cloakroom::render::{self, Arrivals, FlightSettings, Gate, Images, PreparedScene};
use cloakroom_figures::film::{FilmFormat, FlightFilm, FrameFolder, flight_frames};
use std::path::Path;

/// Bins of a gate that is not given, about.
const BINS: usize = 120;

/// What a file of light in flight is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FlightFormat {
    Arrays,
    Film(FilmFormat),
}

/// Looks at light in flight and writes every file asked for.
pub fn run(arguments: &FlightArguments) -> Result<()> {
    let outputs = arguments.outputs.iter();
    let formats = outputs.map(|path| format(path)).collect::<Result<Vec<_>>>()?;
    let text = scene::text(&arguments.scene.scene)?;
    let overrides = scene::overrides(&text, &arguments.scene, &arguments.picture)?;
    let loaded = scene::load_with(&arguments.scene, &text, &overrides)?;
    scene::use_threads(&arguments.threads)?;
    let prepared = scene::prepared(&loaded, &mut Images::default())?;
    let inputs = scene::inputs(&arguments.scene, &loaded);
    let files = arguments.outputs.iter().zip(&formats);
    let files = files.filter(|(_, format)| **format != FlightFormat::Film(FilmFormat::Frames));
    check_outputs(files.map(|(path, _)| path), &inputs)?;
    let folder = arguments.outputs[0].parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let _busy = interruption::busy();
    let settings = settings(arguments, &prepared)?;
    let store = FlightStore::new(folder, loaded.scene.camera.resolution, settings.gate)?;
    let all_formats = arguments.outputs.iter().zip(formats);
    let kinds = all_formats.map(|(path, format)| {
        Ok((
            path.as_path(),
            match format {
                FlightFormat::Arrays => None,
                FlightFormat::Film(film) => {
                    Some((film, FrameFolder::of_film(path, film, settings.gate.bins())?))
                }
            },
        ))
    });
    let outputs: Vec<(&Path, Option<(FilmFormat, FrameFolder)>)> = kinds.collect::<Result<_>>()?;
    let stats = supervised(render::flight_steps(&prepared), "rendering", |_, supervision| {
        render::flight(&prepared, &settings, supervision, |tile| {
            store.put(&tile).map_err(|error| {
                let folder = folder.display();
                Failure::Failed(format!("cannot keep the light in the folder {folder}: {error}"))
            })
        })
    });
    warn_of_cut_branches(&stats?);
    tell_what_is_beside(&store, &settings.gate);
    let mut metadata = prepared.metadata();
    metadata.extend(words(&settings));
    all(outputs.into_iter().map(|(path, of_film)| match of_film {
        None => {
            let order =
                if arguments.time_last { FlightOrder::TimeLast } else { FlightOrder::TimeFirst };
            Ok(store.write_npz(path, order, &metadata)?)
        }
        Some((format, frames)) => film(arguments, &store, (path, format), &frames, &metadata),
    }))
}

fn format(path: &Path) -> Result<FlightFormat> {
    if output::ending(path).as_deref() == Some("npz") && !path.is_dir() {
        return Ok(FlightFormat::Arrays);
    }
    let format = FilmFormat::of(path)
        .map_err(|message| Failure::Failed(message.replace("use .gif", "use .npz, .gif")))?;
    format.check()?;
    Ok(FlightFormat::Film(format))
}

/// What is looked at: the gate is that which is given, or holds what arrives.
fn settings(arguments: &FlightArguments, prepared: &PreparedScene<'_>) -> Result<FlightSettings> {
    let arrivals = Arrivals { delay: arguments.delay.into(), flash: arguments.flash };
    let width = arguments.pulse;
    let gate = match arguments.gate {
        Some(gate) => gate,
        None => {
            let times = render::arrival_times(prepared, &arrivals).ok_or_else(|| {
                let message = "no light of the photograph arrives at any time that is known; give --gate \
                               START..END:STEP in ns, or, behind media that absorb, --delay phase";
                Failure::Failed(message.to_owned())
            })?;
            let gate = Gate::around([times[0] - width, times[1] + width], BINS);
            say(&format!("--gate {gate}"));
            gate
        }
    };
    Ok(FlightSettings { gate, width, arrivals })
}

/// Says how much light no bin has.
fn tell_what_is_beside(store: &FlightStore, gate: &Gate) {
    let words = [
        "comes before",
        "comes after",
        "comes nobody knows when, behind media that absorb, and not in",
    ];
    for (share, words) in store.shares_beside().into_iter().zip(words) {
        if share > 5e-4 {
            say(&format!("note: {:.1} % of the light {words} the gate {gate}", 100.0 * share));
        }
    }
}

/// What a file carries beside what a picture does.
fn words(settings: &FlightSettings) -> Vec<(String, String)> {
    let FlightSettings { gate, width, arrivals } = settings;
    [
        ("gate", gate.to_string()),
        ("pulse", width.to_string()),
        ("delay", arrivals.delay.name().to_owned()),
        ("flash", arrivals.flash.to_string()),
    ]
    .map(|(key, words)| (key.to_owned(), words))
    .to_vec()
}

/// Makes a film.
fn film(
    arguments: &FlightArguments,
    store: &FlightStore,
    (path, format): (&Path, FilmFormat),
    frames: &FrameFolder,
    metadata: &[(String, String)],
) -> Result<()> {
    let bins = store.gate().bins();
    // As bright as in the picture, where a pulse arrives in the middle of a bin.
    let as_in_picture = match arguments.accumulate {
        true => 1.0,
        false => 1.0 / store.gate().largest_share(arguments.pulse),
    };
    let look = FlightFilm {
        exposure: arguments.exposure * as_in_picture,
        accumulated: arguments.accumulate,
    };
    supervised(bins as u64, "frames", |_, supervision| {
        flight_frames(store, &look, frames, metadata, supervision)
    })?;
    if format == FilmFormat::Frames {
        return Ok(());
    }
    let (rate, keep_frames) = (arguments.fps, arguments.keep_frames);
    Written { path, format, rate, metadata, keep_frames }.write(frames)
}
