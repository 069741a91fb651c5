//! Lenses: two spherical or conic faces on a round edge, of any homogeneous medium.

use super::{
    Device, DispersiveMedium, Fact, FarSide, HomogeneousRegion, Hull, MediumWords, Region,
    RegionBorder, Request, Shape, Structure, Surface,
};
use crate::key;
use crate::keys::{Given, KeyError, ValueRange};
use optics::geometry::{ConicFace, Lens, Pose, Solid};
use optics::medium::Tensor;

crate::table! {
    /// A lens: two spherical or conic faces on a round edge, of any homogeneous medium. Its optical
    /// axis is its own x axis, along which light comes in the
    /// paper's view, and `position` is the middle of its thickness. Lenses that share a face touch: a
    /// cemented doublet is two of them.
    pub struct GlassLens with words: MediumWords {
        /// Radius of curvature of the face at smaller x, which light along x meets first: positive
        /// where the centre of curvature is at larger x, as of the front of a magnifying glass; 0 for
        /// a plane.
        front_radius: f64 = 20.0, "cm", in ValueRange::COORDINATE,
        /// Radius of curvature of the face at larger x, with the same sign: negative where that face
        /// bulges; 0 for a plane.
        back_radius: f64 = 0.0, "cm", in ValueRange::COORDINATE,
        /// Conic constant K of the front: 0 for a sphere, -1 for a paraboloid, below for a
        /// hyperboloid, above -1 for an ellipsoid.
        front_conic: f64 = 0.0, in ValueRange::Within(-1e3, 1e3),
        /// Conic constant of the back.
        back_conic: f64 = 0.0, in ValueRange::Within(-1e3, 1e3),
        /// Thickness on the axis.
        thickness: f64 = 4.0, "cm", in ValueRange::LENGTH,
        /// Diameter of the round edge.
        diameter: f64 = 20.0, "cm", in ValueRange::LENGTH,
        /// Relative permittivity, in the device's frame; symmetric. By default the square of the
        /// index 1.5168, that of the glass BK7 in yellow light.
        permittivity: Given<Tensor> = Given::by_default((1.5168 * 1.5168).into()),
        /// Relative permeability, in the device's frame; symmetric.
        permeability: Given<Tensor> = Given::by_default(1.0.into()),
        /// Speed of light over the speed of a pulse in it, for `group_delay`, and for times of
        /// flight where the phase runs backwards; where it is absent, as the `dispersion` says.
        group_index: Option<f64>, in ValueRange::Within(1.0, 1e9),
    }
}

/// The least distance of the faces, at the edge too, cm: a micrometre. A lens has no knife's edge.
const THINNEST: f64 = 1e-4;

impl Device for GlassLens {
    const KIND: &'static str = "lens";
    const TITLE: &'static str = "Lens";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a lens hides no metal and imitates no mirror")?;
        let message = "length is given; a lens has its `thickness` and `diameter`";
        KeyError::refuse_if(request.length.is_some(), key!(Request.length), message)?;
        let lens = self.lens()?;
        let medium = self.medium(request.wavelength_nm)?;
        let region = HomogeneousRegion {
            group_index: self.group_index,
            ..HomogeneousRegion::new(medium, RegionBorder::Lens(lens))
        };
        let surface = |part| Surface::new(Shape::OfLens { lens, part }, FarSide::Region(0));
        let hull = Hull::new(Solid::Lens { lens, pose: Pose::IDENTITY });
        let surfaces = Lens::PARTS.into_iter().map(surface).collect();
        Ok(Structure::new(vec![Region::Homogeneous(region)], surfaces, hull))
    }

    fn facts(&self, request: Request) -> Vec<Fact> {
        let Ok(lens) = self.lens() else { return Vec::new() };
        let [from, to] = lens.between(lens.radius);
        let edge = Fact::number("edge_thickness_cm", to - from);
        let medium = self.medium(request.wavelength_nm).ok();
        let index = medium.map(|found| found.medium).filter(|m| m.is_isotropic() && !m.absorbs());
        let Some(index) = index.map(|medium| medium.mean_index()) else { return vec![edge] };
        let mut facts = vec![edge, Fact::number("index", index)];
        let Paraxial { power, front, back } = Paraxial::of(&lens, index);
        if power != 0.0 {
            let vertices = [lens.front.apex, lens.back.apex];
            facts.extend([
                Fact::number("focal_length_cm", power.recip()),
                Fact::number("front_focal_distance_cm", power.recip() - front),
                Fact::number("back_focal_distance_cm", power.recip() + back),
                Fact::numbers("principal_planes_cm", [vertices[0] + front, vertices[1] + back]),
            ]);
        }
        facts
    }
}

/// What a thick lens in air does to rays near its axis.
struct Paraxial {
    /// 1/f, 1/cm.
    power: f64,
    /// Where the first principal plane is, from the apex of the front, cm.
    front: f64,
    /// Where the second is, from the apex of the back, cm.
    back: f64,
}

impl Paraxial {
    fn of(lens: &Lens, index: f64) -> Self {
        let thickness = lens.back.apex - lens.front.apex;
        let [first, second] =
            [lens.front.curvature, -lens.back.curvature].map(|c| (index - 1.0) * c);
        let power = first + second - thickness / index * first * second;
        let shift = |other: f64| thickness / index * other / power;
        Self { power, front: shift(second), back: -shift(first) }
    }
}

impl GlassLens {
    fn medium(&self, wavelength_nm: f64) -> Result<DispersiveMedium, KeyError> {
        let tensors = [
            (key!(Self.permittivity), self.permittivity),
            (key!(Self.permeability), self.permeability),
        ];
        super::medium(&self.words, tensors, wavelength_nm)
    }

    /// Its faces and its edge, if they make a lens.
    fn lens(&self) -> Result<Lens, KeyError> {
        let face = |apex: f64, radius: f64, conic: f64| ConicFace {
            apex,
            curvature: if radius == 0.0 { 0.0 } else { radius.recip() },
            conic,
        };
        let lens = Lens {
            radius: 0.5 * self.diameter,
            front: face(-0.5 * self.thickness, self.front_radius, self.front_conic),
            back: face(0.5 * self.thickness, self.back_radius, self.back_conic),
        };
        let reach = [
            (lens.front.reach(), key!(Self.front_radius), self.front_radius),
            (lens.back.reach(), key!(Self.back_radius), self.back_radius),
        ];
        for (reach, key, radius) in reach {
            let message = format!(
                "diameter is {} cm; it must be {} cm at most, which is where the face of {key} = {radius} ends",
                self.diameter,
                2.0 * reach
            );
            KeyError::refuse_if(lens.radius > reach, key!(Self.diameter), message)?;
        }
        let (r, gap) = lens.thinnest();
        if gap < THINNEST {
            let least = self.thickness - gap + THINNEST;
            let place = if r == lens.radius {
                "at the edge".to_owned()
            } else {
                format!("{r} cm off the axis")
            };
            let widest = widest(&lens);
            let or = if widest > 0.0 {
                format!(", or diameter {} cm at most", 2.0 * widest)
            } else {
                String::new()
            };
            let message = format!(
                "thickness is {} cm; the faces meet {place}: it must be {least} cm at least{or}",
                self.thickness
            );
            return Err(KeyError::at(key!(Self.thickness), message));
        }
        Ok(lens)
    }
}

/// How far from the axis the faces are at least [`THINNEST`] apart; 0 if they are not there on the
/// axis.
fn widest(lens: &Lens) -> f64 {
    let sound = |radius: f64| Lens { radius, ..*lens }.thinnest().1 >= THINNEST;
    let (mut low, mut high) = (0.0, lens.radius);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if sound(middle) { low = middle } else { high = middle }
    }
    // Down to four digits: what is said works.
    let step = 10f64.powi(low.max(f64::MIN_POSITIVE).log10().floor() as i32 - 3);
    (2.0 * low / step).floor() * step / 2.0
}

#[cfg(test)]
mod tests;
