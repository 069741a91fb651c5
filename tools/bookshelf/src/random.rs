//! Small deterministic randomness: an integer hash, a generator built on it,
//! and smooth noise for grain, cloth and hair.

use glam::Vec3;

/// Mixes the bits of `x` (the output permutation of PCG-RXS-M-XS).
pub fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A hash of two integers.
pub fn hash2(a: u32, b: u32) -> u32 {
    hash(a ^ hash(b ^ 0x9e37_79b9))
}

/// A hash of three integers.
pub fn hash3(a: u32, b: u32, c: u32) -> u32 {
    hash(a ^ hash2(b, c))
}

/// Maps a hash to a number in `[0, 1)`.
pub fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 / 16_777_216.0
}

/// A counting generator: every draw hashes the seed with the next index.
#[derive(Debug, Clone)]
pub struct Random {
    seed: u32,
    drawn: u32,
}

impl Random {
    /// A generator whose stream depends on `seed` alone.
    pub fn new(seed: u32) -> Self {
        Self { seed, drawn: 0 }
    }

    /// The next 32 bits.
    pub fn bits(&mut self) -> u32 {
        self.drawn = self.drawn.wrapping_add(1);
        hash2(self.seed, self.drawn)
    }

    /// The next number in `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        unit(self.bits())
    }

    /// The next number in `[low, high)`.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Whether an event of this probability happens.
    pub fn chance(&mut self, probability: f32) -> bool {
        self.unit() < probability
    }

    /// One of the `choices`, which must not be empty.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.bits() as usize % choices.len()]
    }

    /// A vector with each coordinate in `[-1, 1)`.
    pub fn in_cube(&mut self) -> Vec3 {
        Vec3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0))
    }
}

/// Smooth value noise in `[-1, 1]` with features about one unit wide.
pub fn noise(point: Vec3) -> f32 {
    let cell = point.floor();
    let f = point - cell;
    let w = f * f * (3.0 - 2.0 * f);
    let (x, y, z) = (cell.x as i32 as u32, cell.y as i32 as u32, cell.z as i32 as u32);
    let corner = |dx: u32, dy: u32, dz: u32| {
        unit(hash3(x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz)))
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let near = mix(
        mix(corner(0, 0, 0), corner(1, 0, 0), w.x),
        mix(corner(0, 1, 0), corner(1, 1, 0), w.x),
        w.y,
    );
    let far = mix(
        mix(corner(0, 0, 1), corner(1, 0, 1), w.x),
        mix(corner(0, 1, 1), corner(1, 1, 1), w.x),
        w.y,
    );
    2.0 * mix(near, far, w.z) - 1.0
}

/// Three octaves of [`noise`], within about `[-1.75, 1.75]`.
pub fn cloudy(point: Vec3) -> f32 {
    noise(point) + 0.5 * noise(point * 2.03 + 7.1) + 0.25 * noise(point * 4.1 + 3.7)
}
