//! Points along a ray, for drawings.

use super::points::Point;
use super::ray_packet::RayPacket;
use super::{ConformalFlow, FlowError, VirtualPoint};
use crate::propagation::PathPoint;
use glam::DVec3;
use num_complex::Complex64;

/// Points per length over which the map varies.
const DENSITY: f64 = 24.0;

impl ConformalFlow {
    /// Points along the ray that [`Self::advance_from`] follows, from its start to its end, close
    /// enough for a smooth drawing.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_from`].
    pub fn path(
        &self,
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
    ) -> Result<Vec<PathPoint>, FlowError> {
        let speed = self.index_scale * self.index_scale;
        let point = |at: Complex64, z: f64, tau: f64| PathPoint {
            position: start.half.mirrored(DVec3::new(at.re, at.im, z)),
            optical_path: speed * tau,
        };
        let spacing = self.map.scale() / DENSITY;
        if wave_vector.z == 0.0 && !self.is_uneven() {
            // A straight line in virtual space.
            let end = self.advance_from(start, wave_vector, tolerance)?;
            let (from, to) = (start.virtual_position, end.virtual_point.virtual_position);
            let pieces = ((to - from).norm() / spacing).ceil().max(1.0) as u32;
            let tau = end.optical_path / speed;
            return Ok((0..=pieces)
                .map(|k| {
                    let share = f64::from(k) / f64::from(pieces);
                    let zeta = from + (to - from) * share;
                    point(self.map.jet(zeta).f, start.z, tau * share)
                })
                .collect());
        }
        let way = self.waypoints(start, wave_vector, tolerance, spacing)?;
        Ok(way.into_iter().map(|at| point(at.jet.f, at.z, at.tau)).collect())
    }

    /// Points of a ray from its start to its end, no farther apart than `spacing`, cm.
    ///
    /// A ray that grazes a border may meet it by small steps and not by those of
    /// [`Self::advance_from`]: then the points are of the latter.
    fn waypoints(
        &self,
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
        spacing: f64,
    ) -> Result<Vec<Point>, FlowError> {
        let known = self.advance_from(start, wave_vector, tolerance)?;
        let is_same = |way: &Vec<Point>| {
            let last = way.last().map_or(0.0, |end| end.tau);
            (last * self.index_scale * self.index_scale - known.optical_path).abs() < spacing
        };
        let points = |longest| self.points_by_steps(start, wave_vector, tolerance, longest);
        match points(Some(spacing)).ok().filter(is_same) {
            Some(way) => Ok(way),
            None => points(None),
        }
    }

    /// The same by steps that are no longer than `longest`, cm.
    fn points_by_steps(
        &self,
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
        longest: Option<f64>,
    ) -> Result<Vec<Point>, FlowError> {
        let mut packet =
            RayPacket::new(self, &[Some((*start, wave_vector)), None, None, None], tolerance);
        if let Some(longest) = longest {
            packet.even_out(self, 0, longest);
        }
        let mut way: Vec<Point> = Vec::new();
        loop {
            if let Some(point) = packet.waypoint(0)
                && way.last().is_none_or(|last| point.tau > last.tau)
            {
                way.push(point);
            }
            if !packet.moves(self) {
                break;
            }
        }
        let end = packet.arrival(0)?.end;
        way.retain(|point| point.tau < end.tau);
        way.push(end);
        Ok(way)
    }
}
