//! The invisible sphere: every ray leaves it on its own line, late (Miñano, Opt. Express 14, 9627 (2006);
//! made regular by transmutation, Tyc & Leonhardt, New J. Phys. 10, 115038 (2008)).

use super::round::{RADIUS_KEY, ball, lens_alone};
use super::{Entry, Fact, Request, Structure};
use crate::keys::{Key, KeyError, KeyKind, Values};
use optics::propagation::{CentralLens, RadialFlow, TransmutedSphere};
use optics::wave::SPEED_OF_LIGHT;
use std::f64::consts::TAU;

pub(super) static ENTRY: Entry = Entry {
    kind: "invisible-sphere",
    title: "Invisible sphere",
    summary: "A ball of graded index that every ray loops through once, to leave it on its own line, \
              late by the ball's circumference; it hides nothing but itself. Minano 2006, \
              regularized after Tyc & Leonhardt 2008.",
    keys: &[
        RADIUS_KEY,
        Key {
            name: "material",
            doc: "A graded index that is infinite at the centre, or its regularized form, a \
                  uniaxial dielectric with its axis along the radius: then the extraordinary wave \
                  sees the invisible sphere and the ordinary one a ball of glass.",
            kind: KeyKind::Choice { options: &["graded", "regularized"] },
        },
    ],
    build,
    facts,
};

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    lens_alone(request)?;
    let radius = values.number("radius");
    Ok(ball(
        radius,
        match values.choice("material") {
            "regularized" => RadialFlow::Transmuted(TransmutedSphere::new(radius)),
            _ => RadialFlow::Lens(CentralLens::eaton(radius, TAU)),
        },
    ))
}

fn facts(values: &Values) -> Vec<Fact> {
    let radius = values.number("radius");
    let delay = Fact::number("time_of_flight_difference_ns", TAU * radius / SPEED_OF_LIGHT);
    if values.choice("material") == "regularized" {
        let ordinary = TransmutedSphere::ORDINARY_INDEX;
        return vec![
            Fact::number("ordinary_index", ordinary),
            Fact::numbers(
                "extraordinary_index_at_surface_and_centre",
                [1.0, TransmutedSphere::CENTRAL_EXTRAORDINARY_INDEX],
            ),
            Fact::number("normal_reflectance", ((ordinary - 1.0) / (ordinary + 1.0)).powi(2)),
            delay,
        ];
    }
    let lens = CentralLens::eaton(radius, TAU);
    vec![
        Fact::number("index_min", 1.0),
        Fact::number("index_at_half_radius", lens.index(radius / 2.0)),
        delay,
    ]
}
