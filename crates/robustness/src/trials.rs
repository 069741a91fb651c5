//! The trials: bytes in, a panic if something is wrong.

use crate::cuts::cut_glass;
use crate::draws::Draws;
use crate::stacks::stack;
use crate::touching::touch_any;
use crate::{page, rays, scenes};
use cloakroom::assembly::Assembly;
use cloakroom::interface_json::{InterfaceRequest, solve_interfaces};
use cloakroom::output::{read_npz, read_png};
use cloakroom::photograph::{Edges, ImageSource, Pyramid, Texels, load_bytes};
use cloakroom::ray_json::{RayRequest, trace_rays};
use cloakroom::render;
use cloakroom::scene_file::{self, Loaded, Override};
use cloakroom::trace::{FourTracers, Launch, Limits, Tracer};
use cloakroom_figures::gallery::EXHIBITS;
use glam::DVec3;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use optics::interface::Scattering;
use optics::wave::transverse_basis;
use serde_json::{Value, json};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;

/// Something that any bytes may be given to.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Its name, that of its fuzz target.
    pub name: &'static str,
    /// Runs it on bytes; panics if something is wrong.
    pub run: fn(&[u8]),
    /// Inputs to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
}

/// Every trial.
pub static TRIALS: &[Trial] = &[
    Trial { name: "scene_file", run: scene_file, seeds: scene_texts },
    Trial { name: "trace_json", run: trace_json, seeds: ray_texts },
    Trial { name: "interface_json", run: interface_json, seeds: interface_texts },
    Trial { name: "interfaces", run: interfaces, seeds: random_bytes },
    Trial { name: "images", run: images, seeds: image_files },
    Trial { name: "picture_files", run: picture_files, seeds: picture_bytes },
    Trial { name: "page_messages", run: page::say, seeds: page::messages },
    Trial { name: "physics", run: physics, seeds: random_bytes },
    Trial { name: "touching", run: |bytes| drawn(bytes, touch_any), seeds: few_random_bytes },
    Trial { name: "cuts", run: |bytes| drawn(bytes, cut_glass), seeds: few_random_bytes },
    Trial { name: "stacks", run: |bytes| drawn(bytes, stack), seeds: few_random_bytes },
];

/// Branches weaker than this are not followed: trees of the trials end soon.
const LEAST_POWER: f64 = 1e-6;

/// Most pixels of an image: reading larger ones takes no other way, but longer.
const MOST_PIXELS: u64 = 1 << 20;

/// Most rays of a trial.
const MOST_RAYS: usize = 32;

/// Nothing there: scenes of trials find no files beside them.
fn nowhere() -> &'static Path {
    Path::new("/nowhere")
}

/// The text of a scene file, and, after a line `---`, overrides, one a line.
fn scene_file(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let (text, overrides) = text.split_once("\n---\n").unwrap_or((text, ""));
    let overrides: Vec<Override> = overrides.lines().map(Override::from).collect();
    match scene_file::parse(text, "a.toml", nowhere(), &overrides) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(loaded) => {
            let again = scene_file::parse(&loaded.scene.source, "b.toml", nowhere(), &[]);
            assert!(again.is_ok(), "what a picture says of its scene is no scene: {again:?}");
            look_at(&loaded);
        }
    }
}

/// Builds the devices of a scene and sends a few rays of its camera.
fn look_at(loaded: &Loaded) {
    let assembly = match render::assembly(&loaded.scene) {
        Ok(assembly) => assembly,
        Err(error) => {
            let told = loaded.locations.error_at(&error.key(), error.to_string());
            assert!(!told.to_string().is_empty());
            return;
        }
    };
    let camera = &loaded.scene.camera;
    let [width, height] = camera.resolution.map(f64::from);
    let launches = [(0.5, 0.5), (0.3, 0.6), (0.01, 0.99)].map(|(x, y)| {
        let ray = camera.ray(x * width, y * height);
        let (h, v) = camera.polarization_basis(ray.direction);
        Launch { origin: ray.origin, direction: ray.direction, electric: [h.into(), v.into()] }
    });
    trace(&assembly, render::limits(&loaded.scene), &launches);
}

/// Traces rays singly and four at a time: what must hold holds, and both ways agree to the last
/// bit.
fn trace(assembly: &Assembly, limits: Limits, launches: &[Launch<2>]) {
    let limits = Limits { min_power: limits.min_power.max(LEAST_POWER), ..limits };
    let mut tracer = rays::timed(Tracer::new(assembly, limits), assembly);
    let mut four = FourTracers::new(&tracer);
    let launches: Vec<Launch<2>> =
        launches.iter().filter(|launch| rays::starts_in_air(assembly, launch)).copied().collect();
    for launch in &launches {
        let (leaves, outcome) = tracer.trace(launch);
        if let Err(fault) = rays::examine(launch.origin, leaves, outcome) {
            panic!("{fault:?} of {launch:?}: {leaves:?}, {outcome:?}");
        }
    }
    for launches in launches.chunks_exact(4) {
        let Ok(launches) = <&[Launch<2>; 4]>::try_from(launches) else { continue };
        four.trace(launches);
        for (each, launch) in four.tracers.iter().zip(launches) {
            let (leaves, outcome) = tracer.trace(launch);
            assert_eq!(each.traced(), (leaves, outcome), "four at a time: {launch:?}");
        }
    }
}

/// Scenes that rays of `trace_json` are sent through: one of each kind of passage.
static ASSEMBLIES: LazyLock<Vec<Assembly>> = LazyLock::new(|| {
    let assemblies = EXHIBITS.iter().filter_map(|exhibit| {
        let loaded = scene_file::parse(exhibit.scene, exhibit.name, nowhere(), &[]).ok()?;
        render::assembly(&loaded.scene).ok()
    });
    assemblies.collect()
});

/// The rays of `cloakroom trace`, through one of the scenes of the gallery: the first byte says
/// which.
fn trace_json(bytes: &[u8]) {
    let Some((first, text)) = bytes.split_first() else { return };
    let assembly = &ASSEMBLIES[usize::from(*first) % ASSEMBLIES.len()];
    let Ok(mut requests) = serde_json::from_slice::<Vec<RayRequest>>(text) else { return };
    requests.truncate(MOST_RAYS);
    let limits = Limits { min_power: 1e-4, tolerance: 1e-6 };
    match trace_rays(assembly, limits, &requests, &AtomicBool::new(false)) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(reports) => {
            assert_eq!(reports.iter().count(), requests.len());
            for (report, request) in reports.iter().zip(&requests) {
                let leaves: f64 = report.leaves.iter().map(|leaf| leaf.power).sum();
                let account = leaves + report.absorbed + report.pruned;
                assert!((account - 1.0).abs() <= rays::BALANCE, "{account}: {request:?}");
                // JSON has no word for what is no number: it would say null.
                let said = serde_json::to_value(&report.leaves).expect("leaves are JSON");
                for leaf in said.as_array().into_iter().flatten() {
                    let leaf = leaf.as_object().expect("an object");
                    let known = leaf.iter().filter(|(name, _)| *name != "position");
                    known.for_each(|(name, value)| assert!(is_known(value), "{name}: {request:?}"));
                }
            }
        }
    }
}

/// Whether all of a value is there.
fn is_known(value: &Value) -> bool {
    match value {
        Value::Null => false,
        Value::Array(items) => items.iter().all(is_known),
        Value::Object(entries) => entries.values().all(is_known),
        _ => true,
    }
}

/// The text of `cloakroom interface`.
fn interface_json(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if solve_interfaces(text).is_ok()
        && let Ok(value) = serde_json::from_str::<Value>(text)
    {
        let items = value.as_array().cloned().unwrap_or_else(|| vec![value]);
        for item in items.iter().take(MOST_RAYS) {
            InterfaceRequest::read(item, "").iter().for_each(check_interface);
        }
    }
}

/// Interfaces of random media.
fn interfaces(bytes: &[u8]) {
    let mut draws = Draws::Bytes(bytes);
    let json = |value: toml::Value| serde_json::to_value(value).unwrap_or_default();
    let medium = |draws: &mut Draws<'_>| {
        json!({
            "permittivity": json(scenes::tensor(draws)),
            "permeability": if draws.chance(100) { json(scenes::tensor(draws)) } else { json!(1) },
        })
    };
    let incident = medium(&mut draws);
    let transmitted = if draws.chance(30) { json!("metal") } else { medium(&mut draws) };
    let normal = draws.direction();
    let (across, _) = transverse_basis(normal, DVec3::Z, DVec3::X);
    let size = draws.number(1.0, cloakroom::keys::ValueRange::Finite);
    let request = json!({
        "incident": incident, "transmitted": transmitted,
        "normal": normal.to_array(), "tangential": (across * size).to_array(),
    });
    InterfaceRequest::read(&request, "").iter().for_each(check_interface);
}

/// Every number of a solved interface is one, and the powers add up; the others are refused.
fn check_interface(request: &InterfaceRequest) {
    if let Err(error) = request.solve() {
        assert!(error.to_string().contains("double precision"), "{error}");
        return;
    }
    let InterfaceRequest { incident, transmitted, normal, tangential } = request;
    let solved = Scattering::new(incident, transmitted.as_ref(), *tangential, *normal);
    let modes = solved.incident.iter().chain(&solved.reflected);
    for mode in modes.chain(solved.transmitted.iter().flatten()) {
        let fields = [mode.wave_vector, mode.electric, mode.magnetic];
        let finite = fields.iter().all(|field| field.re.is_finite() && field.im.is_finite());
        assert!(finite && mode.poynting().is_finite(), "{mode:?}: {request:?}");
    }
    for (power, together) in solved.power.iter().zip(&solved.interference) {
        let Some((power, together)) = power.as_ref().zip(together.as_ref()) else { continue };
        let sum = power.iter().chain(together).sum::<f64>();
        // Light in an absorbing medium interferes with what is reflected, and that carries power,
        // too.
        let adds_up = incident.absorbs() || (sum - 1.0).abs() <= rays::BALANCE;
        let sound = power.iter().all(|share| share.is_finite() && *share >= 0.0) && adds_up;
        assert!(sound, "{power:?}: {request:?}");
    }
}

/// An image file.
fn images(bytes: &[u8]) {
    let source = ImageSource::File(PathBuf::from("a.png"));
    match load_bytes(&source, bytes, MOST_PIXELS) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(image) => {
            let pixels = image.width * image.height;
            let count = match &image.texels {
                Texels::Srgb8(codes) => codes.len(),
                Texels::Linear(values) => {
                    assert!(values.iter().all(|value| value.is_finite()));
                    values.len()
                }
            };
            assert!(pixels > 0 && count == 3 * pixels);
            let pyramid = Pyramid::new(image, Edges::Clamp);
            let _ = pyramid.sample([0.4, 0.6], [0.1, 0.02], [-0.01, 0.3]);
        }
    }
}

/// A file that a picture is read back from: NPZ and PNG.
fn picture_files(bytes: &[u8]) {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(bytes).and_then(|()| file.flush()).expect("written");
    let npz = read_npz(file.path()).map(drop);
    let png = read_png(file.path()).map(drop);
    for error in [npz, png].into_iter().filter_map(Result::err) {
        assert!(!error.to_string().is_empty());
    }
}

/// Random rays through random devices.
fn physics(bytes: &[u8]) {
    let mut draws = Draws::Bytes(bytes);
    let text = scenes::scene(&mut draws).to_string();
    let Ok(loaded) = scene_file::parse(&text, "a.toml", nowhere(), &[]) else { return };
    let Ok(assembly) = render::assembly(&loaded.scene) else { return };
    let count = 4 + draws.below(MOST_RAYS - 3);
    let reach = 10f64.powf(draws.between(-3.0, 4.0));
    let launches: Vec<Launch<2>> = (0..count).map(|_| rays::launch(&mut draws, reach)).collect();
    trace(&assembly, render::limits(&loaded.scene), &launches);
}

/// A scene that bytes choose.
fn drawn(bytes: &[u8], send: fn(&mut Draws<'_>) -> u64) {
    send(&mut Draws::Bytes(bytes));
}

fn scene_texts() -> Vec<Vec<u8>> {
    let overridden = |text: &str| format!("{text}\n---\ncamera.samples=1\ndevice.0.rotation=5");
    let exhibits = EXHIBITS.iter().map(|exhibit| overridden(exhibit.scene).into_bytes());
    let random = (0..40).map(|seed| scenes::scene(&mut Draws::Seed(seed)).to_string());
    exhibits.chain(random.map(String::into_bytes)).collect()
}

fn ray_texts() -> Vec<Vec<u8>> {
    let rays = json!([
        { "origin": [-100, 3, 0.5], "direction": [1, 0, 0] },
        { "origin": [-30.5, 1e1, 2], "direction": [2, -0.4, 0.1], "polarization": "vertical" },
        { "origin": [0, 60, 0], "direction": [0, -1, 0],
          "polarization": { "electric_field": [[0, 1], [0, 0], [1, 0]] } },
    ]);
    (0..ASSEMBLIES.len()).map(|i| [&[i as u8], rays.to_string().as_bytes()].concat()).collect()
}

fn interface_texts() -> Vec<Vec<u8>> {
    let glass = json!({ "permittivity": 2.25, "permeability": 1 });
    let lossy = json!({ "permittivity": [2.25, 0.1], "permeability": [1, 0.01] });
    let crystal =
        json!({ "permittivity": [[2, 0.1, 0], [0.1, 3, 0], [0, 0, 4]], "permeability": 1 });
    let general = json!({ "permittivity": [[2, 0.1, 0], [0.1, 3, 0], [0, 0, 4]],
                          "permeability": [[1.5, 0, 0], [0, [1, 0.1], 0.2], [0, 0.2, 3]] });
    let media = [glass, lossy, crystal, general];
    let pairs = media.iter().flat_map(|a| media.iter().map(move |b| (a, b.clone())));
    let metals = media.iter().map(|a| (a, json!("metal")));
    let text = |(incident, transmitted): (&Value, Value)| {
        json!({ "incident": incident, "transmitted": transmitted, "normal": [1, 0, 0],
                "tangential": [0, 0.3, 0.2] })
        .to_string()
        .into_bytes()
    };
    pairs.chain(metals).map(text).collect()
}

fn random_bytes() -> Vec<Vec<u8>> {
    let bytes = |seed: u64| {
        let mut draws = Draws::Seed(seed);
        (0..1500).map(|_| draws.below(256) as u8).collect()
    };
    (0..60).map(bytes).collect()
}

/// For trials that each send many rays.
fn few_random_bytes() -> Vec<Vec<u8>> {
    random_bytes().split_off(55)
}

/// Images of a few pixels, of every kind that can be read.
pub(crate) fn image_files() -> Vec<Vec<u8>> {
    let color = RgbImage::from_fn(9, 7, |x, y| Rgb([(x * 25) as u8, (y * 31) as u8, 90]));
    let color = DynamicImage::ImageRgb8(color);
    let write = |image: &DynamicImage, format| {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).expect("written");
        bytes.into_inner()
    };
    let pngs = [
        color.clone(),
        color.to_luma8().into(),
        color.to_luma_alpha8().into(),
        color.to_rgba8().into(),
        color.to_luma16().into(),
        color.to_rgba16().into(),
    ];
    let mut files: Vec<_> = pngs.iter().map(|image| write(image, ImageFormat::Png)).collect();
    files.push(write(&color, ImageFormat::Jpeg));
    files.push(write(&color.to_luma8().into(), ImageFormat::Jpeg));
    files.push(write(&color.to_rgb32f().into(), ImageFormat::OpenExr));
    files.push(write(&color.to_rgba32f().into(), ImageFormat::OpenExr));
    files
}

fn picture_bytes() -> Vec<Vec<u8>> {
    let scene = "[camera]\nresolution = [6, 4]\nsamples = 1\n[[device]]\nkind = 'square-cloak'\n";
    let Ok(loaded) = scene_file::parse(scene, "a.toml", nowhere(), &[]) else { return Vec::new() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let prepared = render::PreparedScene::new(&loaded.scene).expect("a sound scene");
    let stop = AtomicBool::new(false);
    let supervision = render::Supervision { rows_done: &|_| {}, stop: &stop };
    let rendered = render::render(&prepared, render::ChannelSet::Everything, &supervision);
    let picture = rendered.expect("a picture").picture;
    let file = |name: &str| {
        let path = folder.path().join(name);
        cloakroom::output::write(&picture, &path).expect("written");
        std::fs::read(path).expect("read")
    };
    vec![file("a.npz"), file("a.png")]
}
