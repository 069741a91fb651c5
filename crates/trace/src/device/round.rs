//! What balls and round cylinders have in common.

use super::{FarSide, Hull, Part, RadialRegion, Region, Request, Shape, Structure, Surface};
use crate::key;
use crate::keys::KeyError;
use optics::geometry::{Cylinder, Extent, Hole, Solid, Sphere};
use optics::propagation::RadialFlow;

/// How near to 0 and to the outer radius the inner one may come, relative to the outer one: beyond, the
/// tensors are too lopsided for double precision.
const THINNEST: f64 = 0.001;

/// Refuses an inner radius that is not within the outer one; `key` is that of the inner one.
pub(super) fn check_radii(key: &'static str, inner: f64, outer: f64) -> Result<(), KeyError> {
    let (least, most) = (THINNEST * outer, (1.0 - THINNEST) * outer);
    if !(least..=most).contains(&inner) {
        let message = format!(
            "inner is {inner} cm; it must be from {least} to {most} cm, {THINNEST} to {} times outer",
            1.0 - THINNEST
        );
        return Err(KeyError::at(key, message));
    }
    Ok(())
}

/// Refuses what a ball cannot have.
pub(super) fn no_length(request: Request) -> Result<(), KeyError> {
    match request.length {
        None => Ok(()),
        Some(_) => {
            let message = "length is given; a ball has none but its diameter";
            Err(KeyError::at(key!(Request.length), message))
        }
    }
}

/// Refuses what a ball that hides nothing cannot have.
pub(super) fn lens_alone(request: Request) -> Result<(), KeyError> {
    super::refuse_other_views(request, "this ball hides no metal and imitates no mirror")?;
    no_length(request)
}

/// A ball filled with a medium: solid, around a metal core that no light comes to, or around an open core of a radius.
pub(super) fn ball(radius: f64, flow: RadialFlow, open_core: Option<f64>) -> Structure {
    let border = |radius| Surface::sphere(Sphere { radius }, FarSide::Region(0));
    let (mut surfaces, solid) = (vec![border(radius)], Solid::ball(radius));
    let (inner, hull) = match open_core {
        None => (FarSide::Conductor, Hull::new(solid)),
        Some(core) => {
            surfaces.push(border(core).from_behind());
            (FarSide::Outside, Hull::around(Hole::Round(Solid::ball(core)), solid))
        }
    };
    Structure { regions: vec![Region::Radial(RadialRegion { flow, inner })], surfaces, hull }
}

/// A metal ball.
pub(super) fn metal_ball(radius: f64) -> Structure {
    Structure {
        regions: Vec::new(),
        surfaces: vec![Surface::sphere(Sphere { radius }, FarSide::Conductor)],
        hull: Hull::new(Solid::ball(radius)),
    }
}

/// A round cylinder filled with a medium around a core of metal, or around an open one.
pub(super) fn tube(
    core: f64,
    radius: f64,
    extent: Extent,
    flow: RadialFlow,
    open_core: bool,
) -> Structure {
    let inner = if open_core { FarSide::Outside } else { FarSide::Conductor };
    let mut surfaces = upright((core, inner), radius, extent, FarSide::Region(0));
    let solid = Solid::cylinder(radius, extent);
    let hull = if open_core {
        surfaces.push(round_hole(core, extent));
        Hull::around(Hole::Round(Solid::cylinder(core, extent)), solid)
    } else {
        Hull::new(solid)
    };
    Structure { regions: vec![Region::Radial(RadialRegion { flow, inner })], surfaces, hull }
}

/// The border of an open core, in the first region.
pub(super) fn round_hole(radius: f64, extent: Extent) -> Surface {
    Surface::new(Shape::Round(Cylinder { radius, extent }), FarSide::Region(0)).from_behind()
}

/// A round metal cylinder.
pub(super) fn metal_cylinder(radius: f64, extent: Extent) -> Structure {
    let surfaces = upright((0.0, FarSide::Conductor), radius, extent, FarSide::Conductor);
    Structure { regions: Vec::new(), surfaces, hull: Hull::new(Solid::cylinder(radius, extent)) }
}

/// The side and the ends of a round cylinder, whose core has a radius and is something of its own.
pub(super) fn upright(
    core: (f64, FarSide),
    radius: f64,
    extent: Extent,
    far: FarSide,
) -> Vec<Surface> {
    let cylinder = Cylinder { radius, extent };
    let mut surfaces = vec![Surface::new(Shape::Round(cylinder), far)];
    for disc in cylinder.ends().into_iter().flatten() {
        surfaces.extend(pierced(&Shape::Disc(disc), core, far));
    }
    surfaces
}

/// A flat end around a core that has a radius and is something of its own; where that is outside, nothing is there.
pub(super) fn pierced(end: &Shape, core: (f64, FarSide), far: FarSide) -> Vec<Surface> {
    let (radius, far_of_core) = core;
    let part = |far, part| Surface::new(end.clone(), far).with_part(part);
    let mut surfaces = vec![part(far, Part::Beyond(radius))];
    if far_of_core != FarSide::Outside && radius > 0.0 {
        surfaces.push(part(far_of_core, Part::Within(radius)));
    }
    surfaces
}
