//! Bodies against Snell and Fresnel written plainly, surface by surface.

use super::{LIMITS, body, launches};
use crate::rays::{assembly, launch};
use cloakroom::trace::{Launch, Leaf, Tracer};
use glam::DVec3;

/// A ray on its way through surfaces, by Snell's law and Fresnel's equations: the power is that of
/// s twice and of p twice, averaged at the end, so that it holds where the plane of incidence
/// stays.
#[derive(Clone, Copy, Debug)]
struct Ray {
    position: DVec3,
    direction: DVec3,
    optical_path: f64,
    delay_path: f64,
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
            delay_path: 0.0,
            power: [1.0; 2],
        }
    }

    fn run(&mut self, distance: f64, medium: Glass) {
        self.position += self.direction * distance;
        self.optical_path += medium.index * distance;
        // Backwards, at the least dispersion: ε = n/z and µ = nz have the derivatives 2 - ε and 2 -
        // µ.
        let Glass { index: n, impedance: z } = medium;
        let group = 0.5 * (z * (2.0 - n / z) + (2.0 - n * z) / z);
        self.delay_path += distance * if n < 0.0 { group } else { n };
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
    assert!((leaf.delay_path - ray.delay_path).abs() < 1e-8, "{leaf:?} {ray:?}");
    // Both launched polarizations together are s and p together, while the plane of incidence
    // stays.
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
        let assembly = assembly(&body(&format!(
            "shape = \"sphere\"\nradius = 6\npermittivity = {e}\npermeability = {m}"
        )));
        let mut tracer = Tracer::new(&assembly, LIMITS);
        let (medium, mut through) = (glass(e, m), 0);
        for launch in launches(500, 10.0) {
            let mut ray = Ray::new(&launch);
            let (leaves, outcome) = tracer.trace(&launch);
            assert_eq!(outcome.stats.lost, 0);
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
        let assembly =
            assembly(&body(&format!("thickness = 4\npermittivity = {e}\npermeability = {m}")));
        let mut tracer = Tracer::new(&assembly, LIMITS);
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

/// A slab with ε = µ = -1 images a point at a distance u before it to the distance d - u behind it,
/// without any phase on the way and without reflection; a pulse takes three times as long in it as
/// light in air, at least.
#[test]
fn a_matched_negative_slab_is_a_perfect_lens() {
    let assembly = assembly(&body("thickness = 6\npermittivity = -1\npermeability = -1"));
    let mut tracer = Tracer::new(&assembly, LIMITS);
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
        assert!((leaf.delay_path - (2.5 + 3.0 * 6.0) / polar.cos()).abs() < 1e-9);
    }
}

#[test]
fn boxes_and_cylinders_refract_by_snells_law() {
    let (medium, half) = (glass(2.0, 1.2), DVec3::new(4.0, 3.0, 5.0));
    let bench_of = |keys: &str| {
        assembly(&body(&format!("{keys}\npermittivity = 2.0\npermeability = 1.2\nrotation = 0\n")))
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
            assert_eq!(outcome.stats.lost, 0);
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

/// Ball in ball in ball, of overlapping whole balls: light goes from each medium straight into the
/// next.
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
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, LIMITS);
        let media = [AIR, glass(2.25, 1.0), glass(sign * 1.69, sign), glass(1.2, 1.0)];
        let mut through = 0;
        for launch in launches(400, 5.0) {
            let mut ray = Ray::new(&launch);
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-12, &launch);
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
