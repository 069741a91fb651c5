//! What the soak has found: devices and rays whose power was lost track of, or was no number.
#![expect(clippy::unwrap_used, reason = "a test may")]

use cloakroom::render;
use cloakroom::scene_file::{self, Loaded};
use cloakroom::trace::{Launch, Limits, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use std::path::Path;

fn scene(text: &str) -> Result<Loaded, String> {
    let text = format!("[[device]]\n{text}");
    scene_file::parse(&text, "soak", Path::new(""), &[]).map_err(|error| error.to_string())
}

/// A carpet so small that its outline has no normals in double precision: metal was met that sent nothing back.
#[test]
fn light_that_metal_without_a_normal_swallows_counts_as_lost() {
    for (keys, origin, direction) in [
        (
            "kind = \"gaussian-carpet\"\nwidth = 1.0063648067091695e-306\n",
            DVec3::new(-10.091230226978684, 66.86108306141578, -9.019666871958792),
            DVec3::new(0.1479278598989477, -0.9801200354500553, 0.13221975788474083),
        ),
        (
            "kind = \"gaussian-carpet\"\nh = 1.1734110701446959e-236\n",
            DVec3::new(-10.524686059306516, -66.50447895996817, 0.0),
            DVec3::new(0.4711625681443822, 0.882046390151669, 0.0),
        ),
    ] {
        let loaded = scene(keys).unwrap();
        let bench = render::bench(&loaded.scene).unwrap();
        let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-4, tolerance: 3e-4 });
        let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
        let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
        let (leaves, outcome) = tracer.trace(&launch);
        assert!(trials::examine(leaves, outcome).is_ok(), "{keys}: {leaves:?} {outcome:?}");
    }
}

/// A permeability of 2e-38 made fields that are no numbers.
#[test]
fn media_whose_fields_are_no_numbers_are_refused() {
    let prism = "kind = \"prisms\"\n[[device.prism]]\ncorners = [[3, -6], [0, 9], [-3, -6]]\npermeability = -2e-38\n";
    let refused = scene(prism).map(|loaded| render::bench(&loaded.scene).map(|_| ()));
    let message = match refused {
        Err(message) => message,
        Ok(made) => made.unwrap_err().to_string(),
    };
    assert!(message.contains("permeability") && message.contains("1e-12 to 1e12"), "{message}");
}
