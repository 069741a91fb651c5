//! The first surface that a ray meets, looked at on its own.

use super::{Launch, Limits, PathRecorder, Tracer};
use optics::interface::{OutgoingWave, Side};
use optics::medium::ModeKind;

/// What becomes of a ray's power at the first surface that it meets, for each launched
/// polarization.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstFace<const N: usize> {
    /// The share reflected: all of it by metal.
    pub reflected: [f64; N],
    /// The share that goes on in the ordinary wave of a uniaxial medium.
    pub ordinary: [f64; N],
    /// The share that goes on in the extraordinary wave of a uniaxial medium.
    pub extraordinary: [f64; N],
}

impl<const N: usize> Default for FirstFace<N> {
    fn default() -> Self {
        Self { reflected: [0.0; N], ordinary: [0.0; N], extraordinary: [0.0; N] }
    }
}

impl<const N: usize> FirstFace<N> {
    /// Adds the waves that leave the surface.
    pub(super) fn add(&mut self, waves: &[OutgoingWave<N>]) {
        for wave in waves {
            let sum = match (wave.side, wave.mode) {
                (Side::Reflected, _) => &mut self.reflected,
                (_, ModeKind::Ordinary) => &mut self.ordinary,
                (_, ModeKind::Extraordinary) => &mut self.extraordinary,
                _ => continue,
            };
            for (sum, power) in sum.iter_mut().zip(wave.power) {
                *sum += power;
            }
        }
    }
}

impl<const N: usize, W: PathRecorder<N>> Tracer<'_, N, W> {
    /// What becomes of a ray at the first surface that it meets, without following it any further:
    /// the same walk, stopped there. `None` if it meets none before the screen.
    #[must_use]
    pub fn first_face(&self, launch: &Launch<N>) -> Option<FirstFace<N>> {
        let limits = Limits { min_power: 0.0, ..self.limits };
        let mut stopped = Tracer::new(self.assembly, limits).watched(None);
        (stopped.screen, stopped.screen_touches) = (self.screen, self.screen_touches);
        stopped.stands_alone = self.stands_alone;
        stopped.trace(launch);
        *stopped.recorder()
    }
}
