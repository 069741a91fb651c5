//! The walk of one ray to the border. It does all but the full steps, which it wishes for.

use super::course::{Course, Point};
use super::crossing::{Crossing, Landing, Look};
use super::strides::{Trial, Wish};
use super::{Boundary, ConformalFlow, FlowError, MAX_STEPS};
use crate::propagation::nystrom;

/// How far beyond a border that is near to aim, as a share of the map's scale.
const OVERSHOOT: f64 = 0.012;

/// A ray on its way.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    pub course: Course,
    pub begin: Point,
    here: Point,
    stride: f64,
    state: State,
    steps: u32,
    pub evaluations: u32,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// A step of this length is to be taken.
    Stepping(f64),
    /// It moves onto the border.
    Landing(Landing),
    Arrived(Boundary),
    Lost,
}

impl Walk {
    /// A ray at `begin`, which is there already if it leaves at once.
    pub fn new(flow: &ConformalFlow, course: Course, begin: Point) -> Self {
        let stride = 0.8 * course.longest;
        let state = State::Lost;
        let mut walk = Self { course, begin, here: begin, stride, state, steps: 0, evaluations: 1 };
        match flow.gauges.leaving_at(&course, &begin, flow.slack) {
            Some(boundary) => walk.state = State::Arrived(boundary),
            None => walk.go_on(flow),
        }
        walk
    }

    /// Walks as far as it can alone. What it needs then is a full step; None if it is at the end.
    pub fn wish(&mut self, flow: &ConformalFlow) -> Option<Wish<'_>> {
        loop {
            let length = match self.state {
                State::Stepping(length) => length,
                State::Landing(landing) => landing.ahead,
                State::Arrived(_) | State::Lost => return None,
            };
            if !self.course.may_coast(length) {
                return Some(Wish { course: &self.course, from: &self.here, length });
            }
            let coasted = self.course.coasted(&self.here, length);
            self.evaluations += 1;
            let jet = flow.map.jet(coasted.zeta);
            self.moved(flow, &self.course.with_rates(Point { jet, ..coasted }), 0.0);
        }
    }

    /// Takes the step it wished for, if it is good enough.
    pub fn take(&mut self, flow: &ConformalFlow, trial: &Trial) {
        self.evaluations += nystrom::EVALUATIONS;
        self.moved(flow, &trial.end, trial.error);
    }

    /// Where it is, if that is on its way and not beyond the border, which it looks for.
    pub fn waypoint(&self) -> Option<&Point> {
        matches!(self.state, State::Stepping(_) | State::Arrived(_)).then_some(&self.here)
    }

    /// The end of the walk.
    pub fn arrival(&self) -> Result<(Point, Boundary), FlowError> {
        match self.state {
            State::Arrived(boundary) => Ok((self.here, boundary)),
            _ => Err(FlowError::StepLimit),
        }
    }

    fn moved(&mut self, flow: &ConformalFlow, end: &Point, error: f64) {
        match &mut self.state {
            State::Stepping(length) => {
                let length = *length;
                self.stepped(flow, end, error, length);
            }
            State::Landing(landing) => {
                self.here = *end;
                match landing.look(end, &flow.gauges, &self.course) {
                    Look::Move => {}
                    Look::Landed(boundary) => self.state = State::Arrived(boundary),
                    Look::Missed => self.state = State::Lost,
                }
            }
            State::Arrived(_) | State::Lost => {}
        }
    }

    fn stepped(&mut self, flow: &ConformalFlow, end: &Point, error: f64, length: f64) {
        self.stride = length * nystrom::step_factor(error);
        self.steps += 1;
        let good = error <= 1.0;
        if self.steps > MAX_STEPS || !(good || self.stride >= 1e-9 * flow.slack) {
            self.state = State::Lost;
            return;
        }
        if !good {
            self.go_on(flow);
            return;
        }
        match flow.gauges.first_crossing(&self.course, &self.here, end, length) {
            Crossing::None => {
                self.here = *end;
                self.go_on(flow);
            }
            Crossing::Unclear { share } => self.state = State::Stepping(share * length),
            Crossing::At { gauge, share } => {
                // From the nearer end.
                let ahead = if share < 0.5 {
                    share * length
                } else {
                    self.here = *end;
                    (share - 1.0) * length
                };
                self.state = State::Landing(Landing::new(ahead, gauge, length));
            }
        }
    }

    /// Sets out for the next step.
    fn go_on(&mut self, flow: &ConformalFlow) {
        let course = &self.course;
        let usual = if course.even {
            course.longest
        } else {
            flow.map.longest_stride(self.here.zeta, course.longest)
        } / course.strength;
        let beyond = flow.gauges.time_ahead(course, &self.here) + OVERSHOOT * course.scale;
        self.state = State::Stepping(self.stride.min(usual).min(beyond));
    }
}
