//! Rays that cross the surfaces of bodies.

use super::bodies::{Around, Bodies, Crossing, Inside, ONE_SURFACE};
use super::branch::{Branch, Place};
use super::tracer::Tracer;
use super::{Leg, Witness};
use crate::device::Finish;
use glam::DVec3;
use optics::interface::{OutgoingWaves, Side};
use optics::medium::Medium;

/// Light that crosses more surfaces than this in a row within rounding of one point has spiralled into an
/// edge of a negative-index body, and never comes out.
const MOST_STANDSTILLS: u8 = 16;

/// Tells events at bodies from those at devices in the fingerprint of a path.
const BODY_EVENT: u64 = 1 << 55;

impl<const N: usize, W: Witness<N>> Tracer<'_, N, W> {
    /// The surface of a body that a ray in air meets before the screen and before the surface of another device
    /// at the distance `hit`.
    pub(super) fn body_ahead(
        &self,
        position: DVec3,
        direction: DVec3,
        hit: Option<f64>,
    ) -> Option<Crossing> {
        let bodies = self.bench.bodies();
        if bodies.is_empty() {
            return None;
        }
        let crossing = bodies.crossing(Around::default(), position, direction)?;
        let screen = self.screen.and_then(|screen| screen.hit(position, direction));
        let first = [hit, screen].into_iter().flatten().all(|other| crossing.distance < other);
        first.then_some(crossing)
    }

    /// Follows a branch in air or in a body to where it crosses the surface of a body; whether it goes on
    /// from there.
    pub(super) fn cross(&mut self, branch: &mut Branch<N>, crossing: &Crossing) -> bool {
        branch.standstills =
            if crossing.distance < ONE_SURFACE { branch.standstills + 1 } else { 0 };
        if branch.standstills > MOST_STANDSTILLS {
            self.outcome.rarities.endless += 1;
            self.prune(branch.power);
            return false;
        }
        let bodies = self.bench.bodies();
        let way = branch.direction * crossing.distance;
        let (medium, group_index) = match bodies.inside(branch.around) {
            Inside::Medium(medium, group_index) => (medium, group_index),
            Inside::Air | Inside::Opaque(_) => (&Medium::AIR, None),
        };
        let from = branch.position;
        branch.position += way;
        branch.met_device = true;
        let optical_path = branch.wave_vector.dot(way);
        self.witness.saw(|| Leg::straight(branch, from, optical_path));
        branch.optical_path += optical_path;
        branch.group_path += match group_index {
            Some(index) => index * crossing.distance,
            None => optical_path.abs().max(crossing.distance),
        };
        if medium.absorbs() && !self.absorb(branch, way) {
            return false;
        }
        let around = Bodies::beyond(branch.around, crossing);
        let (here, beyond) = (bodies.inside(branch.around), bodies.inside(around));
        branch.place = Place::Air { left: None };
        if here == beyond {
            // A surface of bodies that give way here to another, or between equal media: nothing is there.
            branch.around = around;
            return true;
        }
        let (beyond, to_air) = match beyond {
            Inside::Opaque(body) => {
                self.leaves.push(branch.leaf(Some(body)));
                return false;
            }
            Inside::Medium(medium, _) => (medium, false),
            Inside::Air => (&Medium::AIR, true),
        };
        let event = BODY_EVENT | (crossing.body as u64) << 32;
        let mut waves = OutgoingWaves::new();
        self.split(medium, beyond, branch, crossing.onward, Finish::Bare, &mut waves);
        self.go_on(branch, &waves, event, |branch, side| {
            if side == Side::Transmitted {
                branch.around = around;
                if to_air {
                    branch.come_out();
                }
            }
        })
    }
}
