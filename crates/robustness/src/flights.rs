//! Light in flight: all of it is in some bin or beside them, as much as the maps say, and it arrives when they say.

use crate::draws::Draws;
use crate::scenes::scene_seen;
use cloakroom::render::{
    Arrivals, ChannelSet, Delay, Flash, FlightCube, FlightSettings, Gate, PreparedScene,
    Supervision, arrival_times, render,
};
use cloakroom::scene::DeviceSettings;
use cloakroom::scene_file::{self, Loaded};
use optics::wave::SPEED_OF_LIGHT;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use toml::{Table, Value};

/// Width and height of the pictures: six patches.
const SIZE: [i64; 2] = [96, 64];

/// Samples of a pixel.
const SAMPLES: i64 = 2;

/// So many scenes are drawn until one is not refused, at most.
const MOST_DRAWN: u64 = 16;

/// Bins of a gate, about: a cube of them is small.
const BINS: usize = 40;

/// What sums may be off by: of light that is 1 where it is brightest.
const CLOSED: f64 = 1e-12;

/// Light of one wavelength (nm), and lamps.
const SPECTRA: [(&str, Option<f64>); 5] = [
    ("\"rgb\"", None),
    ("\"D65\"", None),
    ("{ black_body_k = 2856 }", None),
    ("650", Some(650.0)),
    ("{ lines = [{ wavelength_nm = 436, power = 2 }] }", Some(436.0)),
];

/// What times may be off by, cm of vacuum: ways are interpolated where a picture is made, and not where
/// light is timed; and what pulses take is worked out less exactly.
const INTERPOLATED: f64 = 1e-6;
const OF_PULSES: f64 = 1e-4;

/// Looks at a random device when the photograph flashes; how many rays that takes.
///
/// # Panics
///
/// If light is missing, or the maps have other light or another time.
pub fn fly(draws: &mut Draws<'_>) -> u64 {
    let found = (1..=MOST_DRAWN).find_map(|drawn| sound(draws).map(|sound| (drawn, sound)));
    let Some((drawn, (text, nm, loaded))) = found else { return MOST_DRAWN };
    let delay = if draws.chance(128) { Delay::Group } else { Delay::Phase };
    // The whole flight, or a part of it.
    let part =
        if draws.chance(128) { [0.0, 1.0] } else { [draws.between(0.0, 0.4), draws.share()] };
    let long = if draws.chance(128) { 0.0 } else { draws.between(0.1, 3.0) };
    let Ok(prepared) = PreparedScene::new(&loaded.scene) else { return drawn };
    let arrivals = Arrivals { delay, flash: Flash::Photograph };
    let Some([first, last]) = arrival_times(&prepared, &arrivals) else { return drawn };
    let [from, to] = part.map(|share| first + share * (last - first));
    let gate = Gate::around([from.min(to), from.max(to)], BINS);
    let settings = FlightSettings { gate, width: long * gate.step(), arrivals };
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    let (cube, _) = FlightCube::new(&prepared, &settings, &supervision).expect("light in flight");
    let picture =
        render(&prepared, ChannelSet::Everything, &supervision).expect("a picture").picture;
    let channel = |name: &str| &picture.channel(name).expect("a channel").samples;
    let delivered = channel("delivered");
    let times = channel(match delay {
        Delay::Group => "group_delay",
        Delay::Phase => "time_of_flight",
    });
    let pixels = cube.size[0] * cube.size[1];
    // Each color goes its own way at its own time then, and the map is of one.
    let structures = || prepared.assembly.devices().iter().map(|device| &device.structure);
    let changes = loaded.scene.devices.iter().any(DeviceSettings::is_dispersive)
        || prepared.assembly.absorbs()
        || structures().any(|structure| structure.films.iter().flatten().next().is_some());
    let is_colored = nm.is_none() && changes;
    for pixel in 0..pixels {
        let told = || format!("pixel {pixel}, {settings:?}:\n{text}");
        let bins = || (pixel..cube.light.len()).step_by(pixels);
        for color in 0..3 {
            let within: f64 = bins().map(|bin| cube.light[bin][color]).sum();
            let beside: f64 = cube.beside.iter().map(|all| all[pixel][color]).sum();
            let (sum, all) =
                (within + beside + cube.steady[pixel][color], cube.picture[pixel][color]);
            assert!((sum - all).abs() <= CLOSED, "{sum} and not {all} of light: {}", told());
        }
        let power: f64 = bins().map(|bin| cube.power[bin]).sum();
        let beside: f64 = cube.beside.iter().map(|all| all[pixel][3]).sum();
        if is_colored {
            continue;
        }
        let (all, wanted) = (power + beside, delivered.get(pixel));
        assert!((all - wanted).abs() < INTERPOLATED, "{all} and not {wanted}: {}", told());
        let time = times.get(pixel);
        if beside != 0.0 || power < CLOSED || !time.is_finite() {
            continue;
        }
        let moments = gate.middles().into_iter().zip(bins());
        let mean = moments.map(|(time, bin)| time * cube.power[bin]).sum::<f64>() / power;
        let off = (mean - time).abs() * SPEED_OF_LIGHT;
        // Of long ways and of weak light there are fewer digits.
        let exact = if delay == Delay::Group { OF_PULSES } else { INTERPOLATED };
        let most = exact * time.abs().max(1.0) / power.min(1.0);
        assert!(off < most, "light comes at {mean} and not at {time} ns: {}", told());
    }
    (2 * SAMPLES * SIZE[0] * SIZE[1]).unsigned_abs()
}

/// A random scene, if it is not refused: its text, the wavelength (nm) of its light, if it is one, and the scene.
fn sound(draws: &mut Draws<'_>) -> Option<(String, Option<f64>, Loaded)> {
    let mut scene = scene_seen(draws, SIZE, SAMPLES);
    // Coarser ways differ by more than is looked for.
    let trace: [(_, Value); 1] = [("tolerance", 1e-8.into())];
    let picture: [(_, Value); 1] = [("channels", vec!["group_delay"].into())];
    for (table, keys) in [("trace", trace), ("picture", picture)] {
        let keys = keys.map(|(key, value)| (key.to_owned(), value));
        scene.insert(table.to_owned(), Value::Table(Table::from_iter(keys)));
    }
    let (spectrum, nm) = draws.pick(&SPECTRA);
    let of_maps = nm.map_or(String::new(), |nm| format!("wavelength_nm = {nm}\n"));
    let text = format!("{scene}[light]\nspectrum = {spectrum}\n{of_maps}");
    let loaded = scene_file::parse(&text, "soak", Path::new("/nowhere"), &[]).ok()?;
    PreparedScene::new(&loaded.scene).is_ok().then_some((text, *nm, loaded))
}
