//! Four rays on their way to the border.

use glam::DVec3;
use num_complex::Complex64;

use super::crossing::{Crossing, RootRefinement, RootStatus};
use super::lateness::{Accuracy, Step};
use super::points::{Point, Points};
use super::step_control::StepControl;
use super::strides::{Move, Rays, StepKind, StepResult};
use super::{Arrival, Boundary, ConformalFlow, FlowError, MAX_STEPS, VirtualPoint};
use crate::lanes::LANES;

/// Moves below this share of the map's scale are exact to rounding by Taylor's formula of order
/// two.
const COASTING: f64 = 1e-4;

/// How far beyond a border that is near to aim, as a share of the map's scale.
const OVERSHOOT: f64 = 0.012;

/// Four rays on their way, or fewer: each goes where it would go alone.
pub(super) struct RayPacket {
    rays: Rays,
    controls: [StepControl; LANES],
    states: [RayState; LANES],
    begin: Points,
    here: Points,
    result: StepResult,
    /// What is wanted of pulses.
    pulses: Accuracy,
}

/// How far one of them has come.
#[derive(Clone, Copy, Debug)]
struct RayState {
    status: RayStatus,
    stride: f64,
    steps: u32,
    /// How much longer a pulse has taken than its phase, cm, if that is wanted.
    lateness: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum RayStatus {
    /// There is no such ray.
    Absent,
    /// A step of this length is to be taken.
    Stepping(f64),
    /// It moves onto the border.
    RefiningRoot(RootRefinement),
    Arrived(Boundary),
    Failed(FlowError),
}

impl RayStatus {
    /// That of a ray that is to set out so.
    fn at_start(&VirtualPoint { index, .. }: &VirtualPoint, wave_vector: DVec3) -> Self {
        let length = wave_vector.length();
        if !wave_vector.is_finite() {
            Self::Failed(FlowError::NotFinite)
        } else if (length - index).abs() > 1e-6 * index {
            Self::Failed(FlowError::WaveVector { length, index })
        } else {
            Self::Stepping(0.0)
        }
    }

    /// The next move, if there is one.
    fn ahead(&self) -> Option<f64> {
        match self {
            Self::Stepping(length) => Some(*length),
            Self::RefiningRoot(refinement) => Some(refinement.ahead),
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
        let ray = RayState { status: RayStatus::Absent, stride: 0.0, steps: 0, lateness: None };
        let control = flow.step_control(tolerance, false);
        let (cut, zeros) = (&flow.cut, [0.0; LANES]);
        let lever = 0.5 * (cut.x_max - cut.x_min).max(cut.y_max - flow.map.level());
        let mut packet = Self {
            rays: Rays { p_z: zeros, weight: zeros, lever },
            controls: [control; LANES],
            states: [ray; LANES],
            begin: Points::default(),
            here: Points::default(),
            result: StepResult::default(),
            pulses: Accuracy::default(),
        };
        for (i, start) in starts.iter().enumerate() {
            let Some((start, wave_vector)) = start else { continue };
            packet.states[i].status = RayStatus::at_start(start, *wave_vector);
            let p = start.half.mirrored(*wave_vector);
            packet.rays.p_z[i] = p.z;
            packet.here.zeta.put(i, start.virtual_position);
            packet.here.momentum.put(i, Complex64::new(p.x, p.y));
            packet.here.z[i] = start.z;
        }
        packet.set_out(flow, &control, tolerance);
        packet
    }

    /// Looks where the rays are, and how far they may go.
    fn set_out(&mut self, flow: &ConformalFlow, control: &StepControl, tolerance: f64) {
        let Some(any) = (0..LANES).find(|&i| self.states[i].status.ahead().is_some()) else {
            return;
        };
        // In the places of those that are not there, something that does no harm.
        for i in 0..LANES {
            if self.states[i].status.ahead().is_none() {
                self.rays.p_z[i] = self.rays.p_z[any];
                self.here.zeta.put(i, self.here.zeta.at(any));
                self.here.momentum.put(i, self.here.momentum.at(any));
                self.here.z[i] = self.here.z[any];
            }
        }
        self.stride(flow, StepKind::Departure, &[0.0; LANES]);
        self.begin = self.result.end;
        self.here = self.result.end;
        let nearer = flow.step_control(tolerance, true);
        for i in 0..LANES {
            if self.states[i].status.ahead().is_none() {
                continue;
            }
            let aims_at_floor = flow.aims_at_floor(self.here.zeta.at(i), self.here.momentum.at(i));
            let control = if aims_at_floor { &nearer } else { control };
            let control = control.along_z(self.rays.p_z[i], flow.index_scale);
            self.controls[i] = control;
            self.rays.weight[i] = control.allowed.recip();
            self.states[i].stride = 0.8 * control.longest;
            let leaving = flow.events.leaving_at(control.p_z, &self.here.at(i), flow.slack);
            match leaving {
                Some(boundary) => self.states[i].status = RayStatus::Arrived(boundary),
                None => self.go_on(flow, i),
            }
        }
    }

    /// Moves each ray that is not at its end once, or more often if that is cheap; whether one has
    /// moved.
    pub fn moves(&mut self, flow: &ConformalFlow) -> bool {
        let mut any = false;
        for kind in [StepKind::Full, StepKind::Short, StepKind::Coast] {
            let mut length = [0.0; LANES];
            let mut moves = [false; LANES];
            for i in 0..LANES {
                if let Some(ahead) = self.states[i].status.ahead()
                    && self.kind(flow, i, ahead) == kind
                {
                    (length[i], moves[i]) = (ahead, true);
                }
            }
            if moves == [false; LANES] {
                continue;
            }
            any = true;
            self.stride(flow, kind, &length);
            for (i, moves) in moves.into_iter().enumerate() {
                if moves {
                    self.moved(flow, i);
                }
            }
        }
        any
    }

    fn stride(&mut self, flow: &ConformalFlow, kind: StepKind, length: &[f64; LANES]) {
        let Self { rays, here, result, .. } = self;
        Move { flow, rays, kind, from: here, length, to: result }.take();
    }

    /// How a ray moves by `length`.
    fn kind(&self, flow: &ConformalFlow, i: usize, length: f64) -> StepKind {
        let (control, length) = (&self.controls[i], length.abs());
        if control.p_z == 0.0 && !flow.is_uneven() || length <= COASTING * flow.scale() {
            StepKind::Coast
        } else if length <= control.short && !flow.is_uneven() {
            StepKind::Short
        } else {
            StepKind::Full
        }
    }

    /// The same at their ends, where it is worked out, too, what pulses take, to within `pulses`, cm, if that is given.
    #[inline(never)]
    pub fn arrived(
        flow: &ConformalFlow,
        starts: &[Option<(VirtualPoint, DVec3)>; LANES],
        tolerance: f64,
        pulses: Option<f64>,
    ) -> Self {
        let mut packet = Self::new(flow, starts, tolerance);
        if let Some(to) = pulses {
            packet.pulses = Accuracy::new(flow, tolerance, to);
            for ray in &mut packet.states {
                ray.lateness = Some(0.0);
            }
        }
        while packet.moves(flow) {}
        packet
    }

    /// Puts a ray where its move by `length` has led.
    fn arrive(&mut self, flow: &ConformalFlow, i: usize, length: f64) {
        if let Some(lateness) = &mut self.states[i].lateness {
            let (from, to) = (self.here.at(i), self.result.end.at(i));
            let p_z = self.controls[i].p_z;
            let step = Step { flow, from: &from, to: &to, time: length, p_z };
            *lateness += step.lateness(&self.pulses);
        }
        self.here.take(i, &self.result.end);
    }

    /// Makes all steps of one ray short enough for a smooth drawing.
    pub fn even_out(&mut self, flow: &ConformalFlow, i: usize, longest: f64) {
        let control = &mut self.controls[i];
        (control.longest, control.even) = (control.longest.min(longest), true);
        if let RayStatus::Stepping(length) = &mut self.states[i].status {
            *length = length.min(longest / flow.index_scale);
        }
    }

    /// Where a ray is, if that is on its way and not beyond the border, which it looks for.
    pub fn waypoint(&self, i: usize) -> Option<Point> {
        let on_its_way =
            matches!(self.states[i].status, RayStatus::Stepping(_) | RayStatus::Arrived(_));
        on_its_way.then(|| self.here.at(i))
    }

    /// The end of a ray's way.
    pub fn arrival(&self, i: usize) -> Result<Arrival, FlowError> {
        match self.states[i].status {
            RayStatus::Arrived(boundary) => Ok(Arrival {
                control: self.controls[i],
                begin: self.begin.at(i),
                end: self.here.at(i),
                boundary,
                lateness: self.states[i].lateness,
            }),
            RayStatus::Failed(error) => Err(error),
            _ => Err(FlowError::Stalled),
        }
    }

    fn moved(&mut self, flow: &ConformalFlow, i: usize) {
        match self.states[i].status {
            RayStatus::Stepping(length) => self.stepped(flow, i, length),
            RayStatus::RefiningRoot(mut refinement) => {
                self.arrive(flow, i, refinement.ahead);
                let found = refinement.check(&self.here.at(i), &flow.events, self.controls[i].p_z);
                self.states[i].status = match found {
                    RootStatus::Continue => RayStatus::RefiningRoot(refinement),
                    RootStatus::Found(boundary) => RayStatus::Arrived(boundary),
                    RootStatus::Lost => RayStatus::Failed(FlowError::Stalled),
                };
            }
            RayStatus::Absent | RayStatus::Arrived(_) | RayStatus::Failed(_) => {}
        }
    }

    fn stepped(&mut self, flow: &ConformalFlow, i: usize, length: f64) {
        let error = self.result.error[i];
        let ray = &mut self.states[i];
        ray.stride = length * self.result.factor[i];
        ray.steps += 1;
        let good = error <= 1.0;
        if !(good || ray.stride >= 1e-9 * flow.slack) {
            ray.status = RayStatus::Failed(FlowError::Stalled);
            return;
        }
        if ray.steps > MAX_STEPS {
            ray.status = RayStatus::Failed(FlowError::StepLimit);
            return;
        }
        if !good {
            // The same step again, shorter.
            ray.status = RayStatus::Stepping(ray.stride);
            return;
        }
        let crossing = if self.result.crossed[i] == 0.0 {
            Crossing::None
        } else {
            let (from, to) = (self.here.at(i), self.result.end.at(i));
            flow.events.first_crossing(self.controls[i].p_z, &from, &to, length)
        };
        match crossing {
            Crossing::None => {
                self.arrive(flow, i, length);
                self.go_on(flow, i);
            }
            Crossing::Unclear { share } => ray.status = RayStatus::Stepping(share * length),
            Crossing::At { event, share } => {
                // From the nearer end.
                let ahead = if share < 0.5 {
                    share * length
                } else {
                    self.arrive(flow, i, length);
                    (share - 1.0) * length
                };
                let root = RootRefinement { ahead, event, reach: length, corrections: 0 };
                self.states[i].status = RayStatus::RefiningRoot(root);
            }
        }
    }

    /// Sets out for the next step, from where the last move has led.
    fn go_on(&mut self, flow: &ConformalFlow, i: usize) {
        let (control, ray) = (&self.controls[i], &mut self.states[i]);
        let usual = if control.even {
            control.longest
        } else {
            flow.map.longest_stride(self.here.zeta.at(i), control.longest)
        } / flow.index_scale;
        let beyond = self.result.ahead[i] + OVERSHOOT * flow.scale();
        ray.status = RayStatus::Stepping(ray.stride.min(usual).min(beyond));
    }
}
