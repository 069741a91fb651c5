//! Single interfaces between pairs of media.
//!
//! `cargo bench -p cloakroom-optics --bench interfaces`; items are interfaces, each with all the
//! modes of both media for two polarizations at once.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::{DMat3, DVec2, DVec3};
use optics::interface::{IncidentWave, Reflectionless, reflect_at_conductor, split};
use optics::medium::{Heading, Medium};
use optics::transformation::StripToRhombus;

fn main() {
    divan::main();
}

fn map() -> StripToRhombus {
    StripToRhombus::new(9.97, 0.577)
}

fn segment() -> Medium {
    Medium::impedance_matched(map().tensor(DVec2::ONE)).expect("a sound medium")
}

/// A segment of design (i), with the optic axis in the given quadrant.
fn birefringent(quadrant: DVec2) -> Medium {
    let (values, angle) = map().principal_values();
    let turn = DMat3::from_rotation_z(angle.to_radians() * quadrant.x * quadrant.y);
    Medium::uniaxial_magnetic(values.z, values.y, values.x, turn * DVec3::X)
        .expect("a sound medium")
}

/// A wave towards +x, in birefringent media the ordinary one.
fn wave(medium: &Medium) -> IncidentWave<2> {
    let tangential = DVec3::new(0.0, 0.36, 0.28);
    let [a, b] = medium.modes(tangential, DVec3::X, Heading::Forward);
    let second = if (a.wave_vector.re - b.wave_vector.re).length() < 1e-9 { b } else { a };
    IncidentWave {
        wave_vector: a.wave_vector.re,
        attenuation: DVec3::ZERO,
        direction: a.ray.expect("a wave that propagates"),
        electric: [a.electric, second.electric * 0.5],
        power: [1.0, 0.25],
    }
}

fn bench_split(bencher: Bencher, from: &Medium, to: &Medium) {
    let wave = wave(from);
    let bencher = bencher.counter(ItemsCount::new(1u32));
    bencher.bench(|| split(black_box(from), black_box(to), black_box(&wave), DVec3::X));
}

fn bench_conductor(bencher: Bencher, medium: &Medium) {
    let wave = wave(medium);
    let bencher = bencher.counter(ItemsCount::new(1u32));
    bencher.bench(|| reflect_at_conductor(black_box(medium), black_box(&wave), DVec3::X));
}

#[divan::bench]
fn air_to_glass(bencher: Bencher) {
    bench_split(bencher, &Medium::AIR, &Medium::dielectric(1.5));
}

#[divan::bench]
fn air_to_impedance_matched(bencher: Bencher) {
    bench_split(bencher, &Medium::AIR, &segment());
}

#[divan::bench]
fn air_to_uniaxial(bencher: Bencher) {
    bench_split(bencher, &Medium::AIR, &birefringent(DVec2::ONE));
}

#[divan::bench]
fn uniaxial_to_air(bencher: Bencher) {
    bench_split(bencher, &birefringent(DVec2::ONE), &Medium::AIR);
}

#[divan::bench]
fn uniaxial_to_uniaxial(bencher: Bencher) {
    bench_split(bencher, &birefringent(DVec2::ONE), &birefringent(DVec2::new(-1.0, 1.0)));
}

/// The ordinary wave beyond is evanescent: the same in complex numbers.
#[divan::bench]
fn air_to_uniaxial_evanescent(bencher: Bencher) {
    let rare = Medium::uniaxial_magnetic(0.5, 0.3, 3.0, DVec3::new(0.8, 0.6, 0.0))
        .expect("a sound medium");
    bench_split(bencher, &Medium::AIR, &rare);
}

/// A biaxial crystal, off its principal axes.
fn topaz() -> Medium {
    let turn = DMat3::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), 1.1);
    let tensor = turn * DMat3::from_diagonal(DVec3::new(2.609, 2.613, 2.641)) * turn.transpose();
    Medium::new((tensor + tensor.transpose()) * 0.5, 1.0).expect("a sound medium")
}

/// A medium without symmetry.
fn general() -> Medium {
    let tensor = |values: DVec3, axis: DVec3| {
        let turn = DMat3::from_axis_angle(axis, 0.7);
        let tensor = turn * DMat3::from_diagonal(values) * turn.transpose();
        (tensor + tensor.transpose()) * 0.5
    };
    let permittivity = tensor(DVec3::new(1.3, 2.4, 3.1), DVec3::new(0.48, 0.6, 0.64));
    let permeability = tensor(DVec3::new(1.7, 1.1, 0.8), DVec3::new(0.64, -0.48, 0.6));
    Medium::new(permittivity, permeability).expect("a sound medium")
}

#[divan::bench]
fn uniaxial_to_general(bencher: Bencher) {
    bench_split(bencher, &birefringent(DVec2::ONE), &topaz());
}

#[divan::bench]
fn air_to_biaxial(bencher: Bencher) {
    bench_split(bencher, &Medium::AIR, &topaz());
}

#[divan::bench]
fn air_to_general(bencher: Bencher) {
    bench_split(bencher, &Medium::AIR, &general());
}

/// One wave beyond is evanescent.
#[divan::bench]
fn air_to_general_evanescent(bencher: Bencher) {
    let rare = Medium::new(DMat3::from_diagonal(DVec3::new(0.5, 0.15, 3.0)), 1.0);
    bench_split(bencher, &Medium::AIR, &rare.expect("a sound medium"));
}

#[divan::bench]
fn general_to_air(bencher: Bencher) {
    bench_split(bencher, &general(), &Medium::AIR);
}

#[divan::bench]
fn general_to_general(bencher: Bencher) {
    bench_split(bencher, &general(), &topaz());
}

#[divan::bench]
fn conductor_in_air(bencher: Bencher) {
    bench_conductor(bencher, &Medium::AIR);
}

#[divan::bench]
fn conductor_in_uniaxial(bencher: Bencher) {
    bench_conductor(bencher, &birefringent(DVec2::ONE));
}

/// The reflectionless interface of design (iii), found once from the tensors.
#[divan::bench]
fn reflectionless(bencher: Bencher) {
    let normal = DVec3::new(-1.0, -1.0, 0.0).normalize();
    let medium = segment();
    let interface = Reflectionless::between(&Medium::AIR, &medium, normal);
    let interface = interface.expect("a matched interface");
    let wave = wave(&Medium::AIR);
    let bencher = bencher.counter(ItemsCount::new(1u32));
    bencher.bench(|| black_box(&interface).transmit(black_box(&wave)));
}
