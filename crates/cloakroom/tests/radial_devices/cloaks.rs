//! Impedance-matched cloaks give every ray back as it came, whatever its direction and
//! polarization.

use super::{Numbers, assembly, launch, leaf, random_launch};
use glam::DVec3;

/// The leaf goes on where the ray would have gone, with its path and fields.
fn check_untouched(kind: &str, origin: DVec3, direction: DVec3) {
    let assembly = assembly(kind);
    let launch = launch(origin, direction);
    let leaf = leaf(&assembly, &launch);
    let along = (leaf.position - origin).dot(launch.direction);
    let beside = leaf.position - origin - launch.direction * along;
    assert!(
        leaf.met_device && leaf.direction.distance(launch.direction) < 1e-10,
        "{kind} {leaf:?}"
    );
    assert!(beside.length() < 1e-9, "{kind} {beside}");
    assert!((leaf.optical_path - along).abs() < 1e-9, "{kind} {leaf:?}");
    for (field, before) in leaf.electric.iter().zip(launch.electric) {
        assert!((*field - before).norm_squared() < 1e-20, "{kind} {field:?} {before:?}");
    }
}

#[test]
fn every_ray_comes_out_as_it_went_in() {
    let mut numbers = Numbers(1);
    for kind in ["'cylinder-cloak'", "'sphere-cloak'", "'sphere-cloak'\ninner = 9.5"] {
        for _ in 0..300 {
            let mut ray = random_launch(&mut numbers).0;
            while assembly(kind).device_containing(ray.origin).is_some() {
                // Along the cylinder.
                ray = random_launch(&mut numbers).0;
            }
            check_untouched(kind, ray.origin, ray.direction);
        }
        // At the axis and centre, just beside it, and grazing.
        for y in [0.0, 1e-14, 1e-9, 1e-3, -4.0, 9.999, 10.0 - 1e-9] {
            check_untouched(kind, DVec3::new(-50.0, y, 0.0), DVec3::X);
            check_untouched(kind, DVec3::new(-50.0, y, -25.0), DVec3::new(2.0, 0.0, 1.0));
        }
    }
}

#[test]
fn the_metal_alone_reflects_and_the_mirror_is_nothing() {
    for kind in ["'cylinder-cloak'", "'sphere-cloak'"] {
        let bare = assembly(&format!("{kind}\nshow = 'bare'"));
        let hit = leaf(&bare, &launch(DVec3::new(-50.0, 2.0, 0.0), DVec3::X));
        // On a circle of radius 4 at height 2 the normal stands at 30 degrees to the ray.
        assert!((hit.position - DVec3::new(-12f64.sqrt(), 2.0, 0.0)).length() < 1e-12);
        let expected = DVec3::new(-0.5, 0.75f64.sqrt(), 0.0);
        assert!(hit.direction.distance(expected) < 1e-13, "{}", hit.direction);
        assert!(!leaf(&bare, &launch(DVec3::new(-50.0, 4.1, 0.0), DVec3::X)).met_device);
        let mirror = assembly(&format!("{kind}\nshow = 'mirror'"));
        assert!(!leaf(&mirror, &launch(DVec3::new(-50.0, 2.0, 0.0), DVec3::X)).met_device);
    }
}

#[test]
fn short_cylinders_have_ends() {
    let bare = assembly("'cylinder-cloak'\nshow = 'bare'\nlength = 6");
    let down = |x: f64| launch(DVec3::new(x, 1.0, 20.0), DVec3::NEG_Z);
    let hit = leaf(&bare, &down(2.0));
    assert_eq!((hit.position.z, hit.direction), (3.0, DVec3::Z));
    assert!(!leaf(&bare, &down(4.1)).met_device);
    let cloak = assembly("'cylinder-cloak'\nlength = 6");
    let core = leaf(&cloak, &down(2.0));
    assert_eq!((core.position.z, core.direction), (3.0, DVec3::Z));
    // Reflected inwards above the end it does not meet the side from within.
    let slanted = launch(DVec3::new(13.0, 2.0, 13.0), DVec3::new(-1.0, 0.0, -1.0));
    assert!(
        leaf(&cloak, &slanted).direction.distance(DVec3::new(-1.0, 0.0, 1.0).normalize()) < 1e-15
    );
    // From side to side it is as good as an endless one.
    let through = leaf(&cloak, &launch(DVec3::new(-50.0, 3.0, 1.0), DVec3::X));
    assert!(through.direction.distance(DVec3::X) < 1e-12);
    // Through an end it is refracted, and reflected: the border there is no border of the map.
    let leaves = super::leaves(&cloak, &down(7.0));
    assert!(leaves.len() > 1);
}
