//! The way through graded media, from one point of the border to the next, at the default
//! tolerance.
//!
//! `cargo bench -p cloakroom-optics --bench propagation`; items are legs of rays.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;
use num_complex::Complex64;
use optics::geometry::Extent;
use optics::medium::ModeKind;
use optics::propagation::{
    CentralLens, ConformalFlow, Half, OpticAxis, RadialFlow, TransformedShell, TransmutedSphere,
    UniaxialCylinder, VirtualPoint,
};
use optics::transformation::{
    ConformalMap, GaussianMap, GratingMap, QuasiConformalMap, RadialMap, Symmetry, Truncation,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn main() {
    divan::main();
}

/// cm.
const TOLERANCE: f64 = 1e-6;

/// Legs in one go.
const LEGS: u32 = 256;

/// An evenly spread number in [0, 1) for every n and k: an additive recurrence with the powers of
/// the root of x^4 = x + 1.
fn spread(n: u32, k: i32) -> f64 {
    (f64::from(n) * 1.220_744_084_605_759_5_f64.powi(-k - 1)).fract()
}

/// The maps, as large as the devices have them by default.
const MAPS: [&str; 3] = ["gaussian", "grating", "quasi_conformal"];

fn flow(name: &str) -> ConformalFlow {
    let cut = Truncation::centred(50.0, 28.57);
    let (map, index_scale): (ConformalMap, f64) = match name {
        "gaussian" => {
            (ConformalMap::Gaussian(GaussianMap::new(10.02, 4.25).expect("a sound map")), 1.0)
        }
        "grating" => (ConformalMap::Grating(GratingMap::new(20.0, 1.5).expect("a sound map")), 1.0),
        _ => {
            let map = QuasiConformalMap::new(28.0, 4.25, &cut).expect("a sound map");
            let index_scale = map.index_scale();
            (ConformalMap::QuasiConformal(map), index_scale)
        }
    };
    ConformalFlow::new(map, cut, Extent::ENDLESS, index_scale)
}

/// Rays just inside the face at the least x, up to 20 degrees off the axis, neighbours being alike
/// as those of a camera are.
fn conformal_starts(flow: &ConformalFlow) -> Vec<(VirtualPoint, DVec3)> {
    let start = |n: u32| {
        // Four neighbours, and then elsewhere.
        let (block, member) = (n / 4, f64::from(n % 4));
        let across = |k| 0.34 * (2.0 * spread(block, k) - 1.0) + 1e-3 * member;
        let height = 3.0 + 23.0 * spread(block, 2) + 0.05 * member;
        let at = DVec3::new(flow.cut().x_min, height, 0.0);
        let virtual_point = flow.virtual_point(Half::Upper, at).expect("a point of the border");
        let [p_y, p_z] = [across(0), across(1)];
        let forward = (virtual_point.index.powi(2) - p_y * p_y - p_z * p_z).sqrt();
        (virtual_point, DVec3::new(forward, p_y, p_z))
    };
    (0..LEGS).map(start).collect()
}

#[divan::bench(args = MAPS)]
fn conformal_flow_one(bencher: Bencher, map: &str) {
    let flow = flow(map);
    let starts = conformal_starts(&flow);
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for (virtual_point, wave_vector) in black_box(&starts) {
            black_box(flow.advance_from(virtual_point, *wave_vector, TOLERANCE))
                .expect("a way out");
        }
    });
}

#[divan::bench(args = MAPS)]
fn conformal_flow_four(bencher: Bencher, map: &str) {
    let flow = flow(map);
    let starts = conformal_starts(&flow);
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for four in black_box(&starts).chunks_exact(4) {
            black_box(flow.advance_four(&[0, 1, 2, 3].map(|i| Some(four[i])), TOLERANCE, None));
        }
    });
}

/// Rays in the plane z = const, for which the way is a straight line in virtual space.
#[divan::bench(args = MAPS)]
fn conformal_flow_in_plane(bencher: Bencher, map: &str) {
    let flow = flow(map);
    let mut starts = conformal_starts(&flow);
    for (virtual_point, p) in &mut starts {
        *p = DVec3::new((virtual_point.index.powi(2) - p.y * p.y).sqrt(), p.y, 0.0);
    }
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for four in black_box(&starts).chunks_exact(4) {
            black_box(flow.advance_four(&[0, 1, 2, 3].map(|i| Some(four[i])), TOLERANCE, None));
        }
    });
}

/// Finding the virtual point where a ray enters.
#[divan::bench(args = MAPS)]
fn virtual_point(bencher: Bencher, map: &str) {
    let flow = flow(map);
    let position = |(start, _): &(VirtualPoint, DVec3)| {
        let at = flow.map().jet(start.virtual_position).f;
        DVec3::new(at.re, at.im, start.z)
    };
    let starts: Vec<DVec3> = conformal_starts(&flow).iter().map(position).collect();
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for position in black_box(&starts) {
            black_box(flow.virtual_point(Half::Upper, *position)).expect("a point inside");
        }
    });
}

/// Value and two derivatives of the map at one point.
#[divan::bench(args = MAPS)]
fn map_jet(bencher: Bencher, map: &str) {
    let flow = flow(map);
    let points: Vec<Complex64> = conformal_starts(&flow)
        .iter()
        .map(|(virtual_point, _)| virtual_point.virtual_position)
        .collect();
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for zeta in black_box(&points) {
            let _ = black_box(flow.map().jet(*zeta));
        }
    });
}

/// Radially symmetric media of radius 10, and the wave that goes through them.
const RADIAL: [&str; 12] = [
    "luneburg_lens",
    "eaton_lens",
    "fisheye_lens",
    "invisible_sphere",
    "bending_sphere",
    "sphere_cloak",
    "cylinder_cloak",
    "transmuted_sphere_o",
    "transmuted_sphere_e",
    "radial_cylinder_o",
    "radial_cylinder_e",
    "azimuthal_cylinder_e",
];

fn radial(name: &str) -> (RadialFlow, ModeKind) {
    const RADIUS: f64 = 10.0;
    const CORE: f64 = 4.0;
    let lens = |lens| (RadialFlow::Lens(lens), ModeKind::Shared);
    let shell = |symmetry| {
        let map = RadialMap::new(CORE, RADIUS, symmetry);
        (
            RadialFlow::Transformed(TransformedShell { map, extent: Extent::ENDLESS }),
            ModeKind::Shared,
        )
    };
    let mode = if name.ends_with("_o") { ModeKind::Ordinary } else { ModeKind::Extraordinary };
    let cylinder = |axis| {
        let cylinder = UniaxialCylinder::new(CORE, RADIUS, axis, Extent::ENDLESS);
        (RadialFlow::Uniaxial(cylinder), mode)
    };
    match name {
        "luneburg_lens" => lens(CentralLens::luneburg(RADIUS)),
        "eaton_lens" => lens(CentralLens::eaton(RADIUS, PI)),
        "fisheye_lens" => lens(CentralLens::fisheye(RADIUS)),
        "invisible_sphere" => lens(CentralLens::eaton(RADIUS, TAU)),
        "bending_sphere" => lens(CentralLens::eaton(RADIUS, FRAC_PI_2)),
        "sphere_cloak" => shell(Symmetry::Centre),
        "cylinder_cloak" => shell(Symmetry::Axis),
        "azimuthal_cylinder_e" => cylinder(OpticAxis::Azimuthal),
        "radial_cylinder_o" | "radial_cylinder_e" => cylinder(OpticAxis::Radial),
        _ => (RadialFlow::Transmuted(TransmutedSphere::new(RADIUS)), mode),
    }
}

/// Rays just inside the border: position and the wave vector there, refracted from air.
fn radial_starts(flow: &RadialFlow, mode: ModeKind) -> Vec<(DVec3, DVec3)> {
    let [_, radius] = flow.radii();
    let start = |n: u32| {
        let angle = TAU * spread(n, 0);
        let outward = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let [beside, along] = [1, 2].map(|k| 0.6 * (2.0 * spread(n, k) - 1.0));
        let tangential = DVec3::Z.cross(outward) * beside + DVec3::Z * along;
        let position = outward * radius;
        let medium = flow.medium(position).expect("a medium at the border");
        let modes = medium.modes(tangential, -outward, optics::medium::Heading::Forward);
        let wave = modes.iter().find(|wave| wave.kind == mode).unwrap_or(&modes[0]);
        (position, wave.wave_vector.re)
    };
    (0..LEGS).map(start).collect()
}

#[divan::bench(args = RADIAL)]
fn radial_flow(bencher: Bencher, name: &str) {
    let (flow, mode) = radial(name);
    let starts = radial_starts(&flow, mode);
    bencher.counter(ItemsCount::new(LEGS)).bench(|| {
        for (position, wave_vector) in black_box(&starts) {
            let _ = black_box(flow.advance(*position, *wave_vector, mode));
        }
    });
}
