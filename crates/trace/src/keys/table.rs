//! Tables: structs whose fields are keys.

use super::{Key, KeyError, Value, VisitFile, unknown};

/// A table of a scene, such as the camera or a device, as a struct: [`table!`](crate::table)
/// implements it.
pub trait Table {
    /// The keys, in the order of the fields.
    fn keys(&self) -> &'static [Key];

    /// The value of a key, as one would hand it over; `None` where there is no such key, or it is
    /// absent and its absence means something.
    fn get(&self, name: &str) -> Option<Value>;

    /// The keys that a scene has to write for this table.
    fn written(&self) -> Vec<(String, Value)>;

    /// Gives a key a value that it has let through; false if the value is of another type.
    fn put(&mut self, name: &str, value: &Value) -> bool;

    /// Shows the names of files in it, with the paths of their keys; `path` is that of the table.
    fn visit_files(&mut self, path: &str, visit: &mut VisitFile<'_>);

    /// Holds every field against its key: those of a struct may be anything.
    ///
    /// # Errors
    ///
    /// At the first key whose value is outside its limits.
    fn check(&self) -> Result<(), KeyError>;

    /// Gives a key a value.
    ///
    /// # Errors
    ///
    /// If there is no such key, the value is of the wrong type or outside the limits; the old
    /// value then stays.
    fn set(&mut self, name: &str, value: Value) -> Result<(), KeyError> {
        let key = find(self.keys(), name)?;
        let value = key.check(&value).map_err(|message| KeyError::at(key.name, message))?;
        if self.put(key.name, &value) {
            return Ok(());
        }
        Err(KeyError::at(key.name, key.wrong_type(&value)))
    }
}

/// The key of that name.
///
/// # Errors
///
/// A message with the nearest name if there is none.
pub fn find(keys: &'static [Key], name: &str) -> Result<&'static Key, KeyError> {
    keys.iter().find(|key| key.name == name).ok_or_else(|| {
        let known: Vec<_> = keys.iter().map(|key| key.name).collect();
        KeyError::general(unknown("key", name, "", &known))
    })
}

/// Whether one of the keys has that name.
#[must_use]
pub fn has(keys: &[Key], name: &str) -> bool {
    keys.iter().any(|key| key.name == name)
}

/// The keys of two tables, one after the other.
///
/// # Panics
///
/// If they are not `N` together, or none.
#[must_use]
pub const fn joined<const N: usize>(first: &[Key], second: &[Key]) -> [Key; N] {
    assert!(first.len() + second.len() == N, "all keys");
    let mut keys = [first[0]; N];
    let mut i = 0;
    while i < N {
        keys[i] = if i < first.len() { first[i] } else { second[i - first.len()] };
        i += 1;
    }
    keys
}

/// Makes a table of a scene: the struct, its keys, its defaults, and the way from values to fields
/// and back.
///
/// A field is a key. Its doc comment is what people are told about the key; after its type come its
/// default (where it is not that of the type), the unit of its numbers and their limits:
///
/// ```
/// use cloakroom_trace::keys::{ValueRange, Table};
///
/// cloakroom_trace::choice! {
///     /// What a plate is made of.
///     pub enum Material {
///         /// Ordinary glass.
///         Glass = "glass",
///         /// Silver, a perfect conductor.
///         Silver = "silver",
///     }
/// }
///
/// cloakroom_trace::table! {
///     /// A plate of something.
///     pub struct Plate {
///         /// What it is made of.
///         material: Material,
///         /// How thick it is.
///         thickness: f64 = 0.5, "cm", in ValueRange::LENGTH,
///         /// How many of them stand in a row.
///         count: u32 = 1, in ValueRange::Whole(1, 100),
///         /// Its whole length; endless where it is absent.
///         length: Option<f64>, "cm", in ValueRange::LENGTH,
///     }
/// }
///
/// let mut plate = Plate { material: Material::Silver, ..Plate::default() };
/// plate.set("thickness", 2.0.into())?;
/// assert_eq!((plate.thickness, plate.length), (2.0, None));
/// assert_eq!(Plate::KEYS[1].unit, "cm");
/// # Ok::<(), cloakroom_trace::keys::KeyError>(())
/// ```
///
/// The type of a field is one of those that implement [`Field`](crate::keys::Field); a table may
/// hold tables. `pub struct Plate with words: Words` adds the keys of the table `Words` to its own,
/// in the field `words`.
#[macro_export]
macro_rules! table {
    (
        $(#[doc = $about:literal])+
        pub struct $table:ident $(with $more:ident : $more_type:ty)? {
            $(
                $(#[doc = $doc:literal])+
                $name:ident : $type:ty $(= $default:expr)? $(, $unit:literal)? $(, in $limits:expr)?
            ),* $(,)?
        }
    ) => {
        $(#[doc = $about])+
        #[allow(rustdoc::broken_intra_doc_links, reason = "brackets are vectors and tables")]
        #[derive(Clone, Debug, PartialEq)]
        pub struct $table {
            $(
                $(#[doc = $doc])+
                $(#[doc = concat!("\n\nIn ", $unit, ".")])?
                pub $name: $type,
            )*
            $(
                /// The keys that it shares with other tables.
                pub $more: $more_type,
            )?
        }

        impl Default for $table {
            fn default() -> Self {
                Self {
                    $($name: $crate::table!(@default $($default)?),)*
                    $($more: <$more_type>::default(),)?
                }
            }
        }

        impl $table {
            /// What it is, in a sentence or two.
            pub const SUMMARY: &'static str = concat!($($about),+).trim_ascii_start();

            /// Its keys.
            pub const KEYS: &'static [$crate::keys::Key] = {
                const OWN: &[$crate::keys::Key] = &[$($crate::keys::Key {
                    name: stringify!($name),
                    doc: concat!($($doc),+).trim_ascii_start(),
                    kind: <$type as $crate::keys::Field>::KIND,
                    unit: concat!($($unit)?),
                    limits: $crate::table!(@limits $($limits)?),
                    default: || $crate::keys::Field::value(&$table::default().$name),
                }),*];
                $crate::table!(@keys OWN $(, $more_type)?)
            };
        }

        impl $crate::keys::Table for $table {
            fn keys(&self) -> &'static [$crate::keys::Key] {
                Self::KEYS
            }

            fn get(&self, name: &str) -> Option<$crate::keys::Value> {
                match name {
                    $(stringify!($name) => $crate::keys::Field::value(&self.$name),)*
                    $(_ if $crate::keys::has(<$more_type>::KEYS, name) => $crate::keys::Table::get(&self.$more, name),)?
                    _ => None,
                }
            }

            fn written(&self) -> Vec<(String, $crate::keys::Value)> {
                let entries = [$((stringify!($name), $crate::keys::Field::written_value(&self.$name))),*];
                let own = entries.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
                own$(.chain($crate::keys::Table::written(&self.$more)))?.collect()
            }

            fn put(&mut self, name: &str, value: &$crate::keys::Value) -> bool {
                match name {
                    $(stringify!($name) => {
                        $crate::keys::Field::from_value(value).map(|field| self.$name = field).is_some()
                    })*
                    $(_ if $crate::keys::has(<$more_type>::KEYS, name) => $crate::keys::Table::put(&mut self.$more, name, value),)?
                    _ => false,
                }
            }

            fn visit_files(&mut self, path: &str, visit: &mut $crate::keys::VisitFile<'_>) {
                $($crate::keys::Field::show_files(
                    &mut self.$name,
                    &format!("{path}.{}", stringify!($name)),
                    visit,
                );)*
                $($crate::keys::Table::visit_files(&mut self.$more, path, visit);)?
            }

            fn check(&self) -> Result<(), $crate::keys::KeyError> {
                let mut keys = Self::KEYS.iter();
                $(if let Some(key) = keys.next() {
                    $crate::keys::Field::check_against(&self.$name, key)
                        .map_err(|message| $crate::keys::KeyError::at(key.name, message))?;
                })*
                $($crate::keys::Table::check(&self.$more)?;)?
                Ok(())
            }
        }

        impl $crate::keys::Field for $table {
            const KIND: $crate::keys::KeyKind = $crate::keys::KeyKind::Table { keys: Self::KEYS };

            fn from_value(value: &$crate::keys::Value) -> Option<Self> {
                let mut table = Self::default();
                let fits = value.as_table()?.iter().all(|(name, value)| {
                    $crate::keys::Table::put(&mut table, name, value)
                });
                fits.then_some(table)
            }

            fn value(&self) -> Option<$crate::keys::Value> {
                Some($crate::keys::Value::Table($crate::keys::Table::written(self)))
            }

            fn show_files(&mut self, path: &str, visit: &mut $crate::keys::VisitFile<'_>) {
                $crate::keys::Table::visit_files(self, path, visit);
            }
        }

        impl $crate::keys::Item for $table {
            const LIST: $crate::keys::KeyKind = $crate::keys::KeyKind::Tables { keys: Self::KEYS };
        }
    };
    (@keys $own:ident) => { $own };
    (@keys $own:ident, $more:ty) => {{
        const ALL: [$crate::keys::Key; $own.len() + <$more>::KEYS.len()] =
            $crate::keys::joined($own, <$more>::KEYS);
        &ALL
    }};
    (@default) => { Default::default() };
    (@default $default:expr) => { $default };
    (@limits) => { $crate::keys::ValueRange::Finite };
    (@limits $limits:expr) => { $limits };
}

/// Makes the words that a key can be; the first is the default. See [`table!`](crate::table).
#[macro_export]
macro_rules! choice {
    (
        $(#[doc = $about:literal])+
        pub enum $choice:ident {
            $(#[doc = $first_doc:literal])+
            $first:ident = $first_word:literal,
            $($(#[doc = $doc:literal])+ $option:ident = $word:literal,)*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum $choice {
            $(#[doc = $first_doc])+
            #[default]
            $first,
            $($(#[doc = $doc])+ $option,)*
        }

        impl $choice {
            /// All of the words, in their order.
            pub const WORDS: &'static [&'static str] = &[$first_word $(, $word)*];

            const ALL: &'static [Self] = &[Self::$first $(, Self::$option)*];

            /// The word as scenes write it.
            #[must_use]
            pub const fn word(self) -> &'static str {
                Self::WORDS[self as usize]
            }
        }

        impl $crate::keys::Field for $choice {
            const KIND: $crate::keys::KeyKind = $crate::keys::KeyKind::Choice { options: Self::WORDS };

            fn from_value(value: &$crate::keys::Value) -> Option<Self> {
                let word = value.as_text()?;
                Self::ALL.iter().copied().find(|choice| choice.word() == word)
            }

            fn value(&self) -> Option<$crate::keys::Value> {
                Some(self.word().into())
            }

            fn show_files(&mut self, _path: &str, _visit: &mut $crate::keys::VisitFile<'_>) {}
        }

        impl $crate::keys::Item for $choice {
            const LIST: $crate::keys::KeyKind = $crate::keys::KeyKind::Choices { options: Self::WORDS };
        }
    };
}

/// The name of a key of a table, `key!(SquareCloak.kappa)`, which the compiler knows to be one.
#[macro_export]
macro_rules! key {
    ($table:ident . $name:ident) => {{
        let _ = |table: &$table| _ = &table.$name;
        stringify!($name)
    }};
}
