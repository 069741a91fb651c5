//! The ray trees of designs (i)-(iii), leaf by leaf, against a plain tracer that shares no code
//! with the program's: see `plain_tree`.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::print_stdout,
    reason = "a test may"
)]

use crate::long::count;
use crate::plain_tree::PlainLeaf;
use crate::plain_tree::cloak::{Cloak, Design};
use crate::plain_tree::waves::poynting;
use crate::rays;
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use num_complex::Complex64;
use optics::wave::ComplexVector;

/// Horizontal, vertical and elliptic light.
const POLARIZATIONS: usize = 3;

const DESIGNS: [(Design, &str); 3] = [
    (Design::Positive, "positive-uniaxial"),
    (Design::Negative, "negative-uniaxial"),
    (Design::Matched, "impedance-matched"),
];

fn of_components([x, y, z]: [Complex64; 3]) -> ComplexVector {
    ComplexVector { re: DVec3::new(x.re, y.re, z.re), im: DVec3::new(x.im, y.im, z.im) }
}

fn assembly(material: &str, rounded: bool, rotation: f64, length: Option<f64>) -> Assembly {
    let mut text = format!(
        "[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\nrounded = {rounded}\n\
         rotation = {rotation:?}\n"
    );
    if let Some(length) = length {
        text += &format!("length = {length:?}\n");
    }
    rays::assembly(&text)
}

/// `SplitMix64`.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        low + (high - low) * (((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// A ray towards the cloak from anywhere around it: every third in a plane of constant z, every
    /// third steep against it.
    fn ray(&mut self, index: usize) -> (DVec3, DVec3) {
        let target =
            DVec3::new(self.between(-7.0, 7.0), self.between(-7.0, 7.0), self.between(-5.0, 5.0));
        let azimuth = self.between(0.0, std::f64::consts::TAU);
        let along_z = match index % 3 {
            0 => 0.0,
            1 => self.between(-1.0, 1.0),
            _ => self.between(0.9, 0.9999) * self.between(-1.0, 1.0).signum(),
        };
        let across = (1.0 - along_z * along_z).sqrt();
        let direction = DVec3::new(across * azimuth.cos(), across * azimuth.sin(), along_z);
        (target - direction * (30.0 / across.max(0.01)), direction)
    }
}

/// Horizontal, vertical, and both a quarter period apart.
fn polarizations(direction: DVec3) -> [[Complex64; 3]; POLARIZATIONS] {
    let v = DVec3::Z.cross(direction).try_normalize().unwrap_or(DVec3::Y);
    let h = direction.cross(v);
    let elliptic = [0, 1, 2].map(|i| Complex64::new(0.6 * h[i], 0.8 * v[i]));
    [h.to_array().map(Complex64::from), v.to_array().map(Complex64::from), elliptic]
}

/// How far apart two leaves are: position and optical path (cm), direction, power, field.
fn differences(ours: &Leaf<POLARIZATIONS>, plain: &PlainLeaf<POLARIZATIONS>) -> [f64; 5] {
    let mut worst = [0.0f64; 2];
    for (i, fields) in plain.fields.iter().enumerate() {
        let [x, y, z, ..] = *fields;
        let field = of_components([x, y, z]) - ours.electric[i];
        worst[0] = worst[0].max((ours.power[i] - poynting(fields).length()).abs());
        worst[1] = worst[1].max(field.norm_squared().sqrt());
    }
    [
        ours.position.distance(plain.position),
        (ours.optical_path - plain.optical_path).abs(),
        ours.direction.distance(plain.direction),
        worst[0],
        worst[1],
    ]
}

fn largest<const N: usize>(values: [f64; N]) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// What the comparison of many trees has found.
#[derive(Default)]
struct Comparison {
    trees: usize,
    leaves: usize,
    events: usize,
    skipped: usize,
    differences: [Vec<f64>; 5],
    pruned: Vec<f64>,
    account: Vec<f64>,
}

impl Comparison {
    fn compare(
        &mut self,
        cloak: &Cloak,
        tracer: &mut Tracer<POLARIZATIONS>,
        ray: (DVec3, DVec3),
        min_power: f64,
    ) {
        let (origin, direction) = ray;
        let electric = polarizations(direction);
        let launch = Launch { origin, direction, electric: electric.map(of_components) };
        let (leaves, outcome) = tracer.trace(&launch);
        if outcome.stats.endless > 0 {
            // Trapped for good between the ends.
            self.skipped += 1;
            return;
        }
        outcome.assert_balanced(leaves, 1e-10, &launch);
        let plain = cloak.trace(origin, direction, electric, min_power);
        let mut unmatched: Vec<&PlainLeaf<POLARIZATIONS>> = plain.leaves.iter().collect();
        let mut pruned = outcome.pruned;
        // At the threshold itself a leaf may be on either side.
        let at_threshold = |power: [f64; POLARIZATIONS]| largest(power) < min_power * (1.0 + 1e-6);
        for leaf in leaves {
            // Of mirrored paths that coincide in all but the field, the one with the nearest field.
            let distance = |other: &PlainLeaf<POLARIZATIONS>| largest(differences(leaf, other));
            let nearest = (0..unmatched.len())
                .min_by(|a, b| distance(unmatched[*a]).total_cmp(&distance(unmatched[*b])));
            let found = nearest.filter(|nearest| distance(unmatched[*nearest]) < 1e-5);
            let Some(nearest) = found else {
                let near = nearest.map(|n| (differences(leaf, unmatched[n]), unmatched[n]));
                assert!(at_threshold(leaf.power), "{launch:?}: no {leaf:?}; {near:?}");
                pruned = std::array::from_fn(|i| pruned[i] + leaf.power[i]);
                continue;
            };
            let other = unmatched.swap_remove(nearest);
            for (all, difference) in self.differences.iter_mut().zip(differences(leaf, other)) {
                all.push(difference);
            }
        }
        for left in &unmatched {
            assert!(
                at_threshold(left.power()),
                "{launch:?}: only plain {left:?} {:?}",
                left.power()
            );
            pruned = std::array::from_fn(|i| pruned[i] - left.power()[i]);
        }
        let of_pruned =
            std::array::from_fn::<_, POLARIZATIONS, _>(|i| (pruned[i] - plain.pruned[i]).abs());
        self.pruned.push(largest(of_pruned));
        // The fluxes of the plain tree are those of its fields: nothing shares them out.
        let mut sums = plain.pruned;
        for leaf in &plain.leaves {
            sums = std::array::from_fn(|i| sums[i] + leaf.power()[i]);
        }
        self.account.push(largest(sums.map(|sum| (sum - 1.0).abs())));
        self.trees += 1;
        self.leaves += leaves.len();
        self.events += plain.events;
    }

    fn report(&mut self) -> f64 {
        println!(
            "{} trees, {} leaves, {} events, {} skipped",
            self.trees, self.leaves, self.events, self.skipped
        );
        let names =
            ["position", "optical path", "direction", "power", "field", "pruned", "plain account"];
        let mut worst = 0.0f64;
        for (name, values) in names
            .into_iter()
            .zip(self.differences.iter_mut().chain([&mut self.pruned, &mut self.account]))
        {
            values.sort_by(f64::total_cmp);
            let at = |q: f64| values[((values.len() - 1) as f64 * q) as usize];
            println!(
                "{name:>14}: median {:.1e}, 99 % {:.1e}, 99.9 % {:.1e}, max {:.1e}",
                at(0.5),
                at(0.99),
                at(0.999),
                at(1.0)
            );
            worst = worst.max(at(1.0));
        }
        worst
    }
}

fn compare_trees(
    (design, material): (Design, &str),
    (rounded, rotation, length): (bool, f64, Option<f64>),
    (count, min_power): (usize, f64),
    comparison: &mut Comparison,
) {
    let assembly = assembly(material, rounded, rotation, length);
    let mut tracer = Tracer::new(&assembly, Limits { min_power, tolerance: 1e-6 });
    let half_length = length.map_or(f64::INFINITY, |length| length / 2.0);
    let cloak = Cloak::new(design, rounded, rotation, half_length);
    let mut random = Random(rotation.to_bits());
    for index in 0..count {
        comparison.compare(&cloak, &mut tracer, random.ray(index), min_power);
    }
    if length.is_some() {
        // Along the axis, on the metal and beside it.
        for target in [DVec3::new(-3.0, 6.0, 0.0), DVec3::new(0.3, -0.4, 0.0)] {
            let ray = (target + DVec3::Z * 50.0, -DVec3::Z);
            comparison.compare(&cloak, &mut tracer, ray, min_power);
        }
    }
}

#[test]
fn trees_agree_leaf_by_leaf() {
    for design in DESIGNS {
        let mut comparison = Comparison::default();
        for (rounded, rotation, count) in [
            (false, 0.0, count(5, 15)),
            (false, 10.0, count(3, 9)),
            (false, -47.3, count(3, 9)),
            (false, 90.0, count(1, 3)),
            (true, 0.0, count(1, 3)),
            (true, 20.0, count(3, 9)),
        ] {
            compare_trees(design, (rounded, rotation, None), (count, 1e-5), &mut comparison);
        }
        println!("{design:?}");
        assert!(comparison.report() < 1e-9);
        assert!(comparison.trees > count(13, 40));
    }
}

#[test]
fn trees_of_a_short_cloak_agree_leaf_by_leaf() {
    for design in DESIGNS {
        let mut comparison = Comparison::default();
        let short = (false, 13.0, Some(14.0));
        compare_trees(design, short, (count(4, 12), 1e-4), &mut comparison);
        println!("{design:?}, short");
        assert!(comparison.report() < 1e-9);
        assert!(comparison.trees > count(4, 10));
    }
}

#[test]
fn trapped_vertical_light_leaves_design_ii_after_three_or_four_bounces() {
    let cloak = Cloak::new(Design::Negative, false, 0.0, f64::INFINITY);
    let electric = [DVec3::Y.to_array().map(Complex64::from)];
    for y in [2.0, 4.0, 6.0, 8.0] {
        let tree = cloak.trace(DVec3::new(-50.0, y, 0.0), DVec3::X, electric, 1e-3);
        let leaves = tree.leaves.iter();
        let main = leaves.max_by(|a, b| a.power()[0].total_cmp(&b.power()[0])).unwrap();
        println!("y = {y}: {} after {} reflections", main.power()[0], main.reflections);
        assert!((main.power()[0] - 0.886).abs() < 5e-3);
        assert!([3, 4].contains(&main.reflections), "{}", main.reflections);
    }
}
