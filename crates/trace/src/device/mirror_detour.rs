//! The detour of plane mirrors: the trivial cloak that is none for waves.
//!
//! Eight flat two-sided mirrors at 45 degrees lead light that runs along x around the space in
//! their midst, and back onto its line. Such a cloak works in every polarization and color, but for
//! one direction only, and it delays light: it cloaks rays, never waves (Halimeh & Wegener, Opt.
//! Express 21, 9457 (2013), section 1).

use super::{Device, Fact, Hull, Request, Structure, Surface};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::DVec2;
use optics::geometry::{Extent, Outline, Solid, Wall};
use optics::wave::SPEED_OF_LIGHT;

crate::table! {
    /// Eight plane mirrors that lead light along x around the space in their midst: invisible for
    /// exactly this direction, and even there late. The trivial cloak of the introduction of
    /// Halimeh & Wegener 2013.
    pub struct MirrorDetour {
        /// By how much light is led aside; rays within it of the axis are led around.
        offset: f64 = 8.0, "cm", in ValueRange::LENGTH,
        /// Half the size along x; `offset` at least.
        half_length: f64 = 20.0, "cm", in ValueRange::LENGTH,
    }
}

impl Device for MirrorDetour {
    const KIND: &'static str = "mirror-detour";
    const TITLE: &'static str = "Detour of plane mirrors";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "mirror-detour is mirrors alone")?;
        let (s, l) = (self.offset, self.half_length);
        let message = format!(
            "half_length is {l} cm; it must be {s} cm, the offset, at least, or mirrors cross"
        );
        KeyError::refuse_if(l < s, key!(Self.half_length), message)?;
        let extent = Extent::centred(request.length);
        let (surfaces, solids) = mirrors(s, l)
            .into_iter()
            .map(|[from, to]| {
                let outline = Outline { corners: vec![from, to] };
                (Surface::mirror(Wall::new(from, to, extent)), Solid::Prism { outline, extent })
            })
            .unzip();
        // The space between the mirrors is free: things may stand there.
        Ok(Structure::new(Vec::new(), surfaces, Hull::of_parts(solids)))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let (s, l) = (self.offset, self.half_length);
        vec![
            Fact::number("cloaked_height_cm", 2.0 * s),
            Fact::number("cloaked_area_cm2", 4.0 * s * l - 2.0 * s * s),
            Fact::number("time_of_flight_difference_ns", 2.0 * s / SPEED_OF_LIGHT),
        ]
    }
}

/// The cross-sections of the eight mirrors.
fn mirrors(s: f64, l: f64) -> [[DVec2; 2]; 8] {
    let upper = [
        [(-l, 0.0), (s - l, s)],
        [(-l, s), (s - l, 2.0 * s)],
        [(l - s, 2.0 * s), (l, s)],
        [(l - s, s), (l, 0.0)],
    ]
    .map(|mirror| mirror.map(DVec2::from));
    std::array::from_fn(|i| upper[i % 4].map(|p| if i < 4 { p } else { DVec2::new(p.x, -p.y) }))
}
