use super::*;
use glam::{DVec2, Vec3Swizzles};

fn face(apex: f64, radius: f64, conic: f64) -> ConicFace {
    ConicFace { apex, curvature: radius.recip(), conic }
}

/// Lenses of all forms: bulging, hollow, of one of each, flat, and of all conics.
fn all() -> Vec<Lens> {
    let lens = |radius, front, back| Lens { radius, front, back };
    vec![
        lens(1.5, face(-0.5, 4.0, 0.0), face(0.5, -3.0, 0.0)),
        lens(1.5, face(-0.2, -4.0, 0.0), face(0.2, 3.0, 0.0)),
        lens(1.2, face(-0.3, 1.5, 0.0), face(0.3, 2.0, 0.0)),
        lens(1.2, face(-0.1, -2.0, 0.0), face(0.4, -1.3, 0.0)),
        lens(1.5, face(-0.5, f64::INFINITY, 0.0), face(0.5, -2.0, -2.3)),
        lens(1.5, face(-0.3, 2.0, -1.0), face(0.9, 1.6, -0.6)),
        lens(0.9, face(-0.2, -2.0, -4.0), face(0.3, f64::INFINITY, 0.0)),
        lens(1.0, face(-1.0, 1.0, 0.0), face(1.0, -1.0, 0.0)),
        lens(1.0, face(-2.5, 1.1, 0.2), face(0.5, -1.3, -0.7)),
        lens(2.0, face(-1.0, 1.0, -0.75), face(5.5, -1.3, -1.0)),
    ]
}

fn wave(k: u32, rate: f64) -> f64 {
    (rate * f64::from(k) + 0.3).sin()
}

#[test]
fn rays_go_in_and_out_where_points_say() {
    const STEP: f64 = 1e-3;
    for (number, lens) in all().into_iter().enumerate() {
        let mut through = 0;
        for k in 0..300 {
            let origin = 6.0 * DVec3::new(wave(k, 1.0), wave(k, 1.3), wave(k, 1.7)).normalize();
            let goal = 1.4 * DVec3::new(wave(k, 3.1), wave(k, 2.3), wave(k, 0.9));
            let direction = (goal - origin).normalize();
            let inside = |t: f64| lens.has(origin + direction * t, |less, more| less < more);
            // From where to where the ray is inside, by steps and then halving.
            let edge = |mut a: f64, mut b: f64| {
                let was = inside(a);
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    if inside(middle) == was { a = middle } else { b = middle }
                }
                0.5 * (a + b)
            };
            let times = (0..13_000).map(|step| STEP * f64::from(step));
            let changes: Vec<f64> = times
                .filter(|t| inside(*t) != inside(*t + STEP))
                .map(|t| edge(t, t + STEP))
                .collect();
            let mut from = 0.0;
            for pair in changes.chunks_exact(2) {
                let ahead = |part| lens.entry(part, origin + direction * from, direction);
                let met = first_along(Lens::PARTS.into_iter().filter_map(ahead));
                let (distance, outward) = met.expect("a way in");
                let enter = from + distance;
                if pair[0] - enter > 1e-9 {
                    // A way through a corner shorter than a step.
                    let (short, ..) =
                        lens.exit(origin + direction * enter, direction).expect("it is met");
                    assert!(short < STEP, "{number} {k}: {short}");
                    from = enter + short + 1e-9;
                    continue;
                }
                assert!((enter - pair[0]).abs() < 1e-10, "{number} {k}: {enter} {}", pair[0]);
                assert!(outward.dot(direction) <= 0.0 && outward.is_normalized());
                let start = origin + direction * enter;
                let (distance, part, outward) = lens.exit(start, direction).expect("a way out");
                assert!((enter + distance - pair[1]).abs() < 1e-10, "{number} {k}");
                assert!(outward.dot(direction) >= 0.0 && outward.is_normalized());
                // From within and from the end itself it is the same way out.
                let middle = start + direction * (0.5 * distance);
                let (rest, again, _) = lens.exit(middle, direction).expect("a way out");
                assert!((rest - 0.5 * distance).abs() < 1e-12 && again == part);
                from = pair[1];
                through += 1;
            }
            let past = origin + direction * (from + 1e-9);
            let more = Lens::PARTS.into_iter().filter_map(|part| lens.entry(part, past, direction));
            for (distance, _) in more.collect::<Vec<_>>() {
                let (short, ..) =
                    lens.exit(past + direction * distance, direction).expect("it is met");
                assert!(short < STEP, "{number} {k}: {short}");
            }
        }
        assert!(through > 50, "{number}: {through}");
    }
}

#[test]
fn rays_from_far_away_lose_no_digits() {
    let lens = all()[0];
    let direction = DVec3::new(3.0, 0.2, -0.1).normalize();
    let goal = DVec3::new(lens.front.x_at(0.5), 0.3, 0.4);
    for far in [10.0, 1e3, 1e6] {
        let (distance, _) =
            lens.entry(LensPart::Front, goal - direction * far, direction).expect("it is met");
        assert!((distance - far).abs() < 1e-14 * far.max(10.0), "{}", distance - far);
    }
}

#[test]
fn what_a_ray_has_left_it_does_not_meet_by_rounding() {
    for lens in all() {
        for k in 0..2000 {
            let (part, r) = (Lens::PARTS[k as usize % 2], lens.radius * wave(k, 0.7).abs());
            let angle = 9.0 * wave(k, 1.9);
            let face = if part == LensPart::Front { lens.front } else { lens.back };
            let at = DVec3::new(face.x_at(r), r * angle.cos(), r * angle.sin());
            let outward = lens.outward(part, at);
            let direction = DVec3::new(wave(k, 2.7), wave(k, 3.3), wave(k, 4.1)).normalize();
            if direction.dot(outward).abs() < 1e-3 {
                continue;
            }
            if direction.dot(outward) > 0.0 {
                let again = lens.entry(part, at, direction);
                assert!(again.is_none_or(|(distance, _)| distance > 1e-6), "{lens:?} {k}");
                let (now, ..) = lens.exit(at, direction).expect("it is met");
                assert!(now < 1e-11, "{lens:?} {k}: {now}");
            } else if r < 0.99 * lens.radius {
                let (distance, ..) = lens.exit(at, direction).expect("it is met");
                assert!(distance > 1e-6, "{lens:?} {k}");
            }
        }
    }
}

#[test]
fn it_is_thinnest_where_samples_say() {
    let saddle = Lens { radius: 1.9, front: face(0.0, 1.9, -1.0), back: face(0.7, 2.0, 0.0) };
    for lens in all().into_iter().chain([saddle]) {
        let (r, gap) = lens.thinnest();
        let radii = (0..=1000).map(|k| lens.radius * f64::from(k) / 1000.0);
        let least =
            radii.map(|r| lens.between(r)).map(|[a, b]| b - a).fold(f64::INFINITY, f64::min);
        assert!(gap <= least && gap > least - 1e-5, "{gap} {least} {lens:?}");
        let [from, to] = lens.between(r);
        assert!((to - from - gap).abs() < 1e-12);
    }
    let (r, _) = saddle.thinnest();
    assert!(r > 0.1 && r < 1.8, "{r}");
}

#[test]
fn its_farthest_points_are_those_of_all() {
    for lens in all() {
        // Denser towards the rim, where a face may be steep.
        let ring = |k: u32| (f64::from(k) / 64.0 * std::f64::consts::FRAC_PI_2).sin();
        let turn = |k: u32| DVec2::from_angle(f64::from(k) / 96.0 * std::f64::consts::TAU);
        let at = |k: u32| {
            let r = lens.radius * ring(k / 96);
            lens.between(r).map(|x| (turn(k % 96) * r).extend(x).zxy())
        };
        let points: Vec<DVec3> = (0..65 * 96).flat_map(at).collect();
        for k in 0..40 {
            let v = 3.0 * DVec3::new(wave(k, 1.0), wave(k, 1.4), wave(k, 1.7));
            let most = |value: &dyn Fn(DVec3) -> f64| {
                points.iter().map(|at| value(*at)).fold(f64::NEG_INFINITY, f64::max)
            };
            let along = lens.support(v) - most(&|at| at.dot(v));
            assert!((-1e-12..0.01).contains(&along), "{along} {lens:?}");
            let far = lens.farthest_from(v) - most(&|at| at.distance(v));
            assert!((-1e-12..0.01).contains(&far), "{far} {lens:?}");
            let nested = lens.greatest(|at| at.distance(v)) - lens.farthest_from(v);
            assert!(nested.abs() < 1e-12, "{nested} {lens:?}");
        }
    }
}

#[test]
fn a_bound_on_the_depth_is_one() {
    for lens in all() {
        for (face, sign) in [(lens.front, 1.0), (lens.back.mirrored(), -1.0)] {
            if face.curvature < 0.0 {
                continue;
            }
            let rim = (0..=4000).map(|k| {
                let r = lens.radius * (f64::from(k) / 2000.0 - 1.0);
                [face.x_at(r.abs()), r]
            });
            let rim: Vec<[f64; 2]> = rim.collect();
            for k in 0..300 {
                let r = lens.radius * wave(k, 1.1);
                let x = face.x_at(r.abs()) + (1.0 + wave(k, 2.3)) - 0.4;
                let at = DVec3::new(x, 0.6 * r, 0.8 * r);
                let (depth, gradient) = face.depth(at, lens.radius);
                assert!((depth > 0.0) == (x > face.x_at(r.abs())), "{depth} {face:?} {sign}");
                let near = rim.iter().map(|[a, b]| (a - x).hypot(b - r)).fold(f64::MAX, f64::min);
                assert!(depth <= near + 1e-3, "{depth} {near} {face:?}");
                let step = 1e-6 * DVec3::new(0.3, -0.5, 0.8);
                let slope =
                    face.depth(at + step, lens.radius).0 - face.depth(at - step, lens.radius).0;
                assert!((slope - 2.0 * gradient.dot(step)).abs() < 1e-10, "{face:?} {at}");
            }
        }
    }
}
