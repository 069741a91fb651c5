//! Bodies against Snell and Fresnel written plainly, surface by surface.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::scene_file;
use cloakroom::trace::{Bench, Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use std::path::Path;

const LIMITS: Limits = Limits { min_power: 1e-7, tolerance: 1e-9 };

fn try_bench(text: &str) -> Result<Bench, String> {
    let loaded =
        scene_file::parse(text, "test", Path::new(""), &[]).map_err(|error| error.to_string())?;
    cloakroom::render::bench(&loaded.scene)
        .map_err(|error| loaded.locations.error_at(&error.key(), error.to_string()).to_string())
}

fn bench(text: &str) -> Bench {
    try_bench(text).unwrap_or_else(|error| panic!("{error}"))
}

fn body(keys: &str) -> String {
    format!("[[device]]\nkind = \"body\"\n{keys}\n")
}

fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// Rays from all around that come near the origin.
fn launches(count: u32, reach: f64) -> impl Iterator<Item = Launch<2>> {
    let root: f64 = 1.134_724_138_401_519_4;
    (1..=count).map(move |n| {
        let u: [f64; 5] =
            std::array::from_fn(|i| (f64::from(n) * root.powi(-(i as i32) - 1)).fract() - 0.5);
        let angle = std::f64::consts::TAU * u[0];
        let origin = DVec3::new(60.0 * angle.cos(), 60.0 * angle.sin(), 40.0 * u[1]);
        launch(origin, reach * DVec3::new(u[2], u[3], u[4]) - origin)
    })
}

/// A ray on its way through surfaces, by Snell's law and Fresnel's equations: the power is that of s twice
/// and of p twice, averaged at the end, so that it holds where the plane of incidence stays.
#[derive(Clone, Copy, Debug)]
struct Ray {
    position: DVec3,
    direction: DVec3,
    optical_path: f64,
    group_path: f64,
    power: [f64; 2],
}

/// An isotropic medium: index and impedance.
#[derive(Clone, Copy, Debug)]
struct Glass {
    index: f64,
    impedance: f64,
}

const AIR: Glass = Glass { index: 1.0, impedance: 1.0 };

fn glass(e: f64, m: f64) -> Glass {
    let sign = if e < 0.0 { -1.0 } else { 1.0 };
    Glass { index: sign * (e * m).sqrt(), impedance: (m / e).sqrt() }
}

impl Ray {
    fn new(launch: &Launch<2>) -> Self {
        Self {
            position: launch.origin,
            direction: launch.direction,
            optical_path: 0.0,
            group_path: 0.0,
            power: [1.0; 2],
        }
    }

    fn run(&mut self, distance: f64, medium: Glass) {
        self.position += self.direction * distance;
        self.optical_path += medium.index * distance;
        self.group_path += medium.index.abs().max(1.0) * distance;
    }

    /// Refracts at a surface with a unit normal against the ray; `None` at total reflection.
    fn refract(&mut self, normal: DVec3, from: Glass, to: Glass) -> Option<()> {
        let cos = -self.direction.dot(normal);
        let ratio = from.index / to.index;
        let sin2 = ratio * ratio * (1.0 - cos * cos);
        if sin2 >= 1.0 {
            return None;
        }
        let beyond = (1.0 - sin2).sqrt();
        let along = self.direction + normal * cos;
        self.direction = (along * ratio - normal * beyond).normalize();
        let s = (to.impedance * cos - from.impedance * beyond)
            / (to.impedance * cos + from.impedance * beyond);
        let p = (from.impedance * cos - to.impedance * beyond)
            / (from.impedance * cos + to.impedance * beyond);
        self.power[0] *= 1.0 - s * s;
        self.power[1] *= 1.0 - p * p;
        Some(())
    }
}

/// The leaf that is this ray.
fn find<'a>(leaves: &'a [Leaf<2>], ray: &Ray) -> Option<&'a Leaf<2>> {
    leaves.iter().find(|leaf| {
        (leaf.position - ray.position).length() < 1e-8
            && (leaf.direction - ray.direction).length() < 1e-9
    })
}

fn check(leaf: &Leaf<2>, ray: &Ray) {
    assert!((leaf.optical_path - ray.optical_path).abs() < 1e-8, "{leaf:?} {ray:?}");
    assert!((leaf.group_path - ray.group_path).abs() < 1e-8, "{leaf:?} {ray:?}");
    // Both launched polarizations together are s and p together, while the plane of incidence stays.
    let sum = leaf.power[0] + leaf.power[1];
    assert!((sum - ray.power[0] - ray.power[1]).abs() < 1e-9, "{leaf:?} {ray:?}");
}

/// Both distances at which a line meets a sphere about the origin.
fn sphere_hits(ray: &Ray, radius: f64) -> Option<[f64; 2]> {
    let along = ray.position.dot(ray.direction);
    let inside = along * along - ray.position.length_squared() + radius * radius;
    (inside > 0.0).then(|| [-along - inside.sqrt(), -along + inside.sqrt()])
}

#[test]
fn balls_refract_by_snells_law() {
    for (e, m) in [(2.25, 1.0), (1.0, 3.0), (0.7, 1.1), (-1.69, -1.0), (-1.0, -1.0), (-2.0, -3.0)] {
        let bench = bench(&body(&format!(
            "shape = \"sphere\"\nradius = 6\npermittivity = {e}\npermeability = {m}"
        )));
        let mut tracer = Tracer::new(&bench, LIMITS);
        let (medium, mut through) = (glass(e, m), 0);
        for launch in launches(500, 10.0) {
            let mut ray = Ray::new(&launch);
            let (leaves, outcome) = tracer.trace(&launch);
            assert_eq!(outcome.rarities.lost, 0);
            let Some([near, _]) = sphere_hits(&ray, 6.0) else {
                assert!(leaves.len() == 1 && !leaves[0].met_device);
                continue;
            };
            ray.run(near, AIR);
            if ray.refract(ray.position / 6.0, AIR, medium).is_none() {
                continue;
            }
            let [_, far] = sphere_hits(&ray, 6.0).unwrap();
            ray.run(far, medium);
            ray.refract(-ray.position / 6.0, medium, AIR).unwrap();
            check(find(leaves, &ray).unwrap(), &ray);
            through += 1;
        }
        assert!(through > 100, "{through}");
    }
}

#[test]
fn slabs_shift_rays_to_the_side() {
    for (e, m) in [(2.25, 1.0), (3.0, 2.0), (-1.69, -1.0)] {
        let bench = bench(&body(&format!("thickness = 4\npermittivity = {e}\npermeability = {m}")));
        let mut tracer = Tracer::new(&bench, LIMITS);
        let index = glass(e, m).index;
        for step in 0..80 {
            let angle = f64::from(step).to_radians();
            let direction = DVec3::new(angle.cos(), 0.6 * angle.sin(), 0.8 * angle.sin());
            let launch = launch(DVec3::new(-7.0, 1.0, -2.0), direction);
            let (leaves, _) = tracer.trace(&launch);
            let inner = (angle.sin() / index).asin();
            let aside = 4.0 * (angle - inner).sin() / inner.cos();
            let straight = leaves
                .iter()
                .find(|leaf| {
                    let beside = (leaf.position - launch.origin)
                        .reject_from_normalized(launch.direction)
                        .length();
                    (leaf.direction - launch.direction).length() < 1e-12
                        && (beside - aside.abs()).abs() < 1e-9
                })
                .unwrap();
            let expected = 5.0 / angle.cos() + index * 4.0 / inner.cos();
            assert!((straight.optical_path - expected).abs() < 1e-9);
        }
    }
}

/// A slab with ε = µ = -1 images a point at a distance u before it to the distance d - u behind it, without
/// any phase on the way and without reflection; light takes as long as it would without it.
#[test]
fn a_matched_negative_slab_is_a_perfect_lens() {
    let bench = bench(&body("thickness = 6\npermittivity = -1\npermeability = -1"));
    let mut tracer = Tracer::new(&bench, LIMITS);
    let source = DVec3::new(-3.0 - 2.5, 1.0, 2.0);
    let image = DVec3::new(3.0 + 3.5, 1.0, 2.0);
    for step in 0..200 {
        let n = f64::from(step);
        let (polar, around) = (1.5 * (n * 0.618_033_988_75).fract(), 2.4 * n);
        let direction =
            DVec3::new(polar.cos(), polar.sin() * around.cos(), polar.sin() * around.sin());
        let launch = launch(source, direction);
        let (leaves, _) = tracer.trace(&launch);
        let [leaf] = leaves else { panic!("one leaf: {leaves:?}") };
        assert!((leaf.power[0] - 1.0).abs() < 1e-12 && (leaf.power[1] - 1.0).abs() < 1e-12);
        let to_image = image - leaf.position;
        assert!(to_image.reject_from_normalized(leaf.direction).length() < 1e-9);
        assert!((leaf.optical_path + to_image.dot(leaf.direction)).abs() < 1e-9);
        assert!((leaf.group_path - 8.5 / polar.cos()).abs() < 1e-9);
    }
}

#[test]
fn boxes_and_cylinders_refract_by_snells_law() {
    let (medium, half) = (glass(2.0, 1.2), DVec3::new(4.0, 3.0, 5.0));
    let bench_of = |keys: &str| {
        bench(&body(&format!("{keys}\npermittivity = 2.0\npermeability = 1.2\nrotation = 0\n")))
    };
    let boxed = bench_of("shape = \"box\"\nsize = [8, 6, 10]");
    let round = bench_of("shape = \"cylinder\"\nradius = 4\nlength = 10");
    // Distances to the planes of a box; the sign says which face.
    let faces = |ray: &Ray, inside: bool| {
        let mut hits: Vec<(f64, DVec3)> = Vec::new();
        for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
            for sign in [-1.0, 1.0] {
                let t = (sign * half[axis] - ray.position[axis]) / ray.direction[axis];
                let point = ray.position + ray.direction * t;
                let within = (0..3)
                    .filter(|other| *other != axis)
                    .all(|other| point[other].abs() <= half[other]);
                let leaves = ray.direction[axis] * sign > 0.0;
                if t > 0.0 && within && leaves == inside {
                    hits.push((t, unit * sign));
                }
            }
        }
        hits.into_iter().next()
    };
    let barrel = |ray: &Ray, inside: bool| {
        let (o, d) = (ray.position.truncate(), ray.direction.truncate());
        let (a, b, c) = (d.length_squared(), o.dot(d), o.length_squared() - 16.0);
        let root = (b * b - a * c).sqrt();
        let t = if inside { (root - b) / a } else { (-root - b) / a };
        let end = 5.0 * ray.direction.z.signum() * if inside { 1.0 } else { -1.0 };
        let to_end = (end - ray.position.z) / ray.direction.z;
        let at = |t: f64| ray.position + ray.direction * t;
        let on_side = t > 0.0 && at(t).z.abs() <= 5.0;
        let on_end = to_end > 0.0 && at(to_end).truncate().length() <= 4.0;
        if on_side {
            Some((t, at(t).with_z(0.0).normalize()))
        } else {
            on_end.then(|| (to_end, DVec3::Z * end.signum()))
        }
    };
    for round_one in [false, true] {
        let mut tracer = Tracer::new(if round_one { &round } else { &boxed }, LIMITS);
        let hit = |ray: &Ray, inside: bool| {
            if round_one { barrel(ray, inside) } else { faces(ray, inside) }
        };
        let mut through = 0;
        for launch in launches(800, 9.0) {
            let mut ray = Ray::new(&launch);
            let (leaves, outcome) = tracer.trace(&launch);
            assert_eq!(outcome.rarities.lost, 0);
            let Some((t, outward)) = hit(&ray, false) else {
                assert!(!leaves[0].met_device, "{launch:?}");
                continue;
            };
            ray.run(t, AIR);
            ray.refract(outward, AIR, medium).unwrap();
            let (t, outward) = hit(&ray, true).unwrap();
            ray.run(t, medium);
            if ray.refract(-outward, medium, AIR).is_some() {
                let leaf = find(leaves, &ray).unwrap();
                assert!((leaf.optical_path - ray.optical_path).abs() < 1e-8);
                through += 1;
            }
        }
        assert!(through > 200, "{through}");
    }
}

/// Ball in ball in ball, of overlapping whole balls: light goes from each medium straight into the next.
#[test]
fn the_larger_priority_is_there_where_bodies_overlap() {
    let shells = [(8.0, 2.25, 1.0), (7.0, 1.69, 1.0), (3.0, 1.2, -1.0)];
    for sign in [1.0, -1.0] {
        let ball = |(number, (radius, e, m)): (usize, &(f64, f64, f64))| {
            let (e, m) = if number == 1 { (sign * e, sign * m) } else { (*e, m.abs()) };
            body(&format!(
                "shape = \"sphere\"\nradius = {radius}\npermittivity = {e}\npermeability = {m}\n\
                 priority = {number}\nposition = [0, 0, 0]"
            ))
        };
        // The order in the scene does not matter.
        let text: String = shells.iter().enumerate().map(ball).rev().collect();
        let bench = bench(&text);
        let mut tracer = Tracer::new(&bench, LIMITS);
        let media = [AIR, glass(2.25, 1.0), glass(sign * 1.69, sign), glass(1.2, 1.0)];
        let mut through = 0;
        for launch in launches(400, 5.0) {
            let mut ray = Ray::new(&launch);
            let (leaves, outcome) = tracer.trace(&launch);
            let sum: f64 = leaves.iter().map(|leaf| leaf.power[0]).sum();
            assert!((sum + outcome.pruned[0] - 1.0).abs() < 1e-12);
            let mut follow = || -> Option<()> {
                for level in 0..3 {
                    let [near, _] = sphere_hits(&ray, shells[level].0)?;
                    ray.run(near, media[level]);
                    ray.refract(ray.position.normalize(), media[level], media[level + 1])?;
                }
                for level in (0..3).rev() {
                    let [_, far] = sphere_hits(&ray, shells[level].0)?;
                    ray.run(far, media[level + 1]);
                    ray.refract(-ray.position.normalize(), media[level + 1], media[level])?;
                }
                Some(())
            };
            if follow().is_some() {
                check(find(leaves, &ray).unwrap(), &ray);
                through += 1;
            }
        }
        assert!(through > 50, "{through}");
    }
}

/// Surfaces in one place are one surface: two boxes face to face, and boxes in a box up to its face, leave
/// what one box leaves.
#[test]
fn bodies_face_to_face_have_no_air_between() {
    let part = |size: f64, x: f64, priority: i32| {
        body(&format!(
            "shape = \"box\"\nsize = [{size}, 6, 6]\nposition = [{x}, 0, 0]\npermittivity = 2\n\
             priority = {priority}"
        ))
    };
    let whole = bench(&part(6.0, 0.0, 0));
    let mut tracer = Tracer::new(&whole, LIMITS);
    for text in [
        part(2.0, -2.0, 0) + &part(4.0, 1.0, 0),
        part(6.0, 0.0, 0) + &part(3.0, 1.5, 1) + &part(1.0, 2.5, 2),
    ] {
        let bench = bench(&text);
        let mut parts = Tracer::new(&bench, LIMITS);
        for launch in launches(500, 8.0) {
            let (leaves, _) = tracer.trace(&launch);
            let (others, outcome) = parts.trace(&launch);
            assert_eq!((leaves.len(), outcome.rarities.lost), (others.len(), 0), "{launch:?}");
            for (one, other) in leaves.iter().zip(others) {
                assert!((one.position - other.position).length() < 1e-9);
                assert!((one.power[0] - other.power[0]).abs() < 1e-12);
                assert!((one.optical_path - other.optical_path).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn opaque_bodies_end_rays_and_absorbing_ones_dim_them() {
    let text = body("shape = \"sphere\"\nsurface = { color = [1, 0.2, 0] }")
        + &body(
            "shape = \"box\"\nposition = [20, 0, 0]\nsize = [4, 40, 40]\npermittivity = [1.2, 4e-7]",
        );
    let bench = bench(&text);
    let mut tracer = Tracer::new(&bench, LIMITS);
    let (leaves, _) = tracer.trace(&launch(DVec3::new(-20.0, 1.0, 0.0), DVec3::X));
    let [leaf] = leaves else { panic!("one leaf") };
    assert_eq!((leaf.body, leaf.power), (Some(0), [1.0; 2]));
    assert!((leaf.position.length() - 5.0).abs() < 1e-12);
    let launch = launch(DVec3::new(-20.0, 7.0, 0.0), DVec3::X);
    let (leaves, outcome) = tracer.trace(&launch);
    let index = num_complex::Complex64::new(1.2, 4e-7).sqrt();
    let kept = (-2.0 * std::f64::consts::TAU / 5.5e-5 * index.im * 4.0).exp();
    let r = ((index - 1.0) / (index + 1.0)).norm_sqr();
    let absorbed = (1.0 - r) * (1.0 - kept) / (1.0 - r * kept);
    assert!((outcome.absorbed[0] - absorbed).abs() < 1e-6 && kept < 0.9);
    let sum: f64 = leaves.iter().map(|leaf| leaf.power[0]).sum();
    assert!((sum + outcome.absorbed[0] + outcome.pruned[0] - 1.0).abs() < 1e-12);
}

#[test]
fn a_group_index_sets_the_time_alone() {
    let bench =
        bench(&body("thickness = 4\npermittivity = -1\npermeability = -1\ngroup_index = 3"));
    let mut tracer = Tracer::new(&bench, LIMITS);
    let (leaves, _) = tracer.trace(&launch(DVec3::new(-5.0, 0.0, 0.0), DVec3::X));
    assert!((leaves[0].optical_path - (3.0 - 4.0)).abs() < 1e-12);
    assert!((leaves[0].group_path - (3.0 + 12.0)).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let ball = "shape = \"sphere\"\npermittivity = 2";
    for (text, place, words) in [
        (body(ball) + &body(ball), "test:5:1", "same priority"),
        (
            body(ball) + &body("priority = 1") + "[[device]]\nkind = \"square-cloak\"\n",
            "test:8:1",
            "overlaps",
        ),
        (body("shape = \"box\"\nradius = 3"), "test:4:10", "size"),
        (body("shape = \"box\"\nlength = 3"), "test:4:10", "no length"),
        (body("show = \"bare\""), "test:3:8", "show = \"cloak\""),
        (body("surface = { colour = [1, 0, 0] }"), "test:3:13", "`color`"),
        (body("surface = { color = [1, 0, -1] }"), "test:3:21", "third component"),
        (body("surface = 3"), "test:3:11", "a table with the key color"),
        (body("permittivity = 2\nsurface = {}"), "test:3:16", "opaque"),
        (body("group_index = 0.5"), "test:3:15", "from 1"),
    ] {
        let error = try_bench(&text).unwrap_err();
        assert!(error.starts_with(place) && error.contains(words), "{text}\n{error}");
    }
    let many: String = (0..65)
        .map(|i| body(&format!("shape = \"sphere\"\nradius = 1\nposition = [{}, 0, 0]", 3 * i)))
        .collect();
    assert!(try_bench(&many).unwrap_err().contains("65 bodies"));
}

/// Tensors are those of the body's own frame, as in a prism.
#[test]
fn a_turned_anisotropic_box_is_the_turned_prism() {
    let medium = "permittivity = [[2.5, 0.3, 0.1], [0.3, 1.8, 0], [0.1, 0, [1.4, 2e-7]]]\n";
    let place = "rotation = 23\nposition = [1, -2, 0.5]\n";
    let boxed = bench(&body(&format!("{place}shape = \"box\"\nsize = [6, 8, 7]\n{medium}")));
    let prism = bench(&format!(
        "[[device]]\nkind = \"prisms\"\nlength = 7\n{place}[[device.prism]]\n\
         corners = [[-3, -4], [3, -4], [3, 4], [-3, 4]]\n{medium}"
    ));
    let limits = Limits { min_power: 1e-3, tolerance: 1e-9 };
    let (mut one, mut other) = (Tracer::new(&boxed, limits), Tracer::new(&prism, limits));
    let by_path = |leaves: &[Leaf<2>]| {
        let mut leaves = leaves.to_vec();
        leaves.sort_by(|a, b| b.power[0].total_cmp(&a.power[0]));
        leaves
    };
    for launch in launches(300, 8.0) {
        let leaves = by_path(one.trace(&launch).0);
        let (others, outcome) = other.trace(&launch);
        let others = by_path(others);
        assert_eq!(outcome.rarities.lost, 0);
        for (a, b) in leaves.iter().zip(&others).take(3) {
            assert!((a.power[0] - b.power[0]).abs() < 1e-9, "{launch:?} {a:?} {b:?}");
            assert!((a.optical_path - b.optical_path).abs() < 1e-7 || a.power[0] < 1e-2);
        }
    }
}
