//! Points along a ray, for drawings and for what a pulse takes.

use super::points::Point;
use super::ray_packet::RayPacket;
use super::{ConformalFlow, FlowError, VirtualPoint};
use crate::propagation::PathPoint;
use crate::propagation::group_path::{Integrand, NODES, integral_along};
use glam::DVec3;
use num_complex::Complex64;

/// Points per length over which the map varies.
const DENSITY: f64 = 24.0;

/// The fewest of them between which the way is Hermite's cubic.
const LEAST_DENSITY: f64 = 4.0;

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

    /// How far apart points of a way may be for Hermite's cubic, which is of the fourth order, to follow it to within a
    /// tolerance, cm.
    fn spacing(&self, tolerance: f64) -> f64 {
        let scale = self.map.scale();
        let share = 2.0 * (tolerance / scale).sqrt().sqrt();
        scale * share.clamp(1.0 / DENSITY, 1.0 / LEAST_DENSITY)
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

    /// The speed of light times the time that a pulse takes on the way of [`Self::advance_from`],
    /// cm, to within about `tolerance` (cm), at the least dispersion that causality allows: the
    /// group index is n or 1/n, whichever is larger.
    ///
    /// # Errors
    ///
    /// As [`Self::advance_from`].
    pub fn causal_group_path(
        &self,
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
    ) -> Result<f64, FlowError> {
        let speed = self.index_scale * self.index_scale;
        let over = |ways: &dyn Fn(f64) -> (Complex64, f64), tolerance: f64| {
            let panel = |shares: [f64; NODES]| {
                let points = shares.map(ways);
                let ratio = |(zeta, _): (Complex64, f64)| {
                    self.index_at(&self.map.jet(zeta)).powi(-2).max(1.0)
                };
                (points.map(ratio), points.map(|(_, tau)| speed * tau))
            };
            let sides = |share: f64| u8::from(self.index_at(&self.map.jet(ways(share).0)) > 1.0);
            integral_along(&Integrand { panel: &panel, sides: &sides }, tolerance)
        };
        if wave_vector.z == 0.0 && !self.is_uneven() {
            let end = self.advance_from(start, wave_vector, tolerance)?;
            let (from, to) = (start.virtual_position, end.virtual_point.virtual_position);
            let tau = end.optical_path / speed;
            return Ok(over(&|share| (from + (to - from) * share, tau * share), tolerance));
        }
        let way = self.waypoints(start, wave_vector, tolerance, self.spacing(tolerance))?;
        let pieces = way.len() as f64;
        let piece = |ends: &[Point]| {
            // Hermite's cubic; the way is nearly straight.
            let ([a, b], time) = ([&ends[0], &ends[1]], ends[1].tau - ends[0].tau);
            let at = |s: f64| {
                let (over, left) = (s * s * (3.0 - 2.0 * s), 1.0 - s);
                let bend = (a.momentum * left - b.momentum * s) * (s * left * time);
                (a.zeta + (b.zeta - a.zeta) * over + bend, a.tau + time * s)
            };
            over(&at, tolerance / pieces)
        };
        Ok(way.windows(2).map(piece).sum())
    }
}
