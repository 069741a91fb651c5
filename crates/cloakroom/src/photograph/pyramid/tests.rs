use super::*;

/// A repeatable stream of numbers from 0 to 1.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn image(width: usize, height: usize, light: impl Fn(usize, usize) -> f32) -> LinearImage {
    let texels = (0..width * height).flat_map(|i| [light(i % width, i / width); 3]).collect();
    LinearImage { width, height, texels: Texels::Linear(texels) }
}

fn pyramid(width: usize, height: usize, light: impl Fn(usize, usize) -> f32) -> Pyramid {
    Pyramid::new(image(width, height, light), Edges::Clamp)
}

/// The average over a square patch of the image as it is, texels being little squares.
fn exact_average(light: impl Fn(usize, usize) -> f32, x: f64, y: f64, width: f64) -> f32 {
    let overlap =
        |i: usize, from: f64, to: f64| (to.min(i as f64 + 1.0) - from.max(i as f64)).max(0.0);
    let range =
        |middle: f64| (middle - width / 2.0).floor() as usize..=(middle + width / 2.0) as usize;
    let mut sum = 0.0;
    for j in range(y) {
        for i in range(x) {
            let area = overlap(i, x - width / 2.0, x + width / 2.0)
                * overlap(j, y - width / 2.0, y + width / 2.0);
            sum += area * f64::from(light(i, j));
        }
    }
    (sum / (width * width)) as f32
}

#[test]
fn constant_images_stay_constant() {
    let flat = pyramid(37, 21, |_, _| 0.25);
    let mut random = noise(1);
    for _ in 0..2000 {
        let mut derivative = || [(random() - 0.5) * 0.6, (random() - 0.5) * 0.6];
        let (dx, dy) = (derivative(), derivative());
        let at = [random(), random()];
        for averaging in [Averaging::Sharp, Averaging::Quick] {
            let light = flat.sample_with((Edges::Clamp, averaging), at, [dx, dy]);
            let even = light.iter().all(|value| (value - 0.25).abs() < 1e-6);
            assert!(even, "{averaging:?} {dx:?} {dy:?} {light:?}");
        }
    }
}

#[test]
fn ramps_stay_ramps() {
    // The average of a linear image over any patch is its value in the middle.
    let ramp = pyramid(200, 200, |x, y| (x as f32 + 0.5) / 200.0 + (y as f32 + 0.5) / 400.0);
    let mut random = noise(2);
    for _ in 0..2000 {
        let mut derivative = || [(random() - 0.5) * 0.04, (random() - 0.5) * 0.04];
        let (dx, dy) = (derivative(), derivative());
        let [u, v] = [0.3 + 0.4 * random(), 0.3 + 0.4 * random()];
        let expected = (u + v / 2.0) as f32;
        for averaging in [Averaging::Sharp, Averaging::Quick] {
            let light = ramp.sample_with((Edges::Clamp, averaging), [u, v], [dx, dy])[0];
            let off = (light - expected).abs();
            assert!(off < 2e-5, "{averaging:?} {u} {v} {dx:?} {dy:?}: {light} {expected}");
        }
    }
}

#[test]
fn fine_patterns_shrink_to_their_mean() {
    let size = 256;
    let checkerboard = pyramid(size, size, |x, y| ((x + y) % 2) as f32);
    let mut random = noise(3);
    for width in [2.0, 2.7, 4.0, 6.5, 16.0, 100.0] {
        let step = width / size as f64;
        for _ in 0..500 {
            let at = [0.1 + 0.8 * random(), 0.1 + 0.8 * random()];
            let light = checkerboard.sample(at, [step, 0.0], [0.0, step])[0];
            assert!((light - 0.5).abs() < 0.015, "width {width}: {light}");
        }
    }
}

#[test]
fn zone_plate_does_not_alias() {
    // Frequency grows outwards to one cycle in two texels at the edge.
    let size = 512;
    let light = |x: usize, y: usize| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let k = std::f32::consts::PI / (2.0 * size as f32);
        0.5 + 0.5 * (k * (x * x + y * y)).cos()
    };
    let plate = pyramid(size, size, light);
    let mut random = noise(4);
    for width in [3.0, 5.0, 8.0] {
        let (mut worst, mut worst_exact) = (0.0_f32, 0.0_f32);
        for _ in 0..4000 {
            let at = [0.6 + 0.35 * random(), 0.6 + 0.35 * random()];
            let step = width / size as f64;
            let value = plate.sample(at, [step, 0.0], [0.0, step])[0];
            worst = worst.max((value - 0.5).abs());
            let exact = exact_average(light, at[0] * size as f64, at[1] * size as f64, width);
            worst_exact = worst_exact.max((exact - 0.5).abs());
        }
        // No more ghosts than an exact area average leaves.
        assert!(worst < worst_exact.max(0.02) * 1.3, "width {width}: {worst} {worst_exact}");
    }
}

#[test]
fn as_sharp_as_an_exact_area_average() {
    // A random picture: the contrast that is left, and the difference from the exact average.
    let size = 256;
    let mut random = noise(5);
    let values: Vec<f32> = (0..size * size).map(|_| random() as f32).collect();
    let light = |x: usize, y: usize| values[y * size + x];
    let picture = pyramid(size, size, light);
    for width in [1.0, 1.4, 2.0, 2.8, 3.3, 4.0, 5.6, 7.0, 8.0] {
        let (mut ours, mut exact, mut both) = (0.0, 0.0, 0.0);
        for _ in 0..4000 {
            let at = [0.1 + 0.8 * random(), 0.1 + 0.8 * random()];
            let step = width / size as f64;
            let a = f64::from(picture.sample(at, [step, 0.0], [0.0, step])[0]) - 0.5;
            let b = exact_average(light, at[0] * size as f64, at[1] * size as f64, width);
            let b = f64::from(b) - 0.5;
            ours += a * a;
            exact += b * b;
            both += a * b;
        }
        let contrast = (ours / exact).sqrt();
        let correlation = both / (ours * exact).sqrt();

        assert!((0.93..1.08).contains(&contrast), "width {width}: contrast {contrast}");
        assert!(correlation > 0.9, "width {width}: correlation {correlation}");
    }
}

#[test]
fn oblique_patches_average_along_their_length() {
    // Stripes along one diagonal: a patch along the stripes keeps them, one across loses them.
    let size = 512;
    let stripes = pyramid(size, size, |x, y| (((x + y) / 8) % 2) as f32);
    let step = 1.0 / size as f64;
    let (along, across) = ([40.0 * step, -40.0 * step], [40.0 * step, 40.0 * step]);
    let (thin_across, thin_along) = ([step, step], [step, -step]);
    let (mut kept, mut lost) = (0.0_f32, 0.0_f32);
    let mut random = noise(6);
    for _ in 0..1000 {
        let at = [0.2 + 0.6 * random(), 0.2 + 0.6 * random()];
        kept = kept.max((stripes.sample(at, along, thin_across)[0] - 0.5).abs());
        lost = lost.max((stripes.sample(at, across, thin_along)[0] - 0.5).abs());
    }
    assert!(kept > 0.4, "{kept}");
    assert!(lost < 0.1, "{lost}");
}

#[test]
fn results_do_not_jump() {
    let size = 128;
    let mut random = noise(7);
    let values: Vec<f32> = (0..size * size).map(|_| random() as f32).collect();
    let picture = pyramid(size, size, |x, y| values[y * size + x]);
    // Footprints from magnified to the whole image, stretched more and less, turned by 1 radian.
    let (sin, cos) = 1.0_f64.sin_cos();
    for ratio in [0.0, 1.0, 1.3, 3.0, 10.0, 40.0] {
        let value = |t: f64| {
            let width = 3e-3 * (8.0 * t).exp();
            let long = width * (1.0 + ratio * (40.0 * t).sin().abs());
            let (dx, dy) = ([long * cos, long * sin], [-width * sin, width * cos]);
            picture.sample([0.437, 0.561], dx, dy)[0]
        };
        for step in 0..4000 {
            let seen = |t: f64| (t, value(t));
            let [mut a, mut b] = [step, step + 1].map(|step| seen(f64::from(step) / 4000.0));
            // A jump stays however closely one looks; a slope goes away.
            for _ in 0..20 {
                let middle = seen(0.5 * (a.0 + b.0));
                let first_half = (middle.1 - a.1).abs();
                if first_half > (b.1 - middle.1).abs() { b = middle } else { a = middle }
            }
            let jump = (b.1 - a.1).abs();
            assert!(jump < 2e-6, "ratio {ratio}: {jump} at {}", a.0);
        }
    }
}

#[test]
fn tiny_changes_stay_tiny() {
    let size = 256;
    let mut random = noise(8);
    let values: Vec<f32> = (0..size * size).map(|_| random() as f32).collect();
    let picture = pyramid(size, size, |x, y| values[y * size + x]);
    for _ in 0..20_000 {
        let scale = (random() * 8.0 - 7.0).exp();
        let mut vector = || [(random() - 0.5) * scale, (random() - 0.5) * scale];
        let (dx, dy) = (vector(), vector());
        let at = [random(), random()];
        let nudge = |v: [f64; 2]| v.map(|x| x * (1.0 + 1e-12));
        let a = picture.sample(at, dx, dy)[0];
        let b = picture.sample(nudge(at), nudge(dx), nudge(dy))[0];
        assert!((a - b).abs() < 2e-6, "{at:?} {dx:?} {dy:?}: {a} {b}");
    }
}

#[test]
fn magnified_images_do_not_overshoot() {
    let edge = pyramid(16, 16, |x, _| if x < 8 { 0.0 } else { 1.0 });
    let mut previous = 0.0;
    for step in 0..=1000 {
        let value = edge.sample([f64::from(step) / 1000.0, 0.5], [1e-4, 0.0], [0.0, 1e-4])[0];
        assert!((0.0..=1.000_001).contains(&value));
        assert!(value >= previous - 1e-6, "not monotonic");
        previous = value;
    }
    assert!((previous - 1.0).abs() < 1e-6);
}

#[test]
fn bad_arguments_are_harmless() {
    let picture = pyramid(33, 7, |x, y| ((x * y) % 2) as f32);
    let bad = [0.0, -1.0, 2.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for a in bad {
        for b in bad {
            for c in bad {
                let light = picture.sample([a, b], [b, c], [c, a]);
                assert!(
                    light.iter().all(|value| (-1e-6..=1.000_001).contains(value)),
                    "{a} {b} {c}: {light:?}"
                );
            }
        }
    }
}

#[test]
fn every_size_works() {
    for width in 1..=12 {
        for height in [1, 2, 3, 7, 64] {
            let picture = pyramid(width, height, |_, _| 0.5);
            assert_eq!((picture.width(), picture.height()), (width, height));
            for step in [0.0, 0.1, 1.0, 10.0] {
                let light = picture.sample([0.3, 0.9], [step, 0.0], [0.0, step])[0];
                assert!((light - 0.5).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn codes_and_floats_look_the_same() {
    let (width, height) = (50, 30);
    let codes: Vec<u8> = (0..width * height * 3).map(|i| (i * 7919 % 256) as u8).collect();
    let floats = codes.iter().map(|&code| decode_table()[usize::from(code)]).collect();
    let a = Pyramid::new(LinearImage { width, height, texels: Texels::Srgb8(codes) }, Edges::Clamp);
    let b =
        Pyramid::new(LinearImage { width, height, texels: Texels::Linear(floats) }, Edges::Clamp);
    let mut random = noise(9);
    for _ in 0..500 {
        let at = [random(), random()];
        let step = random() * 0.2;
        assert_eq!(a.sample(at, [step, 0.0], [0.0, step]), b.sample(at, [step, 0.0], [0.0, step]));
    }
    assert!(a.memory() < b.memory());
}

#[test]
fn beyond_its_edges_an_image_is_seen_as_a_larger_one() {
    const SIDE: usize = 32;
    let light = |x: usize, y: usize| ((x * 37 + y * 91 + x * y) % 101) as f32 / 101.0;
    let small = pyramid(SIDE, SIDE, light);
    for edges in [Edges::Repeat, Edges::Mirror] {
        let there = |i: usize| match (edges, i / SIDE) {
            (Edges::Mirror, 0 | 2) => SIDE - 1 - i % SIDE,
            _ => i % SIDE,
        };
        let large = pyramid(3 * SIDE, 3 * SIDE, |x, y| light(there(x), there(y)));
        let mut random = noise(11);
        for _ in 0..2000 {
            let at = [3.0 * random() - 1.0, 3.0 * random() - 1.0];
            let [dx, dy] = [0, 1].map(|_| [0.1 * (random() - 0.5), 0.1 * (random() - 0.5)]);
            let third = |pair: [f64; 2]| pair.map(|x| x / 3.0);
            let seen = small.sample_with((edges, Averaging::Sharp), at, [dx, dy])[0];
            let expected = large.sample_with(
                (Edges::Clamp, Averaging::Sharp),
                third(at.map(|x| x + 1.0)),
                [third(dx), third(dy)],
            )[0];
            // At the outer edge the larger image ends.
            if at.iter().all(|x| (-0.7..1.7).contains(x)) {
                assert!((seen - expected).abs() < 1e-4, "{edges:?} {at:?}: {seen} {expected}");
            }
        }
        for at in [[1e9, -1e9], [f64::INFINITY, 0.3], [f64::NAN, 1e300]] {
            assert!((0.0..=1.0).contains(
                &small.sample_with((edges, Averaging::Sharp), at, [[1e9, 0.0], [0.0, 3.0]])[0]
            ));
        }
    }
}
