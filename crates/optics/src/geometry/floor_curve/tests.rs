use proptest::prelude::*;

use super::*;
use crate::transformation::GaussianMap;

fn map(w: f64, h: f64) -> ConformalMap {
    ConformalMap::Gaussian(GaussianMap::new(w, h).expect("a valid map"))
}

/// The first entry into the metal by walking: slow, and blind to what is thinner than a step.
fn by_walking(map: &ConformalMap, reach: f64, origin: DVec2, direction: DVec2) -> Option<f64> {
    let inside = |t: f64| {
        let p = origin + t * direction;
        p.x.abs() <= reach && p.y.abs() < map.floor_height_at(p.x)
    };
    let (step, count) = (0.01 / direction.length(), 12_000);
    let first = (1..count).map(|k| f64::from(k) * step).find(|t| inside(*t))?;
    let (mut low, mut high) = (first - step, first);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if inside(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

#[test]
fn is_met_from_all_sides() {
    let map = map(10.02, 4.25);
    let curve = FloorCurve::new(map.clone(), MetalBack::MirrorImage, -25.0, 25.0);
    assert_eq!(curve.knots.len(), 3 * PIECES + 1, "it bends three ways");
    let hit = curve.first_hit(DVec2::new(0.0, 30.0), DVec2::new(0.0, -2.0), 0.0).expect("a hit");
    assert!((hit.t - 0.5 * (30.0 - 4.25)).abs() < 1e-13);
    assert!((hit.normal - DVec2::Y).length() < 1e-13);
    let hit = curve.first_hit(DVec2::new(0.0, -30.0), DVec2::Y, 0.0).expect("a hit");
    assert!((hit.t - 25.75).abs() < 1e-13);
    assert!((hit.normal + DVec2::Y).length() < 1e-13);
    let hit = curve.first_hit(DVec2::new(-40.0, 0.0), DVec2::X, 0.0).expect("a hit");
    assert!((hit.t - 15.0).abs() < 1e-13 && hit.normal == -DVec2::X);
    assert_eq!(curve.first_hit(DVec2::new(-40.0, 4.26), DVec2::X, 0.0), None);
    assert_eq!(curve.first_hit(DVec2::new(-40.0, 0.0), DVec2::X, 15.1), None);
    assert_eq!(curve.first_hit(DVec2::new(-40.0, 0.0), -DVec2::X, 0.0), None);
    assert_eq!(curve.first_hit(DVec2::ZERO, DVec2::ZERO, 0.0), None);
    assert_eq!(curve.first_hit(DVec2::NAN, DVec2::X, 0.0), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn agrees_with_walking(
        w in 3.0_f64..12.0, ratio in 0.05_f64..0.88, x in -40.0_f64..40.0, up in -1.5_f64..1.5,
        aim in -25.0_f64..25.0, share in -1.2_f64..1.2, length in 0.1_f64..10.0,
    ) {
        let map = map(w, ratio * w);
        let curve = FloorCurve::new(map.clone(), MetalBack::MirrorImage, -25.0, 25.0);
        let origin = DVec2::new(x, up * ratio * w);
        prop_assume!(x.abs() > 25.0 || origin.y.abs() > map.floor_height_at(x) + 0.02);
        let target = DVec2::new(aim, share * map.floor_height_at(aim));
        let direction = (target - origin).normalize() * length;
        let hit = curve.first_hit(origin, direction, 0.0);
        let walked = by_walking(&map, 25.0, origin, direction);
        match (hit, walked) {
            (Some(hit), Some(t)) => {
                // Walking may step over a corner; the exact hit is then earlier, and real.
                let earlier = hit.t < t && (t - hit.t) * length > 0.005;
                prop_assert!(earlier || (hit.t - t).abs() * length < 1e-9, "{hit:?} {t}");
            }
            (None, Some(t)) => prop_assert!(false, "missed the hit at {t}"),
            _ => {}
        }
        if let Some(hit) = hit {
            let point = origin + hit.t * direction;
            let height = map.floor_height_at(point.x);
            prop_assert!(hit.normal.y == 0.0 || (point.y.abs() - height).abs() < 1e-10);
            prop_assert!((hit.normal.length() - 1.0).abs() < 1e-14);
            prop_assert!(hit.normal.dot(direction) < 0.0);
            // A reflected ray does not hit the same place again, where the metal is thicker than
            // rounding.
            let reflected = direction - 2.0 * direction.dot(hit.normal) * hit.normal;
            if let Some(next) = curve.first_hit(point, reflected, 0.0) {
                prop_assert!(next.t * length > 1e-9 || height < 1e-9);
            }
        }
    }

    /// A ray that all but grazes the floor where that bends away from it enters the metal if it is
    /// that much too low, and passes if it is too high.
    #[test]
    fn grazing_rays_are_told_apart(
        w in 6.0_f64..12.0, ratio in 0.05_f64..0.88, place in -1.0_f64..1.0, backwards: bool,
        depth in -9.0_f64..-5.0,
    ) {
        let map = map(w, ratio * w);
        let curve = FloorCurve::new(map.clone(), MetalBack::MirrorImage, -25.0, 25.0);
        prop_assert_eq!(curve.knots.len(), 3 * PIECES + 1);
        let [from, to] = [&curve.knots[PIECES], &curve.knots[2 * PIECES]];
        let (middle, half) = (0.5 * (from.parameter + to.parameter), 0.5 * (to.parameter - from.parameter));
        let jet = map.profile(middle + 0.7 * place * half);
        let point = DVec2::new(jet.f.re, jet.f.im);
        let mut along = DVec2::new(jet.f1.re, jet.f1.im).normalize();
        let normal = along.perp();
        if backwards {
            along = -along;
        }
        let depth = 10.0_f64.powf(depth);
        let bend = (jet.f1.conj() * jet.f2).im.abs() / jet.f1.norm().powi(3);
        // The chord is that of the circle which lies closest to the curve.
        let chord = (8.0 * depth / bend).sqrt();
        let start = |height: f64| point + height * normal - chord * along;
        let hit = curve.first_hit(start(-depth), along, 0.0);
        let hit = hit.ok_or_else(|| TestCaseError::fail("the metal is missed"))?;
        prop_assert!((hit.t - 0.5 * chord).abs() < 0.2 * chord, "{} of {chord}", hit.t);
        let past = curve.first_hit(start(depth), along, 0.0);
        prop_assert!(past.is_none_or(|hit| hit.t > 2.0 * chord), "{past:?}");
    }
}
