//! Bodies: slabs, boxes, balls and round cylinders of any homogeneous medium, or opaque ones.
//!
//! Bodies may stand in one another: where some overlap, the one of the largest priority is there. So a rod in a
//! glass of water is three bodies, and light goes from one into the other without any air between.

use super::{Body, BodyShape, Entry, Fact, Filling, Hull, REACH, Request, Structure, Surface};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::DVec3;
use num_complex::Complex64;
use optics::geometry::{Cylinder, Extent, Outline, Solid, Sphere};

pub(super) static ENTRY: Entry = Entry {
    kind: "body",
    title: "Body",
    summary: "A slab, box, ball or round cylinder of any homogeneous medium, of negative index too, or an \
              opaque one. Where bodies overlap, the one of the larger priority is there: a rod in a \
              glass of water is three bodies. After Dolling, Wegener, Linden & Hormann, Opt. Express 14, \
              1842 (2006).",
    keys: &[
        Key {
            name: "shape",
            doc: "Its shape, centred on `position`; a slab stands across x and is endless along y and z, the \
                  axis of a cylinder is z.",
            kind: KeyKind::Choice { options: &["slab", "box", "sphere", "cylinder"] },
        },
        Key {
            name: "thickness",
            doc: "Thickness of a slab, along x.",
            kind: KeyKind::Number { default: Some(5.0), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "size",
            doc: "Size of a box along x, y and z.",
            kind: KeyKind::Vector { default: [10.0; 3], unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "radius",
            doc: "Radius of a sphere or cylinder.",
            kind: KeyKind::Number { default: Some(5.0), unit: "cm", limits: Limits::LENGTH },
        },
        super::PERMITTIVITY_KEY,
        super::PERMEABILITY_KEY,
        Key {
            name: "group_index",
            doc: "Speed of light over the speed of a pulse in it, for times of flight; where it is absent, \
                  the size of the index, 1 at least.",
            kind: KeyKind::Number { default: None, unit: "", limits: Limits::Within(1.0, 1e9) },
        },
        Key {
            name: "priority",
            doc: "Where bodies overlap, the one of the larger priority is there.",
            kind: KeyKind::Integer { default: 0, min: -1_000_000, max: 1_000_000 },
        },
        Key {
            name: "surface",
            doc: "What an opaque body shows: { color = [red, green, blue] }, linear, or { image = \"file\" }: \
                  whole and upright on each face of a box and each end of a cylinder, once around a sphere or \
                  the side of a cylinder.",
            kind: KeyKind::Table { keys: SURFACE_KEYS },
        },
    ],
    build,
    facts,
};

static SURFACE_KEYS: &[Key] = &[
    Key {
        name: "color",
        doc: "Linear red, green and blue that it sends out everywhere.",
        kind: KeyKind::Vector { default: [0.5; 3], unit: "", limits: Limits::Within(0.0, 1e30) },
    },
    Key {
        name: "image",
        doc: "An image on it instead of a color: `builtin:bookshelf` or a file (PNG, JPEG, EXR), relative to \
              the scene file.",
        kind: KeyKind::Image { default: None },
    },
];

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    super::refuse_other_views(request, "a body is no cloak")?;
    let shape = shape(values, request.length)?;
    let filling = filling(values)?;
    if matches!(filling, Filling::Opaque(Surface::Image(_))) && shape.is_endless() {
        let message = "an endless body has no place for an image; give a cylinder its `length`, and take a \
                       box instead of a slab";
        return Err(KeyError::at("surface", message));
    }
    let solid = match shape {
        BodyShape::Ball(sphere) => Solid::ball(sphere.radius),
        BodyShape::Cylinder(cylinder) => Solid::cylinder(cylinder.radius, cylinder.extent),
        BodyShape::Box { half } => {
            let near = half.min(DVec3::splat(REACH));
            let outline = Outline::rectangle(near.x, near.y);
            Solid::Prism { outline, extent: Extent { min: -half.z, max: half.z } }
        }
    };
    let body = Body { shape, filling, priority: values.integer("priority") };
    let (cells, skin) = (Vec::new(), Vec::new());
    Ok(Structure { cells, skin, hull: Hull::new(solid).of_body(body) })
}

fn shape(values: &Values, length: Option<f64>) -> Result<BodyShape, KeyError> {
    let shape = values.choice("shape");
    let own: &[&str] = match shape {
        "slab" => &["thickness"],
        "box" => &["size"],
        _ => &["radius"],
    };
    for key in ["thickness", "size", "radius"] {
        if values.is_given(key) && !own.contains(&key) {
            let message = format!("a {shape} has no {key}; it has {}", own.join(", "));
            return Err(KeyError::at(key, message));
        }
    }
    if length.is_some() && matches!(shape, "box" | "sphere") {
        let message = format!("a {shape} has no length; it has {}", own.join(", "));
        return Err(KeyError::at("length", message));
    }
    let extent = Extent::centred(length);
    let radius = values.number("radius");
    Ok(match shape {
        "slab" => {
            let half = 0.5 * values.number("thickness");
            BodyShape::Box { half: DVec3::new(half, f64::INFINITY, extent.max) }
        }
        "box" => BodyShape::Box { half: DVec3::from_array(values.vector("size")) * 0.5 },
        "sphere" => BodyShape::Ball(Sphere { radius }),
        _ => BodyShape::Cylinder(Cylinder { radius, extent }),
    })
}

fn filling(values: &Values) -> Result<Filling, KeyError> {
    let Some(surface) = values.table("surface") else {
        let medium = super::medium(values)?;
        return Ok(Filling::Medium { medium, group_index: values.optional_number("group_index") });
    };
    let of_media = ["permittivity", "permeability", "group_index"];
    if let Some(key) = of_media.into_iter().find(|key| values.is_given(key)) {
        let message = format!("a body with a surface of its own is opaque; it has no {key}");
        return Err(KeyError::at(key, message));
    }
    let Some(image) = surface.optional_image("image") else {
        return Ok(Filling::Opaque(Surface::Color(surface.vector("color"))));
    };
    if surface.is_given("color") {
        let message = "color and image are both given; a surface takes one of them";
        return Err(KeyError::at("surface", message));
    }
    Ok(Filling::Opaque(Surface::Image(image.clone())))
}

fn facts(values: &Values) -> Vec<Fact> {
    let entry = |key: &str| {
        let tensor = values.tensor(key);
        let size = tensor.re.x_axis.x;
        let scalar = tensor == Complex64::new(size, tensor.im.x_axis.x).into();
        scalar.then_some(Complex64::new(size, tensor.im.x_axis.x))
    };
    let mut facts = vec![Fact::number("priority", values.integer("priority") as f64)];
    if let (Some(e), Some(m)) = (entry("permittivity"), entry("permeability")) {
        // The product of the roots with positive imaginary parts is that of the wave that decays.
        let root = |value: Complex64| {
            let root = value.sqrt();
            if root.im < 0.0 { -root } else { root }
        };
        let index = root(e) * root(m);
        facts.push(Fact::number("index", index.re));
        facts.push(Fact::number("index_imaginary_part", index.im));
    }
    facts
}
