//! Boxes in which the square of the index grows evenly.

use super::{check_by_integration, check_starts_inside, leaves};
use crate::rays::{Numbers, assembly, launch, refusal};
use cloakroom::device::{Device, GradedBox, InnerRay, Request};
use glam::DVec3;
use optics::medium::ModeKind;
use optics::propagation::reference::SquaredIndex;

fn boxed(gradient: DVec3) -> GradedBox {
    GradedBox { sides: DVec3::new(12.0, 16.0, 20.0), index: 1.3, gradient }
}

fn height(at: DVec3) -> f64 {
    (at.abs() - DVec3::new(6.0, 8.0, 10.0)).max_element()
}

const GRADIENTS: [DVec3; 4] = [
    DVec3::new(0.0, -0.05, 0.0),
    DVec3::new(0.07, 0.02, -0.05),
    DVec3::new(0.0, 0.0, 1e-9),
    DVec3::ZERO,
];

#[test]
fn rays_run_as_the_index_bends_them() {
    for gradient in GRADIENTS {
        let square = |at: DVec3| SquaredIndex { value: 1.69 + gradient.dot(at), gradient };
        let structure = boxed(gradient).build(Request::default()).unwrap();
        check_by_integration(&structure, &square, &height);
    }
}

#[test]
fn the_wave_vector_across_the_gradient_is_kept() {
    let mut numbers = Numbers(21);
    for gradient in GRADIENTS {
        let structure = boxed(gradient).build(Request::default()).unwrap();
        for _ in 0..100 {
            let position = DVec3::new(5.0, 7.0, 9.0) * numbers.direction();
            let direction = numbers.direction();
            let wave_vector = direction * (1.69 + gradient.dot(position)).sqrt();
            let mode = ModeKind::Shared;
            let ray = InnerRay { position, wave_vector, direction, mode, virtual_point: None };
            let end = structure.regions[0].advance(&ray, 1e-9, None).unwrap();
            // p' = g/2: p × g stays, and p² - g·r is that of the middle.
            let turned = (end.wave_vector - wave_vector).cross(gradient);
            assert!(turned.length() < 1e-14);
            let square = end.wave_vector.length_squared() - gradient.dot(end.position);
            assert!((square - 1.69).abs() < 1e-13);
        }
    }
}

#[test]
fn light_is_accounted_for_and_may_start_inside() {
    let scene = "[[device]]\nkind = 'graded-box'\nsides = [12, 16, 20]\nindex = 1.3\n\
                 gradient = [0.07, 0.02, -0.05]\nposition = [1, 2, 3]\nrotation = 30\naxis = [1, -2, 2]\n";
    check_starts_inside(scene, &height);
    let assembly = assembly(scene);
    let mut numbers = Numbers(22);
    for _ in 0..100 {
        let direction = numbers.direction();
        let aim = DVec3::new(1.0, 2.0, 3.0) + numbers.direction() * numbers.between(0.0, 5.0);
        assert!(leaves(&assembly, &launch(aim - direction * 40.0, direction)).len() > 1);
    }
}

#[test]
fn a_box_of_no_gradient_is_a_box_of_glass() {
    let place = "position = [1, 2, 3]\nrotation = 30\naxis = [1, -2, 2]\n";
    let size = "[12, 16, 20]";
    let graded = assembly(&format!(
        "[[device]]\nkind = 'graded-box'\nsides = {size}\nindex = 1.3\ngradient = [0, 0, 0]\n{place}"
    ));
    let glass = assembly(&format!(
        "[[device]]\nkind = 'body'\nshape = 'box'\nsize = {size}\npermittivity = 1.69\n{place}"
    ));
    let mut numbers = Numbers(23);
    for _ in 0..60 {
        let direction = numbers.direction();
        let aim = DVec3::new(1.0, 2.0, 3.0) + numbers.direction() * numbers.between(0.0, 8.0);
        let ray = launch(aim - direction * 40.0, direction);
        let [ours, theirs] = [&graded, &glass].map(|assembly| leaves(assembly, &ray));
        for leaf in ours.iter().filter(|leaf| leaf.power[0] > 1e-4) {
            let same = theirs.iter().any(|other| {
                other.position.distance(leaf.position) < 1e-9
                    && other.direction.distance(leaf.direction) < 1e-10
                    && (other.optical_path - leaf.optical_path).abs() < 1e-9
                    && (other.power[0] - leaf.power[0]).abs() < 1e-10
            });
            assert!(same, "{leaf:?} {theirs:?}");
        }
    }
}

#[test]
fn a_gradient_that_leaves_no_index_is_refused() {
    let error = refusal("[[device]]\nkind = 'graded-box'\ngradient = [0, 0.2, 0]\n");
    assert!(error.contains("gradient is [0, 0.2, 0] 1/cm"), "{error}");
    assert!(error.contains("must be 0.01 at least"), "{error}");
    let error = refusal("[[device]]\nkind = 'graded-box'\nlength = 3\n");
    assert!(error.contains("a box has the third of its sides"), "{error}");
}
