//! Balls of graded index, and the invisible spheres.

use super::{Numbers, assembly, launch, leaf, leaves, random_launch};
use glam::DVec3;
use std::f64::consts::PI;

const RADIUS: f64 = 10.0;

/// Where a line enters and would leave the ball.
fn chord(origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
    let along = origin.dot(direction);
    let closest = origin - direction * along;
    let half = (RADIUS * RADIUS - closest.length_squared()).sqrt();
    (closest - direction * half, closest + direction * half)
}

#[test]
fn the_invisible_sphere_delays_every_ray_by_its_circumference() {
    let assembly = assembly("'invisible-sphere'");
    let mut numbers = Numbers(2);
    for _ in 0..500 {
        let (ray, _) = random_launch(&mut numbers);
        let out = leaf(&assembly, &ray);
        let end = chord(ray.origin, ray.direction).1;
        assert!(out.position.distance(end) < 1e-9 * RADIUS, "{ray:?}");
        assert!(out.direction.distance(ray.direction) < 1e-9);
        let delay = out.optical_path - (out.position - ray.origin).length();
        assert!((delay - 2.0 * PI * RADIUS).abs() < 1e-9 * RADIUS, "{delay}");
        // A full turn brings the field back, too.
        for (field, before) in out.electric.iter().zip(ray.electric) {
            assert!((*field - before).norm_squared() < 1e-18);
        }
    }
}

#[test]
fn eatons_lens_returns_rays_and_the_bender_turns_them_by_its_angle() {
    let (eaton, right) = (assembly("'eaton-lens'"), assembly("'bending-sphere'"));
    let other = assembly("'bending-sphere'\nangle = 37.5");
    let mut numbers = Numbers(3);
    for _ in 0..500 {
        let (ray, impact) = random_launch(&mut numbers);
        let back = leaf(&eaton, &ray);
        assert!(back.direction.distance(-ray.direction) < 1e-9);
        // On the other side of the centre.
        let beside = back.position - ray.direction * back.position.dot(ray.direction);
        let before = ray.origin - ray.direction * ray.origin.dot(ray.direction);
        assert!((beside + before).length() < 1e-9 * RADIUS);
        for (assembly, angle) in [(&right, 90.0f64), (&other, 37.5)] {
            let out = leaf(assembly, &ray);
            assert!((out.direction.dot(ray.direction) - angle.to_radians().cos()).abs() < 1e-12);
            // The impact is kept, and the ray has turned towards the centre in its plane.
            let (torque, after) =
                (ray.origin.cross(ray.direction), out.position.cross(out.direction));
            assert!(torque.distance(after) < 1e-9 * RADIUS, "{impact}");
            assert!(ray.direction.cross(out.direction).dot(torque) >= 0.0);
            let (entry, end) = chord(ray.origin, ray.direction);
            let path = (entry - ray.origin).length()
                + (end - entry).length()
                + angle.to_radians() * RADIUS;
            assert!((out.optical_path - path).abs() < 1e-9 * RADIUS);
        }
    }
}

#[test]
fn luneburgs_lens_focuses_on_the_far_rim() {
    let assembly = assembly("'luneburg-lens'");
    let mut numbers = Numbers(4);
    for _ in 0..30 {
        let direction = numbers.direction();
        let (across, up) = direction.any_orthonormal_pair();
        let mut arrival = None;
        for _ in 0..10 {
            let (radius, angle) = (9.9 * numbers.next().sqrt(), numbers.between(0.0, 2.0 * PI));
            let beside = (across * angle.cos() + up * angle.sin()) * radius;
            let out = leaf(&assembly, &launch(beside - direction * 40.0, direction));
            assert!(out.position.distance(direction * RADIUS) < 1e-9 * RADIUS);
            // All at once, for they start on a common wavefront.
            let first = *arrival.get_or_insert(out.optical_path);
            assert!((out.optical_path - first).abs() < 1e-9 * RADIUS);
        }
        let central = 30.0 + (0.5 * PI + 1.0) * RADIUS;
        assert!((arrival.unwrap() - central).abs() < 1e-9 * RADIUS);
    }
}

#[test]
fn the_fisheye_images_to_the_antipode() {
    let assembly = assembly("'fisheye-lens'");
    let mut numbers = Numbers(5);
    for _ in 0..500 {
        let (ray, _) = random_launch(&mut numbers);
        let entry = chord(ray.origin, ray.direction).0;
        let out = leaf(&assembly, &ray);
        assert!(out.position.distance(-entry) < 1e-9 * RADIUS);
        let inside = out.optical_path - (entry - ray.origin).length();
        assert!((inside - PI * RADIUS).abs() < 1e-9 * RADIUS);
    }
}

#[test]
fn the_regularized_sphere_hides_from_its_extraordinary_wave() {
    let assembly = assembly("'invisible-sphere'\nmaterial = 'regularized'");
    let index = PI + 1.0;
    let mut numbers = Numbers(6);
    for _ in 0..300 {
        let (mut ray, impact) = random_launch(&mut numbers);
        let (entry, end) = chord(ray.origin, ray.direction);
        let normal = ray.origin.cross(ray.direction).normalize();
        // First in the plane of the ray, the extraordinary wave, then across it.
        ray.electric = [normal.cross(ray.direction).into(), normal.into()];
        let all = leaves(&assembly, &ray);
        let to_entry = (entry - ray.origin).length();
        let straight = |i: usize| {
            all.iter()
                .filter(move |leaf| leaf.power[i] > 1e-6)
                .filter(|leaf| leaf.position.distance(end) < 1e-8)
        };
        let first = straight(0).max_by(|a, b| a.power[0].total_cmp(&b.power[0])).unwrap();
        let path = to_entry + (end - entry).length() + 2.0 * PI * RADIUS;
        assert!((first.optical_path - path).abs() < 1e-8 && first.power[1] < 1e-20, "{first:?}");
        assert!(first.direction.distance(ray.direction) < 1e-9);
        // Fresnel's formulas of the extraordinary wave with its effective impedance p_r/ε_o.
        let cosine = (1.0 - (impact / RADIUS).powi(2)).sqrt();
        let p_r = index * cosine;
        let r = (cosine - p_r / (index * index)) / (cosine + p_r / (index * index));
        assert!((first.power[0] - (1.0 - r * r).powi(2)).abs() < 1e-9, "{} {r}", first.power[0]);
        // The ordinary wave is refracted twice as by a ball of glass.
        let inner = (impact / RADIUS / index).asin();
        let turn = 2.0 * ((impact / RADIUS).asin() - inner);
        let once = all
            .iter()
            .filter(|leaf| leaf.power[1] > 1e-3 && leaf.power[0] < 1e-9)
            .find(|leaf| (leaf.direction.dot(ray.direction) - turn.cos()).abs() < 1e-9)
            .unwrap();
        let path = to_entry + 2.0 * RADIUS * index * inner.cos();
        assert!((once.optical_path - path).abs() < 1e-8);
    }
    // 37.3 % at normal incidence, where both waves run together.
    let all = leaves(&assembly, &launch(DVec3::new(-50.0, 0.0, 0.0), DVec3::X));
    let reflected = all.iter().find(|leaf| (leaf.optical_path - 40.0).abs() < 1e-9).unwrap();
    let reflectance = (PI / (PI + 2.0)).powi(2);
    for power in reflected.power {
        assert!((power - reflectance).abs() < 1e-12 && (power - 0.373).abs() < 1e-3);
    }
}
