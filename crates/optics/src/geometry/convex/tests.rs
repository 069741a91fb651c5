#[path = "../../../tests/long.rs"]
mod long;

use super::super::{Hole, TOUCHING};
use super::*;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

fn cuboid(half: DVec3) -> Solid {
    let extent = Extent { min: -half.z, max: half.z };
    Solid::Prism { outline: Outline::rectangle(half.x, half.y), extent }
}

fn poses() -> impl Strategy<Value = Pose> {
    let vector = || prop::array::uniform3(-3.0..3.0).prop_map(DVec3::from_array);
    (vector(), -PI..PI, vector())
        .prop_map(|(origin, rotation, axis)| Pose::with_axis(origin, rotation, axis))
}

/// Sheets, prisms and cylinders, endless ones among them, and balls.
fn solids() -> impl Strategy<Value = Solid> {
    let extent = || {
        prop_oneof![
            3 => (0.3..4.0).prop_map(|length| Extent::centred(Some(length))),
            1 => Just(Extent::ENDLESS),
        ]
    };
    let corner = || prop::array::uniform2(-2.0..2.0).prop_map(DVec2::from_array);
    let prism = (prop::collection::vec(corner(), 2..8), extent())
        .prop_map(|(points, extent)| Solid::Prism { outline: Outline::hull(points), extent });
    let cylinder = (corner(), 0.3..2.0, extent())
        .prop_map(|(centre, radius, extent)| Solid::Cylinder { centre, radius, extent });
    let ball = (corner(), 0.3..2.0)
        .prop_map(|(at, radius)| Solid::Ball { centre: at.extend(0.2), radius });
    prop_oneof![4 => prism, 3 => cylinder, 1 => ball]
}

fn moved(solid: &Solid, by: DVec3) -> Solid {
    solid.placed(&Pose::new(by, 0.0))
}

/// How far a solid reaches along a unit vector, from the definition.
fn support(solid: &Solid, direction: DVec3) -> f64 {
    match solid {
        Solid::Ball { centre, radius } => direction.dot(*centre) + radius,
        other => Convex::of(other).expect("convex").support(direction),
    }
}

/// The directions of the edges of a prism, and of the axis of a prism or a cylinder.
fn edges(solid: &Solid) -> Vec<DVec3> {
    let Some(convex) = Convex::of(solid) else { return Vec::new() };
    let mut edges = vec![convex.pose.axis()];
    if let Section::Outline(outline) = convex.section {
        let side = |(a, b): (DVec2, DVec2)| convex.pose.vector_to_world((b - a).extend(0.0));
        edges.extend(outline.sides().map(side));
    }
    edges
}

/// How far one must be moved along a unit vector until the other is free: the least over all
/// directions of how far the planes across them must go. Of prisms these planes lie along two
/// edges; else they are searched for, and what is found is at least the true distance.
fn way_out(a: &Solid, b: &Solid, towards: DVec3) -> f64 {
    let needed = |direction: DVec3| {
        let share = direction.dot(towards);
        let press = support(a, direction) + support(b, -direction);
        if share > 1e-9 && press.is_finite() { press / share } else { f64::INFINITY }
    };
    // Endless ones part only across their axes.
    let axes: Vec<DVec3> = [a, b]
        .into_iter()
        .filter_map(Convex::of)
        .filter(|convex| !convex.extent.min.is_finite())
        .map(|convex| convex.pose.axis())
        .collect();
    let allowed = |direction: DVec3| match axes[..] {
        [] => direction.normalize_or_zero(),
        [axis] => direction.reject_from_normalized(axis).normalize_or_zero(),
        [one, other, ..] => {
            let both = one.cross(other).normalize_or_zero();
            both * both.dot(towards).signum()
        }
    };
    let golden = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 800.0;
        let beside = DVec2::from_angle(2.399_963_229_728_653 * f64::from(k));
        (beside * (1.0 - z * z).sqrt()).extend(z)
    };
    let edges = [edges(a), edges(b)].concat();
    let pairs = edges.iter().flat_map(|one| edges.iter().map(|other| one.cross(*other)));
    let along = edges.iter().flat_map(|edge| [*edge, -*edge]);
    let starts = (0..800).map(golden).chain(pairs).chain(along).map(allowed);
    let mut best = (f64::INFINITY, DVec3::ZERO);
    let mut few: Vec<(f64, DVec3)> = starts.map(|n| (needed(n), n)).collect();
    few.sort_by(|x, y| x.0.total_cmp(&y.0));
    for (mut least, mut direction) in few.into_iter().take(5) {
        let (mut step, mut first) = (0.05, 0.0);
        while step > 1e-12 && least.is_finite() {
            let (x, y) = direction.any_orthonormal_pair();
            // Other ways each time: along a narrow ridge few of them go down.
            first += 2.4;
            let tries = (0..12).map(|k| DVec2::from_angle(first + TAU * f64::from(k) / 12.0));
            let tries = tries.map(|way| allowed(direction + step * (x * way.x + y * way.y)));
            let better = tries.map(|n| (needed(n), n)).min_by(|x, y| x.0.total_cmp(&y.0));
            match better {
                Some(better) if better.0 < least => (least, direction) = better,
                _ => step *= 0.9,
            }
        }
        if least < best.0 {
            best = (least, direction);
        }
    }
    best.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(long::count(10, 32)))]

    #[test]
    fn they_overlap_until_one_has_been_moved_out_of_the_other(
        a in solids(),
        b in solids(),
        pose in poses(),
        other in poses(),
        towards in poses(),
    ) {
        // Two sheets have no common depth, however they cross.
        let sheet = |solid: &Solid| {
            matches!(solid, Solid::Prism { outline, .. } if outline.corners.len() < 3)
        };
        prop_assume!(!sheet(&a) || !sheet(&b));
        let (a, b) = (a.placed(&pose), b.placed(&other));
        let towards = towards.axis();
        let far = way_out(&a, &b, towards);
        // Not in one plane, and not along what is endless.
        prop_assume!((1e-3..50.0).contains(&far));
        // On its way through it may miss the other altogether.
        prop_assume!(far + way_out(&a, &b, -towards) > 2e-3);
        let meet = |way: f64| {
            let b = moved(&b, towards * way);
            let both = [a.overlaps(&b, TOUCHING), b.overlaps(&a, TOUCHING)];
            assert_eq!(both[0], both[1], "{a:?} {b:?}");
            both[0]
        };
        prop_assert!(!meet(far), "{a:?} {b:?} {towards} {far}");
        // What only grazes the other may have been free before, too, and a search ends a little far.
        let most = 1e-3_f64.max(0.03 * far);
        let mut back = (0..16).map(|k| 1e-3 * 1.5f64.powi(k)).filter(|back| *back <= most);
        prop_assert!(back.any(|back| meet(far - back)), "{a:?} {b:?} {towards} {far}");
    }

    #[test]
    fn what_holds_a_common_point_overlaps(
        a in solids(),
        b in solids(),
        pose in poses(),
        other in poses(),
        seed in prop::collection::vec(prop::array::uniform3(-4.0..4.0), 200),
    ) {
        let (a, b) = (a.placed(&pose), b.placed(&other));
        for at in seed {
            let at = DVec3::from_array(at);
            if a.holds(at) && b.holds(at) {
                prop_assert!(a.overlaps(&b, TOUCHING));
            }
            let [low, high] = a.bounds().expect("bounds");
            if a.contains(at) {
                prop_assert!((low - 1e-12).cmple(at).all() && (high + 1e-12).cmpge(at).all());
            }
            if a.is_within(&b) && a.holds(at) {
                prop_assert!(b.contains(at), "{a:?} {b:?} {at}");
            }
        }
    }

    #[test]
    fn sheets_touch_until_one_goes_through_the_other(
        pose in poses(),
        other in poses(),
        at in (-0.9..0.9, -0.9..0.9),
        along in 0.0..1.0_f64,
    ) {
        let sheet = |size: f64| {
            let ends = [-size, size].map(|x| DVec2::new(x, 0.0));
            let outline = Outline { corners: ends.to_vec() };
            Solid::Prism { outline, extent: Extent::centred(Some(2.0 * size)) }
        };
        let (wide, small) = (sheet(2.0).placed(&pose), sheet(0.3));
        let normal = pose.vector_to_world(DVec3::Y);
        let turned = |v: DVec3| other.vector_to_world(v);
        // The corners of the small one as it is turned, by how far they lie from the plane of the
        // wide one.
        let mut corners = [[0.3, 0.3], [0.3, -0.3], [-0.3, 0.3], [-0.3, -0.3]]
            .map(|[x, z]| turned(DVec3::new(x, 0.0, z)));
        corners.sort_by(|a, b| a.dot(normal).total_cmp(&b.dot(normal)));
        let [lowest, .., highest] = corners;
        let depth = (highest - lowest).dot(normal);
        prop_assume!(depth > 1e-6);
        let foot = pose.to_world(DVec3::new(at.0, 0.0, at.1));
        let rotation = DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z));
        let overlap = |deep: f64| {
            let origin = foot - lowest - normal * deep;
            let small = small.placed(&Pose::from_rotation(origin, rotation));
            let both = [wide.overlaps(&small, TOUCHING), small.overlaps(&wide, TOUCHING)];
            assert_eq!(both[0], both[1]);
            both[0]
        };
        prop_assert!(!overlap(0.0) && !overlap(depth) && !overlap(-along));
        prop_assert!(overlap((0.01 + 0.98 * along) * depth));
    }

    #[test]
    fn bodies_that_touch_at_odd_angles_do_not_overlap(pose in poses(), turn in -180.0..180.0) {
        let up = Pose::new(DVec3::ZERO, f64::to_radians(turn));
        let slab = cuboid(DVec3::new(4.0, 3.0, 0.5)).placed(&up);
        // A cube on its corner, one on its edge, one flat; a cylinder on its rim, its side, its
        // end.
        let cube = cuboid(DVec3::ONE);
        let rod = Solid::cylinder(0.7, Extent::centred(Some(2.0)));
        let endless = Solid::cylinder(0.7, Extent::ENDLESS);
        let sheet = Solid::Prism {
            outline: Outline { corners: vec![DVec2::new(0.0, -0.9), DVec2::new(0.0, 0.9)] },
            extent: Extent::centred(Some(2.0)),
        };
        let standing = [DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, -2.0), DVec3::ONE];
        let [x, y, z] = standing.map(DVec3::normalize);
        let standing = DMat3::from_cols(x, y, z).transpose();
        let corner = up.after(&Pose::from_rotation(DVec3::ZERO, standing));
        let tilt = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Pose::with_axis(DVec3::ZERO, f64::to_radians(turn), DVec3::new(sin, 0.0, cos))
        };
        let lying = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(cos, sin, 0.0))
        };
        let (sin, cos) = 40f64.to_radians().sin_cos();
        let cases = [
            (cube.placed(&corner), 3f64.sqrt()),
            (cube.placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::Y)), 2f64.sqrt()),
            (cube.placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_2, DVec3::X)), 1.0),
            (rod.placed(&tilt(40.0)), 0.7 * sin + cos),
            (rod.placed(&lying(turn)), 0.7),
            (endless.placed(&lying(turn)), 0.7),
            (rod.clone(), 1.0),
            (sheet.placed(&Pose::with_axis(DVec3::ZERO, 0.0, DVec3::X)), 0.0),
            (sheet.placed(&tilt(0.0)), 1.0),
            (Solid::ball(1.3).placed(&tilt(30.0)), 1.3),
        ];
        for (body, reach) in &cases {
            // What is lowest in the middle touches a rod below, too.
            let low = body.bounds().is_some_and(|[low, _]| body.contains(low * DVec3::Z * (1.0 - 1e-9)));
            let rod = endless.placed(&lying(0.3 * turn));
            for (slab, top) in [(&slab, 0.5), (&rod, 0.7)].into_iter().take(1 + usize::from(low)) {
                let meet = |way: f64| {
                    let body = moved(body, DVec3::Z * way).placed(&pose);
                    let slab = slab.placed(&pose);
                    let both = [body.overlaps(&slab, TOUCHING), slab.overlaps(&body, TOUCHING)];
                    assert_eq!(both[0], both[1], "{body:?} {slab:?}");
                    both[0]
                };
                let touch = reach + top;
                prop_assert!(!meet(touch) && !meet(touch + 1e-6), "{body:?} {slab:?}");
                prop_assert!(meet(touch - 1e-6), "{body:?} {slab:?}");
            }
        }
    }

    #[test]
    fn what_stands_in_something_does_so_wherever_both_are(pose in poses()) {
        let glass = cuboid(DVec3::new(4.0, 3.0, 2.0));
        let rod = Solid::cylinder(3.0, Extent::ENDLESS);
        let within = |inner: &Solid, by: DVec3, around: &Solid| {
            moved(inner, by).placed(&pose).is_within(&around.placed(&pose))
        };
        let cube = cuboid(DVec3::ONE);
        let across = Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::Y);
        let small = Solid::cylinder(1.0, Extent::centred(Some(2.0))).placed(&across);
        let rim = 3.0 - 2f64.sqrt();
        for (inner, around, by) in [
            (&cube, &glass, DVec3::new(3.0, 2.0, 1.0)),
            (&cube, &rod, DVec3::X * (8f64.sqrt() - 1.0)),
            (&Solid::ball(1.0), &glass, DVec3::Y * 2.0),
            (&Solid::ball(1.0), &rod, DVec3::Y * 2.0),
            (&Solid::ball(1.0), &Solid::ball(3.0), DVec3::Z * 2.0),
            (&cube.placed(&across), &rod, DVec3::X * (8f64.sqrt() - 2f64.sqrt())),
            (&small, &glass, DVec3::new(3.0, 2.0, 1.0)),
            (&small, &Solid::ball(2f64.sqrt()), DVec3::ZERO),
            (&small, &rod, DVec3::Y * rim.max(8f64.sqrt() - 1.0)),
            (&Solid::cylinder(2.0, Extent::ENDLESS), &rod, DVec3::X),
        ] {
            prop_assert!(within(inner, by, around), "{inner:?} {by}");
            prop_assert!(within(inner, by * (1.0 - 1e-6), around), "{inner:?} {by}");
            let out = by + 1e-6 * by.try_normalize().unwrap_or(DVec3::Y);
            prop_assert!(!within(inner, out, around), "{inner:?} {out}");
        }
        prop_assert!(!within(&rod, DVec3::ZERO, &glass) && !within(&glass, DVec3::ZERO, &cube));
        prop_assert!(within(&Solid::Nothing, DVec3::ZERO, &glass));
    }

    #[test]
    fn others_may_be_in_a_tilted_hole(pose in poses(), turn in -PI..PI) {
        let hole = Solid::cylinder(3.0, Extent::ENDLESS);
        let tube = Solid::cylinder(5.0, Extent::ENDLESS).with_hole(Hole::Round(hole));
        let short = Extent::centred(Some(1.0));
        let ring = Solid::cylinder(5.0, short)
            .with_hole(Hole::Round(Solid::cylinder(3.0, short)));
        let shell = Solid::ball(5.0).with_hole(Hole::Round(Solid::ball(3.0)));
        let across = Pose::with_axis(DVec3::ZERO, turn, DVec3::Y);
        let rod = Solid::cylinder(1.0, Extent::centred(Some(2.0))).placed(&across);
        let long = Solid::cylinder(1.0, Extent::ENDLESS)
            .placed(&Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(3.0, 0.0, 4.0)));
        let meet = |hollow: &Solid, body: &Solid, by: DVec3| {
            let (hollow, body) = (hollow.placed(&pose), moved(body, by).placed(&pose));
            let both = [hollow.overlaps(&body, TOUCHING), body.overlaps(&hollow, TOUCHING)];
            assert_eq!(both[0], both[1], "{hollow:?} {body:?}");
            both[0]
        };
        // A rod along y, half as long as wide, is a square to the tube.
        let free = 8f64.sqrt() - 1.0;
        for (hollow, way) in [(&tube, DVec3::X), (&shell, DVec3::X), (&shell, DVec3::Z)] {
            prop_assert!(!meet(hollow, &rod, way * (free - 1e-6)));
            prop_assert!(meet(hollow, &rod, way * (free + 1e-6)));
        }
        // One that leans at 3 : 4 through the ring is an ellipse 2.5 long at each end of it, 0.75
        // apart.
        prop_assert!(meet(&tube, &long, DVec3::ZERO) && !meet(&ring, &long, DVec3::ZERO));
        let free = 3.0 - 0.5 * 0.75 - 1.25;
        prop_assert!(!meet(&ring, &long, DVec3::X * (free - 1e-6)));
        prop_assert!(meet(&ring, &long, DVec3::X * (free + 1e-6)));
    }

    #[test]
    fn sheets_lie_on_each_other_wherever_both_are(pose in poses(), turn in -180.0..180.0) {
        let sheet = |half: f64, extent: Extent| Solid::Prism {
            outline: Outline { corners: vec![DVec2::new(-half, 0.0), DVec2::new(half, 0.0)] },
            extent,
        };
        let large = sheet(5.0, Extent::centred(Some(10.0))).placed(&pose);
        let small = |by: DVec3| {
            let turned = Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(turn, 0.0, 90.0));
            moved(&sheet(1.0, Extent::centred(Some(2.0))).placed(&turned), by).placed(&pose)
        };
        let lie = |by: DVec3| {
            let both = [large.coincides(&small(by), TOUCHING), small(by).coincides(&large, TOUCHING)];
            assert_eq!(both[0], both[1], "{by}");
            both[0]
        };
        prop_assert!(lie(DVec3::ZERO) && lie(DVec3::new(4.0, 0.0, 4.0)));
        prop_assert!(!lie(DVec3::Y * 1e-6) && !lie(DVec3::X * 7.0) && !lie(DVec3::Z * 7.0));
        let endless = sheet(5.0, Extent::ENDLESS).placed(&pose);
        prop_assert!(endless.coincides(&large, TOUCHING));
        prop_assert!(!large.coincides(&Solid::ball(1.0), TOUCHING));
    }
}

#[test]
fn a_device_on_its_head_is_an_upright_one() {
    let roof = Outline { corners: vec![DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 1.0)] };
    let solid = Solid::Prism { outline: roof, extent: Extent { min: 0.0, max: 3.0 } };
    let turned = solid.placed(&Pose::with_axis(DVec3::X, 0.0, DVec3::NEG_Z));
    let Solid::Prism { outline, extent } = &turned else { panic!("{turned:?}") };
    assert_eq!(*extent, Extent { min: -3.0, max: 0.0 });
    assert!(outline.contains(DVec2::new(1.5, -0.3)) && turned.holds(DVec3::new(1.5, -0.3, -2.0)));
}

#[test]
fn shadows_are_hulls_of_what_is_there() {
    let lying = Pose::with_axis(DVec3::new(1.0, 2.0, 3.0), 0.0, DVec3::Y);
    let shadow = Solid::cylinder(1.0, Extent::centred(Some(4.0))).placed(&lying).shadow();
    for corner in [(0.0, 0.0), (2.0, 0.0), (2.0, 4.0), (0.0, 4.0)].map(DVec2::from) {
        assert!(shadow.distance(corner) < 1e-12 && !shadow.contains((corner - 1.0) * 1.01 + 1.0));
    }
    let cube = cuboid(DVec3::ONE).placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::X));
    assert!((cube.shadow().radius() - 3f64.sqrt()).abs() < 1e-12);
    let endless = Solid::ball(2.0).placed(&lying).shadow();
    assert!(endless.contains(DVec2::new(1.0, 3.99)) && !endless.contains(DVec2::new(1.0, 4.01)));
}
