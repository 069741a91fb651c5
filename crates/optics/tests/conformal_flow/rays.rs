//! Rays to try, always the same ones.

use glam::{DMat3, DVec3};
use optics::geometry::Extent;
use optics::propagation::{Boundary, ConformalEnd, ConformalFlow, Half, VirtualPoint};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

pub const W: f64 = 10.02;
pub const H: f64 = 4.25;
pub const CUT: Truncation = Truncation { x_min: -25.0, x_max: 25.0, y_max: 28.57 };

pub fn flow(extent: Extent, index_scale: f64) -> ConformalFlow {
    let map = GaussianMap::new(W, H).expect("a valid map");
    ConformalFlow::new(ConformalMap::Gaussian(map), CUT, extent, index_scale)
}

/// Numbers from 0 to 1, always the same (xorshift).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.roll()
    }

    /// A start on one of the faces or on the floor, and a wave vector that goes inwards from there.
    pub fn enter(&mut self, flow: &ConformalFlow, extent: Extent) -> (VirtualPoint, DVec3) {
        let half = if self.roll() < 0.5 { Half::Upper } else { Half::Lower };
        let side = if half == Half::Upper { 1.0 } else { -1.0 };
        let (mut x, mut z) = (self.between(CUT.x_min, CUT.x_max), self.between(-8.0, 8.0));
        let share = self.roll();
        let faces = if extent == Extent::ENDLESS { 4.0 } else { 6.0 };
        let face = (faces * self.roll()) as u32;
        match face {
            0 => x = CUT.x_min,
            1 => x = CUT.x_max,
            4 => z = extent.min,
            5 => z = extent.max,
            _ => {}
        }
        let low = flow.map().floor_height_at(x);
        let y = match face {
            2 => CUT.y_max,
            3 => low,
            _ => low + share * (CUT.y_max - low),
        };
        let start =
            flow.virtual_point(half, DVec3::new(x, side * y, z)).expect("a point of the border");
        let slope = flow.map().jet(start.virtual_position).f1;
        let inward = match face {
            0 => DVec3::X,
            1 => DVec3::NEG_X,
            2 => DVec3::new(0.0, -side, 0.0),
            3 => DVec3::new(-slope.im, side * slope.re, 0.0).normalize(),
            4 => DVec3::Z,
            _ => DVec3::NEG_Z,
        };
        let (u, v) = inward.any_orthonormal_pair();
        let (angle, sine) = (self.between(0.0, 6.3), self.roll().sqrt());
        let tilt = u * angle.cos() + v * angle.sin();
        let mut direction = inward * (1.0 - sine * sine).sqrt() + sine * tilt;
        if self.roll() < 0.15 && face < 4 {
            direction.z = 0.0;
        }
        (start, start.index * direction.normalize())
    }
}

/// The legs of a ray from mirror to mirror until it leaves.
pub fn legs(
    flow: &ConformalFlow,
    (start, wave_vector): (VirtualPoint, DVec3),
    tolerance: f64,
) -> Vec<(VirtualPoint, DVec3, ConformalEnd)> {
    let (mut at, mut p, mut legs) = (start, wave_vector, Vec::new());
    for _ in 0..4 {
        let end = flow.advance_from(&at, p, tolerance).expect("the ray gets through");
        legs.push((at, p, end));
        if end.surface != Boundary::Floor {
            break;
        }
        at = end.virtual_point;
        p = end.wave_vector - 2.0 * end.wave_vector.dot(end.outward) * end.outward;
    }
    legs
}

/// The rotation of the transport from start to end, without what keeps the power.
pub fn turn(start: &VirtualPoint, end: &ConformalEnd) -> DMat3 {
    end.transport * (end.virtual_point.index / start.index).sqrt()
}

/// The sine of the angle between a ray and the face it arrives at.
pub fn steepness(end: &ConformalEnd) -> f64 {
    end.wave_vector.normalize().dot(end.outward)
}
