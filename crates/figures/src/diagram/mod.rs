//! Ray diagrams as in books: the devices, a fan or bundle of rays through them, and marks of equal
//! optical path.

mod pulse;
mod rays;
mod solids;
mod source;
mod view;

pub use pulse::Pulse;
pub use source::Source;

use super::drawing::{Drawing, Shape};
use super::setting::{AXES, Devices, MARGIN, TEXT, draw_axes, sheet};
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::render::{Delay, PreparedSceneError, RenderError, assembly};
use cloakroom::scene::Scene;
use cloakroom::trace::{Limits, Line, Stopped, lines};
use glam::{DVec2, DVec3};
use optics::wave::SPEED_OF_LIGHT;
use rayon::prelude::*;
use rays::Joints;
use solids::Light;
use std::sync::atomic::{AtomicBool, Ordering};
use view::{Scenery, SpaceView};

/// What a ray diagram shows.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagramSettings {
    /// Where the rays come from.
    pub source: Source,
    /// How many there are; for a projection in space, how many in each of that many layers.
    pub rays: u32,
    /// How many layers of rays lie one behind the other along z; 1 for a cross-section.
    pub layers: u32,
    /// The plane z = const that the rays start in, cm; `None`: that of the first device's origin.
    pub z: Option<f64>,
    /// The width of a bundle, cm; `None`: that of the devices.
    pub width: Option<f64>,
    /// Least and greatest x and y of the part of the cross-section that is shown, cm; `None`: the
    /// devices and what is around them.
    pub window: Option<[DVec2; 2]>,
    /// The shares of horizontal and vertical polarization.
    pub polarization: [f64; 2],
    /// The distance of marks of equal optical path, cm, if there are any.
    pub wavefronts: Option<f64>,
    /// Branches weaker than this are not drawn.
    pub min_power: f64,
    /// From where space is seen in parallel projection: degrees about y, from the view along -z (0:
    /// x to the right) towards that along -x, and degrees above the xz-plane; `None`: the
    /// cross-section in the xy-plane.
    pub space: Option<[f64; 2]>,
    /// Width and height in pixels: their ratio is that of the sheet.
    pub size: [u32; 2],
}

/// Why a ray diagram cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum DiagramError {
    /// The scene is impossible.
    #[error(transparent)]
    Scene(#[from] PreparedSceneError),
    /// There is nothing to draw.
    #[error("the scene has no device that could be drawn")]
    NoDevice,
    /// A ray would start in a device.
    #[error("the rays start inside device {device} (counted from 0); they must start in air")]
    Inside {
        /// Which device, counted from 0.
        device: usize,
    },
    /// A number makes no sense.
    #[error("{name} is {value}; it must be {allowed}")]
    Setting {
        /// What it is the number of.
        name: &'static str,
        /// The number.
        value: f64,
        /// What would do.
        allowed: &'static str,
    },
    /// The work was stopped from outside.
    #[error("{0}")]
    Render(#[from] RenderError),
}

/// What a window is called in messages, and its least side, as a share of the size of the devices.
const WINDOW: &str = "the width or height of the window";
const LEAST_WINDOW: f64 = 1e-3;

/// What the distance of wavefronts is called in messages, and how many there may be along a ray.
const WAVEFRONTS: &str = "the distance of wavefronts";
const MOST_WAVEFRONTS: f64 = 4000.0;

/// More rays than this are no diagram.
const MOST_RAYS: u32 = 2000;

/// A ray diagram whose rays have been followed, ready to be drawn.
#[derive(Debug)]
pub struct RayDiagram {
    settings: DiagramSettings,
    assembly: Assembly,
    scenery: Scenery,
    /// The pieces of the tree of each ray.
    trees: Vec<Vec<Line>>,
}

impl RayDiagram {
    /// Follows the rays; `stop` ends the work.
    ///
    /// # Errors
    ///
    /// If the scene is impossible or empty, a setting makes no sense, or the work was stopped.
    pub fn new(
        scene: &Scene,
        settings: &DiagramSettings,
        stop: &AtomicBool,
    ) -> Result<Self, DiagramError> {
        check(settings)?;
        let assembly = assembly(scene)?;
        let bounds = view::bounds(&assembly).or_else(|| Devices::new(&assembly).bounds());
        let bounds = bounds.ok_or(DiagramError::NoDevice)?;
        let least = LEAST_WINDOW * (bounds[1] - bounds[0]).max_element();
        if let Some(side) = settings.window.map(|[low, high]| (high - low).min_element())
            && side < least
        {
            let (name, allowed) = (WINDOW, "a thousandth of the size of the devices, at least");
            return Err(DiagramError::Setting { name, value: side, allowed });
        }
        let z = settings.z.unwrap_or_else(|| assembly.devices()[0].pose.origin.z);
        let scenery = Scenery::new(bounds, z, settings);
        let launches = settings.source.launches(scene, settings, &scenery);
        if let Some(device) =
            launches.iter().find_map(|launch| assembly.device_containing(launch.origin))
        {
            return Err(DiagramError::Inside { device });
        }
        let limits = Limits { min_power: settings.min_power, tolerance: scene.trace.tolerance };
        // How far leaves are followed: as far beyond the devices as rays start before them.
        let middle = scenery.middle();
        let before = launches.iter().map(|launch| launch.origin.truncate().distance(middle));
        let reach = scenery.start() + before.fold(scenery.start(), f64::max);
        let trees: Vec<Vec<Line>> = launches
            .par_iter()
            .map(|launch| {
                if stop.load(Ordering::Relaxed) {
                    return Err(RenderError::from(Stopped));
                }
                let mut tree = lines(&assembly, limits, launch, settings.polarization, reach);
                tree.retain(|line| line.power >= settings.min_power);
                Ok(tree)
            })
            .collect::<Result<_, _>>()?;
        if let Some(value) = settings.wavefronts
            && value * MOST_WAVEFRONTS < rays::longest(trees.iter().flatten())
        {
            let (name, allowed) =
                (WAVEFRONTS, "a 4000th of the longest optical path of a ray, at least");
            return Err(DiagramError::Setting { name, value, allowed });
        }
        Ok(Self { settings: settings.clone(), assembly, scenery, trees })
    }

    /// The plane of constant z (cm) in which parallel rays start, and the devices, by their numbers, that are
    /// drawn and do not reach it; `None` where rays start elsewhere.
    #[must_use]
    pub fn beside_rays(&self) -> Option<(f64, Vec<usize>)> {
        let Self { settings, assembly, scenery, .. } = self;
        let is_plane = matches!(settings.source, Source::Parallel { .. });
        let is_beside = |placed: &Placed| {
            let reach = placed.bounds().map(|[low, high]| low.z..=high.z);
            reach.is_some_and(|reach| !reach.contains(&scenery.z))
        };
        let devices = assembly.devices().iter().enumerate();
        let beside = devices.filter(|(_, placed)| is_beside(placed)).map(|(number, _)| number);
        (is_plane && settings.space.is_none()).then(|| (scenery.z, beside.collect()))
    }

    /// Draws it, with a pulse on its way or without.
    #[must_use]
    pub fn draw(&self, pulse: Option<&Pulse>) -> Drawing {
        let Self { settings, assembly, scenery, trees } = self;
        // How far apart the points of a front may be on so many neighbouring rays.
        let apart = |rays: usize| 6.0 * scenery.depth() / rays.max(4) as f64;
        let wavefronts = |trees: &[Vec<Line>]| {
            let Some(distance) = settings.wavefronts else { return Vec::new() };
            let joints = Joints { assembly, apart: apart(trees.len()) };
            rays::wavefronts(trees, &joints, distance)
        };
        let fronts = |trees: &[Vec<Line>]| {
            pulse.map_or_else(Vec::new, |pulse| {
                let joints = Joints { assembly, apart: apart(trees.len()) };
                pulse::fronts(trees, &joints, self.way(pulse.time), pulse.delay)
            })
        };
        let devices = Devices::new(assembly);
        let sheet = sheet(settings.size);
        let mut drawing = Drawing::new(sheet, TEXT);
        match settings.space {
            None => {
                let view = scenery.section_view(sheet, devices.has_bar());
                devices.draw(&mut drawing, &view);
                let place = |at: DVec3| view.place(at.truncate());
                let frame = view.frame();
                for front in wavefronts(trees) {
                    let front: Vec<DVec2> = front.into_iter().map(place).collect();
                    drawing.add_line("wavefront", front, rays::FRONT).within(vec![frame.to_vec()]);
                }
                rays::draw(&mut drawing, &place, &frame, trees);
                pulse::draw(&mut drawing, &place, &frame, &fronts(trees));
                // Words are read whatever runs over the things that they are about.
                drawing.elements.sort_by_key(|element| matches!(element.shape, Shape::Words(_)));
                if settings.window.is_some() {
                    view::cover_margins(&mut drawing, &frame);
                }
                devices.draw_bar(&mut drawing, view::bar(sheet));
                draw_axes(&mut drawing, sheet - AXES - DVec2::new(MARGIN, 4.0));
            }
            Some(from) => {
                let view = SpaceView::new(scenery, sheet, from);
                let layers = || trees.chunks(settings.rays as usize);
                let wavefronts: Vec<_> = layers().flat_map(wavefronts).collect();
                let pulse: Vec<_> = layers().flat_map(fronts).collect();
                let light = Light { trees, wavefronts: &wavefronts, pulse: &pulse };
                solids::draw(&mut drawing, &view, assembly, &light, scenery);
            }
        }
        view::draw_key(&mut drawing, settings, pulse);
        drawing
    }

    /// From when to when a pulse is in the part of the cross-section that is shown, ns: until the last of
    /// the light that leaves the devices has left it. `None` if it never is, or nobody knows when.
    #[must_use]
    pub fn seen(&self, delay: Delay) -> Option<[f64; 2]> {
        let seen = pulse::seen(&self.trees, &self.scenery, delay)?;
        Some(seen.map(|way| (way - self.before()) / SPEED_OF_LIGHT))
    }

    /// How far a pulse has come at a time (ns), from where the rays start, cm.
    fn way(&self, time: f64) -> f64 {
        time * SPEED_OF_LIGHT + self.before()
    }

    /// The way of the rays up to where a pulse is at the time 0, cm.
    fn before(&self) -> f64 {
        match self.settings.source {
            Source::Parallel { .. } => self.scenery.start(),
            Source::Point(_) | Source::Camera => 0.0,
        }
    }
}

fn check(settings: &DiagramSettings) -> Result<(), DiagramError> {
    let refuse = |name, value, allowed| Err(DiagramError::Setting { name, value, allowed });
    let rays = u64::from(settings.rays) * u64::from(settings.layers);
    if rays == 0 || rays > u64::from(MOST_RAYS) {
        return refuse("the number of rays", rays as f64, "from 1 to 2000");
    }
    if let Some([low, high]) = settings.window {
        let size = (high - low).min_element();
        if !(size > 0.0 && low.is_finite() && high.is_finite()) {
            return refuse(WINDOW, size, "above 0");
        }
    }
    for (name, value) in [
        ("the width of the bundle", settings.width),
        (WAVEFRONTS, settings.wavefronts),
        ("the least power", Some(settings.min_power)),
    ] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return refuse(name, value, "above 0");
        }
    }
    let numbers = match settings.source {
        Source::Parallel { degrees } => vec![degrees],
        Source::Point(point) => point.to_array().to_vec(),
        Source::Camera => Vec::new(),
    };
    match numbers.into_iter().chain(settings.z).find(|number| !number.is_finite()) {
        Some(number) => refuse("a coordinate or an angle", number, "a finite number"),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
