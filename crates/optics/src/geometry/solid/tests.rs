use super::super::{FloorCurve, MetalBack, Sphere};
use super::*;
use crate::transformation::{ConformalMap, GaussianMap};
use std::f64::consts::FRAC_PI_2;

const SLACK: f64 = 1e-9;

fn box_of(half: f64) -> Solid {
    Solid::Prism {
        outline: Outline::rectangle(half, half),
        extent: Extent::centred(Some(2.0 * half)),
    }
}

fn moved(solid: &Solid, by: DVec3) -> Solid {
    solid.placed(&Pose::new(by, 0.0))
}

#[test]
fn bodies_that_touch_do_not_overlap() {
    let cylinder = Solid::cylinder(1.0, Extent::centred(Some(2.0)));
    let bodies = [box_of(1.0), cylinder, Solid::ball(1.0)];
    for a in &bodies {
        for b in &bodies {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                assert!(!a.overlaps(&moved(b, axis * 2.0), SLACK), "{a:?} {b:?} {axis}");
                assert!(a.overlaps(&moved(b, axis * 1.99), SLACK), "{a:?} {b:?} {axis}");
            }
        }
    }
}

#[test]
fn corners_and_rims_are_where_they_are() {
    let corner = DVec3::ONE + DVec3::ONE / 3f64.sqrt();
    let ball = Solid::ball(1.0);
    assert!(!box_of(1.0).overlaps(&moved(&ball, corner * 1.0001), SLACK));
    assert!(box_of(1.0).overlaps(&moved(&ball, corner * 0.9999), SLACK));
    let rim = DVec3::new(1.0 + 0.5f64.sqrt(), 0.0, 1.0 + 0.5f64.sqrt());
    let cylinder = Solid::cylinder(1.0, Extent::centred(Some(2.0)));
    assert!(!cylinder.overlaps(&moved(&ball, rim * 1.0001), SLACK));
    assert!(ball.overlaps(&moved(&cylinder, -rim * 0.9999), SLACK));
    let sheet = Solid::Prism {
        outline: Outline { corners: vec![DVec2::new(0.0, -5.0), DVec2::new(0.0, 5.0)] },
        extent: Extent::centred(Some(4.0)),
    };
    assert!(sheet.overlaps(&moved(&ball, DVec3::new(0.99, 3.0, 1.0)), SLACK));
    assert!(!sheet.overlaps(&moved(&ball, DVec3::new(1.01, 3.0, 1.0)), SLACK));
    assert!(!sheet.overlaps(&moved(&cylinder, DVec3::new(0.5, 0.0, 3.5)), SLACK));
    // Without thickness it holds nothing, nor does the line that it lies on.
    assert!(!sheet.contains(DVec3::ZERO) && !sheet.contains(DVec3::Y * 6.0));
    assert!(!Solid::Nothing.overlaps(&ball, SLACK) && !Solid::Nothing.holds(DVec3::ZERO));
}

/// The body in the hole, moved along x until it presses against the border, and beyond it outside.
fn check_hole(hollow: &Solid, body: &Solid, [inside, outside]: [f64; 2]) {
    for (turn, towards) in [(0.0, DVec3::X), (FRAC_PI_2, DVec3::Y)] {
        let hollow = hollow.placed(&Pose::new(DVec3::ZERO, turn));
        let body = body.placed(&Pose::new(DVec3::ZERO, turn));
        let meets = |way: f64| {
            let body = moved(&body, towards * way);
            let both = [hollow.overlaps(&body, SLACK), body.overlaps(&hollow, SLACK)];
            assert_eq!(both[0], both[1], "{way}");
            both[0]
        };
        assert!(!meets(0.0) && !meets(inside - 1e-6) && meets(inside + 1e-6), "{hollow:?}");
        assert!(meets(outside - 1e-6) && !meets(outside + 1e-6), "{hollow:?} {body:?}");
    }
}

#[test]
fn others_may_be_in_a_hole_but_not_in_its_walls() {
    let short = Extent::centred(Some(2.0));
    let tube = Solid::cylinder(5.0, Extent::ENDLESS)
        .with_hole(Hole::Round(Solid::cylinder(3.0, Extent::ENDLESS)));
    let shell = Solid::ball(5.0).with_hole(Hole::Round(Solid::ball(3.0)));
    let cylinder = Solid::cylinder(1.0, short);
    let ball = Solid::ball(1.0);
    check_hole(&tube, &box_of(1.0), [8f64.sqrt() - 1.0, 6.0]);
    check_hole(&tube, &cylinder, [2.0, 6.0]);
    check_hole(&tube, &ball, [2.0, 6.0]);
    check_hole(&shell, &box_of(1.0), [7f64.sqrt() - 1.0, 6.0]);
    check_hole(&shell, &cylinder, [8f64.sqrt() - 1.0, 6.0]);
    check_hole(&shell, &ball, [2.0, 6.0]);
    let small = Solid::ball(1.0).with_hole(Hole::Round(Solid::ball(0.5)));
    check_hole(&shell, &small, [2.0, 6.0]);
    assert!(shell.holds(DVec3::X * 3.1) && !shell.holds(DVec3::X * 2.9));
    // A ball wider than the hole of a short tube may lie upon its end.
    let ring = Solid::cylinder(5.0, short).with_hole(Hole::Round(Solid::cylinder(3.0, short)));
    let wide = |z: f64| moved(&Solid::ball(3.2), DVec3::Z * z);
    let rest = 1.0 + (3.2f64.powi(2) - 9.0).sqrt();
    assert!(!ring.overlaps(&wide(rest + 1e-6), SLACK));
    assert!(ring.overlaps(&wide(rest - 1e-6), SLACK));
}

#[test]
fn others_may_be_in_a_hole_with_a_curved_border() {
    let map = ConformalMap::Gaussian(GaussianMap::new(10.0, 4.0).expect("a map"));
    let curve = FloorCurve::new(map.clone(), MetalBack::MirrorImage, -25.0, 25.0);
    let extent = Extent::ENDLESS;
    let outline = Outline::rectangle(25.0, 30.0);
    let whole = Solid::Prism { outline, extent };
    let hollow = whole.with_hole(Hole::Lens { curve, pose: Pose::new(DVec3::ZERO, 0.0), extent });
    // The corner of a box meets the curve; so does a ball, where its distance by plain search is
    // its radius.
    let level = |height: f64| {
        let (mut low, mut high) = (0.0, 25.0);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if map.floor_height_at(middle) > height { low = middle } else { high = middle }
        }
        low
    };
    check_along_x(&hollow, &box_of(1.0), [level(1.0) - 1.0, 26.0]);
    let border: Vec<DVec2> = (0..250_000)
        .map(|k| f64::from(k) * 1e-4)
        .map(|x| DVec2::new(x, map.floor_height_at(x)))
        .collect();
    let distance =
        |x: f64| border.iter().map(|p| p.distance(DVec2::X * x)).fold(f64::INFINITY, f64::min);
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..30 {
        let middle: f64 = 0.5 * (low + high);
        if distance(middle) > 1.0 { low = middle } else { high = middle }
    }
    check_along_x(&hollow, &Solid::ball(1.0), [low, 26.0]);
    check_along_x(&hollow, &Solid::cylinder(1.0, extent), [low, 26.0]);
    assert!(hollow.holds(DVec3::Y * 4.01) && !hollow.holds(DVec3::Y * 3.99));
}

fn check_along_x(hollow: &Solid, body: &Solid, [inside, outside]: [f64; 2]) {
    for turn in [0.0, FRAC_PI_2, 0.6] {
        let pose = Pose::new(DVec3::new(3.0, -2.0, 1.0), turn);
        let hollow = hollow.placed(&pose);
        let meets = |way: f64| {
            let body = moved(body, DVec3::X * way).placed(&pose);
            hollow.overlaps(&body, SLACK)
        };
        assert!(!meets(0.0) && !meets(inside - 1e-5) && meets(inside + 1e-5), "{body:?}");
        assert!(meets(outside - 1e-6) && !meets(outside + 1e-6), "{body:?}");
    }
}

/// What a plane leaves of a ball of radius 2, at a place.
fn cut(normal: DVec3, offset: f64, pose: &Pose) -> Solid {
    let plane = Plane { normal: normal.normalize(), offset };
    let ball = CutBall { sphere: Sphere { radius: 2.0 }, plane };
    Solid::CutBall { centre: DVec3::ZERO, ball }.placed(pose)
}

#[test]
fn parts_of_a_ball_are_in_the_way_where_they_are() {
    let normal = DVec3::new(2.0, -1.0, 2.0) / 3.0;
    for (k, offset) in [0.0, 1.2, -0.7].into_iter().enumerate() {
        let axis = DVec3::new(1.0, k as f64, -0.3);
        let pose = Pose::with_axis(DVec3::new(30.0, -7.0, 1e3), 0.6, axis);
        let out = pose.vector_to_world(normal);
        let part = cut(normal, offset, &pose);
        let meet = |other: &Solid, way: f64| {
            let other = moved(other, out * way);
            let both = [part.overlaps(&other, SLACK), other.overlaps(&part, SLACK)];
            assert_eq!(both[0], both[1], "{offset} {other:?}");
            both[0]
        };
        // The part that was cut off, in its place; a ball, a cylinder and a box upon the cut.
        assert!(!meet(&cut(-normal, -offset, &pose), 0.0));
        assert!(meet(&cut(-normal, -offset, &pose), -1e-6));
        let turn = Pose::with_axis(DVec3::ZERO, 0.2, normal);
        for solid in [
            Solid::ball(1.0),
            Solid::cylinder(1.0, Extent::centred(Some(2.0))),
            box_of(1.0),
            cut(normal, 1.0, &Pose::IDENTITY),
        ] {
            let other = solid.placed(&pose.after(&turn));
            let lowest = if matches!(solid, Solid::CutBall { .. }) { 2.0 } else { 1.0 };
            let other = if lowest > 1.0 { solid.placed(&pose) } else { other };
            assert!(!meet(&other, lowest + offset + 1e-7), "{offset} {solid:?}");
            assert!(meet(&other, lowest + offset - 1e-7), "{offset} {solid:?}");
        }
        // Round the other way.
        assert!(!meet(&Solid::ball(1.0).placed(&pose), -3.0 - 1e-7));
        assert!(meet(&Solid::ball(1.0).placed(&pose), -3.0 + 1e-7));
        // All of it is within its bounds and its shadow, and within a box just as large.
        let [low, high] = part.bounds().expect("bounds");
        let half = 0.5 * (high - low);
        let around = |size: DVec3| {
            let outline = Outline::rectangle(size.x, size.y);
            let extent = Extent { min: -size.z, max: size.z };
            moved(&Solid::Prism { outline, extent }, 0.5 * (high + low))
        };
        assert!(part.is_within(&around(half)) && !part.is_within(&around(half - 1e-6)));
        assert!(part.is_within(&moved(&Solid::ball(2.0), pose.origin)));
        let shadow = part.shadow();
        let tips = shadow.corners.iter().map(|at| at.x).fold(f64::MIN, f64::max);
        assert!((tips - high.x).abs() < 1e-2 && part.contains(pose.origin - out * 1.9));
        assert!(!part.holds(pose.origin + out * (offset + 1e-9)));
    }
}

#[test]
fn the_border_is_not_inside() {
    for solid in [box_of(1.0), Solid::cylinder(1.0, Extent::ENDLESS), Solid::ball(1.0)] {
        assert!(solid.holds(DVec3::ZERO) && solid.holds(DVec3::X * 0.999));
        assert!(!solid.holds(DVec3::X) && !solid.holds(DVec3::new(0.0, 1.001, 0.0)));
    }
}
