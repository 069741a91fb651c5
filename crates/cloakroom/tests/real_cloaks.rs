//! Cloaks of real things: the scenes of `scenes/real/` against closed forms.

use crate::long::count;
use crate::rays::{Numbers, launch, strongest};
use cloakroom::assembly::Assembly;
use cloakroom::device::{AnyDevice, Prisms};
use cloakroom::scene::Scene;
use cloakroom::scene_file::{self, Override};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec3};
use optics::material::Material;
use std::f64::consts::TAU;
use std::path::Path;

const CARPET: &str = include_str!("../../../scenes/real/calcite-carpet.toml");
const HEXAGON: &str = include_str!("../../../scenes/real/prism-cloak.toml");
const WATER: &str = include_str!("../../../scenes/real/water-cloak.toml");
const MIRRORS: &str = include_str!("../../../scenes/real/four-mirrors.toml");

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-9 };

fn scene(text: &str, changes: &[&str]) -> Scene {
    let changes: Vec<Override> = changes.iter().map(|c| Override::Text((*c).to_owned())).collect();
    scene_file::parse(text, "test", Path::new(""), &changes).unwrap().scene
}

fn bench(text: &str, changes: &[&str]) -> Assembly {
    cloakroom::render::assembly(&scene(text, changes)).unwrap()
}

/// The device of that number, which is of prisms.
fn prisms(scene: &Scene, number: usize) -> &Prisms {
    match &scene.devices[number].device {
        AnyDevice::Prisms(prisms) => prisms,
        other => panic!("{} is no device of prisms", other.kind()),
    }
}

/// The squares of the indices of calcite, for light across its axis and along it.
fn calcite(nm: f64) -> [f64; 2] {
    let calcite = Material::named("calcite").unwrap();
    let square = |law: &optics::material::IndexLaw| law.at(nm * 1e-3).unwrap().permittivity().re;
    [square(&calcite.ordinary), square(calcite.extraordinary.as_ref().unwrap())]
}

/// What calcite with its axis at 30 degrees to the glue cloaks: the map is y' = k y + H1 (1 - |x|/d),
/// and light polarized in the plane sees n² [[1/k², ∓a/k²], [∓a/k², 1 + a²/k²]] with a = H1/d.
struct Carpet {
    /// The index of the glass that it looks like.
    index: f64,
    k: f64,
    /// H1/d and H2/d.
    heights: [f64; 2],
}

impl Carpet {
    fn designed(nm: f64) -> Self {
        let [o, e] = calcite(nm);
        let (sin, cos) = 60_f64.to_radians().sin_cos();
        // The tensor's entries: the axis is at 60 degrees from x on the right.
        let (xx, xy) = (o + (e - o) * cos * cos, (e - o) * cos * sin);
        let a = -xy / xx;
        let index = (o * e / xx).sqrt();
        let k = index / xx.sqrt();
        Self { index, k, heights: [a, a / (1.0 - k)] }
    }
}

/// A ray in the xy-plane that is polarized in it.
fn in_plane(origin: DVec3, direction: DVec3) -> Launch<1> {
    let Launch { origin, direction, electric: [_, electric] } = launch(origin, direction);
    Launch { origin, direction, electric: [electric] }
}

#[test]
fn the_carpet_is_designed_for_590_nm() {
    let scene = scene(CARPET, &[]);
    let cloak = prisms(&scene, 1);
    let Carpet { index, k, heights } = Carpet::designed(590.0);
    // The published design, from rounded indices.
    for (found, published) in [(index, 1.5241), (k, 0.9426), (heights[0], 0.0897), (heights[1], 1.561)] {
        assert!((found - published).abs() < 6e-5 * published.max(10.0), "{found} {published}");
    }
    let d = 2.0;
    let [bump, apex] = heights.map(|height| d * height);
    let corners = |prism: &cloakroom::device::PrismOfMedium| prism.corners.clone().unwrap();
    let close = |found: Vec<[f64; 2]>, expected: &[[f64; 2]]| {
        let pairs = found.iter().flatten().zip(expected.iter().flatten());
        assert!(found.len() == expected.len() && pairs.clone().all(|(a, b)| (a - b).abs() < 1e-14));
    };
    close(corners(&cloak.prism[0]), &[[-d, 0.0], [d, 0.0], [0.0, bump]]);
    close(corners(&cloak.prism[1]), &[[-d, 0.0], [0.0, bump], [0.0, apex]]);
    close(corners(&cloak.prism[2]), &[[d, 0.0], [0.0, apex], [0.0, bump]]);
    close(corners(&cloak.imitated[0]), &[[-d, 0.0], [d, 0.0], [0.0, apex]]);
    assert!((cloak.imitated[0].words.index.unwrap().re - index).abs() < 1e-14);
}

/// Rays in the plane onto the carpet from above, from anywhere.
fn onto_the_carpet(numbers: &mut Numbers, elevation: f64) -> Launch<1> {
    let (sin, cos) = elevation.sin_cos();
    let direction = DVec3::new(cos, -sin, 0.0);
    let aside = numbers.between(-3.5, 3.5);
    let middle = DVec3::new(sin, cos, 0.0) * aside;
    in_plane(middle - direction * 20.0, direction)
}

#[test]
fn the_calcite_carpet_is_a_glass_prism_on_a_mirror() {
    let [cloak, glass] = ["cloak", "mirror"].map(|show| {
        let show = [0, 1].map(|i| format!("device.{i}.show={show}"));
        bench(CARPET, &["light.spectrum=590", &show[0], &show[1]])
    });
    let (mut through, mut beside) = (Tracer::<1>::new(&cloak, LIMITS), Tracer::new(&glass, LIMITS));
    let mut numbers = Numbers(5);
    let (mut compared, mut worst) = (0, 0.0_f64);
    for _ in 0..count(2000, 50_000) {
        let elevation = numbers.between(5.0, 175.0).to_radians();
        let launch = onto_the_carpet(&mut numbers, elevation);
        let (leaves, outcome) = through.trace(&launch);
        outcome.assert_balanced();
        let (expected, outcome) = beside.trace(&launch);
        outcome.assert_balanced();
        // Their powers are not the same: the calcite is not magnetic.
        let strong = leaves.iter().filter(|leaf| leaf.power[0] > 1e-3);
        for leaf in strong {
            let off = |other: &Leaf<1>| {
                leaf.direction
                    .distance(other.direction)
                    .max(leaf.position.distance(other.position))
                    .max((leaf.optical_path - other.optical_path).abs())
            };
            let off = expected.iter().map(off).fold(f64::INFINITY, f64::min);
            worst = worst.max(off);
            compared += 1;
            assert!(off < 1e-12, "{off:e} {launch:?} {leaf:?}");
        }
    }
    assert!(compared > 2000, "{compared}");
    eprintln!("compared {compared} {worst:e}");
}

#[test]
fn explore_lasers() {
    for nm in [590.0, 488.0, 532.0, 561.0, 632.8, 650.0] {
        let bench = bench(CARPET, &[&format!("light.spectrum={nm}")]);
        for elevation in [35.0_f64, 75.0] {
            let mut tracer = Tracer::<1>::new(&bench, LIMITS);
            let mut numbers = Numbers(5);
            let elevation = elevation.to_radians();
            let mirrored = DVec3::new(elevation.cos(), elevation.sin(), 0.0);
            let mut worst = std::collections::BTreeMap::new();
            for _ in 0..2000 {
                let launch = onto_the_carpet(&mut numbers, elevation);
                let (leaves, _) = tracer.trace(&launch);
                for leaf in leaves {
                    let off = leaf.direction.angle_between(mirrored).to_degrees();
                    if off < 3.0 && off > 0.0 {
                        let w = worst.entry(leaf.path).or_insert((0.0_f64, 0.0_f64, 0));
                        *w = (w.0.max(off), w.1.max(leaf.power[0]), w.2 + 1);
                    }
                }
            }
            let all: Vec<_> = worst.values().filter(|w| w.0 > 1e-4).collect();
            eprintln!("{nm} {elevation} {all:?}");
        }
    }
}
