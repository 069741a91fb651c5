//! The ways that the rays of a patch take, and where they part.

use super::grid::bits;
use super::smooth::Smooth;
use crate::trace::{Branch, LAUNCHED, Leaf, PathRecorder, PathSegment};
use arrayvec::ArrayVec;
use std::sync::Arc;

/// A branch that goes on from a border, of one ray.
#[derive(Clone, Copy, Debug)]
struct Step {
    to: u64,
    from: u64,
    power: f64,
    ray: usize,
    /// Whether the ray has it, and not only would, did it meet another face.
    is_real: bool,
}

/// A branch, by its fingerprint, that comes to a face, of one ray.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    path: u64,
    face: u16,
    ray: usize,
}

/// Whether a face is among some, given as bits by their numbers.
#[inline]
fn has_face(faces: u64, face: u16) -> bool {
    faces.checked_shr(face.into()).is_some_and(|faces| faces & 1 == 1)
}

/// The faces between which rays choose at the end of a branch, as bits by their numbers: of each of them it
/// is known for all rays what comes of it. None, where they do not choose.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choice {
    pub faces: u64,
    /// Those at which rays part nevertheless.
    pub parting: u64,
}

impl Choice {
    pub fn is_made(self) -> bool {
        self.faces != 0
    }

    /// Whether what comes of a face is known.
    pub fn has(self, face: u16) -> bool {
        has_face(self.faces, face)
    }

    /// Whether all is known of what comes of a face.
    pub fn knows(self, face: u16) -> bool {
        self.has(face) && !self.parts_at(face)
    }

    /// Whether rays that come to a face are to be traced from there on, though it is one of these.
    pub fn parts_at(self, face: u16) -> bool {
        has_face(self.parting, face)
    }

    /// With what a part of the patch says, in which rays have come to the `found` faces.
    fn and(self, part: Self, found: u64) -> Self {
        match part.is_made() {
            true => Self {
                faces: self.faces | part.faces,
                parting: self.parting & !found | part.parting & found,
            },
            false => Self { parting: self.parting | found & self.faces, ..self },
        }
    }
}

/// The faces to which branches come, each by all rays that have it.
#[derive(Clone, Debug, Default)]
pub(super) struct Faces {
    /// Of each branch, by its fingerprint, the faces as bits by their numbers.
    met: Vec<(u64, u64)>,
    /// Those that lead on.
    leading: Vec<(u64, u64)>,
    /// Of each branch and ray, the one that the ray meets.
    of_rays: Vec<(u64, usize, u16)>,
    /// The branches that come of them.
    known: Vec<u64>,
    first_surfaces: Surfaces,
}

impl Faces {
    /// Those to which rays come at the end of a branch, as bits by their numbers.
    pub fn of(&self, path: u64) -> u64 {
        among(&self.met, path)
    }

    /// Whether rays come to several at the end of any branch.
    pub fn are_several(&self) -> bool {
        self.met.iter().any(|(_, faces)| faces.count_ones() > 1)
    }

    /// Those that lead on and are not met by a ray.
    pub fn beside(&self, path: u64, ray: usize) -> u64 {
        let leading = among(&self.leading, path);
        if leading == 0 {
            return 0;
        }
        let key = |(path, ray, _): &(u64, usize, u16)| (*path, *ray);
        let own = self.of_rays.binary_search_by_key(&(path, ray), key);
        leading & !own.map_or(0, |place| 1 << self.of_rays[place].2)
    }
}

/// What is known of a branch, given by its fingerprint, among others that are in order.
fn among(faces: &[(u64, u64)], path: u64) -> u64 {
    let found = faces.binary_search_by_key(&path, |(path, _)| *path);
    found.map_or(0, |place| faces[place].1)
}

/// Tells whether branches go on from planes alone. What is curved or graded makes more of an
/// error with which a branch comes, each time that it is passed.
#[derive(Clone, Copy, Debug, Default)]
struct Planes {
    /// The branch that has come to one last.
    arrived: u64,
    are_left: bool,
}

impl Planes {
    #[inline]
    fn meet(&mut self, path: u64, is_plane: impl FnOnce() -> bool) {
        if path != LAUNCHED && is_plane() {
            self.arrived = path;
        }
    }

    #[inline]
    fn go_on_from(&mut self, path: u64) {
        self.are_left |= path != LAUNCHED && path != self.arrived;
    }
}

/// Notes where the branches of a ray go on, and those that may be followed from further on.
#[derive(Clone, Debug)]
pub(super) struct Trail<const N: usize> {
    steps: Vec<Step>,
    branches: Vec<Branch<N>>,
    arrivals: Vec<Arrival>,
    planes: Planes,
    /// What is not looked at.
    pub left_out: LeftOut,
    /// The faces to which a ray is taken, where it does not meet them, and its number.
    pub beside: Option<(Arc<Faces>, usize)>,
    /// How many branches it has come to, those that are not followed among them.
    pub looked_at: usize,
    /// It is taken no further after so many.
    pub most_looked_at: usize,
}

/// The surfaces that rays meet first: each a device and its surface; `None` past all devices. Where
/// there are several they are the faces to which the launched ray comes, by their places here.
pub(super) type Surfaces = ArrayVec<Option<(u16, u16)>, 8>;

impl<const N: usize> Default for Trail<N> {
    fn default() -> Self {
        Self {
            steps: Vec::new(),
            branches: Vec::new(),
            arrivals: Vec::new(),
            planes: Planes::default(),
            left_out: LeftOut::default(),
            beside: None,
            looked_at: 0,
            most_looked_at: usize::MAX,
        }
    }
}

impl<const N: usize> Trail<N> {
    /// Whether the ray was to be taken further than it was.
    pub fn is_too_long(&self) -> bool {
        self.looked_at >= self.most_looked_at
    }

    pub fn clear(&mut self) {
        self.steps.clear();
        self.branches.clear();
        self.arrivals.clear();
        self.planes = Planes::default();
        self.looked_at = 0;
    }
}

impl<const N: usize> PathRecorder<N> for Trail<N> {
    const CUTS_KEPT_LIGHT: bool = true;

    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    #[inline]
    fn begins(&mut self, branch: &Branch<N>) {
        if branch.is_movable() {
            self.branches.push(*branch);
        }
    }

    fn arrives(&mut self, path: u64, face: u16) {
        self.planes.arrived = path;
        // A ray that starts in a medium goes on from there.
        if path != LAUNCHED {
            self.arrivals.push(Arrival { path, face, ray: 0 });
        }
    }

    #[inline]
    fn meets(&mut self, path: u64, is_plane: impl FnOnce() -> bool) {
        self.planes.meet(path, is_plane);
    }

    #[inline]
    fn planes(&self, path: u64) -> Option<u64> {
        self.beside.as_ref().map(|(faces, ray)| faces.beside(path, *ray))
    }

    fn first_surface(&self, number: u16) -> Option<(u16, u16)> {
        let (faces, _) = self.beside.as_ref()?;
        faces.first_surfaces.get(usize::from(number)).copied().flatten()
    }

    fn went_on(&mut self, from: u64, to: u64, power: f64) -> bool {
        self.looked_at += 1;
        if let Some((faces, _)) = &self.beside
            && (faces.known.binary_search(&to).is_err() || self.is_too_long())
        {
            return false;
        }
        self.planes.go_on_from(from);
        self.steps.push(Step { to, from, power, ray: 0, is_real: self.beside.is_none() });
        !self.left_out.has(to)
    }
}

/// A beginning of a way: a branch, from where it starts to the border where it ends.
#[derive(Clone, Copy, Debug)]
struct Beginning {
    path: u64,
    /// That of the branch before; for one with which the rays start, itself.
    from: u64,
    /// The rays that have it, as bits.
    rays: u64,
    /// Those, and the ones that would have it if they met other faces.
    all_rays: u64,
    /// Whether all rays of the patch have it, or would.
    shared: bool,
    /// Whether rays part at its end.
    parts: bool,
    /// The faces between which rays choose there.
    choice: Choice,
    /// The face of the branch before from which it comes.
    from_face: Option<u16>,
}

/// A branch with which rays start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub path: u64,
    /// The rays that have been followed from there, as bits.
    pub rays: u64,
    /// The faces between which rays are known to choose at its end.
    pub faces: u64,
}

/// What larger patches know of what is before a branch with which rays start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin {
    pub path: u64,
    met: Option<u64>,
    /// The last branch before at whose end rays choose between faces, and the face that leads on.
    pub given: Option<(u64, u16)>,
}

impl Origin {
    pub fn of<const N: usize>(branch: &Smooth<Branch<N>>) -> Self {
        Self { path: branch.first.path, met: branch.met, given: branch.given }
    }
}

/// That of a branch among others in order.
pub(super) fn origin(origins: &[Origin], path: u64) -> Option<&Origin> {
    let found = origins.binary_search_by_key(&path, |origin| origin.path);
    found.ok().map(|place| &origins[place])
}

/// The tree of all ways that the rays of a patch take.
#[derive(Debug)]
pub(super) struct Ways<const N: usize> {
    steps: Vec<Step>,
    /// How many branches have been looked at.
    looked_at: usize,
    /// How many of them samples would have.
    of_samples: usize,
    beginnings: Vec<Beginning>,
    /// Each branch after the one before, in order, by their fingerprints.
    after: Vec<(u64, u64)>,
    /// The branches that may be followed from further on, each of one ray.
    branches: Vec<(usize, Branch<N>)>,
    /// The faces that are met, by rays and by those that are taken to others.
    arrivals: [Vec<Arrival>; 2],
    /// Whether rays go on from something else than planes.
    pub leave_planes: bool,
    /// How many rays there are.
    rays: usize,
}

impl<const N: usize> Default for Ways<N> {
    fn default() -> Self {
        Self {
            steps: Vec::new(),
            looked_at: 0,
            of_samples: 0,
            beginnings: Vec::new(),
            after: Vec::new(),
            branches: Vec::new(),
            arrivals: [Vec::new(), Vec::new()],
            leave_planes: false,
            rays: 0,
        }
    }
}

impl<const N: usize> Ways<N> {
    pub fn clear(&mut self) {
        self.steps.clear();
        self.looked_at = 0;
        self.of_samples = 0;
        self.beginnings.clear();
        self.after.clear();
        self.branches.clear();
        self.arrivals.iter_mut().for_each(Vec::clear);
        self.leave_planes = false;
    }

    /// Takes in what a ray has noted, of which samples have what is of at least that power.
    pub fn add(&mut self, ray: usize, trail: &mut Trail<N>, least_power: f64) {
        self.leave_planes |= trail.planes.are_left;
        let arrivals = &mut self.arrivals[usize::from(trail.beside.is_some())];
        arrivals.extend(trail.arrivals.drain(..).map(|arrival| Arrival { ray, ..arrival }));
        self.looked_at += std::mem::take(&mut trail.looked_at);
        let of_samples = |step: &&Step| step.is_real && step.power >= least_power;
        self.of_samples += trail.steps.iter().filter(of_samples).count();
        self.steps.extend(trail.steps.drain(..).map(|step| Step { ray, ..step }));
        self.branches.extend(trail.branches.drain(..).map(|branch| (ray, branch)));
    }

    /// Takes in which of several surfaces a launched ray meets.
    pub fn launch(&mut self, ray: usize, surface: u16) {
        let arrival = Arrival { path: LAUNCHED, face: surface, ray };
        self.arrivals.iter_mut().for_each(|arrivals| arrivals.push(arrival));
    }

    /// How many branches are known, of all rays together.
    pub fn steps(&self) -> usize {
        self.steps.len()
    }

    /// How many have been looked at, those that are not followed among them.
    pub fn looked_at(&self) -> usize {
        self.looked_at
    }

    /// How many of them samples would have that meet the same.
    pub fn of_samples(&self) -> usize {
        self.of_samples
    }

    /// How much is known.
    pub fn known(&self) -> [usize; 3] {
        [self.steps.len(), self.branches.len(), self.arrivals[1].len()]
    }

    /// Forgets what has been added since so much was known.
    pub fn forget_since(&mut self, [steps, branches, arrivals]: [usize; 3]) {
        self.steps.truncate(steps);
        self.branches.truncate(branches);
        self.arrivals[1].truncate(arrivals);
    }

    /// The faces to which branches come of the rays that have been added, and what comes of them of at least that
    /// power.
    pub fn faces(&mut self, first_surfaces: &Surfaces, least_power: f64) -> Option<Faces> {
        let mut of_rays: Vec<(u64, usize, u16)> = self.arrivals[0]
            .iter()
            .map(|Arrival { path, face, ray }| (*path, *ray, *face))
            .collect();
        of_rays.sort_unstable();
        let mut met: Vec<(u64, u64)> = Vec::new();
        for same in of_rays.chunk_by(|(one, ..), (other, ..)| one == other) {
            // Of a branch that crosses seams there is more than one of a ray.
            let is_once = same.windows(2).all(|two| two[0].1 != two[1].1);
            if is_once && same.iter().all(|(.., face)| u32::from(*face) < u64::BITS) {
                met.push((same[0].0, bits(same.iter().map(|(.., face)| usize::from(*face)))));
            }
        }
        if met.is_empty() {
            return None;
        }
        self.steps.sort_unstable_by_key(|step| step.to);
        let (mut known, mut leading) = (Vec::new(), Vec::new());
        for same in self.steps.chunk_by(|one, other| one.to == other.to) {
            if same.iter().any(|step| step.power >= least_power) {
                let Step { to, from, ray, .. } = same[0];
                known.push(to);
                let key = |(path, ray, _): &(u64, usize, u16)| (*path, *ray);
                if let Ok(place) = of_rays.binary_search_by_key(&(from, ray), key)
                    && among(&met, from) != 0
                {
                    leading.push((from, 1 << of_rays[place].2));
                }
            }
        }
        if let Some(place) = first_surfaces.iter().position(Option::is_none) {
            // Past all devices there is a leaf.
            leading.push((LAUNCHED, 1 << place & among(&met, LAUNCHED)));
        }
        leading.sort_unstable();
        leading.dedup_by(|later, first| {
            let same = later.0 == first.0;
            if same {
                first.1 |= later.1;
            }
            same
        });
        Some(Faces { met, leading, of_rays, known, first_surfaces: first_surfaces.clone() })
    }

    /// The branches of a ray that come to a face where others come to other ones; only so much is looked at
    /// as was [`known`](Self::known) then.
    pub fn with_others_beside(
        &self,
        faces: &Faces,
        [_, known, _]: [usize; 3],
        ray: usize,
        found: &mut Vec<Branch<N>>,
    ) {
        let known = &self.branches[..known];
        let first = known.partition_point(|(of, _)| *of < ray);
        let own = known[first..].iter().take_while(|(of, _)| *of == ray).map(|(_, branch)| branch);
        found.extend(own.filter(|branch| faces.beside(branch.path, ray) != 0));
    }

    /// Puts the tree together, of so many rays, which have been followed from the starts on. Where
    /// it is not the same for all of them, rays part, but for branches below `least_power` in all.
    pub fn gather(
        &mut self,
        rays: usize,
        starts: impl Iterator<Item = Start>,
        faces: Option<&Faces>,
        least_power: f64,
    ) {
        self.rays = rays;
        let all = bits(0..rays);
        let beginning = |path: u64, from: u64, [rays, all_rays]: [u64; 2], faces: u64| Beginning {
            path,
            from,
            rays,
            all_rays,
            shared: all_rays == all,
            parts: false,
            choice: Choice { faces, parting: 0 },
            from_face: None,
        };
        self.steps.sort_unstable_by_key(|step| step.to);
        for same in self.steps.chunk_by(|one, other| one.to == other.to) {
            let power = same.iter().map(|step| step.power).fold(0.0, f64::max);
            if power >= least_power {
                let real = bits(same.iter().filter(|step| step.is_real).map(|step| step.ray));
                let rays = [real, bits(same.iter().map(|step| step.ray))];
                self.beginnings.push(beginning(same[0].to, same[0].from, rays, 0));
            }
        }
        // Rays may come to what they also start with.
        let found = self.beginnings.len();
        for Start { path, rays, faces } in starts {
            // The steps are in order.
            match self.beginnings[..found].binary_search_by_key(&path, |known| known.path) {
                Ok(number) => self.beginnings[number].choice.faces = faces,
                Err(_) => self.beginnings.push(beginning(path, path, [rays, all], faces)),
            }
        }
        self.beginnings.sort_unstable_by_key(|beginning| beginning.path);
        let others = self.beginnings.iter().filter(|beginning| beginning.from != beginning.path);
        self.after.extend(others.map(|beginning| (beginning.from, beginning.path)));
        self.after.sort_unstable();
        self.choose(faces);
        for number in 0..self.beginnings.len() {
            if !self.beginnings[number].shared {
                self.part_before_that(number);
            }
        }
    }

    /// Finds the branches at whose ends what comes of each face is known for all rays.
    fn choose(&mut self, faces: Option<&Faces>) {
        let [real, beside] = &mut self.arrivals;
        beside.sort_unstable_by_key(|arrival| arrival.path);
        for same in beside.chunk_by(|one, other| one.path == other.path) {
            let known = faces.map_or(0, |faces| faces.of(same[0].path));
            let is_met = |arrival: &Arrival| has_face(known, arrival.face);
            // Where all come to one anyway there is nothing to choose.
            let is_one = known.count_ones() < 2 && same.iter().all(is_met);
            let key = |beginning: &Beginning| beginning.path;
            if let Ok(number) = self.beginnings.binary_search_by_key(&same[0].path, key)
                && (!is_one || self.beginnings[number].choice.is_made())
            {
                self.beginnings[number].choice.faces |= known;
            }
        }
        // Each branch comes from one face. Of a ray that runs right into an edge it may be said to be the one, and taken
        // to be the other.
        real.sort_unstable_by_key(|arrival| (arrival.path, arrival.ray));
        let mut unsure = Vec::new();
        for beginning in &mut self.beginnings {
            let first = real.partition_point(|arrival| arrival.path < beginning.from);
            let of_path = real[first..].iter().take_while(|arrival| arrival.path == beginning.from);
            let mut own = of_path.filter(|arrival| beginning.rays >> arrival.ray & 1 == 1);
            beginning.from_face = own.next().map(|arrival| arrival.face);
            if own.any(|arrival| Some(arrival.face) != beginning.from_face) {
                unsure.push(beginning.from);
            }
        }
        for path in unsure {
            if self.choice(path).is_made() {
                self.part_at(path);
            }
        }
    }

    /// Notes that rays part at the end of a branch.
    pub fn part_at(&mut self, path: u64) {
        if let Some(number) = self.find(path) {
            self.beginnings[number].parts = true;
            self.choose_no_more(path);
        }
    }

    /// Notes that a branch is not shared: it is to be followed from the end of the one before.
    pub fn part_before(&mut self, path: u64) {
        if let Some(number) = self.find(path) {
            self.beginnings[number].shared = false;
            self.choose_no_more(path);
            self.part_before_that(number);
        }
    }

    fn part_before_that(&mut self, number: usize) {
        let Beginning { from, from_face, .. } = self.beginnings[number];
        let Some(number) = self.find(from) else { return };
        let before = &mut self.beginnings[number];
        match from_face {
            Some(face) if before.choice.has(face) => {
                before.parts = true;
                before.choice.parting |= 1 << face;
            }
            _ => self.part_at(from),
        }
    }

    /// Lets rays be traced that meet other faces at the end of a branch.
    fn choose_no_more(&mut self, path: u64) {
        let Some(number) = self.find(path) else { return };
        if !std::mem::take(&mut self.beginnings[number].choice).is_made() {
            return;
        }
        for path in self.coming_of(path) {
            let Some(number) = self.find(path) else { continue };
            let beginning = &mut self.beginnings[number];
            if beginning.rays != beginning.all_rays {
                (beginning.shared, beginning.choice) = (false, Choice::default());
                self.part_before_that(number);
            }
        }
    }

    /// The branches that come of one.
    fn coming_of(&self, path: u64) -> Vec<u64> {
        let (mut found, mut next) = (Vec::new(), Some(path));
        let mut looked_at = 0;
        while let Some(from) = next {
            let first = self.after.partition_point(|(before, _)| *before < from);
            let after = self.after[first..].iter().take_while(|(before, _)| *before == from);
            found.extend(after.map(|(_, path)| *path));
            next = found.get(looked_at).copied();
            looked_at += 1;
        }
        found
    }

    /// The faces between which rays choose at the end of a branch.
    pub fn choice(&self, path: u64) -> Choice {
        self.find(path).map_or(Choice::default(), |number| self.beginnings[number].choice)
    }

    /// The same, given what is known of a larger patch.
    pub fn choice_in_part(&self, path: u64, known: Choice, faces: Option<&Faces>) -> Choice {
        let own = self.choice(path);
        let found = faces.map_or(0, |faces| faces.of(path));
        if known.is_made() { known.and(own, found) } else { own }
    }

    /// The last branch on the way to another at whose end rays choose, with the face that leads on;
    /// else the one with which they start.
    pub fn chosen_on_the_way(&self, mut path: u64) -> Result<(u64, u16), u64> {
        while let Some(number) = self.find(path) {
            let Beginning { from, from_face, .. } = self.beginnings[number];
            if from == path {
                break;
            }
            if let (true, Some(face)) = (self.choice(from).is_made(), from_face) {
                return Ok((from, face));
            }
            path = from;
        }
        Err(path)
    }

    /// How many branches come before one.
    pub fn depth(&self, mut path: u64) -> usize {
        let mut depth = 0;
        while let Some(number) = self.find(path)
            && self.beginnings[number].from != path
        {
            path = self.beginnings[number].from;
            depth += 1;
        }
        depth
    }

    /// Drops what larger patches know and not all rays come to: that alone holds on.
    pub fn drop_lost(
        &mut self,
        leaves: &mut Vec<Smooth<Leaf<N>>>,
        branches: &mut Vec<Smooth<Branch<N>>>,
    ) {
        let is_lost = |ways: &Self, met: Option<u64>| met.is_some_and(|path| !ways.has(path));
        loop {
            let lost = branches.extract_if(.., |branch| is_lost(self, branch.met));
            let lost: Vec<u64> = lost.map(|branch| branch.first.path).collect();
            if lost.is_empty() {
                break;
            }
            self.forget(&lost);
        }
        leaves.retain(|leaf| !is_lost(self, leaf.met));
    }

    /// Forgets starts that not all rays come to, with all that comes of them.
    fn forget(&mut self, starts: &[u64]) {
        let mut forgotten: Vec<u64> = starts.to_vec();
        starts.iter().for_each(|start| forgotten.extend(self.coming_of(*start)));
        forgotten.sort_unstable();
        self.beginnings.retain(|beginning| forgotten.binary_search(&beginning.path).is_err());
    }

    fn find(&self, path: u64) -> Option<usize> {
        self.beginnings.binary_search_by_key(&path, |beginning| beginning.path).ok()
    }

    /// Whether all rays of the patch have a branch.
    pub fn has(&self, path: u64) -> bool {
        self.find(path).is_some_and(|number| self.beginnings[number].shared)
    }

    /// Whether rays part at the end of a branch.
    pub fn parts(&self, path: u64) -> bool {
        self.find(path).is_some_and(|number| self.beginnings[number].parts)
    }

    /// The branches at whose ends rays part or choose, that all rays have.
    pub fn parting(&self) -> impl Iterator<Item = u64> {
        let parts = |beginning: &&Beginning| beginning.parts || beginning.choice.is_made();
        let parting = self.beginnings.iter().filter(|beginning| beginning.shared).filter(parts);
        parting.map(|beginning| beginning.path)
    }

    /// Those branches that may be followed from further on, of all rays, way by way: of each as
    /// many as there are.
    pub fn movable(&self, paths: &[u64]) -> Vec<(u64, usize, &Branch<N>)> {
        let is_wanted =
            |(_, branch): &&(usize, Branch<N>)| paths.binary_search(&branch.path).is_ok();
        let wanted = self.branches.iter().filter(is_wanted);
        let mut found: Vec<_> = wanted.map(|(ray, branch)| (branch.path, *ray, branch)).collect();
        // Of a branch that crosses seams, the first.
        found.sort_by_key(|(path, ray, _)| (*path, *ray));
        found.dedup_by_key(|(path, ray, _)| (*path, *ray));
        found
    }

    /// How many borders a ray meets in the mean.
    pub fn borders(&self) -> f64 {
        let met: u32 = self.beginnings.iter().map(|beginning| beginning.rays.count_ones()).sum();
        f64::from(met) / self.rays as f64
    }

    /// The same where it is to be traced.
    pub fn borders_to_trace(&self) -> f64 {
        let met = |beginning: &Beginning| {
            let Beginning { path, rays, shared, parts, choice, .. } = *beginning;
            if shared && choice.is_made() {
                let own = self.arrivals[0].iter().filter(|arrival| arrival.path == path);
                own.filter(|arrival| choice.parts_at(arrival.face)).count()
            } else if parts || !shared {
                rays.count_ones() as usize
            } else {
                0
            }
        };
        self.beginnings.iter().map(met).sum::<usize>() as f64 / self.rays as f64
    }

    /// For each branch that some rays have and others have not, those that have it.
    pub fn some_have(&self) -> impl Iterator<Item = u64> {
        let some = self.beginnings.iter().map(|beginning| beginning.all_rays);
        some.filter(|rays| rays.count_ones() as usize != self.rays)
    }

    /// Whether a branch is met where rays are traced, and left out there.
    fn is_met(&self, beginning: &Beginning) -> bool {
        let is_traced = |before: &Beginning| {
            let parts = |face: u16| !before.choice.is_made() || before.choice.parts_at(face);
            !before.shared || before.parts && beginning.from_face.is_none_or(parts)
        };
        beginning.shared
            && beginning.from != beginning.path
            && self.find(beginning.from).is_some_and(|number| is_traced(&self.beginnings[number]))
    }

    /// The last branch on the way to another, or that itself, that is met where rays are traced;
    /// else the one with which they start.
    fn met_on_the_way(&self, mut path: u64) -> Result<u64, u64> {
        while let Some(number) = self.find(path) {
            let beginning = self.beginnings[number];
            if self.is_met(&beginning) {
                return Ok(path);
            }
            if beginning.from == path {
                break;
            }
            path = beginning.from;
        }
        Err(path)
    }

    /// The same where larger patches know what is before the starts.
    pub fn met_before(&self, mut path: u64, starts: &[Origin]) -> Option<u64> {
        loop {
            match self.met_on_the_way(path) {
                Ok(met) => return Some(met),
                Err(start) => {
                    let met = origin(starts, start)?.met?;
                    if met == path {
                        // No ray of the patch comes there.
                        return Some(met);
                    }
                    path = met;
                }
            }
        }
    }

    /// All that are.
    pub fn met(&self) -> impl Iterator<Item = u64> {
        let met = self.beginnings.iter().filter(|beginning| self.is_met(beginning));
        met.map(|beginning| beginning.path)
    }
}

/// Leaves out the branches that all rays of a patch have.
#[derive(Clone, Debug)]
pub(super) struct LeftOut {
    /// Their fingerprints, each at the place that its bits say or after it, and whether the ray has
    /// met it; a power of two of places.
    table: Vec<(u64, bool)>,
    planes: Planes,
}

/// A place in the table without fingerprint.
const FREE: u64 = 0;

impl Default for LeftOut {
    fn default() -> Self {
        Self::new(std::iter::empty())
    }
}

impl LeftOut {
    pub fn new(paths: impl Iterator<Item = u64>) -> Self {
        let paths: Vec<u64> = paths.filter(|path| *path != FREE).collect();
        let places = (2 * paths.len() + 1).next_power_of_two();
        let mut left_out = Self { table: vec![(FREE, false); places], planes: Planes::default() };
        for path in paths {
            let place = left_out.place(path);
            left_out.table[place].0 = path;
        }
        left_out
    }

    /// Where a fingerprint is in the table, or would be.
    #[inline]
    pub fn place(&self, path: u64) -> usize {
        let last = self.table.len() - 1;
        let mut place = (path ^ path >> 32) as usize & last;
        while self.table[place].0 != FREE && self.table[place].0 != path {
            place = (place + 1) & last;
        }
        place
    }

    /// Whether a fingerprint is in the table.
    #[inline]
    pub fn has(&self, path: u64) -> bool {
        self.table[self.place(path)].0 != FREE
    }

    /// Whether the ray has met the branch at a place of the table.
    #[inline]
    pub fn has_met(&self, place: usize) -> bool {
        self.table[place].1
    }

    /// Whether the ray has gone on from something else than planes.
    #[inline]
    pub fn has_left_planes(&self) -> bool {
        self.planes.are_left
    }

    /// Begins with another ray.
    #[inline]
    pub fn begin(&mut self) {
        self.planes = Planes::default();
        self.table.iter_mut().for_each(|(_, met)| *met = false);
    }
}

impl<const N: usize> PathRecorder<N> for LeftOut {
    const CUTS_KEPT_LIGHT: bool = true;

    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    #[inline]
    fn arrives(&mut self, path: u64, _: u16) {
        self.planes.arrived = path;
    }

    #[inline]
    fn meets(&mut self, path: u64, is_plane: impl FnOnce() -> bool) {
        self.planes.meet(path, is_plane);
    }

    #[inline]
    fn went_on(&mut self, from: u64, to: u64, _: f64) -> bool {
        self.planes.go_on_from(from);
        let place = self.place(to);
        let (found, met) = &mut self.table[place];
        let is_there = *found != FREE;
        *met |= is_there;
        !is_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn went_on(ways: &mut Ways<1>, ray: usize, steps: &[(u64, u64, f64)]) {
        let mut trail = Trail::default();
        for &(from, to, power) in steps {
            trail.went_on(from, to, power);
        }
        ways.add(ray, &mut trail, 0.0);
    }

    /// Two rays that go 1, then 2 or 3, and 1, 4, 5 and 6; 12 and 13 are weak.
    fn two_rays() -> Ways<1> {
        let mut ways = Ways::default();
        let same = [(LAUNCHED, 1, 1.0), (1, 4, 0.2), (4, 5, 0.1), (5, 6, 0.1)];
        for (ray, other) in [(0, 2), (1, 3)] {
            went_on(&mut ways, ray, &same);
            went_on(&mut ways, ray, &[(1, other, 0.5), (other, 10 + other, 1e-5)]);
        }
        let start = Start { path: LAUNCHED, rays: 3, faces: 0 };
        ways.gather(2, [start].into_iter(), None, 1e-4);
        ways
    }

    #[test]
    fn rays_part_at_the_end_of_the_branch_before() {
        let mut ways = two_rays();
        assert_eq!(ways.some_have().collect::<Vec<_>>(), [1 << 0, 1 << 1]);
        assert_eq!(ways.parting().collect::<Vec<_>>(), [1]);
        assert!([LAUNCHED, 1, 4, 5, 6].iter().all(|path| ways.has(*path)));
        assert!([2, 3, 12, 13].iter().all(|path| !ways.has(*path)));
        // Traced from 1 on, rays meet 4, and 2 or 3, which are traced, too.
        assert_eq!(ways.met().collect::<Vec<_>>(), [4]);
        assert_eq!([1, 4, 6].map(|path| ways.met_on_the_way(path)), [Err(LAUNCHED), Ok(4), Ok(4)]);
        assert_eq!((ways.borders(), ways.borders_to_trace()), (6.0, 2.0));
        // If 5 is to be traced from 4 on, so is all but the root and 6.
        ways.part_before(5);
        assert_eq!(ways.parting().collect::<Vec<_>>(), [1, 4]);
        assert_eq!(ways.met().collect::<Vec<_>>(), [4, 6]);
        assert_eq!(ways.borders_to_trace(), 4.0);
    }

    /// Two rays that go 1, and from there to 2 by face 4 or to 3 by face 5; each is taken to the other's.
    #[test]
    fn rays_choose_between_faces_of_which_all_is_known() {
        let mut ways = Ways::<1>::default();
        let own = [(4, 2), (5, 3)];
        for (ray, (face, to)) in own.into_iter().enumerate() {
            let mut trail = Trail::default();
            trail.went_on(LAUNCHED, 1, 1.0);
            trail.arrives(1, face);
            trail.went_on(1, to, 0.5);
            ways.add(ray, &mut trail, 0.0);
        }
        let faces = Arc::new(ways.faces(&Surfaces::new(), 1e-4).expect("faces"));
        assert!(faces.are_several());
        assert_eq!((faces.of(1), faces.of(2)), (0b11_0000, 0));
        assert_eq!([0, 1].map(|ray| faces.beside(1, ray)), [1 << 5, 1 << 4]);
        for (ray, (face, to)) in [(4, 3), (5, 2)].into_iter().enumerate() {
            let mut trail = Trail { beside: Some((Arc::clone(&faces), ray)), ..Trail::default() };
            trail.arrives(1, face);
            assert!(trail.went_on(1, to, 0.5) && !trail.went_on(1, 9, 0.5), "9 is not known");
            ways.add(ray, &mut trail, 0.0);
        }
        let start = Start { path: LAUNCHED, rays: 3, faces: 0 };
        ways.gather(2, [start].into_iter(), Some(&faces), 1e-4);
        assert_eq!((ways.choice(1).faces, ways.choice(1).parting), (0b11_0000, 0));
        assert!([LAUNCHED, 1, 2, 3].iter().all(|path| ways.has(*path)));
        assert_eq!([2, 3].map(|path| ways.chosen_on_the_way(path)), [Ok((1, 4)), Ok((1, 5))]);
        assert_eq!((ways.parting().collect::<Vec<_>>(), ways.met().count()), (vec![1], 0));
        assert_eq!((ways.borders(), ways.borders_to_trace()), (3.0, 0.0));
        // Where 3 is no function, rays that meet its face are traced from 1 on, and through 3.
        ways.part_before(3);
        assert!(ways.choice(1).parts_at(5) && !ways.choice(1).parts_at(4));
        assert_eq!((ways.has(2), ways.borders_to_trace()), (true, 1.0));
        // Where they part at 1 itself, it is what each has for itself that counts.
        ways.part_at(1);
        assert!(!ways.choice(1).is_made() && !ways.has(2) && ways.has(1));
    }

    #[test]
    fn what_comes_of_a_start_is_forgotten_with_it() {
        let mut ways = Ways::<1>::default();
        went_on(&mut ways, 0, &[(7, 8, 0.1), (8, 9, 0.1), (LAUNCHED, 1, 1.0)]);
        let starts = [LAUNCHED, 7].map(|path| Start { path, rays: 1, faces: 0 });
        ways.gather(1, starts.into_iter(), None, 1e-4);
        assert_eq!(ways.met_on_the_way(9), Err(7));
        ways.forget(&[7]);
        assert!([7, 8, 9].iter().all(|path| !ways.has(*path)) && ways.has(1) && ways.has(LAUNCHED));
    }

    #[test]
    fn what_is_left_out_is_that_alone() {
        let paths = [1, 5, 1 << 32, 1 << 33, u64::MAX];
        let mut left_out = LeftOut::new(paths.into_iter());
        let leaves_out =
            |left_out: &mut LeftOut, path| !PathRecorder::<1>::went_on(left_out, 0, path, 1.0);
        assert!(paths[1..].iter().all(|path| leaves_out(&mut left_out, *path)));
        assert!((2..5).chain([0, 6, 1 << 34]).all(|path| !leaves_out(&mut left_out, path)));
        let met = paths.map(|path| left_out.has_met(left_out.place(path)));
        assert_eq!(met, [false, true, true, true, true]);
        left_out.begin();
        assert!(paths.iter().all(|path| !left_out.has_met(left_out.place(*path))));
        assert!(!leaves_out(&mut LeftOut::default(), 1));
    }
}
