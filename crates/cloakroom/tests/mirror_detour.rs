//! The detour of plane mirrors against what plane mirrors do: what meets all four of its mirrors is
//! moved by twice the offset against its way along x, and late by as much.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::assembly::Assembly;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};
use optics::wave::transverse_basis;
use std::path::Path;

const OFFSET: f64 = 6.5;
const HALF_LENGTH: f64 = 17.0;

fn assembly() -> Assembly {
    let text = format!(
        "[[device]]\nkind = \"mirror-detour\"\noffset = {OFFSET}\nhalf_length = {HALF_LENGTH}\n"
    );
    let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
    cloakroom::render::assembly(&loaded.scene).unwrap()
}

/// Traces a ray; mirrors split nothing, so there is one leaf.
fn leaf(assembly: &Assembly, origin: DVec3, direction: DVec3) -> Leaf<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
    let mut tracer = Tracer::new(assembly, Limits { min_power: 1e-9, tolerance: 1e-9 });
    let (leaves, outcome) = tracer.trace(&launch);
    assert_eq!((leaves.len(), outcome.pruned), (1, [0.0; 2]));
    leaves[0]
}

/// The mirror images of a ray in the mirrors it is said to meet, in that order: the point on its
/// way where it meets each must lie on the mirror.
fn by_mirror_images(
    origin: DVec3,
    direction: DVec3,
    mirrors: &[[DVec2; 2]],
) -> Option<(DVec3, DVec3, f64)> {
    let (mut o, mut d, mut path) = (origin, direction, 0.0);
    for [a, b] in mirrors {
        let along = (*b - *a).normalize();
        let normal = DVec2::new(-along.y, along.x).extend(0.0);
        let t = normal.dot(a.extend(0.0) - o) / normal.dot(d);
        let hit = o + d * t;
        let share = (hit.truncate() - *a).dot(along) / a.distance(*b);
        if t <= 0.0 || !(0.0..=1.0).contains(&share) {
            return None;
        }
        (o, d, path) = (hit, d - 2.0 * d.dot(normal) * normal, path + t);
    }
    Some((o, d, path))
}

#[test]
fn rays_along_x_are_led_around_the_midst() {
    let assembly = assembly();
    for step in -99..100 {
        let y = OFFSET * f64::from(step) / 100.0;
        if step == 0 {
            continue;
        }
        let leaf = leaf(&assembly, DVec3::new(-50.0, y, 3.0), DVec3::X);
        assert!((leaf.direction - DVec3::X).length() < 1e-14);
        assert!((leaf.position.y - y).abs() < 1e-12 && leaf.position.z == 3.0);
        let straight = leaf.position.x + 50.0;
        assert!((leaf.optical_path - straight - 2.0 * OFFSET).abs() < 1e-12);
    }
}

#[test]
fn rays_beside_the_midst_meet_the_backs_of_the_outer_mirrors() {
    let assembly = assembly();
    for step in 1..100 {
        let y = OFFSET * (1.0 + f64::from(step) / 100.0);
        let leaf = leaf(&assembly, DVec3::new(-50.0, -y, 3.0), DVec3::X);
        assert!((leaf.direction + DVec3::Y).length() < 1e-14);
        let missed = self::leaf(&assembly, DVec3::new(-50.0, y + OFFSET, 3.0), DVec3::X);
        assert!(!missed.met_device);
    }
}

#[test]
fn slanted_rays_that_meet_all_four_mirrors_are_moved_and_late() {
    let assembly = assembly();
    let (s, l) = (OFFSET, HALF_LENGTH);
    let upper = [
        [(-l, 0.0), (s - l, s)],
        [(-l, s), (s - l, 2.0 * s)],
        [(l - s, 2.0 * s), (l, s)],
        [(l - s, s), (l, 0.0)],
    ]
    .map(|mirror| mirror.map(DVec2::from));
    let mut met = 0;
    for step in 0..4000 {
        let n = f64::from(step);
        let y = s * (n * 0.618_033_988_75).fract();
        let slope = 0.3 * ((n * 0.754_877_666).fract() - 0.5);
        let rise = 1.2 * ((n * 0.569_840_291).fract() - 0.5);
        let direction = DVec3::new(1.0, slope, rise).normalize();
        let origin = DVec3::new(-l, y, 1.0) - direction * 20.0;
        let Some((end, along, path)) = by_mirror_images(origin, direction, &upper) else {
            continue;
        };
        // Slanted rays may meet another mirror on their way.
        let leaf = leaf(&assembly, origin, direction);
        if (leaf.position - end).length() > 1e-9 {
            continue;
        }
        met += 1;
        assert!((along - direction).length() < 1e-14);
        assert!((leaf.direction - direction).length() < 1e-14);
        assert!((leaf.optical_path - path).abs() < 1e-12);
        // On a line moved by -2s along x, later by 2s/d_x at any plane of constant x.
        let moved = origin - DVec3::X * 2.0 * s;
        assert!((leaf.position - moved).cross(direction).length() < 1e-11);
        let free = (leaf.position.x - origin.x) / direction.x;
        assert!((leaf.optical_path - free - 2.0 * s / direction.x).abs() < 1e-11);
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn the_midst_is_free_and_the_mirrors_are_not() {
    let devices = |x: f64, y: f64| {
        let text = format!(
            "[[device]]\nkind = \"mirror-detour\"\n[[device]]\nkind = \"square-cloak\"\nside = 4\n\
             position = [{x}, {y}, 0]\n"
        );
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
        cloakroom::render::assembly(&loaded.scene).map(|_| ())
    };
    assert!(devices(0.0, 0.0).is_ok());
    assert!(devices(0.0, 12.0).is_ok());
    let error = devices(-16.0, 4.0).unwrap_err().to_string();
    assert!(error.contains("overlaps"), "{error}");
}

#[test]
fn other_views_and_crossing_mirrors_are_refused() {
    for (keys, words) in [
        ("show = \"bare\"", "show = \"cloak\""),
        ("show = \"mirror\"", "show = \"cloak\""),
        ("half_length = 7.9", "8 cm"),
    ] {
        let text = format!("[[device]]\nkind = \"mirror-detour\"\n{keys}\n");
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
        let error = cloakroom::render::assembly(&loaded.scene).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.key().starts_with("device.0."), "{}", error.key());
    }
}
