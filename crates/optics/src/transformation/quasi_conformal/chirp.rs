//! Fourier sums at evenly spaced points, fast for any step between them.

use num_complex::Complex64;
use rustfft::algorithm::Radix4;
use rustfft::{Fft, FftDirection};

/// Sums Σ_j a_j exp(iθ j m) for m = 0, 1, ...
///
/// With 2jm = j² + m² - (j - m)² they are a convolution with a chirp (Bluestein, IEEE Trans. Audio
/// Electroacoust. 18, 451 (1970)), and that is a product of Fourier transforms whose length can be
/// a power of two.
pub(super) struct ChirpTransform {
    /// exp(iθ n²/2) for the first numbers.
    chirp: Vec<Complex64>,
    /// The transform of its conjugate over the length.
    kernel: Vec<Complex64>,
    forward: Radix4<f64>,
    backward: Radix4<f64>,
    /// Where the convolutions are done, and what they need beside.
    room: Vec<Complex64>,
    scratch: Vec<Complex64>,
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
        let [forward, backward] = [FftDirection::Forward, FftDirection::Inverse]
            .map(|direction| Radix4::new(length, direction));
        let needed = forward.get_inplace_scratch_len().max(backward.get_inplace_scratch_len());
        let mut scratch = vec![Complex64::ZERO; needed];
        forward.process_with_scratch(&mut kernel, &mut scratch);
        Self { chirp, kernel, forward, backward, room: vec![Complex64::ZERO; length], scratch }
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
        self.forward.process_with_scratch(&mut self.room, &mut self.scratch);
        for (room, kernel) in self.room.iter_mut().zip(&self.kernel) {
            *room *= kernel;
        }
        self.backward.process_with_scratch(&mut self.room, &mut self.scratch);
        self.room.iter().zip(&self.chirp).map(|(room, chirp)| room * chirp)
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
