//! A slow, plain integrator of rays in graded anisotropic media: Hamilton's equations of the local
//! dispersion relation in physical space, by extrapolation. It knows the tensors as the literature
//! prints them, and no map, no virtual space and no conserved quantity. Derivatives are exact, by
//! dual numbers.

use glam::DVec3;
use std::ops::{Add, Div, Mul, Sub};

/// A number with its derivatives by x, y, z, p_x, p_y, p_z.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    value: f64,
    slope: [f64; 6],
}

impl Dual {
    pub fn constant(value: f64) -> Self {
        Self { value, slope: [0.0; 6] }
    }

    fn variable(value: f64, index: usize) -> Self {
        let mut slope = [0.0; 6];
        slope[index] = 1.0;
        Self { value, slope }
    }

    fn mapped(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: self.slope.map(|s| s * derivative) }
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.mapped(root, 0.5 / root)
    }

    /// A function given by its value and derivative at the point.
    pub fn through(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, derivative) = function(self.value);
        self.mapped(value, derivative)
    }

    fn combined(self, other: Self, value: f64, a: f64, b: f64) -> Self {
        Self { value, slope: std::array::from_fn(|i| a * self.slope[i] + b * other.slope[i]) }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.combined(other, self.value + other.value, 1.0, 1.0)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.combined(other, self.value - other.value, 1.0, -1.0)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.combined(other, self.value * other.value, other.value, self.value)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        self.combined(other, value, 1.0 / other.value, -value / other.value)
    }
}

/// Position and wave vector.
pub type Phase = [Dual; 6];

/// The length of the position across z, and the parts of p along the radius and around, squared.
pub fn cylindrical([x, y, _, px, py, _]: Phase) -> (Dual, Dual, Dual) {
    let r = (x * x + y * y).sqrt();
    let radial = (x * px + y * py) / r;
    let around = (x * py - y * px) / r;
    (r, radial * radial, around * around)
}

/// The length of the position, and the parts of p along the radius and across, squared.
pub fn spherical([x, y, z, px, py, pz]: Phase) -> (Dual, Dual, Dual) {
    let r = (x * x + y * y + z * z).sqrt();
    let radial = (x * px + y * py + z * pz) / r;
    let all = px * px + py * py + pz * pz;
    (r, radial * radial, all - radial * radial)
}

/// A ray at the end of its way.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub position: DVec3,
    pub wave_vector: DVec3,
    /// ∂H/∂p.
    pub velocity: DVec3,
    pub optical_path: f64,
}

/// Position, wave vector and optical path.
type State = [f64; 7];

fn split(y: &State) -> (DVec3, DVec3) {
    (DVec3::from_slice(&y[..3]), DVec3::from_slice(&y[3..6]))
}

fn moved(y: &State, h: f64, slope: &State) -> State {
    std::array::from_fn(|i| y[i] + h * slope[i])
}

/// The modified midpoint rule over `h` in `count` steps.
fn midpoint(y: &State, h: f64, count: u32, slope: &impl Fn(&State) -> State) -> State {
    let step = h / f64::from(count);
    let (mut last, mut here) = (*y, moved(y, step, &slope(y)));
    for _ in 1..count {
        (last, here) = (here, moved(&last, 2.0 * step, &slope(&here)));
    }
    let ahead = moved(&last, 2.0 * step, &slope(&here));
    std::array::from_fn(|i| 0.25 * (last[i] + 2.0 * here[i] + ahead[i]))
}

/// The method of Gragg, Bulirsch and Stoer: midpoint rules extrapolated in h². The end of the step,
/// and how far it is from the extrapolation with one rule less.
fn extrapolated(y: &State, h: f64, slope: &impl Fn(&State) -> State) -> (State, f64) {
    const RULES: usize = 8;
    let count = |k: usize| 2 * (k as u32 + 1);
    let mut table = [[0.0; 7]; RULES];
    let mut error = f64::INFINITY;
    for k in 0..RULES {
        let mut entry = midpoint(y, h, count(k), slope);
        for j in 1..=k {
            let ratio = f64::from(count(k)) / f64::from(count(k - j));
            let before = std::mem::replace(&mut table[j - 1], entry);
            let factor = 1.0 / (ratio * ratio - 1.0);
            entry = std::array::from_fn(|i| entry[i] + (entry[i] - before[i]) * factor);
        }
        if k > 0 {
            error = (0..7).map(|i| (entry[i] - table[k - 1][i]).abs()).fold(0.0, f64::max);
        }
        table[k] = entry;
    }
    (table[RULES - 1], error)
}

/// Where a function that is positive at 0 and negative at `h` vanishes: regula falsi after
/// Illinois.
fn border_between(h: f64, function: impl Fn(f64) -> f64) -> f64 {
    let mut b = (h, function(h));
    // A ray may start on the border, where rounding decides the sign.
    let mut a = (0.0, function(0.0).max(-b.1));
    for _ in 0..60 {
        if (b.0 - a.0).abs() < 1e-15 * h || b.1 == 0.0 {
            break;
        }
        let x = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let there = function(x);
        if there * b.1 < 0.0 {
            a = b;
        } else {
            a.1 *= 0.5;
        }
        b = (x, there);
        if there.abs() < 1e-15 {
            break;
        }
    }
    b.0
}

/// Follows a ray of the dispersion relation H = 0 until `inside`, positive within the medium,
/// changes its sign.
pub fn follow(
    position: DVec3,
    wave_vector: DVec3,
    dispersion: impl Fn(Phase) -> Dual,
    inside: impl Fn(DVec3) -> f64,
    step_size: f64,
) -> End {
    let slope = |y: &State| {
        let d = dispersion(std::array::from_fn(|i| Dual::variable(y[i], i))).slope;
        let path = y[3] * d[3] + y[4] * d[4] + y[5] * d[5];
        [d[3], d[4], d[5], -d[0], -d[1], -d[2], path]
    };
    let mut y = [0.0; 7];
    position.write_to_slice(&mut y[..3]);
    wave_vector.write_to_slice(&mut y[3..6]);
    let mut h = step_size;
    for _ in 0..100_000 {
        let (next, error) = extrapolated(&y, h, &slope);
        // Not where the medium has no sense: the step may have gone through the hole.
        if error.is_nan() || error > 3e-13 {
            h *= 0.5;
            continue;
        }
        if inside(split(&next).0) < 0.0 {
            let end =
                border_between(h, |share| inside(split(&extrapolated(&y, share, &slope).0).0));
            let last = extrapolated(&y, end, &slope).0;
            let (position, wave_vector) = split(&last);
            let velocity = DVec3::from_slice(&slope(&last)[..3]);
            return End { position, wave_vector, velocity, optical_path: last[6] };
        }
        y = next;
        h = (1.5 * h).min(step_size);
    }
    panic!("the ray does not come out");
}
