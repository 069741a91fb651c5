//! The words by which scenes say what a medium is.

use crate::key;
use crate::keys::{
    Direction, Field, KeyError, KeyKind, MaterialName, Value, ValueRange, VisitFile,
};
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::material::{Dispersion, IndexLaw, Material, Refraction};
use optics::medium::{Medium, Tensor};
use std::borrow::Cow;
use std::sync::Arc;

const UM_PER_NM: f64 = 1e-3;

/// What wavelengths a law of one's own may be asked for, µm.
const EVERYWHERE_UM: [f64; 2] = [1e-6, 1e9];

crate::table! {
    /// What a medium is that is not magnetic.
    pub struct MediumWords {
        /// Index of refraction n, or [n, k] where it absorbs: the permittivity is its square.
        index: Option<Complex64>,
        /// A crystal with an optic axis: { ordinary = n, extraordinary = n, optic_axis = [x, y, z] }.
        uniaxial: Option<UniaxialWords>,
        /// A crystal with two optic axes: { indices = [n1, n2, n3] }, along its principal `axes`.
        biaxial: Option<BiaxialWords>,
        /// A material by its name (`cloakroom materials`), that of a file of the refractiveindex.info
        /// database (`.yml`), or a law of one's own, such as { cauchy = [1.5, 0.004, 0] }.
        material: Option<MaterialWord>,
        /// The optic axis of such a material in the device's frame: [x, y, z], or an angle in its x,
        /// y plane, counted from x; along z by default.
        optic_axis: Option<Direction>, "degrees", in ValueRange::ANGLE,
    }
}

crate::table! {
    /// A crystal with one optic axis.
    pub struct UniaxialWords {
        /// Index n of the ordinary wave, or [n, k].
        ordinary: Option<Complex64>,
        /// Index n, or [n, k], of the extraordinary wave with its field along the optic axis.
        extraordinary: Option<Complex64>,
        /// The optic axis in the device's frame: [x, y, z], or an angle in its x, y plane.
        optic_axis: Direction = Direction::Along(DVec3::Z), "degrees", in ValueRange::ANGLE,
    }
}

crate::table! {
    /// A crystal with two optic axes.
    pub struct BiaxialWords {
        /// The principal indices, of waves with their fields along the first, second and third
        /// axis.
        indices: Option<[f64; 3]>, in ValueRange::Within(1e-6, 1e6),
        /// The principal axes in the device's frame: x, y and z by default.
        axes: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z],
    }
}

crate::table! {
    /// A material of one's own: how its index depends on the wavelength.
    pub struct MaterialLaw {
        /// The material of the ordinary wave of a crystal, by its name or its file.
        ordinary: Option<MaterialName>,
        /// The material of the extraordinary wave.
        extraordinary: Option<MaterialName>,
        /// Sellmeier's law: terms { strength = B, pole_um2 = C } of n² = 1 + Σ B λ²/(λ² - C).
        sellmeier: Vec<SellmeierTerm>,
        /// Cauchy's law: [A, B, C] of n = A + B/λ² + C/λ⁴, λ in µm.
        cauchy: Option<[f64; 3]>,
        /// Drude's law, with the energy E in eV: { plasma_ev = Ep, damping_ev = Γ } of ε = ε∞ -
        /// Ep²/(E² + iΓE).
        drude: Option<DrudeTerm>,
        /// Lorentz's law: terms { strength = s, resonance_ev = E0, damping_ev = Γ } of ε = ε∞ + Σ s
        /// E0²/(E0² - E² - iΓE); also together with Drude's.
        lorentz: Vec<LorentzTerm>,
        /// ε∞ of these.
        permittivity_infinity: Option<f64>, in ValueRange::Within(1.0, 1e6),
    }
}

crate::table! {
    /// A term of Sellmeier's law.
    pub struct SellmeierTerm {
        /// Its strength B.
        strength: Option<f64>,
        /// Its pole C, the square of a wavelength in µm.
        pole_um2: Option<f64>, "µm²",
    }
}

crate::table! {
    /// Free charges: Drude's law.
    pub struct DrudeTerm {
        /// The energy of their plasma.
        plasma_ev: Option<f64>, "eV", in ValueRange::Within(0.0, 1e6),
        /// The width by which their motion is damped.
        damping_ev: f64, "eV", in ValueRange::Within(0.0, 1e6),
    }
}

crate::table! {
    /// Bound charges: a term of Lorentz's law.
    pub struct LorentzTerm {
        /// Its strength s.
        strength: Option<f64>, in ValueRange::Within(0.0, 1e6),
        /// The energy of its resonance.
        resonance_ev: Option<f64>, "eV", in ValueRange::Within(0.0, 1e6),
        /// Its width.
        damping_ev: f64, "eV", in ValueRange::Within(0.0, 1e6),
    }
}

/// A material by its name, or a law of one's own.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialWord {
    /// By its name.
    Named(MaterialName),
    /// By its law.
    Law(MaterialLaw),
}

impl Field for MaterialWord {
    const KIND: KeyKind = KeyKind::MaterialOrTable { keys: MaterialLaw::KEYS };

    fn from_value(value: &Value) -> Option<Self> {
        match value.as_text() {
            Some(_) => MaterialName::from_value(value).map(Self::Named),
            None => MaterialLaw::from_value(value).map(Self::Law),
        }
    }

    fn value(&self) -> Option<Value> {
        match self {
            Self::Named(name) => name.value(),
            Self::Law(law) => law.value(),
        }
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        match self {
            Self::Named(name) => name.show_files(path, visit),
            Self::Law(law) => law.show_files(path, visit),
        }
    }
}

/// A medium at one wavelength, and how it depends on that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersiveMedium {
    /// The medium.
    pub medium: Medium,
    /// How it depends on the frequency; `None` where that is not said.
    pub law: Option<DispersiveTensors>,
}

/// d(ωε)/dω and d(ωµ)/dω of a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersiveTensors {
    /// d(ωε)/dω.
    pub permittivity: Tensor,
    /// d(ωµ)/dω.
    pub permeability: Tensor,
}

impl From<Medium> for DispersiveMedium {
    fn from(medium: Medium) -> Self {
        Self { medium, law: None }
    }
}

impl MediumWords {
    /// The words that are given, but for `optic_axis`.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        let all = [
            (key!(Self.index), self.index.is_some()),
            (key!(Self.uniaxial), self.uniaxial.is_some()),
            (key!(Self.biaxial), self.biaxial.is_some()),
            (key!(Self.material), self.material.is_some()),
        ];
        all.into_iter().filter_map(|(key, given)| given.then_some(key))
    }

    /// The first word that is given.
    #[must_use]
    pub fn word(&self) -> Option<&'static str> {
        self.given().next().or(self.optic_axis.map(|_| key!(Self.optic_axis)))
    }

    /// What they say at a wavelength in vacuum (nm); `None` if they say nothing. `tensors` are the
    /// keys of tensors that are given beside them.
    ///
    /// # Errors
    ///
    /// If they contradict one another or the tensors, or there is no such medium.
    pub fn medium(
        &self,
        tensors: &[&'static str],
        wavelength_nm: f64,
    ) -> Result<Option<DispersiveMedium>, KeyError> {
        let mut given = self.given();
        let Some(word) = given.next() else {
            let message = "optic_axis is that of a material, which is not given; write material = \"calcite\", \
                           or uniaxial = { ordinary = 1.66, extraordinary = 1.49, optic_axis = [0, 0, 1] }";
            let alone = self.optic_axis.is_some();
            return KeyError::refuse_if(alone, key!(Self.optic_axis), message).map(|()| None);
        };
        if let Some(other) = given.next() {
            let message = format!("{word} and {other} are both given; a medium takes one of them");
            return Err(KeyError::at(other, message));
        }
        if let Some(tensor) = tensors.first() {
            let message = match word {
                "index" => format!(
                    "index and {tensor} are both given; the permittivity is the square of the index of a \
                     medium that is not magnetic: take one of them"
                ),
                word => format!("{word} and {tensor} are both given; a medium takes one of them"),
            };
            return Err(KeyError::at(word, message));
        }
        let misplaced = self.optic_axis.is_some() && word != key!(Self.material);
        let message = format!("optic_axis goes with a material; {word} takes none beside it");
        KeyError::refuse_if(misplaced, key!(Self.optic_axis), message)?;
        let medium = if let Some(index) = self.index {
            of_index(word, index)?.into()
        } else if let Some(uniaxial) = &self.uniaxial {
            uniaxial.medium()?.into()
        } else if let Some(biaxial) = &self.biaxial {
            biaxial.medium()?.into()
        } else if let Some(material) = &self.material {
            material.medium(self.optic_axis, wavelength_nm)?
        } else {
            return Ok(None);
        };
        Ok(Some(medium))
    }
}

/// The permittivity of a complex index n + ik of a medium that is not magnetic, which the key says.
fn permittivity(key: &'static str, index: Complex64) -> Result<Complex64, KeyError> {
    let Complex64 { re, im } = index;
    let message = if re < 0.0 && im == 0.0 {
        format!(
            "{key} is {re}; a medium that is not magnetic has none below 0: write permittivity and \
             permeability, as -1 and -1 for an index of -1"
        )
    } else {
        format!("{key} is [{re}, {im}]; n and k of n + ik must be 0 or above, and not both 0")
    };
    let refused = re < 0.0 || im < 0.0 || index == Complex64::ZERO;
    KeyError::refuse_if(refused, key, message).map(|()| index * index)
}

/// The medium of a complex index n + ik and of µ = 1, which the key says.
pub(super) fn of_index(key: &'static str, index: Complex64) -> Result<Medium, KeyError> {
    let permittivity = permittivity(key, index)?;
    Medium::new(permittivity, 1.0).map_err(|error| KeyError::at(key, error.to_string()))
}

impl UniaxialWords {
    fn medium(&self) -> Result<Medium, KeyError> {
        let key = key!(MediumWords.uniaxial);
        let index = |name: &'static str, index: Option<Complex64>| {
            let missing =
                || KeyError::at(key, format!("{key} has no `{name}`: its index of refraction"));
            let index = index.ok_or_else(missing)?;
            permittivity(name, index)
                .map_err(|error| KeyError::at(key, format!("in {key}: {error}")))
        };
        let ordinary = index(key!(Self.ordinary), self.ordinary)?;
        let extraordinary = index(key!(Self.extraordinary), self.extraordinary)?;
        uniaxial(key, [ordinary, extraordinary], self.optic_axis.unit())
    }
}

/// A crystal of these permittivities across and along its optic axis.
fn uniaxial(
    key: &'static str,
    [across, along]: [Complex64; 2],
    axis: DVec3,
) -> Result<Medium, KeyError> {
    let medium = if across.im == 0.0 && along.im == 0.0 {
        Medium::uniaxial_electric(1.0, across.re, along.re, axis)
    } else {
        Medium::new(Tensor::uniaxial(across, along, axis), 1.0)
    };
    medium.map_err(|error| KeyError::at(key, error.to_string()))
}

impl BiaxialWords {
    fn medium(&self) -> Result<Medium, KeyError> {
        let key = key!(MediumWords.biaxial);
        let missing = || KeyError::at(key, format!("{key} has no `indices`: three numbers"));
        let squares = DVec3::from_array(self.indices.ok_or_else(missing)?).powf(2.0);
        // Made right to the last digit: the third completes the other two.
        let [first, second, third] = self.axes.map(|axis| Direction::Along(axis).unit());
        let second = second.reject_from_normalized(first).normalize();
        let third = first.cross(second) * first.cross(second).dot(third).signum();
        let frame = DMat3::from_cols(first, second, third);
        let tensor = frame * DMat3::from_diagonal(squares) * frame.transpose();
        let tensor = (tensor + tensor.transpose()) * 0.5;
        Medium::new(tensor, 1.0).map_err(|error| KeyError::at(key, error.to_string()))
    }
}

impl MaterialWord {
    /// The medium at a wavelength in vacuum, nm.
    fn medium(
        &self,
        optic_axis: Option<Direction>,
        wavelength_nm: f64,
    ) -> Result<DispersiveMedium, KeyError> {
        let key = key!(MediumWords.material);
        let material = self.material()?;
        let at = |law: &IndexLaw| {
            law.at(wavelength_nm * UM_PER_NM)
                .map_err(|error| KeyError::at(key, format!("{}: {error}", self.name())))
        };
        let ordinary = at(&material.ordinary)?;
        let extraordinary = material.extraordinary.as_ref().map(at).transpose()?;
        let tensors = |part: fn(&Refraction) -> Complex64| {
            [part(&ordinary), extraordinary.as_ref().map_or(part(&ordinary), part)]
        };
        let epsilons = tensors(Refraction::permittivity);
        let derivatives = tensors(Refraction::dispersive_permittivity);
        let law = |permittivity| DispersiveTensors { permittivity, permeability: 1.0.into() };
        if extraordinary.is_none() {
            let message = format!("{} is isotropic; it has no optic axis", self.name());
            KeyError::refuse_if(optic_axis.is_some(), key!(MediumWords.optic_axis), message)?;
            let medium = Medium::new(epsilons[0], 1.0)
                .map_err(|error| KeyError::at(key, format!("{}: {error}", self.name())))?;
            return Ok(DispersiveMedium { medium, law: Some(law(derivatives[0].into())) });
        }
        let axis = optic_axis.map_or(DVec3::Z, Direction::unit);
        let medium = uniaxial(key, epsilons, axis)?;
        let law = law(Tensor::uniaxial(derivatives[0], derivatives[1], axis));
        Ok(DispersiveMedium { medium, law: Some(law) })
    }

    /// What it is called in messages.
    fn name(&self) -> String {
        match self.value() {
            Some(Value::Text(name)) => name,
            _ => "the material".to_owned(),
        }
    }

    /// The medium of a metal of it at a wavelength in vacuum, nm; the path of its key is given.
    pub(super) fn metal(&self, key: &'static str, wavelength_nm: f64) -> Result<Medium, KeyError> {
        let material = self.medium(None, wavelength_nm);
        material.map(|found| found.medium).map_err(|error| KeyError::at(key, error.message))
    }

    /// The material.
    ///
    /// # Errors
    ///
    /// If its file has not been read, or its law says too little or too much.
    pub fn material(&self) -> Result<Arc<Material>, KeyError> {
        match self {
            Self::Named(name) => named(name),
            Self::Law(law) => law.material().map(Arc::new),
        }
    }
}

fn named(name: &MaterialName) -> Result<Arc<Material>, KeyError> {
    let unread = || {
        let text = name.value().map(|value| value.to_string()).unwrap_or_default();
        KeyError::at(key!(MediumWords.material), format!("the material {text} has not been read"))
    };
    name.material().ok_or_else(unread)
}

impl MaterialLaw {
    fn material(&self) -> Result<Material, KeyError> {
        let refuse = |message: String| KeyError::at(key!(MediumWords.material), message);
        let resonances = self.drude.is_some() || !self.lorentz.is_empty();
        let waves = self.ordinary.is_some() || self.extraordinary.is_some();
        let kinds = [waves, !self.sellmeier.is_empty(), self.cauchy.is_some(), resonances];
        if kinds.iter().filter(|given| **given).count() != 1 {
            return Err(refuse(
                "this material needs one law: ordinary and extraordinary, sellmeier, cauchy, or drude and \
                 lorentz"
                    .to_owned(),
            ));
        }
        let stray = self.permittivity_infinity.is_some() && !resonances;
        let message =
            "permittivity_infinity goes with drude and lorentz; this law has no use for it";
        KeyError::refuse_if(stray, key!(MediumWords.material), message)?;
        if waves {
            return self.crystal();
        }
        let missing = |what: &str, number: usize, key: &str| {
            refuse(format!("term {number} of {what} (counted from 0) has no `{key}`"))
        };
        let dispersion = if let Some([a, b, c]) = self.cauchy {
            Dispersion::Formula { number: 5, coefficients: Cow::Owned(vec![a, b, -2.0, c, -4.0]) }
        } else if resonances {
            let plasma_ev = match &self.drude {
                None => [0.0; 2],
                Some(drude) => {
                    let missing = || refuse("drude has no `plasma_ev`".to_owned());
                    [drude.plasma_ev.ok_or_else(missing)?, drude.damping_ev]
                }
            };
            let term = |(number, term): (usize, &LorentzTerm)| {
                let missing = |key| missing("lorentz", number, key);
                let strength = term.strength.ok_or_else(|| missing("strength"))?;
                let resonance = term.resonance_ev.ok_or_else(|| missing("resonance_ev"))?;
                Ok([strength, resonance, term.damping_ev])
            };
            let lorentz = self.lorentz.iter().enumerate().map(term).collect::<Result<_, _>>()?;
            let permittivity_infinity = self.permittivity_infinity.unwrap_or(1.0);
            Dispersion::Resonances { permittivity_infinity, plasma_ev, lorentz }
        } else {
            let term = |(number, term): (usize, &SellmeierTerm)| {
                let missing = |key| missing("sellmeier", number, key);
                let strength = term.strength.ok_or_else(|| missing("strength"))?;
                Ok([strength, term.pole_um2.ok_or_else(|| missing("pole_um2"))?])
            };
            let terms: Vec<[f64; 2]> =
                self.sellmeier.iter().enumerate().map(term).collect::<Result<_, _>>()?;
            let coefficients = [0.0].into_iter().chain(terms.into_iter().flatten()).collect();
            Dispersion::Formula { number: 2, coefficients: Cow::Owned(coefficients) }
        };
        let law = IndexLaw { dispersion, extinction: None, range_um: EVERYWHERE_UM };
        Ok(Material {
            title: "A material of one's own".to_owned(),
            source: "the scene".to_owned(),
            ordinary: law,
            extraordinary: None,
        })
    }

    /// A crystal of the materials of its two waves.
    fn crystal(&self) -> Result<Material, KeyError> {
        let key = key!(MediumWords.material);
        let of = |name: &Option<MaterialName>, word: &str| {
            let missing = || KeyError::at(key, format!("this crystal has no `{word}` material"));
            let material = named(name.as_ref().ok_or_else(missing)?)?;
            let message = format!("the {word} material is a crystal itself; take one of its waves");
            KeyError::refuse_if(material.extraordinary.is_some(), key, message)?;
            Ok::<_, KeyError>(material)
        };
        let ordinary = of(&self.ordinary, "ordinary")?;
        let extraordinary = of(&self.extraordinary, "extraordinary")?;
        Ok(Material {
            title: format!("{} and {}", ordinary.title, extraordinary.title),
            source: format!("{}; {}", ordinary.source, extraordinary.source),
            ordinary: ordinary.ordinary.clone(),
            extraordinary: Some(extraordinary.ordinary.clone()),
        })
    }
}
