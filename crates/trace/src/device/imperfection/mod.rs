//! What a real process makes of a design: values that it can reach, levels, errors and loss.

mod deviates;
mod graded;
mod homogeneous;
#[cfg(test)]
mod tests;

use super::{Region, Structure};
use crate::keys::{KeyError, ValueRange};
use deviates::Deviates;

crate::table! {
    /// How what is made of a device differs from its design. Zero values change nothing.
    ///
    /// In this order: each value is brought into the range that can be made, then to the nearest
    /// level, then comes the random error; loss is added last. In homogeneous media the values are
    /// the principal ones of the tensors: a tensor that is that of vacuum stays so, as the
    /// permeability of a dielectric does, and principal values that are equal stay equal. In graded
    /// media the value is the index, and what a range and levels change of it is smoothed; loss
    /// counts along the way, not where light enters or leaves.
    pub struct Imperfection {
        /// Relative standard deviation of a random error: of the index of a graded medium, or of
        /// each principal value of the permittivity and the permeability of each homogeneous
        /// segment or body.
        error: f64, in ValueRange::Within(0.0, 0.5),
        /// The length l over which the error of a graded index is correlated, as exp(-r^2/(2 l^2)).
        correlation: f64 = 2.0, "cm", in ValueRange::LENGTH,
        /// The least value that can be made, of the index of a graded medium or of a principal
        /// value; smaller ones become this one.
        minimum: Option<f64>, in ValueRange::Within(-1e6, 1e6),
        /// The largest value that can be made; larger ones become this one.
        maximum: Option<f64>, in ValueRange::Within(-1e6, 1e6),
        /// How many values can be made, at equal steps from the minimum to the maximum (where these
        /// are absent, those of the design); 0 for any.
        levels: u32, in ValueRange::Whole(0, 1_000_000),
        /// The standard deviation of the Gaussian that smooths what a range and levels make of a
        /// graded index.
        resolution: f64 = 0.5, "cm", in ValueRange::LENGTH,
        /// Imaginary part of the permittivity, and of a permeability other than 1, over the real
        /// part.
        loss_tangent: f64, in ValueRange::Within(0.0, 0.1),
        /// The seed of the random errors.
        seed: u64, in ValueRange::SEED,
    }
}

impl Imperfection {
    /// Whether it depends on the seed.
    #[must_use]
    pub fn is_random(&self) -> bool {
        self.error > 0.0
    }

    /// Whether there are values that cannot be made.
    fn limits_values(&self) -> bool {
        self.levels > 0 || self.minimum.is_some() || self.maximum.is_some()
    }

    /// What is made of a device, shown as it is and not as bare metal. `draw` is the number of the
    /// device in its scene, and which of many draws from the same seed it is: 0 in a scene.
    ///
    /// # Errors
    ///
    /// If the keys do not go together, or the device's material cannot be imperfect.
    pub fn apply(
        &self,
        mut structure: Structure,
        draw: (usize, u32),
    ) -> Result<Structure, KeyError> {
        self.check()?;
        let message = "this device has no medium that could be imperfect";
        KeyError::refuse_if(structure.regions.is_empty(), TABLE, message)?;
        let deviates = Deviates::new([self.seed, draw.0 as u64, u64::from(draw.1)]);
        for region in &mut structure.regions {
            match region {
                Region::Homogeneous(_) => {}
                Region::Conformal(region) => graded::apply(self, &deviates, region)?,
                Region::Spatial(_) => {
                    let message =
                        "this medium is given on a grid; what is made of it is to be given so, too";
                    return Err(KeyError::at(TABLE, message));
                }
                Region::Radial(_) | Region::ClosedForm(_) => {
                    let message = "this graded medium is followed in closed form, for its ideal index only; \
                                   homogeneous and conformal ones can be imperfect";
                    return Err(KeyError::at(TABLE, message));
                }
            }
        }
        homogeneous::apply(self, &deviates, &mut structure)?;
        Ok(structure)
    }

    fn check(&self) -> Result<(), KeyError> {
        if let (Some(minimum), Some(maximum)) = (self.minimum, self.maximum)
            && minimum > maximum
        {
            let message = format!("minimum is {minimum}, above maximum, {maximum}");
            return Err(KeyError::at("imperfection.minimum", message));
        }
        let message = "levels is 1; a process has 2 at least, or 0 for any value";
        KeyError::refuse_if(self.levels == 1, "imperfection.levels", message)
    }

    /// The range and the levels of the process for a design whose values lie between two numbers.
    fn process(&self, design: [f64; 2]) -> Process {
        let [least, largest] = design;
        let minimum = self.minimum.unwrap_or(f64::NEG_INFINITY);
        let maximum = self.maximum.unwrap_or(f64::INFINITY);
        let first = self.minimum.unwrap_or(least.min(maximum));
        let last = self.maximum.unwrap_or(largest.max(minimum));
        let step = if self.levels > 1 { (last - first) / f64::from(self.levels - 1) } else { 0.0 };
        Process { minimum, maximum, first, step }
    }
}

/// The table's name in a device.
const TABLE: &str = "imperfection";

/// Which values can be made.
struct Process {
    minimum: f64,
    maximum: f64,
    /// The first level, and the step from level to level; 0 for any value.
    first: f64,
    step: f64,
}

impl Process {
    /// What is made of a value.
    fn made(&self, value: f64) -> f64 {
        let value = value.clamp(self.minimum, self.maximum);
        if self.step > 0.0 {
            self.first + ((value - self.first) / self.step).round() * self.step
        } else {
            value
        }
    }
}
