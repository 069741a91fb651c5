//! Paints what a page wishes: coarsely at once, then in full, then with more samples. What it sends at
//! each number of samples is the picture that `cloakroom render` makes with that number.

use crate::end::{End, Moment, Problem, Recipe, Subject, View, Wanted};
use crate::figures::figures;
use crate::pace::{Pace, Pass};
use crate::protocol::{Beside, Look, SceneTables, error};
use crate::scenes::Opened;
use crate::seen::Seen;
use crate::slot::Slot;
use crate::watched::lock;
use cloakroom::measure::bare;
use cloakroom::output::{RgbImage, to_srgb};
use cloakroom::render::Supervision;
use cloakroom::scene::{DeviceSettings, PictureSettings, Placement, Scene};
use cloakroom_figures::{Quantity, ScalarMap};
use futures_util::FutureExt;
use serde_json::{Value, json};
use std::panic::AssertUnwindSafe;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How long a page may take to show the first coarse picture before finer ones are begun.
const SIGHT: Duration = Duration::from_millis(400);

/// How often progress is told.
const PROGRESS: Duration = Duration::from_millis(150);

/// A look, and the flag that cancels it.
#[derive(Debug)]
pub struct Wish {
    pub(crate) look: Look,
    pub(crate) stop: Arc<AtomicBool>,
}

/// Paints what a page wishes, until its slot is closed or it is gone.
pub async fn paint(end: &impl End, opened: &Opened, looks: &Slot<Wish>, seen: &Seen) {
    let pace = Pace::default();
    let mut painter =
        Painter { end, opened, seen, pace, devices: Vec::new(), section: Value::Null, times: None };
    while let Some(wish) = looks.take().await {
        let id = wish.look.id;
        let painted = AssertUnwindSafe(painter.paint(&wish)).catch_unwind().await;
        let said = match painted {
            Ok(Ok(()) | Err(Problem::Stopped)) => Ok(()),
            Ok(Err(Problem::Scene { key, message })) => {
                let mut message = error(Some(id), &message);
                message["error"]["key"] = json!(key);
                end.say(&message).await
            }
            Err(_) => {
                let message = "this scene could not be rendered: a mistake in the program";
                end.say(&error(Some(id), message)).await
            }
        };
        if said.is_err() {
            return;
        }
    }
}

struct Painter<'a, E> {
    end: &'a E,
    opened: &'a Opened,
    seen: &'a Seen,
    /// How long its pictures take.
    pace: Pace,
    /// The devices that were shown last.
    devices: Vec<DeviceSettings>,
    /// The cross-section that was sent last.
    section: Value,
    /// A scene with what was beside it, and when its light arrives first and last.
    times: Option<(SceneTables, Beside, [f64; 2])>,
}

impl<E: End> Painter<'_, E> {
    async fn paint(&mut self, wish: &Wish) -> Result<(), Problem> {
        let look = &wish.look;
        let uploaded = self.end.begin();
        let loaded = self.opened.read(&look.scene, uploaded.as_ref()).map_err(Problem::of)?;
        let scene = &loaded.scene;
        let subject = Subject { look, scene, recipe: Recipe::plain(look.size) };
        let section = self.end.section(&subject).await?;
        if section != self.section {
            self.end.say(&section).await?;
            self.section = section;
        }
        let beside = match look.beside {
            Beside::Nothing => None,
            Beside::Bare => bare(scene).map(|_| View::Bare),
            Beside::Empty => Some(View::Empty),
            Beside::Mirror => Some(View::Mirror),
        };
        let views: Vec<View> = std::iter::once(View::Scene).chain(beside).collect();
        if !look.moving && !are_alike(&self.devices, &scene.devices) {
            // Other devices take another time: something is to be seen at once.
            self.pace = Pace::default();
        }
        self.devices.clone_from(&scene.devices);
        let wanted = match look.moment {
            None => Wanted::Picture,
            Some(share) => Wanted::Moment(Moment::at(share, self.times(&subject, &views).await?)),
        };
        for pass in self.pace.passes(look) {
            let (mut time, mut range) = (Duration::ZERO, None);
            for (number, view) in views.iter().enumerate() {
                let last = number + 1 == views.len();
                time +=
                    self.picture(wish, (*view, last, wanted), scene, (pass, &mut range)).await?;
            }
            self.pace.add(pass, time);
            if pass.coarse && !look.moving {
                self.end.wait(self.seen.wait(look.id, &wish.stop), SIGHT).await;
            }
            if !pass.coarse && pass.samples == 1 {
                let mut numbers = figures(self.end, look, scene, &wish.stop).await?;
                numbers["id"] = json!(look.id);
                self.end.say(&json!({ "numbers": numbers })).await?;
            }
        }
        Ok(())
    }

    /// When light of the photograph arrives first and last in any of these views of a scene.
    async fn times(&mut self, subject: &Subject<'_>, views: &[View]) -> Result<[f64; 2], Problem> {
        let look = subject.look;
        if let Some((scene, beside, times)) = &self.times
            && (scene, *beside) == (&look.scene, look.beside)
        {
            return Ok(*times);
        }
        let mut all: Option<[f64; 2]> = None;
        for view in views {
            let subject = Subject { recipe: Recipe { view: *view, ..subject.recipe }, ..*subject };
            if let Some([first, last]) = self.end.times(&subject).await? {
                let [start, end] = all.unwrap_or([first, last]);
                all = Some([start.min(first), end.max(last)]);
            }
        }
        let times = all.ok_or_else(|| {
            Problem::of("no light of the photograph arrives at any time that is known")
        })?;
        self.times = Some((look.scene.clone(), look.beside, times));
        Ok(times)
    }

    /// Renders and sends one picture: of a view, which may be the last of its pass. Maps of one pass have
    /// one range, that of the first. How long rendering has taken.
    async fn picture(
        &self,
        wish: &Wish,
        (view, last, wanted): (View, bool, Wanted),
        scene: &Scene,
        (pass, range): (Pass, &mut Option<[f64; 2]>),
    ) -> Result<Duration, Problem> {
        let (end, look) = (self.end, &wish.look);
        let Pass { size, samples, coarse, .. } = pass;
        let recipe = Recipe { view, size, samples, coarse };
        let start = end.now();
        let (done, told) = (AtomicU64::new(0), Mutex::new(start));
        // The page is told now and then how far a picture is.
        let rows_done = |rows| {
            let done = done.fetch_add(rows, Ordering::Relaxed) + rows;
            let (mut told, now) = (lock(&told), end.now());
            if !coarse && now.saturating_sub(*told) >= PROGRESS {
                *told = now;
                let share = done as f64 / f64::from(size[1]);
                let progress = json!({ "id": look.id, "samples": samples, "share": share });
                end.say_if_room(&json!({ "progress": progress }));
            }
        };
        let supervision = Supervision { rows_done: &rows_done, stop: &wish.stop };
        let subject = Subject { look, scene, recipe };
        let picture = end.picture(&subject, wanted, &supervision).await?;
        let moment = match wanted {
            Wanted::Moment(moment) => Some(moment),
            _ => None,
        };
        let map = scene.picture.map.name().filter(|_| moment.is_none());
        let (image, scale) = match map {
            None => (to_srgb(&picture).map_err(Problem::of)?, Value::Null),
            Some(channel) => {
                let map_range = scene.picture.map_range.or(*range);
                let settings = PictureSettings { map_range, ..scene.picture.clone() };
                let map = ScalarMap::new(&picture, channel, &settings).map_err(Problem::of)?;
                let shown = map.bar.scale.range.filter(|(low, high)| low < high);
                *range = range.or(shown.map(|(low, high)| [low, high]));
                let scale = scale(channel, map.bar.scale.range);
                (map.image, scale)
            }
        };
        let time = end.now().saturating_sub(start);
        // Whether it is the best that was asked for, and the last of those that are shown beside
        // each other.
        let caption = json!({
            "id": look.id,
            "view": view.name(),
            "width": size[0],
            "height": size[1],
            "samples": samples,
            "min_power": recipe.least_power(scene),
            "finished": pass.finished,
            "last": last,
            "scale": scale,
            "time_ns": moment.map(|moment| moment.time_ns),
            "open_ns": moment.map(|moment| moment.open_ns),
        });
        end.send(encode(&caption, &image)).await?;
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
