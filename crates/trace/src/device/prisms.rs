//! A device of one's own: prisms of any cross-section, each of a homogeneous medium or of metal.
//!
//! Prisms that share a side, whole or in part, meet there without a gap.

use super::floor::Floor;
use super::polygons::{PolygonPart, polygonal};
use super::{CoatingLayer, Device, Fact, MediumWords, Metal, Request, Show, Structure, coating};
use crate::key;
use crate::keys::{Given, KeyError, ValueRange};
use glam::DVec2;
use optics::geometry::{Extent, Polygon, PolygonError, SAME_POINT};
use optics::medium::Tensor;

crate::table! {
    /// A device of one's own: prisms of any cross-section and of any homogeneous media,
    /// anisotropic, magnetic, negative or absorbing, or of metal.
    pub struct Prisms {
        /// The prisms, each a table [[device.prism]]; those that share a side, whole or in part,
        /// meet there without a gap.
        prism: Vec<PrismOfMedium>,
        /// What it should look like, if not as nothing: prisms again, each a table
        /// [[device.imitated]], shown with show = "mirror". A mirror, or glass on a mirror.
        imitated: Vec<PrismOfMedium>,
        /// Whole width along x of a flat mirror floor on y = 0 that the prisms stand on; 0 for none.
        /// Without [[device.imitated]] it alone is what the device should look like. It may stand
        /// without prisms, too. It is perfect, or of the device's `metal`.
        floor: f64, "cm", in ValueRange::LENGTH_OR_ZERO,
    }
}

crate::table! {
    /// One of the prisms of [`Prisms`].
    pub struct PrismOfMedium with words: MediumWords {
        /// The corners of its cross-section in the xy-plane, one after the other; it may be
        /// concave.
        corners: Option<Vec<[f64; 2]>>, "cm", in ValueRange::COORDINATE,
        /// Relative permittivity, in the device's frame; symmetric.
        permittivity: Given<Tensor> = Given::by_default(1.0.into()),
        /// Relative permeability, in the device's frame; symmetric.
        permeability: Given<Tensor> = Given::by_default(1.0.into()),
        /// Whether it is metal: true for a perfect conductor, { index = [n, k] } for another.
        metal: Metal,
        /// Thin layers on all of its surfaces, from the outside inwards; instead of the device's,
        /// where it has any.
        coating: Vec<CoatingLayer>,
    }
}

/// More corners than this, all prisms together, are no device.
const MOST_CORNERS: usize = 4096;

impl Device for Prisms {
    const KIND: &'static str = "prisms";
    const TITLE: &'static str = "Prisms of one's own";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        if self.prism.is_empty() && self.floor == 0.0 {
            let message = "there is no prism; give each one a table [[device.prism]] with `corners` and \
                           `permittivity` or `metal = true`, or give a `floor`, which may stand alone";
            return Err(KeyError::general(message));
        }
        let floor = self.floor;
        let device = List { key: key!(Self.prism), prisms: &self.prism, floor };
        let imitated = List { key: key!(Self.imitated), prisms: &self.imitated, floor };
        let nm = request.wavelength_nm;
        let mut parts = device.parts(nm)?;
        // What cannot be shown is refused with the device, too.
        let imitated_parts = imitated.parts(nm)?;
        let of_imitated = imitated.structure(&imitated_parts, request)?;
        match request.show {
            Show::Cloak => {}
            Show::Bare => {
                parts.retain(|part| part.medium.is_none());
                let message = "no prism is metal, so nothing of it is bare";
                KeyError::refuse_if(parts.is_empty() && floor == 0.0, key!(Request.show), message)?;
            }
            Show::Mirror if self.imitated.is_empty() && floor == 0.0 => {
                let reason = "prisms imitate no mirror without [[device.imitated]] or a floor";
                super::refuse_other_views(request, reason)?;
            }
            Show::Mirror => return Ok(of_imitated),
            Show::Empty => return Ok(Structure::empty()),
        }
        device.structure(&parts, request)
    }

    fn facts(&self, request: Request) -> Vec<Fact> {
        let device = List { key: key!(Self.prism), prisms: &self.prism, floor: self.floor };
        let parts = device.parts(request.wavelength_nm).unwrap_or_default();
        let area = |metal: bool| {
            let chosen = parts.iter().filter(|part| part.medium.is_none() == metal);
            chosen.map(|part| part.polygon.area()).sum::<f64>()
        };
        vec![
            Fact::number("prism_count", parts.len() as f64),
            Fact::number("medium_area_cm2", area(false)),
            Fact::number("metal_area_cm2", area(true)),
        ]
    }
}

/// Prisms of a list of tables.
struct List<'p> {
    /// The key of the list.
    key: &'static str,
    prisms: &'p [PrismOfMedium],
    /// The width of the floor that they stand on, cm; 0 for none.
    floor: f64,
}

impl List<'_> {
    /// The prisms, each sound in itself.
    fn parts(&self, wavelength_nm: f64) -> Result<Vec<PolygonPart>, KeyError> {
        let mut known: Vec<DVec2> = Vec::new();
        let prisms = self.prisms.iter().enumerate().map(|(number, prism)| {
            part(prism, &mut known, wavelength_nm).map_err(|error| error.within(self.key, number))
        });
        prisms.collect()
    }

    /// What some of its parts are together.
    fn structure(&self, parts: &[PolygonPart], request: Request) -> Result<Structure, KeyError> {
        let (extent, rounding) = (Extent::centred(request.length), self.rounding());
        let at = |message: String, number: usize| {
            KeyError::at(key!(PrismOfMedium.corners), message).within(self.key, number)
        };
        let floor = Floor { width: self.floor, level: 0.0, extent };
        let lowest = |part: &PolygonPart| {
            part.polygon.corners().iter().fold(f64::INFINITY, |low, at| low.min(at.y))
        };
        let below = parts.iter().map(lowest).position(|low| floor.is_there() && low < -rounding);
        if let Some(number) = below {
            let message = format!(
                "prism {number} (counted from 0) reaches to y = {} cm, below the floor on y = 0; move or cut \
                 it",
                lowest(&parts[number])
            );
            return Err(at(message, number));
        }
        let standing = polygonal(parts, extent, rounding).map_err(|[first, second]| {
            let message =
                format!("prism {second} overlaps prism {first} (counted from 0); cut one of them");
            at(message, second)
        })?;
        floor.under(standing, rounding)
    }

    /// How far sides that are meant to lie along each other may be apart, cm, where corners are
    /// rounded to the decimals with which they are written: each of two sides by half a step along x
    /// and along y. It is less than any side by far.
    fn rounding(&self) -> f64 {
        let polygons = || self.prisms.iter().filter_map(|prism| prism.corners.as_ref());
        let numbers = polygons().flatten().flatten();
        let decimals =
            |number: &f64| number.to_string().split_once('.').map_or(0, |(_, d)| d.len());
        let step = numbers.map(decimals).max().map_or(1.0, |most| 10f64.powi(-(most as i32)));
        let sides = polygons().flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(a, b)| DVec2::from(*a).distance(DVec2::from(*b)))
        });
        let shortest = sides.fold(f64::INFINITY, f64::min);
        (1.5 * step).min(LARGEST_ROUNDING).min(0.1 * shortest).max(SAME_POINT)
    }
}

/// Corners are written with four decimals at least where it matters.
const LARGEST_ROUNDING: f64 = 1.5e-4;

/// One prism; its corners are moved onto those of earlier ones, `known`, that are the same but for
/// rounding.
fn part(
    prism: &PrismOfMedium,
    known: &mut Vec<DVec2>,
    wavelength_nm: f64,
) -> Result<PolygonPart, KeyError> {
    let missing = || KeyError::general("this prism has no `corners`: three or more [x, y]");
    let corners = prism.corners.as_ref().ok_or_else(missing)?;
    let refused = known.len() + corners.len() > MOST_CORNERS;
    let message = format!("all prisms together have more than {MOST_CORNERS} corners");
    KeyError::refuse_if(refused, key!(PrismOfMedium.corners), message)?;
    let corners: Vec<DVec2> = corners
        .iter()
        .map(|corner| {
            let corner = DVec2::from(*corner);
            let same = known.iter().copied().find(|other| other.distance(corner) <= SAME_POINT);
            same.unwrap_or_else(|| {
                known.push(corner);
                corner
            })
        })
        .collect();
    let polygon = Polygon::new(&corners).map_err(|error: PolygonError| {
        KeyError::at(key!(PrismOfMedium.corners), error.to_string())
    })?;
    let given = [
        (prism.permittivity.given, key!(PrismOfMedium.permittivity)),
        (prism.permeability.given, key!(PrismOfMedium.permeability)),
    ];
    let given = given.into_iter().filter_map(|(given, key)| given.then_some(key));
    let medium = match given.chain(prism.words.word()).next() {
        Some(key) if prism.metal != Metal::None => {
            let message = match prism.metal {
                Metal::OfIndex(_) => format!("metal has its `index`, and takes no {key}"),
                _ => format!("metal is a perfect conductor; it has no {key}"),
            };
            return Err(KeyError::at(key, message));
        }
        _ if prism.metal != Metal::None => None,
        None => {
            let message = "this prism has no medium: give it an `index`, a `material`, a `permittivity` or \
                           `metal = true`; a prism of air is left out";
            return Err(KeyError::general(message));
        }
        Some(_) => {
            let tensors = [
                (key!(PrismOfMedium.permittivity), prism.permittivity),
                (key!(PrismOfMedium.permeability), prism.permeability),
            ];
            Some(super::medium(&prism.words, tensors, wavelength_nm)?)
        }
    };
    let metal = prism.metal.medium(wavelength_nm)?;
    let film = coating::layers(key!(PrismOfMedium.coating), &prism.coating, wavelength_nm)?;
    Ok(PolygonPart { polygon, medium, metal, film })
}
