//! The keys of every table of a scene file but a device's own.

use crate::device::IMPERFECTION_KEYS;
use crate::keys::{Key, KeyKind, Limits};

/// Most pixels a side, and most samples a pixel.
const MOST: i64 = super::camera::MOST as i64;

/// The scalar channels a picture can show instead of what the camera sees.
pub const SCALAR_CHANNELS: &[&str] = &[
    "time_of_flight",
    "time_of_flight_spread",
    "time_of_flight_difference",
    "delivered",
    "escaped",
    "absorbed",
    "pruned",
    "extraordinary_share",
    "first_face_reflectance",
];

/// The channels that files hold only if a scene lists them.
pub const OPTIONAL_CHANNELS: &[&str] = &["stokes", "extraordinary_share", "first_face_reflectance"];

/// `[camera]`.
pub static CAMERA_KEYS: &[Key] = &[
    Key {
        name: "position",
        doc: "Where the camera stands.",
        kind: vector([-100.0, 0.0, 0.0], "cm", Limits::COORDINATE),
    },
    Key {
        name: "target",
        doc: "The point in the middle of the picture.",
        kind: vector([50.0, 0.0, 0.0], "cm", Limits::COORDINATE),
    },
    Key {
        name: "up",
        doc: "The direction that is up in the picture; it need not be perpendicular to the view.",
        kind: vector([0.0, 1.0, 0.0], "", Limits::Finite),
    },
    Key {
        name: "projection",
        doc: "Whether rays leave from one point or side by side.",
        kind: KeyKind::Choice { options: &["perspective", "orthographic"] },
    },
    Key {
        name: "field_of_view",
        doc: "Horizontal field of view of a perspective camera.",
        kind: number(40.0, "degrees", Limits::Between(0.0, 180.0)),
    },
    Key {
        name: "width",
        doc: "Width of the view of an orthographic camera, which needs it.",
        kind: KeyKind::Number { default: None, unit: "cm", limits: Limits::LENGTH },
    },
    Key {
        name: "resolution",
        doc: "Width and height of the picture in pixels.",
        kind: KeyKind::IntegerPair { default: [1024, 768], min: 1, max: MOST },
    },
    Key {
        name: "samples",
        doc: "Camera rays per pixel.",
        kind: KeyKind::Integer { default: 4, min: 1, max: MOST },
    },
    Key {
        name: "adaptive",
        doc: "Spends samples where the picture has edges: blocks of 2 x 2 pixels whose first samples (a \
              quarter of them, at least 4) differ by no more than so many 8-bit steps get no others. 0: all \
              pixels get all samples.",
        kind: number(0.0, "8-bit steps", Limits::Within(0.0, 255.0)),
    },
    Key {
        name: "seed",
        doc: "Chooses where in its pixel each sample lies.",
        kind: KeyKind::Integer { default: 0, min: 0, max: i64::MAX },
    },
    Key {
        name: "polarizer",
        doc: "The polarizer before the lens; an angle is counted from horizontal, \
              counterclockwise as the camera sees it.",
        kind: KeyKind::ChoiceOrNumber {
            options: &["none", "horizontal", "vertical"],
            unit: "degrees",
        },
    },
];

/// `[light]`.
pub static LIGHT_KEYS: &[Key] = &[Key {
    name: "wavelength_nm",
    doc: "Wavelength in vacuum; used by absorption only.",
    kind: number(550.0, "nm", Limits::Within(1e-3, 1e12)),
}];

/// `[photograph]`.
pub static PHOTOGRAPH_KEYS: &[Key] = &[
    Key {
        name: "image",
        doc: "What hangs there: `builtin:bookshelf` or a file (PNG, JPEG, EXR), relative to the \
              scene file.",
        kind: KeyKind::Image { default: Some("builtin:bookshelf") },
    },
    Key {
        name: "x",
        doc: "The plane of constant x it hangs in.",
        kind: number(50.0, "cm", Limits::COORDINATE),
    },
    Key {
        name: "width",
        doc: "Its width; the height follows from the image. By default 110 cm for the builtin \
              photograph, for others the smallest that covers the camera's view.",
        kind: KeyKind::Number { default: None, unit: "cm", limits: Limits::LENGTH },
    },
];

/// `[surroundings]`.
pub static SURROUNDINGS_KEYS: &[Key] = &[
    Key {
        name: "color",
        doc: "Linear red, green and blue seen by rays that hit nothing.",
        kind: vector([0.0, 0.0, 0.0], "", Limits::Within(0.0, 1e30)),
    },
    Key {
        name: "image",
        doc: "An equirectangular image of the surroundings instead of a color, relative to the \
              scene file.",
        kind: KeyKind::Image { default: None },
    },
];

/// `[trace]`.
pub static TRACE_KEYS: &[Key] = &[
    Key {
        name: "min_power",
        doc: "Branches of a ray weaker than this share of it are not followed but counted as \
              pruned.",
        kind: number(1e-4, "", Limits::Within(0.0, 1.0)),
    },
    Key {
        name: "tolerance",
        doc: "Largest error of position and optical path on leaving a device.",
        kind: number(1e-6, "cm", Limits::Positive),
    },
];

/// `[picture]`.
pub static PICTURE_KEYS: &[Key] = &[
    Key {
        name: "channels",
        doc: "Channels that EXR and NPZ files hold beside those they always do; `stokes` stands \
              for `stokes.S0` to `stokes.S3`.",
        kind: KeyKind::Choices { options: OPTIONAL_CHANNELS },
    },
    Key {
        name: "map",
        doc: "A channel that a PNG shows in false colors instead of what the camera sees.",
        kind: KeyKind::Choice { options: &MAP_OPTIONS },
    },
    Key {
        name: "color_bar",
        doc: "Whether the scale of a map is drawn beside it.",
        kind: KeyKind::Flag { default: true },
    },
];

/// What every `[[device]]` takes beside its `kind` and its kind's own keys.
pub static PLACEMENT_KEYS: &[Key] = &[
    Key {
        name: "show",
        doc: "The cloak, the bare metal alone, or the mirror it should look like.",
        kind: KeyKind::Choice { options: &["cloak", "bare", "mirror"] },
    },
    Key {
        name: "core",
        doc: "What fills the hidden region of a free-space cloak: metal, or air in which bodies may stand. \
              A carpet needs its mirror.",
        kind: KeyKind::Choice { options: &["metal", "open"] },
    },
    Key {
        name: "rotation",
        doc: "Turns the device about its own axis, counterclockwise seen from +z.",
        kind: number(0.0, "degrees", Limits::ANGLE),
    },
    Key {
        name: "position",
        doc: "Where the device's own origin lies.",
        kind: vector([0.0, 0.0, 0.0], "cm", Limits::COORDINATE),
    },
    Key {
        name: "length",
        doc: "Whole length along the device's z axis; endless where it is absent.",
        kind: KeyKind::Number { default: None, unit: "cm", limits: Limits::LENGTH },
    },
    Key {
        name: "imperfection",
        doc: "How what is made of it differs from its design: random errors, levels, a limited range, loss.",
        kind: KeyKind::Table { keys: IMPERFECTION_KEYS },
    },
];

/// `[receiver]`.
pub static RECEIVER_KEYS: &[Key] = &[
    Key {
        name: "position",
        doc: "The middle of the rectangle on which light is received.",
        kind: vector([50.0, 0.0, 0.0], "cm", Limits::COORDINATE),
    },
    Key {
        name: "normal",
        doc: "The direction that it faces, of any length: light is received from there.",
        kind: vector([-1.0, 0.0, 0.0], "", Limits::Finite),
    },
    Key {
        name: "width",
        doc: "Its size across the z axis.",
        kind: number(60.0, "cm", Limits::LENGTH),
    },
    Key {
        name: "length",
        doc: "Its size along the z axis; of no matter where all devices are endless along z.",
        kind: number(60.0, "cm", Limits::LENGTH),
    },
];

/// The tables that stand at most once in a scene, in the order in which they are documented.
pub static TABLES: &[(&str, &[Key])] = &[
    ("camera", CAMERA_KEYS),
    ("light", LIGHT_KEYS),
    ("photograph", PHOTOGRAPH_KEYS),
    ("surroundings", SURROUNDINGS_KEYS),
    ("trace", TRACE_KEYS),
    ("picture", PICTURE_KEYS),
    ("receiver", RECEIVER_KEYS),
];

/// "none", then every scalar channel.
static MAP_OPTIONS: [&str; 1 + SCALAR_CHANNELS.len()] = {
    let mut options = ["none"; 1 + SCALAR_CHANNELS.len()];
    let mut i = 0;
    while i < SCALAR_CHANNELS.len() {
        options[i + 1] = SCALAR_CHANNELS[i];
        i += 1;
    }
    options
};

const fn number(default: f64, unit: &'static str, limits: Limits) -> KeyKind {
    KeyKind::Number { default: Some(default), unit, limits }
}

const fn vector(default: [f64; 3], unit: &'static str, limits: Limits) -> KeyKind {
    KeyKind::Vector { default, unit, limits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Values;

    #[test]
    fn every_default_is_allowed_and_every_name_is_there_once() {
        let tables = TABLES.iter().copied().chain([("device", PLACEMENT_KEYS)]);
        for (table, keys) in tables {
            let defaults = Values::defaults(keys);
            let mut values = defaults.clone();
            for (i, key) in keys.iter().enumerate() {
                if let Some(value) = defaults.get(key.name) {
                    let set = values.set(key.name, value);
                    assert_eq!(set, Ok(()), "{table}.{}", key.name);
                }
                assert!(keys[..i].iter().all(|earlier| earlier.name != key.name));
                assert!(key.doc.ends_with('.'), "{table}.{}", key.name);
            }
        }
    }
}
