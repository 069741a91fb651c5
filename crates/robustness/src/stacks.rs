//! Plates side by side and in one another, whose waves add as fields.

use crate::draws::Draws;
use crate::rays::launch_along;
use crate::scenes::{assembly, placed, tensor_near};
use cloakroom::trace::{Coherence, Launch, Limits, Tracer};
use glam::DVec3;
use optics::geometry::TOUCHING;
use std::fmt::Write;

/// Followed so far that what is pruned does not count among fields.
const LIMITS: Limits = Limits { min_power: 1e-24, tolerance: 1e-9 };

/// How far the sum of powers may be off, of plates within a centimetre from the origin. Phases are as
/// exact as places, and the farther from the origin, the less exact those are.
const CLOSED: f64 = 1e-9;

/// Stacks plates without loss in any pose, touching, apart or in one another, and sends rays through
/// them; how many.
///
/// # Panics
///
/// If the power of what comes out, added as fields, is not that of what went in.
pub fn stack(draws: &mut Draws<'_>) -> u64 {
    const RAYS: u64 = 4;
    let pose = draws.pose();
    // Waves of one plate are told apart by their length in part, those of several too many for it.
    let plates = 1 + draws.below(5);
    let bandwidth = if plates == 1 { *draws.pick(&[0.0, 1.0, 30.0, 100.0]) } else { 0.0 };
    let light = Coherence::new(550.0, bandwidth);
    let mut scene = String::new();
    let mut plate = |draws: &mut Draws<'_>, [from, to]: [f64; 2], priority: usize| {
        let place = placed(pose.to_world(DVec3::X * from.midpoint(to)), &pose.rotation());
        let medium = match draws.below(3) {
            0 => format!("permittivity = {:?}", draws.between(1.2, 6.0)),
            1 => format!("permittivity = {}", tensor_near(draws, 1.5, 4.0)),
            _ => format!(
                "permittivity = {}\npermeability = {}",
                tensor_near(draws, 1.5, 4.0),
                tensor_near(draws, 0.8, 1.6)
            ),
        };
        let _ = write!(
            scene,
            "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = {:?}\n{place}{medium}\n\
             priority = {priority}\n",
            to - from
        );
    };
    let mut x = 0.0;
    for _ in 0..plates {
        // Thin ones interfere, thicker ones in part.
        let thickness = 10f64.powf(draws.between(-4.9, -3.0));
        plate(draws, [x, x + thickness], 0);
        if bandwidth == 0.0 && draws.chance(128) {
            let within = [draws.between(0.0, 0.45), draws.between(0.0, 0.45)];
            // Faces that are less than TOUCHING apart are one, and no phase tells how far they are.
            let [before, behind] = within.map(|share| {
                let apart = share * thickness;
                if apart > TOUCHING { apart } else { 0.0 }
            });
            plate(draws, [x + before, x + thickness - behind], 1);
        }
        x += thickness;
        if draws.chance(64) {
            x += 10f64.powf(draws.between(-4.9, -3.0));
        }
    }
    let assembly = assembly(&scene);
    let mut tracer = Tracer::new(&assembly, LIMITS).joining(light);
    for _ in 0..RAYS {
        let along = DVec3::new(1.0, draws.between(-1.0, 1.0), draws.between(-1.0, 1.0));
        let Launch { origin, direction, electric } =
            launch_along(pose.to_world(-5.0 * along), pose.vector_to_world(along));
        let ray = Launch { origin, direction, electric: [*draws.pick(&electric)] };
        let (leaves, outcome) = tracer.trace(&ray);
        assert_eq!(outcome.stats.lost, 0, "{ray:?}\n{scene}");
        let sum: f64 = light.gather(leaves).iter().map(|leaf| leaf.power[0]).sum();
        let closed = CLOSED * pose.origin.length().max(1.0);
        assert!((sum - 1.0).abs() < closed, "{sum} {ray:?}\n{scene}");
    }
    RAYS
}
