//! Whether a lens and something else are in each other's way.

use super::convex::{Bound, Bounded, bounded};
use super::lens::greatest_between;
use super::{ConicFace, Lens, Pose, Solid};
use glam::{DMat3, DVec3};

/// Axes that are no farther apart than this, in direction and in place (cm), are one but for
/// rounding.
const SAME_LINE: f64 = 1e-10;

/// How many planes that touch a hollow face are looked behind, along r and around.
const RINGS: u32 = 40;
const TURNS: u32 = 48;

/// The same where several hollow faces matter at once.
const FEW: u32 = 12;

impl Lens {
    /// Bounds of its convex hull at a place, and an ellipsoid around it.
    pub(super) fn bounded(&self, pose: &Pose) -> Bounded {
        let [low, high] = self.ends();
        let axis = pose.vector_to_world(DVec3::X);
        let mut bounds = vec![Bound::Tube { point: pose.origin, axis, radius: self.radius }];
        let seen = [(self.front, *pose), (self.back.mirrored(), pose.after(&turned()))];
        for (face, pose) in seen {
            bounds.push(if face.curvature < 0.0 {
                let normal = pose.vector_to_world(DVec3::NEG_X);
                let offset = normal.dot(pose.origin) - face.x_at(self.radius);
                Bound::Plane { normal, offset }
            } else {
                Bound::Behind { face, radius: self.radius, pose }
            });
        }
        let half = DVec3::new(0.5 * (high - low), self.radius, self.radius) * 2f64.sqrt();
        let middle = pose.to_world(DVec3::X * 0.5 * (low + high));
        Bounded { bounds, ellipsoid: (middle, pose.rotation() * DMat3::from_diagonal(half)) }
    }

    /// Its hollow faces at a place.
    fn hollows(&self, pose: &Pose) -> Vec<Hollow> {
        let seen = [(self.front, *pose), (self.back.mirrored(), pose.after(&turned()))];
        let hollow = seen.into_iter().filter(|(face, _)| face.curvature < 0.0);
        hollow.map(|(face, pose)| Hollow { face, radius: self.radius, pose }).collect()
    }
}

/// The frame of a lens seen from its back: turned by 180 degrees about z.
fn turned() -> Pose {
    Pose::from_rotation(DVec3::ZERO, DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0)))
}

/// A hollow face (c < 0) with the lens at larger x of its frame.
struct Hollow {
    face: ConicFace,
    radius: f64,
    pose: Pose,
}

impl Hollow {
    /// Bounds of the space in it that the convex hull of the lens holds and the lens does not.
    fn space(&self) -> Vec<Bound> {
        let Self { face, radius, pose } = *self;
        let normal = pose.vector_to_world(DVec3::NEG_X);
        let offset = normal.dot(pose.origin) - face.x_at(radius);
        let pose = pose.after(&turned());
        vec![Bound::Plane { normal, offset }, Bound::Behind { face: face.mirrored(), radius, pose }]
    }

    /// Planes that touch it, each as the bound on what lies on the side of the lens.
    fn touching(&self, rings: u32, turns: u32) -> Vec<Bound> {
        let plane = |ring: u32, turn: u32| {
            let r = self.radius * f64::from(ring) / f64::from(rings);
            let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / f64::from(turns)).sin_cos();
            let at = DVec3::new(self.face.x_at(r), r * cos, r * sin);
            let normal = -self.pose.vector_to_world(self.face.normal(at));
            Bound::Plane { normal, offset: normal.dot(self.pose.to_world(at)) }
        };
        let around = (1..=rings).flat_map(|ring| (0..turns).map(move |turn| plane(ring, turn)));
        std::iter::once(plane(0, 0)).chain(around).collect()
    }
}

/// Whether a lens at a place and another solid, no hollow one, press into each other by more than
/// `slack` (cm).
///
/// About one axis that is known from their profiles. Elsewhere their convex hulls are asked, and
/// where the other reaches into the hollow of a face, what lies behind planes that touch the face: each
/// cuts a convex piece from the lens, and all of them together are the lens. There, what presses into
/// the face by less than some thousandths of its radius may pass.
pub(super) fn overlaps(lens: &Lens, pose: &Pose, other: &Solid, slack: f64) -> bool {
    if let Some((radius, between)) = profile(&other.placed(&pose.inverse())) {
        let both = |r: f64| {
            let ([low, high], [from, to]) = (lens.between(r), between(r));
            high.min(to) - low.max(from)
        };
        let radius = lens.radius.min(radius) - slack;
        return radius > 0.0 && greatest_between(radius, both) > slack;
    }
    let own = lens.bounded(pose);
    let Some(second) = bounded(other, slack) else { return false };
    if !own.presses(&second, &[], slack) {
        return false;
    }
    let reached = |hollows: Vec<Hollow>, by: &Bounded, of: &Bounded| {
        let reached = |hollow: &Hollow| of.presses(by, &hollow.space(), slack);
        hollows.into_iter().filter(reached).collect::<Vec<_>>()
    };
    let mut hollows = reached(lens.hollows(pose), &second, &own);
    if let Solid::Lens { lens, pose } = other {
        hollows.extend(reached(lens.hollows(pose), &own, &second));
    }
    let [rings, turns] = if hollows.len() > 1 { [FEW / 2, FEW] } else { [RINGS, TURNS] };
    let planes: Vec<Vec<Bound>> =
        hollows.iter().map(|hollow| hollow.touching(rings, turns)).collect();
    let mut pieces: Vec<Vec<Bound>> = vec![Vec::new()];
    for planes in &planes {
        let with = |piece: &Vec<Bound>| {
            let piece = piece.clone();
            planes.iter().map(move |plane| [&piece[..], &[*plane]].concat())
        };
        // A piece that is free already is so with more bounds.
        pieces.retain(|piece| own.presses(&second, piece, slack));
        pieces = pieces.iter().flat_map(with).collect();
    }
    pieces.iter().any(|piece| own.presses(&second, piece, slack))
}

/// From where to where something round about the x axis reaches at each distance from it, and how far
/// from it; `None` if it is not round about that axis.
type Profile = (f64, Box<dyn Fn(f64) -> [f64; 2]>);

fn profile(solid: &Solid) -> Option<Profile> {
    let centred = |point: DVec3| point.y.hypot(point.z) <= SAME_LINE;
    match solid {
        Solid::Ball { centre, radius } if centred(*centre) => {
            let (x, radius) = (centre.x, *radius);
            let half = move |r: f64| ((radius - r) * (radius + r)).max(0.0).sqrt();
            Some((radius, Box::new(move |r| [x - half(r), x + half(r)])))
        }
        Solid::Tilted { solid, pose } => {
            let Solid::Cylinder { centre, radius, extent } = **solid else { return None };
            let (point, axis) = (pose.to_world(centre.extend(0.0)), pose.axis());
            if !centred(point) || !centred(axis) {
                return None;
            }
            let mut ends = [extent.min, extent.max].map(|z| point.x + axis.x.signum() * z);
            ends.sort_by(f64::total_cmp);
            Some((radius, Box::new(move |_| ends)))
        }
        Solid::Lens { lens, pose } => {
            let (lens, x, along) = (*lens, pose.origin.x, pose.vector_to_world(DVec3::X));
            if !centred(pose.origin) || !centred(along) {
                return None;
            }
            let between = move |r: f64| {
                let [low, high] = lens.between(r);
                if along.x > 0.0 { [x + low, x + high] } else { [x - high, x - low] }
            };
            Some((lens.radius, Box::new(between)))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests;
