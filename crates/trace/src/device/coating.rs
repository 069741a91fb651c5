//! Thin layers on the surfaces of devices, and what metal is made of.

use super::medium_words::of_index;
use super::{Coating, Convex, FarSide, MaterialWord, MediumWords, Region, RegionBorder, Structure};
use crate::key;
use crate::keys::{Field, KeyError, KeyKind, Value, ValueRange, VisitFile};
use glam::DVec3;
use num_complex::Complex64;
use optics::interface::FilmLayer;
use optics::medium::{Medium, Tensor};

/// More layers than this are no coating.
const MOST_LAYERS: usize = 100;

const CM_PER_NM: f64 = 1e-7;

crate::table! {
    /// A thin layer on a surface.
    pub struct CoatingLayer with words: MediumWords {
        /// Its thickness.
        thickness_nm: Option<f64>, "nm", in ValueRange::Within(0.0, 1e6),
        /// Its relative permittivity, instead of words for its medium, in the device's frame also where the surface is tilted or
        /// curved; symmetric.
        permittivity: Option<Tensor>,
    }
}

impl CoatingLayer {
    fn layer(&self, wavelength_nm: f64) -> Result<FilmLayer, KeyError> {
        let missing = || KeyError::general("this layer has no `thickness_nm`");
        let thickness = CM_PER_NM * self.thickness_nm.ok_or_else(missing)?;
        let key = key!(Self.permittivity);
        let tensors = self.permittivity.map(|_| key);
        let medium = match self.words.medium(tensors.as_slice(), wavelength_nm)? {
            Some(found) => found.medium,
            None => {
                let missing = || {
                    KeyError::general(
                        "this layer has no medium: give it an `index`, a `material` or a `permittivity`",
                    )
                };
                let permittivity = self.permittivity.ok_or_else(missing)?;
                Medium::new(permittivity, 1.0)
                    .map_err(|error| KeyError::at(key, error.to_string()))?
            }
        };
        Ok(FilmLayer { medium, thickness })
    }
}

/// The layers of a key, from the outside inwards, at a wavelength in vacuum, nm.
///
/// # Errors
///
/// If there are too many, or one is not sound.
pub fn layers(
    key: &'static str,
    coating: &[CoatingLayer],
    wavelength_nm: f64,
) -> Result<Vec<FilmLayer>, KeyError> {
    let count = coating.len();
    let message = format!("{key} has {count} layers; it may have {MOST_LAYERS}");
    KeyError::refuse_if(count > MOST_LAYERS, key, message)?;
    let layer = |(number, layer): (usize, &CoatingLayer)| {
        layer.layer(wavelength_nm).map_err(|error| error.within(key, number))
    };
    coating.iter().enumerate().map(layer).collect()
}

/// The same layers, met from the other side.
pub(super) fn reversed(layers: &[FilmLayer]) -> Vec<FilmLayer> {
    layers.iter().rev().copied().collect()
}

/// Whether something is of metal, and of which.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Metal {
    /// It is of no metal.
    #[default]
    None,
    /// A perfect conductor.
    Perfect,
    /// A metal of a complex index of refraction n + ik, which keeps what it does not reflect.
    OfIndex(Box<MetalOfIndex>),
}

crate::table! {
    /// A metal that is no perfect conductor.
    pub struct MetalOfIndex {
        /// Its complex index of refraction, [n, k].
        index: Option<Complex64>,
        /// What it is of instead, such as "silver": see `cloakroom materials`.
        material: Option<MaterialWord>,
    }
}

impl Metal {
    /// The medium of a metal at a wavelength in vacuum (nm); `None` for a perfect conductor.
    ///
    /// # Errors
    ///
    /// If its index is missing or that of no medium.
    pub fn medium(&self, wavelength_nm: f64) -> Result<Option<Medium>, KeyError> {
        let Self::OfIndex(metal) = self else { return Ok(None) };
        let message = "this metal has neither `index` nor `material`; give it one, as index = [n, k] or \
                       material = \"silver\", or write metal = true for a perfect conductor";
        match (metal.index, &metal.material) {
            (Some(index), None) => of_index("metal.index", index).map(Some),
            (None, Some(material)) => material.metal("metal.material", wavelength_nm).map(Some),
            (None, None) => Err(KeyError::at("metal", message)),
            (Some(_), Some(_)) => {
                let message = "index and material are both given; a metal takes one of them";
                Err(KeyError::at("metal.material", message))
            }
        }
    }
}

impl Field for Metal {
    const KIND: KeyKind = KeyKind::FlagOrTable { keys: MetalOfIndex::KEYS };

    fn from_value(value: &Value) -> Option<Self> {
        match value.as_flag() {
            Some(true) => Some(Self::Perfect),
            Some(false) => Some(Self::None),
            None => MetalOfIndex::from_value(value).map(Box::new).map(Self::OfIndex),
        }
    }

    fn value(&self) -> Option<Value> {
        match self {
            Self::None => Some(false.into()),
            Self::Perfect => Some(true.into()),
            Self::OfIndex(metal) => metal.value(),
        }
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Self::OfIndex(metal) = self {
            metal.show_files(path, visit);
        }
    }
}

impl Structure {
    /// The same structure with layers, given from the outside inwards, on every surface of it that
    /// faces the outside and has no layers of its own. On the sheets of thin mirrors they are on
    /// both sides.
    ///
    /// # Errors
    ///
    /// If it is opaque or a polarizer, or has a perfect coating already; the key's name is for the
    /// message.
    pub fn coated(mut self, key: &'static str, layers: Vec<FilmLayer>) -> Result<Self, KeyError> {
        if layers.is_empty() {
            return Ok(self);
        }
        let far = |far: FarSide| self.surfaces.iter().any(|surface| surface.far == far);
        let refuse = |refused, message| KeyError::refuse_if(refused, key, message);
        refuse(far(FarSide::Opaque), "an opaque body shows its `surface`, and takes no coating")?;
        refuse(far(FarSide::Polarizer), "a polarizer takes no coating")?;
        let perfect = self.surfaces.iter().any(|s| s.coating == Coating::Antireflection);
        refuse(perfect, "fresnel = false is a perfect coating already; leave one of them out")?;
        let outward = self.add_film(reversed(&layers));
        let inward = self.add_film(layers);
        for surface in &mut self.surfaces {
            if surface.coating == Coating::None {
                surface.coating = inward;
            }
        }
        for region in &mut self.regions {
            let coating = match region {
                Region::Homogeneous(region) => match &mut region.border {
                    RegionBorder::Faces(faces) => {
                        for face in faces {
                            if face.far == FarSide::Outside && face.coating == Coating::None {
                                face.coating = outward;
                            }
                        }
                        continue;
                    }
                    RegionBorder::Convex(_)
                    | RegionBorder::Lens(_)
                    | RegionBorder::Polyhedron(_) => &mut region.coating,
                },
                Region::Conformal(region) => &mut region.coating,
                Region::Radial(region) => &mut region.coating,
                Region::ClosedForm(region) => &mut region.coating,
                Region::Spatial(region) => &mut region.coating,
            };
            *coating = outward;
        }
        Ok(self)
    }

    /// Keeps layers, in the order in which light meets them that comes to a surface.
    pub(super) fn add_film(&mut self, layers: Vec<FilmLayer>) -> Coating {
        // Fewer than surfaces, which are numbered in 16 bits.
        let number = self.films.len() as u16;
        self.films.push(layers);
        Coating::Film(number)
    }

    /// The same structure with its perfect conductors of another metal; whether there were any.
    #[must_use]
    pub fn of_metal(mut self, metal: Medium) -> (Self, bool) {
        let (mut found, number) = (false, self.metals.len() as u16);
        self.metals.push(metal);
        let mut change = |far: &mut FarSide| {
            if *far == FarSide::Conductor {
                (found, *far) = (true, FarSide::Metal(number));
            }
        };
        self.surfaces.iter_mut().for_each(|surface| change(&mut surface.far));
        for region in &mut self.regions {
            match region {
                Region::Homogeneous(region) => {
                    if let RegionBorder::Faces(faces) = &mut region.border {
                        faces.iter_mut().for_each(|face| change(&mut face.far));
                    }
                }
                Region::Conformal(region) => {
                    change(&mut region.floor);
                    if region.flow.radii()[0].is_some() {
                        change(&mut region.core);
                    }
                }
                // A whole ball has no core that light could come to.
                Region::Radial(region) if region.flow.radii()[0] > 0.0 => change(&mut region.inner),
                Region::Spatial(region) => change(&mut region.floor),
                Region::Radial(_) | Region::ClosedForm(_) => {}
            }
        }
        (self, found)
    }
}

impl Convex {
    /// Whether a point lies within `slack` (cm) of the border, where it is not far outside.
    pub(crate) fn borders(&self, point: DVec3, slack: f64) -> bool {
        // Deep inside, the ray's direction does not matter.
        let ahead = |direction| self.holds_ahead(point, direction, slack);
        !DVec3::AXES.iter().all(|axis| ahead(*axis) && ahead(-*axis))
    }
}
