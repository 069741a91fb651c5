//! The four lenses after Choi and Howell, Opt. Express 22, 29465 (2014): near the axis a piece of empty
//! space, around whose foci something is hidden.

use super::{after, assert_near, at_plane, gap, matrix, through};
use crate::rays::{assembly, launch};
use cloakroom::assembly::Assembly;
use cloakroom::device::{Device, FactValue, GlassLens, MaterialWord, Request};
use cloakroom::keys::MaterialName;
use cloakroom::trace::{LeafEnd, Tracer};
use glam::DVec3;

const DOUBLETS: &str = include_str!("../../../../scenes/real/rochester-cloak.toml");
const SINGLETS: &str = include_str!("../../../../scenes/real/rochester-cloak-singlets.toml");

const DESIGN_NM: &str = "wavelength_nm = 587.5618";

/// The scene in light of another wavelength.
fn in_light(scene: &str, wavelength_nm: f64) -> Assembly {
    assert!(scene.contains(DESIGN_NM));
    assembly(&scene.replace(DESIGN_NM, &format!("wavelength_nm = {wavelength_nm:?}")))
}

#[test]
fn four_lenses_are_a_piece_of_empty_space_near_the_axis() {
    // Thin ones, by the formulas of the paper: f1 and f2 of 200 and 75 mm make 880 mm.
    let (f, g) = (20.0, 7.5);
    let lens = |f: f64| [[1.0, 0.0], [-1.0 / f, 1.0]];
    let (t, middle) = (f + g, 2.0 * g * (f + g) / (f - g));
    assert_eq!((t, middle, 2.0 * t + middle), (27.5, 33.0, 88.0));
    let parts = [lens(f), gap(t), lens(g), gap(middle), lens(g), gap(t), lens(f)];
    let thin = parts.into_iter().reduce(|all, next| after(next, all)).unwrap();
    assert_near(thin, gap(88.0), 1e-14, "thin");
    // The real ones, whose distances count between principal planes, are one too, from wherever
    // before them to wherever behind them.
    for scene in [DOUBLETS, SINGLETS] {
        let bench = assembly(scene);
        for [from, to] in [[-60.0, 60.0], [-46.0, 100.0]] {
            assert_near(matrix(&bench, [from, to]), gap(to - from), 1e-9, "lenses");
        }
    }
}

#[test]
fn distances_of_the_scene_are_those_between_principal_planes() {
    let lens = |front_radius, back_radius, thickness| GlassLens {
        front_radius,
        back_radius,
        thickness,
        diameter: 4.0,
        words: cloakroom::device::MediumWords {
            material: Some(MaterialWord::Named(MaterialName::BuiltIn("bk7".to_owned()))),
            ..Default::default()
        },
        ..GlassLens::default()
    };
    let request = Request { wavelength_nm: 587.5618, ..Request::default() };
    let facts = |lens: &GlassLens| {
        let facts = lens.facts(request);
        let value = |name: &str| match &facts.iter().find(|fact| fact.name == name).unwrap().value {
            FactValue::Number(number) => vec![*number],
            FactValue::Numbers(numbers) => numbers.clone(),
        };
        (value("focal_length_cm")[0], value("principal_planes_cm"))
    };
    let (f1, planes1) = facts(&lens(10.34, 0.0, 0.6));
    let (f2, planes2) = facts(&lens(0.0, -3.88, 0.9));
    // Between its principal planes a lens leaves out what a thin one has not: the middle is longer for
    // it.
    let left_out = 2.0 * (planes1[1] - planes1[0] + planes2[1] - planes2[0]);
    let (t, m) = (f1 + f2, -f1 / f2);
    let middle = (2.0 * t * (1.0 - m) + left_out) / (m * m - 1.0);
    // Middles of the lenses, as in the scene.
    let second = -0.5 * middle - planes2[1];
    let first = second + planes2[0] - t - planes1[1];
    let positions: Vec<f64> = SINGLETS
        .split("kind = \"lens\"\nposition = [")
        .skip(1)
        .map(|rest| rest.split(',').next().unwrap().parse().unwrap())
        .collect();
    for (found, wanted) in positions.iter().zip([first, second, -second, -first]) {
        assert!((found - wanted).abs() < 1e-9, "{positions:?} {first} {second}");
    }
}

/// Angles (degrees) at which the camera of the scene sees through the lenses.
const ANGLES: [f64; 4] = [0.2, 0.25, 0.3, 0.35];

fn direction(degrees: f64, turn: f64) -> DVec3 {
    let slope = degrees.to_radians().tan();
    DVec3::new(1.0, slope * turn.cos(), slope * turn.sin())
}

#[test]
fn the_frame_is_hidden_and_what_is_behind_is_seen() {
    let camera = DVec3::X * -250.0;
    let frame: String = DOUBLETS
        .split("[[device]]")
        .filter(|part| part.contains("\"body\""))
        .map(|part| format!("[[device]]{part}"))
        .collect();
    let (with, without) = (assembly(DOUBLETS), assembly(&frame));
    for degrees in ANGLES {
        for turn in [0.4, 1.7, 3.9] {
            let along = direction(degrees, turn);
            // Without the lenses the frame is in the way.
            let mut tracer = Tracer::new(&without, super::LIMITS);
            let (leaves, _) = tracer.trace(&launch(camera, along));
            assert!(leaves.iter().all(|leaf| matches!(leaf.end, LeafEnd::Body(_))), "{degrees}");
            let leaf = through(&with, camera, along);
            assert_eq!(leaf.end, LeafEnd::Away);
            let off = at_plane(&leaf, 100.0) - (camera + along * 350.0);
            assert!(off.length() < 0.05, "{degrees}: {off}");
        }
    }
}

#[test]
fn doublets_have_a_tenth_of_the_colors_of_single_lenses() {
    let camera = DVec3::X * -250.0;
    let spread = |scene: &str| {
        let seen = [486.1, 587.6, 656.3].map(|wavelength_nm| {
            let bench = in_light(scene, wavelength_nm);
            at_plane(&through(&bench, camera, direction(0.3, 0.4)), 100.0)
        });
        seen[0].distance(seen[2]).max(seen[0].distance(seen[1])).max(seen[1].distance(seen[2]))
    };
    let (doublets, singlets) = (spread(DOUBLETS), spread(SINGLETS));
    assert!(singlets > 0.1 && doublets < 0.1 * singlets, "{doublets} {singlets}");
}
