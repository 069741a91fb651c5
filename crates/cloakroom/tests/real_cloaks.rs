//! Cloaks of real things: the scenes of `scenes/real/` against closed forms.

use crate::long::count;
use crate::pictures::png;
use crate::rays::{Numbers, launch, strongest};
use cloakroom::assembly::Assembly;
use cloakroom::device::{AnyDevice, Prisms};
use cloakroom::output::RgbImage;
use cloakroom::scene::Scene;
use cloakroom::scene_file::{self, Override};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat2, DMat3, DVec2, DVec3};
use optics::material::Material;
use std::f64::consts::TAU;
use std::path::Path;

const CARPET: &str = include_str!("../../../scenes/real/calcite-carpet.toml");
const LIQUID: &str = include_str!("../../../scenes/real/calcite-carpet-in-liquid.toml");
const HEXAGON: &str = include_str!("../../../scenes/real/prism-cloak.toml");
const WATER: &str = include_str!("../../../scenes/real/water-cloak.toml");
const MIRRORS: &str = include_str!("../../../scenes/real/four-mirrors.toml");

const BOX: &str = include_str!("../../../scenes/real/mirror-box.toml");

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-9 };
const STRONG: Limits = Limits { min_power: 1e-4, tolerance: 1e-9 };

fn scene(text: &str, changes: &[&str]) -> Scene {
    let changes: Vec<Override> = changes.iter().map(|c| Override::from(*c)).collect();
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
    for (found, published) in
        [(index, 1.5241), (k, 0.9426), (heights[0], 0.0897), (heights[1], 1.561)]
    {
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
    // It is the same in the liquid, which is of the index of the glass.
    let liquid = self::scene(LIQUID, &[]);
    let same = prisms(&liquid, 2);
    assert_eq!((&same.prism, &same.imitated), (&cloak.prism, &cloak.imitated));
    let AnyDevice::SolidBody(body) = &liquid.devices[0].device else { panic!("no body") };
    assert_eq!(body.words.index, cloak.imitated[0].words.index);
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
        outcome.assert_balanced(leaves, 1e-9, &launch);
        let (expected, outcome) = beside.trace(&launch);
        outcome.assert_balanced(expected, 1e-9, &launch);
        // Their powers are not the same: the calcite is not magnetic.
        let strong = leaves.iter().filter(|leaf| leaf.power[0] > 1e-3);
        for leaf in strong {
            // Directions, and places per way: rounding of a direction grows along it, 26-fold more at
            // glue that is met at 2 degrees.
            let off = |other: &Leaf<1>| {
                let along = leaf.optical_path - other.optical_path;
                let places = leaf.position.distance(other.position).max(along.abs());
                leaf.direction.distance(other.direction).max(10.0 * places / leaf.optical_path)
            };
            let off = expected.iter().map(off).fold(f64::INFINITY, f64::min);
            worst = worst.max(off);
            compared += 1;
            assert!(off < 1e-12, "{off:e} {launch:?} {leaf:?}");
        }
    }
    assert!(compared > 2000, "{compared} {worst:e}");
}

/// Light polarized in the plane of a crystal: k·ε·k = det ε there, the wave vector k being that over
/// the one of vacuum.
#[derive(Clone, Copy)]
struct Crystal(DMat2);

impl Crystal {
    const AIR: Self = Self(DMat2::IDENTITY);

    /// Calcite with its axis at an angle to x.
    fn calcite(nm: f64, axis_degrees: f64) -> Self {
        let [o, e] = calcite(nm);
        let axis = DVec2::from_angle(axis_degrees.to_radians());
        let dyad = DMat2::from_cols(axis * axis.x, axis * axis.y);
        Self(DMat2::from_diagonal(DVec2::splat(o)) + dyad * (e - o))
    }

    /// The wave behind or before a face, whose part along it is that of `k`, that runs to the side
    /// of the normal.
    fn beyond(&self, k: DVec2, normal: DVec2) -> DVec2 {
        let across = k.reject_from_normalized(normal);
        let product = |a: DVec2, b: DVec2| a.dot(self.0 * b) / self.0.determinant();
        let (a, b, c) =
            (product(normal, normal), product(normal, across), product(across, across) - 1.0);
        across + normal * ((b * b - a * c).sqrt() - b) / a
    }
}

/// The direction of a ray that goes once through the carpet, down by an elevation: it is reflected
/// on the left or the right of the bump.
fn once_through(nm: f64, elevation: f64, on_the_left: bool) -> DVec2 {
    let [bump, apex] = Carpet::designed(590.0).heights;
    let (left, right) = (Crystal::calcite(nm, 120.0), Crystal::calcite(nm, 60.0));
    let up = |height: f64, x: f64| DVec2::new(height * x, 1.0).normalize();
    let k = left.beyond(DVec2::new(elevation.cos(), -elevation.sin()), -up(apex, -1.0));
    let k = if on_the_left {
        right.beyond(left.beyond(k, up(bump, -1.0)), DVec2::X)
    } else {
        right.beyond(right.beyond(k, DVec2::X), up(bump, 1.0))
    };
    Crystal::AIR.beyond(k, up(apex, 1.0))
}

#[test]
fn lasers_of_other_colors_see_the_carpet_a_little() {
    let mut numbers = Numbers(5);
    // The largest angles, degrees, at 35 degrees and steeply, at 75.
    for (nm, published) in [
        (488.0, [0.374, 0.456]),
        (532.0, [0.187, 0.227]),
        (561.0, [0.087, 0.105]),
        (590.0, [0.0, 0.0]),
        (632.8, [0.109, 0.132]),
        (650.0, [0.148, 0.180]),
    ] {
        let bench = bench(CARPET, &[&format!("light.spectrum={nm}")]);
        let mut tracer = Tracer::<1>::new(&bench, LIMITS);
        for (degrees, published) in [35.0_f64, 75.0].into_iter().zip(published) {
            let elevation = degrees.to_radians();
            let mirrored = DVec2::from_angle(elevation);
            let expected = [false, true].map(|left| once_through(nm, elevation, left));
            let mut seen = [0; 2];
            let mut worst = 0.0_f64;
            for _ in 0..400 {
                let (leaves, _) = tracer.trace(&onto_the_carpet(&mut numbers, elevation));
                for leaf in leaves.iter().filter(|leaf| leaf.power[0] > 0.5) {
                    let found = leaf.direction.truncate();
                    let way = expected.iter().position(|way| way.distance(found) < 1e-12);
                    // Beside the carpet, or by way of the mirror before it.
                    let Some(way) = way else { continue };
                    seen[way] += 1;
                    worst = worst.max(found.angle_to(mirrored).to_degrees().abs());
                }
            }
            // At 590 nm both ways are the mirror's.
            let few = seen.iter().filter(|count| **count < 30).count();
            assert!(few <= usize::from(nm == 590.0), "{nm} {degrees} {seen:?}");
            assert!((worst - published).abs() < 6e-4, "{nm} {degrees}: {worst}");
        }
    }
}

/// A flat face: a point of its line in the xy-plane, and that line's direction.
type Line = [DVec3; 2];

/// Where a ray leaves the last of some faces, its direction there and its optical path: Snell's law
/// at one after the other, the index behind each given with it.
fn refracted(origin: DVec3, direction: DVec3, faces: &[(Line, f64)]) -> (DVec3, DVec3, f64) {
    let (mut point, mut p, mut path) = (origin, direction, 0.0);
    for ([corner, along], index) in faces {
        let normal = DVec3::new(-along.y, along.x, 0.0).normalize();
        let normal = normal * normal.dot(p).signum();
        // The wave vector over that of vacuum is as long as the index.
        let t = normal.dot(*corner - point) / normal.dot(p);
        path += t * p.length_squared();
        point += p * t;
        let across = p - normal * normal.dot(p);
        p = across + normal * (index * index - across.length_squared()).sqrt();
    }
    (point, p.normalize(), path)
}

/// Faces met on the way to x = 0, and those beyond, which are their mirror images.
fn and_back(faces: &[(Line, f64)]) -> Vec<(Line, f64)> {
    let mirror = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
    let indices: Vec<f64> = faces.iter().map(|(_, index)| *index).collect();
    let behind = |i: usize| if i == 0 { 1.0 } else { indices[i - 1] };
    let back = faces.iter().enumerate().rev();
    let back = back.map(|(i, ([corner, along], _))| ([mirror(*corner), mirror(*along)], behind(i)));
    faces.iter().copied().chain(back).collect()
}

/// Reflectance of an interface to the index n (across the plane of incidence, in it), from its
/// other side at an angle whose sine outside is given.
fn reflectance(n: f64, sin: f64) -> [f64; 2] {
    let (outside, inside) = ((1.0 - sin * sin).sqrt(), (1.0 - (sin / n).powi(2)).sqrt());
    let s = (outside - n * inside) / (outside + n * inside);
    let p = (n * outside - inside) / (n * outside + inside);
    [s * s, p * p]
}

fn corner(prisms: &Prisms, prism: usize, corner: usize) -> DVec3 {
    let [x, y] = prisms.prism[prism].corners.as_ref().unwrap()[corner];
    DVec3::new(x, y, 0.0)
}

/// How far a line is from the one on which a ray came.
fn aside(leaf: &Leaf<2>, launch: &Launch<2>) -> f64 {
    let off = leaf.position - launch.origin;
    off.reject_from_normalized(launch.direction).length()
}

/// What is checked of a cloak of prisms that is symmetric about x = 0 and y = 0.
struct Guided<'a> {
    bench: &'a Assembly,
    /// From how many directions it is the same.
    directions: u32,
    /// Half of the height that is led around, cm.
    window: f64,
    /// How far from the axis and from the ends of the window rays are, cm.
    rim: f64,
    /// The upper faces on the way to the middle.
    faces: Vec<(Line, f64)>,
    /// What of each polarization goes through (across the plane, in it).
    transmitted: [f64; 2],
    /// How much longer the optical path is, cm.
    longer: f64,
}

impl Guided<'_> {
    /// Rays along the axes of the cloak come out on their own lines.
    fn assert_in_line(&self) {
        let mut tracer = Tracer::<2>::new(self.bench, STRONG);
        let mut numbers = Numbers(9);
        for n in 0..count(300, 5000) {
            let turn = DMat3::from_rotation_z(
                TAU * f64::from(n % self.directions) / f64::from(self.directions),
            );
            let side = if numbers.next() < 0.5 { 1.0 } else { -1.0 };
            let y = side * numbers.between(self.rim, self.window - self.rim);
            let origin = DVec3::new(-150.0, y, numbers.between(-5.0, 5.0));
            let launch = launch(turn * origin, turn * DVec3::X);
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-9, &launch);
            let leaf = strongest(leaves);
            assert!(leaf.direction.distance(launch.direction) < 1e-12, "{launch:?} {leaf:?}");
            assert!(aside(&leaf, &launch) < 1e-12, "{:e} {launch:?}", aside(&leaf, &launch));
            let straight = (leaf.position - launch.origin).dot(launch.direction);
            let longer = leaf.optical_path - straight;
            assert!((longer - self.longer).abs() < 1e-11, "{longer} {}", self.longer);
            for (power, expected) in leaf.power.iter().zip(self.transmitted) {
                assert!((power - expected).abs() < 1e-12, "{power} {expected}");
            }
        }
    }

    /// Slanted rays, in the plane and out of it, come out in their own direction, and as far off as
    /// Snell's law says; how many of them were.
    fn assert_slanted(&self, most_degrees: f64) -> u32 {
        let faces = and_back(&self.faces);
        let mut tracer = Tracer::<2>::new(self.bench, STRONG);
        let mut numbers = Numbers(11);
        let (mut through, mut number) = (0, 0);
        while number < count(400, 5000) {
            number += 1;
            let slant =
                [0, 1].map(|_| numbers.between(-most_degrees, most_degrees).to_radians().tan());
            let direction = DVec3::new(1.0, slant[0], slant[1]);
            let y = numbers.between(0.05, 0.95) * self.window;
            let launch = launch(DVec3::new(0.0, y, 0.0) - direction * 150.0, direction);
            let (point, out, path) = refracted(launch.origin, launch.direction, &faces);
            assert!(out.distance(launch.direction) < 1e-12);
            // Others meet a card, another prism, or what is hidden.
            let leaves = tracer.trace(&launch).0.iter();
            let there =
                |leaf: &&Leaf<2>| leaf.position.distance(point) < 1e-6 && leaf.power[0] > 0.1;
            if let Some(leaf) = leaves.copied().find(|leaf| there(&leaf)) {
                through += 1;
                assert!(leaf.position.distance(point) < 1e-11);
                assert!(leaf.direction.distance(launch.direction) < 1e-12);
                assert!((leaf.optical_path - path).abs() < 1e-11);
            }
        }
        through
    }

    /// How far off (cm) rays come out that are slanted by so many degrees in the plane of the
    /// directions, and across it.
    fn off(&self, degrees: f64) -> [f64; 2] {
        let slope = degrees.to_radians().tan();
        [DVec3::new(1.0, slope, 0.0), DVec3::new(1.0, 0.0, slope)].map(|direction| {
            let middle = DVec3::new(0.0, 0.5 * self.window, 0.0);
            let (origin, direction) = (middle - direction * 150.0, direction.normalize());
            let (point, ..) = refracted(origin, direction, &and_back(&self.faces));
            (point - origin).reject_from_normalized(direction).length()
        })
    }

    /// What is hidden is seen along the axes by reflections alone: the largest share of a ray's
    /// power, unpolarized, that is from there.
    fn seen(&self, body: u16) -> f64 {
        let mut tracer = Tracer::<2>::new(self.bench, STRONG);
        let mut seen = 0.0_f64;
        for n in 1..200 {
            let y = self.window * (f64::from(n) / 100.0 - 1.0);
            if n == 100 {
                continue;
            }
            let (leaves, _) = tracer.trace(&launch(DVec3::new(-150.0, y, 0.0), DVec3::X));
            let on_it = leaves.iter().filter(|leaf| leaf.body() == Some(body));
            seen = seen.max(on_it.map(|leaf| 0.5 * (leaf.power[0] + leaf.power[1])).sum());
        }
        seen
    }
}

#[test]
fn prisms_lead_light_of_six_directions_around_a_hexagon() {
    for nm in [450.0, 550.0, 650.0] {
        let scene = scene(HEXAGON, &[&format!("light.spectrum={nm}")]);
        let bench = cloakroom::render::assembly(&scene).unwrap();
        let cloak = prisms(&scene, 1);
        let glass = Material::named("bk7").unwrap().ordinary.at(nm * 1e-3).unwrap();
        let n = glass.permittivity().re.sqrt();
        let alpha = 30_f64.to_radians();
        let deviation = (n * alpha.sin()).asin() - alpha;
        let (window, gap) =
            (3.0, (corner(cloak, 2, 0) - corner(cloak, 0, 0)).x - window_rise(alpha));
        // From the slanted face of the first prism to that of the second, by how much light rises.
        let rise = gap * deviation.tan() / (1.0 - alpha.tan() * deviation.tan());
        if nm == 550.0 {
            assert!((rise - 3.0).abs() < 1e-12, "{rise}");
        }
        let slanted = DVec3::new(alpha.sin(), alpha.cos(), 0.0);
        let faces = vec![
            ([corner(cloak, 0, 0), DVec3::Y], n),
            ([corner(cloak, 0, 0), slanted], 1.0),
            ([corner(cloak, 2, 0), slanted], n),
            ([corner(cloak, 2, 1), DVec3::Y], 1.0),
        ];
        let (upright, oblique) = (reflectance(n, 0.0), reflectance(n, n * alpha.sin()));
        let transmitted = [0, 1].map(|i| ((1.0 - upright[i]) * (1.0 - oblique[i])).powi(4));
        // What one prism is thicker by the other is thinner; the way between them is bent.
        let glass = (2.0 * window - rise) * alpha.tan();
        let longer = 2.0 * ((n - 1.0) * glass + rise * (deviation / 2.0).tan());
        // Of other colors, the rims meet no second prism.
        let rim = 0.001 + (rise - window).abs();
        let guided =
            Guided { bench: &bench, directions: 6, window, rim, faces, transmitted, longer };
        guided.assert_in_line();
        // The numbers of the page.
        for (nm_there, published) in [(450.0, 3.063), (550.0, 3.0), (650.0, 2.963)] {
            assert!(nm != nm_there || (rise - published).abs() < 6e-4, "{nm}: {rise}");
        }
        if nm == 550.0 {
            assert_numbers(&transmitted, &[0.518, 0.826], 6e-4);
            assert_numbers(&guided.off(1.0), &[0.241, 0.0027], 6e-4);
            assert_numbers(&[longer, deviation.to_degrees()], &[2.82, 19.40], 6e-3);
            let seen = guided.seen(0);
            assert!(seen < 5e-3, "{seen}");
            let through = guided.assert_slanted(2.0);
            assert!(through > 200, "{through}");
        }
    }
}

fn assert_numbers(found: &[f64], expected: &[f64], tolerance: f64) {
    let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < tolerance);
    assert!(found.len() == expected.len() && close, "{found:?} {expected:?}");
}

/// What a slanted face rises by over the height between the corners of the two prisms, 3 cm.
fn window_rise(alpha: f64) -> f64 {
    3.0 * alpha.tan()
}

#[test]
fn tanks_of_water_lead_light_of_four_directions_around_a_square() {
    let scene = scene(WATER, &[]);
    let bench = cloakroom::render::assembly(&scene).unwrap();
    let cloak = prisms(&scene, 1);
    let (n, sin) = (1.333, 0.5_f64.sqrt());
    let thickness = (corner(cloak, 0, 3) - corner(cloak, 0, 0)).x;
    let inside = (sin / n).asin();
    let rise = thickness * 0.5 * (1.0 - inside.tan());
    assert!((rise - 5.0).abs() < 1e-12, "{rise}");
    let slanted = DVec3::new(-1.0, 1.0, 0.0);
    let faces = vec![([corner(cloak, 0, 0), slanted], n), ([corner(cloak, 0, 3), slanted], 1.0)];
    let transmitted = reflectance(n, sin).map(|r| (1.0 - r).powi(4));
    let longer = 2.0 * thickness * sin * (n * inside.cos() - sin);
    let guided = Guided {
        bench: &bench,
        directions: 4,
        window: 5.0,
        rim: 0.001,
        faces,
        transmitted,
        longer,
    };
    guided.assert_in_line();
    // The numbers of the page.
    assert_numbers(&transmitted, &[0.804, 0.989], 6e-4);
    assert_numbers(&guided.off(1.0), &[0.352, 0.1746], 6e-4);
    assert_numbers(&[longer, thickness], &[15.98, 26.72], 6e-3);
    let seen = guided.seen(0);
    assert!(seen < 5e-3, "{seen}");
    let through = guided.assert_slanted(2.0);
    assert!(through > 200, "{through}");
}

#[test]
fn four_mirrors_lead_light_over_what_they_hide() {
    let bench = bench(MIRRORS, &[]);
    let mut tracer = Tracer::<2>::new(&bench, LIMITS);
    let mut numbers = Numbers(3);
    let mut slanted = 0;
    for n in 0..1000 {
        let slant =
            if n % 2 == 0 { [0.0; 2] } else { [0, 1].map(|_| numbers.between(-0.05, 0.05)) };
        let direction = DVec3::new(1.0, slant[0], slant[1]);
        let middle = DVec3::new(0.0, numbers.between(-3.9, 3.9), numbers.between(-3.0, 3.0));
        let launch = launch(middle - direction * 60.0, direction);
        let (leaves, outcome) = tracer.trace(&launch);
        outcome.assert_balanced(leaves, 1e-9, &launch);
        // Mirrors divide nothing.
        let [leaf] = leaves else { panic!("{leaves:?}") };
        // On a line moved by 20 cm against x, as if it had come from there.
        let moved = leaf.position + DVec3::X * 20.0 - launch.origin;
        let off = moved.reject_from_normalized(launch.direction).length();
        if off > 1e-6 {
            // Slanted so that it misses a mirror.
            assert_eq!(n % 2, 1, "{launch:?}");
            continue;
        }
        slanted += n % 2;
        assert!(off < 1e-12, "{off:e}");
        assert!(leaf.direction.distance(launch.direction) < 1e-14);
        assert!((leaf.optical_path - moved.length()).abs() < 1e-12);
        if n % 2 == 0 {
            assert!(aside(leaf, &launch) < 1e-13);
        }
    }
    assert!(slanted > 300, "{slanted}");
}

#[test]
fn the_mirror_box_shows_side_walls_where_the_back_wall_is() {
    let bench = bench(BOX, &[]);
    let mut tracer = Tracer::<2>::new(&bench, LIMITS);
    let mut numbers = Numbers(17);
    let (depth, mut seen) = (30.0, [0; 2]);
    for _ in 0..1000 {
        let eye = DVec3::new(-170.0, numbers.between(-20.0, 20.0), numbers.between(-20.0, 20.0));
        let there = DVec3::new(depth, numbers.between(-30.0, 30.0), numbers.between(-29.0, 29.0));
        let launch = launch(eye, there - eye);
        let [leaf] = tracer.trace(&launch).0 else { panic!("mirrors divide nothing") };
        // On the right wall (z = 30, the first device) or the left one (the second).
        let body = leaf.body().unwrap();
        let side = if body == 0 { 1.0 } else { -1.0 };
        seen[usize::from(body)] += 1;
        let wall = DVec3::new(side * there.z, there.y, side * depth);
        assert!(leaf.position.distance(wall) < 1e-11, "{leaf:?} {there}");
        assert!((leaf.optical_path - there.distance(eye)).abs() < 1e-11);
    }
    assert!(seen.iter().all(|count| *count > 300), "{seen:?}");
}

#[test]
fn the_mirror_box_reverses_the_back_wall() {
    let small = BOX
        .replace("field_of_view = 42", "field_of_view = 42\nresolution = [96, 72]\nsamples = 16");
    let (cabinet, rest) = small.split_once("# What is hidden.").unwrap();
    let (ball, _) = rest.split_once("# The mirrors").unwrap();
    let (with, without) = (png(&small), png(cabinet));
    let open = png(&format!("{cabinet}{ball}"));
    // The mean of a block of pixels; the back wall takes up the middle of the picture.
    let block = |image: &RgbImage, x: u32, y: u32, color: usize| {
        let all = (0..4).flat_map(|i| (0..4).map(move |j| (4 * x + i, 4 * y + j)));
        all.map(|(x, y)| f64::from(image.get_pixel(x, y).0[color])).sum::<f64>() / 16.0
    };
    let off = |one: &RgbImage, other: &RgbImage, reversed: bool| {
        let mut sum = 0.0;
        for (x, y, color) in
            (8..16).flat_map(|x| (4..14).flat_map(move |y| (0..3).map(move |c| (x, y, c))))
        {
            let there = if reversed { 23 - x } else { x };
            sum += (block(one, x, y, color) - block(other, there, y, color)).abs();
        }
        sum / (8.0 * 10.0 * 3.0)
    };
    let [reversed, straight] = [true, false].map(|reversed| off(&with, &without, reversed));
    // In steps of 255; samples are at random.
    assert!(reversed < 1.5 && straight > 20.0, "{reversed} {straight}");
    assert!(off(&open, &without, false) > 1.0);
}
