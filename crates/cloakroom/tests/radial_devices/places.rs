//! Where balls and round cylinders may stand, and what they refuse.

use super::try_bench;
use cloakroom::render::PreparedSceneError;
use cloakroom::scene::DeviceName;
use glam::DVec3;

const ROUND: [&str; 6] = [
    "'cylinder-cloak'",
    "'sphere-cloak'",
    "'invisible-sphere'",
    "'eaton-lens'",
    "'luneburg-lens'",
    "'fisheye-lens'",
];

#[test]
fn points_inside_are_inside_and_devices_do_not_overlap() {
    for kind in ROUND {
        let assembly = try_bench(kind).unwrap();
        assert_eq!(assembly.device_containing(DVec3::new(0.0, 9.99, 0.0)), Some(0), "{kind}");
        assert_eq!(assembly.device_containing(DVec3::new(7.1, 7.1, 0.0)), None, "{kind}");
        let core = try_bench(&format!("{kind}\nshow = 'bare'"));
        if let Ok(core) = core {
            assert_eq!(core.device_containing(DVec3::new(3.9, 0.0, 0.0)), Some(0), "{kind}");
            assert_eq!(core.device_containing(DVec3::new(4.1, 0.0, 0.0)), None, "{kind}");
        }
        for other in ROUND {
            let beside = |x: f64| {
                try_bench(&format!("{kind}\n[[device]]\nkind = {other}\nposition = [{x:?}, 0, 0]"))
            };
            assert!(beside(20.0).is_ok(), "{kind} {other}");
            assert!(
                matches!(
                    beside(19.99),
                    Err(PreparedSceneError::Overlap {
                        first: DeviceName { number: 0, .. },
                        second: DeviceName { number: 1, .. }
                    })
                ),
                "{kind} {other}"
            );
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let refused = |device: &str| match try_bench(device) {
        Err(PreparedSceneError::Device { error, .. }) => {
            (error.key.unwrap_or_default(), error.message)
        }
        other => panic!("{device}: {other:?}"),
    };
    for kind in &ROUND[2..] {
        for show in ["bare", "mirror"] {
            let (key, message) = refused(&format!("{kind}\nshow = '{show}'"));
            assert!(key == "show" && message.contains("hides no metal"), "{message}");
        }
        assert_eq!(refused(&format!("{kind}\nlength = 3")).0, "length");
    }
    for kind in &ROUND[..2] {
        for inner in [10.0, 12.0, 9.9999, 1e-4] {
            let (key, message) = refused(&format!("{kind}\ninner = {inner:?}"));
            assert!(key == "inner" && message.contains("outer"), "{message}");
        }
    }
}
