//! The classical balls of graded index: the lenses of Eaton and Luneburg and Maxwell's fish-eye.

use super::round::{ball, lens_alone};
use super::{Device, Fact, Request, Structure};
use crate::keys::{KeyError, ValueRange};
use optics::propagation::{CentralLens, RadialFlow};
use std::f64::consts::{FRAC_PI_2, PI};

/// Makes a ball that is a lens: what it is, its kind and title, its index, and its facts.
macro_rules! lens {
    (
        $(#[doc = $about:literal])+
        $name:ident, $kind:literal, $title:literal, $lens:expr, $facts:expr
    ) => {
        crate::table! {
            $(#[doc = $about])+
            pub struct $name {
                /// Radius of the ball.
                radius: f64 = 10.0, "cm", in ValueRange::LENGTH,
            }
        }

        impl Device for $name {
            const KIND: &'static str = $kind;
            const TITLE: &'static str = $title;

            fn structure(&self, request: Request) -> Result<Structure, KeyError> {
                lens_alone(request)?;
                let lens: fn(f64) -> CentralLens = $lens;
                Ok(ball(self.radius, RadialFlow::Lens(lens(self.radius)), None))
            }

            fn facts(&self, _: Request) -> Vec<Fact> {
                let (lens, facts): (fn(f64) -> CentralLens, fn(CentralLens) -> [Fact; 2]) =
                    ($lens, $facts);
                [vec![Fact::number("index_min", 1.0)], facts(lens(self.radius)).into()].concat()
            }
        }
    };
}

lens! {
    /// A ball of graded index that sends every ray back where it came from, shifted to the other
    /// side of the centre. Eaton 1952.
    EatonLens, "eaton-lens", "Eaton's lens",
    |radius| CentralLens::eaton(radius, PI),
    |lens| [
        Fact::number("index_at_half_radius", lens.index(lens.radius / 2.0)),
        Fact::number("optical_path_beyond_chord_cm", PI * lens.radius),
    ]
}

lens! {
    /// A ball of graded index that focuses parallel rays, of any direction, to a point of its far
    /// side. Luneburg 1944.
    LuneburgLens, "luneburg-lens", "Luneburg's lens",
    CentralLens::luneburg,
    |lens| [
        Fact::number("index_max", lens.index(0.0)),
        Fact::number("central_optical_path_cm", (FRAC_PI_2 + 1.0) * lens.radius),
    ]
}

lens! {
    /// A ball of graded index that images every point of its surface to the opposite one. Maxwell
    /// 1854.
    FisheyeLens, "fisheye-lens", "Maxwell's fish-eye",
    CentralLens::fisheye,
    |lens| [
        Fact::number("index_max", lens.index(0.0)),
        Fact::number("optical_path_cm", PI * lens.radius),
    ]
}
