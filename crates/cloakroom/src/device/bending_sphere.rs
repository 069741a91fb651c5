//! A sphere that turns every ray by one angle (Hannay & Haeusser, J. Mod. Opt. 40, 1437 (1993)).

use super::round::{RADIUS_KEY, ball, lens_alone};
use super::{Entry, Fact, Request, Structure};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use optics::propagation::{CentralLens, RadialFlow};

pub(super) static ENTRY: Entry = Entry {
    kind: "bending-sphere",
    title: "Bending sphere",
    summary: "A ball of graded index that turns every ray that meets it by the same angle towards its \
              centre: 90 degrees by default. Hannay & Haeusser 1993.",
    keys: &[
        RADIUS_KEY,
        Key {
            name: "angle",
            doc: "By how much each ray is turned; 180 is Eaton's lens and 360 the invisible sphere.",
            kind: KeyKind::Number {
                default: Some(90.0),
                unit: "degrees",
                limits: Limits::Within(0.0, 720.0),
            },
        },
    ],
    build,
    facts,
};

fn lens(values: &Values) -> CentralLens {
    CentralLens::eaton(values.number("radius"), values.number("angle").to_radians())
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    lens_alone(request)?;
    Ok(ball(values.number("radius"), RadialFlow::Lens(lens(values))))
}

fn facts(values: &Values) -> Vec<Fact> {
    let (radius, angle) = (values.number("radius"), values.number("angle"));
    vec![
        Fact::number("index_min", 1.0),
        Fact::number("index_at_half_radius", lens(values).index(radius / 2.0)),
        Fact::number("bending_angle_deg", angle),
        Fact::number("optical_path_beyond_chord_cm", angle.to_radians() * radius),
    ]
}
