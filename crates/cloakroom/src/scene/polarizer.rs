//! The polarizer before the camera's lens.

use crate::keys::{Field, KeyKind, Value, VisitFile};

/// What the camera's polarizer lets through.
///
/// A polarizer at angle psi passes cos(psi) e_h + sin(psi) e_v, with e_h and e_v from
/// [`Camera::polarization_basis`](super::Camera::polarization_basis).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Polarizer {
    /// No polarizer: the mean of horizontal and vertical.
    #[default]
    None,
    /// The electric field along the camera's right-hand axis.
    Horizontal,
    /// The electric field upright.
    Vertical,
    /// Degrees from horizontal, counterclockwise as the camera sees it.
    Angle(f64),
}

/// As scenes write it, with the unit of an angle.
impl std::fmt::Display for Polarizer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Polarizer::None => f.write_str("none"),
            Polarizer::Horizontal => f.write_str("horizontal"),
            Polarizer::Vertical => f.write_str("vertical"),
            Polarizer::Angle(degrees) => write!(f, "{degrees} degrees"),
        }
    }
}

impl Field for Polarizer {
    const KIND: KeyKind = KeyKind::ChoiceOrNumber { options: &["none", "horizontal", "vertical"] };

    fn from_value(value: &Value) -> Option<Self> {
        match value.as_text() {
            Some("none") => Some(Self::None),
            Some("horizontal") => Some(Self::Horizontal),
            Some("vertical") => Some(Self::Vertical),
            Some(_) => None,
            None => value.as_number().map(Self::Angle),
        }
    }

    fn value(&self) -> Option<Value> {
        Some(match self {
            Self::Angle(degrees) => Value::from(*degrees),
            word => word.to_string().into(),
        })
    }

    fn show_files(&mut self, _path: &str, _visit: &mut VisitFile<'_>) {}
}

impl Polarizer {
    /// The amplitudes along e_h and e_v of what passes, a unit vector; `None` without a polarizer,
    /// where no single field does.
    pub fn amplitudes(self) -> Option<[f64; 2]> {
        match self {
            Polarizer::None => None,
            Polarizer::Horizontal => Some([1.0, 0.0]),
            Polarizer::Vertical => Some([0.0, 1.0]),
            Polarizer::Angle(degrees) => {
                // Whole quarter turns are exact, so that 90 degrees is `Vertical`.
                let turned = degrees.rem_euclid(360.0);
                let quarter = (turned / 90.0).round();
                let (sin, cos) = (turned - 90.0 * quarter).to_radians().sin_cos();
                Some(match quarter as i64 {
                    1 => [-sin, cos],
                    2 => [-cos, -sin],
                    3 => [sin, -cos],
                    _ => [cos, sin],
                })
            }
        }
    }

    /// The shares of horizontal and of vertical light in what the camera sees; they add up to 1.
    ///
    /// For an angle these are shares of power only: the two amplitudes then belong to one field,
    /// see [`Polarizer::amplitudes`].
    pub fn weights(self) -> [f64; 2] {
        self.amplitudes().map_or([0.5, 0.5], |[h, v]| [h * h, v * v])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact_and_half_turns_change_nothing() {
        assert_eq!(Polarizer::Angle(0.0).amplitudes(), Polarizer::Horizontal.amplitudes());
        assert_eq!(Polarizer::Angle(90.0).amplitudes(), Some([-0.0, 1.0]));
        assert_eq!(Polarizer::Angle(-270.0).weights(), Polarizer::Vertical.weights());
        for degrees in [0.0, 17.0, 45.0, 90.0, 133.0, 359.9, -30.0] {
            let [h, v] = Polarizer::Angle(degrees).amplitudes().expect("an angle");
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            assert!((h - cos).abs() < 1e-14 && (v - sin).abs() < 1e-14, "{degrees}");
            let turned = Polarizer::Angle(degrees + 180.0).weights();
            let straight = Polarizer::Angle(degrees).weights();
            assert!((turned[0] - straight[0]).abs() < 1e-14);
            assert!((straight[0] + straight[1] - 1.0).abs() < 1e-15);
        }
    }
}
