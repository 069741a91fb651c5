//! What a page talks to. There are two such ends of one protocol: the server of `cloakroom view`, and
//! the page's own workers where it computes by itself. They differ in where work is done.

use crate::cross_section::cross_section;
use crate::figures::resized;
use crate::protocol::{Look, SceneTables};
use crate::watched::lock;
use cloakroom::measure::{self, bare, empty, ideal};
use cloakroom::output::{Channel, Picture, Samples};
use cloakroom::photograph::{Averaging, ImageSource};
use cloakroom::render::{
    Arrivals, BAND_ROWS, ChannelSet, FlightSettings, Gate, Images, PreparedScene,
    PreparedSceneError, RenderError, Supervision, Tile, arrival_times, flight_part, render_part,
};
use cloakroom::scene::Scene;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::future::Future;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// What coarse pictures may leave out: branches weaker than this, and places less exact than this,
/// cm. So they differ from exact ones by 1 or 2 steps of 255 in the mean.
const COARSE_POWER: f64 = 5e-2;
const COARSE_TOLERANCE: f64 = 0.1;

/// The page has gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the page has gone")]
pub struct Gone;

/// Why something was not done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Problem {
    /// Newer wishes, or the end of the page.
    Stopped,
    /// Something in the scene.
    Scene {
        /// The key at fault, where it is one.
        key: Option<String>,
        /// What is wrong.
        message: String,
    },
}

impl Problem {
    /// One that is about no key of the scene.
    pub fn of(error: impl ToString) -> Self {
        Self::Scene { key: None, message: error.to_string() }
    }
}

impl From<Gone> for Problem {
    fn from(_: Gone) -> Self {
        Self::Stopped
    }
}

impl From<PreparedSceneError> for Problem {
    fn from(error: PreparedSceneError) -> Self {
        Self::Scene { key: Some(error.key()), message: error.to_string() }
    }
}

impl From<RenderError> for Problem {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Stopped(_) => Self::Stopped,
            RenderError::TooLarge { .. } => Self::of(error),
        }
    }
}

/// What of a scene is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum View {
    /// All of it.
    Scene,
    /// The metal without its cloak.
    Bare,
    /// No device.
    Empty,
    /// What the cloak should look like.
    Mirror,
}

impl View {
    /// What pages call it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Bare => "bare",
            Self::Empty => "empty",
            Self::Mirror => "mirror",
        }
    }
}

/// What is made of the scene that a page has sent before anything is done with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recipe {
    /// What of it is seen.
    pub view: View,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// Whether weak branches may be left out.
    pub coarse: bool,
}

impl Recipe {
    /// The whole scene in one sample a pixel.
    pub(crate) fn plain(size: [u32; 2]) -> Self {
        Self { view: View::Scene, size, samples: 1, coarse: false }
    }

    /// The power of the weakest branches that are followed.
    pub(crate) fn least_power(&self, scene: &Scene) -> f64 {
        let power = scene.trace.min_power.value;
        if self.coarse { power.max(COARSE_POWER) } else { power }
    }

    /// The scene that is made; a scene without a device that could be bare is so already.
    #[must_use]
    pub fn scene(&self, scene: &Scene) -> Scene {
        let seen = match self.view {
            View::Scene => None,
            View::Bare => bare(scene),
            View::Empty => Some(empty(scene)),
            View::Mirror => Some(ideal(scene)),
        };
        let mut scene = resized(seen.as_ref().unwrap_or(scene), self.size, self.samples);
        if self.coarse {
            scene.trace.min_power.value = self.least_power(&scene);
            scene.trace.tolerance = scene.trace.tolerance.max(COARSE_TOLERANCE);
        }
        scene
    }

    /// The scene that has been made, ready to be rendered.
    ///
    /// # Errors
    ///
    /// As [`PreparedScene::with_images`].
    pub fn prepared<'s>(
        &self,
        scene: &'s Scene,
        images: &mut Images,
    ) -> Result<PreparedScene<'s>, PreparedSceneError> {
        let averaging = if self.coarse { Averaging::Quick } else { Averaging::Sharp };
        Ok(PreparedScene::with_images(scene, images)?.averaged(averaging))
    }
}

/// What of a scene is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Wanted {
    /// What its picture shows: the image, or a map.
    Picture,
    /// Every channel.
    Everything,
    /// What a camera sees that is open for a moment after the photograph has flashed.
    Moment(Moment),
}

/// When a camera is open, after the photograph has flashed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// The middle of that time, ns.
    pub time_ns: f64,
    /// How long it is, ns.
    pub open_ns: f64,
}

impl Moment {
    /// At a share, 0 to 1, of the time from before light arrives first until after it does last (ns).
    pub(crate) fn at(share: f64, [first, last]: [f64; 2]) -> Self {
        /// So many moments one after the other hold all light.
        const MOMENTS: f64 = 24.0;
        /// Light takes so long for 3 mm.
        const SHORTEST: f64 = 1e-2;
        let open_ns = ((last - first) / MOMENTS).max(SHORTEST);
        let [first, last] = [first - open_ns, last + open_ns];
        Self { time_ns: first + share * (last - first), open_ns }
    }
}

/// What something is to be done with.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The look that it is for.
    pub look: &'a Look,
    /// Its scene, read.
    pub scene: &'a Scene,
    /// What is made of it.
    pub recipe: Recipe,
}

impl Subject<'_> {
    /// The scene as the page has sent it.
    #[must_use]
    pub fn tables(&self) -> &SceneTables {
        &self.look.scene
    }
}

/// An end of the protocol.
#[allow(async_fn_in_trait, reason = "each is used on the thread where it was made")]
pub trait End: Sync {
    /// A look begins: the photograph that the page has brought, which no later one replaces until the next
    /// look begins.
    fn begin(&self) -> Option<ImageSource>;

    /// Says something.
    async fn say(&self, message: &Value) -> Result<(), Gone>;

    /// Says something unless the page is busy.
    fn say_if_room(&self, message: &Value);

    /// Sends a picture.
    async fn send(&self, bytes: Vec<u8>) -> Result<(), Gone>;

    /// The time since some moment.
    fn now(&self) -> Duration;

    /// Waits for something, but no longer than this.
    async fn wait(&self, what: impl Future<Output = ()>, patience: Duration);

    /// Renders a scene.
    async fn picture(
        &self,
        subject: &Subject<'_>,
        wanted: Wanted,
        supervision: &Supervision<'_>,
    ) -> Result<Picture, Problem>;

    /// The first and the last time (ns) at which light of the photograph arrives, if any does at a time
    /// that is known.
    async fn times(&self, subject: &Subject<'_>) -> Result<Option<[f64; 2]>, Problem>;

    /// The cross-section; the rays that are followed from now on go through this scene.
    async fn section(&self, subject: &Subject<'_>) -> Result<Value, Problem>;

    /// Where rays land, against where they should.
    async fn survey(
        &self,
        subject: &Subject<'_>,
        supervision: &Supervision<'_>,
    ) -> Result<Survey, Problem>;
}

/// What the numbers of a page need of a survey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survey {
    /// Whether the ray through the middle of a pixel meets a device.
    pub silhouette: Vec<bool>,
    /// How far from where it should light lands, cm.
    pub displacement_rms_cm: Option<f64>,
    /// The share of light that lands where, and as, it should.
    pub in_place_share: Option<f64>,
}

/// Renders rows of a picture, from a multiple of [`BAND_ROWS`] on.
///
/// # Errors
///
/// If it was stopped, or does not fit into memory.
pub fn rows(
    prepared: &PreparedScene<'_>,
    [top, height]: [u32; 2],
    wanted: Wanted,
    supervision: &Supervision<'_>,
) -> Result<Picture, Problem> {
    let width = prepared.scene.camera.resolution[0];
    let tile = Tile { left: 0, top, width, height };
    let channels = match wanted {
        Wanted::Picture => ChannelSet::for_image(&prepared.scene.picture),
        Wanted::Everything => ChannelSet::Everything,
        Wanted::Moment(moment) => return moment_of(prepared, tile, moment, supervision),
    };
    Ok(render_part(prepared, channels, tile, supervision)?.picture)
}

/// Renders what is seen of whole rows in a moment of light in flight: red, green and blue, which are as bright as in the picture
/// where all light arrives then.
fn moment_of(
    prepared: &PreparedScene<'_>,
    tile: Tile,
    Moment { time_ns, open_ns }: Moment,
    supervision: &Supervision<'_>,
) -> Result<Picture, Problem> {
    let gate = Gate::new([time_ns; 2], open_ns).map_err(Problem::of)?;
    let settings = FlightSettings { gate, width: 0.0, arrivals: Arrivals::default() };
    let [width, height] = [tile.width, tile.height].map(|side| side as usize);
    let planes = Mutex::new([0; 3].map(|_| vec![0.0; width * height]));
    // Of the parts that lie side by side the last one done ends their rows.
    let (beside, done) = (u64::from(tile.width.div_ceil(BAND_ROWS)), AtomicU64::new(0));
    let rows_done = |rows: u64| {
        let before = done.fetch_add(rows, Ordering::Relaxed);
        (supervision.rows_done)((before + rows) / beside - before / beside);
    };
    let supervision = Supervision { rows_done: &rows_done, stop: supervision.stop };
    flight_part(prepared, &settings, tile, &supervision, |part| {
        let mut planes = lock(&planes);
        let above = tile.top as usize * width;
        for (place, (bins, steady)) in
            part.tile.places(width).zip(part.bins.iter().zip(&part.steady))
        {
            let light = bins.light.first().copied().unwrap_or_default();
            for (color, plane) in planes.iter_mut().enumerate() {
                plane[place - above] = (steady[color] + light[color]) as f32;
            }
        }
        Ok::<_, Problem>(())
    })?;
    let planes = planes.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let channel =
        |(name, plane): (&str, _)| Channel { name: name.to_owned(), samples: Samples::F32(plane) };
    let channels = ["R", "G", "B"].into_iter().zip(planes).map(channel).collect();
    Ok(Picture { width, height, channels, metadata: Vec::new() })
}

/// When light of the photograph arrives first and last; see [`End::times`].
#[must_use]
pub fn times(prepared: &PreparedScene<'_>) -> Option<[f64; 2]> {
    arrival_times(prepared, &Arrivals::default())
}

/// The cross-section of a scene, as pages are told it.
#[must_use]
pub fn section(prepared: &PreparedScene<'_>) -> Value {
    json!({ "section": cross_section(prepared.scene, prepared) })
}

/// Where the rays of a scene land, against where they should.
///
/// # Errors
///
/// If it was stopped.
pub fn survey(
    prepared: &PreparedScene<'_>,
    images: &mut Images,
    supervision: &Supervision<'_>,
) -> Result<Survey, Problem> {
    let wanted = ideal(prepared.scene);
    // About no key of the scene that is shown.
    let ideal = PreparedScene::with_images(&wanted, images).map_err(Problem::of)?;
    let rays = measure::survey(prepared, &ideal, supervision)?;
    let in_place_share = rays.in_place_share();
    let measure::Survey { silhouette, displacement_rms_cm, .. } = rays;
    Ok(Survey { silhouette, displacement_rms_cm, in_place_share })
}
