//! The tables of a scene file but a device's own.

use super::{Polarizer, Spectrum};
use crate::device::{CoatingLayer, Core, Dispersion, Imperfection, Metal, Request, Show};
use crate::keys::{Given, Key, ValueRange};
use crate::photograph::{Edges, ImageSource};
use cloakroom_trace::{choice, table};
use glam::DVec3;

/// Most pixels a side, and most samples a pixel.
const MOST: i64 = 65_536;

/// The scalar channels a picture can show instead of what the camera sees.
pub const SCALAR_CHANNELS: &[&str] = MapChannel::WORDS.split_at(1).1;

/// The channels that files hold only if a scene lists them.
pub const OPTIONAL_CHANNELS: &[&str] = OptionalChannel::WORDS;

choice! {
    /// The colors of a map.
    pub enum Colormap {
        /// Those that suit the numbers.
        Auto = "auto",
        /// From dark violet by green to yellow, evenly for the eye.
        Viridis = "viridis",
        /// From blue to yellow, alike for people with deficient color vision.
        Cividis = "cividis",
        /// From black by violet to pale yellow.
        Magma = "magma",
        /// Diverging: blue below 0, white at 0, red above.
        BlueRed = "blue-red",
    }
}

choice! {
    /// How rays leave the camera.
    pub enum Projection {
        /// From one point.
        Perspective = "perspective",
        /// Side by side, all in the direction of the line of sight.
        Orthographic = "orthographic",
    }
}

table! {
    /// What a camera is made from, not validated yet. By default it is that of the paper: at x =
    /// -100 cm, looking along +x, 40 degrees wide.
    pub struct CameraSettings {
        /// Where the camera stands.
        position: DVec3 = DVec3::new(-100.0, 0.0, 0.0), "cm", in ValueRange::COORDINATE,
        /// The point in the middle of the picture.
        target: DVec3 = DVec3::new(50.0, 0.0, 0.0), "cm", in ValueRange::COORDINATE,
        /// The direction that is up in the picture; it need not be perpendicular to the view.
        up: DVec3 = DVec3::Y,
        /// Whether rays leave from one point or side by side.
        projection: Projection,
        /// Horizontal field of view of a perspective camera.
        field_of_view: Given<f64> = Given::by_default(40.0), "degrees", in ValueRange::Between(0.0, 180.0),
        /// Width of the view of an orthographic camera, which needs it.
        width: Option<f64>, "cm", in ValueRange::LENGTH,
        /// Width and height of the picture in pixels.
        resolution: [u32; 2] = [1024, 768], in ValueRange::Whole(1, MOST),
        /// Camera rays per pixel.
        samples: u32 = 4, in ValueRange::Whole(1, MOST),
        /// Spends samples where the picture has edges: blocks of 2 x 2 pixels whose first samples
        /// (a quarter of them, at least 4) differ by no more than so many 8-bit steps get no
        /// others. 0: all pixels get all samples.
        adaptive: f64, "8-bit steps", in ValueRange::Within(0.0, 255.0),
        /// Chooses where in its pixel each sample lies.
        seed: u64, in ValueRange::SEED,
        /// The polarizer before the lens; an angle is counted from horizontal, counterclockwise as
        /// the camera sees it.
        polarizer: Polarizer, "degrees",
    }
}

table! {
    /// The light that fills the scene.
    pub struct Light {
        /// Wavelength in vacuum: the mean of the line; used by absorption, interference and materials
        /// wherever colors are not traced by themselves.
        wavelength_nm: f64 = 550.0, "nm", in ValueRange::Within(1e-3, 1e12),
        /// Full width at half maximum of the line, a Gaussian: light whose paths differ by less
        /// than about the square of the wavelength over it interferes; 0 is light of one
        /// wavelength.
        bandwidth_nm: Given<f64> = Given::by_default(100.0), "nm", in ValueRange::Within(0.0, 1e12),
        /// What makes the colors of pictures: `rgb`, light of `wavelength_nm` for red, green and blue;
        /// daylight, `D65`; equal power, `E`; one wavelength, which is then `wavelength_nm`, too; or a
        /// lamp, such as { black_body_k = 2856 } or { lines = [{ wavelength_nm = 546.1 }] }. `auto`:
        /// `D65` where a medium has a law, else `rgb`.
        spectrum: Spectrum, "nm", in ValueRange::Within(380.0, 780.0),
    }
}

impl Light {
    /// The wavelength in vacuum of what is not traced for each color: that of a spectrum of one.
    #[must_use]
    pub fn wavelength_nm(&self) -> f64 {
        match self.spectrum {
            Spectrum::Wavelength(wavelength_nm) => wavelength_nm,
            _ => self.wavelength_nm,
        }
    }
}

choice! {
    /// What is seen beyond the edge of the photograph.
    pub enum Border {
        /// Nothing: light goes past it.
        None = "none",
        /// The photograph mirrored at its edge, again and again.
        Mirror = "mirror",
        /// The photograph again and again.
        Repeat = "repeat",
        /// The colors of its edge.
        Clamp = "clamp",
    }
}

impl Border {
    /// What the filter finds beyond the edges of the image.
    #[must_use]
    pub fn edges(self) -> Edges {
        match self {
            Self::None | Self::Clamp => Edges::Clamp,
            Self::Mirror => Edges::Mirror,
            Self::Repeat => Edges::Repeat,
        }
    }
}

table! {
    /// The photograph: a rectangle with two sides.
    pub struct PhotographSettings {
        /// What hangs there: `builtin:bookshelf` or a file (PNG, JPEG, EXR), relative to the scene
        /// file.
        image: ImageSource = ImageSource::BuiltIn("bookshelf"),
        /// Short for `position = [x, 0, 0]`.
        x: Given<f64> = Given::by_default(50.0), "cm", in ValueRange::COORDINATE,
        /// Its middle; not together with `x`.
        position: Given<DVec3> = Given::by_default(DVec3::new(50.0, 0.0, 0.0)), "cm", in ValueRange::COORDINATE,
        /// The direction that it faces, of any length. It has two sides: who looks straight at
        /// either sees it upright and unmirrored.
        normal: DVec3 = DVec3::NEG_X,
        /// The direction that is up in it; it need not be perpendicular to the normal.
        up: DVec3 = DVec3::Y,
        /// Its width; the height follows from the image. By default 110 cm for the builtin
        /// photograph, for others the smallest that covers the camera's view.
        width: Option<f64>, "cm", in ValueRange::LENGTH,
        /// What is seen beyond its edge, on the rest of its plane: `none`, light goes past; or the
        /// photograph goes on, mirrored at each edge, repeated, or in the colors of its edge (`clamp`).
        /// Then no light gets past the plane.
        border: Border,
    }
}

table! {
    /// What rays see that hit nothing: a color or an image.
    pub struct SurroundingsSettings {
        /// Linear red, green and blue seen by rays that hit nothing.
        color: Given<[f64; 3]> = Given::by_default([0.0; 3]), in ValueRange::Within(0.0, 1e30),
        /// An equirectangular image of the surroundings instead of a color: `builtin:room`, the room
        /// of `builtin:bookshelf`, which goes on over the edges of that photograph for who looks from
        /// the origin, or a file (PNG, JPEG, EXR), relative to the scene file.
        image: Option<ImageSource>,
    }
}

table! {
    /// How rays are followed.
    pub struct TraceSettings {
        /// Branches of a ray weaker than this share of it are not followed but counted as pruned.
        min_power: Given<f64> = Given::by_default(1e-4), in ValueRange::Within(0.0, 1.0),
        /// Largest error of position and optical path on leaving a device.
        tolerance: f64 = 1e-6, "cm", in ValueRange::Between(0.0, 1.0),
        /// Whether every ray of a picture is traced by itself. Else, where neighbouring rays take
        /// the same ways, a few are traced and the others interpolated, within the tolerance.
        exact: bool,
    }
}

choice! {
    /// A channel that files hold only if a scene lists it.
    pub enum OptionalChannel {
        /// The Stokes parameters.
        Stokes = "stokes",
        /// The share of power that has been an extraordinary wave.
        ExtraordinaryShare = "extraordinary_share",
        /// The share of power that the first face reflects.
        FirstFaceReflectance = "first_face_reflectance",
        /// What a pulse takes, its spread and its difference to the empty scene.
        GroupDelay = "group_delay",
        /// How far away a LIDAR at the camera would find what sends its pulse back.
        PulseDepth = "pulse_depth",
        /// The light in bins of wavelengths.
        Spectrum = "spectrum",
    }
}

choice! {
    /// What a PNG shows.
    pub enum MapChannel {
        /// What the camera sees.
        None = "none",
        /// How long light is on its way.
        TimeOfFlight = "time_of_flight",
        /// How far the times of the ways of a pixel spread.
        TimeOfFlightSpread = "time_of_flight_spread",
        /// How much longer light is on its way than without devices.
        TimeOfFlightDifference = "time_of_flight_difference",
        /// How long a pulse is on its way.
        GroupDelay = "group_delay",
        /// How far the pulses of a pixel spread.
        GroupDelaySpread = "group_delay_spread",
        /// How much longer a pulse is on its way than without devices.
        GroupDelayDifference = "group_delay_difference",
        /// How far away a LIDAR finds what sends back its first pulse.
        FirstPulseDepth = "first_pulse_depth",
        /// The same of its strongest pulse.
        StrongestPulseDepth = "strongest_pulse_depth",
        /// The share of power that comes from the photograph.
        Delivered = "delivered",
        /// The share of power that comes from the surroundings.
        Escaped = "escaped",
        /// The share of power that is absorbed.
        Absorbed = "absorbed",
        /// The share of power that was not followed.
        Pruned = "pruned",
        /// The share of power that has been an extraordinary wave.
        ExtraordinaryShare = "extraordinary_share",
        /// The share of power that the first face reflects.
        FirstFaceReflectance = "first_face_reflectance",
    }
}

impl MapChannel {
    /// Its name, one of [`SCALAR_CHANNELS`]; `None` for what the camera sees.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        (self != Self::None).then_some(self.word())
    }
}

table! {
    /// What a picture shows and holds.
    pub struct PictureSettings {
        /// Channels that EXR and NPZ files hold beside those they always do; `stokes` stands for
        /// `stokes.S0` to `stokes.S3`, `group_delay` for that, its spread and its difference,
        /// `pulse_depth` for `first_pulse_depth` and `strongest_pulse_depth`, `spectrum` for the light in 16 bins of wavelengths, where the scene has a spectrum.
        channels: Vec<OptionalChannel>,
        /// A channel that a PNG shows in false colors instead of what the camera sees.
        map: MapChannel,
        /// Whether the scale of a map is drawn beside it.
        color_bar: bool = true,
        /// The numbers of a map with its first and its last color, ns for times and shares for
        /// powers; by default the least and the greatest, but for outliers.
        map_range: Option<[f64; 2]>,
        /// Instead of these, how much of the numbers lies in the range, as many being above it as
        /// below.
        map_percentile: Option<f64>, "%", in ValueRange::Within(1.0, 100.0),
        /// The colors of a map. `auto`: viridis, or blue-red for differences of both signs.
        /// `blue-red` has white at 0 and the same range to both sides of it.
        colormap: Colormap,
    }
}

table! {
    /// What every device takes beside its `kind` and its kind's own keys.
    pub struct Placement {
        /// What it is called in messages, in lists, and in overrides: `left.rotation=5`. No two
        /// devices have one name, and none that of a table.
        name: Option<String>,
        /// The cloak, the bare metal alone, the mirror it should look like, or nothing in its place.
        show: Show,
        /// What fills the hidden region of a free-space cloak: metal, or air in which bodies may
        /// stand. A carpet needs its mirror.
        core: Core,
        /// Turns the device about its own z axis, counterclockwise seen from the end that the axis
        /// points to.
        rotation: f64, "degrees", in ValueRange::ANGLE,
        /// Where the device's own z axis points, of any length: the shortest turn of z to it, after
        /// `rotation`; to -z by 180 degrees about x.
        axis: DVec3 = DVec3::Z,
        /// Where the device's own origin lies.
        position: DVec3, "cm", in ValueRange::COORDINATE,
        /// Whole length along the device's z axis; endless where it is absent.
        length: Option<f64>, "cm", in ValueRange::LENGTH,
        /// How its media depend on the frequency: what a pulse takes, in `group_delay` and where
        /// the phase runs backwards. `causal`: as little as causality allows, a bound for every
        /// real device; `none`: as the phase. `drude` and `lorentz` say what light of other
        /// wavelengths meets, too, through what the design says at `design_wavelength_nm`. Materials
        /// have their own laws.
        dispersion: Dispersion,
        /// The wavelength in vacuum for which the device is designed.
        design_wavelength_nm: f64 = Request::DESIGN_WAVELENGTH_NM, "nm", in ValueRange::Within(1e-3, 1e12),
        /// The wavelength of the resonance of `lorentz`, below that of the design: half of it by
        /// default.
        resonance_nm: Option<f64>, "nm", in ValueRange::Within(1e-3, 1e12),
        /// Thin layers on all of its surfaces that face the outside, from the outside inwards; each
        /// a table with its thickness and its index or permittivity.
        coating: Vec<CoatingLayer>,
        /// What its metal is of: { index = [n, k] } or { material = "silver" }; a perfect conductor
        /// by default. A body is of metal where this says so, true for a perfect conductor.
        metal: Option<Metal>,
        /// How what is made of it differs from its design: random errors, levels, a limited range,
        /// loss.
        imperfection: Option<Imperfection>,
    }
}

table! {
    /// A rectangle on which light is received, from the side that its normal points to.
    pub struct Receiver {
        /// The middle of the rectangle on which light is received.
        position: DVec3 = DVec3::new(50.0, 0.0, 0.0), "cm", in ValueRange::COORDINATE,
        /// The direction that it faces, of any length: light is received from there.
        normal: DVec3 = DVec3::NEG_X,
        /// Its size across the z axis.
        width: f64 = 60.0, "cm", in ValueRange::LENGTH,
        /// Its size along the z axis; of no matter where all devices are endless along z.
        length: f64 = 60.0, "cm", in ValueRange::LENGTH,
    }
}

/// The tables that stand at most once in a scene, in the order in which they are documented.
pub static TABLES: &[(&str, &[Key])] = &[
    ("camera", CameraSettings::KEYS),
    ("light", Light::KEYS),
    ("photograph", PhotographSettings::KEYS),
    ("surroundings", SurroundingsSettings::KEYS),
    ("trace", TraceSettings::KEYS),
    ("picture", PictureSettings::KEYS),
    ("receiver", Receiver::KEYS),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::CATALOGUE;
    use cloakroom_trace::key;

    #[test]
    fn every_default_is_allowed_and_every_name_is_there_once() {
        let tables = TABLES.iter().copied().chain([("device", Placement::KEYS)]);
        for (table, keys) in tables.chain(CATALOGUE.iter().map(|entry| (entry.kind, entry.keys))) {
            for (i, key) in keys.iter().enumerate() {
                if let Some(value) = (key.default)() {
                    assert_eq!(key.check(&value), Ok(value), "{table}.{}", key.name);
                }
                assert!(keys[..i].iter().all(|earlier| earlier.name != key.name));
                assert!(key.doc.ends_with('.'), "{table}.{}", key.name);
            }
        }
    }

    #[test]
    fn what_devices_are_asked_for_is_named_as_their_placement_names_it() {
        let named = [key!(Request.show), key!(Request.length), key!(Request.core)];
        assert_eq!(named, [key!(Placement.show), key!(Placement.length), key!(Placement.core)]);
    }
}
