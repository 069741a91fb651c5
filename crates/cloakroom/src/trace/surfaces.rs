//! From surface to surface: how a branch runs on, and what becomes of it where media meet.

use super::branch::{Branch, Left, Place};
use super::{Leg, Placed, Tracer, Witness};
use crate::device::{Beyond, Cell, Entrance, Finish, Passage, SkinHit};
use glam::DVec3;
use optics::interface::{
    OutgoingWave, OutgoingWaves, Side, reflect_at_conductor, split_down_to, transmit_antireflection,
};
use optics::medium::{Medium, ModeKind};

/// The square of the largest wave vector that is followed, a billion times the largest index of refraction. Light
/// that runs into a corner of a hyperbolic medium gets there: each face makes it shorter, and it never comes out.
const SHORTEST_WAVE: f64 = 1e30;

impl<'a, const N: usize, W: Witness<N>> Tracer<'a, N, W> {
    /// Whether a ray in air runs on through air to the screen, or for ever.
    #[must_use]
    pub fn meets_nothing(&self, origin: DVec3, direction: DVec3) -> bool {
        self.surface_ahead(origin, direction, None).is_none()
            && self.body_ahead(origin, direction, None).is_none()
    }

    /// Follows a branch in air to the next surface; whether it goes on from there.
    pub(super) fn through_air(&mut self, branch: &mut Branch<N>, left: Option<Left>) -> bool {
        if !branch.around.nothing() {
            let bodies = self.bench.bodies();
            return match bodies.crossing(branch.around, branch.position, branch.direction) {
                Some(crossing) => self.cross(branch, &crossing),
                // It runs along an endless body for ever.
                None => self.lose(branch.power),
            };
        }
        let hit = self.surface_ahead(branch.position, branch.direction, left);
        let distance = hit.map(|(_, hit)| hit.distance);
        if let Some(crossing) = self.body_ahead(branch.position, branch.direction, distance) {
            return self.cross(branch, &crossing);
        }
        let Some((device_index, hit)) = hit else {
            self.leaves.push(branch.leaf(None));
            return false;
        };
        let from = branch.position;
        branch.position += branch.direction * hit.distance;
        self.witness.saw(|| Leg::straight(branch, from, hit.distance));
        branch.optical_path += hit.distance;
        branch.group_path += hit.distance;
        branch.met_device = true;
        let device = &self.bench.devices()[usize::from(device_index)];
        let left = device.left(device_index, Some(hit.skin));
        let (cell_index, into) = match hit.beyond {
            // A thin sheet of air: nothing there.
            Beyond::Air => {
                let surface = Some(hit.skin);
                branch.place = Place::Air { left: Some(Left { device: device_index, surface }) };
                return true;
            }
            Beyond::Conductor => (None, -hit.outward),
            Beyond::Cell(cell) | Beyond::Seam(cell) => (Some(cell), -hit.outward),
        };
        branch.enter_frame(&device.pose);
        let event = u64::from(device_index) << 32 | u64::from(hit.skin) << 2;
        let Some(cell_index) = cell_index else {
            let waves = self.reflect(&Medium::AIR, branch, into);
            return self.go_on(branch, &waves, event, |branch, _| {
                branch.leave_frame(&device.pose, left);
            });
        };
        if let Some(interface) = self.bench.interfaces(device_index).entrance(hit.skin) {
            branch.go_on_as(&interface.transmit(&branch.incident()), event);
            branch.enter_cell(device_index, cell_index, None);
            return true;
        }
        let mut graded = None;
        let cell = self.cell(device, cell_index);
        let Some((entrance, beyond)) = entered(cell, branch.position, &mut graded) else {
            return self.lose(branch.power);
        };
        let mut waves = OutgoingWaves::new();
        self.split(&Medium::AIR, beyond, branch, into, hit.finish, &mut waves);
        self.go_on(branch, &waves, event, |branch, side| match side {
            Side::Reflected => branch.leave_frame(&device.pose, left),
            Side::Transmitted => branch.enter_cell(device_index, cell_index, entrance.foothold),
        })
    }

    /// Whether a branch in a cell starts as several waves that then part: each goes on alone.
    pub(super) fn parts(&mut self, branch: &Branch<N>, cell: &Cell) -> bool {
        if branch.mode != ModeKind::Shared {
            return false;
        }
        let parted = cell.parted(branch.position, branch.wave_vector);
        let Some([(a, in_a), (b, in_b)]) = parted else { return false };
        for mut part in [branch.part(a, in_a, in_b), branch.part(b, in_b, in_a)] {
            if self.follows(part.power) {
                part.weigh(self.least_power());
                self.waiting.push(part);
            }
        }
        true
    }

    /// Takes a branch to the surface to which it has passed through a cell; whether it goes on from there.
    pub(super) fn pass(
        &mut self,
        branch: &mut Branch<N>,
        (device_index, cell_index): (u16, u16),
        passage: Option<&Passage>,
    ) -> bool {
        let Some(passage) = passage else {
            return self.lose(branch.power);
        };
        let device = &self.bench.devices()[usize::from(device_index)];
        let cell = self.cell(device, cell_index);
        let way = passage.position - branch.position;
        self.witness.saw(|| Leg {
            power: branch.power,
            optical_path: branch.optical_path,
            inside: Some((device_index, cell_index)),
            path: cell.path(&branch.inner_ray(), passage, self.limits.tolerance),
        });
        branch.position = passage.position;
        let mut graded_here = None;
        let medium = cell.medium(passage.position, passage.foothold.as_ref(), &mut graded_here);
        let Some(medium) = medium else {
            return self.lose(branch.power);
        };
        if medium.absorbs() && !self.absorb(branch, way) {
            return false;
        }
        if passage.extinction > 0.0 && !self.extinguish(branch, passage.extinction) {
            return false;
        }
        branch.wave_vector = passage.wave_vector;
        branch.direction = passage.direction;
        branch.optical_path += passage.optical_path;
        branch.group_path += if passage.optical_path < 0.0 {
            way.length().max(-passage.optical_path)
        } else {
            passage.optical_path
        };
        branch.foothold = passage.foothold;
        if let Some(transport) = passage.transport {
            branch.electric = branch.electric.map(|field| field.transformed(&transport));
        }
        let event = u64::from(device_index) << 32
            | (u64::from(cell_index) + 1) << 20
            | u64::from(passage.face) << 2;
        let interface = self.bench.interfaces(device_index).exit(cell_index, passage.face);
        match passage.beyond {
            Beyond::Conductor => {
                let waves = self.reflect(medium, branch, passage.outward);
                self.go_on(branch, &waves, event, |_, _| ())
            }
            Beyond::Seam(next) => {
                branch.place = Place::Cell { device: device_index, cell: next };
                true
            }
            Beyond::Cell(next) => {
                if let Some(interface) = interface {
                    branch.go_on_as(&interface.transmit(&branch.incident()), event);
                    branch.enter_cell(device_index, next, None);
                    return true;
                }
                let mut graded = None;
                let beyond = entered(self.cell(device, next), branch.position, &mut graded);
                let Some((entrance, beyond)) = beyond else {
                    return self.lose(branch.power);
                };
                let mut waves = OutgoingWaves::new();
                self.split(medium, beyond, branch, passage.outward, passage.finish, &mut waves);
                self.go_on(branch, &waves, event, |branch, side| {
                    if side == Side::Transmitted {
                        branch.enter_cell(device_index, next, entrance.foothold);
                    }
                })
            }
            Beyond::Air => {
                // It has met no surface of the skin, which it may meet next unless the device is convex.
                let left = device.left(device_index, None);
                let leave = |branch: &mut Branch<N>| {
                    branch.come_out();
                    branch.leave_frame(&device.pose, left);
                };
                if let Some(interface) = interface {
                    branch.go_on_as(&interface.transmit(&branch.incident()), event);
                    leave(branch);
                    return true;
                }
                let air = &Medium::AIR;
                let mut waves = OutgoingWaves::new();
                self.split(medium, air, branch, passage.outward, passage.finish, &mut waves);
                self.go_on(branch, &waves, event, |branch, side| {
                    if side == Side::Transmitted {
                        leave(branch);
                    }
                })
            }
        }
    }

    /// The waves that metal sends back. Where it sends none, for a surface has no normal that numbers can hold, light is
    /// lost.
    fn reflect(&mut self, medium: &Medium, branch: &Branch<N>, into: DVec3) -> OutgoingWaves<N> {
        let waves = reflect_at_conductor(medium, &branch.incident(), into);
        if waves.is_empty() {
            self.lose(branch.power);
        }
        waves
    }

    /// Lets the waves that leave a surface go on, each put into its place: the last one as the branch itself,
    /// the others waiting. Whether there is one.
    pub(super) fn go_on(
        &mut self,
        branch: &mut Branch<N>,
        waves: &[OutgoingWave<N>],
        event: u64,
        put: impl Fn(&mut Branch<N>, Side),
    ) -> bool {
        let least_power = self.least_power();
        let mut last: Option<&OutgoingWave<N>> = None;
        for wave in waves {
            if !self.follows(wave.power) {
                continue;
            }
            if let Some(earlier) = last.replace(wave) {
                // Branches are large, and made where they wait.
                self.waiting.push(*branch);
                if let Some(other) = self.waiting.last_mut() {
                    other.go_on_as(earlier, event | side_code(earlier));
                    other.weigh(least_power);
                    put(other, earlier.side);
                }
            }
        }
        let Some(wave) = last else { return false };
        branch.go_on_as(wave, event | side_code(wave));
        branch.weigh(least_power);
        put(branch, wave.side);
        true
    }

    /// The surface that a ray in air meets before the screen; `left` is the one it has just left.
    pub(super) fn surface_ahead(
        &self,
        position: DVec3,
        direction: DVec3,
        left: Option<Left>,
    ) -> Option<(u16, SkinHit)> {
        let hit = self.bench.first_hit(position, direction, left)?;
        let screen = self.screen.and_then(|screen| screen.hit(position, direction));
        screen.is_none_or(|distance| hit.1.distance < distance).then_some(hit)
    }

    pub(super) fn split(
        &mut self,
        from: &Medium,
        to: &Medium,
        branch: &Branch<N>,
        normal: DVec3,
        finish: Finish,
        waves: &mut OutgoingWaves<N>,
    ) {
        if branch.wave_vector.length_squared() > SHORTEST_WAVE {
            self.outcome.rarities.endless += 1;
            self.prune(branch.power);
            return;
        }
        let wave = branch.incident();
        let mut weak = [0.0; N];
        match finish {
            Finish::Bare => {
                weak = split_down_to(from, to, &wave, normal, self.least_power(), waves);
            }
            Finish::Antireflection => {
                waves.extend(transmit_antireflection(from, to, &wave, normal));
            }
        }
        self.check_account(branch, waves, weak);
    }

    pub(super) fn cell(&self, device: &'a Placed, index: u16) -> &'a Cell {
        &device.structure.cells[usize::from(index)]
    }
}

/// What a ray finds that enters a cell, and the medium there.
pub(super) fn entered<'m>(
    cell: &'m Cell,
    position: DVec3,
    graded: &'m mut Option<Medium>,
) -> Option<(Entrance, &'m Medium)> {
    let entrance = cell.enter(position)?;
    let medium = cell.medium(position, entrance.foothold.as_ref(), graded)?;
    Some((entrance, medium))
}

/// Tells the branches at one surface apart in the fingerprint of the path.
fn side_code<const N: usize>(wave: &OutgoingWave<N>) -> u64 {
    let side = match wave.side {
        Side::Reflected => 1,
        Side::Transmitted => 2,
    };
    side | (wave.mode as u64) << 56
}
