//! Rays through media that are given on a grid in space: an isotropic index, or a uniaxial
//! dielectric with a field of optic axes.
//!
//! With ε_o = n_o², ρ = ε_e/ε_o and the unit vector a of the optic axis, the waves of a uniaxial
//! dielectric (µ = 1) have the Hamiltonians
//!
//! ```text
//! ordinary, and isotropic:  H = (p² - ε_o)/2 = 0
//! extraordinary:            H = (p² + (ρ - 1)(p·a)² - ρ ε_o)/2 = 0
//! ```
//!
//! and rays dr/dτ = ∂H/∂p, dp/dτ = -∂H/∂r (Kravtsov & Orlov, Geometrical Optics of Inhomogeneous
//! Media, chapters 2 and 3); the optical path grows by p·dr. Each wave keeps to itself, its field
//! turning with the axis, as holds where the medium varies little over λ/|n_e - n_o|. In isotropic
//! media the field is carried parallel, de/ds = -(e·∇ln n) t (Rytov).

use super::group_path::kink_inside;
use super::radial::uniaxial_wave::{UniaxialPoint, transport};
use super::runge_kutta::{predict, step, step_factor};
use super::space_spline::{Look, SpaceSpline};
use super::{FlowError, PathEnd, PathPoint};
use crate::geometry::FlatOrRound;
use crate::medium::{Medium, ModeKind};
use glam::{DMat3, DVec3};

/// A medium given on a grid in space.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialMedium {
    /// The square of the index, of the ordinary wave where there are two; above 0 all over.
    pub square: SpaceSpline<1>,
    /// What makes it uniaxial.
    pub anisotropy: Option<Anisotropy>,
}

/// What makes a medium uniaxial.
#[derive(Clone, Debug, PartialEq)]
pub struct Anisotropy {
    /// The index along the axis.
    pub extraordinary: Extraordinary,
    /// The optic axes.
    pub axis: AxisField,
}

/// The index of fields along the axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Extraordinary {
    /// Its square over that of the ordinary index, the same all over; above 0.
    Ratio(f64),
    /// Its square, above 0 all over.
    Square(SpaceSpline<1>),
}

/// The optic axes of a medium.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisField {
    /// The same all over, a unit vector.
    Constant(DVec3),
    /// Along these vectors, which vanish nowhere.
    Spline(SpaceSpline<3>),
}

/// A surface at which a medium given on a grid ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpatialBorder {
    /// A plane or a sphere.
    FlatOrRound(FlatOrRound),
    /// A round cylinder about the z axis: the sphere of its radius.
    Tube(FlatOrRound),
}

/// Rays through a medium given on a grid that is cut to a convex shape.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialFlow {
    medium: SpatialMedium,
    border: Vec<SpatialBorder>,
    /// How large the shape is, cm.
    size: f64,
}

/// A ray at a point of a medium, or of its border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialRay {
    /// Where it is, cm.
    pub position: DVec3,
    /// Its wave vector.
    pub wave_vector: DVec3,
    /// Which of the medium's waves it is.
    pub mode: ModeKind,
}

/// r, p, the optical path, and what is carried along: a field, or what a pulse takes.
type State = [f64; 10];

/// What is carried along.
#[derive(Clone, Copy, PartialEq)]
enum Carried {
    Nothing,
    /// An electric field across p, from here on.
    Field(DVec3),
    /// The speed of light times the time of a pulse.
    GroupPath,
}

/// Steps of one way.
const MOST_STEPS: u32 = 20_000;

/// Of the tolerance what a step may be off.
const SHARE: f64 = 0.02;

/// Steps end within so many cells of the planes of the grid, where the third derivatives of the
/// medium jump: beyond them by less the error is small of fourth order.
const SLACK: f64 = 1e-3;

/// Of the size, the longest step, and the shortest.
const STEPS: [f64; 2] = [1.0, 1e-13];

/// Straight pieces that a way is drawn with, at least.
const PIECES: f64 = 96.0;

/// sin² of the angle of p to the axis below which both waves are one.
const ONE_WAVE: f64 = 1e-28;

/// How often a step is cut at most where the group index has a kink.
const MOST_CUTS: u32 = 3;

/// What a medium is at a point.
struct Local {
    square: f64,
    square_gradient: DVec3,
    /// ρ - 1; 0 in isotropic media.
    excess: f64,
    ratio_gradient: DVec3,
    axis: DVec3,
    /// The gradients of the components of the axis.
    turn: [DVec3; 3],
}

impl SpatialBorder {
    fn of(self, at: DVec3) -> (FlatOrRound, DVec3) {
        match self {
            Self::FlatOrRound(surface) => (surface, at),
            Self::Tube(sphere) => (sphere, at.with_z(0.0)),
        }
    }

    /// How far outside a point is that is near the surface, cm; negative inside.
    #[must_use]
    pub fn height(self, at: DVec3) -> f64 {
        let (surface, at) = self.of(at);
        surface.height(at)
    }

    /// The outward unit normal at a point near the surface.
    #[must_use]
    pub fn outward(self, at: DVec3) -> DVec3 {
        let (surface, at) = self.of(at);
        surface.outward(at)
    }
}

impl SpatialMedium {
    fn local(&self, at: DVec3) -> Local {
        let Look { value: [square], gradient: [square_gradient] } = self.square.look(at);
        let mut local = Local {
            square,
            square_gradient,
            excess: 0.0,
            ratio_gradient: DVec3::ZERO,
            axis: DVec3::Z,
            turn: [DVec3::ZERO; 3],
        };
        let Some(Anisotropy { extraordinary, axis }) = &self.anisotropy else { return local };
        match extraordinary {
            Extraordinary::Ratio(ratio) => local.excess = ratio - 1.0,
            Extraordinary::Square(spline) => {
                let Look { value: [along], gradient: [gradient] } = spline.look(at);
                local.excess = (along - square) / square;
                local.ratio_gradient = (gradient - square_gradient * (along / square)) / square;
            }
        }
        match axis {
            AxisField::Constant(axis) => local.axis = *axis,
            AxisField::Spline(spline) => {
                let Look { value, gradient } = spline.look(at);
                let vector = DVec3::from_array(value);
                let length = vector.length();
                local.axis = vector / length;
                let along: DVec3 = (0..3).map(|c| gradient[c] * local.axis[c]).sum();
                local.turn =
                    std::array::from_fn(|c| (gradient[c] - along * local.axis[c]) / length);
            }
        }
        local
    }

    /// The local medium at a point; `None` if it is none, beyond the border.
    #[must_use]
    pub fn at(&self, position: DVec3) -> Option<Medium> {
        self.local(position).medium(self.is_isotropic())
    }

    /// Whether it is the same however it is turned, all over.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.anisotropy.is_none()
    }
}

impl Local {
    fn medium(&self, isotropic: bool) -> Option<Medium> {
        if isotropic {
            return (self.square > 0.0 && self.square.is_finite())
                .then(|| Medium::dielectric(self.square.sqrt()));
        }
        let along = self.square * (1.0 + self.excess);
        Medium::uniaxial_electric(1.0, self.square, along, self.axis).ok()
    }

    fn point(&self) -> UniaxialPoint {
        let extraordinary = self.square * (1.0 + self.excess);
        UniaxialPoint { ordinary: self.square, extraordinary, axis: self.axis }
    }

    /// dr/dτ and dp/dτ.
    fn rates(&self, p: DVec3, extraordinary: bool) -> (DVec3, DVec3) {
        if !extraordinary {
            return (p, 0.5 * self.square_gradient);
        }
        let along = p.dot(self.axis);
        let turn = self.turn[0] * p.x + self.turn[1] * p.y + self.turn[2] * p.z;
        let square = self.square_gradient * (1.0 + self.excess) + self.ratio_gradient * self.square;
        let force =
            square - self.ratio_gradient * (along * along) - turn * (2.0 * self.excess * along);
        (p + self.axis * (self.excess * along), 0.5 * force)
    }

    /// The wave vector along `p` that the medium has.
    fn on_surface(&self, p: DVec3, extraordinary: bool) -> DVec3 {
        let (form, constant) = if extraordinary {
            let along = p.dot(self.axis);
            let form = p.length_squared() + self.excess * along * along;
            (form, self.square * (1.0 + self.excess))
        } else {
            (p.length_squared(), self.square)
        };
        p * (constant / form).sqrt()
    }

    /// The unit vector p × a; where both waves are one, that to which it tends on the way from here
    /// (`sense` 1) or to here (-1), `None` if they stay one.
    fn across(&self, p: DVec3, sense: f64) -> Option<DVec3> {
        let across = p.cross(self.axis);
        if across.length_squared() >= ONE_WAVE * p.length_squared() {
            return Some(across.normalize());
        }
        let (velocity, force) = self.rates(p, false);
        let turned = DVec3::from_array(self.turn.map(|gradient| gradient.dot(velocity)));
        let rate = force.cross(self.axis) + p.cross(turned);
        let least = 1e-10 * p.length() * (turned.length() + force.length() / p.length());
        (rate.length() > least).then(|| rate.normalize() * sense)
    }

    /// The electric field of unit power of a wave.
    fn field(&self, p: DVec3, mode: ModeKind, sense: f64) -> DVec3 {
        let across =
            self.across(p, sense).unwrap_or_else(|| p.normalize().any_orthonormal_vector());
        self.point().field_across(p, across, mode)
    }
}

fn is_one_of_two(mode: ModeKind) -> bool {
    matches!(mode, ModeKind::Ordinary | ModeKind::Extraordinary)
}

fn vector(state: &State, first: usize) -> DVec3 {
    DVec3::new(state[first], state[first + 1], state[first + 2])
}

impl SpatialFlow {
    /// Rays through a medium within some surfaces, between which it has about that size, cm.
    #[must_use]
    pub fn new(medium: SpatialMedium, border: Vec<SpatialBorder>, size: f64) -> Self {
        Self { medium, border, size }
    }

    /// The medium.
    #[must_use]
    pub fn medium(&self) -> &SpatialMedium {
        &self.medium
    }

    /// How far outside of the border a point is that is near it, cm; negative inside.
    #[must_use]
    pub fn height(&self, at: DVec3) -> f64 {
        let heights = self.border.iter().map(|surface| surface.height(at));
        heights.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Where the waves of a uniaxial medium start as one and then part: their electric fields, of
    /// unit power. `None` if they do not part.
    #[must_use]
    pub fn parted(&self, position: DVec3, wave_vector: DVec3) -> Option<[(ModeKind, DVec3); 2]> {
        self.medium.anisotropy.as_ref()?;
        let local = self.medium.local(position);
        let across = local.across(wave_vector, 1.0)?;
        let field = |mode| (mode, local.point().field_across(wave_vector, across, mode));
        Some([ModeKind::Ordinary, ModeKind::Extraordinary].map(field))
    }

    /// Follows a ray to the border, with errors of position and optical path of about `tolerance`,
    /// cm.
    ///
    /// # Errors
    ///
    /// If the ray stays inside for too many steps, or cannot be followed.
    pub fn advance(&self, ray: &SpatialRay, tolerance: f64) -> Result<PathEnd<u16>, FlowError> {
        let SpatialRay { position, wave_vector, mode } = *ray;
        let own_field = is_one_of_two(mode) && !self.medium.is_isotropic();
        let across = wave_vector.normalize().any_orthonormal_vector();
        let carried = if own_field { Carried::Nothing } else { Carried::Field(across) };
        let (end, surface) = self.march(ray, carried, tolerance, STEPS[0], |_| ())?;
        let extraordinary = mode == ModeKind::Extraordinary;
        let border = self.border[usize::from(surface)];
        let end_position = vector(&end, 0);
        let outward = border.outward(end_position);
        let end_position = end_position - outward * border.height(end_position);
        let [before, after] = [position, end_position].map(|at| self.medium.local(at));
        let end_wave_vector = after.on_surface(vector(&end, 3), extraordinary);
        let (direction, _) = after.rates(end_wave_vector, extraordinary);
        let direction = direction.normalize();
        let transport = if own_field {
            let field = before.field(wave_vector, mode, 1.0);
            transport(field, after.field(end_wave_vector, mode, -1.0))
        } else {
            let from = [wave_vector.normalize(), across];
            let field = vector(&end, 7);
            let field = (field - direction * field.dot(direction)).normalize();
            let [from, to] = [from, [direction, field]]
                .map(|[along, field]| DMat3::from_cols(along, field, along.cross(field)));
            // |Re(E × H*)| = n |E|².
            to * from.transpose() * (before.square / after.square).powf(0.25)
        };
        let sound =
            end_position.is_finite() && end_wave_vector.is_finite() && transport.is_finite();
        let end = PathEnd {
            surface,
            position: end_position,
            virtual_point: (),
            wave_vector: end_wave_vector,
            direction,
            optical_path: end[6],
            group_path: None,
            transport,
            outward,
        };
        if sound { Ok(end) } else { Err(FlowError::Stalled) }
    }

    /// The speed of light times the time that a pulse takes on the way of a ray, cm, at the least
    /// dispersion that causality allows.
    ///
    /// # Errors
    ///
    /// As [`Self::advance`].
    pub fn causal_group_path(&self, ray: &SpatialRay, tolerance: f64) -> Result<f64, FlowError> {
        let (end, _) = self.march(ray, Carried::GroupPath, tolerance, STEPS[0], |_| ())?;
        Ok(end[7])
    }

    /// Points along the way of a ray to the border.
    ///
    /// # Errors
    ///
    /// As [`Self::advance`].
    pub fn path(&self, ray: &SpatialRay, tolerance: f64) -> Result<Vec<PathPoint>, FlowError> {
        let mut path = vec![PathPoint { position: ray.position, optical_path: 0.0 }];
        self.march(ray, Carried::Nothing, tolerance, PIECES.recip(), |state| {
            path.push(PathPoint { position: vector(state, 0), optical_path: state[6] });
        })?;
        Ok(path)
    }

    fn rates(&self, state: &State, mode: ModeKind, carried: Carried) -> State {
        let (position, p) = (vector(state, 0), vector(state, 3));
        let local = self.medium.local(position);
        let extraordinary = mode == ModeKind::Extraordinary;
        let (velocity, force) = local.rates(p, extraordinary);
        let carried = match carried {
            Carried::Nothing => DVec3::ZERO,
            Carried::Field(_) => {
                p * (-0.5 * vector(state, 7).dot(local.square_gradient) / local.square)
            }
            // n and 1/n, whichever is larger, per length.
            Carried::GroupPath if !extraordinary => DVec3::X * local.square.max(1.0),
            Carried::GroupPath => {
                let field = local.field(p, mode, 1.0);
                let group = local
                    .medium(false)
                    .map_or(f64::NAN, |medium| medium.causal_group_index(p, field.into()));
                DVec3::X * (group * velocity.length())
            }
        };
        let (v, f, c) = (velocity, force, carried);
        [v.x, v.y, v.z, f.x, f.y, f.z, p.dot(velocity), c.x, c.y, c.z]
    }

    /// Follows a ray to the border: the state there, and which surface. `visit` is shown each state
    /// after the first, steps being at most `longest` of the size.
    fn march(
        &self,
        ray: &SpatialRay,
        carried: Carried,
        tolerance: f64,
        longest: f64,
        mut visit: impl FnMut(&State),
    ) -> Result<(State, u16), FlowError> {
        let (r, p) = (ray.position, ray.wave_vector);
        if !(r.is_finite() && p.is_finite()) {
            return Err(FlowError::NotFinite);
        }
        let start_field = if let Carried::Field(field) = carried { field } else { DVec3::ZERO };
        let c = start_field;
        let mut state = [r.x, r.y, r.z, p.x, p.y, p.z, 0.0, c.x, c.y, c.z];
        let rates = |state: &State| self.rates(state, ray.mode, carried);
        let weight = self.weight(&state, carried, tolerance);
        let mut first = rates(&state);
        let mut leaving = self.already_outside(&state, &first);
        let mut wanted = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            if let Some(surface) = leaving {
                return Ok((state, surface));
            }
            let speed = vector(&first, 0).length();
            let mut h = wanted.min(longest * self.size / speed);
            if let Some((time, axis, plane)) = self.way_to_plane(&state, &first)
                && time < h
            {
                h = time;
                let there = predict(&rates, (&state, &first), time);
                let later = (plane - there[axis]) / rates(&there)[axis];
                if later.abs() < 0.2 * time {
                    h += later;
                }
            }
            let (mut end, mut error) = step(&rates, (&state, &first), h, &weight);
            let (mut uncut, mut cuts) = (None, 0);
            while error.is_nan() || error > 1.0 {
                let kink = || self.kink((&state, &first), (&end, &rates(&end)), h);
                if let Carried::GroupPath = carried
                    && cuts < MOST_CUTS
                    && let Some(share) = kink()
                {
                    uncut.get_or_insert(h);
                    cuts += 1;
                    h *= share;
                } else {
                    h *= step_factor(error).min(0.9);
                    if h * speed < STEPS[1] * self.size || h.is_nan() {
                        return Err(FlowError::Stalled);
                    }
                }
                (end, error) = step(&rates, (&state, &first), h, &weight);
            }
            // Beyond a kink it goes on as before it.
            wanted = uncut.unwrap_or(h * step_factor(error));
            let last = rates(&end);
            let take = |h: f64| step(&rates, (&state, &first), h, &weight).0;
            let met = self.way_out((&state, &first), (&end, &last), h, (&take, &rates))?;
            if let Some((surface, out)) = met {
                (end, leaving) = (out, Some(surface));
            }
            visit(&end);
            (state, first) = (end, last);
        }
        Err(FlowError::StepLimit)
    }

    /// At which share of a step between states with these rates, if at any inside, a principal value passes 1: there
    /// the group index has a kink. The way is Hermite's cubic.
    fn kink(
        &self,
        (a, first): (&State, &State),
        (b, last): (&State, &State),
        h: f64,
    ) -> Option<f64> {
        let sides = |at: DVec3| {
            let Local { square, excess, .. } = self.medium.local(at);
            (square > 1.0, square * (1.0 + excess) > 1.0)
        };
        let ([from, to], [v, w]) =
            ([a, b].map(|s| vector(s, 0)), [first, last].map(|r| vector(r, 0)));
        let at = |share: f64| {
            let left = 1.0 - share;
            from + (to - from) * (share * share * (3.0 - 2.0 * share))
                + (v * left - w * share) * (share * left * h)
        };
        let changes = to.is_finite() && sides(from) != sides(to);
        changes.then(|| kink_inside([0.0, 1.0], [0.0, 1.0], |share| sides(at(share))))?
    }

    /// One over what a step may be off in each component.
    fn weight(&self, state: &State, carried: Carried, tolerance: f64) -> State {
        let allowed =
            |tolerance: f64, size: f64| (tolerance * SHARE).max(64.0 * f64::EPSILON * size);
        let place = vector(state, 0).length().max(self.size);
        let [place, wave] = [
            allowed(tolerance, place).recip(),
            allowed(tolerance / self.size, vector(state, 3).length()).recip(),
        ];
        let [x, y, z] = match carried {
            Carried::Nothing => [0.0; 3],
            Carried::Field(_) => [allowed(tolerance / self.size, 1.0).recip(); 3],
            Carried::GroupPath => [place, 0.0, 0.0],
        };
        [place, place, place, wave, wave, wave, place, x, y, z]
    }

    /// The surface on which a ray is that runs out of it, or along it, from the start.
    fn already_outside(&self, state: &State, rates: &State) -> Option<u16> {
        let (at, velocity) = (vector(state, 0), vector(rates, 0));
        let near = 1e-12 * at.length().max(self.size);
        let out = |surface: &SpatialBorder| {
            surface.height(at) > -near && surface.outward(at).dot(velocity) >= 0.0
        };
        self.border.iter().position(out).map(|surface| surface as u16)
    }

    /// About when the ray comes to the end of its cell of the grid, and through which plane: the
    /// axis across it, and where it is.
    fn way_to_plane(&self, state: &State, rates: &State) -> Option<(f64, usize, f64)> {
        let mut nearest: Option<(f64, usize, f64)> = None;
        for axis in 0..3 {
            let (at, speed, bend) = (state[axis], rates[axis], 0.5 * rates[3 + axis]);
            let cell = self.medium.square.cell_along(axis, at, speed, SLACK);
            let Some([low, high]) = cell else { continue };
            let ways = [(high, [at - high, speed, bend]), (low, [low - at, -speed, -bend])];
            for (plane, way) in ways {
                if way[0].is_finite()
                    && let Some([over, under]) = super::first_way_out(way)
                    && under > 0.0
                    && over > 0.0
                    && nearest.is_none_or(|(time, ..)| over / under < time)
                {
                    nearest = Some((over / under, axis, plane));
                }
            }
        }
        nearest
    }

    /// Where a step of length `h` comes out through the border, if it does: the surface and the
    /// state there.
    fn way_out(
        &self,
        (start, first): (&State, &State),
        (end, last): (&State, &State),
        h: f64,
        (take, rates): (&impl Fn(f64) -> State, &impl Fn(&State) -> State),
    ) -> Result<Option<(u16, State)>, FlowError> {
        let mut found: Option<(u16, f64, State)> = None;
        for (number, surface) in (0u16..).zip(&self.border) {
            let rise = |state: &State, rates: &State| {
                let at = vector(state, 0);
                [surface.height(at), surface.outward(at).dot(vector(rates, 0))]
            };
            let [bottom, climb] = rise(start, first);
            let (mut high, mut state) = (h, *end);
            if let Some((_, time, earlier)) = &found {
                (high, state) = (*time, *earlier);
            }
            let [mut top, fall] = rise(end, last);
            if found.is_some() {
                top = surface.height(vector(&state, 0));
            }
            if top <= 0.0 {
                // Out and in again within the step: the top of a parabola.
                if found.is_some() || climb <= 0.0 || fall >= 0.0 {
                    continue;
                }
                let turn = h * climb / (climb - fall);
                if bottom + 0.5 * climb * turn < -0.1 * (climb * h).abs() {
                    continue;
                }
                (high, state) = (turn, take(turn));
                if surface.height(vector(&state, 0)) <= 0.0 {
                    continue;
                }
            }
            let (time, out) = self.root(*surface, high, state, (take, rates))?;
            found = Some((number, time, out));
        }
        Ok(found.map(|(number, _, out)| (number, out)))
    }

    /// The time up to `high`, at which the state is beyond a surface, when it comes through it.
    fn root(
        &self,
        surface: SpatialBorder,
        mut high: f64,
        mut state: State,
        (take, rates): (&impl Fn(f64) -> State, &impl Fn(&State) -> State),
    ) -> Result<(f64, State), FlowError> {
        let mut low = 0.0;
        let mut time = high;
        let close = 2.0 * f64::EPSILON * vector(&state, 0).length().max(self.size);
        for _ in 0..100 {
            let at = vector(&state, 0);
            let height = surface.height(at);
            if height.abs() <= close {
                return Ok((time, state));
            }
            if height > 0.0 {
                high = time
            } else {
                low = time
            }
            let slope = surface.outward(at).dot(vector(&rates(&state), 0));
            let next = time - height / slope;
            time = if slope > 0.0 && next > low && next < high { next } else { 0.5 * (low + high) };
            if high - low <= 4.0 * f64::EPSILON * high {
                return Ok((time, state));
            }
            state = take(time);
        }
        Err(FlowError::Stalled)
    }
}
