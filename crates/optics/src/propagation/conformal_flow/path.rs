//! Points along a ray, for drawings.

use super::ray_packet::RayPacket;
use super::{ConformalFlow, FlowError, VirtualPoint};
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
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
    ) -> Result<Vec<PathPoint>, FlowError> {
        let half = start.half;
        let speed = self.index_scale * self.index_scale;
        let point = |at: Complex64, z: f64, tau: f64| PathPoint {
            position: half.mirrored(DVec3::new(at.re, at.im, z)),
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
        let mut packet =
            RayPacket::new(self, &[Some((*start, wave_vector)), None, None, None], tolerance);
        packet.even_out(self, 0, spacing);
        let mut way = Vec::new();
        let mut last = -1.0;
        loop {
            if let Some((at, z, tau)) = packet.waypoint(0)
                && tau > last
            {
                way.push((at, z, tau));
                last = tau;
            }
            if !packet.moves(self) {
                break;
            }
        }
        let end = packet.arrival(0)?.end;
        way.retain(|(_, _, tau)| *tau < end.tau);
        way.push((end.jet.f, end.z, end.tau));
        Ok(way.into_iter().map(|(at, z, tau)| point(at, z, tau)).collect())
    }
}
