//! Modes of absorbing media, and of any medium under a wave that decays along the surface.

use super::general::Berreman;
use super::uniaxial::{field_direction, out_of_plane};
use super::{BothWays, LocalMode, LocalModes, ModeKind};
use crate::medium::Medium;
use crate::medium::class::{Class, Uniaxial};
use crate::wave::{Frame, cross};
use num_complex::Complex64;

type ComplexMode = LocalMode<Complex64>;

/// Below this normal flux, relative to the fields along the surface that it is made of, a mode counts as
/// evanescent: where a principal value is next to zero, those across it may be far larger.
const NO_FLUX: f64 = 1e-13;

impl Medium {
    pub(super) fn absorbing_modes(&self, frame: &Frame, k: [Complex64; 2]) -> BothWays {
        let modes = match &self.class {
            Class::AbsorbingIsotropic(e, m) => isotropic(*e, *m, k),
            Class::Isotropic(_) => isotropic(
                self.real.permittivity.x_axis.x.into(),
                self.real.permeability.x_axis.x.into(),
                k,
            ),
            Class::AbsorbingUniaxial(medium) => uniaxial(medium, frame, k),
            Class::Uniaxial(medium) => uniaxial(&medium.map(Complex64::from), frame, k),
            Class::Matched(_) | Class::General => {
                let (permittivity, permeability) = self.tensors();
                Berreman::modes_of(frame, &permittivity, &permeability, k)
            }
        };
        let [forward, backward] = modes;
        [
            LocalModes::Complex(forward.map(|mode| normalized(mode, 1.0))),
            LocalModes::Complex(backward.map(|mode| normalized(mode, -1.0))),
        ]
    }
}

/// A mode of normal flux 1. Under a wave that decays along the surface one that decays away from it
/// may carry power towards it: that counts as evanescent.
fn normalized(mode: ComplexMode, heading: f64) -> ComplexMode {
    let tangential = |[first, second, _]: [Complex64; 3]| first.norm_sqr() + second.norm_sqr();
    let most = (tangential(mode.electric) * tangential(mode.magnetic)).sqrt();
    let flux = mode.flux() * heading;
    let propagating = flux > NO_FLUX * most;
    let size = if propagating { flux } else { mode.norm_squared() };
    LocalMode { propagating, ..mode.scaled(size.sqrt().recip()) }
}

/// The pairs (forward, backward) of s and p.
fn isotropic(
    permittivity: Complex64,
    permeability: Complex64,
    k: [Complex64; 2],
) -> [[ComplexMode; 2]; 2] {
    let [k1, k2] = k;
    let mut q = (permittivity * permeability - k1 * k1 - k2 * k2).sqrt();
    if q.norm_sqr() < 1e-30 {
        q = Complex64::from(1e-15);
    }
    let length = (k1.norm_sqr() + k2.norm_sqr()).sqrt();
    let across =
        if length > 1e-9 { [-k2 / length, k1 / length, Complex64::ZERO] } else { out_of_plane() };
    let pair = |q: Complex64| {
        let curl = cross([k1, k2, q], across);
        let s = LocalMode {
            kind: ModeKind::S,
            propagating: true,
            q,
            electric: across,
            magnetic: curl.map(|component| component / permeability),
        };
        let electric = curl.map(|component| -component / permittivity);
        [s, LocalMode { kind: ModeKind::P, electric, magnetic: across, ..s }]
    };
    let (one, other) = (pair(q), pair(-q));
    let sum = |pair: &[ComplexMode; 2]| pair.iter().map(LocalMode::forwardness).sum::<f64>();
    if sum(&one) >= sum(&other) { [one, other] } else { [other, one] }
}

/// The pairs (forward, backward) of ordinary and extraordinary mode.
fn uniaxial(
    medium: &Uniaxial<Complex64>,
    frame: &Frame,
    k: [Complex64; 2],
) -> [[ComplexMode; 2]; 2] {
    let axis = frame.components(medium.axis);
    let [ordinary, extraordinary] = medium.equations(k, axis).map(|e| e.complex_roots());
    // Close to the axis rounding makes p × a of each wave what it likes; one of them serves both.
    let direction = |q: Complex64| field_direction([k[0], k[1], q], axis);
    let sorted = |modes: [(ComplexMode, bool); 2]| {
        let [a, b] = modes;
        if a.0.forwardness() >= b.0.forwardness() { [a, b] } else { [b, a] }
    };
    let o = sorted(ordinary.map(|q| {
        let (u, on_axis) = direction(q);
        (medium.ordinary_mode([k[0], k[1], q], u), on_axis)
    }));
    let e = sorted(extraordinary.map(|q| {
        let (u, on_axis) = direction(q);
        (medium.extraordinary_mode(axis, [k[0], k[1], q], u), on_axis)
    }));
    std::array::from_fn(|i| {
        let ((o, o_on_axis), (e, e_on_axis)) = (o[i], e[i]);
        if o_on_axis && e_on_axis { medium.named_along_axis(o, e) } else { [o, e] }
    })
}
