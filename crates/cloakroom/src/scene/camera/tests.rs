//! Tests of the camera.

use super::*;
use crate::scene::Polarizer;

fn camera(change: impl FnOnce(&mut CameraSettings)) -> Result<Camera, KeyError> {
    let mut settings = CameraSettings::default();
    change(&mut settings);
    Camera::new(settings)
}

fn perspective(field_of_view: f64) -> impl Fn(&mut CameraSettings) {
    move |s| s.field_of_view = field_of_view.into()
}

fn orthographic(width: f64) -> impl Fn(&mut CameraSettings) {
    move |s| (s.projection, s.width) = (Projection::Orthographic, Some(width))
}

fn oblique(project: impl Fn(&mut CameraSettings)) -> Camera {
    camera(|s| {
        s.position = DVec3::new(-80.0, 30.0, -20.0);
        s.target = DVec3::new(40.0, -5.0, 9.0);
        s.up = DVec3::new(0.2, 1.0, -0.1);
        project(s);
        s.resolution = [101, 64];
    })
    .expect("a camera")
}

fn cameras() -> [Camera; 2] {
    [oblique(perspective(70.0)), oblique(orthographic(60.0))]
}

#[test]
fn the_papers_camera_has_the_world_axes() {
    let camera = Camera::default();
    assert_eq!(camera.forward(), DVec3::X);
    assert_eq!(camera.right(), DVec3::Z);
    assert_eq!(camera.up(), DVec3::Y);
    assert_eq!(camera.ray(512.0, 384.0).direction, DVec3::X);
    let right_edge = camera.ray(1024.0, 384.0).direction;
    assert!((right_edge.z.atan2(right_edge.x).to_degrees() - 20.0).abs() < 1e-12);
    let top = camera.ray(512.0, 0.0).direction;
    assert!(top.y > 0.0 && top.z == 0.0);
    // Pixels are square.
    assert!((top.y / top.x / (20.0_f64.to_radians().tan() * 0.75) - 1.0).abs() < 1e-14);
}

#[test]
fn mirrored_points_have_mirrored_rays_to_the_last_bit() {
    let camera = Camera::default();
    for (px, py) in [(0.5, 0.5), (100.5, 7.5), (511.5, 383.5), (3.125, 700.25)] {
        let ray = camera.ray(px, py).direction;
        let left_right = camera.ray(1024.0 - px, py).direction;
        let up_down = camera.ray(px, 768.0 - py).direction;
        assert_eq!(left_right, DVec3::new(ray.x, ray.y, -ray.z));
        assert_eq!(up_down, DVec3::new(ray.x, -ray.y, ray.z));
    }
}

#[test]
fn directions_and_axes_are_orthonormal() {
    for camera in cameras() {
        let (f, r, u) = (camera.forward(), camera.right(), camera.up());
        for (a, b) in [(f, r), (r, u), (u, f)] {
            assert!(a.dot(b).abs() < 1e-15 && (a.length() - 1.0).abs() < 1e-15);
        }
        assert!((f.cross(u) - r).length() < 1e-15);
        for (px, py) in [(0.0, 0.0), (17.3, 55.0), (101.0, 64.0)] {
            assert!((camera.ray(px, py).direction.length() - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn an_orthographic_view_is_as_wide_as_it_says() {
    let camera = oblique(orthographic(60.0));
    let (left, right) = (camera.ray(0.0, 10.0), camera.ray(101.0, 10.0));
    assert!(((right.origin - left.origin) - 60.0 * camera.right()).length() < 1e-12);
    assert_eq!(left.direction, camera.forward());
}

#[test]
fn polarization_follows_the_convention() {
    let camera = Camera::default();
    assert_eq!(camera.polarization_basis(DVec3::X), (DVec3::Z, DVec3::Y));
    let (horizontal, vertical) = camera.polarization_basis(DVec3::Z);
    assert_eq!(horizontal, DVec3::X);
    assert!(vertical.dot(DVec3::Z).abs() < 1e-15 && vertical.is_normalized());

    for camera in cameras() {
        let along = [camera.right(), -camera.right()];
        let rays = [(0.0, 0.0), (60.0, 1.0), (101.0, 64.0)].map(|(x, y)| camera.ray(x, y));
        for direction in rays.map(|ray| ray.direction).into_iter().chain(along) {
            let (h, v) = camera.polarization_basis(direction);
            for (a, b) in [(h, v), (h, direction), (v, direction)] {
                assert!(a.dot(b).abs() < 1e-14);
            }
            assert!((h.length() - 1.0).abs() < 1e-14 && (v.length() - 1.0).abs() < 1e-14);
            assert!((direction.cross(v) - h).length() < 1e-14);
            // Seen by the camera, horizontal points right and vertical up.
            let sideways = direction.dot(camera.right()).abs() > 0.999;
            assert!(sideways || (h.dot(camera.right()) > 0.0 && v.dot(camera.up()) > 0.0));
        }
    }
}

/// The place of a photograph in a plane of constant x.
fn plane(x: f64) -> Pose {
    Pose::new(DVec3::X * x, 0.0)
}

#[test]
fn the_covering_width_covers_every_pixel_and_no_more() {
    // The paper's camera straight on: 150 cm away, tan 20 degrees to either side.
    let straight = Camera::default().covering_width(&plane(50.0), 1.0).expect("hits");
    assert!((straight - 300.0 * 20.0_f64.to_radians().tan()).abs() < 1e-10);
    let tall = Camera::default().covering_width(&plane(50.0), 2.0).expect("hits");
    assert!((tall - 1.5 * straight).abs() < 1e-10);

    for camera in cameras() {
        let width = camera.covering_width(&plane(60.0), 1.3).expect("hits");
        let mut reached = 0.0_f64;
        for i in 0..=20 {
            for j in 0..=20 {
                let ray = camera.ray(101.0 * f64::from(i) / 20.0, 64.0 * f64::from(j) / 20.0);
                let t = (60.0 - ray.origin.x) / ray.direction.x;
                let hit = ray.origin + t * ray.direction;
                reached = reached.max(2.0 * hit.z.abs()).max(2.0 * 1.3 * hit.y.abs());
            }
        }
        assert!((reached - width).abs() < 1e-9);
        assert_eq!(camera.covering_width(&plane(-200.0), 1.3), None, "behind the camera");
    }
    let wide = camera(perspective(100.0));
    let mut settings = CameraSettings::clone(&wide.expect("a camera"));
    settings.target = DVec3::new(0.0, 0.0, 100.0);
    let aside = Camera::new(settings).expect("a camera");
    assert_eq!(aside.covering_width(&plane(50.0), 1.0), None, "the left edge looks away");
}

#[test]
fn impossible_cameras_are_refused_at_the_right_key() {
    let cases: Vec<(&str, Result<Camera, KeyError>)> = vec![
        ("target", camera(|s| s.target = s.position)),
        ("up", camera(|s| s.up = DVec3::new(-3.0, 0.0, 0.0))),
        ("up", camera(|s| s.up = DVec3::ZERO)),
        ("up", camera(|s| s.up = DVec3::NAN)),
        ("position", camera(|s| s.position.y = f64::INFINITY)),
        ("target", camera(|s| s.target.x = 1e7)),
        ("resolution", camera(|s| s.resolution = [0, 10])),
        ("resolution", camera(|s| s.resolution = [10, 65_537])),
        ("samples", camera(|s| s.samples = 0)),
        ("adaptive", camera(|s| s.adaptive = -1.0)),
        ("adaptive", camera(|s| s.adaptive = f64::NAN)),
        ("polarizer", camera(|s| s.polarizer = Polarizer::Angle(f64::NAN))),
        ("field_of_view", camera(perspective(0.0))),
        ("field_of_view", camera(perspective(180.0))),
        ("field_of_view", camera(perspective(f64::NAN))),
        ("width", camera(orthographic(0.0))),
        ("width", camera(orthographic(f64::INFINITY))),
    ];
    for (key, result) in cases {
        assert_eq!(result.map_err(|error| error.key), Err(Some(key)));
    }
}

#[test]
fn tiny_and_huge_scenes_have_cameras_too() {
    for scale in [1e-300, 1e-20, 1e2, 1e4] {
        let camera = camera(|s| {
            s.position *= scale;
            s.target *= scale;
            s.up *= scale;
        });
        assert_eq!(camera.map(|c| c.right()), Ok(DVec3::Z));
    }
}
