//! What the carpet cloaks have in common: a rectangle of graded index on a bump of a mirror floor,
//! light from above (Li & Pendry, Phys. Rev. Lett. 101, 203901 (2008)).
//!
//! A carpet stands on the line y = 0 of its own frame, from which the thin floor goes on to its
//! left and right. Everything is a mirror on both sides: the floor, the bump, and the flat back of
//! the metal below it. The back lies on y = 0, for a grating at the depth of its troughs.

use super::{
    ConformalRegion, Fact, FarSide, GaussianCarpet, Hull, Part, Region, Request, Shape, Show,
    Structure, Surface,
};
use crate::key;
use crate::keys::KeyError;
use glam::DVec2;
use optics::geometry::{Cap, Extent, FloorCurve, MetalBack, Outline, Solid, Wall};
use optics::propagation::{ConformalFlow, Half};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

/// The map of width parameter `w` and height `h`.
pub(super) fn gaussian_map(w: f64, h: f64) -> Result<GaussianMap, KeyError> {
    GaussianMap::new(w, h).map_err(|error| KeyError::at(key!(GaussianCarpet.h), error.to_string()))
}

/// The rectangle a carpet is cut to, whose metal rises to `peak`, of a width along x and a height
/// above the floor's level; the floor may be wider, or 0 for none. All in cm.
///
/// # Errors
///
/// If the metal does not fit in, or the floor ends below the device.
pub(super) fn cut(
    [width, height]: [f64; 2],
    floor: f64,
    peak: f64,
) -> Result<Truncation, KeyError> {
    let message =
        format!("height is {height} cm; it must be above h, {peak} cm, to hold the metal");
    KeyError::refuse_if(height <= peak, key!(GaussianCarpet.height), message)?;
    let message = format!(
        "floor is {floor} cm; it must be at least as wide as the device, {width} cm, or 0 for none"
    );
    KeyError::refuse_if(floor > 0.0 && floor < width, key!(GaussianCarpet.floor), message)?;
    Ok(Truncation::centred(width, height))
}

/// A carpet in any view, on a floor so wide (cm); `index_scale` is c of its index c/|f'|.
pub(super) fn structure(
    map: ConformalMap,
    cut: Truncation,
    index_scale: f64,
    floor: f64,
    request: Request,
) -> Structure {
    let extent = Extent::centred(request.length);
    let site = Site { cut, half_floor: 0.5 * floor, extent };
    match request.show {
        Show::Cloak => site.cloak(ConformalFlow::new(map, cut, extent, index_scale)),
        Show::Bare => site.bare(map),
        // The flat mirror that the floor with the carpet should look like.
        Show::Mirror => super::flat_strip(site.half_floor.max(cut.x_max), extent),
        Show::Empty => Structure::empty(),
    }
}

/// The facts of a carpet, or of several that are alike: the range of its index c/|f'|, those of its
/// own, and how wide the mirror is.
pub(super) fn facts(map: &ConformalMap, cut: &Truncation, c: f64, own: &[Fact]) -> Vec<Fact> {
    let (least, largest) = map.index_range(cut);
    let index = [Fact::number("index_min", c * least), Fact::number("index_max", c * largest)];
    [&index, own, &[Fact::number("mirror_width_cm", 2.0 * cut.x_max)]].concat()
}

/// The metal below a floor, bare, in a prism around it: the outline, then the ends.
pub(super) fn metal(curve: FloorCurve, around: Outline, extent: Extent) -> Structure {
    let metal = |shape| Surface::new(shape, FarSide::Conductor);
    let mut surfaces = vec![metal(Shape::Curve { curve: curve.clone(), side: None, extent })];
    for cap in extent.ends().into_iter().flat_map(|ends| Cap::both(&around, ends)) {
        surfaces.push(Surface { part: Part::Metal(curve.clone()), ..metal(Shape::Cap(cap)) });
    }
    let hull = Hull { metal: Some(curve), ..Hull::new(Solid::Prism { outline: around, extent }) };
    Structure::new(Vec::new(), surfaces, hull)
}

/// Where a carpet stands.
struct Site {
    cut: Truncation,
    half_floor: f64,
    extent: Extent,
}

impl Site {
    fn cloak(&self, flow: ConformalFlow) -> Structure {
        let map = flow.map();
        let Truncation { x_max: x, y_max: top, .. } = self.cut;
        let bottom = map.trough();
        // The metal ends bluntly at the cut; in a trough it ends as high as the floor.
        let tip = map.floor_height_at(x).max(0.0);
        let mut surfaces = Vec::new();
        let medium = FarSide::Region(0);
        let mut wall = |from: [f64; 2], to: [f64; 2], far: FarSide| {
            if from != to {
                let wall = Wall::new(DVec2::from(from), DVec2::from(to), self.extent);
                surfaces.push(Surface::wall(wall, far));
            }
        };
        wall([x, tip], [x, top], medium);
        wall([x, top], [-x, top], medium);
        wall([-x, top], [-x, tip], medium);
        wall([-x, tip], [-x, bottom], FarSide::Conductor);
        wall([-x, bottom], [x, bottom], FarSide::Conductor);
        wall([x, bottom], [x, tip], FarSide::Conductor);
        let outline = self.box_between(bottom, top);
        for cap in self.extent.ends().into_iter().flat_map(|ends| Cap::both(&outline, ends)) {
            let cap = |far, part| Surface { part, ..Surface::new(Shape::Cap(cap.clone()), far) };
            let below = Part::BelowFloor { map: map.clone(), mirrored: false };
            surfaces.push(cap(FarSide::Conductor, below));
            surfaces.push(cap(medium, Part::AboveFloor(map.clone(), Half::Upper)));
        }
        let region = ConformalRegion::new(flow, Half::Upper, FarSide::Conductor);
        let hull = Hull::new(Solid::Prism { outline, extent: self.extent });
        self.on_floor(vec![Region::Conformal(region)], surfaces, hull)
    }

    fn bare(&self, map: ConformalMap) -> Structure {
        let [bottom, peak] = [map.trough(), map.peak()];
        let Truncation { x_min, x_max, .. } = self.cut;
        let tip = map.floor_height_at(x_max);
        let around = self.box_between(bottom, peak);
        let curve = FloorCurve::new(map, MetalBack::Flat(bottom), x_min, x_max);
        let Structure { mut surfaces, hull, .. } = metal(curve, around, self.extent);
        if tip < 0.0 {
            // A trough at the end is closed by a thin wall up to the floor.
            let closed = [x_min, x_max].map(|x| {
                let ends = [tip, 0.0].map(|y| DVec2::new(x, y));
                Surface::mirror(Wall::new(ends[0], ends[1], self.extent))
            });
            surfaces.splice(1..1, closed);
        }
        self.on_floor(Vec::new(), surfaces, hull)
    }

    /// The rectangle over the width of the device.
    fn box_between(&self, bottom: f64, top: f64) -> Outline {
        let Truncation { x_min, x_max, .. } = self.cut;
        let corners = [(x_min, bottom), (x_max, bottom), (x_max, top), (x_min, top)];
        Outline { corners: corners.map(DVec2::from).to_vec() }
    }

    /// Adds the floor on the left and on the right.
    fn on_floor(&self, regions: Vec<Region>, mut surfaces: Vec<Surface>, hull: Hull) -> Structure {
        let (inner, outer) = (self.cut.x_max, self.half_floor);
        if outer <= inner {
            return Structure::new(regions, surfaces, hull);
        }
        for side in [-1.0, 1.0] {
            let ends = [inner, outer].map(|x| DVec2::new(side * x, 0.0));
            surfaces.push(Surface::mirror(Wall::new(ends[0], ends[1], self.extent)));
        }
        let line = [-outer, outer].map(|x| DVec2::new(x, 0.0));
        let hull = hull.with_thin_mirror(Outline { corners: line.to_vec() }, self.extent);
        Structure::new(regions, surfaces, hull)
    }
}
