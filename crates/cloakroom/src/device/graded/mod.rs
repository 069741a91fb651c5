//! A graded index of one's own: an isotropic index given on a grid over a rectangle or a disc, endless along z or cut,
//! with or without a round metal core.
//!
//! Between the samples the square of the index is a bicubic spline, whose second derivatives are continuous; rays are
//! followed through that, to the tolerance. At the border the index steps to that of air, with refraction and Fresnel
//! reflection.

mod index_file;

use super::round::{metal_cylinder, upright};
use super::{
    Beyond, Cell, ConformalCell, Entry, Fact, Finish, Hull, Request, Show, Skin, Structure,
};
use crate::keys::{Key, KeyError, KeyKind, Limits, Sampled, Samples, Values};
use glam::DVec2;
use optics::geometry::{Cap, Cylinder, Extent, Hole, Outline, Solid, Wall};
use optics::propagation::{ConformalFlow, GridSpline, Half, Unevenness};
use optics::transformation::{ConformalMap, FlatMap, Truncation};
use std::f64::consts::PI;

pub(super) static ENTRY: Entry = Entry {
    kind: "graded",
    title: "Graded index of one's own",
    summary: "A device of one's own: any isotropic graded index, given on a grid over a rectangle or a disc and the \
              same along z, around a metal cylinder or without one.",
    keys: &[
        Key {
            name: "index",
            doc: "The refractive index on a regular grid from border to border: rows of numbers, one row for each \
                  x from the least to the largest, in it one number for each y; four at least either way. Or the \
                  name of a .npy file, relative to the scene file. Between them the square of the index is a \
                  bicubic spline.",
            kind: KeyKind::Samples { limits: Limits::Between(0.0, 1000.0) },
        },
        Key {
            name: "shape",
            doc: "The border: the rectangle of the grid, or the largest circle about the middle of it.",
            kind: KeyKind::Choice { options: &["rectangle", "circle"] },
        },
        Key {
            name: "width",
            doc: "Size of the grid along x, from its first sample to its last.",
            kind: KeyKind::Number { default: Some(40.0), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "height",
            doc: "Size of the grid along y, from its first sample to its last.",
            kind: KeyKind::Number { default: Some(40.0), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "inner",
            doc: "Radius of a metal cylinder along z in the middle, which the medium surrounds; 0 for none. The \
                  samples within go on smoothly for about ten steps of the grid; what they are beyond does not matter.",
            kind: KeyKind::Number {
                default: Some(0.0),
                unit: "cm",
                limits: Limits::LENGTH_OR_ZERO,
            },
        },
    ],
    build,
    facts,
};

/// The one cell.
const CELL: u16 = 0;

/// How near the core may come to the border, as a share of the way there.
const THINNEST: f64 = 0.001;

/// Of the size of the device, the length over which it varies at most.
const VARIES: f64 = 0.25;

/// The border of a device: it is centred on the z axis.
#[derive(Clone, Copy)]
struct Site {
    /// Half the size of the grid along x and y, cm.
    half: DVec2,
    /// The radius of the border if it is round, cm.
    rim: Option<f64>,
    /// The radius of the core, if there is one, cm.
    core: Option<f64>,
}

impl Site {
    fn new(values: &Values) -> Result<Self, KeyError> {
        let half = 0.5 * DVec2::new(values.number("width"), values.number("height"));
        let nearest = half.min_element();
        let rim = (values.choice("shape") == "circle").then_some(nearest);
        let inner = values.number("inner");
        let most = (1.0 - THINNEST) * nearest;
        if inner > most {
            let message =
                format!("inner is {inner} cm; it must be at most {most} cm, within the border");
            return Err(KeyError::at("inner", message));
        }
        Ok(Self { half, rim, core: (inner > 0.0).then_some(inner) })
    }

    /// The area of the medium, cm².
    fn area(&self) -> f64 {
        let whole = self.rim.map_or(4.0 * self.half.x * self.half.y, |rim| PI * rim * rim);
        whole - self.core_area()
    }

    fn core_area(&self) -> f64 {
        self.core.map_or(0.0, |core| PI * core * core)
    }

    /// Whether the medium is at a point of the grid.
    fn holds(&self, at: DVec2) -> bool {
        let within = self.rim.is_none_or(|rim| at.length() <= rim);
        within && self.core.is_none_or(|core| at.length() >= core)
    }

    /// Where samples are: the first of them, and the steps along x and y.
    fn grid(&self, count: [usize; 2]) -> [DVec2; 2] {
        let steps = DVec2::new(count[0] as f64, count[1] as f64) - 1.0;
        [-self.half, 2.0 * self.half / steps]
    }

    fn structure(
        self,
        square: GridSpline,
        extent: Extent,
        open_core: bool,
    ) -> Result<Structure, KeyError> {
        let DVec2 { x, y } = self.half;
        // Beyond a round border, its box is not there.
        let margin = if self.rim.is_some() { 1.5 } else { 1.0 };
        let cut = Truncation { x_min: -margin * x, x_max: margin * x, y_max: margin * y };
        let map = ConformalMap::from(FlatMap::new(-margin * y, VARIES * (2.0 * x.max(y))));
        let reach = |[nearest, farthest]: [f64; 2]| {
            self.core.is_none_or(|core| farthest >= core)
                && self.rim.is_none_or(|rim| nearest <= rim)
        };
        let unevenness = Unevenness::within(square, reach).ok_or_else(|| {
            let message = "between the samples the index falls to 0; take a finer grid, or a larger least index";
            KeyError::at("index", message)
        })?;
        let flow = ConformalFlow::new(map, cut, extent, 1.0)
            .between(self.core, self.rim)
            .with_unevenness(unevenness);
        let beyond_core = if open_core { Beyond::Air } else { Beyond::Conductor };
        let cells = vec![Cell::Conformal(ConformalCell {
            flow,
            half: Half::Upper,
            floor: Beyond::Air,
            core: beyond_core,
            finish: Finish::Bare,
            loss_tangent: 0.0,
        })];
        let core = (self.core.unwrap_or(0.0), beyond_core);
        let beyond = Beyond::Cell(CELL);
        let outline = Outline::rectangle(x, y);
        let (mut skin, whole) = match self.rim {
            Some(rim) => (upright(core, rim, extent, beyond), Solid::cylinder(rim, extent)),
            None => (upright_box(core, &outline, extent, beyond), Solid::Prism { outline, extent }),
        };
        let hull = match self.core {
            Some(radius) if open_core => {
                skin.push(Skin::InnerSide { cylinder: Cylinder { radius, extent }, beyond });
                let hole = Hole::Round(Solid::cylinder(radius, extent));
                Hull::new(whole.clone().with_hole(hole)).with_open_core(whole)
            }
            _ => Hull::new(whole),
        };
        Ok(Structure { cells, skin, hull })
    }
}

/// The sides and the ends of a box with a round core, which has a radius and is something of its own.
fn upright_box(
    core: (f64, Beyond),
    outline: &Outline,
    extent: Extent,
    beyond: Beyond,
) -> Vec<Skin> {
    let finish = Finish::Bare;
    let wall = |(from, to)| Skin::Wall { wall: Wall::new(from, to, extent), beyond, finish };
    let mut skin: Vec<Skin> = outline.sides().map(wall).collect();
    let (core, beyond_core) = core;
    for cap in extent.ends().into_iter().flat_map(|ends| Cap::both(outline, ends)) {
        skin.push(Skin::PiercedCap { cap, beyond, core, beyond_core });
    }
    skin
}

fn samples(values: &Values) -> Result<Samples, KeyError> {
    match values.samples("index") {
        Some(Sampled::Here(samples)) => Ok(samples.clone()),
        Some(Sampled::InFile(file)) => {
            let samples =
                index_file::read(file).map_err(|message| KeyError::at("index", message))?;
            // What a scene says is held against its key before.
            let KeyKind::Samples { limits } = ENTRY.keys[0].kind else { return Ok(samples) };
            match samples.values().iter().position(|number| !limits.allow(*number)) {
                None => Ok(samples),
                Some(at) => {
                    let [row, column] = [at / samples.count()[1], at % samples.count()[1]];
                    let message = format!(
                        "index[{row}][{column}] is {} in {file}; it must be {}",
                        samples.values()[at],
                        limits.describe()
                    );
                    Err(KeyError::at("index", message))
                }
            }
        }
        None => {
            let message = "there is no `index`: rows of numbers, or the name of a .npy file";
            Err(KeyError::general(message))
        }
    }
}

/// The square of the index.
fn square(site: &Site, samples: &Samples) -> Result<GridSpline, KeyError> {
    let [nx, ny] = samples.count();
    let [corner, spacing] = site.grid([nx, ny]);
    // Along x side by side.
    let along_x = (0..ny).flat_map(|j| (0..nx).map(move |i| samples.values()[i * ny + j].powi(2)));
    GridSpline::new(corner, spacing, [nx, ny], &along_x.collect::<Vec<_>>())
        .map_err(|error| KeyError::at("index", format!("index: {error}")))
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let site = Site::new(values)?;
    let extent = Extent::centred(request.length);
    if request.open_core && site.core.is_none() {
        let message = "there is no core to open; `inner` is its radius";
        return Err(KeyError::at("core", message));
    }
    match (request.show, site.core) {
        (Show::Cloak, _) => {
            site.structure(square(&site, &samples(values)?)?, extent, request.open_core)
        }
        (Show::Bare, Some(core)) => Ok(metal_cylinder(core, extent)),
        (Show::Mirror, Some(_)) => Ok(Structure::empty()),
        (_, None) => {
            super::refuse_other_views(request, "a graded index without a core hides no metal")?;
            Ok(Structure::empty())
        }
    }
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok(site) = Site::new(values) else { return Vec::new() };
    let mut facts = vec![Fact::number("medium_area_cm2", site.area())];
    if site.core.is_some() {
        facts.push(Fact::number("cloaked_area_cm2", site.core_area()));
    }
    if let Ok(samples) = samples(values) {
        let [_, ny] = samples.count();
        let [corner, spacing] = site.grid(samples.count());
        let place = |k: usize| corner + spacing * DVec2::new((k / ny) as f64, (k % ny) as f64);
        let within = samples.values().iter().enumerate().filter(|(k, _)| site.holds(place(*k)));
        let start = (f64::INFINITY, 0.0_f64);
        let (least, largest) =
            within.fold(start, |(low, high), (_, n)| (low.min(*n), high.max(*n)));
        if least.is_finite() {
            facts.push(Fact::number("index_min", least));
            facts.push(Fact::number("index_max", largest));
        }
    }
    facts
}
