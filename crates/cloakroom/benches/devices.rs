//! Rays through every device of the catalogue, one at a time, as `cloakroom trace` follows them; a
//! new device, and each word that one of its keys takes, is here by itself.
//!
//! `cargo bench -p cloakroom --bench devices`; items are rays. What a device's error is for,
//! `trace.tolerance`, is the default, 1e-6 cm; branches are followed down to the default share of
//! the power, too. In `surfaces` items are what they meet.

use cloakroom::assembly::Assembly;
use cloakroom::device::{CATALOGUE, InnerRay, Region};
use cloakroom::keys::KeyKind;
use cloakroom::scene::Scene;
use cloakroom::scene_file;
use cloakroom::trace::{FourTracers, Launch, Limits, PathRecorder, PathSegment, Tracer};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use optics::medium::ModeKind;
use optics::wave::transverse_basis;
use std::path::Path;

fn main() {
    divan::main();
}

/// Rays in one go.
const RAYS: u32 = 256;

/// The keys of kinds that are nothing without: a prism of glass, a ball of glass, hills of the
/// index.
const NEEDED: [(&str, &str); 3] = [
    (
        "graded",
        "index = [[1, 1, 1, 1, 1], [1, 1.2, 1, 1.4, 1], [1, 1, 1.3, 1, 1], [1, 1.4, 1, 1.2, 1], [1, 1, 1, 1, 1]]\n",
    ),
    ("prisms", "[[device.prism]]\ncorners = [[-8, -6], [8, -6], [0, 9]]\npermittivity = 2.25\n"),
    ("body", "permittivity = 2.25\n"),
];

/// Every kind, then each of its words but the first: `cylinder-cloak`, `cylinder-cloak
/// material=radial-uniaxial`.
fn devices() -> Vec<String> {
    let words = |key: &cloakroom::keys::Key| match key.kind {
        KeyKind::Choice { options } => options[1..].to_vec(),
        _ => Vec::new(),
    };
    let mut names = Vec::new();
    for entry in CATALOGUE {
        names.push(entry.kind.to_owned());
        for key in entry.keys {
            let named = |word| format!("{} {}={word}", entry.kind, key.name);
            names.extend(words(key).into_iter().map(named));
        }
    }
    names
}

fn scene(name: &str) -> Scene {
    let mut words = name.split(' ');
    let kind = words.next().unwrap_or_default();
    let mut text = format!("[[device]]\nkind = \"{kind}\"\nrotation = 10\n");
    for (key, word) in words.filter_map(|word| word.split_once('=')) {
        text += &format!("{key} = \"{word}\"\n");
    }
    if name == "graded shape=ball" {
        text += &hilly_ball();
    } else {
        text.extend(NEEDED.iter().filter(|(needs, _)| *needs == kind).map(|(_, keys)| *keys));
    }
    let loaded = scene_file::parse(&text, name, Path::new(""), &[]);
    loaded.expect("a sound scene").scene
}

/// Hills of the index in space.
fn hilly_ball() -> String {
    let five = 0..5_u32;
    let line = |i: u32, j: u32| -> Vec<f64> {
        five.clone().map(|k| 1.0 + 0.1 * f64::from((i + 2 * j + 3 * k) % 4)).collect()
    };
    let layer = |i: u32| -> Vec<Vec<f64>> { five.clone().map(|j| line(i, j)).collect() };
    format!(
        "width = 20\nheight = 20\nlength = 20\nindex = {:?}\n",
        five.clone().map(layer).collect::<Vec<_>>()
    )
}

fn assembly(scene: &Scene) -> Assembly {
    cloakroom::render::assembly(scene).expect("a sound device")
}

fn limits(scene: &Scene) -> Limits {
    Limits { min_power: scene.trace.min_power.value, tolerance: scene.trace.tolerance }
}

/// Rays of a camera 100 cm before the device, or above the floor of a carpet, in blocks of 2 x 2
/// neighbours over a square 16 cm wide, with two polarizations.
fn launches(name: &str) -> Vec<Launch<2>> {
    let (origin, middle) = if name.contains("carpet") {
        (DVec3::new(-70.0, 70.0, 0.0), 9.0)
    } else {
        (DVec3::new(-100.0, 0.0, 0.0), 0.0)
    };
    let launch = |n: u32| {
        let (block, member) = (n / 4, n % 4);
        // An additive recurrence with the powers of the root of x^3 = x + 1.
        let place = |by: f64, next: u32| {
            16.0 * ((f64::from(block) * by).fract() - 0.5) + 0.03 * f64::from(next)
        };
        let y = middle + place(0.754_877_666_246_692_8, member / 2);
        let z = place(0.569_840_290_998_053_3, member % 2);
        let direction = (DVec3::new(0.0, y, z) - origin).normalize();
        let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
        Launch { origin, direction, electric: [h.into(), v.into()] }
    };
    (0..RAYS).map(launch).collect()
}

#[divan::bench(args = devices())]
fn one_ray(bencher: Bencher, name: &str) {
    let scene = scene(name);
    let (assembly, launches) = (assembly(&scene), launches(name));
    let mut tracer = Tracer::new(&assembly, limits(&scene));
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        for launch in black_box(&launches) {
            black_box(tracer.trace(launch));
        }
    });
}

/// Counts the surfaces that a tree meets.
struct Surfaces(u64);

impl PathRecorder<2> for Surfaces {
    fn record(&mut self, _: impl FnOnce() -> PathSegment<2>) {
        self.0 += 1;
    }
}

/// The same by surfaces: an item is a segment of a branch with the interface at its end, two
/// events.
#[divan::bench(args = devices())]
fn surfaces(bencher: Bencher, name: &str) {
    let scene = scene(name);
    let (assembly, launches) = (assembly(&scene), launches(name));
    let mut watched = Tracer::new(&assembly, limits(&scene)).watched(Surfaces(0));
    for launch in &launches {
        watched.trace(launch);
    }
    let count = watched.recorder().0;
    let mut tracer = Tracer::new(&assembly, limits(&scene));
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        for launch in black_box(&launches) {
            black_box(tracer.trace(launch));
        }
    });
}

/// Four neighbours at once, as in pictures.
#[divan::bench(args = devices())]
fn four_rays(bencher: Bencher, name: &str) {
    let scene = scene(name);
    let (assembly, launches) = (assembly(&scene), launches(name));
    let mut tracers = FourTracers::new(&Tracer::new(&assembly, limits(&scene)));
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        for four in black_box(&launches).as_chunks().0 {
            tracers.trace(black_box(four));
        }
    });
}

/// The way through a homogeneous prism, a segment of the square cloak; items are legs.
#[divan::bench]
fn prism(bencher: Bencher) {
    let assembly = assembly(&scene("square-cloak"));
    let regions = assembly.devices().iter().flat_map(|device| &device.structure.regions);
    // The middle of one of the four triangles.
    let (region, inside) = regions
        .flat_map(|region| [(1, 1), (-1, 1), (1, -1), (-1, -1)].map(|signs| (region, signs)))
        .map(|(region, (x, y))| (region, DVec3::new(3.3 * f64::from(x), 5.2 * f64::from(y), 0.0)))
        .find(|(region, point)| match region {
            Region::Homogeneous(region) => (region.faces().iter())
                .all(|face| face.plane.normal.dot(face.plane.project(*point) - point) > 0.0),
            _ => false,
        })
        .expect("a prism");
    let rays: Vec<InnerRay> = (0..RAYS)
        .map(|n| {
            let angle = std::f64::consts::TAU * f64::from(n) / f64::from(RAYS);
            let direction = DVec3::new(angle.cos(), angle.sin(), 0.1).normalize();
            let (wave_vector, mode) = (direction, ModeKind::Shared);
            InnerRay { position: inside, wave_vector, direction, mode, virtual_point: None }
        })
        .collect();
    bencher.counter(ItemsCount::new(RAYS)).bench(|| {
        for ray in black_box(&rays) {
            let _ = black_box(region.advance(ray, 1e-6, None));
        }
    });
}
