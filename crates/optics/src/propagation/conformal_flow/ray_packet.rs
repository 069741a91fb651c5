//! The walk of four rays to the border.

use glam::DVec3;
use num_complex::Complex64;

use super::course::StepControl;
use super::crossing::{Crossing, Look, RootRefinement};
use super::points::Points;
use super::strides::{Move, Rays, StepKind, StepResult};
use super::{Arrival, Boundary, ConformalFlow, FlowError, MAX_STEPS, VirtualPoint};
use crate::lanes::LANES;

/// Moves below this share of the map's scale are exact to rounding by Taylor's formula of order two.
const COASTING: f64 = 1e-4;

/// How far beyond a border that is near to aim, as a share of the map's scale.
const OVERSHOOT: f64 = 0.012;

/// Four rays on their way, or fewer: each goes where it would go alone.
pub(super) struct RayPacket {
    rays: Rays,
    courses: [StepControl; LANES],
    walks: [Walk; LANES],
    begin: Points,
    here: Points,
    trials: StepResult,
}

/// How far one of them has come.
#[derive(Clone, Copy, Debug)]
struct Walk {
    state: State,
    stride: f64,
    steps: u32,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// There is no such ray.
    Absent,
    /// A step of this length is to be taken.
    Stepping(f64),
    /// It moves onto the border.
    RootRefinement(RootRefinement),
    Arrived(Boundary),
    Failed(FlowError),
}

impl State {
    /// The next move, if there is one.
    fn ahead(&self) -> Option<f64> {
        match self {
            Self::Stepping(length) => Some(*length),
            Self::RootRefinement(landing) => Some(landing.ahead),
            Self::Absent | Self::Arrived(_) | Self::Failed(_) => None,
        }
    }
}

impl RayPacket {
    /// Rays at their starts with their wave vectors, to be followed to the tolerance (cm).
    pub fn new(
        flow: &ConformalFlow,
        starts: &[Option<(VirtualPoint, DVec3)>; LANES],
        tolerance: f64,
    ) -> Self {
        let walk = Walk { state: State::Absent, stride: 0.0, steps: 0 };
        let demands = flow.demands(tolerance, false);
        let weight = [0.0; LANES];
        let mut convoy = Self {
            rays: Rays { p_z: [0.0; LANES], weight, lever: flow.lever() },
            courses: [demands; LANES],
            walks: [walk; LANES],
            begin: Points::default(),
            here: Points::default(),
            trials: StepResult::default(),
        };
        for (i, start) in starts.iter().enumerate() {
            let Some((start, wave_vector)) = start else { continue };
            convoy.walks[i].state = match flow.sets_out(start, *wave_vector) {
                Ok(()) => State::Stepping(0.0),
                Err(error) => State::Failed(error),
            };
            let p = start.half.mirrored(*wave_vector);
            convoy.rays.p_z[i] = p.z;
            convoy.here.zeta.put(i, start.virtual_position);
            convoy.here.momentum.put(i, Complex64::new(p.x, p.y));
            convoy.here.z[i] = start.half.mirrored(start.position).z;
        }
        convoy.set_out(flow, &demands, tolerance);
        convoy
    }

    /// Looks where the rays are, and how far they may go.
    fn set_out(&mut self, flow: &ConformalFlow, demands: &StepControl, tolerance: f64) {
        let Some(any) = (0..LANES).find(|&i| self.walks[i].state.ahead().is_some()) else {
            return;
        };
        // In the places of those that are not there, something that does no harm.
        for i in 0..LANES {
            if self.walks[i].state.ahead().is_none() {
                self.rays.p_z[i] = self.rays.p_z[any];
                self.here.zeta.put(i, self.here.zeta.at(any));
                self.here.momentum.put(i, self.here.momentum.at(any));
                self.here.z[i] = self.here.z[any];
            }
        }
        self.stride(flow, StepKind::Departure, &[0.0; LANES]);
        self.begin = self.trials.end;
        self.here = self.trials.end;
        let nearer = flow.demands(tolerance, true);
        for i in 0..LANES {
            if self.walks[i].state.ahead().is_none() {
                continue;
            }
            let aims_at_floor = flow.aims_at_floor(self.here.zeta.at(i), self.here.momentum.at(i));
            let demands = if aims_at_floor { &nearer } else { demands };
            let course = demands.along_z(self.rays.p_z[i], flow.index_scale);
            self.courses[i] = course;
            self.rays.weight[i] = course.allowed.recip();
            self.walks[i].stride = 0.8 * course.longest;
            let leaving = flow.gauges.leaving_at(course.p_z, &self.here.at(i), flow.slack);
            match leaving {
                Some(boundary) => self.walks[i].state = State::Arrived(boundary),
                None => self.go_on(flow, i),
            }
        }
    }

    /// Moves each ray that is not at its end once, or more often if that is cheap; whether one has moved.
    pub fn moves(&mut self, flow: &ConformalFlow) -> bool {
        let mut any = false;
        for pace in [StepKind::Full, StepKind::Short, StepKind::Coast] {
            let mut length = [0.0; LANES];
            let mut moves = [false; LANES];
            for i in 0..LANES {
                if let Some(ahead) = self.walks[i].state.ahead()
                    && self.pace(flow, i, ahead) == pace
                {
                    (length[i], moves[i]) = (ahead, true);
                }
            }
            if moves == [false; LANES] {
                continue;
            }
            any = true;
            self.stride(flow, pace, &length);
            for (i, moves) in moves.into_iter().enumerate() {
                if moves {
                    self.moved(flow, i);
                }
            }
        }
        any
    }

    fn stride(&mut self, flow: &ConformalFlow, pace: StepKind, length: &[f64; LANES]) {
        let Self { rays, here, trials, .. } = self;
        Move { flow, rays, pace, from: here, length, to: trials }.take();
    }

    /// How a ray moves by `length`.
    fn pace(&self, flow: &ConformalFlow, i: usize, length: f64) -> StepKind {
        let (course, length) = (&self.courses[i], length.abs());
        if course.p_z == 0.0 && !flow.is_uneven() || length <= COASTING * flow.scale() {
            StepKind::Coast
        } else if length <= course.short && !flow.is_uneven() {
            StepKind::Short
        } else {
            StepKind::Full
        }
    }

    /// Makes all steps of one ray short enough for a smooth drawing.
    pub fn even_out(&mut self, flow: &ConformalFlow, i: usize, longest: f64) {
        let course = &mut self.courses[i];
        (course.longest, course.even) = (course.longest.min(longest), true);
        if let State::Stepping(length) = &mut self.walks[i].state {
            *length = length.min(longest / flow.index_scale);
        }
    }

    /// Where a ray is, if that is on its way and not beyond the border, which it looks for: x + iy, z and τ.
    pub fn waypoint(&self, i: usize) -> Option<(Complex64, f64, f64)> {
        let on_its_way = matches!(self.walks[i].state, State::Stepping(_) | State::Arrived(_));
        on_its_way.then(|| (self.here.jet.f.at(i), self.here.z[i], self.here.tau[i]))
    }

    /// The end of a ray's way.
    pub fn arrival(&self, i: usize) -> Result<Arrival, FlowError> {
        match self.walks[i].state {
            State::Arrived(boundary) => Ok(Arrival {
                course: self.courses[i],
                begin: self.begin.at(i),
                end: self.here.at(i),
                boundary,
            }),
            State::Failed(error) => Err(error),
            _ => Err(FlowError::StepLimit),
        }
    }

    fn moved(&mut self, flow: &ConformalFlow, i: usize) {
        let walk = &mut self.walks[i];
        match &mut walk.state {
            State::Stepping(length) => {
                let length = *length;
                self.stepped(flow, i, length);
            }
            State::RootRefinement(landing) => {
                self.here.take(i, &self.trials.end);
                match landing.look(&self.here.at(i), &flow.gauges, self.courses[i].p_z) {
                    Look::Move => {}
                    Look::Landed(boundary) => walk.state = State::Arrived(boundary),
                    Look::Missed => walk.state = State::Failed(FlowError::StepLimit),
                }
            }
            State::Absent | State::Arrived(_) | State::Failed(_) => {}
        }
    }

    fn stepped(&mut self, flow: &ConformalFlow, i: usize, length: f64) {
        let error = self.trials.error[i];
        let walk = &mut self.walks[i];
        walk.stride = length * self.trials.factor[i];
        walk.steps += 1;
        let good = error <= 1.0;
        if walk.steps > MAX_STEPS || !(good || walk.stride >= 1e-9 * flow.slack) {
            walk.state = State::Failed(FlowError::StepLimit);
            return;
        }
        if !good {
            // The same step again, shorter.
            walk.state = State::Stepping(walk.stride);
            return;
        }
        let crossing = if self.trials.crossed[i] == 0.0 {
            Crossing::None
        } else {
            let (from, to) = (self.here.at(i), self.trials.end.at(i));
            flow.gauges.first_crossing(self.courses[i].p_z, &from, &to, length)
        };
        match crossing {
            Crossing::None => {
                self.here.take(i, &self.trials.end);
                self.go_on(flow, i);
            }
            Crossing::Unclear { share } => walk.state = State::Stepping(share * length),
            Crossing::At { gauge, share } => {
                // From the nearer end.
                let ahead = if share < 0.5 {
                    share * length
                } else {
                    self.here.take(i, &self.trials.end);
                    (share - 1.0) * length
                };
                walk.state = State::RootRefinement(RootRefinement::new(ahead, gauge, length));
            }
        }
    }

    /// Sets out for the next step, from where the last move has led.
    fn go_on(&mut self, flow: &ConformalFlow, i: usize) {
        let (course, walk) = (&self.courses[i], &mut self.walks[i]);
        let usual = if course.even {
            course.longest
        } else {
            flow.map.longest_stride(self.here.zeta.at(i), course.longest)
        } / flow.index_scale;
        let beyond = self.trials.ahead[i] + OVERSHOOT * flow.scale();
        walk.state = State::Stepping(walk.stride.min(usual).min(beyond));
    }
}
