//! Interfaces in, modes and powers out, as JSON: the form of `cloakroom interface`.

mod read;
#[cfg(test)]
mod tests;

pub use read::{InterfaceError, InterfaceRequest};

use crate::{json, memory};
use num_complex::Complex64;
use optics::interface::{JonesMatrices, Scattering};
use optics::medium::Mode;
use optics::wave::ComplexVector;
use serde::Serialize;

/// How far waves may be from solving Maxwell's equations, relative to their terms.
const RESIDUAL: f64 = 1e-6;

/// A complex vector as three pairs [re, im].
type Components = [[f64; 2]; 3];

/// What the two incident modes become at an interface.
///
/// Modes carry a normal flux of 1 and are orthogonal in flux. Degenerate pairs: s, then p; uniaxial
/// media: ordinary, then extraordinary; others: the smaller |p| first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InterfaceReport {
    /// The two modes that run towards the interface.
    pub incident: [ModeReport; 2],
    /// The two modes that run back.
    pub reflected: [ModeReport; 2],
    /// The two modes beyond; none in metal.
    pub transmitted: Vec<ModeReport>,
    /// Rows are the outgoing modes (reflected 1, 2, transmitted 1, 2; the first two at metal),
    /// columns the incident ones: each the share of the incident normal flux. `null` for evanescent
    /// incident modes, 0 for evanescent outgoing ones.
    pub power: Vec<[Option<f64>; 2]>,
    /// The amplitudes of the outgoing modes for an incident mode of amplitude 1, by the same rows
    /// and columns, each as [re, im]: with the modes' own fields, those at the interface.
    /// Evanescent modes have theirs.
    pub amplitudes: Vec<[[f64; 2]; 2]>,
    /// The same for fields of unit size, in s and p; `null` where a medium is not isotropic.
    pub jones: Option<JonesReport>,
    /// The share of the normal flux that is reflected, for each incident mode: the sum of its rows
    /// and, in a medium that absorbs, what the two modes carry together beyond what each carries
    /// alone.
    pub total_reflected: [Option<f64>; 2],
    /// The same of what is transmitted.
    pub total_transmitted: [Option<f64>; 2],
}

impl InterfaceReport {
    /// Bytes that one takes, with the lists that it owns.
    pub const BYTES: usize = size_of::<Self>() + 2 * size_of::<ModeReport>() + 4 * (16 + 16 + 32);
}

/// Two rows of complex numbers, each as [re, im].
pub type ComplexMatrix = [[[f64; 2]; 2]; 2];

/// What an interface of isotropic media makes of electric fields of unit size, see
/// [`JonesMatrices`]: rows s and p of the wave that leaves, columns s and p of the wave that comes,
/// each number as [re, im].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JonesReport {
    /// Of the wave that is reflected.
    pub reflected: ComplexMatrix,
    /// Of the wave beyond; `null` in metal.
    pub transmitted: Option<ComplexMatrix>,
}

impl From<JonesMatrices> for JonesReport {
    fn from(jones: JonesMatrices) -> Self {
        let pairs = |matrix: [[Complex64; 2]; 2]| matrix.map(|row| row.map(pair));
        Self { reflected: pairs(jones.reflected), transmitted: jones.transmitted.map(pairs) }
    }
}

/// A complex number as [re, im].
fn pair(number: Complex64) -> [f64; 2] {
    [number.re, number.im]
}

/// One mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeReport {
    /// Wave vector p = k/k0, each component as [re, im].
    pub wave_vector: Components,
    /// Poynting vector Re(E × H*); `null` if the mode is evanescent.
    pub poynting: Option<[f64; 3]>,
    /// Electric field, each component as [re, im].
    pub electric_field: Components,
    /// Magnetic field times the vacuum impedance, each component as [re, im].
    pub magnetic_field: Components,
    /// Whether the mode carries power across the interface.
    pub propagating: bool,
}

impl From<&Mode> for ModeReport {
    fn from(mode: &Mode) -> Self {
        let components = |v: ComplexVector| v.components().map(pair);
        Self {
            wave_vector: components(mode.wave_vector),
            poynting: mode.is_propagating().then(|| mode.poynting().to_array()),
            electric_field: components(mode.electric),
            magnetic_field: components(mode.magnetic),
            propagating: mode.is_propagating(),
        }
    }
}

impl InterfaceRequest {
    /// Solves the interface.
    ///
    /// # Errors
    ///
    /// If double precision does not reach: principal values that differ by many powers of ten, and
    /// a long tangential wave vector.
    pub fn solve(&self) -> Result<InterfaceReport, InterfaceError> {
        let Self { incident, transmitted, normal, tangential } = self;
        let scattering = Scattering::new(incident, transmitted.as_ref(), *tangential, *normal);
        self.check(&scattering)?;
        let rows = if transmitted.is_some() { 4 } else { 2 };
        let share = |row: usize| scattering.power.map(|column| column.map(|shares| shares[row]));
        let total = |side: usize| {
            std::array::from_fn(|column| {
                let (shares, together) =
                    scattering.power[column].zip(scattering.interference[column])?;
                Some(shares[2 * side] + shares[2 * side + 1] + together[side])
            })
        };
        let report = |modes: &[Mode; 2]| [(&modes[0]).into(), (&modes[1]).into()];
        let transmitted = scattering.transmitted.iter().flatten();
        Ok(InterfaceReport {
            incident: report(&scattering.incident),
            reflected: report(&scattering.reflected),
            transmitted: transmitted.map(ModeReport::from).collect(),
            power: (0..rows).map(share).collect(),
            amplitudes: scattering.amplitudes[..rows].iter().map(|row| row.map(pair)).collect(),
            jones: scattering.jones.map(JonesReport::from),
            total_reflected: total(0),
            total_transmitted: total(1),
        })
    }

    /// Whether the waves solve Maxwell's equations, and their powers add up.
    fn check(&self, scattering: &Scattering) -> Result<(), InterfaceError> {
        let Scattering { incident, reflected, transmitted, power, interference, .. } = scattering;
        let here = incident.iter().chain(reflected).map(|mode| self.incident.residual(mode));
        let beyond = self.transmitted.iter().zip(transmitted);
        let beyond =
            beyond.flat_map(|(medium, modes)| modes.iter().map(|mode| medium.residual(mode)));
        let solved = here.chain(beyond).all(|residual| residual < RESIDUAL);
        let adds_up = |(shares, together): ([f64; 4], [f64; 2])| {
            let sum = shares.iter().chain(&together).sum::<f64>();
            sum.is_finite() && (self.incident.absorbs() || (sum - 1.0).abs() < RESIDUAL)
        };
        if solved && power.iter().zip(interference).filter_map(|(a, b)| a.zip(*b)).all(adds_up) {
            return Ok(());
        }
        Err(InterfaceError::at(
            "",
            "the waves cannot be computed in double precision; principal values that differ by less, or a shorter \
             tangential wave vector, would do",
        ))
    }
}

/// What a JSON text asks for, in the same form: one interface or an array of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Solved {
    /// One.
    One(Box<InterfaceReport>),
    /// An array.
    Each(Vec<InterfaceReport>),
}

/// What a text of interfaces looks like.
const EXPECTED: &str = "{\"incident\": M, \"transmitted\": M, \"normal\": [x,y,z], \"tangential\": \
                        [x,y,z]} or an array of such, M being {\"permittivity\": T, \"permeability\": T} or, \
                        of \"transmitted\", \"metal\", and T a number, [re,im] or 3 x 3 of either";

/// Solves the interfaces of a JSON text, one object or an array of them.
///
/// # Errors
///
/// If the text is no JSON or asks for something that cannot be, the message names the place; or if
/// there is not enough memory for the answers.
pub fn solve_interfaces(text: &str) -> Result<Solved, InterfaceError> {
    let solve = |place: String, item: &serde_json::Value| {
        let solved = InterfaceRequest::read(item, &place)?.solve();
        solved.map_err(|error| InterfaceError { place, ..error })
    };
    let no_json =
        |error: serde_json::Error| InterfaceError::at("", format!("{error}; expected {EXPECTED}"));
    if !text.trim_start().starts_with('[') {
        let item = serde_json::from_str(text).map_err(no_json)?;
        return Ok(Solved::One(solve(String::new(), &item)?.into()));
    }
    let (mut reports, mut refused) = (Vec::new(), None);
    let read = json::read_list(text, |number, item| {
        let solved = solve(format!("[{number}]"), &item).and_then(|report| {
            let too_many = |shortage| {
                InterfaceError::at(
                    "",
                    format!("so many interfaces: it {shortage}; give them in parts"),
                )
            };
            memory::make_room(&mut reports, InterfaceReport::BYTES).map_err(too_many)?;
            reports.push(report);
            Ok(())
        });
        solved.map_err(|error| refused.insert(error).to_string())
    });
    match (refused, read) {
        (Some(error), _) => Err(error),
        (None, Err(error)) => Err(no_json(error)),
        (None, Ok(())) => Ok(Solved::Each(reports)),
    }
}
