use super::*;
use crate::geometry::{Extent, Pose, Solid};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Pseudo-random numbers in [0, 1), the same at each run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    fn pose(&mut self) -> Pose {
        let axis = self.point() + DVec3::Z * 1e-3;
        Pose::with_axis(self.point() * 3.0, TAU * self.next(), axis)
    }
}

fn solid(mesh: &Triangles) -> Polyhedron {
    Polyhedron::new(mesh).expect("a solid")
}

/// A box of the whole size about a point.
fn cuboid(middle: DVec3, size: DVec3) -> Triangles {
    let corner = |k: u32| {
        let side = DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1));
        middle + (side - 0.5) * size
    };
    convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a hull")
}

/// Adds the triangles of another mesh.
fn add(mesh: &mut Triangles, other: &Triangles) {
    let first = mesh.corners.len() as u32;
    mesh.corners.extend(&other.corners);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|corner| corner + first)));
}

/// The same, seen from inside.
fn turned(mesh: &Triangles) -> Triangles {
    let triangles = mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Triangles { triangles, ..mesh.clone() }
}

/// A star: a ring of points, far and near in turn, between two tips. It is not convex.
fn star() -> Triangles {
    let ring = (0..10).map(|k| {
        let (sin, cos) = (TAU * f64::from(k) / 10.0).sin_cos();
        let radius = if k % 2 == 0 { 3.0 } else { 1.2 };
        DVec3::new(radius * cos, radius * sin, 0.0)
    });
    let corners = ring.chain([DVec3::Z * 0.8, DVec3::Z * -0.8]).collect();
    let triangles = (0..10).flat_map(|k| [[k, (k + 1) % 10, 10], [(k + 1) % 10, k, 11]]).collect();
    Triangles { corners, triangles }
}

/// A ball of triangles: an octahedron, its triangles divided some times.
fn ball(divisions: u32) -> Triangles {
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let mut mesh = convex_hull(&axes.collect::<Vec<_>>()).expect("a hull");
    for _ in 0..divisions {
        let mut next = Triangles::default();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize]);
            let middle = |one: DVec3, other: DVec3| (one + other).normalize();
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            for piece in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                let first = next.corners.len() as u32;
                next.corners.extend(piece);
                next.triangles.push([first, first + 1, first + 2]);
            }
        }
        mesh = next;
    }
    mesh
}

fn moved(mesh: &Triangles, place: impl Fn(DVec3) -> DVec3) -> Triangles {
    Triangles { corners: mesh.corners.iter().map(|at| place(*at)).collect(), ..mesh.clone() }
}

/// Goes straight through, entering and leaving in turn, from outside to outside.
fn passes(solid: &Polyhedron, origin: DVec3, direction: DVec3) -> Vec<[f64; 2]> {
    let (mut at, mut gone) = (origin, 0.0);
    let mut within = Vec::new();
    while let Some(entry) = solid.entry(at, direction) {
        at += direction * entry.distance;
        let exit = solid.exit(at, direction);
        let exit = exit.unwrap_or_else(|| panic!("no way out from {at} along {direction}"));
        within.push([gone + entry.distance, gone + entry.distance + exit.distance]);
        gone += entry.distance + exit.distance;
        at += direction * exit.distance;
        assert!(within.len() < 100, "{within:?}");
    }
    within
}

#[test]
fn no_ray_slips_through_even_at_corners_and_edges() {
    let mut numbers = Numbers(1);
    for mesh in [cuboid(DVec3::splat(0.1), DVec3::new(2.0, 1.0, 3.0)), star(), ball(3)] {
        for turn in 0..3 {
            let pose = if turn == 0 { Pose::IDENTITY } else { numbers.pose() };
            let solid = solid(&moved(&mesh, |at| pose.to_world(at)));
            let pieces: Vec<[DVec3; 3]> = solid.pieces().collect();
            for k in 0..4000 {
                let [a, b, c] = pieces[k % pieces.len()];
                let share = numbers.next();
                let target = match k % 4 {
                    0 => a,
                    1 => a.lerp(b, share),
                    2 => a.lerp(b, 0.5),
                    _ => a.lerp(b, share).lerp(c, numbers.next()),
                };
                // From a distance, and so that axes and diagonals are among the directions.
                let direction = match k % 7 {
                    0 => DVec3::AXES[k % 3],
                    1 => DVec3::new(1.0, -1.0, 0.0).normalize(),
                    _ => numbers.point().normalize(),
                };
                let within = passes(&solid, target - direction * 40.0, direction);
                for [from, to] in within {
                    let middle = target + direction * (0.5 * (from + to) - 40.0);
                    // What runs along a face is on the border.
                    let along = k % 7 < 2;
                    assert!(along || to - from < 1e-6 || solid.holds(middle), "{k} {from} {to}");
                }
            }
        }
    }
}

#[test]
fn rays_that_start_on_the_border_know_where_they_are() {
    let mut numbers = Numbers(5);
    for mesh in [cuboid(DVec3::ZERO, DVec3::new(2.0, 1.0, 3.0)), star()] {
        let solid = solid(&mesh);
        let pieces: Vec<[DVec3; 3]> = solid.pieces().collect();
        for k in 0..4000 {
            let [a, b, c] = pieces[k % pieces.len()];
            // On a corner, on an edge, and a hair beside them.
            let off = [0.0, 1e-15, 1e-12, 1e-10][k % 4];
            let on_edge = if k % 2 == 0 { a } else { a.lerp(b, numbers.next()) };
            let start = on_edge + (c - on_edge) * off;
            let direction = numbers.point().normalize();
            let ahead = start + direction * 1e-6;
            let inside = solid.holds(ahead);
            let exit = solid.exit(start, direction);
            let there = exit.unwrap_or_else(|| panic!("no way out {k}"));
            assert!(inside || there.distance < 1e-6 || !solid.is_convex(), "{k} {there:?}");
            if inside {
                assert!(there.distance >= 0.9e-6, "{k} {there:?}");
            }
            let entry = solid.entry(start, direction).map_or(f64::INFINITY, |hit| hit.distance);
            assert_eq!(
                inside,
                entry < 1e-6 && there.distance > 1e-6 || inside && entry > 1e-6,
                "{k}"
            );
        }
    }
}

#[test]
fn rays_along_edges_leave_at_their_ends() {
    let mut numbers = Numbers(9);
    for mesh in [cuboid(DVec3::ZERO, DVec3::new(2.0, 1.0, 3.0)), star()] {
        for _ in 0..200 {
            let pose = numbers.pose();
            let solid = solid(&moved(&mesh, |at| pose.to_world(at)));
            for [a, b] in solid.edges() {
                let direction = (b - a).normalize();
                let hit = solid.exit(a, direction).expect("a way out");
                let end = a.distance(b);
                assert!(hit.distance < 1e-9 || hit.distance > end - 1e-9, "{hit:?} {end}");
            }
        }
    }
}

#[test]
fn a_ball_of_triangles_is_a_ball_in_the_end() {
    let mut last = f64::INFINITY;
    for divisions in 0..6 {
        let solid = solid(&ball(divisions));
        let off = TAU * 2.0 / 3.0 - solid.volume();
        assert!(off > 0.0 && off < 0.6 * last, "{divisions} {off}");
        assert_eq!((solid.is_convex(), solid.face_count()), (true, 8 << (2 * divisions)));
        last = off;
    }
    assert!(last < 0.01);
}

#[test]
fn hulls_hold_their_points_and_planes_bound_what_they_say() {
    let mut numbers = Numbers(11);
    for count in [4, 7, 40, 300] {
        let points: Vec<DVec3> = (0..count).map(|_| numbers.point()).collect();
        let hull = solid(&convex_hull(&points).expect("a hull"));
        assert!(hull.is_convex());
        for plane in hull.planes() {
            assert!(points.iter().all(|at| plane.normal.dot(*at) <= plane.offset + 1e-14));
        }
        let again = solid(
            &within_planes(&hull.planes()[..hull.face_count().min(100)])
                .unwrap_or_else(|_| convex_hull(&points).expect("a hull")),
        );
        if hull.face_count() <= 100 {
            assert!((again.volume() - hull.volume()).abs() < 1e-9 * hull.volume(), "{count}");
        }
    }
    let cube = |offset: f64| -> Vec<Plane> {
        let both = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        both.map(|normal| Plane { normal, offset }).collect()
    };
    let within = solid(&within_planes(&cube(1.5)).expect("a cube"));
    assert!((within.volume() - 27.0).abs() < 1e-12 && within.face_count() == 6);
    assert_eq!(within_planes(&cube(1.5)[1..]), Err(PlanesFault::Endless));
    assert_eq!(within_planes(&cube(-1.0)), Err(PlanesFault::Empty));
    assert_eq!(convex_hull(&[DVec3::X, DVec3::Y, DVec3::ZERO, DVec3::ONE.with_z(0.0)]), None);
}

#[test]
fn what_bounds_no_solid_is_told() {
    let whole = cuboid(DVec3::ZERO, DVec3::ONE);
    let fault = |change: &dyn Fn(&mut Triangles)| {
        let mut mesh = whole.clone();
        change(&mut mesh);
        Polyhedron::new(&mesh).err()
    };
    let small = cuboid(DVec3::splat(0.03), DVec3::splat(0.2));
    // All the wrong way round is no fault.
    assert_eq!(fault(&|mesh| *mesh = turned(mesh)), None);
    // A hollow, and something in it; two apart.
    assert_eq!(fault(&|mesh| add(mesh, &turned(&small))), None);
    assert_eq!(fault(&|mesh| add(mesh, &moved(&small, |at| at + 3.0))), None);
    let open = fault(&|mesh| {
        mesh.triangles.pop();
    });
    assert!(matches!(open, Some(MeshFault::Open { count: 3, .. })), "{open:?}");
    let branching = fault(&|mesh| {
        mesh.corners.push(DVec3::splat(4.0));
        let [a, b, _] = mesh.triangles[0];
        mesh.triangles.push([a, b, mesh.corners.len() as u32 - 1]);
        mesh.triangles.push([b, a, mesh.corners.len() as u32 - 1]);
    });
    assert!(matches!(branching, Some(MeshFault::Branching { count: 4, .. })), "{branching:?}");
    let twisted = fault(&|mesh| mesh.triangles[3].swap(0, 1));
    assert!(matches!(twisted, Some(MeshFault::Turned { .. })), "{twisted:?}");
    let crossing = fault(&|mesh| add(mesh, &moved(&whole, |at| at + DVec3::new(0.31, 0.47, 0.53))));
    assert!(matches!(crossing, Some(MeshFault::Crossing(_))), "{crossing:?}");
    let nested = fault(&|mesh| add(mesh, &small));
    assert!(matches!(nested, Some(MeshFault::Shell { inside: true, .. })), "{nested:?}");
    let beside = fault(&|mesh| add(mesh, &turned(&moved(&small, |at| at + 3.0))));
    assert!(matches!(beside, Some(MeshFault::Shell { inside: false, .. })), "{beside:?}");
    let nowhere = fault(&|mesh| mesh.corners[0].x = f64::NAN);
    assert!(matches!(nowhere, Some(MeshFault::NoPoint(_))), "{nowhere:?}");
    assert_eq!(fault(&|mesh| mesh.triangles.truncate(3)), Some(MeshFault::TooFew(3)));
    let flat = fault(&|mesh| mesh.corners.iter_mut().for_each(|at| at.z = 0.0));
    assert!(flat.is_some(), "{flat:?}");
    for fault in [open, branching, twisted, crossing, nested, beside].into_iter().flatten() {
        assert!(fault.to_string().contains('('), "{fault}");
    }
}

/// Where edges meet edges, and faces lie in the planes of others, parts cross as well.
#[test]
fn parts_that_overlap_are_refused_however_they_lie() {
    let cube = cuboid(DVec3::ZERO, DVec3::splat(6.0));
    for number in 0..11 * 11 * 11 {
        let shift = DVec3::from_array([1, 11, 121].map(|n| f64::from(number / n % 11 - 5)));
        let mut both = cube.clone();
        add(&mut both, &moved(&cube, |at| at + shift));
        assert!(Polyhedron::new(&both).is_err(), "{shift}");
    }
    // What only touches is taken.
    for shift in [DVec3::new(6.0, 1.0, 2.0), DVec3::new(-6.0, 3.0, 3.0), DVec3::new(1.0, 6.0, -5.0)]
    {
        let mut both = cube.clone();
        add(&mut both, &moved(&cube, |at| at + shift));
        let solid = Polyhedron::new(&both).expect("it touches");
        assert!((solid.volume() - 432.0).abs() < 1e-9);
    }
    // Two tetrahedra in the corners of a cube: all corners are outside of the other, and edges cross edges in their
    // middles.
    let corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
    let corners = corners.map(|at| DVec3::from_array(at.map(f64::from))).to_vec();
    let one = Triangles { corners, triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] };
    let mut both = one.clone();
    add(&mut both, &turned(&moved(&one, |at| -at)));
    let crossing = Polyhedron::new(&both).err();
    assert!(matches!(crossing, Some(MeshFault::Crossing(_))), "{crossing:?}");
}

/// Whatever the order of the triangles, and wherever a hollow is.
#[test]
fn hollows_are_taken() {
    let mut numbers = Numbers(11);
    for _ in 0..60 {
        let mut mesh = cuboid(DVec3::ZERO, DVec3::splat(2.0));
        let turn = numbers.pose();
        let (middle, size) = (numbers.point() * 0.4, 0.2 + 0.5 * numbers.next());
        let inner = cuboid(DVec3::ZERO, DVec3::splat(size));
        let inner = moved(&inner, |at| middle + turn.rotation() * at);
        add(&mut mesh, &turned(&inner));
        for last in (1..mesh.triangles.len()).rev() {
            mesh.triangles.swap(last, (numbers.next() * (last as f64 + 1.0)) as usize);
        }
        let solid = Polyhedron::new(&mesh).expect("a hollow cube");
        assert!((solid.volume() - (8.0 - size.powi(3))).abs() < 1e-9);
        assert!(!solid.holds(middle) && solid.holds(DVec3::splat(0.99)));
    }
}

#[test]
fn polyhedra_are_in_the_way_as_what_they_are_made_of_is() {
    let of =
        |mesh: &Triangles, pose: Pose| Solid::Polyhedron { solid: Arc::new(solid(mesh)), pose };
    let at = |x: f64, y: f64, z: f64| Pose::new(DVec3::new(x, y, z), 0.3);
    let slack = 1e-9;
    let cube = cuboid(DVec3::ZERO, DVec3::splat(2.0));
    let outline = Outline::rectangle(1.0, 1.0);
    let prism = Solid::Prism { outline, extent: Extent { min: -1.0, max: 1.0 } };
    let mut numbers = Numbers(3);
    let mut both = [0, 0];
    for _ in 0..60 {
        let (one, other) = (numbers.pose(), numbers.pose());
        let expected = prism.placed(&one).overlaps(&prism.placed(&other), slack);
        both[usize::from(expected)] += 1;
        assert_eq!(of(&cube, one).overlaps(&of(&cube, other), slack), expected);
        assert_eq!(of(&cube, one).overlaps(&prism.placed(&other), slack), expected);
        assert_eq!(prism.placed(&one).overlaps(&of(&cube, other), slack), expected);
        // A dented one, of which only the hull is a cube.
        let ball = Solid::ball(0.9).placed(&other);
        let plain = prism.placed(&one).overlaps(&ball, slack);
        assert_eq!(of(&cube, one).overlaps(&ball, slack), plain);
    }
    assert!(both[0] > 5 && both[1] > 5, "{both:?}");
    // Between the arms of a star there is room.
    let pole = |x: f64| Solid::ball(0.4).placed(&at(x, 0.0, 0.0));
    let turned = Pose::new(DVec3::ZERO, TAU / 10.0);
    let star = star();
    assert!(!of(&star, turned).overlaps(&pole(2.5), slack));
    assert!(of(&star, Pose::IDENTITY).overlaps(&pole(2.5), slack));
    assert!(of(&star, turned).overlaps(&pole(1.4), slack));
    let mirror = |y: f64| Solid::Prism {
        outline: Outline { corners: vec![DVec2::new(-9.0, y), DVec2::new(9.0, y)] },
        extent: Extent { min: -9.0, max: 9.0 },
    };
    for mesh in [&star, &cube] {
        let [low, _] = solid(mesh).bounds();
        assert!(!of(mesh, Pose::IDENTITY).overlaps(&mirror(low.y), slack));
        assert!(of(mesh, Pose::IDENTITY).overlaps(&mirror(low.y + 0.1), slack));
    }
    assert!(of(&star, Pose::IDENTITY).is_within(&Solid::ball(3.1)));
    assert!(!of(&star, Pose::IDENTITY).is_within(&Solid::ball(2.9)));
    // One in the hollow of another.
    let small = cuboid(DVec3::ZERO, DVec3::splat(0.5));
    let mut hollow = cube.clone();
    hollow.corners.extend(small.corners.iter().map(|at| *at * 2.0));
    let first = cube.corners.len() as u32;
    hollow
        .triangles
        .extend(small.triangles.iter().map(|[a, b, c]| [*a + first, *c + first, *b + first]));
    assert!(!of(&hollow, Pose::IDENTITY).overlaps(&of(&small, at(0.1, 0.0, 0.0)), slack));
    assert!(of(&hollow, Pose::IDENTITY).overlaps(&of(&small, at(0.4, 0.0, 0.0)), slack));
    assert!(of(&cube, Pose::IDENTITY).overlaps(&of(&small, at(0.1, 0.0, 0.0)), slack));
}

#[test]
fn sections_and_edges_are_those_of_the_faces() {
    let cube = solid(&cuboid(DVec3::ZERO, DVec3::new(2.0, 4.0, 6.0)));
    assert_eq!((cube.edges().len(), cube.face_count()), (12, 6));
    let length: f64 = cube.section().iter().map(|[a, b]| a.distance(*b)).sum();
    assert!((length - 12.0).abs() < 1e-12, "{length}");
    assert!((cube.thickness() - 2.0).abs() < 1e-12);
    // Cut through corners.
    let low = solid(&cuboid(DVec3::Z * 3.0, DVec3::new(2.0, 4.0, 6.0)));
    assert!((low.section().iter().map(|[a, b]| a.distance(*b)).sum::<f64>() - 12.0).abs() < 1e-12);
}
