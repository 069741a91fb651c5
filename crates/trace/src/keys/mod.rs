//! Keys: the name, type, default and limits of everything a scene can say.
//!
//! Each table of a scene file (the camera, the light, each kind of device) is described once, by a
//! struct that [`table!`](crate::table) makes together with its list of [`Key`]s. Reading,
//! messages, the JSON Schema, the catalogue and the other front ends all follow from that list.

mod check;
mod error;
mod field;
mod nearest;
mod samples;
mod synonyms;
mod table;
mod tensor;
#[cfg(test)]
mod tests;
mod value;

pub use error::KeyError;
pub use field::{
    Direction, Field, Given, Item, MESH_ENDINGS, MaterialName, MeshSource, NamedFile, Sampled,
    VisitFile,
};
pub use nearest::{hint, nearest, unknown};
pub use samples::{Samples, shape_text};
pub use synonyms::synonym;
pub use table::{Table, find, has, joined};
pub use value::{Value, number_text, quoted, vector_text};

/// What the name of an image begins with that comes with the program.
pub const BUILT_IN_PREFIX: &str = "builtin:";

/// The images that come with the program, as written in a scene.
pub const BUILT_IN_IMAGES: [&str; 2] = ["builtin:bookshelf", "builtin:room"];

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The key as written in a scene file.
    pub name: &'static str,
    /// One sentence: what it is.
    pub doc: &'static str,
    /// Its type.
    pub kind: KeyKind,
    /// The unit of its numbers, `""` for bare ones.
    pub unit: &'static str,
    /// What its numbers may be.
    pub limits: ValueRange,
    /// The value where the key is absent; `None` if absence itself means something.
    pub default: fn() -> Option<Value>,
}

/// The type of a key.
#[derive(Clone, Copy, Debug)]
pub enum KeyKind {
    /// A finite number.
    Number,
    /// A whole number.
    Integer,
    /// True or false.
    Flag,
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
    Vector,
    /// Two whole numbers, such as a resolution.
    IntegerPair,
    /// Two numbers, the lower one first.
    Interval,
    /// An image: the name of a file, or of one that comes with the program. A scene file's reader
    /// takes names of files relative to its folder.
    Image,
    /// One of a few words, or a number: a polarizer is `"none"`, `"horizontal"` or an angle.
    ChoiceOrNumber {
        /// The words; the first is the default.
        options: &'static [&'static str],
    },
    /// The same, or a table with keys of its own: a spectrum is `"D65"`, a wavelength or lines.
    ChoiceNumberOrTable {
        /// The words; the first is the default.
        options: &'static [&'static str],
        /// The keys of the table.
        keys: &'static [Key],
    },
    /// A relative permittivity or permeability: a number, [re, im], or 3 x 3 of either.
    Tensor,
    /// A complex number: a number, or [re, im].
    Complex,
    /// A direction: three numbers, or an angle in the x, y plane, counted from x to y.
    Direction,
    /// Three directions at right angles.
    Axes,
    /// A material: the name of one that comes with the program, or of a file of the
    /// refractiveindex.info database (`.yml`). A scene file's reader makes names of files relative
    /// to its folder.
    Material,
    /// The same, or a table with keys of its own.
    MaterialOrTable {
        /// Its keys.
        keys: &'static [Key],
    },
    /// The name of a file of a mesh of triangles. A scene file's reader makes it relative to its
    /// folder.
    Mesh,
    /// A name that the scene gives to something: a letter, then letters, digits, - and _.
    Name,
    /// The corners of a polygon, [x, y] each, three at least.
    Polygon,
    /// Numbers on a grid: rows of numbers, or the name of a file that holds them. A scene file's
    /// reader makes names of files relative to its folder.
    Samples {
        /// The least and the largest dimension of the grid: 0 for one number, 2 for rows, 3 for lists
        /// of rows.
        dimensions: [usize; 2],
    },
    /// A table with keys of its own.
    Table {
        /// Its keys.
        keys: &'static [Key],
    },
    /// True or false, or a table with keys of its own, which says more.
    FlagOrTable {
        /// Its keys.
        keys: &'static [Key],
    },
    /// A list of tables, each with keys of its own; none by default.
    Tables {
        /// The keys of each table.
        keys: &'static [Key],
    },
}

impl KeyKind {
    /// The keys of a table, or of each table of a list.
    #[must_use]
    pub fn inner_keys(self) -> Option<&'static [Key]> {
        match self {
            Self::Table { keys }
            | Self::FlagOrTable { keys }
            | Self::MaterialOrTable { keys }
            | Self::ChoiceNumberOrTable { keys, .. }
            | Self::Tables { keys } => Some(keys),
            _ => None,
        }
    }
}

/// The allowed values of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValueRange {
    /// Any finite number.
    Finite,
    /// Above zero.
    Positive,
    /// Above the first and below the second.
    Between(f64, f64),
    /// From the first to the second, both allowed.
    Within(f64, f64),
    /// Whole numbers from the first to the second, both allowed.
    Whole(i64, i64),
}

impl ValueRange {
    /// Of a length in cm, 10 nm to 10 km: beyond, what is far and what is near share no digits.
    pub const LENGTH: Self = Self::Within(1e-6, Self::FARTHEST);

    /// Of a length in cm that may be none.
    pub const LENGTH_OR_ZERO: Self = Self::Within(0.0, Self::FARTHEST);

    /// Of a coordinate in cm.
    pub const COORDINATE: Self = Self::Within(-Self::FARTHEST, Self::FARTHEST);

    /// Of an angle in degrees, a few thousand turns either way.
    pub const ANGLE: Self = Self::Within(-1e6, 1e6);

    /// Of the seed of random numbers.
    pub const SEED: Self = Self::Whole(0, i64::MAX);

    const FARTHEST: f64 = 1e6;
}
