//! What flashes.

use crate::assembly::Screen;
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;
use std::fmt;
use std::str::FromStr;

/// What flashes, at the time 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Flash {
    /// The whole photograph at once.
    #[default]
    Photograph,
    /// The photograph, where a plane wave comes to it that runs along this direction through air:
    /// its middle at the time 0.
    PlaneWave(DVec3),
    /// The photograph, where light comes to it from a point (cm) through air.
    Point(DVec3),
    /// A spot of a laser on it, as bright as the photograph there: a Gaussian about the point of
    /// the photograph nearest to `middle` (cm), which is half as bright at `radius` (cm).
    Spot {
        /// Its middle.
        middle: DVec3,
        /// Where it is half as bright.
        radius: f64,
    },
}

impl Flash {
    /// Whether all of the photograph flashes, and as bright as it is.
    pub(super) fn is_even(&self) -> bool {
        !matches!(self, Self::Spot { .. })
    }

    /// How much later (ns) a point of the photograph flashes, and how bright it is.
    pub(super) fn at(&self, point: DVec3, screen: &Screen) -> (f64, f64) {
        match *self {
            Self::Photograph => (0.0, 1.0),
            Self::PlaneWave(direction) => {
                let along = (point - screen.middle).dot(direction.normalize_or_zero());
                (along / SPEED_OF_LIGHT, 1.0)
            }
            Self::Point(source) => (point.distance(source) / SPEED_OF_LIGHT, 1.0),
            Self::Spot { middle, radius } => {
                let squared = point.distance_squared(screen.foot(middle)) / (radius * radius);
                (0.0, (-squared).exp2())
            }
        }
    }
}

/// As it is written.
impl fmt::Display for Flash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Photograph => f.write_str("photograph"),
            Self::PlaneWave(DVec3 { x, y, z }) => write!(f, "plane:{x},{y},{z}"),
            Self::Point(DVec3 { x, y, z }) => write!(f, "point:{x},{y},{z}"),
            Self::Spot { middle: DVec3 { x, y, z }, radius } => {
                write!(f, "spot:{x},{y},{z},{radius}")
            }
        }
    }
}

/// What is wrong with a flash: it is not written as one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no flash; write photograph, plane:DX,DY,DZ, point:X,Y,Z or spot:X,Y,Z,RADIUS in cm, as in \
     point:50,0,30"
)]
pub struct FlashError(String);

impl FromStr for Flash {
    type Err = FlashError;

    fn from_str(text: &str) -> Result<Self, FlashError> {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let numbers: Option<Vec<f64>> = match rest {
            "" => Some(Vec::new()),
            rest => rest.split(',').map(|part| part.trim().parse().ok()).collect(),
        };
        let numbers = numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite()));
        match (kind, numbers.as_deref()) {
            ("photograph", Some([])) => Some(Self::Photograph),
            ("plane", Some(&[x, y, z])) if [x, y, z] != [0.0; 3] => {
                Some(Self::PlaneWave(DVec3::new(x, y, z)))
            }
            ("point", Some(&[x, y, z])) => Some(Self::Point(DVec3::new(x, y, z))),
            ("spot", Some(&[x, y, z, radius])) if radius > 0.0 => {
                Some(Self::Spot { middle: DVec3::new(x, y, z), radius })
            }
            _ => None,
        }
        .ok_or_else(|| FlashError(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flash_is_read_as_it_is_written() {
        for text in ["photograph", "plane:1,-0.5,0", "point:50,0,30.25", "spot:20,5,-5,2"] {
            assert_eq!(text.parse().map(|flash: Flash| flash.to_string()), Ok(text.to_owned()));
        }
    }
}
