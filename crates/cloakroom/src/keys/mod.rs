//! Keys: the name, type, default and limits of everything a scene can say.
//!
//! Each table of a scene file (the camera, the light, each kind of device) is described once, as a
//! list of [`Key`]s. Reading, messages, the JSON Schema, the catalogue and the other front ends
//! all follow from that list.

mod check;
mod nearest;
mod samples;
mod tensor;
#[cfg(test)]
mod tests;
mod value;
mod values;

pub use nearest::{hint, nearest, unknown};
pub use samples::{Samples, SamplesError};
pub use value::Value;
pub(crate) use value::{number_text, quoted, vector_text};
pub use values::{ChoiceOrNumber, KeyError, Sampled, Values};

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The key as written in a scene file.
    pub name: &'static str,
    /// One sentence: what it is.
    pub doc: &'static str,
    /// Its type, default and limits.
    pub kind: KeyKind,
}

/// The type of a key, with its default and limits.
#[derive(Clone, Copy, Debug)]
pub enum KeyKind {
    /// A finite number.
    Number {
        /// Used where the key is absent; `None` if absence itself means something.
        default: Option<f64>,
        /// The unit, `""` for a bare number.
        unit: &'static str,
        /// What values are allowed.
        limits: Limits,
    },
    /// A whole number.
    Integer {
        /// Used where the key is absent.
        default: i64,
        /// Smallest allowed value.
        min: i64,
        /// Largest allowed value.
        max: i64,
    },
    /// True or false.
    Flag {
        /// Used where the key is absent.
        default: bool,
    },
    /// One of a few words; the first is the default.
    Choice {
        /// The words.
        options: &'static [&'static str],
    },
    /// Any of a few words, as a list; none of them by default.
    Choices {
        /// The words.
        options: &'static [&'static str],
    },
    /// Three finite numbers.
    Vector {
        /// Used where the key is absent.
        default: [f64; 3],
        /// The unit of each component.
        unit: &'static str,
        /// What each component may be.
        limits: Limits,
    },
    /// Two whole numbers, such as a resolution.
    IntegerPair {
        /// Used where the key is absent.
        default: [i64; 2],
        /// Smallest allowed value of either.
        min: i64,
        /// Largest allowed value of either.
        max: i64,
    },
    /// An image: the name of a file, or of one that comes with the program. A scene file's reader takes names of
    /// files relative to its folder.
    Image {
        /// Used where the key is absent; `None` if absence itself means something.
        default: Option<&'static str>,
    },
    /// One of a few words, or a number: a polarizer is `"none"`, `"horizontal"` or an angle.
    ChoiceOrNumber {
        /// The words; the first is the default.
        options: &'static [&'static str],
        /// The unit of the number.
        unit: &'static str,
    },
    /// A relative permittivity or permeability: a number, [re, im], or 3 x 3 of either; 1 by default.
    Tensor,
    /// The corners of a polygon, [x, y] each, three at least; absence itself means something.
    Polygon {
        /// The unit of the coordinates.
        unit: &'static str,
    },
    /// Numbers on a grid: rows of numbers, or the name of a file that holds them; absence itself means something. A
    /// scene file's reader makes names of files relative to its folder.
    Samples {
        /// What each number may be.
        limits: Limits,
    },
    /// A table with keys of its own; absence itself means something.
    Table {
        /// Its keys.
        keys: &'static [Key],
    },
    /// A list of tables, each with keys of its own; none by default.
    Tables {
        /// The keys of each table.
        keys: &'static [Key],
    },
}

/// The allowed values of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limits {
    /// Any finite number.
    Finite,
    /// Above zero.
    Positive,
    /// Above the first and below the second.
    Between(f64, f64),
    /// From the first to the second, both allowed.
    Within(f64, f64),
}

impl Limits {
    /// Of a length in cm, 10 nm to 10 km: beyond, what is far and what is near share no digits.
    pub const LENGTH: Self = Self::Within(1e-6, Self::FARTHEST);

    /// Of a length in cm that may be none.
    pub const LENGTH_OR_ZERO: Self = Self::Within(0.0, Self::FARTHEST);

    /// Of a coordinate in cm.
    pub const COORDINATE: Self = Self::Within(-Self::FARTHEST, Self::FARTHEST);

    /// Of an angle in degrees, a few thousand turns either way.
    pub const ANGLE: Self = Self::Within(-1e6, 1e6);

    const FARTHEST: f64 = 1e6;
}
