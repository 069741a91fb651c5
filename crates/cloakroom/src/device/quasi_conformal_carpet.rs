//! The quasi-conformal carpet cloak (Li & Pendry, Phys. Rev. Lett. 101, 203901 (2008); Ergin et al.,
//! Science 328, 337 (2010)).
//!
//! The map is solved for here, [`QuasiConformalMap`]. It does not quite keep the shape of the box, and that
//! small anisotropy is neglected: an index of c/|f'| is left.

use super::{Entry, Fact, Request, Structure, carpet};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use optics::transformation::{ConformalMap, QuasiConformalMap, QuasiConformalMapError, Truncation};

pub(super) static ENTRY: Entry = Entry {
    kind: "quasi-conformal-carpet",
    title: "Quasi-conformal carpet cloak",
    summary: "Hides a bump of a mirror floor, h cos^2(pi x/w), below a locally isotropic graded index, from the \
              quasi-conformal map of a box. Li & Pendry 2008, Ergin et al. 2010.",
    keys: &[
        Key {
            name: "h",
            doc: "Height of the metal bump.",
            kind: KeyKind::Number { default: Some(4.25), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "w",
            doc: "Whole width of the bump; at most that of the device.",
            kind: KeyKind::Number { default: Some(28.0), unit: "cm", limits: Limits::LENGTH },
        },
        carpet::width_key(50.0),
        carpet::HEIGHT_KEY,
        carpet::FLOOR_KEY,
    ],
    build,
    facts,
};

fn parts(values: &Values) -> Result<(QuasiConformalMap, Truncation), KeyError> {
    let (w, h) = (values.number("w"), values.number("h"));
    let cut = carpet::cut(values, h)?;
    let map = QuasiConformalMap::new(w, h, &cut).map_err(|error| {
        let key = match error {
            QuasiConformalMapError::TooWide { .. } | QuasiConformalMapError::TooNarrow { .. } => {
                "w"
            }
            _ => "h",
        };
        KeyError::at(key, error.to_string())
    })?;
    Ok((map, cut))
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let (map, cut) = parts(values)?;
    let strength = map.strength();
    Ok(carpet::structure(map.into(), cut, strength, values, request))
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((quasi_conformal, cut)) = parts(values) else { return Vec::new() };
    let c = quasi_conformal.strength();
    let anisotropy = quasi_conformal.anisotropy();
    let map = ConformalMap::from(quasi_conformal);
    let (least, largest) = map.index_range(&cut);
    vec![
        Fact::number("index_min", c * least),
        Fact::number("index_max", c * largest),
        Fact::number("neglected_anisotropy", anisotropy),
        Fact::number("cloaked_area_cm2", map.area_within(&cut)),
        Fact::number("mirror_width_cm", 2.0 * cut.x_max),
    ]
}
