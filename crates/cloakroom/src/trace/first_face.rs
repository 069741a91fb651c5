//! The first surface that a ray meets, looked at on its own.

use super::tracer::split_as_finished;
use super::{Launch, Tracer};
use crate::device::Beyond;
use glam::DVec3;
use optics::interface::{IncidentWave, Side};
use optics::medium::{Medium, ModeKind};
use optics::wave::ComplexVector;

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

impl<const N: usize> Tracer<'_, N> {
    /// What becomes of a ray at the first surface that it meets, without following it any further;
    /// `None` if it meets none before the screen. The ray must start in air.
    #[must_use]
    pub fn first_face(&self, launch: &Launch<N>) -> Option<FirstFace<N>> {
        let (mut position, mut left) = (launch.origin, None);
        loop {
            let (device_index, hit) = self.surface_ahead(position, launch.direction, left)?;
            position += launch.direction * hit.distance;
            let power = launch.electric.map(ComplexVector::norm_squared);
            let mut face =
                FirstFace { reflected: [0.0; N], ordinary: [0.0; N], extraordinary: [0.0; N] };
            match hit.beyond {
                // A thin sheet of air: nothing there.
                Beyond::Air => {
                    left = Some((device_index, hit.skin));
                    continue;
                }
                Beyond::Conductor => face.reflected = power,
                Beyond::Cell(cell) | Beyond::Seam(cell) => {
                    let device = &self.bench.devices()[usize::from(device_index)];
                    let pose = &device.pose;
                    let entrance = self.cell(device, cell).enter(pose.to_local(position))?;
                    let direction = pose.vector_to_local(launch.direction);
                    let wave = IncidentWave {
                        wave_vector: direction,
                        attenuation: DVec3::ZERO,
                        direction,
                        electric: launch.electric.map(|field| pose.field_to_local(field)),
                        power,
                    };
                    let into = -hit.outward;
                    let (from, to) = (&Medium::AIR, &entrance.medium);
                    for wave in split_as_finished(from, to, &wave, into, hit.finish) {
                        let sum = match (wave.side, wave.mode) {
                            (Side::Reflected, _) => &mut face.reflected,
                            (_, ModeKind::Ordinary) => &mut face.ordinary,
                            (_, ModeKind::Extraordinary) => &mut face.extraordinary,
                            _ => continue,
                        };
                        for (sum, power) in sum.iter_mut().zip(wave.power) {
                            *sum += power;
                        }
                    }
                }
            }
            return Some(face);
        }
    }
}
