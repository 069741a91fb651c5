//! The classical balls of graded index: the lenses of Eaton and Luneburg and Maxwell's fish-eye.

use super::round::{RADIUS_KEY, ball, lens_alone};
use super::{Entry, Fact, Request, Structure};
use crate::keys::{Key, KeyError, Values};
use optics::propagation::{CentralLens, RadialFlow};
use std::f64::consts::{FRAC_PI_2, PI};

const KEYS: &[Key] = &[RADIUS_KEY];

pub(super) static EATON: Entry = Entry {
    kind: "eaton-lens",
    title: "Eaton's lens",
    summary: "A ball of graded index that sends every ray back where it came from, shifted to the other \
              side of the centre. Eaton 1952.",
    keys: KEYS,
    build: |values, request| build(eaton(values), request),
    facts: |values| {
        let lens = eaton(values);
        vec![
            Fact::number("index_min", 1.0),
            Fact::number("index_at_half_radius", lens.index(lens.radius() / 2.0)),
            Fact::number("optical_path_beyond_chord_cm", PI * lens.radius()),
        ]
    },
};

pub(super) static LUNEBURG: Entry = Entry {
    kind: "luneburg-lens",
    title: "Luneburg's lens",
    summary: "A ball of graded index that focuses parallel rays, of any direction, to a point of its far \
              side. Luneburg 1944.",
    keys: KEYS,
    build: |values, request| build(luneburg(values), request),
    facts: |values| {
        let lens = luneburg(values);
        vec![
            Fact::number("index_min", 1.0),
            Fact::number("index_max", lens.index(0.0)),
            Fact::number("central_optical_path_cm", (FRAC_PI_2 + 1.0) * lens.radius()),
        ]
    },
};

pub(super) static FISHEYE: Entry = Entry {
    kind: "fisheye-lens",
    title: "Maxwell's fish-eye",
    summary: "A ball of graded index that images every point of its surface to the opposite one. Maxwell \
              1854.",
    keys: KEYS,
    build: |values, request| build(fisheye(values), request),
    facts: |values| {
        let lens = fisheye(values);
        vec![
            Fact::number("index_min", 1.0),
            Fact::number("index_max", lens.index(0.0)),
            Fact::number("optical_path_cm", PI * lens.radius()),
        ]
    },
};

fn eaton(values: &Values) -> CentralLens {
    CentralLens::eaton(values.number("radius"), PI)
}

fn luneburg(values: &Values) -> CentralLens {
    CentralLens::luneburg(values.number("radius"))
}

fn fisheye(values: &Values) -> CentralLens {
    CentralLens::fisheye(values.number("radius"))
}

fn build(lens: CentralLens, request: Request) -> Result<Structure, KeyError> {
    lens_alone(request)?;
    Ok(ball(lens.radius(), RadialFlow::Lens(lens)))
}
