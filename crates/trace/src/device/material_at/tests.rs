use super::*;
use crate::device::{Core, Request, built};

fn structure(kind: &str, core: Core) -> Structure {
    let request = Request { core, length: Some(20.0), ..Request::default() };
    built(kind, &[], request)
}

#[test]
fn air_media_metal_and_the_hidden_region_are_told_apart() {
    // Of each cloak a point in its medium and one in its hidden region.
    for (kind, in_medium, hidden) in [
        ("square-cloak", DVec3::new(0.0, 8.0, 3.0), DVec3::new(1.0, -1.0, 3.0)),
        ("double-gaussian-cloak", DVec3::new(3.0, -9.0, 3.0), DVec3::new(1.0, -1.0, 3.0)),
        ("cylinder-cloak", DVec3::new(0.0, -7.0, 3.0), DVec3::new(0.0, 3.9, -3.0)),
    ] {
        for core in [Core::Metal, Core::Open] {
            let device = structure(kind, core);
            let inside = match core {
                Core::Metal => MaterialAt::Metal,
                Core::Open => MaterialAt::HiddenAir,
            };
            assert!(matches!(device.material_at(in_medium), MaterialAt::Medium(_)), "{kind}");
            assert_eq!(device.material_at(hidden), inside, "{kind}");
            for outside in [DVec3::new(60.0, 0.0, 0.0), hidden.with_z(10.5)] {
                assert_eq!(device.material_at(outside), MaterialAt::Air, "{kind}");
            }
        }
    }
}

#[test]
fn below_a_carpet_there_is_metal() {
    let device = structure("gaussian-carpet", Core::Metal);
    assert_eq!(device.material_at(DVec3::new(0.0, 4.2, 0.0)), MaterialAt::Metal);
    assert!(matches!(device.material_at(DVec3::new(0.0, 4.3, 0.0)), MaterialAt::Medium(_)));
    assert_eq!(device.material_at(DVec3::new(0.0, -0.1, 0.0)), MaterialAt::Air);
}
