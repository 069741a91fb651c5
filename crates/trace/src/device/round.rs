//! What balls and round cylinders have in common.

use super::{
    Coating, Convex, FarSide, Hull, Part, RadialRegion, Region, Request, Shape, Structure, Surface,
};
use crate::key;
use crate::keys::KeyError;
use optics::geometry::{Cylinder, Extent, Hole, Solid, Sphere};
use optics::propagation::RadialFlow;

/// How near to 0 and to the outer radius the inner one may come, relative to the outer one: beyond,
/// the tensors are too lopsided for double precision.
const THINNEST: f64 = 0.001;

/// Refuses an inner radius that is not within the outer one; `key` is that of the inner one.
pub(super) fn check_radii(key: &'static str, inner: f64, outer: f64) -> Result<(), KeyError> {
    let (least, most) = (THINNEST * outer, (1.0 - THINNEST) * outer);
    let message = format!(
        "inner is {inner} cm; it must be from {least} to {most} cm, {THINNEST} to {} times outer",
        1.0 - THINNEST
    );
    KeyError::refuse_if(!(least..=most).contains(&inner), key, message)
}

/// Refuses what a ball cannot have.
pub(super) fn no_length(request: Request) -> Result<(), KeyError> {
    let message = "length is given; a ball has none but its diameter";
    KeyError::refuse_if(request.length.is_some(), key!(Request.length), message)
}

/// Refuses what a ball that hides nothing cannot have.
pub(super) fn lens_alone(request: Request) -> Result<(), KeyError> {
    super::refuse_other_views(request, "this ball hides no metal and imitates no mirror")?;
    no_length(request)
}

/// A ball filled with a medium: solid, around a metal core that no light comes to, or around an
/// open core of a radius.
pub(super) fn ball(radius: f64, flow: RadialFlow, open_core: Option<f64>) -> Structure {
    let border = |shape| Surface::new(shape, FarSide::Region(0));
    let mut surfaces = vec![border(sphere(radius))];
    let solid = Solid::ball(radius);
    let (inner, hull) = match open_core {
        None => (FarSide::Conductor, Hull::new(solid)),
        Some(core) => {
            surfaces.push(border(Shape::BallHole(Sphere { radius: core })));
            (FarSide::Outside, Hull::around(Hole::Round(Solid::ball(core)), solid))
        }
    };
    radial(flow, inner, surfaces, hull)
}

/// A device that is one region of a radial medium.
fn radial(flow: RadialFlow, inner: FarSide, surfaces: Vec<Surface>, hull: Hull) -> Structure {
    let region = RadialRegion { flow, inner, coating: Coating::None };
    Structure::new(vec![Region::Radial(region)], surfaces, hull)
}

/// The border of a ball.
fn sphere(radius: f64) -> Shape {
    Shape::Convex(Convex::Ball(Sphere { radius }))
}

/// A metal ball.
pub(super) fn metal_ball(radius: f64) -> Structure {
    let surfaces = vec![Surface::new(sphere(radius), FarSide::Conductor)];
    Structure::new(Vec::new(), surfaces, Hull::new(Solid::ball(radius)))
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
    let hull = hull((core, inner), Solid::cylinder(radius, extent), extent, &mut surfaces);
    radial(flow, inner, surfaces, hull)
}

/// The hull of a device around a round core that has a radius and is something of its own; an open
/// one gets its border, that of the first region.
pub(super) fn hull(
    (radius, far_of_core): (f64, FarSide),
    whole: Solid,
    extent: Extent,
    surfaces: &mut Vec<Surface>,
) -> Hull {
    if far_of_core != FarSide::Outside {
        return Hull::new(whole);
    }
    let border = Shape::RoundHole(Cylinder { radius, extent });
    surfaces.push(Surface::new(border, FarSide::Region(0)));
    Hull::around(Hole::Round(Solid::cylinder(radius, extent)), whole)
}

/// A round metal cylinder.
pub(super) fn metal_cylinder(radius: f64, extent: Extent) -> Structure {
    let surfaces = upright((0.0, FarSide::Conductor), radius, extent, FarSide::Conductor);
    Structure::new(Vec::new(), surfaces, Hull::new(Solid::cylinder(radius, extent)))
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

/// A flat end around a core that has a radius and is something of its own; where that is outside,
/// nothing is there.
pub(super) fn pierced(end: &Shape, core: (f64, FarSide), far: FarSide) -> Vec<Surface> {
    let (radius, far_of_core) = core;
    let part = |far, part| Surface { part, ..Surface::new(end.clone(), far) };
    let mut surfaces = vec![part(far, Part::Without(radius))];
    if far_of_core != FarSide::Outside && radius > 0.0 {
        surfaces.push(part(far_of_core, Part::Within(radius)));
    }
    surfaces
}
