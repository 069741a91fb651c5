//! The walk along the ray tree.

use super::branch::{Branch, LAUNCHED, Place, largest};
use super::coherence::Joining;
use super::draw::{Draw, MOST_EVENTS_DRAWN};
use super::{Coherence, Leaf, LeafEnd, Outcome, PathRecorder};
use crate::assembly::{Assembly, Screen};
use crate::device::{Dispersion, InnerRay, NoPassage, Passage};
use glam::DVec3;
use optics::interface::OutgoingWaves;
use optics::wave::ComplexVector;

/// A ray to launch, with `N` polarizations at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch<const N: usize> {
    /// Where it starts, cm.
    pub origin: DVec3,
    /// Its direction, a unit vector.
    pub direction: DVec3,
    /// The electric fields, across the direction and of unit norm; each has the power 1 wherever it
    /// starts.
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

/// What a tree may cost, in terms of a surface met. Few do. Those that do, by light that is trapped or runs
/// almost along the device, are followed on with the strongest branch first.
const MUCH: u32 = 5_000;

/// So much more they may cost for each share of the least power that still waits then; what is left
/// counts as pruned.
const DESERVED: f64 = 10.0;

/// No tree costs more than so much then for each factor of ten between that power and the least.
const MOST_DESERVED: f64 = 10_000.0;

/// What a way through a medium costs that is followed step by step, beside the surface that it comes to.
const COST_OF_INTEGRATION: u32 = 15;

/// As often, in surfaces met, it is looked whether a branch runs in place: into a corner of media in
/// which rays and wave vectors go different ways, say, where it never arrives.
const EVENTS_PER_LOOK: u32 = 8;

/// A branch runs in place that has as much of its power left after that.
const LEFT_IN_PLACE: f64 = 0.99875;

/// A branch that carries more than so many times what was launched is not followed. In absorbing
/// media beams carry what their interference takes back; where light starts in a film of such a
/// medium that is thinner than a wavelength, more of it at each total reflection.
const MOST_POWER: f64 = 1e3;

/// A branch that is taken further on than its ray starts may be so far out of its region, in terms
/// of the tolerance.
const MOST_BEYOND: f64 = 100.0;

/// What rounding leaves of a wave that is not there.
const NO_POWER: f64 = 1e-24;

/// The share of the power that rounding may take at an interface.
const LEAK: f64 = 1e-10;

/// Where fields may have cancelled, the least power of which that share is asked.
const CANCELLED: f64 = 1e-6;

/// Traces rays. It keeps its memory from ray to ray: make one a thread. `W` is who watches it,
/// nobody as a rule.
#[derive(Clone, Debug)]
pub struct Tracer<'a, const N: usize, W = ()> {
    pub(super) assembly: &'a Assembly,
    pub(super) limits: Limits,
    pub(super) screen: Option<Screen>,
    pub(super) waiting: Vec<Branch<N>>,
    pub(super) leaves: Vec<Leaf<N>>,
    pub(super) outcome: Outcome<N>,
    /// Surfaces met.
    events: u32,
    /// What the tree has cost, and may cost.
    cost: u32,
    most_cost: u32,
    /// When the branch of that time is looked at.
    next_look: u32,
    /// What it was like the last time, if it is the same branch, and how many others waited.
    looked_at: Option<(Branch<N>, usize)>,
    /// Of the branches that wait, how many are in a heap, the strongest first; `None` where the last
    /// is taken.
    heaped: Option<usize>,
    /// Where branches are joined, how many of them, the first ones, have met as many surfaces as the branch that is
    /// followed; the others have met one more.
    in_turn: usize,
    pub(super) recorder: W,
    /// Which branches become one where they run together.
    joining: Option<Joining>,
    /// How one of its leaves is drawn, if only that is wanted.
    pub(super) draw: Option<Draw<N>>,
    /// Whether leaves are to know what a pulse takes.
    group_delays: bool,
    /// To within how much, cm, if that is more than for other paths.
    pulse_tolerance: f64,
    /// Whether the screen touches a device.
    pub(super) screen_touches: bool,
    /// Whether what is endless may keep light: no screen is within, where it would end.
    pub(super) keeps_light: bool,
    /// Whether nothing touches what rays leave: there is one device at most, no body, and the
    /// screen is apart.
    pub(super) stands_alone: bool,
    /// Where the last rays have started, and in which region of which device.
    pub(super) started: (DVec3, Option<(u16, u16)>),
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// A tracer for the devices of `assembly`.
    #[must_use]
    pub fn new(assembly: &'a Assembly, limits: Limits) -> Self {
        Self::watching(assembly, limits, ())
    }

    /// The same tracer, watched.
    #[must_use]
    pub fn watched<W: PathRecorder<N>>(self, recorder: W) -> Tracer<'a, N, W> {
        let tracer = Tracer::watching(self.assembly, self.limits, recorder);
        let Self { group_delays, pulse_tolerance, .. } = self;
        let tracer = Tracer { group_delays, pulse_tolerance, ..tracer };
        match self.screen {
            Some(screen) => tracer.with_screen(screen),
            None => tracer,
        }
    }
}

impl<'a, const N: usize, W: PathRecorder<N>> Tracer<'a, N, W> {
    fn watching(assembly: &'a Assembly, limits: Limits, recorder: W) -> Self {
        Self {
            assembly,
            limits,
            screen: None,
            joining: None,
            draw: None,
            group_delays: false,
            pulse_tolerance: 0.0,
            screen_touches: false,
            keeps_light: assembly.endless_axes != DVec3::ZERO,
            stands_alone: assembly.simple,
            waiting: Vec::new(),
            leaves: Vec::new(),
            outcome: Outcome::default(),
            events: 0,
            cost: 0,
            most_cost: MUCH,
            next_look: EVENTS_PER_LOOK,
            looked_at: None,
            heaped: None,
            in_turn: 0,
            started: (DVec3::NAN, None),
            recorder,
        }
        .within(limits)
    }

    /// Who watches it.
    pub fn watcher(&self) -> &W {
        &self.recorder
    }

    /// Who watches it, to be changed.
    pub fn recorder(&mut self) -> &mut W {
        &mut self.recorder
    }

    /// Ends branches that meet a screen.
    #[must_use]
    pub fn with_screen(self, screen: Screen) -> Self {
        let screen_touches = screen.touches(self.assembly);
        let simple = self.assembly.simple;
        let stands_alone = simple && !screen_touches;
        let is_within = || !simple || screen.cut_by(self.assembly).is_some();
        let keeps_light = self.keeps_light && !(screen_touches && is_within());
        Self { screen_touches, keeps_light, stands_alone, screen: Some(screen), ..self }
    }

    /// Makes one branch of those that run together, as fields: in plates the ways are many, and the
    /// waves few. Their leaves are to be [gathered](Coherence::gather); power that interference
    /// moves between leaves is in no account.
    #[must_use]
    pub fn joining(self, coherence: Coherence) -> Self {
        Self { joining: Some(Joining::same(coherence)), ..self }
    }

    /// Makes one branch, too, of those that a picture cannot tell apart, but for their phases: both
    /// waves of a medium that is hardly birefringent would be parted at each surface again.
    #[must_use]
    pub fn joining_similar(self, coherence: Coherence) -> Self {
        Self { joining: Some(Joining::similar(coherence)), ..self }
    }

    /// Follows rays within other limits.
    #[must_use]
    pub fn within(self, limits: Limits) -> Self {
        let min_power = limits.min_power.max(NO_POWER);
        Self { limits: Limits { min_power, ..limits }, ..self }
    }

    /// Works out what a pulse takes, too, [`Leaf::group_path`].
    #[must_use]
    pub fn with_group_delays(self) -> Self {
        self.with_group_delays_to(0.0)
    }

    /// The same to within `tolerance` (cm), if that is more than for other paths.
    #[must_use]
    pub fn with_group_delays_to(self, tolerance: f64) -> Self {
        Self { group_delays: true, pulse_tolerance: tolerance, ..self }
    }

    /// Follows one ray to the end of every branch: the leaves, in the order the tree was walked,
    /// and the account of the rest of the power. A ray that starts in a medium is launched in those
    /// waves of it whose rays run along its direction; one that starts in metal is lost.
    pub fn trace(&mut self, launch: &Launch<N>) -> (&[Leaf<N>], &Outcome<N>) {
        let mut branch = Branch::launched(launch);
        let mut here = self.begin(&mut branch);
        while let Some((device, number)) = here {
            let passage = self.advance((device, number), &branch.inner_ray());
            here = self.resume(&mut branch, (device, number), passage);
        }
        self.traced()
    }

    /// What has come of the last ray: see [`Tracer::trace`].
    #[must_use]
    pub fn traced(&self) -> (&[Leaf<N>], &Outcome<N>) {
        (&self.leaves, &self.outcome)
    }

    /// Follows the tree of a launched ray to where a branch, which takes the place of the given
    /// one, is to be taken through a region that takes four: the device and its region. None if it
    /// is at the end.
    pub(super) fn begin(&mut self, branch: &mut Branch<N>) -> Option<(u16, u16)> {
        self.clear();
        if self.group_delays {
            branch.dispersion = 0.0;
        }
        if let Some(draw) = &mut self.draw {
            draw.begin(branch);
            self.most_cost = MOST_EVENTS_DRAWN;
        }
        if !self.start(branch) {
            self.take_next(branch)?;
        }
        self.walk(branch)
    }

    /// As [`Self::begin`], but with branches further on to be followed, those in regions, and the launched ray only if
    /// `launched` says so.
    pub(super) fn begin_further_on(
        &mut self,
        branch: &mut Branch<N>,
        launched: bool,
        further_on: &[Branch<N>],
    ) -> Option<(u16, u16)> {
        self.clear();
        for further_on in further_on {
            let Place::Region { device, region } = further_on.place else { continue };
            let region = self.assembly.device(device).region(region);
            let beyond = MOST_BEYOND * self.limits.tolerance;
            if self.recorder.planes(further_on.path).is_some()
                || region.is_within_faces(further_on.position, beyond)
            {
                self.waiting.push(*further_on);
            } else {
                self.lose(further_on.power);
            }
        }
        if self.group_delays {
            branch.dispersion = 0.0;
        }
        if !(launched && self.start(branch)) {
            self.take_next(branch)?;
        }
        self.walk(branch)
    }

    fn clear(&mut self) {
        self.leaves.clear();
        self.outcome = Outcome::default();
        self.waiting.clear();
        (self.most_cost, self.heaped, self.in_turn) = (MUCH, None, 0);
        self.start_anew();
    }

    /// Counts events from here on.
    pub(super) fn start_anew(&mut self) {
        (self.events, self.cost) = (0, 0);
        (self.next_look, self.looked_at) = (EVENTS_PER_LOOK, None);
    }

    /// As [`Self::begin`], from where the branch has been taken through a region.
    pub(super) fn resume(
        &mut self,
        branch: &mut Branch<N>,
        region: (u16, u16),
        passage: Result<Passage, NoPassage>,
    ) -> Option<(u16, u16)> {
        if !self.pass(branch, region, passage.as_ref()) {
            self.take_next(branch)?;
        } else if self.joins().is_some() || self.heaped.is_some() || self.has_forked() {
            self.waiting.push(*branch);
            self.take_next(branch)?;
        }
        self.walk(branch)
    }

    /// Takes rays through a region: see
    /// [`Region::advance_four`](crate::device::Region::advance_four).
    pub(super) fn advance_four(
        &self,
        (device, region): (u16, u16),
        rays: &[Option<InnerRay>; 4],
    ) -> [Option<Result<Passage, NoPassage>>; 4] {
        let region = self.assembly.device(device).region(region);
        region.advance_four(rays, self.limits.tolerance, self.asked_pulses(device))
    }

    /// Takes a ray through a region: see [`Region::advance`](crate::device::Region::advance).
    fn advance(&self, (device, region): (u16, u16), ray: &InnerRay) -> Result<Passage, NoPassage> {
        let region = self.assembly.device(device).region(region);
        region.advance(ray, self.limits.tolerance, self.asked_pulses(device))
    }

    /// To within how much it is worked out what pulses take in a device, if that is another time than of the phase.
    pub(super) fn pulses(&self, device: u16) -> Option<f64> {
        let disperses = self.assembly.device(device).dispersion != Dispersion::None;
        disperses.then(|| self.pulse_tolerance.max(self.limits.tolerance))
    }

    fn asked_pulses(&self, device: u16) -> Option<f64> {
        if self.group_delays { self.pulses(device) } else { None }
    }

    fn walk(&mut self, branch: &mut Branch<N>) -> Option<(u16, u16)> {
        loop {
            let power = largest(&branch.power);
            let goes_on = if self.events >= self.next_look && self.runs_in_place(branch) {
                self.cut(branch.power)
            } else if self.cost >= self.most_cost && !self.may_go_on(branch) {
                self.cut_all(branch)
            } else if power < self.limits.min_power {
                self.cut(branch.power)
            } else if power > MOST_POWER {
                self.lose(branch.power)
            } else {
                self.events += 1;
                self.cost += 1;
                match branch.place {
                    Place::Air => match self.recorder.planes(branch.path) {
                        Some(planes) if branch.path == LAUNCHED => {
                            self.go_to_surfaces(branch, planes)
                        }
                        _ => self.through_air(branch),
                    },
                    Place::Region { device, region: number } => {
                        let region = self.assembly.device(device).region(number);
                        if region.is_integrated() && self.draw.is_none() {
                            self.cost += COST_OF_INTEGRATION;
                        }
                        if let Some(planes) = self.recorder.planes(branch.path) {
                            self.go_to_planes(branch, (device, number), planes)
                        } else if region.takes_four() {
                            return Some((device, number));
                        } else {
                            if region.is_homogeneous() {
                                self.recorder.begins(branch);
                            }
                            !self.parts(branch, region) && {
                                let ray = branch.inner_ray();
                                let passage = self.advance((device, number), &ray);
                                if let (false, Ok(passage)) = (region.faces().is_empty(), &passage)
                                {
                                    self.recorder.arrives(branch.path, passage.face);
                                }
                                self.pass(branch, (device, number), passage.as_ref())
                            }
                        }
                    }
                }
            };
            if !goes_on {
                self.take_next(branch)?;
            } else if self.joins().is_some() || self.heaped.is_some() || self.has_forked() {
                self.waiting.push(*branch);
                self.take_next(branch)?;
            }
        }
    }

    /// Takes a branch to planes around its region, each as if it were alone, where it waits as what
    /// goes on from there.
    #[cold]
    fn go_to_planes(&mut self, branch: &Branch<N>, place: (u16, u16), mut planes: u64) -> bool {
        self.recorder.begins(branch);
        let ray = branch.inner_ray();
        let region = self.assembly.device(place.0).region(place.1);
        if let Some(face) = self.plane_met(branch, 0.0) {
            self.recorder.arrives(branch.path, face);
        }
        while planes != 0 {
            let passage = region.passage_to_plane(&ray, planes.trailing_zeros() as u16);
            planes &= planes - 1;
            let Some(passage) = passage else { continue };
            let is_back = (passage.position - ray.position).dot(ray.direction) < 0.0;
            let forwards = ray.wave_vector.dot(ray.direction) > 0.0;
            if is_back && (self.group_delays || !forwards) {
                // It would take another time than its path says.
                continue;
            }
            let mut taken = *branch;
            if self.pass(&mut taken, place, Ok(&passage)) {
                self.waiting.push(taken);
            }
        }
        false
    }

    /// Takes a launched ray in air to plane surfaces of devices, each as if it were alone, where it
    /// waits as what goes on from there.
    #[cold]
    fn go_to_surfaces(&mut self, branch: &Branch<N>, mut numbers: u64) -> bool {
        while numbers != 0 {
            let surface = self.recorder.first_surface(numbers.trailing_zeros() as u16);
            numbers &= numbers - 1;
            let Some((device, surface)) = surface else {
                self.leaves.push(branch.leaf(LeafEnd::Away));
                continue;
            };
            if let Some(hit) = self.plane_surface_ahead(branch, (device, surface)) {
                let mut taken = *branch;
                if self.come_to(&mut taken, device, &hit) {
                    self.waiting.push(taken);
                }
            }
        }
        false
    }

    /// Which of the planes around its region a branch meets, if its region is between planes and it
    /// would be the same one from wherever within `slack` (cm) of where it is; it may be beyond them.
    #[must_use]
    pub fn plane_met(&self, branch: &Branch<N>, slack: f64) -> Option<u16> {
        let Place::Region { device, region } = branch.place else { return None };
        self.assembly.device(device).region(region).plane_met(&branch.inner_ray(), slack)
    }

    /// Whether a branch is where it was when it was looked at before, with as much power.
    #[cold]
    fn runs_in_place(&mut self, branch: &Branch<N>) -> bool {
        self.next_look = self.events + EVENTS_PER_LOOK;
        let waiting = self.waiting.len();
        let before = self.looked_at.replace((*branch, waiting));
        before.is_some_and(|(before, others)| {
            others == waiting
                && before.place == branch.place
                && before.position.distance(branch.position) <= self.limits.tolerance
                && largest(&branch.power) >= LEFT_IN_PLACE * largest(&before.power)
        })
    }

    /// Whether a tree that has met many surfaces is to be followed further: for as long as the power
    /// deserves that still waits.
    #[cold]
    fn may_go_on(&mut self, branch: &Branch<N>) -> bool {
        if self.heaped.is_some() || self.draw.is_some() {
            return false;
        }
        self.heaped = Some(0);
        let mut left = branch.power;
        for waiting in &self.waiting {
            left.iter_mut().zip(waiting.power).for_each(|(left, power)| *left += power);
        }
        let shares = largest(&left) / self.limits.min_power;
        let most = MOST_DESERVED * shares.log10().max(0.0);
        self.most_cost += (DESERVED * shares).min(most) as u32;
        true
    }

    /// Cuts a branch and all that wait.
    #[cold]
    fn cut_all(&mut self, branch: &Branch<N>) -> bool {
        for waiting in std::mem::take(&mut self.waiting) {
            self.cut(waiting.power);
        }
        self.cut(branch.power)
    }

    /// Takes the strongest of the branches that wait: a heap of which the last ones are not yet
    /// part.
    #[cold]
    fn take_strongest(&mut self, heaped: usize) -> Option<Branch<N>> {
        let power = |waiting: &[Branch<N>], i: usize| largest(&waiting[i].power);
        let waiting = &mut self.waiting;
        for new in heaped..waiting.len() {
            let mut child = new;
            while child > 0 && power(waiting, child) > power(waiting, (child - 1) / 2) {
                waiting.swap(child, (child - 1) / 2);
                child = (child - 1) / 2;
            }
        }
        let last = waiting.len().checked_sub(1)?;
        waiting.swap(0, last);
        let strongest = waiting.pop();
        let mut parent = 0;
        while let Some(child) = (2 * parent + 1..last.min(2 * parent + 3))
            .max_by(|&one, &other| power(waiting, one).total_cmp(&power(waiting, other)))
            && power(waiting, child) > power(waiting, parent)
        {
            waiting.swap(child, parent);
            parent = child;
        }
        self.heaped = Some(last);
        strongest
    }

    /// Puts in place of a branch the one to be followed next: the last that waits, or the strongest
    /// in large trees, or where branches are joined [one](Self::take_joined) with all that run together with it, or
    /// where a leaf is drawn the one that is. None if none waits.
    #[inline(always)]
    fn take_next(&mut self, branch: &mut Branch<N>) -> Option<()> {
        self.looked_at = None;
        if self.draw.is_some() {
            return self.take_drawn(branch);
        }
        if let Some(joining) = self.joins() {
            return self.take_joined(branch, joining);
        }
        if let Some(heaped) = self.heaped {
            *branch = self.take_strongest(heaped)?;
            return Some(());
        }
        *branch = *self.waiting.last()?;
        self.waiting.truncate(self.waiting.len() - 1);
        Some(())
    }

    /// Which branches become one, if any do.
    #[inline]
    pub(super) fn joins(&self) -> Option<Joining> {
        if W::JOINS { self.joining } else { None }
    }

    /// Puts in place of a branch the one of the shortest path, with all that run together with it, of those that
    /// have met the fewest surfaces. From surface to surface all fields together keep their power, and only together:
    /// what some of them add to others that wait may be more than they had.
    #[cold]
    fn take_joined(&mut self, branch: &mut Branch<N>, joining: Joining) -> Option<()> {
        loop {
            if self.in_turn == 0 || self.waiting.is_empty() {
                self.in_turn = self.waiting.len();
            }
            let paths = self.waiting[..self.in_turn].iter().map(|branch| branch.optical_path);
            let (shortest, _) = paths.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
            *branch = self.take_in_turn(shortest);
            let mut number = 0;
            while number < self.in_turn {
                if joining.join(self.assembly, branch, &self.waiting[number]) {
                    self.take_in_turn(number);
                } else {
                    number += 1;
                }
            }
            // Their fields may have cancelled.
            if self.follows(branch.power) {
                return Some(());
            }
        }
    }

    /// Takes away one of those whose turn it is.
    fn take_in_turn(&mut self, number: usize) -> Branch<N> {
        self.in_turn -= 1;
        self.waiting.swap(number, self.in_turn);
        self.waiting.swap_remove(self.in_turn)
    }

    /// Whether what a pulse takes on a way of that optical path is asked for, by itself or as the
    /// time of flight.
    #[inline]
    pub(super) fn wants_group_path(&self, optical_path: f64) -> bool {
        self.group_delays || optical_path < 0.0
    }

    /// Takes from a branch what an absorbing medium keeps of it, given ∫ Im n ds along the way, cm;
    /// whether what is left is to be followed, for else it is pruned.
    pub(super) fn extinguish(&mut self, branch: &mut Branch<N>, extinction: f64) -> bool {
        // Power never grows along a ray: rounding must not have it so.
        let depth = (self.assembly.vacuum_wave_number * extinction).max(0.0);
        let (amplitude, kept) = ((-depth).exp(), (-2.0 * depth).exp());
        for (i, power) in branch.power.iter_mut().enumerate() {
            let left = *power * kept;
            self.outcome.absorbed[i] += *power - left;
            *power = left;
            branch.electric[i] = branch.electric[i] * amplitude;
        }
        branch.update_survival(self.limits.min_power);
        self.follows(branch.power)
    }

    /// Counts power as pruned that an interface has left in waves too weak to follow, and as lost
    /// what it could not hand on: the account must not leak, even where numbers fail. In media that
    /// absorb, waves carry together what none of them carries alone, of either sign: that counts as
    /// absorbed where they part.
    pub(super) fn check_account(
        &mut self,
        branch: &Branch<N>,
        waves: &mut OutgoingWaves<N>,
        weak: [f64; N],
        absorbing: bool,
    ) {
        let rest: [f64; N] = std::array::from_fn(|i| {
            branch.power[i] - waves.iter().map(|wave| wave.power[i]).sum::<f64>() - weak[i]
        });
        if rest.iter().any(|rest| !rest.is_finite()) {
            waves.clear();
            self.lose(branch.power);
            return;
        }
        let mut lost = false;
        for (i, power) in branch.power.iter().enumerate() {
            self.outcome.pruned[i] += weak[i];
            if absorbing {
                self.outcome.absorbed[i] += rest[i];
                continue;
            }
            if rest[i].abs() > LEAK * power && !self.is_rounding(rest[i]) {
                self.outcome.pruned[i] += rest[i];
                lost = true;
            }
        }
        self.outcome.stats.lost += u64::from(lost);
    }

    /// Whether a rest of power is that of a polarization that has died, as that may which does not
    /// see what keeps the other caught, or of fields that have cancelled where branches were joined:
    /// they have few digits.
    #[cold]
    fn is_rounding(&self, rest: f64) -> bool {
        rest.abs() <= NO_POWER || self.joins().is_some() && rest.abs() <= LEAK * CANCELLED
    }

    /// Whether a branch of that power is followed; else it is pruned, and need not be made.
    pub(super) fn follows(&mut self, power: [f64; N]) -> bool {
        let follows = largest(&power) >= self.limits.min_power;
        if !follows {
            self.prune(power);
        }
        follows
    }

    /// Keeps a branch for later if it is to be followed.
    pub(super) fn await_turn(&mut self, mut branch: Branch<N>) {
        if self.follows(branch.power) {
            branch.update_survival(self.limits.min_power);
            self.waiting.push(branch);
        }
    }

    /// Gives up a branch that cannot be followed: it does not go on.
    pub(super) fn lose(&mut self, power: [f64; N]) -> bool {
        self.outcome.stats.lost += 1;
        self.prune(power);
        false
    }

    /// Cuts a branch that has no end: it does not go on.
    pub(super) fn cut(&mut self, power: [f64; N]) -> bool {
        self.outcome.stats.endless += 1;
        self.prune(power);
        false
    }

    pub(super) fn prune(&mut self, power: [f64; N]) {
        for (sum, power) in self.outcome.pruned.iter_mut().zip(power) {
            *sum += power;
        }
    }
}
