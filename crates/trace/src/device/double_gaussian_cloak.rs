//! The double-Gaussian cloak: two Gaussian carpet cloaks back to back (design (iv) of Halimeh &
//! Wegener, Opt. Express 21, 9457 (2013), after Leonhardt, Science 312, 1777 (2006) and Schmied,
//! Halimeh & Wegener, Opt. Express 18, 24361 (2010)).
//!
//! A rectangle of locally isotropic graded index around a metal lens; the index is n = c/|f'| of
//! the map [`GaussianMap`], in the lower half that of its mirror image. At the cut the index steps.

use super::{
    Coating, ConformalRegion, Device, Fact, FarSide, Hull, Part, Region, Request, Shape, Show,
    Structure, Surface, carpet,
};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::{DVec2, DVec3};
use optics::geometry::{
    Cap, CurvedSide, Extent, FloorCurve, Hole, MetalBack, Outline, Pose, Solid, Wall,
};
use optics::propagation::{ConformalFlow, Half};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

crate::table! {
    /// Unidirectional, polarization-independent cloak of locally isotropic graded index around a
    /// metal lens, from a conformal map. Design (iv) of Halimeh & Wegener 2013.
    pub struct DoubleGaussianCloak {
        /// Width parameter of the map.
        w: f64 = 10.02, "cm", in ValueRange::LENGTH,
        /// Half the height of the metal lens; below 0.886 w.
        h: f64 = 4.25, "cm", in ValueRange::LENGTH,
        /// Size of the cut along x.
        width: f64 = 50.0, "cm", in ValueRange::LENGTH,
        /// Size of the cut along y; above twice h.
        height: f64 = 57.14, "cm", in ValueRange::LENGTH,
        /// Reflect at the cut, and at the border of an open core, as the index step asks for; false
        /// is a perfect antireflection coating.
        fresnel: bool = true,
        /// Divide the index by its minimum, so that it is 1 at least.
        referenced: bool,
    }
}

impl DoubleGaussianCloak {
    /// The map and the cut of the upper half.
    fn parts(&self) -> Result<(GaussianMap, Truncation), KeyError> {
        let map = carpet::gaussian_map(self.w, self.h)?;
        let (height, metal) = (self.height, 2.0 * map.height);
        let message = format!(
            "height is {height} cm; it must be above twice h, {metal} cm, to hold the metal"
        );
        KeyError::refuse_if(height <= metal, key!(Self.height), message)?;
        Ok((map, Truncation::centred(self.width, height / 2.0)))
    }

    /// The factor c of the index n = c/|f'|.
    fn index_scale(&self, map: &ConformalMap, cut: &Truncation) -> f64 {
        if self.referenced { 1.0 / map.index_range(cut).0 } else { 1.0 }
    }
}

impl Device for DoubleGaussianCloak {
    const KIND: &'static str = "double-gaussian-cloak";
    const TITLE: &'static str = "Double-Gaussian cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let (map, cut) = self.parts()?;
        let map = ConformalMap::Gaussian(map);
        let extent = Extent::centred(request.length);
        Ok(match request.show {
            Show::Cloak => {
                let coating = if self.fresnel { Coating::None } else { Coating::Antireflection };
                let index_scale = self.index_scale(&map, &cut);
                let flow = ConformalFlow::new(map, cut, extent, index_scale);
                cloak(&flow, coating, extent, request.has_open_core())
            }
            Show::Bare => {
                let around = Outline::rectangle(cut.x_max, map.peak());
                let curve = FloorCurve::new(map, MetalBack::MirrorImage, cut.x_min, cut.x_max);
                carpet::metal(curve, around, extent)
            }
            Show::Mirror => super::flat_strip(cut.x_max, extent),
            Show::Empty => Structure::empty(),
        })
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok((gaussian, cut)) = self.parts() else { return Vec::new() };
        let map = ConformalMap::Gaussian(gaussian);
        let c = self.index_scale(&map, &cut);
        let areas = [
            Fact::number("cloaked_area_cm2", 2.0 * gaussian.area()),
            Fact::number("cloaked_area_within_cut_cm2", 2.0 * map.area_within(&cut)),
        ];
        carpet::facts(&map, &cut, c, &areas)
    }
}

fn cloak(flow: &ConformalFlow, coating: Coating, extent: Extent, open_core: bool) -> Structure {
    let cut = flow.cut();
    let (x, y) = (cut.x_max, cut.y_max);
    let outline = Outline::rectangle(x, y);
    // The metal, or the core, ends bluntly at the cut.
    let tip = flow.map().floor_height_at(x);
    let wall = |from: [f64; 2], to: [f64; 2], far: FarSide| {
        let wall = Wall::new(DVec2::from(from), DVec2::from(to), extent);
        Surface { coating, ..Surface::wall(wall, far) }
    };
    let (upper, lower) = (FarSide::Region(0), FarSide::Region(1));
    let mut surfaces = vec![
        wall([x, -y], [x, -tip], lower),
        wall([x, tip], [x, y], upper),
        wall([x, y], [-x, y], upper),
        wall([-x, y], [-x, tip], upper),
        wall([-x, -tip], [-x, -y], lower),
        wall([-x, -y], [x, -y], lower),
    ];
    let floor = if open_core { FarSide::Outside } else { FarSide::Conductor };
    if !open_core {
        surfaces.push(wall([x, -tip], [x, tip], floor));
        surfaces.push(wall([-x, tip], [-x, -tip], floor));
    }
    for cap in extent.ends().into_iter().flat_map(|ends| Cap::both(&outline, ends)) {
        let cap =
            |far, part| Surface { part, coating, ..Surface::new(Shape::Cap(cap.clone()), far) };
        let map = || flow.map().clone();
        surfaces.push(cap(upper, Part::AboveFloor(map(), Half::Upper)));
        surfaces.push(cap(lower, Part::AboveFloor(map(), Half::Lower)));
        if !open_core {
            surfaces.push(cap(floor, Part::BelowFloor { map: map(), mirrored: true }));
        }
    }
    let regions = [Half::Upper, Half::Lower]
        .map(|half| {
            let region = ConformalRegion::new(flow.clone(), half, floor);
            Region::Conformal(ConformalRegion { coating, ..region })
        })
        .to_vec();
    let whole = Solid::Prism { outline, extent };
    if !open_core {
        return Structure::new(regions, surfaces, Hull::new(whole));
    }
    let curve = FloorCurve::new(flow.map().clone(), MetalBack::MirrorImage, cut.x_min, x);
    for (side, far) in [(CurvedSide::Floor, upper), (CurvedSide::Image, lower)] {
        let shape = Shape::Curve { curve: curve.clone(), side: Some(side), extent };
        surfaces.push(Surface { coating, ..Surface::new(shape, far) });
    }
    let hole = Hole::Lens { curve, pose: Pose::new(DVec3::ZERO, 0.0), extent };
    Structure::new(regions, surfaces, Hull::around(hole, whole))
}
