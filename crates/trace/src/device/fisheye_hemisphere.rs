//! Half of Maxwell's fish-eye, or what any plane leaves of it.

use super::closed_form::filled;
use super::round::lens_alone;
use super::{ClosedFormBorder, Device, Fact, Request, Structure};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::{DVec3, DVec4};
use optics::geometry::{CutBall, FlatOrRound, Plane, Sphere};
use optics::propagation::{ClosedForm, CurvedRay, SquaredIndex, first_way_out};
use optics::wave::unit;
use std::f64::consts::FRAC_PI_2;

crate::table! {
    /// Maxwell's fish-eye cut by a plane: half of it makes the light of a point of its round
    /// surface parallel, and parallel light, straight onto the cut, meets at such a point. Maxwell
    /// 1854.
    pub struct FisheyeHemisphere {
        /// Radius of the ball that is cut.
        radius: f64 = 10.0, "cm", in ValueRange::LENGTH,
        /// Index at the round surface; it is twice that at the centre of the ball.
        index: f64 = 1.0, in ValueRange::Within(0.1, 100.0),
        /// The direction in which the cut looks, out of the device, in the device's frame; of any
        /// length.
        cut_normal: DVec3 = DVec3::NEG_X,
        /// How far from the centre of the ball it is cut, along `cut_normal`; less than half of the
        /// ball is left where it is negative.
        cut_distance: f64, "cm", in ValueRange::COORDINATE,
    }
}

/// The nearest to the border of the ball, as a share of its radius, that it may be cut.
const THINNEST: f64 = 0.001;

impl FisheyeHemisphere {
    fn cut(&self) -> Result<Plane, KeyError> {
        let nowhere = "cut_normal is [0, 0, 0]; it must point somewhere";
        let normal = unit(self.cut_normal);
        let normal = normal.ok_or_else(|| KeyError::at(key!(Self.cut_normal), nowhere))?;
        let (offset, most) = (self.cut_distance, (1.0 - THINNEST) * self.radius);
        let range = format!("it must be from -{most} to {most} cm, within the ball");
        let message = format!("cut_distance is {offset} cm; {range}");
        KeyError::refuse_if(offset.abs() > most, key!(Self.cut_distance), message)?;
        Ok(Plane { normal, offset })
    }
}

impl Device for FisheyeHemisphere {
    const KIND: &'static str = "fisheye-hemisphere";
    const TITLE: &'static str = "Half of Maxwell's fish-eye";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        lens_alone(request)?;
        let ball = CutBall { sphere: Sphere { radius: self.radius }, plane: self.cut()? };
        let medium = Fisheye { radius: self.radius, border_index: self.index };
        Ok(filled(ClosedFormBorder::CutBall(ball), medium))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let deepest = (self.cut_distance / self.radius).min(0.0);
        vec![
            Fact::number("index_min", self.index),
            Fact::number("index_max", 2.0 * self.index / (1.0 + deepest * deepest)),
            Fact::number("focal_optical_path_cm", FRAC_PI_2 * self.index * self.radius),
        ]
    }
}

/// n = 2 m/(1 + (r/R)²), m at r = R. It is the stereographic projection, x = r/R = ξ/(1 - w), of
/// the unit sphere (ξ, w) in four dimensions, m R times as large: rays are its great circles, and
/// the optical path is m R times the angle. Planes and spheres are what linear equations leave of
/// it.
#[derive(Debug)]
struct Fisheye {
    /// R, cm.
    radius: f64,
    /// m.
    border_index: f64,
}

impl Fisheye {
    /// The point of the great circle of a ray, and the unit vector along it there.
    fn on_sphere(&self, ray: &CurvedRay) -> [DVec4; 2] {
        let (x, d) = (ray.position / self.radius, ray.wave_vector.normalize());
        let shrunk = 2.0 / (1.0 + x.length_squared());
        let climb = shrunk * x.dot(d);
        [(x * shrunk).extend(1.0 - shrunk), (d - x * climb).extend(climb)]
    }
}

impl ClosedForm for Fisheye {
    fn squared_index(&self, at: DVec3) -> SquaredIndex {
        let x = at / self.radius;
        let value = (2.0 * self.border_index / (1.0 + x.length_squared())).powi(2);
        let gradient = x * (-4.0 * value / (self.radius * (1.0 + x.length_squared())));
        SquaredIndex { value, gradient }
    }

    fn way_out(&self, start: &CurvedRay, surface: &FlatOrRound) -> Option<f64> {
        // The height times 1 - w, of point cos φ + along sin φ; with tan φ/2 it is a quadratic.
        let FlatOrRound { constant, linear, square } = *surface;
        let square = square * self.radius * self.radius;
        let slope = (linear * self.radius).extend(square - constant);
        let [cos, sin] = self.on_sphere(start).map(|at| at.dot(slope));
        let level = constant + square;
        let tangent = first_way_out([level + cos, 2.0 * sin, level - cos]);
        tangent.map(|[over, under]| 2.0 * over.atan2(under))
    }

    fn way_point(&self, start: &CurvedRay, angle: f64) -> (CurvedRay, f64) {
        let [point, along] = self.on_sphere(start);
        let (sin, cos) = angle.sin_cos();
        let [at, onward] = [point * cos + along * sin, along * cos - point * sin];
        let x = at.truncate() / (1.0 - at.w);
        let direction = (onward.truncate() + x * onward.w).normalize();
        let wave_vector = direction * (self.border_index * (1.0 - at.w));
        let position = x * self.radius;
        (CurvedRay { position, wave_vector }, self.border_index * self.radius * angle)
    }
}
