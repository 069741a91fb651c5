//! The double-Gaussian cloak: two Gaussian carpet cloaks back to back (design (iv) of Halimeh & Wegener,
//! Opt. Express 21, 9457 (2013), after Leonhardt, Science 312, 1777 (2006) and Schmied, Halimeh & Wegener,
//! Opt. Express 18, 24361 (2010)).
//!
//! A rectangle of locally isotropic graded index around a metal lens; the index is n = c/|f'| of the map
//! [`GaussianMap`], in the lower half that of its mirror image. At the cut the index steps.

use super::{
    Beyond, Cell, ConformalCell, Entry, Fact, Finish, Hull, Request, Show, Skin, Structure, carpet,
};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::{DVec2, DVec3};
use optics::geometry::{
    Cap, CurvedSide, Extent, FloorCurve, Hole, MetalBack, Outline, Pose, Solid, Wall,
};
use optics::propagation::{ConformalFlow, Half};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

pub(super) static ENTRY: Entry = Entry {
    kind: "double-gaussian-cloak",
    title: "Double-Gaussian cloak",
    summary: "Unidirectional, polarization-independent cloak of locally isotropic graded index around a \
              metal lens, from a conformal map. Design (iv) of Halimeh & Wegener 2013.",
    keys: &[
        carpet::W_KEY,
        carpet::h_key("Half the height of the metal lens; below 0.886 w."),
        Key {
            name: "width",
            doc: "Size of the cut along x.",
            kind: KeyKind::Number { default: Some(50.0), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "height",
            doc: "Size of the cut along y; above twice h.",
            kind: KeyKind::Number { default: Some(57.14), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "fresnel",
            doc: "Reflect at the cut, and at the border of an open core, as the index step asks for; false is a \
                  perfect antireflection coating.",
            kind: KeyKind::Flag { default: true },
        },
        Key {
            name: "referenced",
            doc: "Divide the index by its minimum, so that it is 1 at least.",
            kind: KeyKind::Flag { default: false },
        },
    ],
    build,
    facts,
};

/// The cells of the two halves.
const UPPER: u16 = 0;
const LOWER: u16 = 1;

/// The map and the cut of the upper half.
fn parts(values: &Values) -> Result<(GaussianMap, Truncation), KeyError> {
    let map = carpet::gaussian_map(values)?;
    let h = map.height();
    let height = values.number("height");
    if height <= 2.0 * h {
        let message = format!(
            "height is {height} cm; it must be above twice h, {} cm, to hold the metal",
            2.0 * h
        );
        return Err(KeyError::at("height", message));
    }
    Ok((map, Truncation::centred(values.number("width"), height / 2.0)))
}

/// The factor c of the index n = c/|f'|.
fn strength(values: &Values, map: &ConformalMap, cut: &Truncation) -> f64 {
    if values.flag("referenced") { 1.0 / map.index_range(cut).0 } else { 1.0 }
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let (map, cut) = parts(values)?;
    let map = ConformalMap::from(map);
    let extent = Extent::centred(request.length);
    Ok(match request.show {
        Show::Cloak => {
            let finish = if values.flag("fresnel") { Finish::Bare } else { Finish::Antireflection };
            let strength = strength(values, &map, &cut);
            cloak(
                &ConformalFlow::new(map, cut, extent, strength),
                finish,
                extent,
                request.open_core,
            )
        }
        Show::Bare => bare(map, cut, extent),
        Show::Mirror => super::flat_strip(cut.x_max, extent),
    })
}

fn cloak(flow: &ConformalFlow, finish: Finish, extent: Extent, open_core: bool) -> Structure {
    let cut = flow.cut();
    let (x, y) = (cut.x_max, cut.y_max);
    let outline = Outline::rectangle(x, y);
    // The metal, or the core, ends bluntly at the cut.
    let tip = flow.map().floor_height_at(x);
    let wall = |from: [f64; 2], to: [f64; 2], beyond: Beyond| Skin::Wall {
        wall: Wall::new(DVec2::from(from), DVec2::from(to), extent),
        beyond,
        finish: if beyond == Beyond::Conductor { Finish::Bare } else { finish },
    };
    let (upper, lower) = (Beyond::Cell(UPPER), Beyond::Cell(LOWER));
    let mut skin = vec![
        wall([x, -y], [x, -tip], lower),
        wall([x, tip], [x, y], upper),
        wall([x, y], [-x, y], upper),
        wall([-x, y], [-x, tip], upper),
        wall([-x, -tip], [-x, -y], lower),
        wall([-x, -y], [x, -y], lower),
    ];
    let floor = if open_core { Beyond::Air } else { Beyond::Conductor };
    if !open_core {
        skin.push(wall([x, -tip], [x, tip], floor));
        skin.push(wall([-x, tip], [-x, -tip], floor));
    }
    if let Some(ends) = extent.ends() {
        skin.extend(Cap::both(&outline, ends).map(|cap| Skin::ConformalCap {
            cap,
            map: flow.map().clone(),
            below: floor,
            upper: UPPER,
            lower: Some(LOWER),
            finish,
        }));
    }
    let cells = [Half::Upper, Half::Lower]
        .map(|half| {
            let (flow, loss_tangent) = (flow.clone(), 0.0);
            let core = Beyond::Air;
            Cell::Conformal(ConformalCell { flow, half, floor, core, finish, loss_tangent })
        })
        .to_vec();
    if !open_core {
        return Structure { cells, skin, hull: Hull::prism(outline, extent) };
    }
    let curve = FloorCurve::new(flow.map().clone(), MetalBack::MirrorImage, cut.x_min, x);
    for (side, beyond) in [(CurvedSide::Floor, upper), (CurvedSide::Image, lower)] {
        skin.push(Skin::InnerFloor { curve: curve.clone(), side, extent, beyond, finish });
    }
    let hole = Hole::Lens { curve, pose: Pose::new(DVec3::ZERO, 0.0), extent };
    let filled = Solid::Prism { outline, extent };
    let hull = Hull::new(filled.clone().with_hole(hole)).with_open_core(filled);
    Structure { cells, skin, hull }
}

fn bare(map: ConformalMap, cut: Truncation, extent: Extent) -> Structure {
    let x = cut.x_max;
    let around = Outline::rectangle(x, map.peak());
    let curve = FloorCurve::new(map, MetalBack::MirrorImage, cut.x_min, x);
    let mut skin = vec![Skin::Floor { curve: curve.clone(), extent }];
    if let Some(ends) = extent.ends() {
        skin.extend(
            Cap::both(&around, ends).map(|cap| Skin::FloorCap { cap, curve: curve.clone() }),
        );
    }
    let hull = Hull::prism(around, extent).of_metal(curve);
    Structure { cells: Vec::new(), skin, hull }
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((gaussian, cut)) = parts(values) else { return Vec::new() };
    let map = ConformalMap::from(gaussian);
    let c = strength(values, &map, &cut);
    let (least, largest) = map.index_range(&cut);
    vec![
        Fact::number("index_min", c * least),
        Fact::number("index_max", c * largest),
        Fact::number("cloaked_area_cm2", 2.0 * gaussian.area()),
        Fact::number("cloaked_area_within_cut_cm2", 2.0 * map.area_within(&cut)),
        Fact::number("mirror_width_cm", 2.0 * cut.x_max),
    ]
}
