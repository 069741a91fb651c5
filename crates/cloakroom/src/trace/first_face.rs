//! The first surface that a ray meets, looked at on its own.

use super::bodies::{Around, Bodies, Inside};
use super::branch::{Branch, Left};
use super::surfaces::entered;
use super::{Launch, Tracer, Witness};
use crate::device::{Beyond, Finish};
use optics::interface::{OutgoingWave, Side, split, transmit_antireflection};
use optics::medium::{Medium, ModeKind};

/// What becomes of a ray's power at the first surface that it meets, for each launched polarization.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstFace<const N: usize> {
    /// The share reflected: all of it by metal.
    pub reflected: [f64; N],
    /// The share that goes on in the ordinary wave of a uniaxial medium.
    pub ordinary: [f64; N],
    /// The share that goes on in the extraordinary wave of a uniaxial medium.
    pub extraordinary: [f64; N],
}

impl<const N: usize> FirstFace<N> {
    /// Adds the waves that leave the surface.
    fn add(&mut self, waves: &[OutgoingWave<N>]) {
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

impl<const N: usize, W: Witness<N>> Tracer<'_, N, W> {
    /// What becomes of a ray at the first surface that it meets, without following it any further;
    /// `None` if it meets none before the screen. The ray must start in air.
    #[must_use]
    pub fn first_face(&self, launch: &Launch<N>) -> Option<FirstFace<N>> {
        let (mut branch, mut left) = (Branch::launched(launch), None);
        loop {
            let hit = self.surface_ahead(branch.position, branch.direction, left);
            let mut face =
                FirstFace { reflected: [0.0; N], ordinary: [0.0; N], extraordinary: [0.0; N] };
            let distance = hit.map(|(_, hit)| hit.distance);
            if let Some(crossing) = self.body_ahead(branch.position, branch.direction, distance) {
                let bodies = self.bench.bodies();
                let beyond = bodies.inside(Bodies::beyond(Around::default(), &crossing));
                if let Inside::Medium(medium, _) = beyond {
                    face.add(&split(&Medium::AIR, medium, &branch.incident(), crossing.onward));
                }
                return Some(face);
            }
            let (device_index, hit) = hit?;
            branch.position += branch.direction * hit.distance;
            match hit.beyond {
                // A thin sheet of air: nothing there.
                Beyond::Air => {
                    left = Some(Left { device: device_index, surface: Some(hit.skin) });
                    continue;
                }
                Beyond::Conductor => face.reflected = branch.power,
                Beyond::Cell(cell) | Beyond::Seam(cell) => {
                    let device = &self.bench.devices()[usize::from(device_index)];
                    branch.enter_frame(&device.pose);
                    let mut graded = None;
                    let cell = self.cell(device, cell);
                    let (_, beyond) = entered(cell, branch.position, &mut graded)?;
                    let (wave, into) = (branch.incident(), -hit.outward);
                    let waves = match hit.finish {
                        Finish::Bare => split(&Medium::AIR, beyond, &wave, into),
                        Finish::Antireflection => {
                            transmit_antireflection(&Medium::AIR, beyond, &wave, into)
                        }
                    };
                    face.add(&waves);
                }
            }
            return Some(face);
        }
    }
}
