//! The Gaussian carpet cloak: one half of the double-Gaussian cloak on a mirror floor (Schmied, Halimeh &
//! Wegener, Opt. Express 18, 24361 (2010)).
//!
//! A conformal map, [`GaussianMap`], so the index 1/|f'| is exact: the bump looks like flat floor.

use super::{Entry, Fact, Request, Structure, carpet};
use crate::keys::{KeyError, Values};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

pub(super) static ENTRY: Entry = Entry {
    kind: "gaussian-carpet",
    title: "Conformal carpet cloak",
    summary: "Hides a bump of a mirror floor below a locally isotropic graded index, from a conformal map: one \
              half of the double-Gaussian cloak. Schmied, Halimeh & Wegener 2010.",
    keys: &[
        carpet::W_KEY,
        carpet::h_key("Height of the metal bump; below 0.886 w."),
        carpet::width_key(50.0),
        carpet::HEIGHT_KEY,
        carpet::FLOOR_KEY,
    ],
    build,
    facts,
};

fn parts(values: &Values) -> Result<(GaussianMap, Truncation), KeyError> {
    let map = carpet::gaussian_map(values)?;
    Ok((map, carpet::cut(values, map.height())?))
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let (map, cut) = parts(values)?;
    Ok(carpet::structure(map.into(), cut, 1.0, values, request))
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((gaussian, cut)) = parts(values) else { return Vec::new() };
    let map = ConformalMap::from(gaussian);
    let (least, largest) = map.index_range(&cut);
    vec![
        Fact::number("index_min", least),
        Fact::number("index_max", largest),
        Fact::number("cloaked_area_cm2", gaussian.area()),
        Fact::number("cloaked_area_within_cut_cm2", map.area_within(&cut)),
        Fact::number("mirror_width_cm", 2.0 * cut.x_max),
    ]
}
