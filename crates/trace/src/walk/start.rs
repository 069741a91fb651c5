//! Rays that start in a medium.

use super::branch::{Branch, Place, largest};
use super::{PathRecorder, Tracer};
use crate::assembly::{Ahead, Assembly};
use glam::DVec3;
use num_complex::Complex64;
use optics::medium::{Medium, RayWave};
use optics::wave::{ComplexVector, poynting};

impl Assembly {
    /// The device and its region in which a ray starts at a point of the world; `None` in air.
    ///
    /// # Errors
    ///
    /// The number of the device in whose metal or opaque inside it would start.
    pub fn region_around(
        &self,
        point: DVec3,
        direction: DVec3,
    ) -> Result<Option<(u16, u16)>, usize> {
        let number = match self.device_containing(point) {
            Some(number) => number,
            // On the border of a body the direction decides.
            None => match self.ahead(point, direction, None) {
                Ahead::Body(number) => usize::from(number),
                Ahead::Air | Ahead::Surface(..) => return Ok(None),
            },
        };
        let device = &self.devices()[number];
        let region = if device.body().is_some() && !device.structure.regions.is_empty() {
            Some(0)
        } else {
            device.structure.region_at(device.pose.to_local(point)).map(|(region, _)| region)
        };
        // Devices are numbered in 16 bits.
        region.map(|region| Some((number as u16, region))).ok_or(number)
    }
}

impl<const N: usize, W: PathRecorder<N>> Tracer<'_, N, W> {
    /// Puts a launched branch where it starts; whether it goes on from there. In a birefringent
    /// medium it becomes two that wait.
    pub(super) fn start(&mut self, branch: &mut Branch<N>) -> bool {
        if self.started.0 != branch.position {
            let place = self.assembly.region_around(branch.position, branch.direction);
            let Ok(place) = place else { return self.lose(branch.power) };
            self.started = (branch.position, place);
        }
        let Some((number, region)) = self.started.1 else { return true };
        let device = self.assembly.device(number);
        branch.enter_frame(&device.pose);
        branch.place = Place::Region { device: number, region };
        let found = device.region(region).enter_if_within(branch.position);
        let Some((virtual_point, medium)) = found else { return self.lose(branch.power) };
        branch.virtual_point = virtual_point;
        let waves = medium.waves_along_ray(branch.direction);
        match waves.as_slice() {
            [] => self.lose(branch.power),
            [wave] if wave.electric.is_none() => {
                launch_as(branch, &medium, wave);
                if self.is_kept(branch) { self.cut(branch.power) } else { true }
            }
            waves => {
                for (wave, amplitudes) in waves.iter().zip(amplitudes(branch, waves)) {
                    let started = branch.as_wave(wave, amplitudes);
                    let power = largest(&started.power);
                    if self.is_kept(&started) {
                        self.cut(started.power);
                    } else if self.recorder.went_on(branch.path, started.path, power) {
                        self.await_turn(started);
                    }
                }
                false
            }
        }
    }

    /// Whether light never gets out of the device in which it starts: along what is endless it is shorter than
    /// any wave in air, and stays so.
    fn is_kept(&self, started: &Branch<N>) -> bool {
        let along = started.wave_vector * self.assembly.endless_axes;
        W::CUTS_KEPT_LIGHT
            && self.keeps_light
            && along.length_squared() > SHORTER
            && self.draw.is_none()
    }
}

/// The square of how often a wave fits into one in air that is certainly shorter, whatever is rounded.
const SHORTER: f64 = 1.0 + 1e-9;

/// Launches a branch as the one wave that both polarizations share.
fn launch_as<const N: usize>(branch: &mut Branch<N>, medium: &Medium, wave: &RayWave) {
    branch.wave_vector = wave.wave_vector;
    branch.attenuation = wave.attenuation;
    branch.mode = wave.kind;
    let vector = ComplexVector::new(wave.wave_vector, wave.attenuation);
    for (field, power) in branch.electric.iter_mut().zip(branch.power) {
        let flux = poynting(*field, medium.decaying_magnetic_field(vector, *field)).length();
        *field = *field * (power / flux).sqrt();
    }
}

/// The amplitudes of the waves in each launched field, which lies across the ray as theirs do;
/// their powers add up to the branch's.
fn amplitudes<const N: usize>(branch: &Branch<N>, waves: &[RayWave]) -> [[Complex64; N]; 2] {
    let (first, second) = branch.direction.any_orthonormal_pair();
    let across = |field: ComplexVector| [field.dot_real(first), field.dot_real(second)];
    let fields = [0, 1].map(|i| waves.get(i).and_then(|wave| wave.electric).map(across));
    let in_both = |(launched, power): (ComplexVector, f64)| {
        let e = across(launched);
        let [one, other] = match fields {
            [Some(a), Some(b)] => {
                let determinant = a[0] * b[1] - a[1] * b[0];
                [
                    (e[0] * b[1] - e[1] * b[0]) / determinant,
                    (a[0] * e[1] - a[1] * e[0]) / determinant,
                ]
            }
            _ => [Complex64::ONE, Complex64::ZERO],
        };
        let size = (power / (one.norm_sqr() + other.norm_sqr())).sqrt();
        [one * size, other * size]
    };
    let shares: [[Complex64; 2]; N] =
        std::array::from_fn(|i| in_both((branch.electric[i], branch.power[i])));
    [0, 1].map(|wave| shares.map(|share| share[wave]))
}
