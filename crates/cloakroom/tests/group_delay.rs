//! What a pulse takes: never less than light in air, by numbers known, and as the phase where
//! nothing disperses.

use crate::long::count;
use crate::rays::{assembly, launch, launches_around};
use cloakroom::trace::{Leaf, Limits, Tracer};
use glam::DVec3;

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-7 };

/// The leaves of a ray along x through a scene, and how much longer a pulse takes than in air, cm.
fn late(scene: &str, from: DVec3, direction: DVec3) -> Vec<(Leaf<2>, f64)> {
    let assembly = assembly(scene);
    let mut tracer = Tracer::new(&assembly, LIMITS).with_group_delays();
    let ray = launch(from, direction);
    let (leaves, _) = tracer.trace(&ray);
    leaves
        .iter()
        .map(|leaf| (*leaf, leaf.group_path.unwrap_or(f64::NAN) - leaf.position.distance(from)))
        .collect()
}

#[test]
fn pulses_on_the_axis_of_the_square_cloak_are_late_by_1_45140_nanoseconds() {
    for height in [1e-6, -1e-6] {
        let leaves =
            late("[[device]]\nkind = \"square-cloak\"", DVec3::new(-100.0, height, 0.0), DVec3::X);
        let (leaf, late) = leaves[0];
        // Physics: the ratio of the energies is 3.18209.
        assert!((late - 43.5118).abs() < 1e-4, "{late}");
        assert!((leaf.delay_path - leaf.optical_path).abs() < 1e-12);
        let none = "[[device]]\nkind = \"square-cloak\"\ndispersion = \"none\"";
        let leaf = self::late(none, DVec3::new(-100.0, height, 0.0), DVec3::X)[0].0;
        assert!(leaf.group_path.is_some_and(|path| (path - leaf.optical_path).abs() < 1e-12));
    }
}

#[test]
fn slabs_delay_a_pulse_by_their_group_index() {
    let slab = |keys: &str| {
        let scene = format!("[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 2\n{keys}");
        let (leaf, late) = late(&scene, DVec3::new(-50.0, 0.0, 0.0), DVec3::X)[0];
        let delay = leaf.delay_path - leaf.position.distance(DVec3::new(-50.0, 0.0, 0.0));
        (1.0 + 0.5 * late, 1.0 + 0.5 * delay)
    };
    let is = |keys: &str, group: f64, phase: f64| {
        let found = slab(keys);
        assert!(
            (found.0 - group).abs() < 1e-9 || (found.0.is_nan() && group.is_nan()),
            "{keys} {found:?}"
        );
        assert!((found.1 - phase).abs() < 1e-9, "{keys} {found:?}");
    };
    is("permittivity = 2.25", 1.5, 1.5);
    is("permittivity = 0.25", 2.0, 0.5);
    is("permittivity = 2.25\ngroup_index = 1.7", 1.7, 1.5);
    // Where the phase runs backwards, the time of flight is that of a pulse.
    is("permittivity = -1\npermeability = -1", 3.0, 3.0);
    // (3.69 + 3 · 1.69)/(2 · 1.3).
    is("permittivity = -1.69\npermeability = -1", 8.76 / 2.6, 8.76 / 2.6);
    is("permittivity = -1.69\npermeability = -1\ndispersion = \"none\"", 1.3, 1.3);
    is("permittivity = -1.69\npermeability = -1\ngroup_index = 4", 4.0, 4.0);
    is("permittivity = [2.25, 1e-7]", f64::NAN, 1.5);
}

#[test]
fn no_pulse_is_early() {
    let kinds = [
        "square-cloak\"",
        "square-cloak\"\nmaterial = \"positive-uniaxial\"",
        "square-cloak\"\nmaterial = \"negative-uniaxial\"",
        "double-gaussian-cloak\"",
        "gaussian-carpet\"",
        "cylinder-cloak\"",
        "cylinder-cloak\"\nmaterial = \"radial-uniaxial\"",
        "cylinder-cloak\"\nmaterial = \"azimuthal-uniaxial\"",
        "sphere-cloak\"",
        "invisible-sphere\"",
        "invisible-sphere\"\nmaterial = \"regularized\"",
        "bending-sphere\"",
        "luneburg-lens\"",
        "graded-box\"",
        "body\"\nshape = \"sphere\"\npermittivity = [[0.4, 0, 0.1], [0, 2, 0], [0.1, 0, -0.7]]",
        "body\"\nshape = \"box\"\npermittivity = 0.3\npermeability = 1.2",
    ];
    for kind in kinds {
        let assembly = assembly(&format!("[[device]]\nkind = \"{kind}"));
        let limits = Limits { min_power: 1e-3, tolerance: 1e-6 };
        let mut tracer = Tracer::new(&assembly, limits).with_group_delays();
        let mut met = 0;
        for ray in launches_around(count(10, 100), [60.0, 40.0], DVec3::splat(8.0)) {
            let (leaves, _) = tracer.trace(&ray);
            for leaf in leaves.iter().filter(|leaf| leaf.met_device) {
                met += 1;
                let straight = leaf.position.distance(ray.origin);
                let group = leaf.group_path.expect("a velocity");
                assert!(group >= straight - 1e-5, "{kind}: {leaf:?} {straight}");
                assert!(group >= leaf.optical_path - 1e-5, "{kind}: {leaf:?}");
            }
        }
        assert!(met > 5, "{kind}");
    }
}
