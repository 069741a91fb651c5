//! What a key may be in Rust: the types of the fields of tables.

use super::value::items_of;
use super::{BUILT_IN_PREFIX, Key, KeyKind, Samples, Value, tensor};
use glam::DVec3;
use num_complex::Complex64;
use optics::geometry::Polyhedron;
use optics::material::Material;
use optics::medium::Tensor;
use std::path::PathBuf;
use std::sync::Arc;

/// Is told each file that a table names, and the path of the key that names it.
pub type VisitFile<'a> = dyn FnMut(&str, NamedFile<'_>) + 'a;

/// A file that a table names.
#[derive(Debug)]
pub struct NamedFile<'f> {
    /// Where it is.
    pub path: &'f mut PathBuf,
    /// Where the material belongs that it holds, if it holds one.
    pub material: Option<&'f mut Option<Arc<Material>>>,
}

impl<'f> NamedFile<'f> {
    /// One that is read where it is needed.
    pub fn of(path: &'f mut PathBuf) -> Self {
        Self { path, material: None }
    }
}

/// A type that a field of a table can have.
pub trait Field: Sized {
    /// The type of its key.
    const KIND: KeyKind;

    /// What a value means that [`Key::check`] has let through; `None` if it is of another type.
    fn from_value(value: &Value) -> Option<Self>;

    /// The value as a scene writes it; `None` where it is absent and its absence means something.
    fn value(&self) -> Option<Value>;

    /// The value as a scene has to write it; `None` where it is left at its default.
    fn written_value(&self) -> Option<Value> {
        self.value()
    }

    /// Shows the names of files in it, where the key's path is `path`.
    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>);

    /// Holds it against its key.
    ///
    /// # Errors
    ///
    /// A message if it is outside the limits.
    fn check_against(&self, key: &Key) -> Result<(), String> {
        self.value().map_or(Ok(()), |value| key.check(&value).map(drop))
    }
}

/// A type of which a field can have a list.
pub trait Item: Field {
    /// The type of the key of a list.
    const LIST: KeyKind;
}

/// A value of which it matters whether it was given, or left at its default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given<T> {
    /// The value.
    pub value: T,
    /// Whether it was given.
    pub given: bool,
}

impl<T> Given<T> {
    /// A value that nobody has given.
    pub const fn by_default(value: T) -> Self {
        Self { value, given: false }
    }
}

impl<T> From<T> for Given<T> {
    fn from(value: T) -> Self {
        Self { value, given: true }
    }
}

/// Numbers on a grid of so many dimensions at least and at most, or where they are.
#[derive(Clone, Debug, PartialEq)]
pub enum Sampled<const LEAST: usize = 2, const MOST: usize = 2> {
    /// The numbers.
    Here(Samples),
    /// The name of a file that holds them.
    InFile(PathBuf),
}

/// Implements [`Field`] for a type by its kind, a pattern of values and what it is as a value.
macro_rules! field {
    ($type:ty, $kind:ident, $from:expr, $to:expr) => {
        impl Field for $type {
            const KIND: KeyKind = KeyKind::$kind;

            fn from_value(value: &Value) -> Option<Self> {
                let from: fn(&Value) -> Option<Self> = $from;
                from(value)
            }

            fn value(&self) -> Option<Value> {
                let to: fn(&Self) -> Value = $to;
                Some(to(self))
            }

            fn show_files(&mut self, _path: &str, _visit: &mut VisitFile<'_>) {}
        }
    };
}

fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    items_of(value, Value::as_number)
}

fn whole<T: TryFrom<i64>>(value: &Value) -> Option<T> {
    value.as_integer().and_then(|integer| T::try_from(integer).ok())
}

field!(String, Name, |value| value.as_text().map(str::to_owned), |name| name.as_str().into());
field!(f64, Number, Value::as_number, |number| Value::from(*number));
field!(u32, Integer, whole, |integer| Value::from(i64::from(*integer)));
field!(i64, Integer, whole, |integer| Value::from(*integer));
field!(u64, Integer, whole, |integer| Value::from(i64::try_from(*integer).unwrap_or(i64::MAX)));
field!(bool, Flag, Value::as_flag, |flag| Value::from(*flag));
field!([f64; 3], Vector, numbers, |vector| Value::from(*vector));
field!(DVec3, Vector, |value| numbers(value).map(DVec3::from_array), |v| v.to_array().into());
field!([f64; 2], Interval, numbers, |ends| Value::from(*ends));
field!([u32; 2], IntegerPair, |v| items_of(v, whole), |pair| pair.map(i64::from).into());
field!(Tensor, Tensor, tensor::from_value, tensor::to_value);
field!(Complex64, Complex, tensor::entry, |number| match number.im {
    0.0 => number.re.into(),
    im => [number.re, im].into(),
});
field!(Vec<[f64; 2]>, Polygon, |value| value.as_list()?.iter().map(numbers).collect(), |corners| {
    Value::List(corners.iter().map(|corner| Value::from(*corner)).collect())
});

/// An image by its name.
impl Field for PathBuf {
    const KIND: KeyKind = KeyKind::Image;

    fn from_value(value: &Value) -> Option<Self> {
        value.as_text().map(Self::from)
    }

    fn value(&self) -> Option<Value> {
        Some(self.display().to_string().into())
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if !self.to_string_lossy().starts_with(BUILT_IN_PREFIX) {
            visit(path, NamedFile::of(self));
        }
    }
}

/// A direction as scenes write it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// A vector of any length.
    Along(DVec3),
    /// In the x, y plane, so many degrees from x to y.
    Angle(f64),
}

impl Direction {
    /// The unit vector; zero of a vector without direction.
    #[must_use]
    pub fn unit(self) -> DVec3 {
        match self {
            Self::Along(vector) => optics::wave::unit(vector).unwrap_or_default(),
            Self::Angle(degrees) => {
                let angle = degrees.rem_euclid(360.0).to_radians();
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            }
        }
    }
}

field!(
    Direction,
    Direction,
    |value| match value.as_number() {
        Some(degrees) => Some(Self::Angle(degrees)),
        None => numbers(value).map(|vector| Self::Along(DVec3::from_array(vector))),
    },
    |direction| match direction {
        Direction::Along(vector) => vector.to_array().into(),
        Direction::Angle(degrees) => (*degrees).into(),
    }
);
field!(
    [DVec3; 3],
    Axes,
    |value| items_of(value, |axis| numbers(axis).map(DVec3::from_array)),
    |axes| axes.map(|axis| axis.to_array()).into()
);

/// What the names of files of materials end with.
const MATERIAL_ENDINGS: [&str; 2] = [".yml", ".yaml"];

/// Whether the name of a material is that of a file.
pub(super) fn is_material_file(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    MATERIAL_ENDINGS.iter().any(|ending| name.ends_with(ending))
}

/// A material by its name.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialName {
    /// One that comes with the program.
    BuiltIn(String),
    /// One of a file, and what has been read there.
    InFile {
        /// Where the file is.
        path: PathBuf,
        /// The material, once it has been read.
        material: Option<Arc<Material>>,
    },
}

impl MaterialName {
    /// The material; `None` if there is none of that name, or its file has not been read.
    #[must_use]
    pub fn material(&self) -> Option<Arc<Material>> {
        match self {
            Self::BuiltIn(name) => Material::named(name).map(Arc::new),
            Self::InFile { material, .. } => material.clone(),
        }
    }
}

impl Field for MaterialName {
    const KIND: KeyKind = KeyKind::Material;

    fn from_value(value: &Value) -> Option<Self> {
        let name = value.as_text()?;
        Some(if is_material_file(name) {
            Self::InFile { path: name.into(), material: None }
        } else {
            Self::BuiltIn(name.to_owned())
        })
    }

    fn value(&self) -> Option<Value> {
        Some(match self {
            Self::BuiltIn(name) => name.as_str().into(),
            Self::InFile { path, .. } => path.display().to_string().into(),
        })
    }

    fn show_files(&mut self, key: &str, visit: &mut VisitFile<'_>) {
        if let Self::InFile { path, material } = self {
            visit(key, NamedFile { path, material: Some(material) });
        }
    }
}

impl<const LEAST: usize, const MOST: usize> Field for Sampled<LEAST, MOST> {
    const KIND: KeyKind = KeyKind::Samples { dimensions: [LEAST, MOST] };

    fn from_value(value: &Value) -> Option<Self> {
        match value {
            Value::Text(file) => Some(Self::InFile(file.into())),
            _ => {
                let number = |_: &[usize], item: &Value| item.as_number().ok_or_else(String::new);
                Samples::gather(value, [LEAST, MOST], number).ok()?.map(Self::Here)
            }
        }
    }

    fn value(&self) -> Option<Value> {
        Some(match self {
            Self::Here(samples) => samples.into(),
            Self::InFile(file) => file.display().to_string().into(),
        })
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Self::InFile(file) = self {
            visit(path, NamedFile::of(file));
        }
    }

    fn check_against(&self, key: &Key) -> Result<(), String> {
        match self {
            Self::Here(samples) => samples.check(key),
            Self::InFile(_) => Ok(()),
        }
    }
}

/// What the names of files of meshes end with.
pub const MESH_ENDINGS: [&str; 4] = [".stl", ".obj", ".glb", ".gltf"];

/// A closed mesh of triangles, or where it is.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshSource {
    /// The solid that it bounds.
    Here(Arc<Polyhedron>),
    /// The name of a file that holds it.
    InFile(PathBuf),
}

impl Field for MeshSource {
    const KIND: KeyKind = KeyKind::Mesh;

    fn from_value(value: &Value) -> Option<Self> {
        value.as_text().map(|file| Self::InFile(file.into()))
    }

    fn value(&self) -> Option<Value> {
        match self {
            Self::Here(_) => None,
            Self::InFile(file) => Some(file.display().to_string().into()),
        }
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Self::InFile(file) = self {
            visit(path, NamedFile::of(file));
        }
    }
}

impl<T: Field> Field for Option<T> {
    const KIND: KeyKind = T::KIND;

    fn from_value(value: &Value) -> Option<Self> {
        T::from_value(value).map(Some)
    }

    fn value(&self) -> Option<Value> {
        self.as_ref().and_then(T::value)
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Some(field) = self {
            field.show_files(path, visit);
        }
    }

    fn check_against(&self, key: &Key) -> Result<(), String> {
        self.as_ref().map_or(Ok(()), |field| field.check_against(key))
    }
}

impl<T: Field> Field for Given<T> {
    const KIND: KeyKind = T::KIND;

    fn from_value(value: &Value) -> Option<Self> {
        T::from_value(value).map(Self::from)
    }

    fn value(&self) -> Option<Value> {
        self.value.value()
    }

    fn written_value(&self) -> Option<Value> {
        self.value().filter(|_| self.given)
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        self.value.show_files(path, visit);
    }
}

impl<T: Item> Field for Vec<T> {
    const KIND: KeyKind = T::LIST;

    fn from_value(value: &Value) -> Option<Self> {
        value.as_list()?.iter().map(T::from_value).collect()
    }

    fn value(&self) -> Option<Value> {
        Some(Value::List(self.iter().filter_map(T::value).collect()))
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        for (number, item) in self.iter_mut().enumerate() {
            item.show_files(&format!("{path}.{number}"), visit);
        }
    }
}
