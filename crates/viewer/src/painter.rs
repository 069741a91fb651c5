//! The thread that renders for one page: coarsely at once, then in full, then with more samples.
//! What it sends at each number of samples is the picture that `cloakroom render` makes with that
//! number.

use crate::client::{Client, Gone, Outbox, Space};
use crate::cross_section::cross_section;
use crate::figures::{figures, resized};
use crate::pace::{Pace, Pass};
use crate::protocol::{Beside, Look, error};
use crate::slot::lock;
use cloakroom::measure::{bare, empty, ideal};
use cloakroom::output::{RgbImage, to_srgb};
use cloakroom::render::{
    ChannelSet, Images, PreparedScene, PreparedSceneError, Supervision, render,
};
use cloakroom::scene::{DeviceSettings, PictureSettings, Placement, Scene};
use cloakroom::trace::Stopped;
use cloakroom_figures::{Quantity, ScalarMap};
use serde_json::{Value, json};
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What coarse pictures may leave out: branches weaker than this, and places less exact than this,
/// cm.
const COARSE_POWER: f64 = 3e-2;
const COARSE_TOLERANCE: f64 = 1e-2;

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
    /// What a photograph among them takes.
    _space: Option<Arc<Space>>,
}

/// Why there is no picture.
type PaintError = Box<dyn Error + Send + Sync>;

/// Whether newer wishes, or the end of the page, are why.
fn is_stop(error: &PaintError) -> bool {
    error.is::<Gone>() || Stopped::is_in(error.as_ref())
}

/// Paints what a page wishes, until it is gone.
pub(crate) fn paint(client: &Client, outbox: &Outbox) {
    let mut painter = Painter {
        client,
        outbox,
        images: lock(&client.server.images).clone(),
        uploaded: None,
        pace: Pace::default(),
        devices: Vec::new(),
        section: Value::Null,
    };
    // Of its own: the system shares the processors out among pages, and light that is trapped in the
    // device of one keeps no other waiting.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build();
    while let Some(wish) = client.looks.take() {
        let id = wish.look.id;
        let painted = catch_unwind(AssertUnwindSafe(|| match &threads {
            Ok(threads) => threads.install(|| painter.paint(&wish)),
            Err(_) => painter.paint(&wish),
        }));
        let said = match painted {
            Ok(Ok(())) => Ok(()),
            Ok(Err(failure)) if is_stop(&failure) => Ok(()),
            Ok(Err(failure)) => {
                let mut message = error(Some(id), &failure.to_string());
                let of_scene = failure.downcast_ref::<PreparedSceneError>();
                message["error"]["key"] = json!(of_scene.map(PreparedSceneError::key));
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
    uploaded: Option<(u64, Images, Arc<Space>)>,
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
        let scene = opened.read(&look.scene, source)?.scene;
        let Some(uploaded) = uploaded.filter(|own| own.source == scene.photograph.image) else {
            let mut images = std::mem::take(&mut self.images);
            let painted = self.paint_scene(wish, &scene, (&mut images, None));
            self.images = images;
            return painted;
        };
        let known = self.uploaded.take().filter(|(number, ..)| *number == uploaded.number);
        let mut images = known.map_or(uploaded.images, |(_, images, _)| images);
        let space = uploaded.space;
        let painted = self.paint_scene(wish, &scene, (&mut images, Some(&space)));
        self.uploaded = Some((uploaded.number, images, space));
        painted
    }

    fn paint_scene(
        &mut self,
        wish: &Wish,
        scene: &Scene,
        (images, space): (&mut Images, Option<&Arc<Space>>),
    ) -> Result<(), PaintError> {
        let look = &wish.look;
        let full = resized(scene, look.size, 1);
        {
            let prepared = PreparedScene::with_images(&full, images)?;
            let section = cross_section(&full, &prepared);
            if section != self.section {
                self.outbox.say(&json!({ "section": section }))?;
                self.section = section;
            }
        }
        let shown = Shown { scene: full, images: images.clone(), _space: space.cloned() };
        *lock(&self.client.shown) = Some(Arc::new(shown));
        let beside = match look.beside {
            Beside::Nothing => None,
            Beside::Bare => bare(scene).map(|scene| ("bare", scene)),
            Beside::Empty => Some(("empty", empty(scene))),
            Beside::Mirror => Some(("mirror", ideal(scene))),
        };
        let mut views = vec![("scene", scene)];
        views.extend(beside.as_ref().map(|(name, scene)| (*name, scene)));
        if !look.moving && !are_alike(&self.devices, &scene.devices) {
            // Other devices take another time: something is to be seen at once.
            self.pace = Pace::default();
        }
        self.devices.clone_from(&scene.devices);
        for pass in self.pace.passes(look) {
            let (mut time, mut range) = (Duration::ZERO, None);
            for (number, (name, scene)) in views.iter().enumerate() {
                let last = number + 1 == views.len();
                time += self.picture(wish, (name, last), scene, (pass, &mut range), images)?;
            }
            self.pace.add(pass, time);
            if pass.coarse && !look.moving {
                self.client.seen.wait(look.id, SIGHT, &wish.stop);
            }
            if !pass.coarse && pass.samples == 1 {
                let mut numbers = figures(scene, images, &wish.stop)?;
                numbers["id"] = json!(look.id);
                self.outbox.say(&json!({ "numbers": numbers }))?;
            }
        }
        Ok(())
    }

    /// Renders and sends one picture: of a view, which may be the last of its pass. Maps of one pass have
    /// one range, that of the first. How long rendering has taken.
    fn picture(
        &self,
        wish: &Wish,
        (view, last): (&'static str, bool),
        scene: &Scene,
        (pass, range): (Pass, &mut Option<[f64; 2]>),
        images: &mut Images,
    ) -> Result<Duration, PaintError> {
        let mut scene = resized(scene, pass.size, pass.samples);
        if pass.coarse {
            scene.trace.min_power.value = scene.trace.min_power.value.max(COARSE_POWER);
            scene.trace.tolerance = scene.trace.tolerance.max(COARSE_TOLERANCE);
        }
        let start = Instant::now();
        let prepared = PreparedScene::with_images(&scene, images)?;
        let (done, told) = (AtomicU64::new(0), Mutex::new(Instant::now()));
        // The page is told now and then how far a picture is.
        let rows_done = |rows| {
            let done = done.fetch_add(rows, Ordering::Relaxed) + rows;
            let mut told = lock(&told);
            if !pass.coarse && told.elapsed() >= PROGRESS {
                *told = Instant::now();
                let (id, share) = (wish.look.id, done as f64 / prepared.rows() as f64);
                let progress = json!({ "id": id, "samples": pass.samples, "share": share });
                self.outbox.say_if_room(&json!({ "progress": progress }));
            }
        };
        let supervision = Supervision { rows_done: &rows_done, stop: &wish.stop };
        let wanted = ChannelSet::for_image(&scene.picture);
        let picture = render(&prepared, wanted, &supervision)?.picture;
        let (image, scale) = match scene.picture.map.name() {
            None => (to_srgb(&picture)?, Value::Null),
            Some(channel) => {
                let map_range = scene.picture.map_range.or(*range);
                let settings = PictureSettings { map_range, ..scene.picture.clone() };
                let map = ScalarMap::new(&picture, channel, &settings)?;
                let shown = map.bar.scale.range.filter(|(low, high)| low < high);
                *range = range.or(shown.map(|(low, high)| [low, high]));
                let scale = scale(channel, map.bar.scale.range);
                (map.image, scale)
            }
        };
        let time = start.elapsed();
        // Whether it is the best that was asked for, and the last of those that are shown beside
        // each other.
        let caption = json!({
            "id": wish.look.id,
            "view": view,
            "width": pass.size[0],
            "height": pass.size[1],
            "samples": pass.samples,
            "min_power": scene.trace.min_power.value,
            "finished": pass.finished,
            "last": last,
            "scale": scale,
        });
        self.outbox.send_bytes(encode(&caption, &image))?;
        Ok(time)
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

/// The scale of a map, which colors stand for which numbers, in a unit for people; no ends if no
/// number is finite.
fn scale(channel: &str, range: Option<(f64, f64)>) -> Value {
    let quantity = Quantity::of_channel(channel);
    let size = range.map_or(0.0, |(low, high)| low.abs().max(high.abs()));
    let unit = quantity.unit(size);
    json!({
        "title": quantity.title,
        "low": range.map(|(low, _)| low / unit.size),
        "high": range.map(|(_, high)| high / unit.size),
        "unit": unit.symbol,
    })
}

/// A picture on its way to a page: four bytes of length, JSON of that length, then RGBA.
fn encode(caption: &Value, image: &RgbImage) -> Vec<u8> {
    let caption = caption.to_string().into_bytes();
    let pixels = image.as_raw();
    let mut bytes = Vec::with_capacity(4 + caption.len() + pixels.len() / 3 * 4);
    bytes.extend((caption.len() as u32).to_le_bytes());
    bytes.extend(caption);
    for pixel in pixels.chunks_exact(3) {
        bytes.extend([pixel[0], pixel[1], pixel[2], 255]);
    }
    bytes
}
