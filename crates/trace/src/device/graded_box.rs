//! A box in which the square of the index grows evenly along a direction.

use super::closed_form::filled;
use super::{ClosedFormBorder, Device, Fact, Request, Structure};
use crate::key;
use crate::keys::{KeyError, ValueRange, vector_text};
use glam::DVec3;
use optics::geometry::FlatOrRound;
use optics::propagation::{ClosedForm, CurvedRay, SquaredIndex, first_way_out};

crate::table! {
    /// A box in which the square of the index grows evenly in one direction: rays are parabolas, as
    /// those of a ball thrown upwards. Born & Wolf, Principles of Optics, section 3.2.
    pub struct GradedBox {
        /// Lengths of its sides along x, y and z.
        sides: DVec3 = DVec3::splat(20.0), "cm", in ValueRange::LENGTH,
        /// Index in the middle.
        index: f64 = 1.3, in ValueRange::Within(0.1, 100.0),
        /// The gradient of the square of the index, in the device's frame: by how much it grows per
        /// cm along x, y and z.
        gradient: DVec3 = DVec3::new(0.0, -0.03, 0.0), "1/cm", in ValueRange::Within(-1e6, 1e6),
    }
}

/// The least square of the index.
const LEAST: f64 = 0.01;

impl GradedBox {
    fn medium(&self) -> LinearSquare {
        LinearSquare { middle: self.index * self.index, gradient: self.gradient }
    }

    /// The least and the largest square of the index: at corners.
    fn squares(&self) -> [f64; 2] {
        let change = 0.5 * self.gradient.abs().dot(self.sides);
        [-change, change].map(|change| self.index * self.index + change)
    }
}

impl Device for GradedBox {
    const KIND: &'static str = "graded-box";
    const TITLE: &'static str = "Box of evenly graded index";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a box hides no metal and imitates no mirror")?;
        let message = "length is given; a box has the third of its sides";
        KeyError::refuse_if(request.length.is_some(), key!(Request.length), message)?;
        let [least, _] = self.squares();
        let message = format!(
            "gradient is {} 1/cm: with it the square of the index is {least} at a corner of the box; \
             it must be {LEAST} at least",
            vector_text(self.gradient)
        );
        KeyError::refuse_if(least < LEAST, key!(Self.gradient), message)?;
        Ok(filled(ClosedFormBorder::Box(0.5 * self.sides), self.medium()))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let [least, largest] = self.squares();
        if least < LEAST {
            return Vec::new();
        }
        vec![
            Fact::number("index_min", least.sqrt()),
            Fact::number("index_max", largest.sqrt()),
            Fact::number("volume_cm3", self.sides.element_product()),
        ]
    }
}

/// n² = a + g·r: with dσ = ds/n, r'' = g/2, and the wave vector is r'.
#[derive(Debug)]
struct LinearSquare {
    /// a.
    middle: f64,
    /// g, 1/cm.
    gradient: DVec3,
}

impl ClosedForm for LinearSquare {
    fn squared_index(&self, at: DVec3) -> SquaredIndex {
        SquaredIndex { value: self.middle + self.gradient.dot(at), gradient: self.gradient }
    }

    /// Out of a plane: the box has no round surface.
    fn way_out(&self, start: &CurvedRay, surface: &FlatOrRound) -> Option<f64> {
        let [speed, pull] =
            [start.wave_vector, 0.25 * self.gradient].map(|v| surface.linear.dot(v));
        let [over, under] = first_way_out([surface.height(start.position), speed, pull])?;
        (under > 0.0).then(|| over / under)
    }

    fn way_point(&self, start: &CurvedRay, sigma: f64) -> (CurvedRay, f64) {
        let CurvedRay { position, wave_vector } = *start;
        let g = self.gradient;
        let half = 0.5 * sigma;
        let at = position + sigma * (wave_vector + g * (0.5 * half));
        let wave_vector_there = wave_vector + g * half;
        // ∫ n² dσ
        let rise = g.dot(wave_vector) * half + g.length_squared() * half * half / 3.0;
        let optical_path = sigma * (self.squared_index(position).value + rise);
        (CurvedRay { position: at, wave_vector: wave_vector_there }, optical_path)
    }
}
