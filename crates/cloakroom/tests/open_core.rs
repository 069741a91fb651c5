//! Cloaks with an open core: what is in it, how light gets out of it, and what may stand in it.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::equation_of_motion::{GradedHalf, fresnel, gaussian, refract};
use crate::pictures::{difference, png};
use crate::rays::{self, Numbers, assembly, launch, launches_around, spread, strongest, try_bench};
use cloakroom::assembly::Assembly;
use cloakroom::render::PreparedSceneError;
use cloakroom::scene::DeviceName;
use cloakroom::trace::{Launch, Leaf, Limits, Outcome, TraceStats, Tracer};
use glam::DVec3;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-9 };

fn open(kind: &str, more: &str) -> String {
    format!("[[device]]\nkind = \"{kind}\"\ncore = \"open\"\n{more}\n")
}

/// An opaque ball in the core.
fn with_ball(kind: &str, radius: f64, position: DVec3) -> String {
    let at = position.to_array();
    let ball = format!(
        "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = {radius:?}\nposition = {at:?}\n\
         surface = {{}}\n"
    );
    open(kind, "") + &ball
}

fn trace(assembly: &Assembly, launch: &Launch<2>) -> (Vec<Leaf<2>>, Outcome<2>) {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    outcome.assert_balanced(leaves, 1e-12, launch);
    (leaves.to_vec(), *outcome)
}

#[test]
fn what_stands_in_a_perfect_cloak_is_not_seen() {
    let mut numbers = Numbers(7);
    for kind in ["cylinder-cloak", "sphere-cloak"] {
        let full = assembly(&with_ball(kind, 3.9, DVec3::ZERO));
        let mut met = 0;
        for _ in 0..400 {
            let direction = numbers.direction();
            let across = direction.cross(numbers.direction()).normalize();
            let ray = launch(across * 10.0 * numbers.next() - direction * 50.0, direction);
            // From outside: a ray along the cylinder may start in its core.
            if kind == "cylinder-cloak" && ray.origin.truncate().length() < 10.0 {
                continue;
            }
            let (leaves, outcome) = trace(&full, &ray);
            assert_eq!((leaves.len(), outcome.stats), (1, TraceStats::default()), "{ray:?}");
            let leaf = leaves[0];
            let along = (leaf.position - ray.origin).dot(ray.direction);
            let beside = leaf.position - ray.origin - ray.direction * along;
            assert!(leaf.body().is_none() && leaf.direction.distance(ray.direction) < 1e-10);
            assert!(beside.length() < 1e-9 && (leaf.optical_path - along).abs() < 1e-9);
            met += usize::from(leaf.met_device);
        }
        assert!(met > 300, "{kind} {met}");
        // Exactly at the axis or the centre, too.
        let (leaves, _) = trace(&full, &launch(DVec3::new(-50.0, 0.0, 0.0), DVec3::X));
        assert!(leaves.len() == 1 && leaves[0].direction.distance(DVec3::X) < 1e-10);
    }
}

#[test]
fn pictures_of_full_perfect_cloaks_are_empty_views() {
    let camera = "[camera]\nresolution = [96, 72]\nsamples = 1\n";
    let empty = png(camera);
    for kind in ["cylinder-cloak", "sphere-cloak"] {
        let full = png(&format!("{camera}{}", with_ball(kind, 3.9, DVec3::ZERO)));
        let (pixels, steps) = difference(&full, &empty);
        assert!(pixels <= 1 && steps <= 1, "{kind} {pixels} {steps}");
        let ball = with_ball(kind, 3.9, DVec3::ZERO).replace(&open(kind, ""), "");
        assert!(difference(&png(&format!("{camera}{ball}")), &empty).0 > 30, "{kind}");
    }
}

/// All light of the core of a perfect cloak is reflected at its border, as by a mirror.
#[test]
fn light_in_a_perfect_cloak_stays_there() {
    let middle = DVec3::new(-2.0, 0.5, 0.0);
    for (kind, across) in [("cylinder-cloak", true), ("sphere-cloak", false)] {
        let full = assembly(&with_ball(kind, 1.0, middle));
        let start = DVec3::new(2.5, 0.5, 0.3);
        assert_eq!(full.device_containing(start), None);
        let mut compared = 0;
        for n in 1..=300 {
            // Towards a point of the border from which the way leads to the ball.
            let angle = std::f64::consts::TAU * spread(n, 0);
            let z = if across { 0.3 } else { 4.0 * (spread(n, 1) - 0.5) };
            let size = if across { 4.0 } else { (16.0 - z * z).sqrt() };
            let at = DVec3::new(size * angle.cos(), size * angle.sin(), z);
            let normal = if across { at.with_z(0.0) } else { at }.normalize();
            let direction = (at - start).normalize();
            let on = direction - 2.0 * direction.dot(normal) * normal;
            let beside = |at: DVec3, direction: DVec3| (middle - at).cross(direction).length();
            if beside(start, direction) < 1.01 || beside(at, on) > 0.99 {
                continue;
            }
            let (leaves, outcome) = trace(&full, &launch(start, direction));
            assert_eq!((leaves.len(), outcome.stats), (1, TraceStats::default()), "{kind} {n}");
            let leaf = leaves[0];
            assert_eq!(leaf.body(), Some(1), "{kind} {at} {leaf:?}");
            assert!(leaf.direction.distance(on) < 1e-12 && leaf.power[0] > 1.0 - 1e-12, "{leaf:?}");
            compared += 1;
        }
        assert!(compared > 30, "{kind} {compared}");
        // At the border head-on it turns back as well: the limit.
        for start in [DVec3::new(2.5, 0.0, 0.0), DVec3::new(2.0, -0.2, 0.0)] {
            let (leaves, outcome) = trace(&full, &launch(start, start));
            let back: f64 = leaves.iter().map(|leaf| leaf.power[0]).sum();
            assert!(leaves.iter().all(|leaf| leaf.body() == Some(1)), "{kind} {leaves:?}");
            assert!(back > 1.0 - 1e-7 && outcome.stats == TraceStats::default(), "{kind} {back}");
            assert!(leaves[0].direction.distance(-start.normalize()) < 1e-12);
        }
    }
}

/// The ordinary wave of the cylinder with a radial optic axis comes to the core, and through it:
/// straight rays of index k, for E along z in the plane.
#[test]
fn the_ordinary_wave_of_a_radial_axis_passes_the_core() {
    let (a, b): (f64, f64) = (4.0, 10.0);
    let k = b / (b - a);
    let assembly = assembly(&open("cylinder-cloak", "material = \"radial-uniaxial\""));
    let mut passed = 0;
    for n in 1..=200 {
        // The impact parameter; inside the shell that over k, in the core as outside again.
        let impact = 6.0 * (spread(n, 0) - 0.5);
        let ray = launch(DVec3::new(-50.0, impact, 0.0), DVec3::X);
        let (leaves, _) = trace(&assembly, &ray);
        let chord = |radius: f64, h: f64| (radius * radius - h * h).sqrt();
        let turned = 2.0
            * ((impact / b).asin() - (impact / (k * b)).asin() + (impact / (k * a)).asin()
                - (impact / a).asin());
        let shell = chord(b, impact / k) - chord(a, impact / k);
        let path = 50.0 - chord(b, impact) + 2.0 * k * shell + 2.0 * chord(a, impact);
        let cos = |radius: f64, index: f64| (1.0 - (impact / (radius * index)).powi(2)).sqrt();
        let [outer, inner] =
            [b, a].map(|radius| fresnel(cos(radius, 1.0), k * cos(radius, k), 1.0, k)[0]);
        let expected = DVec3::new(turned.cos(), -turned.sin(), 0.0);
        let leaf = leaves.iter().find(|leaf| (leaf.optical_path - path).abs() < 1e-9);
        let leaf = leaf.unwrap_or_else(|| panic!("{impact} {path} {leaves:?}"));
        assert!(leaf.direction.distance(expected) < 1e-9, "{impact} {leaf:?} {expected}");
        assert!((leaf.power[0] - (outer * inner).powi(2)).abs() < 1e-9, "{impact} {leaf:?}");
        assert!(leaf.power[1] < 1e-9);
        passed += 1;
    }
    assert_eq!(passed, 200);
}

const LENS: [f64; 2] = [10.02, 4.25];

fn upper_half() -> GradedHalf {
    GradedHalf::new(gaussian(LENS[0], LENS[1]), 1.0, [25.0, 28.57], 0.02)
}

/// Where a ray in the core meets the border, by plain bisection; the point of the upper half, and
/// the sign of the half.
fn to_border(half: &GradedHalf, ray: &Launch<2>) -> Option<(f64, DVec3, f64)> {
    let at = |t: f64| ray.origin + ray.direction * t;
    let outside = |t: f64| {
        let at = at(t);
        half.invert(DVec3::new(at.x, at.y.abs(), 0.0)).im > 0.0
    };
    let first = (1..).map(|k| f64::from(k) * 0.01).take_while(|t| at(*t).x.abs() < 20.0);
    let first = first.into_iter().find(|t| outside(*t))?;
    let (mut low, mut high) = (first - 0.01, first);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if outside(middle) { high = middle } else { low = middle }
    }
    let side = at(low).y.signum();
    Some((low, at(low) * DVec3::new(1.0, side, 1.0), side))
}

#[test]
fn light_leaves_the_core_of_the_double_gaussian_cloak_by_snells_law() {
    let half = upper_half();
    let assembly = assembly(&open("double-gaussian-cloak", ""));
    let (mut compared, mut inside) = (0, 0);
    for n in 1..=250 {
        let origin = DVec3::new(
            10.0 * (spread(n, 0) - 0.5),
            3.0 * (spread(n, 1) - 0.5),
            20.0 * (spread(n, 2) - 0.5),
        );
        let angle = std::f64::consts::TAU * spread(n, 3);
        let slope = 1.6 * (spread(n, 4) - 0.5);
        let ray = launch(origin, DVec3::new(angle.cos(), angle.sin(), slope));
        assert_eq!(assembly.device_containing(origin), None);
        let (leaves, outcome) = trace(&assembly, &ray);
        assert_eq!(outcome.stats, TraceStats::default(), "{ray:?}");
        let Some((distance, at, side)) = to_border(&half, &ray) else { continue };
        let flip = |v: DVec3| v * DVec3::new(1.0, side, 1.0);
        let up = half.floor_normal(at);
        let square = half.squared_index(at).value;
        let direction = flip(ray.direction);
        let Some(p) = refract(direction, up, square) else { continue };
        let Some(expected) = half.out(at, p, distance) else { continue };
        if expected.mirrored {
            // It has come to the core once more, where it is no mirror.
            continue;
        }
        let leaf = strongest(&leaves);
        let off = [
            (leaf.position - flip(expected.position)).length(),
            (leaf.optical_path - expected.optical_path).abs(),
            10.0 * (leaf.direction - flip(expected.direction)).length(),
        ];
        assert!(off.iter().all(|off| *off < 1e-7), "{n} {off:?}");
        // s and p of the border together; the cut takes a little of either.
        let passed = fresnel(direction.dot(up), p.dot(up), 1.0, square.sqrt());
        let passed: f64 = passed.iter().sum();
        let [one, other] = expected.transmitted;
        let power = leaf.power[0] + leaf.power[1];
        let between = passed * one.min(other) - 1e-9..=passed * one.max(other) + 1e-9;
        assert!(between.contains(&power), "{n} {power} {between:?}");
        compared += 1;
        // And back: the strongest path, and with it into the core.
        let back = Launch {
            origin: leaf.position + leaf.direction * 10.0,
            direction: -leaf.direction,
            electric: leaf.electric.map(|field| {
                let whole = field.norm_squared();
                field.conj() * whole.powf(-0.5)
            }),
        };
        let (leaves, _) = trace(&assembly, &back);
        inside += u32::from(leaves.iter().any(|home| {
            // On from where the ray has started, through the other border of the core.
            home.optical_path > leaf.optical_path + 10.0
        }));
    }
    assert!(compared > 100 && inside == compared, "{compared} {inside}");
}

/// A ray through the whole cloak and its core comes back along the same path with the same power.
#[test]
fn paths_through_the_core_are_reciprocal() {
    let assembly = assembly(&open("double-gaussian-cloak", "rotation = 20"));
    let metal = rays::assembly("[[device]]\nkind = \"double-gaussian-cloak\"\nrotation = 20\n");
    let mut through = 0;
    for ray in launches_around(200, [70.0, 40.0], DVec3::new(10.0, 6.0, 20.0)) {
        let (leaves, outcome) = trace(&assembly, &ray);
        assert_eq!(outcome.stats.lost, 0);
        let leaf = strongest(&leaves);
        if leaf.power[0] < 0.5 || leaf.power[1] < 0.5 {
            continue;
        }
        let field = leaf.electric[0];
        let back = Launch {
            origin: leaf.position + leaf.direction * 10.0,
            direction: -leaf.direction,
            electric: [field.conj() * field.norm_squared().powf(-0.5)],
        };
        let mut tracer = Tracer::new(&assembly, LIMITS);
        let (home, _) = tracer.trace(&back);
        let home = home.iter().max_by(|a, b| a.power[0].total_cmp(&b.power[0])).unwrap();
        let to_start = ray.origin - home.position;
        let along = to_start.dot(home.direction);
        assert!((to_start - home.direction * along).length() < 1e-6, "{ray:?}");
        assert!((home.optical_path + along - leaf.optical_path - 10.0).abs() < 1e-6);
        // The amplitude between two fields is the same both ways; what of it is in this one:
        let same = home.electric[0].dot(ray.electric[0].conj()).norm_sqr();
        assert!((same - leaf.power[0]).abs() < 1e-6, "{same} {leaf:?}");
        let (metal, _) = trace(&metal, &ray);
        through += u32::from((strongest(&metal).direction - leaf.direction).length() > 0.1);
    }
    assert!(through > 30, "{through}");
}

#[test]
fn bodies_may_stand_in_the_core_and_nowhere_else() {
    let body = |keys: &str| format!("[[device]]\nkind = \"body\"\nsurface = {{}}\n{keys}\n");
    for (kind, fits, too_large) in [
        ("cylinder-cloak", "shape = \"sphere\"\nradius = 4", "shape = \"sphere\"\nradius = 4.001"),
        (
            "cylinder-cloak",
            "shape = \"box\"\nsize = [5, 6, 99]",
            "shape = \"box\"\nsize = [5.1, 6.2, 1]",
        ),
        (
            "sphere-cloak",
            "shape = \"cylinder\"\nradius = 3\nlength = 5.2",
            "shape = \"cylinder\"\nradius = 3\nlength = 5.3",
        ),
        (
            "double-gaussian-cloak",
            "shape = \"sphere\"\nradius = 2",
            "shape = \"sphere\"\nradius = 4.25",
        ),
        (
            "double-gaussian-cloak",
            "shape = \"box\"\nsize = [9, 4, 60]",
            "shape = \"box\"\nsize = [9, 7, 60]",
        ),
        ("square-cloak", "shape = \"sphere\"\nradius = 4.9", "shape = \"sphere\"\nradius = 5"),
    ] {
        for place in ["", "rotation = 31\nposition = [2, 1, -7]\n"] {
            let scene = |keys: &str| open(kind, place) + &body(&format!("{place}{keys}"));
            assert!(try_bench(&scene(fits)).is_ok(), "{kind} {fits}");
            let error = try_bench(&scene(too_large)).unwrap_err();
            assert!(
                matches!(
                    error,
                    PreparedSceneError::Overlap {
                        first: DeviceName { number: 0, .. },
                        second: DeviceName { number: 1, .. }
                    }
                ),
                "{kind} {too_large} {error}"
            );
        }
        // With its metal nothing fits in.
        let full = format!("[[device]]\nkind = \"{kind}\"\n{}", body(fits));
        assert!(matches!(try_bench(&full), Err(PreparedSceneError::Overlap { .. })), "{kind}");
    }
    // Cloaks in a cloak.
    let inner = "[[device]]\nkind = \"cylinder-cloak\"\ninner = 1\nouter = 3.9\n";
    assert!(try_bench(&(open("cylinder-cloak", "") + inner)).is_ok());
    let inner = "[[device]]\nkind = \"cylinder-cloak\"\ninner = 1\nouter = 4.1\n";
    assert!(try_bench(&(open("cylinder-cloak", "") + inner)).is_err());
}

#[test]
fn nothing_is_before_the_core_of_a_short_cloak() {
    for (kind, inside, beside) in [
        ("cylinder-cloak", DVec3::new(1.0, 2.0, 30.0), DVec3::new(5.0, 2.0, 30.0)),
        ("double-gaussian-cloak", DVec3::new(1.0, 2.0, 30.0), DVec3::new(5.0, 6.0, 30.0)),
    ] {
        let assembly = assembly(&open(kind, "length = 20"));
        let (leaves, _) = trace(&assembly, &launch(inside, DVec3::NEG_Z));
        assert!(leaves.len() == 1 && !leaves[0].met_device, "{kind} {leaves:?}");
        assert!(trace(&assembly, &launch(beside, DVec3::NEG_Z)).0[0].met_device, "{kind}");
        // In through the end, and on to the border within.
        let slanted = launch(inside, DVec3::new(0.0, 0.3, -1.0));
        let (leaves, _) = trace(&assembly, &slanted);
        assert!(leaves.iter().all(|leaf| leaf.met_device && leaf.position.is_finite()), "{kind}");
    }
}

#[test]
fn what_has_no_core_cannot_open_it() {
    for device in [
        "gaussian-carpet",
        "grating-carpet",
        "quasi-conformal-carpet",
        "luneburg-lens",
        "sphere-cloak\"\nshow = \"bare",
        "double-gaussian-cloak\"\nshow = \"mirror",
        "square-cloak\"\nshow = \"bare",
    ] {
        let error = try_bench(&open(device, "")).unwrap_err();
        assert_eq!(error.key(), "device.0.core");
        assert!(error.to_string().contains("no core"), "{error}");
    }
}
