//! Fourier sums at evenly spaced points, fast for any step between them.

use std::f64::consts::PI;

use num_complex::Complex64;

/// Sums Σ_j a_j exp(iθ j m) for m = 0, 1, ...
///
/// With 2jm = j² + m² - (j - m)² they are a convolution with a chirp (Bluestein, IEEE Trans. Audio
/// Electroacoust. 18, 451 (1970)), and that is a product of Fourier transforms whose length can be
/// a power of two.
#[derive(Debug)]
pub(super) struct ChirpTransform {
    /// exp(iθ n²/2) for the first numbers.
    chirp: Vec<Complex64>,
    /// The transform of its conjugate over the length.
    kernel: Vec<Complex64>,
    fourier: Fourier,
    /// Where the convolutions are done.
    room: Vec<Complex64>,
}

impl ChirpTransform {
    /// For at most so many a_j and m; `chirp(n²)` is exp(iθ n²/2).
    pub fn new(inputs: usize, outputs: usize, chirp: impl Fn(u64) -> Complex64) -> Self {
        let chirp: Vec<_> = (0..inputs.max(outputs) as u64).map(|n| chirp(n * n)).collect();
        let length = (inputs + outputs).next_power_of_two();
        let mut kernel = vec![Complex64::ZERO; length];
        for (n, root) in chirp.iter().enumerate() {
            let value = root.conj() / length as f64;
            if n < outputs {
                kernel[n] = value;
            }
            if n > 0 && n < inputs {
                kernel[length - n] = value;
            }
        }
        let fourier = Fourier::new(length);
        fourier.forward(&mut kernel);
        Self { chirp, kernel, fourier, room: vec![Complex64::ZERO; length] }
    }

    /// The sums, from the first one on.
    pub fn sums(
        &mut self,
        inputs: impl Iterator<Item = Complex64>,
    ) -> impl Iterator<Item = Complex64> {
        self.room.fill(Complex64::ZERO);
        for ((room, input), chirp) in self.room.iter_mut().zip(inputs).zip(&self.chirp) {
            *room = input * chirp;
        }
        self.fourier.forward(&mut self.room);
        for (room, kernel) in self.room.iter_mut().zip(&self.kernel) {
            *room *= kernel;
        }
        self.fourier.backward(&mut self.room);
        self.room.iter().zip(&self.chirp).map(|(room, chirp)| room * chirp)
    }
}

/// Fourier transforms of one length, a power of two. What they transform to is in an order of its
/// own, the same for all.
#[derive(Debug)]
struct Fourier {
    /// exp(-2πi n/length) for half a circle.
    roots: Vec<Complex64>,
}

impl Fourier {
    fn new(length: usize) -> Self {
        let root = |n: usize| Complex64::cis(-2.0 * PI * n as f64 / length as f64);
        Self { roots: (0..length / 2).map(root).collect() }
    }

    fn forward(&self, data: &mut [Complex64]) {
        let mut half = data.len() / 2;
        while half > 0 {
            let stride = self.roots.len() / half;
            for block in data.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                let roots = self.roots.iter().step_by(stride);
                for ((low, high), root) in low.iter_mut().zip(high).zip(roots) {
                    (*low, *high) = (*low + *high, (*low - *high) * root);
                }
            }
            half /= 2;
        }
    }

    /// Undoes [`Self::forward`] but for a factor, the length.
    fn backward(&self, data: &mut [Complex64]) {
        let mut half = 1;
        while half < data.len() {
            let stride = self.roots.len() / half;
            for block in data.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                let roots = self.roots.iter().step_by(stride);
                for ((low, high), root) in low.iter_mut().zip(high).zip(roots) {
                    let turned = *high * root.conj();
                    (*low, *high) = (*low + turned, *low - turned);
                }
            }
            half *= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_that_are_asked_for() {
        for (inputs, outputs, step) in [(1, 1, 0.3), (5, 9, 1.7), (40, 7, 0.01), (33, 33, 0.19)] {
            let chirp = |square: u64| Complex64::cis(0.5 * step * square as f64);
            let mut transform = ChirpTransform::new(inputs, outputs, chirp);
            let given: Vec<Complex64> = (0..inputs)
                .map(|j| Complex64::new((j as f64 * 0.7).sin(), (j as f64 * 1.3).cos()))
                .collect();
            // What was transformed before leaves no trace.
            for used in [inputs, 1] {
                let sums: Vec<_> = transform.sums(given[..used].iter().copied()).collect();
                for (m, sum) in sums[..outputs].iter().enumerate() {
                    let terms = given[..used].iter().enumerate();
                    let expected: Complex64 =
                        terms.map(|(j, a)| a * Complex64::cis(step * (j * m) as f64)).sum();
                    assert!((sum - expected).norm() < 1e-13, "{inputs} {outputs} {m}");
                }
            }
        }
    }
}
