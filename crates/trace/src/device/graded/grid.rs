//! Media on a grid in space, and uniaxial ones.

use super::{Graded, GradedShape, HIDES_NOTHING, here, upright_box};
use crate::device::{Convex, Fact, FarSide, Request, Show, Structure, refuse_other_views, spatial};
use crate::key;
use crate::keys::{KeyError, Samples, shape_text};
use glam::DVec3;
use optics::geometry::{Cylinder, Extent, Outline, Sphere};
use optics::propagation::{Anisotropy, AxisField, Extraordinary, SpaceSpline, SpatialMedium};

/// The most samples of an index: 256 along each axis of a cube, with splines of 128 MiB each.
const MOST_SAMPLES: usize = 1 << 24;

/// The grid in space, centred on the origin: one layer along z where nothing depends on that.
struct Grid {
    shape: Convex,
    /// Half its size, along z infinite where it has no end.
    half: DVec3,
    /// Where its first sample is, the steps from sample to sample, and how many there are.
    corner: DVec3,
    spacing: DVec3,
    count: [usize; 3],
}

/// Refuses grids that take too much memory.
pub(super) fn not_too_many(samples: &Samples) -> Result<(), KeyError> {
    let count = samples.values().len();
    let message = format!(
        "index has {count} numbers, {}; at most {MOST_SAMPLES} are taken: take a coarser grid, the \
         spline between its samples is smooth",
        shape_text(samples.shape())
    );
    KeyError::refuse_if(count > MOST_SAMPLES, key!(Graded.index), message)
}

impl Grid {
    fn new(device: &Graded, samples: &Samples, request: Request) -> Result<Self, KeyError> {
        not_too_many(samples)?;
        let in_space = samples.shape().len() == 3;
        let message = format!(
            "index has three dimensions, {}; say with `length` how long the grid is along z, cm",
            shape_text(samples.shape())
        );
        KeyError::refuse_if(in_space && request.length.is_none(), key!(Request.length), message)?;
        let message = format!(
            "inner is {} cm; a metal core takes an index of two dimensions, without a ratio: leave \
             inner out",
            device.inner
        );
        KeyError::refuse_if(device.inner > 0.0, key!(Graded.inner), message)?;
        let length = request.length.unwrap_or(f64::INFINITY);
        let half = 0.5 * DVec3::new(device.width, device.height, length);
        let extent = Extent::centred(request.length);
        let shape = match device.shape {
            GradedShape::Rectangle => Convex::Box { half },
            GradedShape::Circle => {
                Convex::Cylinder(Cylinder { radius: half.x.min(half.y), extent })
            }
            GradedShape::Ball if in_space => Convex::Ball(Sphere { radius: half.min_element() }),
            GradedShape::Ball => {
                let message = "shape is \"ball\", which takes an index of three dimensions: in the place of \
                               each number a list of them, one for each z";
                return Err(KeyError::at(key!(Graded.shape), message));
            }
        };
        let count = match *samples.shape() {
            [nx, ny, nz] => [nx, ny, nz],
            [nx, ny] => [nx, ny, 1],
            _ => [0; 3],
        };
        let steps = DVec3::from_array(count.map(|count| count as f64 - 1.0));
        let mut corner = -half;
        let mut spacing = 2.0 * half / steps;
        if !in_space {
            (corner.z, spacing.z) = (0.0, 1.0);
        }
        Ok(Self { shape, half, corner, spacing, count })
    }

    fn spline<const C: usize>(&self, samples: &[[f64; C]]) -> Result<SpaceSpline<C>, KeyError> {
        SpaceSpline::new(self.corner, self.spacing, self.count, samples)
            .map_err(|error| KeyError::at(key!(Graded.index), format!("index: {error}")))
    }

    /// Whether a cell of the grid, from its lowest corner to its highest, has a part within the
    /// border.
    fn reaches(&self, low: DVec3, high: DVec3) -> bool {
        let nearest = DVec3::ZERO.clamp(low, high);
        match self.shape {
            Convex::Ball(sphere) => nearest.length() <= sphere.radius,
            Convex::Cylinder(cylinder) => nearest.truncate().length() <= cylinder.radius,
            Convex::Box { .. } | Convex::CutBall(_) => true,
        }
    }

    /// Whether a sample is within the border.
    fn holds(&self, number: usize) -> bool {
        let [_, ny, nz] = self.count;
        let place = [number / (ny * nz), number / nz % ny, number % nz].map(|at| at as f64);
        let at = self.corner + self.spacing * DVec3::from_array(place);
        self.reaches(at, at)
    }

    /// The spline of squares, which fall to 0 nowhere.
    fn squares(
        &self,
        squares: impl Iterator<Item = f64>,
        key: &'static str,
        name: &str,
    ) -> Result<SpaceSpline<1>, KeyError> {
        let spline = self.spline(&squares.map(|square| [square]).collect::<Vec<_>>())?;
        let positive = spline.is_positive(|low, high| self.reaches(low, high), |_| [1.0]);
        let message = format!(
            "between the samples {name} falls to 0; take a finer grid, or larger least numbers"
        );
        KeyError::refuse_if(!positive, key, message)?;
        Ok(spline)
    }

    /// The size of the shape, cm; across z where that has no end.
    fn size(&self) -> f64 {
        let half = if self.half.z.is_finite() { self.half } else { self.half.with_z(0.0) };
        2.0 * half.length()
    }
}

pub(super) fn structure(device: &Graded, request: Request) -> Result<Structure, KeyError> {
    let extent = Extent::centred(request.length);
    let floor = device.floor(extent)?;
    if !floor.is_there() {
        refuse_other_views(request, HIDES_NOTHING)?;
    } else if request.show != Show::Cloak {
        return floor.alone();
    }
    let samples = device.samples()?;
    let grid = Grid::new(device, samples, request)?;
    let squares = samples.values().iter().map(|index| index * index);
    let square = grid.squares(squares, key!(Graded.index), "the index")?;
    let medium = SpatialMedium { square, anisotropy: anisotropy(device, samples, &grid)? };
    let mut filled = spatial::filled(grid.shape, medium, grid.size());
    if floor.is_there() {
        // Its sides one by one: the lowest is the floor's.
        let outline = Outline::rectangle(grid.half.x, grid.half.y);
        filled.surfaces =
            upright_box((0.0, FarSide::Outside), &outline, extent, FarSide::Region(0));
    }
    floor.under(filled, 0.0)
}

/// What makes the medium uniaxial, if it is.
fn anisotropy(
    device: &Graded,
    index: &Samples,
    grid: &Grid,
) -> Result<Option<Anisotropy>, KeyError> {
    let [ratio_key, axis_key] = [key!(Graded.ratio), key!(Graded.optic_axis)];
    let ratio = here(device.ratio.as_ref(), ratio_key)?;
    let axis = here(device.optic_axis.as_ref(), axis_key)?;
    let (ratio, axis) = match (ratio, axis) {
        (None, None) => return Ok(None),
        (Some(ratio), Some(axis)) => (ratio, axis),
        (Some(_), None) => {
            let message = "there is a ratio, and no optic_axis: give a direction [x, y, z], or one for each \
                           number of index";
            return Err(KeyError::at(axis_key, message));
        }
        (None, Some(_)) => {
            let message = "there is an optic_axis, and no ratio: give the index along the axis over the one \
                           across it";
            return Err(KeyError::at(ratio_key, message));
        }
    };
    let extraordinary = match ratio.shape() {
        [] => Extraordinary::Ratio(ratio.values()[0].powi(2)),
        shape if shape == index.shape() => {
            let numbers = index.values().iter().zip(ratio.values());
            let squares = numbers.map(|(index, ratio)| (index * ratio).powi(2));
            let name = "the index along the axis";
            Extraordinary::Square(grid.squares(squares, ratio_key, name)?)
        }
        shape => {
            let message = format!(
                "ratio is {}, index {}; it must be one number, or as many as index has",
                shape_text(shape),
                shape_text(index.shape())
            );
            return Err(KeyError::at(ratio_key, message));
        }
    };
    let axis = axes(axis, index, grid)?;
    // Without birefringence both waves are one.
    let is_isotropic = matches!(extraordinary, Extraordinary::Ratio(1.0));
    Ok((!is_isotropic).then_some(Anisotropy { extraordinary, axis }))
}

/// The optic axes of a key.
fn axes(axes: &Samples, index: &Samples, grid: &Grid) -> Result<AxisField, KeyError> {
    let refused = |message: String| KeyError::at(key!(Graded.optic_axis), message);
    let of_angle = |angle: &f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        DVec3::new(cos, sin, 0.0)
    };
    let values = axes.values();
    let direction = |number: usize, vector: &[f64]| {
        let vector = DVec3::from_slice(vector);
        vector.try_normalize().ok_or_else(|| {
            let place = axes.place(3 * number);
            let place = place.rsplit_once('[').map_or("", |(place, _)| place);
            refused(format!("optic_axis{place} is [0, 0, 0], which has no direction"))
        })
    };
    let numbered = || values.chunks_exact(3).enumerate();
    let mut found: Vec<DVec3> = match axes.shape() {
        [] => return Ok(AxisField::Constant(of_angle(&values[0]))),
        [3] => return Ok(AxisField::Constant(direction(0, values)?)),
        shape if shape == index.shape() => values.iter().map(of_angle).collect(),
        [shape @ .., 3] if shape == index.shape() => numbered()
            .map(|(number, vector)| direction(number, vector))
            .collect::<Result<_, _>>()?,
        shape => {
            let (own, index) = (shape_text(shape), shape_text(index.shape()));
            return Err(refused(format!(
                "optic_axis is {own}, index {index}; it must be one angle, one direction [x, y, z], \
                 or as many of either as index has numbers: {index}, or {index} x 3"
            )));
        }
    };
    align(&mut found, grid.count).map_err(|number| {
        let place = index.place(number);
        refused(format!(
            "near the axis of index{place} the optic axis turns by more than 60 degrees from sample to \
             sample; take a finer grid, or axes that turn less: around a line where they have no \
             direction they cannot be smooth"
        ))
    })?;
    let vectors: Vec<[f64; 3]> = found.iter().map(|axis| axis.to_array()).collect();
    let spline = grid.spline(&vectors)?;
    let sound = spline.is_positive(|low, high| grid.reaches(low, high), |middle| middle);
    let message = "between the samples the optic axis has no direction; take a finer grid";
    KeyError::refuse_if(!sound, key!(Graded.optic_axis), message)?;
    Ok(AxisField::Spline(spline))
}

/// The least product of neighbouring axes, the cosine of the angle between them.
const LEAST_PRODUCT: f64 = 0.5;

/// Gives axes, which have no sense, those in which neighbours are near each other, those along z
/// being side by side; the number of one that is not.
fn align(axes: &mut [DVec3], [_, ny, nz]: [usize; 3]) -> Result<(), usize> {
    let steps = [1, nz, ny * nz];
    let place = |number: usize| [number % nz, number / nz % ny, number / (ny * nz)];
    for number in 1..axes.len() {
        let before = (0..3).find(|axis| place(number)[*axis] > 0).map(|axis| number - steps[axis]);
        if before.is_some_and(|before| axes[before].dot(axes[number]) < 0.0) {
            axes[number] = -axes[number];
        }
        let turned = |axis: &usize| {
            place(number)[*axis] > 0
                && axes[number - steps[*axis]].dot(axes[number]) < LEAST_PRODUCT
        };
        if (0..3).any(|axis| turned(&axis)) {
            return Err(number);
        }
    }
    Ok(())
}

pub(super) fn facts(device: &Graded, request: Request) -> Vec<Fact> {
    let Ok(samples) = device.samples() else { return Vec::new() };
    let Ok(grid) = Grid::new(device, samples, request) else { return Vec::new() };
    let range = |values: &[f64]| {
        let within = values.iter().enumerate().filter(|(number, _)| grid.holds(*number));
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        within.fold(start, |[low, high], (_, value)| [low.min(*value), high.max(*value)])
    };
    let mut facts = Vec::new();
    let mut add = |names: [&'static str; 2], [least, largest]: [f64; 2]| {
        if least.is_finite() {
            facts.push(Fact::number(names[0], least));
            facts.push(Fact::number(names[1], largest));
        }
    };
    add(["index_min", "index_max"], range(samples.values()));
    if let Ok(Some(ratio)) = here(device.ratio.as_ref(), key!(Graded.ratio)) {
        let of_all = || [ratio.values()[0]; 2];
        let many = ratio.shape() == samples.shape();
        let ratios = if many { range(ratio.values()) } else { of_all() };
        add(["ratio_min", "ratio_max"], ratios);
    }
    facts
}
