//! Devices that touch: light is never in metal, and glass is one however it is cut. Pictures of random
//! devices, and light in flight through them.

use crate::long::count;
use robustness::{
    Draws, cut_glass, fly, hardly_birefringent, interpolate, interpolate_small,
    interpolate_straight, stack, touch, touching_kinds,
};

#[test]
fn light_never_goes_through_metal_that_touches_a_device() {
    let mut draws = Draws::Seed(7);
    for round in 0..count(1500, 40_000) {
        touch(round, None, &mut draws);
    }
}

#[test]
fn every_pair_of_kinds_that_touch_balances() {
    let mut draws = Draws::Seed(19);
    for _ in 0..count(1, 20) {
        for one in 0..touching_kinds() {
            for other in 0..touching_kinds() {
                touch(one, Some(other), &mut draws);
            }
        }
    }
}

#[test]
fn a_glass_square_is_the_same_however_it_is_cut() {
    let mut draws = Draws::Seed(3);
    for _ in 0..count(60, 2000) {
        cut_glass(&mut draws);
    }
}

#[test]
fn plates_in_any_pose_keep_the_power_of_what_interferes() {
    let mut draws = Draws::Seed(33);
    for _ in 0..count(20, 600) {
        stack(&mut draws);
    }
}

#[test]
fn hardly_birefringent_bodies_look_as_isotropic_ones() {
    let mut draws = Draws::Seed(51);
    for _ in 0..count(20, 600) {
        hardly_birefringent(&mut draws);
    }
}

#[test]
fn pictures_of_shared_rays_are_those_of_traced_ones() {
    let mut draws = Draws::Seed(20);
    for _ in 0..count(30, 600) {
        interpolate(&mut draws);
    }
    for _ in 0..count(30, 400) {
        interpolate_straight(&mut draws);
    }
    for _ in 0..count(6, 200) {
        interpolate_small(&mut draws);
    }
}

#[test]
fn all_light_in_flight_comes_when_the_maps_say() {
    let mut draws = Draws::Seed(41);
    let scenes = count(3, 200);
    let rays: u64 = (0..scenes).map(|_| fly(&mut draws)).sum();
    // Most are seen.
    assert!(rays > 10_000 * scenes as u64, "{rays}");
}
