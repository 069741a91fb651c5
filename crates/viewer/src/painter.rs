//! The thread that renders for one page: coarsely at once, then in full, then with more samples. What it sends at each
//! number of samples is the picture that `cloakroom render` makes with that number.

use crate::client::{Client, Outbox};
use crate::cross_section::cross_section;
use crate::figures::{FiguresError, figures, resized};
use crate::frame::{Caption, Scale, encode};
use crate::pace::{Pace, Pass};
use crate::protocol::{Beside, Look, error};
use cloakroom::measure::{bare, empty, ideal};
use cloakroom::output::{OutputError, RgbImage, to_srgb};
use cloakroom::render::{
    ChannelSet, Images, PreparedScene, PreparedSceneError, RenderError, Supervision, render,
};
use cloakroom::scene::{DeviceSettings, Placement, Scene};
use cloakroom_figures::{IllustrationError, Quantity, ScalarMap};
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What coarse pictures may leave out: branches weaker than this, and places less exact than this, cm.
const COARSE_POWER: f64 = 1e-2;
const COARSE_TOLERANCE: f64 = 1e-4;

/// How long a page may take to show the first coarse picture before finer ones are begun.
const SIGHT: Duration = Duration::from_millis(400);

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
    PreparedScene(#[from] PreparedSceneError),
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
            Self::PreparedScene(error) => Some(error.key()),
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
        pace: Pace::default(),
        devices: Vec::new(),
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
    /// How long its pictures take.
    pace: Pace,
    /// The devices that were shown last.
    devices: Vec<DeviceSettings>,
    /// The cross-section that was sent last.
    section: Value,
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
            let studio = PreparedScene::with_images(&full, images)?;
            let section = cross_section(&full, &studio);
            if section != self.section {
                self.say(&json!({ "section": section }))?;
                self.section = section;
            }
        }
        self.client.show(Shown { scene: full, images: images.clone() });
        let beside = match look.beside {
            Beside::Nothing => None,
            Beside::Bare => bare(scene).map(|scene| ("bare", scene)),
            Beside::Empty => Some(("empty", empty(scene))),
            Beside::Mirror => Some(("mirror", ideal(scene))),
        };
        let views: Vec<(&'static str, &Scene)> = [("scene", scene)]
            .into_iter()
            .chain(beside.as_ref().map(|(name, scene)| (*name, scene)))
            .collect();
        if !look.moving && !are_alike(&self.devices, &scene.devices) {
            // Other devices take another time: something is to be seen at once.
            self.pace = Pace::default();
        }
        self.devices.clone_from(&scene.devices);
        for pass in self.pace.passes(look) {
            let mut time = Duration::ZERO;
            for (number, (name, scene)) in views.iter().enumerate() {
                let last = number + 1 == views.len();
                time += self.picture(wish, (name, last), scene, pass, images)?;
            }
            self.pace.add(pass, time);
            if pass.coarse && !look.moving {
                self.client.seen.wait(look.id, SIGHT, &wish.stop);
            }
            if !pass.coarse && pass.samples == 1 {
                let mut numbers = figures(scene, images, &wish.stop)?;
                numbers["id"] = json!(look.id);
                self.say(&json!({ "numbers": numbers }))?;
            }
        }
        Ok(())
    }

    /// Renders and sends one picture: of a view, which may be the last of its pass. How long rendering has taken.
    fn picture(
        &self,
        wish: &Wish,
        (view, last): (&'static str, bool),
        scene: &Scene,
        pass: Pass,
        images: &mut Images,
    ) -> Result<Duration, PaintError> {
        let mut scene = resized(scene, pass.size, pass.samples);
        if pass.coarse {
            scene.trace.min_power.value = scene.trace.min_power.value.max(COARSE_POWER);
            scene.trace.tolerance = scene.trace.tolerance.max(COARSE_TOLERANCE);
        }
        let start = Instant::now();
        let studio = PreparedScene::with_images(&scene, images)?;
        let progress = Progress::new(self.outbox, wish.look.id, pass.samples, studio.rows());
        let rows_done = |rows| progress.add(rows);
        let quiet = |_| {};
        let supervision = Supervision {
            rows_done: if pass.coarse { &quiet } else { &rows_done },
            stop: &wish.stop,
        };
        let wanted = ChannelSet::for_image(&scene.picture);
        let picture = render(&studio, wanted, &supervision)?.picture;
        let (image, scale): (RgbImage, Option<Scale>) = match scene.picture.map.name() {
            None => (to_srgb(&picture)?, None),
            Some(channel) => {
                let map = ScalarMap::new(&picture, channel, None)?;
                let scale = scale(channel, map.bar.scale.range());
                (map.image, Some(scale))
            }
        };
        let time = start.elapsed();
        let caption = Caption {
            id: wish.look.id,
            view,
            width: pass.size[0],
            height: pass.size[1],
            samples: pass.samples,
            min_power: scene.trace.min_power.value,
            finished: pass.finished,
            last,
            scale,
        };
        self.outbox.send_bytes(encode(&caption, &image)).map_err(|_| PaintError::Gone)?;
        Ok(time)
    }

    fn say(&self, message: &Value) -> Result<(), PaintError> {
        self.outbox.say(message).map_err(|_| PaintError::Gone)
    }
}

/// Whether devices differ in nothing but how they stand.
fn are_alike(some: &[DeviceSettings], others: &[DeviceSettings]) -> bool {
    let alike = |(one, other): (&DeviceSettings, &DeviceSettings)| {
        let Placement { rotation, axis, position, .. } = other.placement;
        let placement = Placement { rotation, axis, position, ..one.placement.clone() };
        one.device == other.device && placement == other.placement
    };
    some.len() == others.len() && some.iter().zip(others).all(alike)
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
