//! Points along a ray, for drawings.

use super::course::Point;
use super::strides::strides;
use super::walk::Walk;
use super::{ConformalFlow, FlowError, Foothold};
use crate::propagation::PathPoint;
use glam::DVec3;
use num_complex::Complex64;

/// Points per length over which the map varies.
const DENSITY: f64 = 24.0;

impl ConformalFlow {
    /// Points along the ray that [`Self::advance_from`] follows, from its start to its end, close enough for a
    /// smooth drawing.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_from`].
    pub fn path(
        &self,
        start: &Foothold,
        wave_vector: DVec3,
        tolerance: f64,
    ) -> Result<Vec<PathPoint>, FlowError> {
        let (mut course, begin) = self.course(start, wave_vector, tolerance)?;
        let half = start.half;
        let speed = self.strength * self.strength;
        let point = |at: Complex64, z: f64, tau: f64| PathPoint {
            position: half.mirrored(DVec3::new(at.re, at.im, z)),
            optical_path: speed * tau,
        };
        let spacing = self.map.scale() / DENSITY;
        if course.p_z == 0.0 {
            // A straight line in virtual space.
            let end = self.advance_from(start, wave_vector, tolerance)?;
            let (from, to) = (begin.zeta, end.at.virtual_position);
            let pieces = ((to - from).norm() / spacing).ceil().max(1.0) as u32;
            let tau = end.optical_path / speed;
            return Ok((0..=pieces)
                .map(|k| {
                    let share = f64::from(k) / f64::from(pieces);
                    let zeta = from + (to - from) * share;
                    point(self.map.jet(zeta).f, begin.z, tau * share)
                })
                .collect());
        }
        (course.longest, course.even) = (course.longest.min(spacing), true);
        let mut walk = Walk::new(self, course, begin);
        let mut way: Vec<Point> = vec![begin];
        loop {
            let trial = match walk.wish(self) {
                None => break,
                Some(wish) => strides(&self.map, [Some(wish), None, None, None]),
            };
            let Some([trial, ..]) = trial else { break };
            walk.take(self, &trial);
            if let Some(here) = walk.waypoint()
                && way.last().is_none_or(|last| here.tau > last.tau)
            {
                way.push(*here);
            }
        }
        let (end, _) = walk.arrival()?;
        way.retain(|at| at.tau < end.tau);
        way.push(end);
        Ok(way.iter().map(|at| point(at.jet.f, at.z, at.tau)).collect())
    }
}
