//! What balls and round cylinders have in common.

use super::{Beyond, Cell, Hull, RadialCell, Request, Skin, Structure};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use optics::geometry::{Cylinder, Extent, Hole, Solid, Sphere};
use optics::propagation::RadialFlow;

/// The one cell of a device of a single radial medium.
const CELL: u16 = 0;

/// How near to 0 and to the outer radius the inner one may come, relative to the outer one: beyond, the
/// tensors are too lopsided for double precision.
const THINNEST: f64 = 0.001;

/// The key `radius` of a ball.
pub(super) const RADIUS_KEY: Key = Key {
    name: "radius",
    doc: "Radius of the ball.",
    kind: KeyKind::Number { default: Some(10.0), unit: "cm", limits: Limits::LENGTH },
};

/// The key `inner` of a cloak.
pub(super) const fn inner_key(doc: &'static str) -> Key {
    let kind = KeyKind::Number { default: Some(4.0), unit: "cm", limits: Limits::LENGTH };
    Key { name: "inner", doc, kind }
}

/// The key `outer` of a cloak.
pub(super) const OUTER_KEY: Key = Key {
    name: "outer",
    doc: "Radius of the cloak.",
    kind: KeyKind::Number { default: Some(10.0), unit: "cm", limits: Limits::LENGTH },
};

/// The radii of the keys `inner` and `outer`.
pub(super) fn radii(values: &Values) -> Result<(f64, f64), KeyError> {
    let (inner, outer) = (values.number("inner"), values.number("outer"));
    let (least, most) = (THINNEST * outer, (1.0 - THINNEST) * outer);
    if !(least..=most).contains(&inner) {
        let message = format!(
            "inner is {inner} cm; it must be from {least} to {most} cm, {THINNEST} to {} times outer",
            1.0 - THINNEST
        );
        return Err(KeyError::at("inner", message));
    }
    Ok((inner, outer))
}

/// Refuses what a ball cannot have.
pub(super) fn no_length(request: Request) -> Result<(), KeyError> {
    match request.length {
        None => Ok(()),
        Some(_) => Err(KeyError::at("length", "length is given; a ball has none but its diameter")),
    }
}

/// Refuses what a ball that hides nothing cannot have.
pub(super) fn lens_alone(request: Request) -> Result<(), KeyError> {
    super::refuse_other_views(request, "this ball hides no metal and imitates no mirror")?;
    no_length(request)
}

/// A ball filled with a medium, solid or around a metal core that no light comes to.
pub(super) fn ball(radius: f64, flow: RadialFlow) -> Structure {
    let sphere = Sphere { radius };
    Structure {
        cells: vec![Cell::Radial(RadialCell { flow, inner: Beyond::Conductor })],
        skin: vec![Skin::Sphere { sphere, beyond: Beyond::Cell(CELL) }],
        hull: Hull::new(Solid::ball(radius)),
    }
}

/// A ball filled with a medium around an open core.
pub(super) fn hollow_ball(core: f64, radius: f64, flow: RadialFlow) -> Structure {
    let filled = Solid::ball(radius);
    let solid = filled.clone().with_hole(Hole::Round(Solid::ball(core)));
    let [outer, inner] = [radius, core].map(|radius| Sphere { radius });
    let beyond = Beyond::Cell(CELL);
    Structure {
        cells: vec![Cell::Radial(RadialCell { flow, inner: Beyond::Air })],
        skin: vec![
            Skin::Sphere { sphere: outer, beyond },
            Skin::InnerSphere { sphere: inner, beyond },
        ],
        hull: Hull::new(solid).with_open_core(filled),
    }
}

/// A metal ball.
pub(super) fn metal_ball(radius: f64) -> Structure {
    let sphere = Sphere { radius };
    Structure {
        cells: Vec::new(),
        skin: vec![Skin::Sphere { sphere, beyond: Beyond::Conductor }],
        hull: Hull::new(Solid::ball(radius)),
    }
}

/// A round cylinder filled with a medium around a metal core.
pub(super) fn tube(core: f64, radius: f64, extent: Extent, flow: RadialFlow) -> Structure {
    let cell = Cell::Radial(RadialCell { flow, inner: Beyond::Conductor });
    let whole = Solid::cylinder(radius, extent);
    let skin = upright((core, Beyond::Conductor), radius, extent, Beyond::Cell(CELL));
    Structure { cells: vec![cell], skin, hull: Hull::new(whole) }
}

/// A round cylinder filled with a medium around an open core.
pub(super) fn hollow_tube(core: f64, radius: f64, extent: Extent, flow: RadialFlow) -> Structure {
    let cell = Cell::Radial(RadialCell { flow, inner: Beyond::Air });
    let filled = Solid::cylinder(radius, extent);
    let solid = filled.clone().with_hole(Hole::Round(Solid::cylinder(core, extent)));
    let mut skin = upright((core, Beyond::Air), radius, extent, Beyond::Cell(CELL));
    let cylinder = Cylinder { radius: core, extent };
    skin.push(Skin::InnerSide { cylinder, beyond: Beyond::Cell(CELL) });
    Structure { cells: vec![cell], skin, hull: Hull::new(solid).with_open_core(filled) }
}

/// A round metal cylinder.
pub(super) fn metal_cylinder(radius: f64, extent: Extent) -> Structure {
    let skin = upright((0.0, Beyond::Conductor), radius, extent, Beyond::Conductor);
    Structure { cells: Vec::new(), skin, hull: Hull::new(Solid::cylinder(radius, extent)) }
}

/// The side and the ends of a round cylinder, whose core has a radius and is something of its own.
pub(super) fn upright(
    core: (f64, Beyond),
    radius: f64,
    extent: Extent,
    beyond: Beyond,
) -> Vec<Skin> {
    let (core, beyond_core) = core;
    let cylinder = Cylinder { radius, extent };
    let mut skin = vec![Skin::Side { cylinder, beyond }];
    for disc in cylinder.ends().into_iter().flatten() {
        skin.push(Skin::Disc { disc, beyond, core, beyond_core });
    }
    skin
}
