use super::*;
use crate::geometry::{CutBall, Extent, Outline, Plane, Sphere, TOUCHING};

fn face(apex: f64, radius: f64, conic: f64) -> ConicFace {
    ConicFace { apex, curvature: radius.recip(), conic }
}

fn placed(lens: Lens, origin: DVec3, axis: DVec3) -> Solid {
    // The lens's axis is x; a pose says where z goes.
    let pose = Pose::with_axis(origin, 0.3, axis.any_orthonormal_vector());
    let turn =
        DMat3::from_quat(glam::DQuat::from_rotation_arc(pose.vector_to_world(DVec3::X), axis));
    Solid::Lens { lens, pose: Pose::from_rotation(origin, turn * pose.rotation()) }
}

#[test]
fn cemented_lenses_touch_and_pressed_ones_overlap() {
    let (glue, glue_conic) = (-2.2, -0.6);
    let crown =
        Lens { radius: 1.2, front: face(-0.6, 3.0, 0.0), back: face(0.4, glue, glue_conic) };
    for radius in [0.9, 1.2, 1.3] {
        let flint =
            Lens { radius, front: face(-0.2, glue, glue_conic), back: face(0.3, -9.0, 0.0) };
        let axis = DVec3::new(0.3, -0.8, 0.5).normalize();
        let at = DVec3::new(3.0, -1.0, 20.0);
        for turned in [1.0, -1.0] {
            let first = placed(crown, at, axis * turned);
            for (press, overlap) in [(-1e-6, false), (0.0, false), (1e-8, true), (0.3, true)] {
                let second = placed(flint, at + axis * turned * (0.6 - press), axis * turned);
                assert_eq!(first.overlaps(&second, TOUCHING), overlap, "{press} {radius}");
                assert_eq!(second.overlaps(&first, TOUCHING), overlap, "{press} {radius}");
            }
        }
    }
}

#[test]
fn flat_faces_touch_flat_things() {
    let hollow =
        Lens { radius: 1.0, front: face(-0.3, f64::INFINITY, 0.0), back: face(0.1, 3.0, 0.0) };
    let bulging = Lens { back: face(0.4, -2.0, 0.0), ..hollow };
    for lens in [hollow, bulging] {
        let solid = placed(lens, DVec3::ZERO, DVec3::X);
        for (press, overlap) in [(-1e-8, false), (0.0, false), (1e-8, true)] {
            let block = |shift: DVec3, outline: Outline| Solid::Prism {
                outline,
                extent: Extent { min: shift.z - 4.0, max: shift.z + 4.0 },
            };
            let block = block(DVec3::Z, Outline::rectangle(2.0, 7.0));
            let block = block.placed(&Pose::new(DVec3::X * (-2.3 + press), 0.0));
            assert_eq!(solid.overlaps(&block, TOUCHING), overlap, "{press}");
            assert_eq!(block.overlaps(&solid, TOUCHING), overlap, "{press}");
        }
    }
}

#[test]
fn a_ball_fits_into_a_hollow_of_its_radius_or_more() {
    // The ball is beside the axis, so that profiles do not tell.
    let lens =
        Lens { radius: 2.0, front: face(-0.5, f64::INFINITY, 0.0), back: face(0.5, 3.0, 0.0) };
    let solid = placed(lens, DVec3::ZERO, DVec3::X);
    let centre = lens.back.apex + 3.0;
    for (radius, overlap) in [(1.0, false), (1.49, false), (1.53, true), (2.0, true)] {
        // It lies off the axis, and touches the face with a radius of 1.5.
        let ball = Solid::Ball { centre: DVec3::new(centre - 1.5 * 0.96, 1.5 * 0.28, 0.0), radius };
        assert_eq!(solid.overlaps(&ball, TOUCHING), overlap, "{radius}");
    }
    let nested = Lens { radius: 1.2, front: face(0.0, 2.5, 0.0), back: face(1.0, 4.0, 0.0) };
    for (gap, overlap) in [(0.05, false), (0.01, false), (-0.03, true)] {
        let aside = DVec3::new(0.5 + gap, 0.05, -0.02);
        let second = placed(nested, aside, DVec3::X);
        assert_eq!(solid.overlaps(&second, TOUCHING), overlap, "{gap}");
        assert_eq!(second.overlaps(&solid, TOUCHING), overlap, "{gap}");
    }
}

#[test]
fn random_pairs_overlap_where_points_are_in_both() {
    let lenses = [
        Lens { radius: 1.5, front: face(-0.5, 4.0, 0.0), back: face(0.5, -3.0, 0.0) },
        Lens { radius: 1.5, front: face(-0.2, -4.0, 0.0), back: face(0.2, 3.0, 0.0) },
        Lens { radius: 1.2, front: face(-0.3, 1.5, -2.0), back: face(0.3, 2.0, 0.5) },
        Lens { radius: 1.0, front: face(-2.5, 1.1, 0.2), back: face(0.5, -1.3, -1.7) },
    ];
    let wave = |k: u32, rate: f64| (rate * f64::from(k) + 0.3).sin();
    let plane = Plane { normal: DVec3::new(0.6, 0.0, 0.8), offset: 0.3 };
    let cut = CutBall { sphere: Sphere { radius: 1.4 }, plane };
    let outline = Outline::rectangle(0.8, 1.1);
    let (mut together, mut apart) = (0, 0);
    for k in 0..160 {
        let axis = DVec3::new(wave(k, 1.1), wave(k, 2.1), wave(k, 3.1)).normalize();
        let solid = placed(lenses[k as usize % 4], DVec3::new(0.2, -0.1, 0.4), axis);
        let at = 1.7 * DVec3::new(wave(k, 1.3), wave(k, 1.9), wave(k, 2.7));
        let turned = DVec3::new(wave(k, 2.9), wave(k, 0.7), wave(k, 1.5)).normalize();
        let extent = Extent { min: -1.0, max: 0.7 };
        let pose = Pose::with_axis(at, 0.4, turned);
        let other = match k / 4 % 5 {
            0 => Solid::Ball { centre: at, radius: 0.8 },
            1 => Solid::Prism { outline: outline.clone(), extent }.placed(&pose),
            2 => Solid::cylinder(0.6, extent).placed(&pose),
            3 => Solid::CutBall { centre: at, ball: cut },
            _ => placed(lenses[(k / 20) as usize % 4], at, turned),
        };
        let [low, high] = solid.bounds().expect("it has ends");
        let lattice = (0..60u32.pow(3)).map(|i| {
            let share = DVec3::new(f64::from(i % 60), f64::from(i / 60 % 60), f64::from(i / 3600));
            low + (high - low) * (share + 0.5) / 60.0
        });
        let common = lattice.filter(|p| solid.holds(*p) && other.holds(*p)).count();
        let overlap = solid.overlaps(&other, TOUCHING);
        assert_eq!(overlap, other.overlaps(&solid, TOUCHING), "{k}");
        // Some lattice points in both are more than what planes beside a hollow face may miss.
        assert!(overlap || common < 4, "{k}: {common}");
        together += i32::from(overlap && common > 0);
        apart += i32::from(!overlap);
        assert!(!overlap || common > 0 || grazes(&solid, &other), "{k}");
    }
    assert!(together > 30 && apart > 30, "{together} {apart}");
}

/// Whether two solids come so near to each other that a coarse lattice may miss what they share: a
/// finer one finds it.
fn grazes(one: &Solid, other: &Solid) -> bool {
    let ([low, high], [from, to]) =
        (one.bounds().expect("it has ends"), other.bounds().expect("it has ends"));
    let (low, high) = (low.max(from), high.min(to));
    (0..200u32.pow(3)).any(|i| {
        let share = DVec3::new(f64::from(i % 200), f64::from(i / 200 % 200), f64::from(i / 40_000));
        let at = low + (high - low) * (share + 0.5) / 200.0;
        one.holds(at) && other.holds(at)
    })
}

#[test]
fn a_lens_is_within_what_holds_its_points() {
    let lens = Lens { radius: 1.5, front: face(-0.5, 4.0, 0.0), back: face(0.5, -3.0, 0.0) };
    let axis = DVec3::new(0.3, -0.8, 0.5).normalize();
    let solid = placed(lens, DVec3::ZERO, axis);
    let far = lens.farthest_from(DVec3::ZERO);
    for (room, within) in [(1e-8, true), (-1e-8, false)] {
        assert_eq!(solid.is_within(&Solid::ball(far + room)), within);
        let [low, high] = solid.bounds().expect("it has ends");
        let outline = |room: f64| {
            let [a, b] = [low.truncate(), high.truncate() + room];
            Outline { corners: vec![a, a.with_x(b.x), b, a.with_y(b.y)] }
        };
        let extent = Extent { min: low.z, max: high.z };
        assert_eq!(solid.is_within(&Solid::Prism { outline: outline(room), extent }), within);
        let tube = lens.cylinder_around();
        let upright = placed(lens, DVec3::ZERO, DVec3::X);
        assert!(upright.is_within(&tube) && upright.overlaps(&tube, TOUCHING));
        let reach = lens.greatest(|at| at.truncate().length());
        let round = Solid::cylinder(reach + room, Extent::ENDLESS);
        assert_eq!(upright.is_within(&round), within);
    }
}
