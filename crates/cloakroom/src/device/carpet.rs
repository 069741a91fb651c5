//! What the carpet cloaks have in common: a rectangle of graded index on a bump of a mirror floor, light
//! from above (Li & Pendry, Phys. Rev. Lett. 101, 203901 (2008)).
//!
//! A carpet stands on the line y = 0 of its own frame, from which the thin floor goes on to its left and
//! right. Everything is a mirror on both sides: the floor, the bump, and the flat back of the metal below
//! it. The back lies on y = 0, for a grating at the depth of its troughs.

use super::{Beyond, Cell, ConformalCell, Finish, Hull, Request, Show, Skin, Structure};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::DVec2;
use optics::geometry::{Cap, Extent, FloorCurve, MetalBack, Outline, Wall};
use optics::propagation::{ConformalFlow, Half};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

/// The key `w` of a Gaussian map.
pub(super) const W_KEY: Key = Key {
    name: "w",
    doc: "Width parameter of the map.",
    kind: KeyKind::Number { default: Some(10.02), unit: "cm", limits: Limits::LENGTH },
};

/// The key `h` of a Gaussian map.
pub(super) const fn h_key(doc: &'static str) -> Key {
    Key {
        name: "h",
        doc,
        kind: KeyKind::Number { default: Some(4.25), unit: "cm", limits: Limits::LENGTH },
    }
}

/// The map of the keys `w` and `h`.
pub(super) fn gaussian_map(values: &Values) -> Result<GaussianMap, KeyError> {
    GaussianMap::new(values.number("w"), values.number("h"))
        .map_err(|error| KeyError::at("h", error.to_string()))
}

/// The key `width` of a carpet.
pub(super) const fn width_key(default: f64) -> Key {
    Key {
        name: "width",
        doc: "Size of the device along x.",
        kind: KeyKind::Number { default: Some(default), unit: "cm", limits: Limits::LENGTH },
    }
}

/// The key `height` of a carpet.
pub(super) const HEIGHT_KEY: Key = Key {
    name: "height",
    doc: "Height of the device above the floor's level; above the bump.",
    kind: KeyKind::Number { default: Some(28.57), unit: "cm", limits: Limits::LENGTH },
};

/// The key `floor` of a carpet.
pub(super) const FLOOR_KEY: Key = Key {
    name: "floor",
    doc: "Whole width along x of the mirror floor that the device stands on; 0 for none.",
    kind: KeyKind::Number { default: Some(400.0), unit: "cm", limits: Limits::LENGTH_OR_ZERO },
};

/// The rectangle a carpet is cut to, whose metal rises to `peak`.
///
/// # Errors
///
/// If the metal does not fit in, or the floor ends below the device.
pub(super) fn cut(values: &Values, peak: f64) -> Result<Truncation, KeyError> {
    let [width, height, floor] = ["width", "height", "floor"].map(|name| values.number(name));
    if height <= peak {
        let message =
            format!("height is {height} cm; it must be above h, {peak} cm, to hold the metal");
        return Err(KeyError::at("height", message));
    }
    if floor > 0.0 && floor < width {
        let message = format!(
            "floor is {floor} cm; it must be at least as wide as the device, {width} cm, or 0 for none"
        );
        return Err(KeyError::at("floor", message));
    }
    Ok(Truncation::centred(width, height))
}

/// A carpet in any view; `strength` is c of its index c/|f'|.
pub(super) fn structure(
    map: ConformalMap,
    cut: Truncation,
    strength: f64,
    values: &Values,
    request: Request,
) -> Structure {
    let extent = Extent::centred(request.length);
    let site = Site { cut, half_floor: 0.5 * values.number("floor"), extent };
    match request.show {
        Show::Cloak => site.cloak(&ConformalFlow::new(map, cut, extent, strength)),
        Show::Bare => site.bare(map),
        Show::Mirror => site.mirror(),
    }
}

/// Where a carpet stands.
struct Site {
    cut: Truncation,
    half_floor: f64,
    extent: Extent,
}

impl Site {
    fn cloak(&self, flow: &ConformalFlow) -> Structure {
        const CELL: u16 = 0;
        let map = flow.map();
        let Truncation { x_max: x, y_max: top, .. } = self.cut;
        let bottom = map.trough();
        // The metal ends bluntly at the cut; in a trough it ends as high as the floor.
        let tip = map.floor_height_at(x).max(0.0);
        let finish = Finish::Bare;
        let mut skin = Vec::new();
        let mut wall = |from: [f64; 2], to: [f64; 2], beyond: Beyond| {
            if from != to {
                let wall = Wall::new(DVec2::from(from), DVec2::from(to), self.extent);
                skin.push(Skin::Wall { wall, beyond, finish });
            }
        };
        wall([x, tip], [x, top], Beyond::Cell(CELL));
        wall([x, top], [-x, top], Beyond::Cell(CELL));
        wall([-x, top], [-x, tip], Beyond::Cell(CELL));
        wall([-x, tip], [-x, bottom], Beyond::Conductor);
        wall([-x, bottom], [x, bottom], Beyond::Conductor);
        wall([x, bottom], [x, tip], Beyond::Conductor);
        let outline = self.box_between(bottom, top);
        if let Some(ends) = self.extent.ends() {
            skin.extend(Cap::both(&outline, ends).map(|cap| Skin::ConformalCap {
                cap,
                map: map.clone(),
                below: Beyond::Conductor,
                upper: CELL,
                lower: None,
                finish,
            }));
        }
        let cell = ConformalCell {
            flow: flow.clone(),
            half: Half::Upper,
            floor: Beyond::Conductor,
            core: Beyond::Air,
            finish,
            loss_tangent: 0.0,
        };
        self.on_floor(vec![Cell::Conformal(cell)], skin, Hull::prism(outline, self.extent))
    }

    fn bare(&self, map: ConformalMap) -> Structure {
        let [bottom, peak] = [map.trough(), map.peak()];
        let Truncation { x_min, x_max, .. } = self.cut;
        let tip = map.floor_height_at(x_max);
        let around = self.box_between(bottom, peak);
        let curve = FloorCurve::new(map, MetalBack::Flat(bottom), x_min, x_max);
        let mut skin = vec![Skin::Floor { curve: curve.clone(), extent: self.extent }];
        if tip < 0.0 {
            // A trough at the end is closed by a thin wall up to the floor.
            skin.extend([x_min, x_max].map(|x| {
                let ends = [tip, 0.0].map(|y| DVec2::new(x, y));
                Skin::Strip(Wall::new(ends[0], ends[1], self.extent))
            }));
        }
        if let Some(ends) = self.extent.ends() {
            skin.extend(
                Cap::both(&around, ends).map(|cap| Skin::FloorCap { cap, curve: curve.clone() }),
            );
        }
        self.on_floor(Vec::new(), skin, Hull::prism(around, self.extent).of_metal(curve))
    }

    /// The flat mirror that the floor with the carpet should look like.
    fn mirror(&self) -> Structure {
        super::flat_strip(self.half_floor.max(self.cut.x_max), self.extent)
    }

    /// The rectangle over the width of the device.
    fn box_between(&self, bottom: f64, top: f64) -> Outline {
        let Truncation { x_min, x_max, .. } = self.cut;
        Outline::new(
            [(x_min, bottom), (x_max, bottom), (x_max, top), (x_min, top)]
                .map(DVec2::from)
                .to_vec(),
        )
    }

    /// Adds the floor on the left and on the right.
    fn on_floor(&self, cells: Vec<Cell>, mut skin: Vec<Skin>, hull: Hull) -> Structure {
        let (inner, outer) = (self.cut.x_max, self.half_floor);
        if outer <= inner {
            return Structure { cells, skin, hull };
        }
        for side in [-1.0, 1.0] {
            let ends = [inner, outer].map(|x| DVec2::new(side * x, 0.0));
            skin.push(Skin::Strip(Wall::new(ends[0], ends[1], self.extent)));
        }
        let line = [-outer, outer].map(|x| DVec2::new(x, 0.0));
        let hull = hull.with_thin_mirror(Outline::new(line.to_vec()), self.extent);
        Structure { cells, skin, hull }
    }
}
