//! Interpolated leaves against those of the same rays traced one by one.

use super::*;
use crate::render::{Arrivals, ChannelSet, sampling};
use crate::scene::Scene;
use crate::scene_file;
use std::path::Path;

/// The largest errors of interpolated leaves: of the place on the photograph times the power, cm;
/// of the power; of the optical path times the power, cm; and how many rays have other leaves.
#[derive(Debug, Default)]
struct Errors {
    place: f64,
    power: f64,
    path: f64,
    rays: u32,
    others: u32,
}

fn scene(toml: &str) -> Scene {
    scene_file::parse(toml, "test", Path::new(""), &[]).expect("a scene").scene
}

/// Compares the leaves of every sample of every so many-th block of the patches of a part of the
/// picture.
fn errors<const N: usize>(
    scene: &Scene,
    detection: &Detection<N>,
    corner: [usize; 2],
    (count, step): (usize, usize),
) -> Errors {
    let prepared = PreparedScene::new(scene).expect("sound");
    let tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(prepared.screen);
    let tracer = if detection.wants_group_paths() { tracer.with_group_delays() } else { tracer };
    let mut exact = tracer.clone();
    let mut patches = LeafPatches::new(&prepared, detection, &tracer, 4).expect("interpolated");
    let mut errors = Errors::default();
    for number in 0..count {
        let patch = Patch { corner: [corner[0] + number * SIDE, corner[1]], size: [SIDE; 2] };
        compare(&mut patches, (patch, 0), &mut exact, step, &mut errors);
    }
    errors
}

fn compare<const N: usize>(
    patches: &mut LeafPatches<'_, N>,
    (patch, level): (Patch, usize),
    exact: &mut Tracer<'_, N>,
    step: usize,
    errors: &mut Errors,
) {
    if patches.fit(patch, level) == Fit::Alone {
        return;
    }
    if let Some(halves) = patches.division() {
        for half in halves {
            compare(patches, (half, level + 1), exact, step, errors);
        }
        return;
    }
    let prepared = patches.prepared;
    let camera = &prepared.scene.camera;
    let blocks = (0..patch.size[1] / 2).flat_map(|j| (0..patch.size[0] / 2).map(move |i| [i, j]));
    for [i, j] in blocks.step_by(step) {
        let block = [patch.corner[0] / 2 + i, patch.corner[1] / 2 + j];
        for sample in 0..camera.samples {
            let offset = sampling::offset(sample, camera.samples, block.map(|b| b as u32), 0);
            let points: [[f64; 2]; 4] = std::array::from_fn(|k| {
                [
                    (2 * block[0] + k % 2) as f64 + offset[0],
                    (2 * block[1] + k / 2) as f64 + offset[1],
                ]
            });
            let rays = points.map(|[x, y]| camera.ray(x, y));
            if !patches.sample(&points, &rays) {
                continue;
            }
            for (k, ray) in rays.iter().enumerate() {
                let (leaves, _) = exact.trace(&patches.detection.launch(camera, ray));
                errors.rays += 1;
                let mut same = true;
                for leaf in leaves {
                    let found = patches.samples[k].0.iter().find(|found| found.path == leaf.path);
                    let Some(found) = found else {
                        same &= leaf.largest_power() < 1.1 * prepared.limits.min_power;
                        continue;
                    };
                    let distance = leaf.distance_to(&prepared.screen).unwrap_or(100.0);
                    let place = |leaf: &Leaf<N>| leaf.position + leaf.direction * distance;
                    let power = leaf.largest_power();
                    let off = place(leaf).distance(place(found)) * power;
                    errors.place = errors.place.max(off);
                    let path = (leaf.optical_path - found.optical_path).abs() * power;
                    errors.path = errors.path.max(path);
                    // One that is known and one that is not are infinitely far apart.
                    let group_path = match (leaf.group_path, found.group_path) {
                        (Some(leaf), Some(found)) => (leaf - found).abs() * power,
                        (None, None) => 0.0,
                        _ => f64::INFINITY,
                    };
                    errors.path = errors.path.max(group_path);
                    let powers = leaf.power.iter().zip(found.power);
                    errors.power = powers.map(|(a, b)| (a - b).abs()).fold(errors.power, f64::max);
                }
                for found in &patches.samples[k].0 {
                    if !leaves.iter().any(|leaf| leaf.path == found.path) {
                        same &= found.largest_power() < 1.1 * prepared.limits.min_power;
                    }
                }
                errors.others += u32::from(!same);
            }
        }
    }
}

/// Devices with what makes rays part: edges, total reflection, caustics, mirrors.
const DEVICES: [&str; 6] = [
    "kind = 'square-cloak'\nmaterial = 'positive-uniaxial'",
    "kind = 'square-cloak'\nmaterial = 'negative-uniaxial'\nrotation = 10",
    "kind = 'double-gaussian-cloak'\nrotation = 10",
    "kind = 'cylinder-cloak'\nmaterial = 'radial-uniaxial'\nrotation = 5",
    "kind = 'gaussian-carpet'\nrotation = 3",
    "kind = 'body'\nshape = 'sphere'\nradius = 5\npermittivity = 2.25",
];

/// Everything but paths, which pictures do without.
#[test]
fn interpolated_leaves_are_those_of_traced_rays() {
    let mut rays = 0;
    for device in DEVICES {
        for corner in [[96, 480], [512, 288], [320, 416], [416, 512]] {
            let text =
                format!("[camera]\nresolution = [1024, 1024]\nsamples = 4\n[[device]]\n{device}\n");
            let scene = scene(&text);
            let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Image, &scene.picture);
            let errors = errors(&scene, &detection, corner, (2, 13));
            rays += errors.rays;
            let is_true = errors.place < 1e-6 && errors.power < 2e-6 && errors.others == 0;
            assert!(is_true, "{device} {corner:?}: {errors:?}");
        }
    }
    assert!(rays > 5000, "{rays} rays are hardly a trial");
}

/// A patch is given up where one of its rays never ends; of those beside it nothing is left for the next patch.
/// Along the axis such rays are at the nodes of patches.
#[test]
fn of_a_patch_that_is_given_up_nothing_is_left() {
    let device = "kind = 'square-cloak'\nmaterial = 'negative-uniaxial'";
    let text = format!("[camera]\nresolution = [640, 480]\nsamples = 4\n[[device]]\n{device}\n");
    let scene = scene(&text);
    let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Image, &scene.picture);
    for corner in [[288, 224], [320, 224], [320, 192], [320, 160]] {
        let errors = errors(&scene, &detection, corner, (1, 1));
        let is_true = errors.place < 1e-6 && errors.power < 2e-6 && errors.others == 0;
        assert!(is_true && errors.rays > 3000, "{corner:?}: {errors:?}");
    }
}

/// Where rays at nodes run right into an edge, one face may be said to be met and the other be taken.
#[test]
fn rays_that_run_into_an_edge_mislead_no_others() {
    let cloak = "kind = 'square-cloak'\ncore = 'open'\nrotation = 90";
    let ball = "kind = 'body'\nshape = 'sphere'\nradius = 2\nposition = [0, 0.1, 0]\nmetal = true";
    let text = format!(
        "[camera]\nresolution = [320, 240]\nsamples = 4\nfield_of_view = 26\n[[device]]\n{cloak}\n[[device]]\n{ball}\n"
    );
    let scene = scene(&text);
    let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Image, &scene.picture);
    let errors = errors(&scene, &detection, [0, 96], (3, 1));
    let is_true = errors.place < 1e-6 && errors.power < 2e-6 && errors.others == 0;
    assert!(is_true && errors.rays > 3000, "{errors:?}");
}

/// Light that goes through a lens again and again makes more and more of an error it comes with.
#[test]
fn what_is_curved_makes_nothing_of_errors() {
    let box_size = "[50.24546426953748, 31.038911051582545, 42.342594660585746]";
    let text = format!(
        "[camera]\nresolution = [1280, 720]\nsamples = 4\n[trace]\ntolerance = 1.7e-7\n[[device]]\nkind = 'eaton-lens'\ncore = 'metal'\n[[device]]\nkind = 'body'\nshape = 'box'\npermittivity = 3.0505107707343995\nsize = {box_size}\n"
    );
    let scene = scene(&text);
    let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Image, &scene.picture);
    let errors = errors(&scene, &detection, [576, 320], (2, 1));
    let is_true = errors.place < 1e-6 && errors.power < 2e-6 && errors.others == 0;
    assert!(is_true && errors.rays > 1000, "{errors:?}");
}

/// What it takes to share the rays of patches: the share of the picture that is traced nevertheless, and
/// how many branches are looked at to find that out, as a share of what all samples have.
fn price(scene: &Scene, corners: &[[usize; 2]]) -> [f64; 2] {
    let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Image, &scene.picture);
    let prepared = PreparedScene::new(scene).expect("sound");
    let tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(prepared.screen);
    let mut patches = LeafPatches::new(&prepared, &detection, &tracer, scene.camera.samples)
        .expect("interpolated");
    let mut single = tracer.clone().watched(Trail::default());
    let (mut traced, mut looked_at, mut of_samples) = (0.0, 0, 0.0);
    for corner in corners {
        let mut parts = vec![(Patch { corner: *corner, size: [SIDE; 2] }, 0)];
        while let Some((patch, level)) = parts.pop() {
            patches.ways.clear();
            let fit = patches.fit(patch, level);
            looked_at += patches.ways.looked_at();
            match patches.division().filter(|_| fit == Fit::Shared) {
                Some(halves) => parts.extend(halves.map(|half| (half, level + 1)).iter().rev()),
                None => {
                    let share = if fit == Fit::Shared { patches.traced() } else { 1.0 };
                    traced += share * (patch.size[0] * patch.size[1]) as f64;
                }
            }
        }
        // A ray of every sixteenth pixel.
        for (x, y) in (0..SIDE / 4).flat_map(|y| (0..SIDE / 4).map(move |x| (x, y))) {
            let [x, y] = [corner[0] + 4 * x, corner[1] + 4 * y].map(|pixel| pixel as f64 + 1.3);
            single.trace(&detection.launch(&scene.camera, &scene.camera.ray(x, y)));
            let branches = single.recorder().looked_at;
            single.recorder().clear();
            of_samples += 16.0 * f64::from(scene.camera.samples) * branches as f64;
        }
    }
    let pixels = (corners.len() * SIDE * SIDE) as f64;
    [traced / pixels, looked_at as f64 / of_samples]
}

/// Carpets of crystals, as they are made: rays of some hundred branches, most of which go everywhere.
#[test]
fn rays_in_carpets_of_crystals_are_shared() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../benches/compare/calcite_carpet.toml");
    let text = std::fs::read_to_string(file).expect("a scene");
    let text = text.replace("[camera]", "[camera]\nsamples = 16");
    let [traced, looked_at] = price(&scene(&text), &[[288, 416], [384, 448], [608, 416]]);
    assert!(traced < 0.2 && looked_at < 0.2, "{traced} of the rays, {looked_at} more branches");
}

/// Crystals that keep light, endless ones of which a single ray has hundreds of branches that no other
/// ray has: to find that out takes less than to trace them.
#[test]
fn it_is_found_out_in_time_that_rays_share_nothing() {
    let permittivities = [
        "[[7.2771692192, 0.3750111997, 0.6672569299], [0.3750111997, 7.0319291765, 0.4838432229], [0.6672569299, 0.4838432229, 7.6209016042]]",
        "[[2.5699886933, -0.1803018667, -0.1803018667], [-0.1803018667, 2.5699886933, -0.1803018667], [-0.1803018667, -0.1803018667, 2.5699886933]]",
    ];
    for permittivity in permittivities {
        let corners = "[[-7.9, -6.4], [7.9, -6.4], [7.9, 6.4], [-7.9, 6.4]]";
        let text = format!(
            "[camera]\nresolution = [160, 120]\nsamples = 4\n[[device]]\nkind = 'prisms'\nposition = [0, -8, 0]\nrotation = 69\n[[device.prism]]\ncorners = {corners}\npermittivity = {permittivity}\n"
        );
        let price = price(&scene(&text), &[[64, 0], [64, 32], [64, 64], [96, 0], [96, 32]]);
        assert!(price[1] < 0.5, "{permittivity}: {price:?}");
    }
}

/// With times, in a graded medium, and Stokes parameters.
#[test]
fn interpolated_paths_are_those_of_traced_rays() {
    let text = "[camera]\nresolution = [1024, 1024]\nsamples = 4\n[picture]\nchannels = ['stokes']\n[[device]]\nkind = 'double-gaussian-cloak'\nrotation = 10\n";
    let scene = scene(text);
    let detection = Detection::UNPOLARIZED.with_options(ChannelSet::Everything, &scene.picture);
    let errors = errors(&scene, &detection, [320, 416], (4, 11));
    let is_true = errors.place < 1e-6 && errors.path < 1e-6 && errors.others == 0;
    assert!(is_true && errors.rays > 1000, "{errors:?}");
}

/// Those of pulses.
#[test]
fn interpolated_paths_of_pulses_are_those_of_traced_rays() {
    let mut rays = 0;
    for device in DEVICES {
        let text =
            format!("[camera]\nresolution = [1024, 1024]\nsamples = 4\n[[device]]\n{device}\n");
        let scene = scene(&text);
        let detection = Detection::UNPOLARIZED.in_flight(Arrivals::default(), 0.0);
        let errors = errors(&scene, &detection, [320, 416], (2, 13));
        rays += errors.rays;
        let is_true = errors.place < 1e-6 && errors.path < 1e-6 && errors.others == 0;
        assert!(is_true, "{device}: {errors:?}");
    }
    assert!(rays > 1000, "{rays} rays are hardly a trial");
}

#[test]
fn long_and_steep_patches_have_more_nodes_along_their_short_side() {
    let shape = |size, steep| Patch { corner: [0; 2], size }.shape(steep);
    let shapes = |sizes: [[usize; 2]; 4], steep| sizes.map(|size| shape(size, steep));
    let by_far = |by_far| Steep { along: by_far, by_far };
    let flat = Steep::default();
    let sides = [5, 5, 4, 3].map(Shape::Square);
    assert_eq!(shapes([[32, 32], [8, 16], [8, 4], [4, 2]], flat), sides);
    assert_eq!(shapes([[32, 4], [32, 2], [16, 2], [64, 8]], flat), [Shape::Low; 4]);
    assert_eq!(shapes([[4, 32], [2, 32], [2, 16], [8, 64]], flat), [Shape::Narrow; 4]);
    let down = by_far([0, 1]);
    assert_eq!(shapes([[32, 32], [32, 16], [8, 8], [8, 4]], down), [Shape::Low; 4]);
    let across = by_far([2, 1]);
    assert_eq!(shapes([[32, 32], [16, 32], [8, 8], [4, 8]], across), [Shape::Narrow; 4]);
    // What is steep along the long side is divided that way, and what is nearly as steep both ways has
    // the most nodes.
    let most = [Shape::Square(MOST); 4];
    assert_eq!(shapes([[16, 32], [4, 8], [4, 4], [4, 2]], down), most);
    let along = Steep { along: [0, 2], by_far: [0; 2] };
    assert_eq!(shapes([[32, 32], [32, 16], [8, 8], [4, 4]], along), most);
    assert_eq!(shapes([[32, 32], [32, 16], [8, 8], [4, 4]], by_far([3; 2])), most);
}
