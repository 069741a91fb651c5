//! The thread that renders for one page: coarsely at once, then in full, then with more samples. What it sends at each
//! number of samples is the picture that `cloakroom render` makes with that number.

use crate::client::{Client, Outbox};
use crate::cross_section::cross_section;
use crate::figures::{FiguresError, figures, resized};
use crate::frame::{Caption, Scale, encode};
use crate::protocol::{Beside, Look, error};
use crate::scenes::shown_as;
use cloakroom::device::Show;
use cloakroom::illustration::{IllustrationError, Quantity, ScalarMap};
use cloakroom::measure::{empty, ideal};
use cloakroom::output::{OutputError, RgbImage, to_srgb};
use cloakroom::render::{Images, RenderError, Studio, StudioError, Supervision, Wanted, render};
use cloakroom::scene::Scene;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a coarse picture should take.
const COARSE: Duration = Duration::from_millis(36);

/// A full picture of one sample that takes longer than this is preceded by a coarse one.
const PATIENCE: Duration = Duration::from_millis(120);

/// What coarse pictures may leave out: branches weaker than this, and places less exact than this, cm.
const COARSE_POWER: f64 = 1e-2;
const COARSE_TOLERANCE: f64 = 1e-4;

/// By how much coarse pictures are smaller, each way.
const DIVISORS: [f64; 8] = [1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 6.0];

/// How often progress is told.
const PROGRESS: Duration = Duration::from_millis(150);

/// A look, and the flag that cancels it.
#[derive(Debug)]
pub(crate) struct Wish {
    pub look: Look,
    pub stop: Arc<AtomicBool>,
}

/// What a page shows now, for rays to be sent through.
#[derive(Debug)]
pub(crate) struct Shown {
    /// The scene in the size of the full picture.
    pub scene: Scene,
    /// Its images.
    pub images: Images,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
enum PaintError {
    /// The scene makes no sense.
    #[error("{0}")]
    Scene(String),
    /// It cannot be built.
    #[error(transparent)]
    Studio(#[from] StudioError),
    /// It cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// It cannot be measured.
    #[error(transparent)]
    Figures(#[from] FiguresError),
    /// Its map cannot be drawn.
    #[error(transparent)]
    Map(#[from] IllustrationError),
    /// It has no image.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The page has gone.
    #[error("the page has gone")]
    Gone,
}

impl PaintError {
    /// Whether newer wishes, or the end of the page, are why.
    fn is_stop(&self) -> bool {
        use RenderError::Stopped;
        matches!(
            self,
            Self::Render(Stopped) | Self::Figures(FiguresError::Render(Stopped)) | Self::Gone
        )
    }

    /// The key of the scene that it is about.
    fn key(&self) -> Option<String> {
        match self {
            Self::Studio(error) => Some(error.key()),
            _ => None,
        }
    }
}

/// Paints what a page wishes, until it is gone.
pub(crate) fn paint(client: &Client, outbox: &Outbox) {
    let mut painter = Painter {
        client,
        outbox,
        images: client.images(),
        uploaded: None,
        nanoseconds_a_pixel: None,
        section: Value::Null,
    };
    while let Some(wish) = client.looks.take() {
        let id = wish.look.id;
        let painted = catch_unwind(AssertUnwindSafe(|| painter.paint(&wish)));
        let said = match painted {
            Ok(Ok(())) => Ok(()),
            Ok(Err(failure)) if failure.is_stop() => Ok(()),
            Ok(Err(failure)) => {
                let mut message = error(Some(id), &failure.to_string());
                message["error"]["key"] = json!(failure.key());
                outbox.say(&message)
            }
            Err(_) => outbox.say(&error(
                Some(id),
                "this scene could not be rendered: a mistake in the program",
            )),
        };
        if said.is_err() {
            return;
        }
    }
}

struct Painter<'a> {
    client: &'a Client,
    outbox: &'a Outbox,
    images: Images,
    /// The images of the page's own photograph, and its number.
    uploaded: Option<(u64, Images)>,
    /// What a pixel of the last coarse picture took, of all its views.
    nanoseconds_a_pixel: Option<f64>,
    /// The cross-section that was sent last.
    section: Value,
}

/// One picture on the way to the finished one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pass {
    size: [u32; 2],
    samples: u32,
    coarse: bool,
    finished: bool,
}

impl Painter<'_> {
    fn paint(&mut self, wish: &Wish) -> Result<(), PaintError> {
        let look = &wish.look;
        let uploaded = self.client.uploaded();
        let source = uploaded.as_ref().map(|uploaded| &uploaded.source);
        let opened = &self.client.server.opened;
        let scene = opened.read(&look.scene, source).map_err(PaintError::Scene)?.scene;
        let mut images = match &uploaded {
            Some(uploaded) if uploaded.source == scene.photograph.image => {
                match self.uploaded.take().filter(|(number, _)| *number == uploaded.number) {
                    Some((_, images)) => images,
                    None => uploaded.images.clone(),
                }
            }
            _ => std::mem::take(&mut self.images),
        };
        let painted = self.paint_scene(wish, &scene, &mut images);
        match uploaded {
            Some(uploaded) if uploaded.source == scene.photograph.image => {
                self.uploaded = Some((uploaded.number, images));
            }
            _ => self.images = images,
        }
        painted
    }

    fn paint_scene(
        &mut self,
        wish: &Wish,
        scene: &Scene,
        images: &mut Images,
    ) -> Result<(), PaintError> {
        let look = &wish.look;
        let full = resized(scene, look.size, 1);
        {
            let studio = Studio::with_images(&full, images)?;
            let section = cross_section(&full, &studio);
            if section != self.section {
                self.say(&json!({ "section": section }))?;
                self.section = section;
            }
        }
        self.client.show(Shown { scene: full, images: images.clone() });
        let beside = match look.beside {
            Beside::Nothing => None,
            Beside::Bare => shown_as(scene, Show::Bare).map(|scene| ("bare", scene)),
            Beside::Empty => Some(("empty", empty(scene))),
            Beside::Mirror => Some(("mirror", ideal(scene))),
        };
        let views: Vec<(&'static str, &Scene)> = [("scene", scene)]
            .into_iter()
            .chain(beside.as_ref().map(|(name, scene)| (*name, scene)))
            .collect();
        for pass in passes(look, self.nanoseconds_a_pixel) {
            let start = Instant::now();
            for (number, (name, scene)) in views.iter().enumerate() {
                let last = number + 1 == views.len();
                self.picture(wish, (name, last), scene, pass, images)?;
            }
            let pixels = f64::from(pass.size[0]) * f64::from(pass.size[1]);
            if pass.samples == 1 {
                self.nanoseconds_a_pixel = Some(start.elapsed().as_nanos() as f64 / pixels);
            }
            if !pass.coarse && pass.samples == 1 {
                let mut numbers = figures(scene, images, &wish.stop)?;
                numbers["id"] = json!(look.id);
                self.say(&json!({ "numbers": numbers }))?;
            }
        }
        Ok(())
    }

    /// Renders and sends one picture: of a view, which may be the last of its pass.
    fn picture(
        &self,
        wish: &Wish,
        (view, last): (&'static str, bool),
        scene: &Scene,
        pass: Pass,
        images: &mut Images,
    ) -> Result<(), PaintError> {
        let mut scene = resized(scene, pass.size, pass.samples);
        if pass.coarse {
            scene.trace.min_power = scene.trace.min_power.max(COARSE_POWER);
            scene.trace.tolerance = scene.trace.tolerance.max(COARSE_TOLERANCE);
        }
        let start = Instant::now();
        let studio = Studio::with_images(&scene, images)?;
        let progress = Progress::new(self.outbox, wish.look.id, pass.samples, studio.rows());
        let rows_done = |rows| progress.add(rows);
        let quiet = |_| {};
        let supervision = Supervision {
            rows_done: if pass.coarse { &quiet } else { &rows_done },
            stop: &wish.stop,
        };
        let wanted = if scene.picture.map.is_some() { Wanted::Everything } else { Wanted::Image };
        let picture = render(&studio, wanted, &supervision)?.picture;
        let (image, scale): (RgbImage, Option<Scale>) = match scene.picture.map {
            None => (to_srgb(&picture)?, None),
            Some(channel) => {
                let map = ScalarMap::new(&picture, channel)?;
                let scale = scale(channel, map.range());
                (map.image, Some(scale))
            }
        };
        let caption = Caption {
            id: wish.look.id,
            view,
            width: pass.size[0],
            height: pass.size[1],
            samples: pass.samples,
            min_power: scene.trace.min_power,
            finished: pass.finished,
            last,
            milliseconds: start.elapsed().as_secs_f64() * 1e3,
            scale,
        };
        self.outbox.send_bytes(encode(&caption, &image)).map_err(|_| PaintError::Gone)
    }

    fn say(&self, message: &Value) -> Result<(), PaintError> {
        self.outbox.say(message).map_err(|_| PaintError::Gone)
    }
}

/// The pictures on the way to a finished one.
fn passes(look: &Look, nanoseconds_a_pixel: Option<f64>) -> Vec<Pass> {
    let pixels = f64::from(look.size[0]) * f64::from(look.size[1]);
    let divisor = match nanoseconds_a_pixel {
        None => 4.0,
        Some(each) => {
            let fits =
                |divisor: &&f64| each * pixels / (*divisor * *divisor) <= COARSE.as_nanos() as f64;
            DIVISORS.iter().find(fits).copied().unwrap_or(DIVISORS[DIVISORS.len() - 1])
        }
    };
    let size = look.size.map(|side| ((f64::from(side) / divisor).round() as u32).max(1));
    let coarse = Pass { size, samples: 1, coarse: true, finished: false };
    if look.moving {
        return vec![coarse];
    }
    let quick = nanoseconds_a_pixel.is_some_and(|each| each * pixels < PATIENCE.as_nanos() as f64);
    let mut passes = if quick { Vec::new() } else { vec![coarse] };
    let steps = std::iter::successors(Some(1), |samples| Some(samples * 4));
    let steps = steps.take_while(|samples| *samples < look.samples);
    for samples in steps.chain([look.samples]) {
        let finished = samples == look.samples;
        passes.push(Pass { size: look.size, samples, coarse: false, finished });
    }
    passes
}

/// The scale of a map in a unit for people.
fn scale(channel: &str, range: Option<(f64, f64)>) -> Scale {
    let quantity = Quantity::of_channel(channel);
    let size = range.map_or(0.0, |(low, high)| low.abs().max(high.abs()));
    let unit = quantity.unit(size);
    Scale {
        title: quantity.title,
        low: range.map(|(low, _)| low / unit.size),
        high: range.map(|(_, high)| high / unit.size),
        unit: unit.symbol,
    }
}

/// Tells a page now and then how far a picture is.
struct Progress<'a> {
    outbox: &'a Outbox,
    id: u64,
    samples: u32,
    rows: u64,
    done: AtomicU64,
    told: Mutex<Instant>,
}

impl<'a> Progress<'a> {
    fn new(outbox: &'a Outbox, id: u64, samples: u32, rows: u64) -> Self {
        let told = Mutex::new(Instant::now());
        Self { outbox, id, samples, rows, done: AtomicU64::new(0), told }
    }

    fn add(&self, rows: u64) {
        let done = self.done.fetch_add(rows, Ordering::Relaxed) + rows;
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.elapsed() >= PROGRESS {
            *told = Instant::now();
            let share = done as f64 / self.rows as f64;
            self.outbox.say_if_room(
                &json!({ "progress": { "id": self.id, "samples": self.samples, "share": share } }),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(moving: bool, samples: u32) -> Look {
        let scene = crate::protocol::SceneTables::new();
        Look { id: 1, scene, size: [640, 480], samples, moving, beside: Beside::Nothing }
    }

    #[test]
    fn pictures_get_better_step_by_step() {
        let samples = |passes: Vec<Pass>| passes.iter().map(|p| p.samples).collect::<Vec<_>>();
        let first = passes(&look(false, 16), None);
        assert!(first[0].coarse && first[0].size == [160, 120]);
        assert_eq!(samples(first), [1, 1, 4, 16]);
        // Quick scenes need no coarse picture.
        assert_eq!(samples(passes(&look(false, 16), Some(100.0))), [1, 4, 16]);
        let last = passes(&look(false, 10), Some(1e5));
        assert_eq!(samples(last.clone()), [1, 1, 4, 10]);
        assert_eq!(last.iter().filter(|pass| pass.finished).count(), 1);
        assert_eq!(samples(passes(&look(false, 1), Some(100.0))), [1]);
    }

    #[test]
    fn what_moves_is_as_fine_as_time_allows() {
        let size = |each| passes(&look(true, 16), Some(each))[0].size;
        assert_eq!(size(100.0), [640, 480]);
        assert_eq!(size(400.0), [320, 240]);
        assert_eq!(size(1e9), [107, 80]);
        assert_eq!(passes(&look(true, 16), Some(400.0)).len(), 1);
    }
}
