//! Devices that touch: nothing leaks between them, and what is cut out of one glass is one glass.

use crate::long::count;
use crate::pictures::picture;
use crate::rays::{Numbers, assembly, launch, placed};
use cloakroom::assembly::Assembly;
use cloakroom::output::Samples;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-6 };

/// The leaves of a ray, whose account must add up with nothing lost.
fn leaves(assembly: &Assembly, ray: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(ray);
    outcome.assert_balanced(leaves, 1e-9, ray);
    leaves.to_vec()
}

/// What goes on along a direction.
fn onward(leaves: &[Leaf<2>], direction: DVec3) -> f64 {
    let on = leaves.iter().filter(|leaf| leaf.direction.dot(direction) > 0.5);
    on.map(|leaf| leaf.power[0]).sum()
}

/// A block of half the size `half` along x, as a device of its own kind, at a place.
fn block(kind: usize, metal: bool, half: f64, place: &str) -> String {
    let corners = format!("[[{0}, {0}], [-{0}, {0}], [-{0}, -{0}], [{0}, -{0}]]", half);
    let filling = if metal { "metal = true" } else { "permittivity = 2.25" };
    let prism = format!("[[device.prism]]\ncorners = {corners}\n{filling}\n");
    let size = format!("size = [{0}, {0}, 4]", 2.0 * half);
    match (kind, metal) {
        (0, _) => format!("[[device]]\nkind = \"prisms\"\n{place}\n{prism}"),
        (1, _) => format!("[[device]]\nkind = \"prisms\"\nlength = 4\n{place}\n{prism}"),
        (_, false) => {
            format!("[[device]]\nkind = \"body\"\nshape = \"box\"\n{size}\n{filling}\n{place}\n")
        }
        (_, true) => format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\n{size}\nsurface = {{ color = [1, 1, 1] }}\n{place}\n"
        ),
    }
}

#[test]
fn nothing_goes_through_metal_of_one_decimal_beside_glass() {
    // Rounded, x + h and x' - h differ by an ulp or not: all places where blocks of one size touch.
    for (half, at) in (1..=10).flat_map(|half| (-30..=30).map(move |at| (half, at))) {
        let beyond = at + 2 * half;
        let place = |tenths: i32| format!("position = [{:.1}, 0, 0]", f64::from(tenths) / 10.0);
        let half = f64::from(half) / 10.0;
        for (glass, metal) in [(0, 0), (0, 2), (1, 1), (2, 0), (2, 2)] {
            let scene =
                block(glass, false, half, &place(at)) + &block(metal, true, half, &place(beyond));
            let assembly = assembly(&scene);
            for y in [0.0, 0.49, -0.9] {
                let ray = launch(DVec3::new(-20.0, y * half, 0.1), DVec3::X);
                let leaves = leaves(&assembly, &ray);
                let through: Vec<_> =
                    leaves.iter().filter(|leaf| leaf.body().is_none()).copied().collect();
                assert!(onward(&through, DVec3::X) == 0.0, "through the metal of\n{scene}");
            }
        }
    }
}

#[test]
fn a_pane_that_touches_the_photograph_shows_it() {
    let seen = |x: f64, medium: &str| {
        let scene = format!(
            "[camera]\nresolution = [64, 48]\nsamples = 1\n[photograph]\nx = 20.15\n\
             [[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 0.1\n\
             position = [{x}, 0, 0]\n{medium}\n"
        );
        let picture = picture(&scene);
        let colors = picture.channels.iter().take(3).flat_map(|channel| match &channel.samples {
            Samples::F32(samples) => samples.iter().map(|sample| f64::from(*sample)),
            _ => panic!("{}", channel.name),
        });
        colors.collect::<Vec<_>>()
    };
    // What it shows is brighter by what its far face would reflect, and by nothing else.
    for (medium, reflectance) in
        [("permittivity = 1.2\npermeability = 1.2", 0.0), ("permittivity = 2.25", 0.04)]
    {
        let (touching, apart) = (seen(20.1, medium), seen(20.0, medium));
        let brightness = apart.iter().sum::<f64>() / apart.len() as f64;
        assert!(brightness > 0.05, "{brightness}");
        let off: Vec<f64> = touching
            .iter()
            .zip(&apart)
            .map(|(a, b)| (a - (1.0 + reflectance) * b).abs() / brightness)
            .collect();
        let far = off.iter().filter(|off| **off > 0.01).count();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        assert!(mean < 0.002 && far * 50 < off.len(), "{medium}: {mean}, {far} of {}", off.len());
    }
}

#[test]
fn sides_that_differ_in_the_sixth_decimal_are_one() {
    let prism = |from: f64, to: f64| {
        format!(
            "[[device.prism]]\ncorners = [[{from}, -5], [{to}, -5], [{to}, 5], [{from}, 5]]\n\
             permittivity = 2.25\n"
        )
    };
    let device = |prisms: String| assembly(&format!("[[device]]\nkind = \"prisms\"\n{prisms}"));
    let whole = device(prism(0.0, 10.0));
    let mut numbers = Numbers(17);
    for (end, start) in [(5.0, 4.999999), (4.999999, 5.0), (5.0, 5.000001), (5.0, 5.0)] {
        for swapped in [false, true] {
            let [a, b] = [prism(0.0, end), prism(start, 10.0)];
            let cut = device(if swapped { b + &a } else { a + &b });
            for _ in 0..20 {
                let direction = DVec3::new(1.0, numbers.between(-0.2, 0.2), numbers.next());
                let ray = launch(direction * -10.0, direction);
                let [one, other] = [&whole, &cut].map(|assembly| leaves(assembly, &ray));
                assert_eq!(one.len(), other.len(), "{end} {start} {ray:?}");
                for (one, other) in one.iter().zip(&other) {
                    assert!((one.power[0] - other.power[0]).abs() < 1e-9, "{one:?} {other:?}");
                    assert!(one.position.distance(other.position) < 1e-5, "{one:?} {other:?}");
                    assert!(one.direction.distance(other.direction) < 1e-9, "{one:?} {other:?}");
                }
            }
        }
    }
}

#[test]
fn rounded_sides_of_one_cut_that_are_parallel_are_no_gap() {
    // A square cut into five; two pieces along one cut, between corners on each other's sides, are
    // 1.06e-5 apart and parallel, for corners of four decimals are points of a grid.
    let glass =
        |corners: &str| format!("[[device.prism]]\ncorners = [{corners}]\npermittivity = 2.25\n");
    let pieces = [
        "[-3.0139, 0.4589], [-3.4186, -0.7233], [-1.3164, 1.8941]",
        "[1.0122, 2.8244], [-0.2281, 3.2491], [-2.6959, 0.1765]",
        "[-0.2281, 3.2491], [-1.8665, 3.8100], [-3.0139, 0.4589], [-1.3164, 1.8941]",
        "[3.5117, 0.9951], [3.8100, 1.8665], [1.0122, 2.8244], [-1.5109, 1.0227]",
        "[-3.8100, -1.8665], [1.8665, -3.8100], [3.5117, 0.9951], [-1.5109, 1.0227], [-2.6959, 0.1765], \
         [-3.4186, -0.7233]",
    ];
    let device = |prisms: &[&str]| {
        let prisms: String = prisms.iter().map(|corners| glass(corners)).collect();
        assembly(&format!("[[device]]\nkind = \"prisms\"\n{prisms}"))
    };
    let whole = device(&["[-3.81, -1.8665], [1.8665, -3.81], [3.81, 1.8665], [-1.8665, 3.81]"]);
    let cut = device(&pieces);
    for i in 0..100 {
        let target = DVec3::new(0.0, f64::from(i) * 0.05 - 2.5, 0.3);
        let origin = DVec3::new(-20.0, 0.1, 0.2);
        let ray = launch(origin, (target - origin).normalize());
        let most = |assembly: &Assembly| {
            leaves(assembly, &ray).iter().map(|leaf| leaf.power[0]).fold(0.0, f64::max)
        };
        let [found, expected] = [&cut, &whole].map(most);
        assert!((found - expected).abs() < 1e-3, "{target} {found} {expected}");
    }
}

#[test]
fn a_gap_with_parallel_sides_is_no_rounding() {
    // Beyond the critical angle: through the gap goes nothing, for rays do not tunnel.
    let scene = |gap: f64| {
        let [near, far] = [gap - 1.0, gap + 1.0].map(|y| (y * 1e9).round() / 1e9);
        assembly(&format!(
            "[[device]]\nkind = \"prisms\"\n\
             [[device.prism]]\ncorners = [[-1, -1], [1, -1], [-1, 1]]\npermittivity = 2.25\n\
             [[device.prism]]\ncorners = [[1, {near:?}], [1, {far:?}], [-1, {far:?}]]\n\
             permittivity = 2.25\n"
        ))
    };
    let through = |gap: f64| {
        onward(&leaves(&scene(gap), &launch(DVec3::new(-5.0, 0.3, 0.0), DVec3::X)), DVec3::X)
    };
    assert_eq!(through(1e-4), 0.0);
    assert_eq!(through(3e-6), 0.0);
    let touching = through(0.0);
    assert!(touching > 0.9, "{touching}");
}

#[test]
fn blocks_of_one_glass_that_touch_are_one_block() {
    let mut numbers = Numbers(11);
    for _ in 0..count(100, 2000) {
        let pose = numbers.pose();
        let place = |x: f64| placed(pose.to_world(DVec3::X * x), &pose.rotation());
        let [a, b] = [0, 1].map(|_| numbers.between(0.0, 3.0) as usize);
        let assembly =
            assembly(&(block(a, false, 1.0, &place(-1.0)) + &block(b, false, 1.0, &place(1.0))));
        for _ in 0..10 {
            let slant = 0.3 * DVec2::new(numbers.next() - 0.5, numbers.next() - 0.5);
            let local = DVec3::new(1.0, slant.x, slant.y).normalize();
            let through = DVec3::new(0.0, numbers.between(-0.5, 0.5), numbers.between(-1.0, 1.0));
            let ray = launch(pose.to_world(through - local * 20.0), pose.vector_to_world(local));
            let leaves = leaves(&assembly, &ray);
            // Two faces: of the part T of the power that each lets through, T² goes on at once.
            let first: f64 = leaves.iter().map(|leaf| leaf.power[0]).fold(0.0, f64::max);
            let (cos_i, sin_i) = (local.x, (1.0 - local.x * local.x).sqrt());
            let cos_t = (1.0 - (sin_i / 1.5).powi(2)).sqrt();
            let s = ((cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t)).powi(2);
            let p = ((1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t)).powi(2);
            let bounds = [(1.0 - s).powi(2), (1.0 - p).powi(2)];
            assert!(
                first > bounds[0].min(bounds[1]) - 1e-9 && first < bounds[0].max(bounds[1]) + 1e-9,
                "{first} {bounds:?} {ray:?}"
            );
            assert!(onward(&leaves, ray.direction) > 0.9, "{leaves:?}");
        }
    }
}
