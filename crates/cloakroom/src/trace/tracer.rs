//! The walk along the ray tree.

use super::bodies::Around;
use super::branch::{Branch, Place};
use super::{Bench, Leaf, Outcome, Placed, Screen};
use crate::device::{Beyond, Cell, Entrance, Finish, SkinHit};
use glam::DVec3;
use optics::interface::{
    IncidentWave, OutgoingWave, OutgoingWaves, Side, reflect_at_conductor, split,
    transmit_antireflection,
};
use optics::medium::{Medium, ModeKind};
use optics::wave::ComplexVector;

/// A ray to launch in air, with `N` polarizations at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch<const N: usize> {
    /// Where it starts, cm.
    pub origin: DVec3,
    /// Its direction, a unit vector.
    pub direction: DVec3,
    /// The electric fields, across the direction and of unit norm.
    pub electric: [ComplexVector; N],
}

/// When a branch is followed no further, and how exactly graded media are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Branches below this share of the launched power, in every polarization, are pruned.
    pub min_power: f64,
    /// Largest error of position and optical path on leaving a device, cm.
    pub tolerance: f64,
}

/// Few trees meet this many surfaces. Those that do, by light that is trapped or runs almost along the
/// device, are followed on with a threshold ten times as high, so that the strong branches are not
/// lost; what that cuts counts as pruned.
const MANY_EVENTS: u32 = 100_000;

/// After as many surfaces again the threshold is raised once more.
const MORE_EVENTS: u32 = 10_000;

/// What rounding leaves of a wave that is not there.
const NO_POWER: f64 = 1e-24;

/// The share of the power that rounding may take at an interface.
const LEAK: f64 = 1e-10;

/// Traces rays. It keeps its memory from ray to ray: make one a thread.
#[derive(Debug)]
pub struct Tracer<'a, const N: usize> {
    pub(super) bench: &'a Bench,
    limits: Limits,
    pub(super) screen: Option<Screen>,
    pub(super) waiting: Vec<Branch<N>>,
    pub(super) leaves: Vec<Leaf<N>>,
    pub(super) outcome: Outcome<N>,
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// A tracer for the devices of `bench`.
    #[must_use]
    pub fn new(bench: &'a Bench, limits: Limits) -> Self {
        let outcome = Outcome::default();
        Self { bench, limits, screen: None, waiting: Vec::new(), leaves: Vec::new(), outcome }
    }

    /// Ends branches that meet a screen.
    #[must_use]
    pub fn with_screen(self, screen: Screen) -> Self {
        Self { screen: Some(screen), ..self }
    }

    /// Follows one ray to the end of every branch: the leaves, in the order the tree was walked,
    /// and the account of the rest of the power. The ray must start in air.
    pub fn trace(&mut self, launch: &Launch<N>) -> (&[Leaf<N>], &Outcome<N>) {
        self.leaves.clear();
        self.outcome = Outcome::default();
        self.waiting.clear();
        let mut next = Some(Branch {
            place: Place::Air { left: None },
            position: launch.origin,
            wave_vector: launch.direction,
            attenuation: DVec3::ZERO,
            direction: launch.direction,
            electric: launch.electric,
            power: launch.electric.map(ComplexVector::norm_squared),
            optical_path: 0.0,
            group_path: 0.0,
            around: Around::default(),
            standstills: 0,
            met_device: false,
            path: 0,
            mode: ModeKind::Shared,
            foothold: None,
        });
        let (mut events, mut threshold) = (0, self.limits.min_power.max(NO_POWER));
        while let Some(mut branch) = next.take().or_else(|| self.waiting.pop()) {
            if branch.largest_power() < threshold {
                self.outcome.rarities.endless += 1;
                self.prune(branch.power);
                continue;
            }
            events += 1;
            if events > MANY_EVENTS {
                events -= MORE_EVENTS;
                threshold *= 10.0;
            }
            match branch.place {
                Place::Air { left } => self.through_air(&mut branch, left),
                Place::Cell { device, cell } => self.through_cell(&mut branch, device, cell),
            }
        }
        (&self.leaves, &self.outcome)
    }

    fn through_air(&mut self, branch: &mut Branch<N>, left: Option<(u16, u16)>) {
        if !branch.around.nothing() {
            let bodies = self.bench.bodies();
            match bodies.crossing(branch.around, branch.position, branch.direction) {
                Some(crossing) => self.cross(*branch, &crossing),
                // It runs along an endless body for ever.
                None => self.lose(branch.power),
            }
            return;
        }
        let hit = self.surface_ahead(branch.position, branch.direction, left);
        let distance = hit.map(|(_, hit)| hit.distance);
        if let Some(crossing) = self.body_ahead(branch.position, branch.direction, distance) {
            self.cross(*branch, &crossing);
            return;
        }
        let Some((device_index, hit)) = hit else {
            self.leaves.push(branch.leaf(None));
            return;
        };
        branch.position += branch.direction * hit.distance;
        branch.optical_path += hit.distance;
        branch.group_path += hit.distance;
        branch.met_device = true;
        let device = &self.bench.devices()[usize::from(device_index)];
        let into = -hit.outward;
        let air = Place::Air { left: Some((device_index, hit.skin)) };
        let event = u64::from(device_index) << 32 | u64::from(hit.skin) << 2;
        let local = branch.to_local(&device.pose);
        match hit.beyond {
            Beyond::Conductor => {
                for wave in reflect_at_conductor(&Medium::AIR, &local.incident(), into) {
                    if self.follows(wave.power) {
                        let onward = local.onward(&wave, air, event);
                        self.waiting.push(onward.to_world(&device.pose));
                    }
                }
            }
            Beyond::Cell(cell) | Beyond::Seam(cell) => {
                let inside = Place::Cell { device: device_index, cell };
                let cell = self.cell(device, cell);
                let mut graded = None;
                let Some((entrance, beyond)) = entered(cell, local.position, &mut graded) else {
                    self.lose(branch.power);
                    return;
                };
                for wave in self.split(&Medium::AIR, beyond, &local, into, hit.finish) {
                    if !self.follows(wave.power) {
                        continue;
                    }
                    let event = event | side_code(&wave);
                    self.waiting.push(match wave.side {
                        Side::Reflected => local.onward(&wave, air, event).to_world(&device.pose),
                        Side::Transmitted => Branch {
                            foothold: entrance.foothold,
                            ..local.onward(&wave, inside, event)
                        },
                    });
                }
            }
            // A thin sheet of air: nothing there.
            Beyond::Air => self.waiting.push(Branch { place: air, ..*branch }),
        }
    }

    fn through_cell(&mut self, branch: &mut Branch<N>, device_index: u16, cell_index: u16) {
        let device = &self.bench.devices()[usize::from(device_index)];
        let cell = self.cell(device, cell_index);
        if branch.mode == ModeKind::Shared
            && let Some([(a, in_a), (b, in_b)]) = cell.parted(branch.position, branch.wave_vector)
        {
            for part in [branch.part(a, in_a, in_b), branch.part(b, in_b, in_a)] {
                if self.follows(part.power) {
                    self.waiting.push(part);
                }
            }
            return;
        }
        let Some(passage) = cell.advance(&branch.inner_ray(), self.limits.tolerance) else {
            self.lose(branch.power);
            return;
        };
        let way = passage.position - branch.position;
        branch.position = passage.position;
        let mut graded_here = None;
        let medium = cell.medium(passage.position, passage.foothold.as_ref(), &mut graded_here);
        let Some(medium) = medium else {
            self.lose(branch.power);
            return;
        };
        if medium.absorbs() && !self.absorb(branch, way) {
            return;
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
        let here = branch.place;
        match passage.beyond {
            Beyond::Conductor => {
                for wave in reflect_at_conductor(medium, &branch.incident(), passage.outward) {
                    if self.follows(wave.power) {
                        let event = event | side_code(&wave);
                        self.waiting.push(branch.onward(&wave, here, event));
                    }
                }
            }
            Beyond::Seam(next) => self.waiting.push(Branch {
                place: Place::Cell { device: device_index, cell: next },
                ..*branch
            }),
            Beyond::Cell(next) => {
                let there = Place::Cell { device: device_index, cell: next };
                let next = self.cell(device, next);
                let mut graded = None;
                let Some((entrance, beyond)) = entered(next, branch.position, &mut graded) else {
                    self.lose(branch.power);
                    return;
                };
                let waves = self.split(medium, beyond, branch, passage.outward, passage.finish);
                for wave in waves {
                    if !self.follows(wave.power) {
                        continue;
                    }
                    let event = event | side_code(&wave);
                    self.waiting.push(match wave.side {
                        Side::Reflected => branch.onward(&wave, here, event),
                        Side::Transmitted => Branch {
                            foothold: entrance.foothold,
                            ..branch.onward(&wave, there, event)
                        },
                    });
                }
            }
            Beyond::Air => {
                let waves =
                    self.split(medium, &Medium::AIR, branch, passage.outward, passage.finish);
                for wave in waves {
                    if !self.follows(wave.power) {
                        continue;
                    }
                    let event = event | side_code(&wave);
                    self.waiting.push(match wave.side {
                        Side::Reflected => branch.onward(&wave, here, event),
                        Side::Transmitted => {
                            let air = Place::Air { left: None };
                            branch.onward(&wave, air, event).in_air().to_world(&device.pose)
                        }
                    });
                }
            }
        }
    }

    /// The surface that a ray in air meets before the screen; `left` is the one it has just left.
    pub(super) fn surface_ahead(
        &self,
        position: DVec3,
        direction: DVec3,
        left: Option<(u16, u16)>,
    ) -> Option<(u16, SkinHit)> {
        let screen = self.screen.and_then(|screen| screen.hit(position, direction));
        self.bench
            .first_hit(position, direction, left)
            .filter(|(_, hit)| screen.is_none_or(|distance| hit.distance < distance))
    }

    pub(super) fn split(
        &mut self,
        from: &Medium,
        to: &Medium,
        branch: &Branch<N>,
        normal: DVec3,
        finish: Finish,
    ) -> OutgoingWaves<N> {
        let waves = split_as_finished(from, to, &branch.incident(), normal, finish);
        self.check_account(branch, &waves);
        waves
    }

    /// Takes from a branch what an absorbing medium keeps of it on a straight way; whether what is left
    /// is to be followed, for else it is pruned.
    pub(super) fn absorb(&mut self, branch: &mut Branch<N>, way: DVec3) -> bool {
        // Power never grows along a ray: rounding must not have it so.
        let depth = (self.bench.vacuum_wave_number() * branch.attenuation.dot(way)).max(0.0);
        let (amplitude, kept) = ((-depth).exp(), (-2.0 * depth).exp());
        for (i, power) in branch.power.iter_mut().enumerate() {
            let left = *power * kept;
            self.outcome.absorbed[i] += *power - left;
            *power = left;
            branch.electric[i] = branch.electric[i] * amplitude;
        }
        self.follows(branch.power)
    }

    /// Counts power as lost that an interface could not hand on: the account must not leak, even
    /// where numbers fail.
    fn check_account(&mut self, branch: &Branch<N>, waves: &[OutgoingWave<N>]) {
        let mut lost = false;
        for (i, power) in branch.power.iter().enumerate() {
            let rest = power - waves.iter().map(|wave| wave.power[i]).sum::<f64>();
            if rest.abs() > LEAK * power {
                self.outcome.pruned[i] += rest;
                lost = true;
            }
        }
        self.outcome.rarities.lost += u64::from(lost);
    }

    /// Whether a branch of that power is followed; else it is pruned, and need not be made.
    pub(super) fn follows(&mut self, power: [f64; N]) -> bool {
        let largest = power.iter().copied().fold(0.0, f64::max);
        let follows = largest >= self.limits.min_power.max(NO_POWER);
        if !follows {
            self.prune(power);
        }
        follows
    }

    /// Gives up a branch that cannot be followed.
    fn lose(&mut self, power: [f64; N]) {
        self.outcome.rarities.lost += 1;
        self.prune(power);
    }

    pub(super) fn prune(&mut self, power: [f64; N]) {
        for (sum, power) in self.outcome.pruned.iter_mut().zip(power) {
            *sum += power;
        }
    }

    pub(super) fn cell(&self, device: &'a Placed, index: u16) -> &'a Cell {
        &device.structure.cells[usize::from(index)]
    }
}

/// Splits a wave at the interface of two media that meet as `finish` says.
pub(super) fn split_as_finished<const N: usize>(
    from: &Medium,
    to: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
    finish: Finish,
) -> OutgoingWaves<N> {
    match finish {
        Finish::Bare => split(from, to, wave, normal),
        Finish::Antireflection => transmit_antireflection(from, to, wave, normal),
    }
}

/// What a ray finds that enters a cell, and the medium there.
fn entered<'m>(
    cell: &'m Cell,
    position: DVec3,
    graded: &'m mut Option<Medium>,
) -> Option<(Entrance, &'m Medium)> {
    let entrance = cell.enter(position)?;
    let medium = cell.medium(position, entrance.foothold.as_ref(), graded)?;
    Some((entrance, medium))
}

/// Tells the branches at one surface apart in the fingerprint of the path.
pub(super) fn side_code<const N: usize>(wave: &OutgoingWave<N>) -> u64 {
    let side = match wave.side {
        Side::Reflected => 1,
        Side::Transmitted => 2,
    };
    side | (wave.mode as u64) << 56
}
