//! Bodies: slabs, boxes, balls and round cylinders of any homogeneous medium, of metal, or opaque
//! ones.
//!
//! Bodies may stand in one another: where some overlap, the one of the largest priority is there.
//! So a rod in a glass of water is three bodies, and light goes from one into the other without any
//! air between.

use super::{
    Body, Convex, Device, DispersiveMedium, Fact, FarSide, HomogeneousRegion, Hull, MediumWords,
    Region, RegionBorder, Request, Shape, Structure, Surface,
};
use crate::key;
use crate::keys::{Given, KeyError, ValueRange};
use glam::DVec3;
use num_complex::Complex64;
use optics::geometry::{Cylinder, Extent, Sphere};
use optics::medium::Tensor;
use std::path::PathBuf;

crate::choice! {
    /// The shape of a [`SolidBody`].
    pub enum BodyShape {
        /// It stands across x and is endless along y and z.
        Slab = "slab",
        /// Its sides are along x, y and z.
        Box = "box",
        /// A ball.
        Sphere = "sphere",
        /// Its axis is z.
        Cylinder = "cylinder",
    }
}

crate::table! {
    /// A slab, box, ball or round cylinder of any homogeneous medium, of negative index too, of
    /// `metal`, or an opaque one. Where bodies overlap, the one of the larger priority is there: a rod in a glass
    /// of water is three bodies. After Dolling, Wegener, Linden & Hormann, Opt. Express 14, 1842
    /// (2006).
    pub struct SolidBody with words: MediumWords {
        /// Its shape, centred on `position`; a slab stands across x and is endless along y and z,
        /// the axis of a cylinder is z.
        shape: BodyShape,
        /// Thickness of a slab, along x.
        thickness: Given<f64> = Given::by_default(5.0), "cm", in ValueRange::LENGTH,
        /// Size of a box along x, y and z.
        size: Given<DVec3> = Given::by_default(DVec3::splat(10.0)), "cm", in ValueRange::LENGTH,
        /// Radius of a sphere or cylinder.
        radius: Given<f64> = Given::by_default(5.0), "cm", in ValueRange::LENGTH,
        /// Relative permittivity, in the device's frame; symmetric.
        permittivity: Given<Tensor> = Given::by_default(1.0.into()),
        /// Relative permeability, in the device's frame; symmetric.
        permeability: Given<Tensor> = Given::by_default(1.0.into()),
        /// Speed of light over the speed of a pulse in it, for `group_delay`, and for times of
        /// flight where the phase runs backwards; where it is absent, as the `dispersion` says.
        group_index: Option<f64>, in ValueRange::Within(1.0, 1e9),
        /// Where bodies overlap, the one of the larger priority is there.
        priority: i64, in ValueRange::Whole(-1_000_000, 1_000_000),
        /// What an opaque body shows: { color = [red, green, blue] }, linear, or { image = "file"
        /// }: whole and upright on each face of a box and each end of a cylinder, once around a
        /// sphere or the side of a cylinder.
        surface: Option<BodySurface>,
    }
}

crate::table! {
    /// What an opaque body shows.
    pub struct BodySurface {
        /// Linear red, green and blue that it sends out everywhere.
        color: Given<[f64; 3]> = Given::by_default([0.5; 3]), in ValueRange::Within(0.0, 1e30),
        /// An image on it instead of a color: `builtin:bookshelf` or a file (PNG, JPEG, EXR),
        /// relative to the scene file.
        image: Option<PathBuf>,
        /// Whether the surroundings light it: color or image are then the shares of light that it
        /// scatters, evenly to all sides, of what comes from the surroundings to a surface with its
        /// normal. Nothing else lights it, and nothing shades it.
        lit: bool,
    }
}

impl Device for SolidBody {
    const KIND: &'static str = "body";
    const TITLE: &'static str = "Body";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a body is no cloak")?;
        let shape = self.convex(request.length)?;
        let (far, medium) = self.filling(request)?;
        let pictured = self.surface.as_ref().is_some_and(|surface| surface.image.is_some());
        let message = "an endless body has no place for an image; give a cylinder its `length`, and take a \
                       box instead of a slab";
        let endless = self.shape == BodyShape::Slab
            || (self.shape == BodyShape::Cylinder && request.length.is_none());
        KeyError::refuse_if(pictured && endless, key!(Self.surface), message)?;
        let of_law = medium.is_some_and(|medium| medium.law.is_some());
        let message = "the group index of a material follows from its law; leave group_index out";
        let given = self.group_index.is_some();
        KeyError::refuse_if(of_law && given, key!(Self.group_index), message)?;
        let body = Body { shape, priority: self.priority };
        let region = |medium: DispersiveMedium| HomogeneousRegion {
            group_index: self.group_index,
            ..HomogeneousRegion::new(medium, RegionBorder::Convex(shape))
        };
        let regions = medium.into_iter().map(region).map(Region::Homogeneous).collect();
        let surfaces = vec![Surface::new(Shape::Convex(shape), far)];
        let hull = Hull { body: Some(body), ..Hull::new(shape.solid()) };
        Ok(Structure::new(regions, surfaces, hull))
    }

    fn facts(&self, request: Request) -> Vec<Fact> {
        let entry = |tensor: Tensor| {
            let entry = Complex64::new(tensor.re.x_axis.x, tensor.im.x_axis.x);
            (tensor == entry.into()).then_some(entry)
        };
        let mut facts = vec![Fact::number("priority", self.priority as f64)];
        let Ok((_, Some(found))) = self.filling(request) else { return facts };
        let (permittivity, permeability) = found.medium.tensors();
        if let (Some(e), Some(m)) = (entry(permittivity), entry(permeability)) {
            // The product of the roots with positive imaginary parts is that of the wave that
            // decays.
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
}

impl SolidBody {
    fn convex(&self, length: Option<f64>) -> Result<Convex, KeyError> {
        let (extent, radius) = (Extent::centred(length), self.radius.value);
        let (own, convex) = match self.shape {
            BodyShape::Slab => {
                let half = DVec3::new(0.5 * self.thickness.value, f64::INFINITY, extent.max);
                (key!(Self.thickness), Convex::Box { half })
            }
            BodyShape::Box => (key!(Self.size), Convex::Box { half: self.size.value * 0.5 }),
            BodyShape::Sphere => (key!(Self.radius), Convex::Ball(Sphere { radius })),
            BodyShape::Cylinder => {
                (key!(Self.radius), Convex::Cylinder(Cylinder { radius, extent }))
            }
        };
        let has_no_length = matches!(self.shape, BodyShape::Box | BodyShape::Sphere);
        let given = [
            (key!(Self.thickness), self.thickness.given),
            (key!(Self.size), self.size.given),
            (key!(Self.radius), self.radius.given),
            (key!(Request.length), length.is_some() && has_no_length),
        ];
        let shape = self.shape.word();
        match given.into_iter().find(|(key, given)| *given && *key != own) {
            Some((key, _)) => {
                Err(KeyError::at(key, format!("a {shape} has no {key}; it has {own}")))
            }
            None => Ok(convex),
        }
    }

    /// What lies behind its surface, and the medium that fills it; none if it is of metal or has a
    /// surface of its own.
    fn filling(&self, request: Request) -> Result<(FarSide, Option<DispersiveMedium>), KeyError> {
        let (far, what) = match (&self.surface, request.metal) {
            (None, false) => {
                let tensors = [
                    (key!(Self.permittivity), self.permittivity),
                    (key!(Self.permeability), self.permeability),
                ];
                let medium = super::medium(&self.words, tensors, request.wavelength_nm)?;
                return Ok((FarSide::Region(0), Some(medium)));
            }
            (None, true) => (FarSide::Conductor, "a body of metal lets no light in"),
            (Some(_), false) => (FarSide::Opaque, "a body with a surface of its own is opaque"),
            (Some(_), true) => {
                let message =
                    "surface and metal are both given; a body of metal shows what it reflects";
                return Err(KeyError::at(key!(Self.surface), message));
            }
        };
        let of_media = [
            (key!(Self.permittivity), self.permittivity.given),
            (key!(Self.permeability), self.permeability.given),
            (key!(Self.group_index), self.group_index.is_some()),
        ];
        let of_media = of_media.into_iter().filter_map(|(key, given)| given.then_some(key));
        if let Some(key) = of_media.chain(self.words.word()).next() {
            return Err(KeyError::at(key, format!("{what}; it has no {key}")));
        }
        let both = self.surface.as_ref().is_some_and(|s| s.image.is_some() && s.color.given);
        let message = "color and image are both given; a surface takes one of them";
        KeyError::refuse_if(both, key!(Self.surface), message).map(|()| (far, None))
    }
}
