//! Single interfaces between pairs of media.
//!
//! `cargo bench -p cloakroom-optics`

use divan::{Bencher, black_box};
use glam::{DVec2, DVec3};
use optics::interface::{IncidentWave, reflect_at_conductor, split};
use optics::medium::Medium;
use optics::transformation::StripToRhombus;

fn main() {
    divan::main();
}

fn segment() -> Medium {
    let map = StripToRhombus::new(9.97, 0.577);
    Medium::impedance_matched(map.tensor(DVec2::ONE)).expect("a sound medium")
}

fn wave(medium: &Medium) -> IncidentWave<2> {
    let direction = DVec3::new(0.8, 0.36, 0.48);
    let wave_vector = medium.wave_surface().wave_vector_along(direction);
    let across = wave_vector.normalize().any_orthonormal_pair();
    IncidentWave {
        wave_vector,
        direction,
        electric: [across.0.into(), across.1.into()],
        power: [1.0; 2],
    }
}

#[divan::bench]
fn air_to_glass(bencher: Bencher) {
    let (air, glass) = (Medium::AIR, Medium::dielectric(1.5));
    let wave = wave(&air);
    bencher.bench(|| split(black_box(&air), black_box(&glass), black_box(&wave), DVec3::X));
}

#[divan::bench]
fn air_to_impedance_matched(bencher: Bencher) {
    let (air, segment) = (Medium::AIR, segment());
    let wave = wave(&air);
    bencher.bench(|| split(black_box(&air), black_box(&segment), black_box(&wave), DVec3::X));
}

#[divan::bench]
fn conductor(bencher: Bencher) {
    let air = Medium::AIR;
    let wave = wave(&air);
    bencher.bench(|| reflect_at_conductor(black_box(&air), black_box(&wave), DVec3::X));
}
