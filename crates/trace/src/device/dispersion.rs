//! How the media of metamaterial devices depend on the frequency.

use super::{DispersiveTensors, Region, Structure};
use crate::keys::KeyError;
use glam::DMat3;
use optics::medium::{Medium, Tensor, principal_axes};

crate::choice! {
    /// How the medium of a device depends on the frequency: what a pulse takes, and what light of
    /// other wavelengths than that of the design meets.
    pub enum Dispersion {
        /// As little as causality allows: no device can be faster. Other wavelengths meet the same
        /// medium.
        Causal = "causal",
        /// Not at all: a pulse takes what its phase takes.
        None = "none",
        /// Each principal value e below 1 is a plasma's, 1 - (1 - e) λ²/λd², and others are constant:
        /// the least that causality allows at every wavelength.
        Drude = "drude",
        /// Values below 1 are a plasma's, and those above 1 are of a resonance at λ0: 1 + (e - 1) (1/λ0²
        /// - 1/λd²)/(1/λ0² - 1/λ²).
        Lorentz = "lorentz",
    }
}

/// The light that meets a device, by its wavelength in vacuum, and the law of its media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersionLaw {
    /// Which law.
    pub kind: Dispersion,
    /// The wavelength at which media are what the design says, nm.
    pub design_nm: f64,
    /// The wavelength of the resonance of Lorentz's law, nm.
    pub resonance_nm: f64,
    /// The wavelength of the light, nm.
    pub wavelength_nm: f64,
}

impl DispersionLaw {
    /// A principal value of a tensor e at the design's wavelength as it is for the light, and d(ωe)/dω
    /// there.
    ///
    /// Drude's law is 1 - ωp²/ω² and Lorentz's 1 + s ω0²/(ω0² - ω²); ωp and s follow from the value.
    #[must_use]
    pub fn value(&self, design: f64) -> [f64; 2] {
        let squared = |nm: f64| (self.design_nm / nm).powi(2);
        // ω²/ωd² and ω0²/ωd².
        let (here, resonance) = (squared(self.wavelength_nm), squared(self.resonance_nm));
        match self.kind {
            Dispersion::Drude | Dispersion::Lorentz if design < 1.0 => {
                let plasma = (1.0 - design) / here;
                [1.0 - plasma, 1.0 + plasma]
            }
            Dispersion::Lorentz => {
                let (strength, off) = ((design - 1.0) * (resonance - 1.0), resonance - here);
                [1.0 + strength / off, 1.0 + strength * (resonance + here) / (off * off)]
            }
            Dispersion::Drude | Dispersion::Causal | Dispersion::None => [design, design],
        }
    }

    /// A tensor for the light, and d(ωe)/dω; what absorbs does so as it is designed to.
    fn tensors(&self, design: &Tensor) -> [Tensor; 2] {
        let (values, axes) = principal_axes(&design.re);
        [0, 1].map(|which| {
            let values = values.to_array().map(|value| self.value(value)[which]);
            let re = axes * DMat3::from_diagonal(values.into()) * axes.transpose();
            Tensor { re: (re + re.transpose()) * 0.5, im: design.im }
        })
    }

    /// Gives the media of a structure their law; what has one of its own keeps it.
    ///
    /// # Errors
    ///
    /// If a medium is graded, or there is none left.
    pub fn apply(&self, mut structure: Structure) -> Result<Structure, KeyError> {
        if !matches!(self.kind, Dispersion::Drude | Dispersion::Lorentz) {
            return Ok(structure);
        }
        let refuse = |message: String| KeyError::at("dispersion", message);
        let word = self.kind.word();
        for region in &mut structure.regions {
            let Region::Homogeneous(region) = region else {
                return Err(refuse(format!(
                    "dispersion is \"{word}\", but the device is graded, and its rays are known for its design \
                     alone; it must be \"causal\" or \"none\""
                )));
            };
            if region.law.is_some() {
                continue;
            }
            let (permittivity, permeability) = region.medium.tensors();
            let [[permittivity, electric], [permeability, magnetic]] =
                [permittivity, permeability].map(|tensor| self.tensors(&tensor));
            // At the design's wavelength it is the medium that it was, to the last digit.
            if self.wavelength_nm != self.design_nm {
                region.medium = Medium::new(permittivity, permeability).map_err(|error| {
                    let nm = self.wavelength_nm;
                    refuse(format!(
                        "with dispersion \"{word}\" there is no medium left at {nm} nm: {error}"
                    ))
                })?;
            }
            region.law = Some(DispersiveTensors { permittivity: electric, permeability: magnetic });
        }
        Ok(structure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(kind: Dispersion, wavelength_nm: f64) -> DispersionLaw {
        DispersionLaw { kind, design_nm: 550.0, resonance_nm: 275.0, wavelength_nm }
    }

    #[test]
    fn laws_go_through_the_design_and_are_causal() {
        for kind in [Dispersion::Drude, Dispersion::Lorentz] {
            for design in [-3.0, -1.0, 0.1, 0.9, 1.0, 1.7, 12.0] {
                assert!((law(kind, 550.0).value(design)[0] - design).abs() < 1e-12);
                for nm in [300.0, 400.0, 550.0, 700.0, 2000.0] {
                    let [value, derivative] = law(kind, nm).value(design);
                    let least = value.max(2.0 - value);
                    assert!(derivative >= least * (1.0 - 1e-12), "{kind:?} {design} {nm}");
                    // d(ωe)/dω = e - λ de/dλ.
                    let h = 1e-4 * nm;
                    let slope = [nm - h, nm + h].map(|nm| law(kind, nm).value(design)[0]);
                    let slope = (slope[1] - slope[0]) / (2.0 * h);
                    assert!(
                        (derivative - (value - nm * slope)).abs() < 1e-5 * derivative,
                        "{kind:?} {design} {nm}"
                    );
                }
            }
        }
    }
}
