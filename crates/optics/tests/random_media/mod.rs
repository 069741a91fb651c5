//! Random media of every kind, and what their waves must obey.

use glam::{DMat3, DVec3};
use optics::interface::Scattering;
use optics::medium::{Medium, Mode, Tensor};
use optics::wave::ComplexVector;

/// `SplitMix64`.
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    fn positive(&mut self) -> f64 {
        self.between(0.2, 4.0)
    }

    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * angle.cos(), r * angle.sin(), z)
    }

    /// A symmetric tensor with the given principal values and random axes.
    fn tensor(&mut self, values: DVec3) -> DMat3 {
        let turn = DMat3::from_axis_angle(self.direction(), self.between(0.0, 6.3));
        let m = turn * DMat3::from_diagonal(values) * turn.transpose();
        (m + m.transpose()) * 0.5
    }

    fn values(&mut self, indefinite: bool) -> DVec3 {
        let mut values = DVec3::from_array([self.positive(), self.positive(), self.positive()]);
        if indefinite {
            for i in 0..3 {
                values[i] *= self.sign();
            }
        }
        values
    }
}

pub const KINDS: [&str; 11] = [
    "isotropic",
    "negative",
    "uniaxial magnetic",
    "uniaxial electric",
    "impedance matched",
    "biaxial",
    "general",
    "general negative",
    "hyperbolic uniaxial",
    "hyperbolic general",
    "absorbing",
];

/// A medium of the kind `KINDS[kind]`.
pub fn medium(kind: usize, random: &mut Random) -> Medium {
    let axis = random.direction();
    let [a, b, c] = [random.positive(), random.positive(), random.positive()];
    let made = match kind {
        0 => Medium::isotropic(a, b),
        1 => Medium::isotropic(-a, -b),
        2 => Medium::uniaxial_magnetic(a, b, c, axis),
        3 => Medium::uniaxial_electric(a, b, c, axis),
        4 => {
            let indefinite = random.unit() < 0.3;
            let values = random.values(indefinite);
            Medium::impedance_matched(random.tensor(values))
        }
        5 => {
            let values = random.values(false);
            Medium::new(random.tensor(values), a)
        }
        6 | 7 => {
            let sign = if kind == 6 { 1.0 } else { -1.0 };
            let (e, m) = (random.values(false) * sign, random.values(false) * sign);
            Medium::new(random.tensor(e), random.tensor(m))
        }
        8 => {
            let [s, t, u] = [random.sign(), random.sign(), random.sign()];
            if random.unit() < 0.5 {
                Medium::uniaxial_magnetic(a * s, b * t, c * u, axis)
            } else {
                Medium::uniaxial_electric(a * s, b * t, c * u, axis)
            }
        }
        9 => {
            let (e, m) = (random.values(true), random.values(true));
            Medium::new(random.tensor(e), random.tensor(m))
        }
        _ => {
            let (e, loss) = (random.values(true), random.values(false) * 0.3);
            let tensor = Tensor { re: random.tensor(e), im: random.tensor(loss) };
            match random.below(3) {
                0 => Medium::new(tensor, a),
                1 => Medium::new(num_complex::Complex64::new(e.x, loss.x), a),
                _ => {
                    let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
                    let part =
                        |along: f64, across: f64| dyad * along + (DMat3::IDENTITY - dyad) * across;
                    let mu = Tensor { re: part(e.x, e.y), im: part(loss.x, loss.y) };
                    Medium::new(a, mu)
                }
            }
        }
    };
    made.expect("a sound medium")
}

fn transformed(tensor: &Tensor, v: ComplexVector) -> ComplexVector {
    let lossy = v.transformed(&tensor.im);
    v.transformed(&tensor.re) + ComplexVector::new(-lossy.im, lossy.re)
}

fn norm(v: ComplexVector) -> f64 {
    v.norm_squared().sqrt()
}

fn size(t: &Tensor) -> f64 {
    let entries = t.re.to_cols_array().into_iter().chain(t.im.to_cols_array());
    entries.fold(0.0, |largest, entry| entry.abs().max(largest))
}

/// The larger of |p × E - µH| and |p × H + εE|, relative to the terms they are made of.
pub fn maxwell_residual(medium: &Medium, mode: &Mode) -> f64 {
    let (e, m) = medium.tensors();
    let Mode { wave_vector: p, electric, magnetic, .. } = *mode;
    let faraday = p.cross(electric) - transformed(&m, magnetic);
    let ampere = p.cross(magnetic) + transformed(&e, electric);
    let scale = (norm(p) + size(&e) + size(&m)) * (norm(electric) + norm(magnetic));
    norm(faraday).max(norm(ampere)) / scale
}

/// The jump of the tangential fields, relative to the largest of them, for an incident mode.
pub fn jump(scattering: &Scattering, column: usize, normal: DVec3) -> f64 {
    let mut electric = ComplexVector::ZERO;
    let mut magnetic = ComplexVector::ZERO;
    let mut largest: f64 = 0.0;
    let mut add = |mode: &Mode, amplitude: num_complex::Complex64| {
        let (e, h) = (mode.electric.scaled(amplitude), mode.magnetic.scaled(amplitude));
        largest = largest.max(norm(e)).max(norm(h));
        electric = electric + e.crossed_by(normal);
        magnetic = magnetic + h.crossed_by(normal);
    };
    add(&scattering.incident[column], 1.0.into());
    let amplitude = |row: usize| scattering.amplitudes[row][column];
    add(&scattering.reflected[0], amplitude(0));
    add(&scattering.reflected[1], amplitude(1));
    match &scattering.transmitted {
        Some([a, b]) => {
            add(a, -amplitude(2));
            add(b, -amplitude(3));
        }
        // Metal takes no tangential electric field and carries any surface current.
        None => magnetic = ComplexVector::ZERO,
    }
    norm(electric).max(norm(magnetic)) / largest
}
