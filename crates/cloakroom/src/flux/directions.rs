//! Where the light comes from.

use crate::scene::Receiver;
use glam::DVec3;

/// A direction of light, and how strong it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// The way of the light, a unit vector.
    pub along: DVec3,
    /// What is given to name it: an angle of incidence in degrees, or the hour of the day.
    pub label: f64,
}

impl Direction {
    /// The angle to the receiver's normal, degrees.
    #[must_use]
    pub fn incidence(&self, receiver: &Receiver) -> f64 {
        (-self.along.dot(receiver.normal)).clamp(-1.0, 1.0).acos().to_degrees()
    }
}

/// Light at angles of incidence (degrees, of either sign) in the plane of the receiver's normal and
/// its width, tilted by `tilt` degrees towards its length. A positive angle comes from the side of
/// less width.
#[must_use]
pub fn across_range(receiver: &Receiver, angles: &[f64], tilt: f64) -> Vec<Direction> {
    let [across, along] = receiver.axes();
    let (rise, level) = tilt.to_radians().sin_cos();
    angles
        .iter()
        .map(|&label| {
            let (sin, cos) = label.to_radians().sin_cos();
            let flat = across * sin - receiver.normal * cos;
            Direction { along: flat * level + along * rise, label }
        })
        .collect()
}

/// The sun over a day, seen from a latitude when it has a declination (degrees; 23.44 at midsummer
/// in the north), every `step` hours of solar time while it is above the receiver, which lies flat:
/// its normal is up, its width runs from west to east and its length towards the north.
#[must_use]
pub fn sun_day(receiver: &Receiver, latitude: f64, declination: f64, step: f64) -> Vec<Direction> {
    /// The sun on the horizon gives no light that could be measured, degrees.
    const LOWEST: f64 = 0.5;
    let [east, north] = receiver.axes();
    let (sin_l, cos_l) = latitude.to_radians().sin_cos();
    let (sin_d, cos_d) = declination.to_radians().sin_cos();
    let count = (24.0 / step).floor().clamp(0.0, 1e5) as u32;
    (0..=count)
        .map(|k| f64::from(k) * step)
        .filter(|hour| *hour < 24.0)
        .filter_map(|hour| {
            let (sin_h, cos_h) = (15.0 * (hour - 12.0)).to_radians().sin_cos();
            let sun = east * (-cos_d * sin_h)
                + north * (cos_l * sin_d - sin_l * cos_d * cos_h)
                + receiver.normal * (sin_l * sin_d + cos_l * cos_d * cos_h);
            let height = sun.dot(receiver.normal).clamp(-1.0, 1.0).asin().to_degrees();
            (height > LOWEST).then(|| Direction { along: -sun.normalize(), label: hour })
        })
        .collect()
}
