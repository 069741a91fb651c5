//! The polarization of the light that arrives, from rays traced backwards: against polarizers one
//! at a time, against light traced forwards, and against textbook optics.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::picture;
use crate::rays::{assembly, launch};
use cloakroom::output::Picture;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use num_complex::Complex64;
use optics::wave::arriving_stokes;

fn seen(device: &str, polarizer: &str) -> Picture {
    let text = format!(
        "[camera]\nresolution = [64, 48]\nsamples = 1\npolarizer = {polarizer}\n\
         [picture]\nchannels = [\"stokes\"]\n{device}"
    );
    picture(&text)
}

fn numbers(picture: &Picture, name: &str) -> Vec<f64> {
    let samples = &picture.channel(name).unwrap().samples;
    (0..samples.len()).map(|i| samples.get(i)).collect()
}

/// Stokes parameter `k`, color by color.
fn stokes(picture: &Picture, k: usize) -> Vec<f64> {
    numbers(picture, &format!("stokes.S{k}"))
}

/// An image, color by color, as [`stokes`] gives one.
fn image(picture: &Picture, prefix: &str) -> Vec<f64> {
    let planes = ["R", "G", "B"].map(|color| numbers(picture, &format!("{prefix}{color}")));
    (0..planes[0].len()).flat_map(|i| [planes[0][i], planes[1][i], planes[2][i]]).collect()
}

const TURNED: &str =
    "[[device]]\nkind = \"square-cloak\"\nmaterial = \"positive-uniaxial\"\nrotation = 12\n";

#[test]
fn every_polarizers_picture_follows_from_the_stokes_parameters() {
    let unpolarized = seen(TURNED, "\"none\"");
    let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|k| stokes(&unpolarized, k));
    let (h, v) = (image(&unpolarized, "horizontal."), image(&unpolarized, "vertical."));
    let mut largest = [0.0f64; 4];
    for i in 0..s0.len() {
        assert!((s0[i] - (h[i] + v[i]) / 2.0).abs() < 1e-6);
        assert!((s1[i] - (h[i] - v[i]) / 2.0).abs() < 1e-6);
        let polarized = s1[i].hypot(s2[i]).hypot(s3[i]);
        assert!(polarized <= s0[i] + 1e-6, "{polarized} of {}", s0[i]);
        for (largest, s) in largest.iter_mut().zip([&s0, &s1, &s2, &s3]) {
            *largest = largest.max(s[i].abs());
        }
    }
    // There is something of each to get wrong.
    assert!(largest.iter().all(|s| *s > 0.01), "{largest:?}");
    for degrees in [30.0, 45.0, 100.0, -45.0] {
        let through = seen(TURNED, &format!("{degrees:?}"));
        let seen = image(&through, "");
        let turn = 2.0 * f64::to_radians(degrees);
        let (s0, s1, s2) = (stokes(&through, 0), stokes(&through, 1), stokes(&through, 2));
        for i in 0..seen.len() {
            // The polarizer does not change what arrives at it; single precision.
            let expected = s0[i] + s1[i] * turn.cos() + s2[i] * turn.sin();
            assert!((seen[i] - expected).abs() < 1e-6, "{degrees}: {} {expected}", seen[i]);
        }
    }
}

#[test]
fn the_empty_view_is_unpolarized() {
    let empty = seen("", "\"none\"");
    let light = image(&empty, "");
    for (s0, light) in stokes(&empty, 0).into_iter().zip(light) {
        assert!((s0 - light).abs() < 1e-6);
    }
    for k in 1..4 {
        // But for the rounding of two unit vectors.
        assert!(stokes(&empty, k).iter().all(|s| s.abs() < 1e-14), "S{k}");
    }
}

#[test]
fn the_third_parameter_is_right_less_left_circular() {
    let assembly = assembly(TURNED);
    // Nothing pruned but what no launch carries, so that the trees are the same.
    let limits = Limits { min_power: 1e-7, tolerance: 1e-8 };
    let (mut tracer, mut circular) =
        (Tracer::<2>::new(&assembly, limits), Tracer::<2>::new(&assembly, limits));
    let mut largest: f64 = 0.0;
    for launch in rays(60) {
        let [h, v] = launch.electric;
        let s3: f64 = tracer
            .trace(&launch)
            .0
            .iter()
            .map(|leaf| arriving_stokes(leaf.electric[0], leaf.electric[1])[3])
            .sum();
        // Right-handed light has E_V = -i E_H; what detects it is launched as its conjugate.
        let quarter = |sign: f64| v.scaled(Complex64::new(0.0, sign));
        let electric =
            [1.0, -1.0].map(|sign| (h + quarter(sign)) * std::f64::consts::FRAC_1_SQRT_2);
        // Sums over all leaves are 1 for either: the share on one side of the device tells them
        // apart.
        let side = |leaf: &&Leaf<2>| leaf.direction.y > 0.0;
        let (leaves, _) = circular.trace(&Launch { electric, ..launch });
        let [right, left] =
            [0, 1].map(|i| leaves.iter().filter(side).map(|leaf| leaf.power[i]).sum::<f64>());
        let expected: f64 = tracer
            .trace(&launch)
            .0
            .iter()
            .filter(side)
            .map(|leaf| arriving_stokes(leaf.electric[0], leaf.electric[1])[3])
            .sum();
        assert!((expected - (right - left) / 2.0).abs() < 1e-5, "{expected} {right} {left}");
        // All of the sphere of directions sends as much of the one as of the other.
        assert!(s3.abs() < 1e-5, "{s3}");
        largest = largest.max(expected.abs());
    }
    assert!(largest > 0.02, "{largest}");
}

/// Rays of the paper's camera towards the device, horizontal and vertical.
fn rays(count: u32) -> impl Iterator<Item = Launch<2>> {
    (1..=count).map(|n| {
        let n = f64::from(n);
        let target = DVec3::new(100.0, 8.0 * (n * 0.618).sin(), 25.0 * (n * 0.755).cos());
        launch(DVec3::new(-100.0, 0.0, 0.0), target)
    })
}

/// Whether two leaves run along the same line, having taken the same optical path to it.
fn coincide(a: &Leaf<2>, b: &Leaf<2>) -> bool {
    let between = b.position - a.position;
    let along = between.dot(a.direction);
    (a.direction - b.direction).length() < 1e-8
        && (between - a.direction * along).length() < 1e-6
        && (a.optical_path + along - b.optical_path).abs() < 1e-6
}

/// The picture is made of rays traced from the camera. Here unpolarized light is sent from the far
/// end of each path, forwards, and its Stokes parameters are measured where it arrives.
#[test]
fn light_traced_forwards_arrives_as_rays_traced_backwards_say() {
    for material in ["positive", "negative"] {
        let text = format!(
            "[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}-uniaxial\"\nrotation = 20\n"
        );
        let assembly = assembly(&text);
        let limits = Limits { min_power: 1e-8, tolerance: 1e-8 };
        let (mut tracer, mut forwards) =
            (Tracer::<2>::new(&assembly, limits), Tracer::<2>::new(&assembly, limits));
        let (mut compared, mut circular) = (0, 0.0f64);
        for ray in rays(40) {
            let leaves = tracer.trace(&ray).0.to_vec();
            for leaf in leaves.iter().filter(|leaf| leaf.power[0] + leaf.power[1] > 0.05) {
                // Paths that coincide, mirrored at the seam, are told apart by nobody.
                let mut expected = [0.0; 4];
                for leaf in leaves.iter().filter(|other| coincide(leaf, other)) {
                    let stokes = arriving_stokes(leaf.electric[0], leaf.electric[1]);
                    expected.iter_mut().zip(stokes).for_each(|(sum, s)| *sum += s);
                }
                let far_end = launch(leaf.position + leaf.direction * 5.0, -leaf.direction);
                let (arrived, _) = forwards.trace(&far_end);
                let mut measured = [0.0; 4];
                for end in arrived {
                    let to_camera = ray.origin - end.position;
                    let along = to_camera.dot(end.direction);
                    let home = (end.direction + ray.direction).length() < 1e-8
                        && (to_camera - end.direction * along).length() < 1e-6
                        && (end.optical_path - 5.0 + along - leaf.optical_path).abs() < 1e-6;
                    if home {
                        // Both halves of unpolarized light, half a unit of power each.
                        for field in end.electric {
                            let [h, v] = ray.electric.map(|axis| field.dot(axis));
                            let mutual = h * v.conj();
                            let (h, v) = (h.norm_sqr(), v.norm_sqr());
                            let stokes = [(h + v) / 2.0, (h - v) / 2.0, mutual.re, mutual.im];
                            measured.iter_mut().zip(stokes).for_each(|(sum, s)| *sum += s);
                        }
                    }
                }
                for k in 0..4 {
                    assert!(
                        (measured[k] - expected[k]).abs() < 1e-8,
                        "{material}: S{k} {measured:?} {expected:?}"
                    );
                }
                compared += 1;
                circular = circular.max(expected[3].abs() / expected[0]);
            }
        }
        // Total reflection in air makes the light of design (i) circular; (ii) has none.
        assert!(compared > 60, "{material}: {compared}");
        assert_eq!(circular > 0.02, material == "positive", "{circular}");
    }
}
