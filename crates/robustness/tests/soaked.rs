//! What the soak has found: devices and rays whose power was lost track of, or was no number.
#![allow(clippy::unwrap_used, reason = "a test may")]

use cloakroom::render;
use cloakroom::scene_file::{self, Loaded};
use cloakroom::trace::{Launch, Limits, TraceStats, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use std::path::Path;

fn scene(text: &str) -> Result<Loaded, String> {
    let text = format!("[[device]]\n{text}");
    scene_file::parse(&text, "soak", Path::new(""), &[]).map_err(|error| error.to_string())
}

/// Looks at the tree of a ray; what in it is rare.
fn sound(keys: &str, origin: DVec3, direction: DVec3, tolerance: f64) -> TraceStats {
    let loaded = scene(keys).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let tracer = Tracer::new(&assembly, Limits { min_power: 1e-4, tolerance });
    let mut tracer = robustness::timed(tracer, &assembly);
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
    let (leaves, outcome) = tracer.trace(&launch);
    assert!(robustness::examine(origin, leaves, outcome).is_ok(), "{keys}: {leaves:?} {outcome:?}");
    outcome.stats
}

/// Devices so small that surfaces have no normals in double precision lost light.
#[test]
fn senseless_sizes_are_refused() {
    for (keys, key) in [
        ("kind = \"gaussian-carpet\"\nwidth = 1.0063648067091695e-306\n", "width"),
        ("kind = \"gaussian-carpet\"\nh = 1.1734110701446959e-236\n", "h"),
        ("kind = \"eaton-lens\"\nradius = 2e-201\n", "radius"),
        ("kind = \"square-cloak\"\nrotation = 1.7e308\n", "rotation"),
    ] {
        let message = scene(keys).unwrap_err();
        assert!(
            message.contains(&format!("{key} is ")) && message.contains("must be from"),
            "{message}"
        );
    }
}

/// In a corner of a hyperbolic medium a wave gets shorter at every face, until its fields were no
/// numbers.
#[test]
fn light_that_runs_into_a_corner_of_a_hyperbolic_medium_ends() {
    let prisms = "kind = \"prisms\"\nrotation = 0.30833858620102117\n\
        [[device.prism]]\ncorners = [[10.785691898779323, -7.645163415135461], [10.0, -2.083400603584786], \
        [7.208506828911087, -2.2994805842921853], [2.2205757401597053, -6.0], [6.0, -8.793901199562285], \
        [3.952491679608414, -13.0], [10.789049074511201, -11.628383425259797]]\n\
        permittivity = [[-13309.27594767034, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 0.3932181403195679]]\n\
        [[device.prism]]\ncorners = [[7.0, 5.0], [5.0, 8.0], [2.800660136634953, 5.3614352432478265], \
        [-3.8679020308049123, 7.519743237573129], [-2.9044891109001147, 2.6893283514490163], \
        [4.0, -2.1921230391605127], [7.534515494848552, -2.0]]\npermeability = -1.8148269154005803\n";
    let origin = DVec3::new(-38.30529692037659, -22.446144844193572, 19.30201199522524);
    let direction = DVec3::new(0.862741895361695, 0.43807378577538286, -0.2525228310552024);
    let stats = sound(prisms, origin, direction, 1.95e-9);
    assert!(matches!(stats, TraceStats { endless: 1.., lost: 0 }), "{stats:?}");
}

/// A permeability of 2e-38 made fields that are no numbers.
#[test]
fn media_whose_fields_are_no_numbers_are_refused() {
    let prism = "kind = \"prisms\"\n[[device.prism]]\ncorners = [[3, -6], [0, 9], [-3, -6]]\npermeability = -2e-38\n";
    let refused = scene(prism).map(|loaded| render::assembly(&loaded.scene).map(|_| ()));
    let message = match refused {
        Err(message) => message,
        Ok(made) => made.unwrap_err().to_string(),
    };
    assert!(message.contains("permeability") && message.contains("1e-12 to 1e12"), "{message}");
}

/// A process whose smallest permittivity is 1e9 made rays in air that were off by 1e-5 of their
/// direction.
#[test]
fn media_too_dense_for_directions_in_air_are_refused() {
    let cloak = |minimum: f64| {
        let text = format!(
            "kind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\n[device.imperfection]\nminimum = {minimum:?}\n"
        );
        scene(&text)
            .map(|loaded| render::assembly(&loaded.scene).map(|_| ()).map_err(|e| e.to_string()))
    };
    assert_eq!(cloak(1e6), Ok(Ok(())));
    let message = cloak(1e9).unwrap_err();
    assert!(message.contains("minimum") && message.contains("-1000000 to 1000000"), "{message}");
}

/// Waves that are evanescent but for a loss of 4e-7 were followed along the surfaces that they decay
/// from, into corners where each reflection made more of them.
#[test]
fn evanescent_waves_in_media_that_hardly_absorb_are_no_rays() {
    let prisms = "kind = \"prisms\"\nrotation = 13\nposition = [1.5, -2, 0.5]\nlength = 18\n\
        [[device.prism]]\ncorners = [[-8, -6], [4, -6], [4, 0], [-2, 0], [-2, 7], [-8, 7]]\npermittivity = 1.44\n\
        [[device.prism]]\ncorners = [[4, -4], [9, -4], [9, -2], [4, -2]]\n\
        permittivity = [[1.3, 0.05, 0], [0.05, 1.4, 0], [0, 0, [1.2, 4e-7]]]\npermeability = [1.03, 1e-7]\n\
        [[device.prism]]\ncorners = [[-2, 0], [1, 0], [1, 5], [-2, 5]]\nmetal = true";
    let loaded = scene(prisms).unwrap();
    let assembly = render::assembly(&loaded.scene).unwrap();
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-9, tolerance: 1e-6 });
    let origin = DVec3::new(-41.40687795969556, 68.45049640163961, -6.760059984153486);
    let direction = DVec3::new(0.543574349903507, -0.826157068311472, 0.14829505927701575);
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let (leaves, outcome) =
        tracer.trace(&Launch { origin, direction, electric: [h.into(), v.into()] });
    outcome.assert_balanced(leaves, 1e-12, &"the corner");
    for leaf in leaves {
        // Along z nothing turns light but the ends, which it does not reach.
        let along = (leaf.direction.z.abs() - direction.z).abs();
        assert!(leaf.power.iter().all(|power| *power < 1.0) && along < 1e-6, "{leaf:?}");
    }
}

/// A graded medium can keep light for longer than it can be followed: that has no end, and is not
/// lost.
#[test]
fn light_that_a_graded_medium_keeps_has_no_end() {
    // With n² = 3 - 2.5 r², r in units of 20 cm, light goes round at r² = 0.6.
    let index = |i: u32, j: u32| {
        let [x, y] = [i, j].map(|k| f64::from(k) / 8.0 - 1.0);
        (3.0 - 2.5 * (x * x + y * y)).max(0.1).sqrt()
    };
    let rows: Vec<String> = (0..17)
        .map(|i| format!("{:?}", (0..17).map(|j| index(i, j)).collect::<Vec<_>>()))
        .collect();
    let keys = format!("kind = \"graded\"\nshape = \"circle\"\nindex = [{}]", rows.join(", "));
    let stats = sound(&keys, DVec3::new(20.0 * 0.6f64.sqrt(), 0.0, 0.0), DVec3::Y, 1e-6);
    assert_eq!((stats.endless, stats.lost), (1, 0));
}
