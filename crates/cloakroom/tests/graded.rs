//! A graded index of one's own, as a scene has it, against rays known in closed form.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::rays::{self, strongest, try_bench};
use cloakroom::render::PreparedSceneError;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};
use ndarray::Array2;
use ndarray_npy::WriteNpyExt;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;

/// A device of the index on a grid of so many steps either way, with more of its keys.
fn device(index: impl Fn(DVec2) -> f64, size: f64, steps: usize, keys: &str) -> String {
    let mut text = format!(
        "[[device]]\nkind = \"graded\"\nwidth = {size:?}\nheight = {size:?}\n{keys}\nindex = ["
    );
    let at = |k: usize| size * (k as f64 / steps as f64 - 0.5);
    for i in 0..=steps {
        text += "[";
        for j in 0..=steps {
            write!(text, "{:?}, ", index(DVec2::new(at(i), at(j)))).unwrap();
        }
        text += "],\n";
    }
    text + "]\n"
}

fn leaf(text: &str, origin: DVec3, direction: DVec3) -> Leaf<2> {
    let assembly = try_bench(text).unwrap();
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-10 });
    let across = direction.cross(DVec3::Z).normalize();
    let electric = [across.into(), direction.cross(across).into()];
    let (leaves, _) = tracer.trace(&Launch { origin, direction, electric });
    strongest(leaves)
}

/// Maxwell's fish-eye as a rod: n = 2/(1 + r²/R²) is 1 at the border, and in the plane across a ray
/// leaves at the point opposite to where it has come in, with the optical path πR.
fn fisheye_off(steps: usize) -> f64 {
    const R: f64 = 10.0;
    let index = |p: DVec2| 2.0 / (1.0 + p.length_squared() / (R * R));
    let text = device(index, 2.0 * R, steps, "shape = \"circle\"");
    let heights = [-9.3, -7.0, -2.2, 0.4, 3.1, 5.7, 8.8];
    let off = heights.map(|y: f64| {
        let entry = DVec3::new(-(R * R - y * y).sqrt(), y, 0.3);
        let leaf = leaf(&text, entry.with_x(-30.0), DVec3::X);
        let x = entry.with_z(0.0) / R;
        let direction = 2.0 * DVec3::X.dot(x) * x - DVec3::X;
        let exit = DVec3::new(-entry.x, -entry.y, entry.z);
        let path = leaf.optical_path - (30.0 + entry.x) - PI * R;
        (leaf.position - exit).length().max((leaf.direction - direction).length()).max(path.abs())
    });
    off.into_iter().fold(0.0, f64::max)
}

#[test]
fn a_sampled_fisheye_images_each_point_to_its_opposite() {
    let off = [24, 48, 96].map(fisheye_off);
    // From grid to grid it depends on where the rays pass between the samples.
    let order = (off[0] / off[2]).log2() / 2.0;
    assert!(off[2] < 1e-5 && order > 3.5, "{off:?} {order}");
}

#[test]
fn the_border_refracts_and_reflects_as_the_index_asks_for() {
    // A box of one index, on a grid, is a body of it.
    let box_of_glass =
        "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [12, 12, 9]\npermittivity = 2.25\n";
    let graded = device(|_| 1.5, 12.0, 5, "length = 9");
    let [a, b] = [box_of_glass, &graded].map(|text| try_bench(text).unwrap());
    let limits = Limits { min_power: 1e-7, tolerance: 1e-9 };
    let (mut glass, mut graded) = (Tracer::new(&a, limits), Tracer::new(&b, limits));
    let mut branches = 0;
    for launch in rays::launches_around(200, [40.0, 30.0], DVec3::splat(5.0)) {
        let (expected, _) = glass.trace(&launch);
        let (found, outcome) = graded.trace(&launch);
        assert_eq!(outcome.stats.lost, 0);
        let strong = |leaf: &&Leaf<2>| leaf.power[0] + leaf.power[1] > 1e-6;
        for leaf in expected.iter().filter(strong) {
            let same = found.iter().any(|other| {
                let off = (leaf.direction - other.direction).length().max(
                    (0..2).map(|i| (leaf.power[i] - other.power[i]).abs()).fold(0.0, f64::max),
                );
                off < 1e-9
                    && (!leaf.met_device
                        || (leaf.position - other.position).length() < 1e-8
                            && (leaf.optical_path - other.optical_path).abs() < 1e-8)
            });
            assert!(same, "{launch:?} {leaf:?} {found:?}");
            branches += 1;
        }
    }
    assert!(branches > 500, "{branches}");
}

#[test]
fn a_file_holds_what_rows_do() {
    let folder = tempfile::tempdir().unwrap();
    let index = |p: DVec2| 1.2 + 0.02 * p.x - 0.01 * p.y;
    let rows = device(index, 10.0, 6, "");
    let at = |k: usize| 10.0 * (k as f64 / 6.0 - 0.5);
    let array = Array2::from_shape_fn((7, 7), |(i, j)| index(DVec2::new(at(i), at(j))));
    array.write_npy(std::fs::File::create(folder.path().join("n.npy")).unwrap()).unwrap();
    let text = "[[device]]\nkind = \"graded\"\nwidth = 10\nheight = 10\nindex = \"n.npy\"\n";
    let scene = scene_file::parse(text, "a", folder.path(), &[]).unwrap().scene;
    let assembly = cloakroom::render::assembly(&scene).unwrap();
    let launch = rays::launches_around(1, [30.0, 20.0], DVec3::splat(2.0)).next().unwrap();
    let limits = Limits { min_power: 1e-6, tolerance: 1e-6 };
    let found = Tracer::new(&assembly, limits).trace(&launch).0.to_vec();
    let other = try_bench(&rows).unwrap();
    assert_eq!(found, Tracer::new(&other, limits).trace(&launch).0.to_vec());
}

#[test]
fn what_is_no_index_is_refused() {
    let refused = |keys: &str, part: &str| {
        let text = format!("[[device]]\nkind = \"graded\"\n{keys}");
        let message = match scene_file::parse(&text, "a", Path::new(""), &[]) {
            Err(error) => error.to_string(),
            Ok(loaded) => match cloakroom::render::assembly(&loaded.scene) {
                Err(PreparedSceneError::Device { error, .. }) => error.to_string(),
                other => panic!("{keys}: {other:?}"),
            },
        };
        assert!(message.contains(part), "{keys}: {message}");
    };
    let flat = "index = [[1, 1, 1, 1], [1, 1, 1, 1], [1, 1, 1, 1], [1, 1, 1, 1]]\n";
    refused("", "there is no `index`");
    refused("index = [[1, 1, 1], [1, 1, 1]]", "2 x 3 samples is too small");
    refused("index = [[1, 1], [1]]", "row 1 has 1 numbers, row 0 has 2");
    refused("index = []", "there are no numbers");
    refused("index = [1, 2]", "index is [1, 2]; it must be rows of numbers");
    refused("index = [[1, 0]]", "index[0][1] is 0; it must be above 0 and below 1000");
    refused("index = [[1, nan]]", "index[0][1] is not a number");
    refused("index = [[1, \"a\"]]", "index[0][1] is \"a\"; it must be a number");
    refused("index = \"no.npy\"", "cannot read no.npy");
    refused("index = \"\"", "index is empty");
    refused(&format!("{flat}inner = 20"), "inner is 20 cm; it must be at most 19.98 cm");
    refused(&format!("{flat}core = \"open\""), "no core to open");
    refused(&format!("{flat}show = \"bare\""), "hides no metal");
    refused(&format!("{flat}imperfection = {{ error = 0.1 }}"), "given on a grid");
    let steep = "index = [[1, 1, 1, 1, 1], [1, 1, 9, 1, 1], [1, 9, 0.1, 9, 1], [1, 1, 9, 1, 1], [1, 1, 1, 1, 1]]";
    refused(steep, "between the samples the index falls to 0");
}
