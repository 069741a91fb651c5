//! The border: where rays start and where they end.

use glam::{DMat3, DVec3};
use optics::geometry::Extent;
use optics::propagation::{Boundary, ConformalFlow, FlowError, Half, VirtualPoint};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

use super::rays::{CUT, Dice, flow, legs, turn};

#[test]
fn ends_on_the_border_and_on_shell_with_a_rotation() {
    let short = Extent { min: -10.0, max: 10.0 };
    let flow = flow(short, 1.0);
    let mut dice = Dice(77);
    for _ in 0..2000 {
        for (start, p, end) in legs(&flow, dice.enter(&flow, short), 1e-6) {
            let VirtualPoint { index, virtual_position, .. } = end.virtual_point;
            let position = end.position;
            let n = flow.index(end.virtual_point.half, position).expect("a point of the medium");
            assert!((end.wave_vector.length() - index).abs() < 2e-15 * index);
            assert!((n - index).abs() < 1e-12);
            assert!(
                end.wave_vector.dot(end.outward) >= -1e-12
                    && (end.outward.length() - 1.0).abs() < 1e-14
            );
            assert!((end.wave_vector.z - p.z).abs() < 1e-15);
            let limit = match end.surface {
                Boundary::XMin => position.x - CUT.x_min,
                Boundary::XMax => position.x - CUT.x_max,
                Boundary::YMax => position.y.abs() - CUT.y_max,
                Boundary::ZMin => position.z - short.min,
                Boundary::ZMax => position.z - short.max,
                Boundary::Floor => position.y.abs() - flow.map().floor_height_at(position.x),
                Boundary::Rim | Boundary::Core => f64::NAN,
            };
            assert!(limit.abs() < 1e-13, "{limit:e} {end:?}");
            let image = flow.map().jet(virtual_position).f;
            assert!((image.re - position.x).hypot(image.im - position.y.abs()) < 2e-13);
            let turn = turn(&start, &end);
            let straightness = turn * turn.transpose() - DMat3::IDENTITY;
            assert!(straightness.to_cols_array().iter().all(|e| e.abs() < 1e-14));
            assert!((turn.determinant() - 1.0).abs() < 1e-14);
            let carried = turn * p / start.index - end.wave_vector / index;
            assert!(carried.length() < 1e-8, "{}", carried.length());
        }
    }
}

#[test]
fn starts_on_the_border_go_on_or_end_at_once() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let at = |x, y| {
        flow.virtual_point(Half::Upper, DVec3::new(x, y, 0.0)).expect("a point of the border")
    };
    let top = at(3.0, CUT.y_max);
    let go = |start: &VirtualPoint, direction: DVec3| {
        flow.advance_from(start, start.index * direction.normalize(), 1e-6).expect("a ray")
    };
    assert_eq!(go(&top, DVec3::new(0.1, 1.0, 0.2)).optical_path, 0.0);
    assert_eq!(go(&top, DVec3::new(0.1, 1.0, 0.2)).surface, Boundary::YMax);
    assert!(go(&top, DVec3::new(0.1, -1.0, 0.2)).optical_path > 1.0);
    assert_eq!(go(&at(25.0, 3.0), DVec3::new(1e-3, 1.0, 0.0)).optical_path, 0.0);
    assert!(go(&at(25.0, 3.0), DVec3::new(-1e-3, 1.0, 0.0)).optical_path > 1e-3);
    let floor = at(2.0, flow.map().floor_height_at(2.0));
    assert_eq!(floor.virtual_position.im, 0.0);
    assert_eq!(go(&floor, DVec3::NEG_Y).surface, Boundary::Floor);
    assert_eq!(go(&floor, DVec3::Y).surface, Boundary::YMax);
    // Corners, and the middle line at the tip, where both halves meet.
    assert_eq!(go(&at(-25.0, CUT.y_max), DVec3::new(1.0, -1.0, 0.0)).surface, Boundary::Floor);
    let tip = at(25.0, flow.map().floor_height_at(25.0));
    assert!(go(&tip, DVec3::new(-1.0, 0.3, 0.1)).optical_path > 10.0);
}

#[test]
fn misses_no_crossing_of_straight_paths() {
    let mut dice = Dice(99);
    for _ in 0..300 {
        let w = dice.between(2.0, 12.0);
        let map = GaussianMap::new(w, w * dice.between(0.05, 0.88)).expect("a valid map");
        let cut = Truncation {
            x_min: -w * dice.between(0.2, 3.0),
            x_max: w * dice.between(0.2, 3.0),
            y_max: map.height * dice.between(1.02, 3.0),
        };
        let flow = ConformalFlow::new(ConformalMap::Gaussian(map), cut, Extent::ENDLESS, 1.0);
        for k in 0..20 {
            // Many starts on the top face and at grazing angles.
            let x = dice.between(cut.x_min, cut.x_max);
            let low = flow.map().floor_height_at(x);
            let y = if k % 2 == 0 { cut.y_max } else { dice.between(low, cut.y_max) };
            let start = flow.virtual_point(Half::Upper, DVec3::new(x, y, 0.0)).expect("inside");
            let angle = dice.between(-1.0, 1.0).powi(3) - f64::from(k % 3) * std::f64::consts::PI;
            let p = start.index * DVec3::new(angle.cos(), angle.sin(), 0.0);
            let end = flow.advance_from(&start, p, 1e-6).expect("a ray");
            for share in 1..500 {
                let share = f64::from(share) / 500.0;
                let way = end.virtual_point.virtual_position - start.virtual_position;
                let zeta = start.virtual_position + share * way;
                let z = flow.map().jet(zeta).f;
                let inside = [z.re - cut.x_min, cut.x_max - z.re, cut.y_max - z.im, zeta.im];
                assert!(inside.into_iter().all(|d| d > -1e-9), "{cut:?} {start:?} {p} {end:?}");
            }
        }
    }
}

#[test]
fn refuses_what_it_cannot_follow() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let start = DVec3::new(-25.0, 3.0, 0.0);
    let go = |position, p| flow.advance_from(&flow.virtual_point(Half::Upper, position)?, p, 1e-6);
    assert_eq!(go(DVec3::NAN, DVec3::X), Err(FlowError::NotFinite));
    assert_eq!(go(start, DVec3::INFINITY), Err(FlowError::NotFinite));
    assert_eq!(go(DVec3::new(-25.1, 3.0, 0.0), DVec3::X), Err(FlowError::Outside));
    assert_eq!(go(DVec3::new(0.0, 4.0, 0.0), DVec3::X), Err(FlowError::Outside));
    assert_eq!(flow.virtual_point(Half::Lower, start), Err(FlowError::Outside));
    assert!(matches!(go(start, 1.01 * DVec3::X), Err(FlowError::WaveVector { .. })));
    // Along z: bent away from the axis, it comes out; odd tolerances are made sensible.
    let n = flow.index(Half::Upper, start).expect("a point of the medium");
    for tolerance in [1e-6, 0.0, f64::NAN, 1e9] {
        let start = flow.virtual_point(Half::Upper, start).expect("a point of the medium");
        assert!(flow.advance_from(&start, n * DVec3::Z, tolerance).is_ok());
    }
}

/// Near the top a ray turns back just before the border: the nearest point was looked for again and
/// again.
#[test]
fn leaves_a_border_it_nearly_touches() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let start = flow
        .virtual_point(Half::Upper, DVec3::new(-25.0, 2.776_314_201_482_194_5e1, 0.0))
        .expect("a point of the border");
    let direction =
        DVec3::new(0.954_058_304_274_097_1, 0.031_478_774_922_878_43, -0.297_962_814_416_479_15);
    let end = flow.advance_from(&start, direction * start.index, 1e-6).expect("a way out");
    assert_eq!(end.surface, Boundary::XMax);
}
