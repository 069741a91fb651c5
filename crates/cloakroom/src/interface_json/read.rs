//! Reading interfaces from JSON, with errors that name the place.

use crate::keys::unknown;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::medium::{Medium, Tensor};
use optics::wave::unit;
use serde_json::Value;

/// How large the normal part of a tangential wave vector may be.
const TANGENTIAL: f64 = 1e-9;

/// How long a tangential wave vector may be: as long as in a medium of the largest index of
/// refraction.
const LONGEST: f64 = 1e6;

/// An interface to be solved.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceRequest {
    /// The medium the light comes from.
    pub incident: Medium,
    /// The medium beyond; `None` for metal, a perfect conductor.
    pub transmitted: Option<Medium>,
    /// The unit normal, from the incident into the transmitted medium.
    pub normal: DVec3,
    /// The tangential part of the wave vectors.
    pub tangential: DVec3,
}

/// Why an interface cannot be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{problem}", if place.is_empty() { String::new() } else { format!("{place}: ") })]
pub struct InterfaceError {
    /// Where in the input, such as `[2].incident.permittivity[0][1]`; empty for all of it.
    pub place: String,
    /// What is wrong there.
    pub problem: String,
}

impl InterfaceError {
    pub(super) fn at(place: &str, problem: impl Into<String>) -> Self {
        Self { place: place.trim_start_matches('.').to_owned(), problem: problem.into() }
    }
}

impl InterfaceRequest {
    /// Reads one interface; `place` is where the value stands in the input, empty for all of it.
    ///
    /// # Errors
    ///
    /// If something is missing, unknown, of the wrong kind, or unphysical.
    pub fn read(value: &Value, place: &str) -> Result<Self, InterfaceError> {
        let keys = ["incident", "transmitted", "normal", "tangential"];
        let [incident, transmitted, normal, tangential] = fields(value, place, keys)?;
        let within = |key: &str| format!("{place}.{key}");
        let incident = medium(incident, &within("incident"))?;
        let transmitted = match transmitted {
            Value::String(word) if word == "metal" => None,
            Value::String(word) => {
                let problem = format!("\"{word}\" is neither \"metal\" nor an object");
                return Err(InterfaceError::at(&within("transmitted"), problem));
            }
            value => Some(medium(value, &within("transmitted"))?),
        };
        let normal = vector(normal, &within("normal"))?;
        let tangential = vector(tangential, &within("tangential"))?;
        Self::new(incident, transmitted, normal, tangential)
            .map_err(|fault| InterfaceError::at(&within(&fault.place), fault.problem))
    }

    /// The interface between two media, or at metal if `transmitted` is `None`; the normal may be
    /// of any length.
    ///
    /// # Errors
    ///
    /// If the normal is zero, or the tangential vector is not finite, not tangential or too long;
    /// the error's place is `normal` or `tangential`.
    pub fn new(
        incident: Medium,
        transmitted: Option<Medium>,
        normal: DVec3,
        tangential: DVec3,
    ) -> Result<Self, InterfaceError> {
        let normal =
            unit(normal).ok_or_else(|| InterfaceError::at("normal", "the normal is zero"))?;
        if !tangential.is_finite() {
            return Err(InterfaceError::at("tangential", "a component is no finite number"));
        }
        let length = tangential.length();
        if length > LONGEST {
            let problem = format!("the vector is {length:e} long; at most {LONGEST:e} is allowed");
            return Err(InterfaceError::at("tangential", problem));
        }
        let along = tangential.dot(normal);
        if along.abs() > TANGENTIAL {
            let problem = format!(
                "the normal part is {along:e}; at most {TANGENTIAL:e} is allowed in a tangential vector"
            );
            return Err(InterfaceError::at("tangential", problem));
        }
        Ok(Self { incident, transmitted, normal, tangential: tangential - normal * along })
    }
}

/// The values of exactly the given keys of an object.
fn fields<'a, const N: usize>(
    value: &'a Value,
    place: &str,
    keys: [&str; N],
) -> Result<[&'a Value; N], InterfaceError> {
    let Value::Object(object) = value else {
        let problem = format!("expected an object with the keys {}", keys.join(", "));
        return Err(InterfaceError::at(place, problem));
    };
    if let Some(key) = object.keys().find(|key| !keys.contains(&key.as_str())) {
        return Err(InterfaceError::at(place, unknown("key", key, "", &keys)));
    }
    let mut values = [&Value::Null; N];
    for (slot, key) in values.iter_mut().zip(keys) {
        *slot = (object.get(key))
            .ok_or_else(|| InterfaceError::at(place, format!("`{key}` is missing")))?;
    }
    Ok(values)
}

fn medium(value: &Value, place: &str) -> Result<Medium, InterfaceError> {
    let [permittivity, permeability] = fields(value, place, ["permittivity", "permeability"])?;
    let permittivity = tensor(permittivity, &format!("{place}.permittivity"))?;
    let permeability = tensor(permeability, &format!("{place}.permeability"))?;
    Medium::new(permittivity, permeability)
        .map_err(|error| InterfaceError::at(place, error.to_string()))
}

/// A number, a pair [re, im], or 3 x 3 of either.
fn tensor(value: &Value, place: &str) -> Result<Tensor, InterfaceError> {
    if value.as_array().is_none_or(|rows| rows.len() == 2 && rows.iter().all(Value::is_number)) {
        return Ok(entry(value, place)?.into());
    }
    let mut tensor = Tensor { re: DMat3::ZERO, im: DMat3::ZERO };
    for (i, row) in three(value, place, "a number, [re, im] or a 3 x 3 array")?.iter().enumerate() {
        let place = format!("{place}[{i}]");
        for (j, value) in three(row, &place, "a row of three entries")?.iter().enumerate() {
            let value = entry(value, &format!("{place}[{j}]"))?;
            tensor.re.col_mut(j)[i] = value.re;
            tensor.im.col_mut(j)[i] = value.im;
        }
    }
    Ok(tensor)
}

fn entry(value: &Value, place: &str) -> Result<Complex64, InterfaceError> {
    let part = |value: &Value, i: usize| number(value, &format!("{place}[{i}]"));
    match value.as_array().map(Vec::as_slice) {
        None => Ok(number(value, place)?.into()),
        Some([re, im]) => Ok(Complex64::new(part(re, 0)?, part(im, 1)?)),
        Some(_) => Err(InterfaceError::at(place, "expected a number or [re, im]")),
    }
}

fn vector(value: &Value, place: &str) -> Result<DVec3, InterfaceError> {
    let mut vector = DVec3::ZERO;
    for (i, value) in three(value, place, "[x, y, z]")?.iter().enumerate() {
        vector[i] = number(value, &format!("{place}[{i}]"))?;
    }
    Ok(vector)
}

/// The three entries of an array.
fn three<'a>(value: &'a Value, place: &str, expected: &str) -> Result<&'a [Value], InterfaceError> {
    match value {
        Value::Array(values) if values.len() == 3 => Ok(values),
        Value::Array(values) => {
            let problem = format!("expected {expected}, found {} entries", values.len());
            Err(InterfaceError::at(place, problem))
        }
        _ => Err(InterfaceError::at(place, format!("expected {expected}"))),
    }
}

fn number(value: &Value, place: &str) -> Result<f64, InterfaceError> {
    match value.as_f64() {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(InterfaceError::at(place, format!("expected a finite number, found {value}"))),
    }
}
