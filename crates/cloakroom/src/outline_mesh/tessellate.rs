//! Solids as triangles.

use glam::{DVec2, DVec3};
use optics::geometry::{
    CutBall, Extent, Hole, Lens, Outline, Polygon, Solid, Sphere, Triangles, convex_hull,
};
use std::f64::consts::TAU;

/// Pieces around what is round.
const AROUND: u32 = 96;

type Pieces = Vec<[DVec3; 3]>;

/// The surface of a solid, seen from outside; of a thin sheet both sides.
pub(super) fn solid(solid: &Solid) -> Pieces {
    match solid {
        Solid::Nothing => Vec::new(),
        Solid::Prism { outline, extent } => prism(&outline.corners, ends(extent)),
        Solid::Cylinder { centre, radius, extent } => {
            let circle = circle(*radius).into_iter().map(|at| at + *centre);
            prism(&circle.collect::<Vec<_>>(), ends(extent))
        }
        Solid::Ball { centre, radius } => moved(ball(*radius), |at| at + *centre),
        Solid::CutBall { centre, ball } => moved(cut_ball(ball), |at| at + *centre),
        Solid::Hollow { whole, hole } => {
            let shell = match hole.as_ref() {
                Hole::Round(hole) => self::solid(hole),
                Hole::Lens { curve, pose, extent } => {
                    let outline = Polygon::new(&curve.outline(AROUND));
                    let shell = outline.map(|outline| drawn_out(&outline, ends(extent)));
                    moved(shell.unwrap_or_default(), |at| pose.to_world(at))
                }
            };
            let turned = shell.into_iter().map(|[a, b, c]| [a, c, b]);
            self::solid(whole).into_iter().chain(turned).collect()
        }
        Solid::Lens { lens, pose } => moved(of_lens(lens), |at| pose.to_world(at)),
        Solid::Polyhedron { solid, pose } => {
            moved(solid.pieces().collect(), |at| pose.to_world(at))
        }
        Solid::Tilted { solid, pose } => moved(self::solid(solid), |at| pose.to_world(at)),
    }
}

/// A polygon drawn out along z.
pub(super) fn drawn_out(polygon: &Polygon, [low, high]: [f64; 2]) -> Pieces {
    let mut pieces = sides(polygon.corners(), [low, high]);
    for part in polygon.convex_parts() {
        let Outline { corners } = polygon.outline(&part);
        pieces.extend(caps(&corners, [low, high]));
    }
    pieces
}

fn ends(extent: &Extent) -> [f64; 2] {
    [extent.min, extent.max]
}

fn moved(pieces: Pieces, place: impl Fn(DVec3) -> DVec3) -> Pieces {
    pieces.into_iter().map(|piece| piece.map(&place)).collect()
}

fn circle(radius: f64) -> Vec<DVec2> {
    (0..AROUND)
        .map(|k| radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(AROUND)))
        .collect()
}

/// The sides of a polygon, counterclockwise; of two corners both sides of a sheet.
fn sides(corners: &[DVec2], [low, high]: [f64; 2]) -> Pieces {
    let next = corners.iter().cycle().skip(1);
    let side = |(a, b): (&DVec2, &DVec2)| {
        let [a, b, c, d] = [a.extend(low), b.extend(low), b.extend(high), a.extend(high)];
        [[a, b, c], [a, c, d]]
    };
    corners.iter().zip(next).flat_map(side).collect()
}

/// Both ends of a convex polygon.
fn caps(corners: &[DVec2], [low, high]: [f64; 2]) -> Pieces {
    let fan = (1..corners.len().saturating_sub(1)).flat_map(|i| {
        let [a, b, c] = [corners[0], corners[i], corners[i + 1]];
        [
            [a.extend(low), c.extend(low), b.extend(low)],
            [a.extend(high), b.extend(high), c.extend(high)],
        ]
    });
    fan.collect()
}

fn prism(corners: &[DVec2], ends: [f64; 2]) -> Pieces {
    [sides(corners, ends), caps(corners, ends)].concat()
}

fn pieces(mesh: &Triangles) -> Pieces {
    let at = |corner: u32| mesh.corners[corner as usize];
    mesh.triangles.iter().map(|triangle| triangle.map(at)).collect()
}

/// A ball: an octahedron of which each side of a triangle is halved, and halved again.
fn ball(radius: f64) -> Pieces {
    let both = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]).collect::<Vec<_>>();
    let mut ball = convex_hull(&both).map(|mesh| pieces(&mesh)).unwrap_or_default();
    for _ in 0..5 {
        let divided = |[a, b, c]: [DVec3; 3]| {
            let middle = |one: DVec3, other: DVec3| (one + other).normalize();
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        ball = ball.into_iter().flat_map(divided).collect();
    }
    moved(ball, |at| at * radius)
}

/// What a plane has left of a ball: rings around its normal.
fn cut_ball(ball: &CutBall) -> Pieces {
    let Sphere { radius } = ball.sphere;
    let axis = ball.plane.normal;
    // From the far pole to the rim, and to the middle of the cut.
    let rim = (ball.plane.offset / radius).clamp(-1.0, 1.0).acos();
    let rings = AROUND / 2;
    let profile = (0..=rings).map(|k| {
        let angle =
            std::f64::consts::PI - (std::f64::consts::PI - rim) * f64::from(k) / f64::from(rings);
        [radius * angle.cos(), radius * angle.sin()]
    });
    let profile: Vec<[f64; 2]> = profile.chain([[ball.plane.offset, 0.0]]).collect();
    turned(&profile, axis)
}

fn of_lens(lens: &Lens) -> Pieces {
    let front = lens.face_line(&lens.front, AROUND);
    let back = lens.face_line(&lens.back, AROUND);
    // Lines from rim to rim: half of each is a profile.
    let half = |line: Vec<[f64; 2]>| {
        let mut half: Vec<[f64; 2]> = line.into_iter().filter(|[_, r]| *r >= 0.0).collect();
        half.sort_by(|a, b| a[1].total_cmp(&b[1]));
        half
    };
    let (front, mut back) = (half(front), half(back));
    back.reverse();
    turned(&[front, back].concat(), DVec3::X)
}

/// A profile, [along, off the axis] each, turned about an axis through the origin; it starts and ends on
/// the axis, first at the lower end.
fn turned(profile: &[[f64; 2]], axis: DVec3) -> Pieces {
    let (u, v) = axis.any_orthonormal_pair();
    let at = |[along, off]: [f64; 2], k: u32| {
        let (sin, cos) = (TAU * f64::from(k % AROUND) / f64::from(AROUND)).sin_cos();
        axis * along + (u * cos + v * sin) * off
    };
    let mut pieces = Vec::new();
    for pair in profile.windows(2) {
        let on_axis = pair.iter().map(|[_, off]| off.abs() < 1e-12).collect::<Vec<_>>();
        for k in 0..AROUND {
            let [a, b] = [at(pair[0], k), at(pair[0], k + 1)];
            let [c, d] = [at(pair[1], k + 1), at(pair[1], k)];
            if !on_axis[0] {
                pieces.push([a, b, c]);
            }
            if !on_axis[1] {
                pieces.push([a, c, d]);
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use optics::geometry::{ConicFace, Plane, Polyhedron, Pose};

    /// Each is a closed surface, of about the volume that it has.
    #[test]
    fn solids_become_closed_surfaces() {
        let extent = Extent { min: -2.0, max: 3.0 };
        let face = |apex: f64, curvature: f64| ConicFace { apex, curvature, conic: 0.0 };
        let lens = Lens { radius: 4.0, front: face(-1.5, 0.1), back: face(1.5, 0.05) };
        let plane = Plane { normal: DVec3::new(0.6, 0.0, 0.8), offset: 0.0 };
        let ball = CutBall { sphere: Sphere { radius: 3.0 }, plane };
        let centre = DVec3::new(1.0, -2.0, 0.5);
        let third = TAU * 2.0 / 3.0;
        let solids = [
            (Solid::cylinder(2.0, extent), TAU * 10.0),
            (Solid::Prism { outline: Outline::rectangle(1.0, 2.0), extent }, 40.0),
            (Solid::ball(3.0), third * 27.0),
            (Solid::CutBall { centre, ball }, third * 27.0 / 2.0),
            (Solid::ball(3.0).with_hole(Hole::Round(Solid::ball(1.0))), third * 26.0),
            (Solid::Lens { lens, pose: Pose::new(centre, 1.0) }, f64::NAN),
        ];
        for (solid, volume) in solids {
            let pieces = super::solid(&solid);
            let corners: Vec<DVec3> = pieces.concat();
            // Corners that rounding has parted are one.
            let corners = corners.iter().map(|at| (*at * 1e9).round() / 1e9).collect();
            let triangles =
                (0..pieces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = Polyhedron::new(&Triangles { corners, triangles });
            let mesh = mesh.unwrap_or_else(|fault| panic!("{solid:?}: {fault}"));
            // Seen from outside.
            let signed: f64 = pieces.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum();
            assert!((signed / mesh.volume() - 1.0).abs() < 1e-6, "{solid:?} {signed}");
            let off = mesh.volume() / volume - 1.0;
            assert!(volume.is_nan() || (-5e-3..=1e-9).contains(&off), "{solid:?} {off}");
        }
    }
}
