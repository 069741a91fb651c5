//! A graded medium of one's own: an index given on a grid, in the plane or in space, isotropic or
//! of two waves, the optic axis being given on the grid, too.
//!
//! Between the samples the square of the index is a bicubic or tricubic spline, whose second
//! derivatives are continuous; rays are followed through that, to the tolerance. At the border the
//! index steps to that of air, with refraction and Fresnel reflection.

mod grid;

use super::floor::Floor;
use super::round::{self, metal_cylinder, pierced, upright};
use super::{
    ConformalRegion, Device, Fact, FarSide, Region, Request, Shape, Show, Structure, Surface,
};
use crate::key;
use crate::keys::{KeyError, Sampled, Samples, ValueRange};
use glam::DVec2;
use optics::geometry::{Cap, Extent, Outline, Solid, Wall};
use optics::propagation::{ConformalFlow, Degree, GridSpline, Half, IndexPerturbation};
use optics::transformation::{ConformalMap, FlatMap, Truncation};
use std::f64::consts::PI;

crate::choice! {
    /// The border of a [`Graded`] device.
    pub enum GradedShape {
        /// The rectangle of the grid, or its box.
        Rectangle = "rectangle",
        /// The largest circle about the middle of the grid, across z.
        Circle = "circle",
        /// The largest ball about the middle of a grid in space.
        Ball = "ball",
    }
}

crate::table! {
    /// A device of one's own: any graded index, given on a grid over a rectangle or a disc and the
    /// same along z, around a metal cylinder or without one; or on a grid in space, over a box, a
    /// round cylinder or a ball. With a ratio of indices and optic axes the medium is uniaxial.
    pub struct Graded {
        /// The refractive index on a regular grid from border to border: rows of numbers, one row
        /// for each x from the least to the largest, in it one number for each y; four at least
        /// either way. In space, in the place of each number a list of them, one for each z; the
        /// device's length is that of the grid then. Or the name of a .npy file, relative to the
        /// scene file. Between them the square of the index is a cubic spline along each axis. In
        /// a uniaxial medium it is the index of the ordinary wave.
        index: Option<Sampled<2, 3>>, in ValueRange::Between(0.0, 1000.0),
        /// The index of fields along the optic axis over that of fields across it, which makes the
        /// medium uniaxial: one number, or one for each of index, or the name of a .npy file. The
        /// square of its product with the index is the spline then.
        ratio: Option<Sampled<0, 3>>, in ValueRange::Within(0.01, 100.0),
        /// The optic axis where there is a ratio, in the device's frame: one direction [x, y, z] or
        /// one angle from x towards y, degrees; or a direction or an angle for each number of index;
        /// or the name of a .npy file. Between them the vectors of length 1 are a cubic spline along
        /// each axis, of which the direction counts, and not the sense.
        optic_axis: Option<Sampled<0, 4>>, in ValueRange::Within(-1e6, 1e6),
        /// The border: the rectangle or the box of the grid, the largest circle about the middle of
        /// it, or the largest ball.
        shape: GradedShape,
        /// Size of the grid along x, from its first sample to its last.
        width: f64 = 40.0, "cm", in ValueRange::LENGTH,
        /// Size of the grid along y, from its first sample to its last.
        height: f64 = 40.0, "cm", in ValueRange::LENGTH,
        /// Radius of a metal cylinder along z in the middle, which the medium surrounds; 0 for
        /// none. The samples within go on smoothly for about ten steps of the grid; what they are
        /// beyond does not matter.
        inner: f64, "cm", in ValueRange::LENGTH_OR_ZERO,
        /// Whole width along x of a flat mirror floor under a rectangle or box, at its lower border
        /// y = -height / 2; at least that of the device, or 0 for none. It alone is what the device should
        /// look like. It is perfect, or of the device's `metal`.
        floor: f64, "cm", in ValueRange::LENGTH_OR_ZERO,
    }
}

/// What is said of a graded index of which there is no other view.
const HIDES_NOTHING: &str = "a graded index without a core or a floor hides no metal";

/// How near the core may come to the border, as a share of the way there.
const THINNEST: f64 = 0.001;

/// Of the size of the device, the length over which it varies at most.
const VARIES: f64 = 0.25;

/// The border of a device: it is centred on the z axis.
#[derive(Clone, Copy)]
struct Plan {
    /// Half the size of the grid along x and y, cm.
    half: DVec2,
    /// The radius of the border if it is round, cm.
    rim: Option<f64>,
    /// The radius of the core, if there is one, cm.
    core: Option<f64>,
}

impl Plan {
    fn new(device: &Graded) -> Result<Self, KeyError> {
        let half = 0.5 * DVec2::new(device.width, device.height);
        let nearest = half.min_element();
        let ball = device.shape == GradedShape::Ball;
        let message = "shape is \"ball\"; a ball takes an index of three dimensions, as does a list of \
                       numbers in the place of each";
        KeyError::refuse_if(ball, key!(Graded.shape), message)?;
        let rim = (device.shape == GradedShape::Circle).then_some(nearest);
        let inner = device.inner;
        let most = (1.0 - THINNEST) * nearest;
        let message =
            format!("inner is {inner} cm; it must be at most {most} cm, within the border");
        KeyError::refuse_if(inner > most, key!(Graded.inner), message)?;
        Ok(Self { half, rim, core: (inner > 0.0).then_some(inner) })
    }

    /// The area of the medium, cm².
    fn area(&self) -> f64 {
        let whole = self.rim.map_or(4.0 * self.half.x * self.half.y, |rim| PI * rim * rim);
        whole - self.core_area()
    }

    fn core_area(&self) -> f64 {
        self.core.map_or(0.0, |core| PI * core * core)
    }

    /// Whether the medium is at a point of the grid.
    fn holds(&self, at: DVec2) -> bool {
        let within = self.rim.is_none_or(|rim| at.length() <= rim);
        within && self.core.is_none_or(|core| at.length() >= core)
    }

    /// Where samples are: the first of them, and the steps along x and y.
    fn grid(&self, count: [usize; 2]) -> [DVec2; 2] {
        let steps = DVec2::new(count[0] as f64, count[1] as f64) - 1.0;
        [-self.half, 2.0 * self.half / steps]
    }

    fn structure(
        self,
        square: GridSpline,
        extent: Extent,
        open_core: bool,
    ) -> Result<Structure, KeyError> {
        let DVec2 { x, y } = self.half;
        // Beyond a round border, its box is not there.
        let margin = if self.rim.is_some() { 1.5 } else { 1.0 };
        let cut = Truncation { x_min: -margin * x, x_max: margin * x, y_max: margin * y };
        let map = ConformalMap::Flat(FlatMap::new(-margin * y, VARIES * (2.0 * x.max(y))));
        let reach = |[nearest, farthest]: [f64; 2]| {
            self.core.is_none_or(|core| farthest >= core)
                && self.rim.is_none_or(|rim| nearest <= rim)
        };
        let index_perturbation = IndexPerturbation::within(square, reach).ok_or_else(|| {
            let message = "between the samples the index falls to 0; take a finer grid, or a larger least index";
            KeyError::at(key!(Graded.index), message)
        })?;
        let flow = ConformalFlow::new(map, cut, extent, 1.0)
            .between(self.core, self.rim)
            .with_index_perturbation(index_perturbation);
        let far_of_core = if open_core { FarSide::Outside } else { FarSide::Conductor };
        let region = ConformalRegion::new(flow, Half::Upper, FarSide::Outside);
        let regions = vec![Region::Conformal(ConformalRegion { core: far_of_core, ..region })];
        let core = (self.core.unwrap_or(0.0), far_of_core);
        let far = FarSide::Region(0);
        let outline = Outline::rectangle(x, y);
        let (mut surfaces, whole) = match self.rim {
            Some(rim) => (upright(core, rim, extent, far), Solid::cylinder(rim, extent)),
            None => (upright_box(core, &outline, extent, far), Solid::Prism { outline, extent }),
        };
        let hull = round::hull(core, whole, extent, &mut surfaces);
        Ok(Structure::new(regions, surfaces, hull))
    }
}

/// The sides and the ends of a box with a round core, which has a radius and is something of its
/// own.
fn upright_box(
    core: (f64, FarSide),
    outline: &Outline,
    extent: Extent,
    far: FarSide,
) -> Vec<Surface> {
    let wall = |(from, to)| Surface::wall(Wall::new(from, to, extent), far);
    let ends = extent.ends().into_iter().flat_map(|ends| Cap::both(outline, ends));
    let ends = ends.flat_map(|cap| pierced(&Shape::Cap(cap), core, far));
    outline.sides().map(wall).chain(ends).collect()
}

/// The numbers of a key, which a file has been put in the place of.
pub(super) fn here<'d, const LEAST: usize, const MOST: usize>(
    sampled: Option<&'d Sampled<LEAST, MOST>>,
    key: &'static str,
) -> Result<Option<&'d Samples>, KeyError> {
    match sampled {
        None => Ok(None),
        Some(Sampled::Here(samples)) => Ok(Some(samples)),
        Some(Sampled::InFile(file)) => Err(KeyError::at(
            key,
            format!("{} has not been read; a device takes the numbers", file.display()),
        )),
    }
}

impl Graded {
    fn samples(&self) -> Result<&Samples, KeyError> {
        here(self.index.as_ref(), key!(Self.index))?.ok_or_else(|| {
            let message = "there is no `index`: rows of numbers, or the name of a .npy file";
            KeyError::general(message)
        })
    }

    /// The floor that it stands on.
    fn floor(&self, extent: Extent) -> Result<Floor, KeyError> {
        let floor = Floor { width: self.floor, level: -0.5 * self.height, extent };
        let round = floor.is_there() && self.shape != GradedShape::Rectangle;
        let message = "a round border does not stand on a floor; take shape = \"rectangle\"";
        KeyError::refuse_if(round, key!(Self.floor), message)?;
        Ok(floor)
    }

    /// Whether it is more than an isotropic index in the plane.
    fn is_spatial(&self) -> bool {
        let in_space =
            matches!(&self.index, Some(Sampled::Here(samples)) if samples.shape().len() == 3);
        in_space || self.ratio.is_some() || self.optic_axis.is_some()
    }
}

/// How many samples there are along x and y.
fn in_plane(samples: &Samples) -> [usize; 2] {
    let [nx, ny] = samples.shape() else { return [0; 2] };
    [*nx, *ny]
}

/// The square of the index.
fn square(plan: &Plan, samples: &Samples) -> Result<GridSpline, KeyError> {
    let [nx, ny] = in_plane(samples);
    grid::not_too_many(samples)?;
    let [corner, spacing] = plan.grid([nx, ny]);
    // Along x side by side.
    let along_x = (0..ny).flat_map(|j| (0..nx).map(move |i| samples.values()[i * ny + j].powi(2)));
    GridSpline::new(Degree::Three, corner, spacing, [nx, ny], &along_x.collect::<Vec<_>>())
        .map_err(|error| KeyError::at(key!(Graded.index), format!("index: {error}")))
}

impl Device for Graded {
    const KIND: &'static str = "graded";
    const TITLE: &'static str = "Graded index of one's own";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        if self.is_spatial() {
            return grid::structure(self, request);
        }
        let plan = Plan::new(self)?;
        let extent = Extent::centred(request.length);
        let message = "there is no core to open; `inner` is its radius";
        KeyError::refuse_if(
            request.has_open_core() && plan.core.is_none(),
            key!(Request.core),
            message,
        )?;
        let floor = self.floor(extent)?;
        let standing = match (request.show, plan.core) {
            (Show::Cloak, _) => {
                plan.structure(square(&plan, self.samples()?)?, extent, request.has_open_core())?
            }
            (Show::Bare, Some(core)) => metal_cylinder(core, extent),
            (Show::Mirror | Show::Empty, Some(_)) => Structure::empty(),
            (_, None) if floor.is_there() => Structure::empty(),
            (_, None) => {
                super::refuse_other_views(request, HIDES_NOTHING)?;
                Structure::empty()
            }
        };
        floor.under(standing, 0.0)
    }

    fn facts(&self, request: Request) -> Vec<Fact> {
        if self.is_spatial() {
            return grid::facts(self, request);
        }
        let Ok(plan) = Plan::new(self) else { return Vec::new() };
        let mut facts = vec![Fact::number("medium_area_cm2", plan.area())];
        if plan.core.is_some() {
            facts.push(Fact::number("cloaked_area_cm2", plan.core_area()));
        }
        if let Ok(samples) = self.samples() {
            let count @ [_, ny] = in_plane(samples);
            let [corner, spacing] = plan.grid(count);
            let place = |k: usize| corner + spacing * DVec2::new((k / ny) as f64, (k % ny) as f64);
            let within = samples.values().iter().enumerate().filter(|(k, _)| plan.holds(place(*k)));
            let start = (f64::INFINITY, 0.0_f64);
            let (least, largest) =
                within.fold(start, |(low, high), (_, n)| (low.min(*n), high.max(*n)));
            if least.is_finite() {
                facts.push(Fact::number("index_min", least));
                facts.push(Fact::number("index_max", largest));
            }
        }
        facts
    }
}
