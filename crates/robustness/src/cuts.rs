//! Glass cut at random into prisms, as one glass.

use crate::draws::Draws;
use crate::rays::launch_along;
use crate::scenes::{assembly, placed};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-6 };

/// The leaves of a ray, whose account must add up with nothing lost.
fn leaves(assembly: &Assembly, ray: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(ray);
    outcome.assert_balanced(leaves, 1e-9, ray);
    leaves.to_vec()
}

/// A convex polygon cut at random: pieces whose sides are no shorter than `shortest`.
fn cut_at_random(square: &[DVec2], draws: &mut Draws<'_>, shortest: f64) -> Vec<Vec<DVec2>> {
    let mut pieces = vec![square.to_vec()];
    let wanted = 2 + (5.0 * draws.share()) as usize;
    for _ in 0..200 {
        if pieces.len() == wanted {
            break;
        }
        let chosen = (draws.share() * pieces.len() as f64) as usize;
        let piece = &pieces[chosen];
        let sides = piece.len();
        let first = (draws.share() * sides as f64) as usize;
        let second = (first + 1 + (draws.share() * (sides - 1) as f64) as usize) % sides;
        let (first, second) = (first.min(second), first.max(second));
        let [a, b] = [first, second]
            .map(|side| piece[side].lerp(piece[(side + 1) % sides], draws.between(0.1, 0.9)));
        let one: Vec<_> = [&[a][..], &piece[first + 1..=second], &[b]].concat();
        let other: Vec<_> = [&piece[..=first], &[a, b], &piece[second + 1..]].concat();
        let long = |piece: &Vec<DVec2>| {
            let next = piece.iter().cycle().skip(1);
            piece.iter().zip(next).all(|(a, b)| a.distance(*b) >= shortest)
        };
        if long(&one) && long(&other) {
            pieces[chosen] = one;
            pieces.push(other);
        }
    }
    pieces
}

/// Cuts a square of glass at random, its corners written with four to nine decimals, and sends rays
/// through it and through the whole one; how many.
///
/// # Panics
///
/// If other light comes through.
pub fn cut_glass(draws: &mut Draws<'_>) -> u64 {
    const SHORTEST: f64 = 0.75;
    const RAYS: u64 = 20;
    let decimals = 4 + draws.below(6);
    let pose = draws.pose();
    let turn = DVec2::from_angle(draws.between(0.0, TAU)) * 3.0;
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|corner| turn.rotate(DVec2::from(corner)));
    let pieces = cut_at_random(&square, draws, SHORTEST);
    let length = *draws.pick(&["", "length = 4\n"]);
    let place = placed(pose.origin, &pose.rotation());
    let scene = |parts: &[Vec<DVec2>]| {
        let mut scene = format!("[[device]]\nkind = \"prisms\"\n{length}{place}");
        for part in parts {
            let corners =
                part.iter().map(|at| format!("[{:.decimals$}, {:.decimals$}]", at.x, at.y));
            let corners = corners.collect::<Vec<_>>().join(", ");
            scene += &format!("[[device.prism]]\ncorners = [{corners}]\npermittivity = 2.25\n");
        }
        scene
    };
    let (cut, whole) = (assembly(&scene(&pieces)), assembly(&scene(&[square.to_vec()])));
    // Rounded corners turn a piece of a side as moving a corner of the square does that
    // much farther, which shows where light comes in or out grazing. Each is rounded by itself, along
    // both axes: what the moves do adds up.
    let by = 1.4 * 0.1f64.powi(decimals as i32) * 6.0 / SHORTEST;
    let moves = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].map(|way| way * by);
    let bent: Vec<Assembly> = (0..16)
        .map(|i| {
            let mut corners = square;
            corners[i / 4] += moves[i % 4];
            assembly(&scene(&[corners.to_vec()]))
        })
        .collect();
    for _ in 0..RAYS {
        let target = DVec3::new(0.0, draws.between(-3.0, 3.0), draws.between(-1.0, 1.0));
        let from = DVec3::new(-20.0, 0.1, 0.2);
        let ray = launch_along(pose.to_world(from), pose.vector_to_world(target - from));
        let sorted = |assembly: &Assembly| {
            let mut powers: Vec<f64> =
                leaves(assembly, &ray).iter().map(|leaf| leaf.power[0]).collect();
            powers.sort_by(|a, b| b.total_cmp(a));
            powers.truncate(3);
            powers
        };
        let (found, expected) = (sorted(&cut), sorted(&whole));
        let others: Vec<_> = bent.iter().map(sorted).collect();
        let is_near = |i: usize| {
            let off =
                |other: &Vec<f64>| other.get(i).map_or(0.0, |other| (other - expected[i]).abs());
            let most: f64 = others
                .chunks(2)
                .map(|to_and_fro| off(&to_and_fro[0]).max(off(&to_and_fro[1])))
                .sum();
            (found[i] - expected[i]).abs() < most.max(1e-5)
        };
        let near = found.len() == expected.len() && (0..found.len()).all(is_near);
        assert!(near, "{found:?} {expected:?} {others:?}\n{}", scene(&pieces));
    }
    RAYS
}
