//! The grating carpet cloak: a periodically corrugated mirror floor that looks flat (Schmied, Halimeh &
//! Wegener, Opt. Express 18, 24361 (2010)).
//!
//! A conformal map, [`GratingMap`], so the index 1/|f'| is exact. The metal swings between y = -h and h about
//! the floor's level y = 0, and below that level the device ends at metal.

use super::{Entry, Fact, Request, Structure, carpet};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use optics::transformation::{ConformalMap, GratingMap, Truncation};

pub(super) static ENTRY: Entry = Entry {
    kind: "grating-carpet",
    title: "Periodic grating cloak",
    summary: "Makes a corrugated mirror look flat by a locally isotropic graded index, from a conformal map. \
              Schmied, Halimeh & Wegener 2010.",
    keys: &[
        Key {
            name: "h",
            doc: "How far the metal swings above and below the floor's level; below period/(2 pi).",
            kind: KeyKind::Number { default: Some(1.5), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "period",
            doc: "Period of the grating along x; at most the width.",
            kind: KeyKind::Number { default: Some(20.0), unit: "cm", limits: Limits::LENGTH },
        },
        carpet::width_key(60.0),
        carpet::HEIGHT_KEY,
        carpet::FLOOR_KEY,
    ],
    build,
    facts,
};

/// More periods than anyone can see; each takes memory.
const MOST_PERIODS: f64 = 1000.0;

fn parts(values: &Values) -> Result<(GratingMap, Truncation), KeyError> {
    let [h, period, width] = ["h", "period", "width"].map(|name| values.number(name));
    let map = GratingMap::new(period, h).map_err(|error| KeyError::at("h", error.to_string()))?;
    if period > width || period * MOST_PERIODS < width {
        let least = width / MOST_PERIODS;
        let message = format!(
            "period is {period} cm; it must be from {least} cm to {width} cm, for 1 to {MOST_PERIODS} of them \
             on the width"
        );
        return Err(KeyError::at("period", message));
    }
    Ok((map, carpet::cut(values, h)?))
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let (map, cut) = parts(values)?;
    Ok(carpet::structure(map.into(), cut, 1.0, values, request))
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((grating, cut)) = parts(values) else { return Vec::new() };
    let (least, largest) = ConformalMap::from(grating).index_range(&cut);
    vec![
        Fact::number("index_min", least),
        Fact::number("index_max", largest),
        Fact::number("cloaked_area_per_period_cm2", grating.area_of_a_period()),
        Fact::number("mirror_width_cm", 2.0 * cut.x_max),
    ]
}
