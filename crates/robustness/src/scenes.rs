//! Random scenes: any device of the catalogue, with any of its keys.

use crate::draws::Draws;
use cloakroom::assembly::Assembly;
use cloakroom::device::{CATALOGUE, Entry};
use cloakroom::keys::{Key, KeyKind, ValueRange};
use cloakroom::render;
use cloakroom::scene::{Placement, Scene, TABLES};
use cloakroom::scene_file::{self, Loaded};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::material::Material;
use std::f64::consts::TAU;
use std::fmt::Display;
use std::path::Path;
use toml::{Table, Value};

/// Imaginary parts around this dim light over centimetres at the default wavelength.
const LOSS: f64 = 1e-6;

/// The kind of devices whose media are given on grids.
const GRADED: &str = "graded";

/// The key of lists that need not be there.
const COATING: &str = "coating";

/// A scene of one to three devices, as the tables of a scene file.
pub(crate) fn scene(draws: &mut Draws<'_>) -> Table {
    let count = 1 + draws.below(8) / 3;
    let devices = (0..count).map(|_| {
        let entry = *draws.pick(CATALOGUE);
        Value::Table(device(draws, entry))
    });
    let mut scene = Table::from_iter([("device".to_owned(), devices.collect::<Vec<_>>().into())]);
    for (name, keys) in TABLES {
        if draws.chance(60) {
            scene.insert((*name).to_owned(), Value::Table(table(draws, keys, 80)));
        }
    }
    scene
}

/// A scene of one device of a kind, at the origin; some stand in a block of glass, which may be too
/// small for them: such a scene is refused.
pub(crate) fn scene_of(draws: &mut Draws<'_>, entry: &'static Entry) -> Table {
    let mut device = device(draws, entry);
    device.remove("position");
    let mut devices = vec![Value::Table(device)];
    if draws.chance(50) {
        let size: Vec<Value> = (0..3).map(|_| draws.between(15.0, 80.0).into()).collect();
        devices.push(Value::Table(Table::from_iter([
            ("kind".to_owned(), "body".into()),
            ("shape".to_owned(), "box".into()),
            ("size".to_owned(), size.into()),
            ("permittivity".to_owned(), draws.between(1.2, 4.0).into()),
        ])));
    }
    let tolerance = 10f64.powf(draws.between(-9.0, -3.0));
    let trace = Table::from_iter([("tolerance".to_owned(), tolerance.into())]);
    Table::from_iter([
        ("device".to_owned(), devices.into()),
        ("trace".to_owned(), Value::Table(trace)),
    ])
}

/// A scene of any device, seen from anywhere before the photograph: a picture of that size.
pub(crate) fn scene_seen(draws: &mut Draws<'_>, size: [i64; 2], samples: i64) -> Table {
    let entry = draws.pick(CATALOGUE);
    let mut scene = scene_of(draws, entry);
    let from = draws.direction() * 10f64.powf(draws.between(1.5, 2.2));
    // On the side from which the device is before the photograph.
    let from = from.with_x(-from.x.abs());
    let camera = Table::from_iter([
        ("resolution".to_owned(), size.to_vec().into()),
        ("samples".to_owned(), samples.into()),
        ("position".to_owned(), from.to_array().to_vec().into()),
        ("target".to_owned(), vec![0.0; 3].into()),
    ]);
    scene.insert("camera".to_owned(), camera.into());
    scene
}

/// A random scene that is not refused.
#[derive(Debug)]
pub struct SoundScene {
    /// As a scene file.
    pub text: String,
    /// The scene.
    pub scene: Scene,
    /// Its devices.
    pub assembly: Assembly,
    /// How many were refused before it.
    pub refused: u64,
}

/// How many scenes are drawn at most until one is not refused.
const MOST_DRAWN: u64 = 256;

/// The first random scene of one device of a kind that is not refused.
///
/// # Errors
///
/// Why the last one was refused, if all were.
pub fn sound_scene(draws: &mut Draws<'_>, entry: &'static Entry) -> Result<SoundScene, String> {
    let mut why = String::new();
    for refused in 0..MOST_DRAWN {
        let text = scene_of(draws, entry).to_string();
        let loaded = scene_file::parse(&text, "scene", Path::new("/nowhere"), &[]);
        let made =
            loaded.map_err(|error| error.to_string()).and_then(|Loaded { scene, .. }| {
                let assembly = render::assembly(&scene).map_err(|error| error.to_string())?;
                Ok((scene, assembly))
            });
        match made {
            Ok((scene, assembly)) => return Ok(SoundScene { text, scene, assembly, refused }),
            Err(message) => why = message,
        }
    }
    Err(why)
}

/// The table of a device of a kind.
fn device(draws: &mut Draws<'_>, entry: &'static Entry) -> Table {
    let mut device = table(draws, entry.keys, 100);
    device.extend(table(draws, Placement::KEYS, 50));
    if entry.kind == GRADED && !draws.chance(20) {
        fields(draws, &mut device);
    }
    device.insert("kind".to_owned(), entry.kind.into());
    device
}

/// Some of the keys of a table: each in `share` of 256 cases. What there is nothing without is
/// there, and as a rule nothing that contradicts the rest.
fn table(draws: &mut Draws<'_>, keys: &'static [Key], share: u8) -> Table {
    let mut table = Table::new();
    let ways = ways(keys);
    let way = (!ways.is_empty() && !draws.chance(4)).then(|| *draws.pick(&ways));
    for key in keys {
        let is_of = |way: &[&str]| way.contains(&key.name);
        if way.is_some_and(|way| !is_of(way)) && ways.iter().any(|way| is_of(way)) {
            continue;
        }
        let is_list = matches!(
            key.kind,
            KeyKind::Tables { .. } | KeyKind::Polygon | KeyKind::Samples { dimensions: [2, _] }
        ) && !matches!(key.name, COATING | "vertices" | "planes");
        let is_first = way.is_some_and(|way| way.first() == Some(&key.name));
        if is_list || is_first || NEEDED.contains(&key.name) || draws.chance(share) {
            table.insert(key.name.to_owned(), value(draws, key));
        }
    }
    let is_crystal = |material: &Value| match material.as_str() {
        Some(name) => Material::named(name).is_some_and(|found| found.extraordinary.is_some()),
        None => material.get("extraordinary").is_some(),
    };
    if way == Some(MATERIAL) && !table.get("material").is_some_and(is_crystal) {
        table.remove("optic_axis");
    }
    table
}

const MATERIAL: &[&str] = &["material", "optic_axis"];

/// What says all of a medium, of a metal or of a law, the first key of each being needed: a table
/// takes one of these ways.
fn ways(keys: &[Key]) -> Vec<&'static [&'static str]> {
    const MEDIUM: [&[&str]; 5] =
        [&["index"], &["uniaxial"], &["biaxial"], MATERIAL, &["permittivity", "permeability"]];
    const METAL: [&[&str]; 2] = [&["index"], &["material"]];
    const LAW: [&[&str]; 5] = [
        &["ordinary", "extraordinary"],
        &["sellmeier"],
        &["cauchy"],
        &["drude", "lorentz", "permittivity_infinity"],
        &["lorentz", "permittivity_infinity"],
    ];
    let has = |name| keys.iter().any(|key| key.name == name);
    let mut ways = if has("biaxial") {
        MEDIUM.to_vec()
    } else if has("cauchy") {
        LAW.to_vec()
    } else if has("index") && has("material") {
        METAL.to_vec()
    } else {
        Vec::new()
    };
    if has("biaxial") && has("metal") {
        ways.push(&["metal"]);
    }
    ways
}

/// Keys without which the others of their table mean nothing.
const NEEDED: [&str; 8] = [
    "ordinary",
    "extraordinary",
    "indices",
    "strength",
    "pole_um2",
    "plasma_ev",
    "resonance_ev",
    "thickness_nm",
];

/// A value of a key, allowed as a rule.
fn value(draws: &mut Draws<'_>, key: &'static Key) -> Value {
    use cloakroom::keys::Value as Default;
    let limits = key.limits;
    let (min, max) = match limits {
        ValueRange::Whole(min, max) => (min, max),
        _ => (i64::MIN, i64::MAX),
    };
    let default = (key.default)();
    let usual = |value: &Default| value.as_number().unwrap_or(1.5);
    let usual_integer = |value: &Default| value.as_integer().unwrap_or(0);
    let number = default.as_ref().map_or(1.5, usual);
    let integer = default.as_ref().map_or(0, usual_integer);
    let items = default.as_ref().and_then(Default::as_list).unwrap_or_default();
    match key.kind {
        KeyKind::Number => draws.number(number, limits).into(),
        KeyKind::Integer => match draws.below(4) {
            0 => integer,
            1 => draws.integer().clamp(min, max),
            2 => (integer + draws.below(5) as i64).clamp(min, max),
            _ => draws.integer(),
        }
        .into(),
        KeyKind::Flag => draws.chance(128).into(),
        KeyKind::Choice { options } => (*draws.pick(options)).into(),
        KeyKind::Choices { options } => {
            let count = draws.below(options.len() + 1);
            (0..count).map(|_| Value::from(*draws.pick(options))).collect::<Vec<_>>().into()
        }
        KeyKind::Vector => {
            let usual = |i: usize| items.get(i).map_or(1.5, usual);
            (0..3).map(|i| draws.number(usual(i), limits).into()).collect::<Vec<Value>>().into()
        }
        KeyKind::IntegerPair => {
            let number = |item| {
                let small = usual_integer(item).min(40).clamp(min, max);
                Value::from(if draws.chance(60) { draws.integer() } else { small })
            };
            Value::Array(items.iter().map(number).collect())
        }
        KeyKind::Interval => {
            let low = draws.number(number, limits);
            vec![low, low + draws.between(-0.2, 2.0)].into()
        }
        KeyKind::Image => (*draws.pick(&[
            "builtin:bookshelf",
            "builtin:room",
            "nowhere.png",
            "builtin:",
            "",
            "/",
        ]))
        .into(),
        KeyKind::ChoiceOrNumber { options } => match draws.below(2) {
            0 => (*draws.pick(options)).into(),
            _ => draws.number(30.0, ValueRange::Finite).into(),
        },
        KeyKind::ChoiceNumberOrTable { options, keys } => match draws.below(4) {
            0 | 1 => (*draws.pick(options)).into(),
            2 => draws.number(550.0, limits).into(),
            _ => Value::Table(table(draws, keys, 120)),
        },
        KeyKind::Tensor => tensor(draws),
        KeyKind::Complex => match draws.below(4) {
            0 | 1 => draws.number(1.5, limits).into(),
            2 => Value::from([1.5, LOSS].map(|usual| draws.number(usual, limits)).to_vec()),
            _ => Value::from([1.5, 2.0].map(|usual| draws.number(usual, limits)).to_vec()),
        },
        KeyKind::Direction => match draws.below(2) {
            0 => draws.number(30.0, limits).into(),
            _ => vector(draws),
        },
        KeyKind::Axes if draws.chance(20) => {
            (0..3).map(|_| vector(draws)).collect::<Vec<_>>().into()
        }
        KeyKind::Axes => {
            let frame = draws.pose().rotation().to_cols_array_2d();
            frame.map(|axis| axis.to_vec()).to_vec().into()
        }
        KeyKind::Material => material(draws),
        KeyKind::MaterialOrTable { keys } => match draws.below(3) {
            0 => Value::Table(table(draws, keys, 60)),
            _ => material(draws),
        },
        KeyKind::Mesh => (*draws.pick(&["nowhere.stl", "/", "a.glb"])).into(),
        KeyKind::Name => (*draws.pick(&["left", "right", "a_1", "", "1"])).into(),
        KeyKind::Polygon => polygon(draws),
        KeyKind::Samples { dimensions } => samples(draws, limits, dimensions),
        KeyKind::Table { keys } => Value::Table(table(draws, keys, 128)),
        KeyKind::FlagOrTable { keys } => match draws.below(2) {
            0 => draws.chance(128).into(),
            _ => Value::Table(table(draws, keys, 230)),
        },
        KeyKind::Tables { keys } => {
            let (coating, count) = (key.name == COATING, 1 + draws.below(4));
            if coating && !draws.chance(30) {
                return (0..count).map(|_| layer(draws)).collect::<Vec<_>>().into();
            }
            (0..count).map(|_| Value::Table(table(draws, keys, 100))).collect::<Vec<_>>().into()
        }
    }
}

/// A layer of a coating, from nothing to what no light gets through, of a dielectric, a metal or a
/// crystal.
fn layer(draws: &mut Draws<'_>) -> Value {
    let thickness = if draws.chance(20) { 0.0 } else { 10f64.powf(draws.between(0.0, 4.5)) };
    let (name, value) = match draws.below(3) {
        0 => ("index", draws.between(0.1, 4.0).into()),
        1 => ("index", vec![draws.between(0.0, 3.0), draws.between(0.0, 8.0)].into()),
        _ => ("permittivity", tensor(draws)),
    };
    Value::Table(Table::from_iter([
        ("thickness_nm".to_owned(), thickness.into()),
        (name.to_owned(), value),
    ]))
}

/// A material, as a rule one that comes with the program.
fn material(draws: &mut Draws<'_>) -> Value {
    if draws.chance(20) {
        return (*draws.pick(&["glas", "", "nowhere.yml", "/"])).into();
    }
    (*draws.pick(&Material::NAMES)).into()
}

/// Three numbers, as a rule those of a direction.
fn vector(draws: &mut Draws<'_>) -> Value {
    let number = |draws: &mut Draws<'_>| draws.number(1.0, ValueRange::Within(-1.0, 1.0));
    vec![number(draws), number(draws), number(draws)].into()
}

/// Gives a device of a graded medium what agrees with the dimensions of its index: in space a
/// length and no core; often a ratio of indices, with optic axes that turn little from sample to
/// sample.
fn fields(draws: &mut Draws<'_>, device: &mut Table) {
    let index = samples(draws, ValueRange::Between(0.5, 3.0), [2, 3]);
    let sides = sides(&index);
    let in_space = sides.len() == 3;
    device.insert("index".to_owned(), index);
    if in_space {
        device.insert("length".to_owned(), draws.between(10.0, 60.0).into());
    } else if device.get("shape").and_then(Value::as_str) == Some("ball") {
        device.remove("shape");
    }
    let is_uniaxial = draws.chance(128);
    if is_uniaxial || in_space {
        device.remove("inner");
    }
    for (key, dimensions) in [("ratio", 0), ("optic_axis", 1)] {
        device.remove(key);
        if is_uniaxial {
            let of_sides = if draws.chance(128) { &sides[..] } else { &[] };
            let field = match dimensions {
                0 => grid(draws, ValueRange::Between(0.5, 2.0), of_sides),
                _ => turning(draws, of_sides),
            };
            device.insert(key.to_owned(), field);
        }
    }
}

/// The sides of a grid.
fn sides(grid: &Value) -> Vec<usize> {
    match grid.as_array() {
        Some(items) => {
            let rest = items.first().map(sides).unwrap_or_default();
            [items.len()].into_iter().chain(rest).collect()
        }
        None => Vec::new(),
    }
}

/// Directions or angles on a grid of these sides, that turn little from sample to sample.
fn turning(draws: &mut Draws<'_>, sides: &[usize]) -> Value {
    fn laid(sides: &[usize], at: &mut Vec<f64>, value: &dyn Fn(&[f64]) -> Value) -> Value {
        let [side, rest @ ..] = sides else { return value(at) };
        let row = (0..*side).map(|number| {
            at.push(number as f64);
            let item = laid(rest, at, value);
            at.pop();
            item
        });
        row.collect::<Vec<_>>().into()
    }
    let pose = draws.pose().rotation();
    let (start, turns) = (draws.between(-180.0, 180.0), [0; 3].map(|_| draws.between(-15.0, 15.0)));
    let angle =
        move |at: &[f64]| start + at.iter().zip(turns).map(|(at, turn)| at * turn).sum::<f64>();
    let direction = move |at: &[f64]| {
        let (sin, cos) = angle(at).to_radians().sin_cos();
        (pose * DVec3::new(cos, sin, 0.0)).to_array().to_vec().into()
    };
    match draws.chance(128) {
        true => laid(sides, &mut Vec::new(), &direction),
        false => laid(sides, &mut Vec::new(), &|at| angle(at).into()),
    }
}

/// Numbers on a grid, mostly near one another.
fn samples(draws: &mut Draws<'_>, limits: ValueRange, [least, most]: [usize; 2]) -> Value {
    let dimensions = least + draws.below(most - least + 1);
    let sides: Vec<usize> =
        (0..dimensions)
            .map(|_| {
                if draws.chance(8) {
                    3
                } else {
                    4 + draws.below(if dimensions > 2 { 2 } else { 6 })
                }
            })
            .collect();
    grid(draws, limits, &sides)
}

fn grid(draws: &mut Draws<'_>, limits: ValueRange, sides: &[usize]) -> Value {
    let [side, rest @ ..] = sides else {
        let number = match draws.chance(1) {
            true => draws.number(1.5, limits),
            false => draws.between(0.8, 1.6),
        };
        return number.into();
    };
    (0..*side).map(|_| grid(draws, limits, rest)).collect::<Vec<_>>().into()
}

/// The devices of a scene that must be sound.
pub(crate) fn assembly(scene: &str) -> Assembly {
    let told = |error: &dyn Display| -> ! { panic!("{error}\n{scene}") };
    let loaded = scene_file::parse(scene, "scene", Path::new("/nowhere"), &[]);
    let loaded = loaded.unwrap_or_else(|error| told(&error));
    render::assembly(&loaded.scene).unwrap_or_else(|error| told(&error))
}

/// The keys of a device's pose that put its origin and its axes to where they are given.
pub(crate) fn placed(origin: DVec3, rotation: &DMat3) -> String {
    // The axis is turned along; what is left is a rotation about it.
    let axis = rotation.z_axis;
    let upright = Pose::with_axis(DVec3::ZERO, 0.0, axis).rotation().transpose() * *rotation;
    let turn = upright.x_axis.y.atan2(upright.x_axis.x).to_degrees();
    let (origin, axis) = (origin.to_array(), axis.to_array());
    format!("position = {origin:?}\nrotation = {turn:?}\naxis = {axis:?}\n")
}

/// A symmetric tensor of any orientation with principal values in an interval, as in a scene file.
pub(crate) fn tensor_near(draws: &mut Draws<'_>, low: f64, high: f64) -> String {
    let turn = draws.pose().rotation();
    let values = DVec3::from_array([0; 3].map(|_| draws.between(low, high)));
    let tensor = turn * DMat3::from_diagonal(values) * turn.transpose();
    format!("{:?}", ((tensor + tensor.transpose()) * 0.5).to_cols_array_2d())
}

/// A permittivity or a permeability: scalar, diagonal or full; mostly lossless and definite.
pub(crate) fn tensor(draws: &mut Draws<'_>) -> Value {
    let pair = |re: f64, im: f64| Value::Array(vec![re.into(), im.into()]);
    let shape = draws.below(6);
    let mut lossy = draws.chance(60);
    let principal = |draws: &mut Draws<'_>| {
        let sign = if draws.chance(40) { -1.0 } else { 1.0 };
        draws.number(1.5, ValueRange::Finite) * sign
    };
    let loss = |draws: &mut Draws<'_>| {
        if lossy { draws.number(LOSS, ValueRange::Within(0.0, f64::MAX)) } else { 0.0 }
    };
    match shape {
        0 | 1 => principal(draws).into(),
        2 => pair(principal(draws), loss(draws)),
        _ => {
            let mut re = [[0.0; 3]; 3];
            let mut im = [[0.0; 3]; 3];
            for i in 0..3 {
                (re[i][i], im[i][i]) = (principal(draws), loss(draws));
            }
            // Equal principal values are special.
            if draws.chance(100) {
                re[1][1] = re[0][0];
                im[1][1] = im[0][0];
            }
            if shape > 3 {
                for [i, j] in [[0, 1], [0, 2], [1, 2]] {
                    let off = draws.between(-0.7, 0.7) * (re[i][i] * re[j][j]).abs().sqrt();
                    let off_loss = draws.between(-0.7, 0.7) * (im[i][i] * im[j][j]).abs().sqrt();
                    (re[i][j], im[i][j]) = (off, off_loss);
                    if !draws.chance(8) {
                        (re[j][i], im[j][i]) = (off, off_loss);
                    }
                }
            }
            lossy = lossy || im.iter().flatten().any(|part| *part != 0.0);
            let entry = |i: usize, j: usize| {
                if lossy { pair(re[i][j], im[i][j]) } else { re[i][j].into() }
            };
            let row = |i: usize| Value::Array((0..3).map(|j| entry(i, j)).collect());
            Value::Array((0..3).map(row).collect())
        }
    }
}

/// A polygon: around a point as a rule, and else of any corners.
fn polygon(draws: &mut Draws<'_>) -> Value {
    let count = 3 + draws.below(5);
    let wild = draws.chance(30);
    let middle = [draws.between(-8.0, 8.0), draws.between(-8.0, 8.0)];
    let corner = |i: usize, draws: &mut Draws<'_>| {
        let corner = if wild {
            [draws.number(3.0, ValueRange::Finite), draws.number(3.0, ValueRange::Finite)]
        } else {
            let angle = TAU * (i as f64 + draws.between(-0.4, 0.4)) / count as f64;
            let radius = draws.between(0.5, 8.0);
            // Neighbours that share an edge are common in designs, and so are round numbers.
            let round = |x: f64| if draws.chance(100) { x.round() } else { x };
            [middle[0] + radius * angle.cos(), middle[1] + radius * angle.sin()].map(round)
        };
        Value::Array(corner.map(Value::from).to_vec())
    };
    let corners: Vec<Value> = (0..count).map(|i| corner(i, draws)).collect();
    corners.into()
}
