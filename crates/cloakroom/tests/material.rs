//! The exported material against closed forms, and its files read back.

use cloakroom::material::{
    CellContent, Frame, MaterialError, Resolution, sample, segments, write_segments,
};
use cloakroom::output::{GridFile, GridValues, write_grid};
use cloakroom::render::{Supervision, assembly};
use cloakroom::scene_file;
use ndarray::{Array1, Array3, Array5};
use ndarray_npy::NpzReader;
use num_complex::Complex64;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn sampled(scene: &str, frame: Frame, resolution: Resolution) -> Result<GridFile, MaterialError> {
    let scene = scene_file::parse(scene, "scene", Path::new(""), &[]).expect("a scene").scene;
    let assembly = assembly(&scene).expect("a bench");
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    sample(&scene, &assembly, None, frame, resolution, &|_| {}, &supervision)
}

fn cells(scene: &str, frame: Frame, cells: [u32; 3]) -> GridFile {
    sampled(scene, frame, Resolution::Cells(cells)).expect("a grid")
}

/// A cell: middle, region, index, permittivity and permeability.
type Point = ([f64; 3], u8, f64, [[f64; 6]; 2]);

/// The values of all cells.
fn points(grid: &GridFile) -> Vec<Point> {
    let values =
        |name: &str| &grid.arrays.iter().find(|array| array.name == name).expect("an array").values;
    let (GridValues::Codes(regions, _), GridValues::Numbers(indices)) =
        (values("region"), values("index"))
    else {
        panic!("wrong kinds of values")
    };
    let (GridValues::SymmetricTensors(e), GridValues::SymmetricTensors(m)) =
        (values("permittivity"), values("permeability"))
    else {
        panic!("wrong kinds of values")
    };
    let [nx, ny, nz] = grid.grid.cells;
    assert_eq!(regions.len(), nx * ny * nz);
    (0..regions.len())
        .map(|i| {
            let at = [i % nx, i / nx % ny, i / (nx * ny)];
            let middle = [0, 1, 2]
                .map(|a| grid.grid.corner[a] + (at[a] as f64 + 0.5) * grid.grid.spacing[a]);
            (middle, regions[i], indices[i], [e[i], m[i]])
        })
        .collect()
}

fn near(found: [f64; 6], expected: [f64; 6], tolerance: f64) -> bool {
    found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= tolerance * (1.0 + e.abs()))
}

const SQUARE: &str = "[[device]]\nkind = \"square-cloak\"\n";

#[test]
fn the_square_cloak_has_the_tensors_of_its_map() {
    let kappa = 1.0 / 3f64.sqrt();
    let (d, scale) = (14.1 / 2f64.sqrt(), 1.0 / (1.0 - kappa));
    let [xx, yy, xy] = [scale, (kappa * kappa + (1.0 - kappa).powi(2)) * scale, -kappa * scale];
    let mut seen = [0; 3];
    for ([x, y, _], region, index, tensors) in points(&cells(SQUARE, Frame::Device, [39, 38, 1])) {
        // On the seam x = 0 either side may be meant.
        if x.abs() < 1e-9 {
            continue;
        }
        let (outer, inner) = (x.abs() + y.abs() - d, x.abs() / d + y.abs() / (kappa * d) - 1.0);
        let expected = if outer > 0.0 {
            CellContent::Air
        } else if inner < 0.0 {
            CellContent::Metal
        } else {
            CellContent::Material
        };
        assert_eq!(region, expected as u8, "{x} {y}");
        seen[usize::from(region)] += 1;
        let sign = (x * y).signum();
        match expected {
            CellContent::Material => {
                for tensor in tensors {
                    assert!(near(tensor, [xx, yy, scale, sign * xy, 0.0, 0.0], 1e-14), "{x} {y}");
                }
                // The determinant is that of the third principal value.
                assert!((index - scale.cbrt()).abs() < 1e-14);
            }
            CellContent::Metal => assert!(index.is_nan() && tensors[0][0].is_nan()),
            _ => assert_eq!((index, tensors[1]), (1.0, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0])),
        }
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

#[test]
fn the_cylinder_cloak_has_the_tensors_of_its_radii() {
    let scene = "[[device]]\nkind = \"cylinder-cloak\"\ncore = \"open\"\n";
    let (a, b) = (4.0, 10.0);
    let stretch = (b / (b - a)) * (b / (b - a));
    let mut hidden = 0;
    for ([x, y, _], region, _, tensors) in points(&cells(scene, Frame::Device, [33, 33, 1])) {
        let r = x.hypot(y);
        if r < a {
            hidden += 1;
            assert_eq!(region, CellContent::Hidden as u8);
        } else if r < b {
            let s = (r - a) / r;
            let (cos, sin) = (x / r, y / r);
            let expected = [
                s * cos * cos + sin * sin / s,
                s * sin * sin + cos * cos / s,
                stretch * s,
                (s - 1.0 / s) * sin * cos,
                0.0,
                0.0,
            ];
            assert!(
                near(tensors[0], expected, 1e-12) && near(tensors[1], expected, 1e-12),
                "{x} {y}"
            );
        }
    }
    assert!(hidden > 50);
}

#[test]
fn the_graded_cloak_has_the_index_of_its_map() {
    // n = c/|f'| with f = ζ + i h w_F(ζ/w), found here from the other side: at f(ζ).
    let (w, h) = (10.02, 4.25);
    let scene = "[[device]]\nkind = \"double-gaussian-cloak\"\n";
    for (keys, strength) in [("", 1.0), ("referenced = true\n", 1.145_6)] {
        let grid = cells(&format!("{scene}{keys}"), Frame::Device, [50, 56, 1]);
        let mut least = f64::INFINITY;
        for ([x, y, _], region, index, tensors) in points(&grid) {
            if region != CellContent::Material as u8 {
                continue;
            }
            least = least.min(index);
            assert!(near(
                tensors[0],
                [index * index, index * index, index * index, 0.0, 0.0, 0.0],
                1e-14
            ));
            // Newton's method with a numerical derivative, from the far field.
            let f = |zeta: Complex64| {
                zeta + Complex64::i() * h * errorfunctions::ComplexErrorFunctions::w(zeta / w)
            };
            let z = Complex64::new(x, y.abs());
            let mut zeta = z + h * w / (std::f64::consts::PI.sqrt() * z);
            let slope = |zeta: Complex64| {
                let step = 1e-4;
                let i = Complex64::i() * step;
                (f(zeta + step) - f(zeta - step) - Complex64::i() * (f(zeta + i) - f(zeta - i)))
                    / (4.0 * step)
            };
            for _ in 0..60 {
                let step = (f(zeta) - z) / slope(zeta);
                zeta -= step * (2.0 / (2.0 + step.norm())).min(1.0);
            }
            assert!((f(zeta) - z).norm() < 1e-9, "{x} {y}");
            let expected = strength / slope(zeta).norm();
            assert!((index - expected).abs() < 2e-5 * expected, "{x} {y}: {index} {expected}");
        }
        if strength > 1.0 {
            // Laser writing has no material below that of the surroundings.
            assert!((least - 1.0).abs() < 2e-3 && least >= 1.0, "{least}");
        }
    }
}

#[test]
fn the_frame_of_the_world_turns_grid_and_tensors() {
    let scene = format!("{SQUARE}rotation = 90\nposition = [5, 6, 7]\nlength = 4\n");
    // An odd number of cells, or some would lie on the border.
    let grid = cells(&scene, Frame::World, [21, 21, 3]);
    let middle = [0, 1, 2]
        .map(|a| grid.grid.corner[a] + 0.5 * grid.grid.spacing[a] * grid.grid.cells[a] as f64);
    assert!(middle.iter().zip([5.0, 6.0, 7.0]).all(|(m, e)| (m - e).abs() < 1e-12), "{middle:?}");
    assert!((grid.grid.spacing[2] - 4.0 / 3.0).abs() < 1e-12);
    let own = points(&cells(SQUARE, Frame::Device, [21, 21, 1]));
    let turned = points(&grid);
    for (i, (_, region, _, [e, _])) in turned.iter().take(441).enumerate() {
        // A point (x, y) of the world is (y, -x) in the device's frame.
        let (column, row) = (i % 21, i / 21);
        if column == 10 || row == 10 {
            continue;
        }
        let (_, own_region, _, [own_e, _]) = own[row + 21 * (20 - column)];
        assert_eq!(*region, own_region);
        if own_region == CellContent::Material as u8 {
            assert!(near(*e, [own_e[1], own_e[0], own_e[2], -own_e[3], 0.0, 0.0], 1e-13));
        }
    }
}

#[test]
fn absorption_is_kept() {
    let scene = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\npermittivity = [2.0, 0.1]\n";
    let grid = cells(scene, Frame::Device, [5, 5, 5]);
    let array = grid.arrays.iter().find(|array| array.name == "permittivity_imaginary");
    let Some(GridValues::SymmetricTensors(tensors)) = array.map(|array| &array.values) else {
        panic!("no imaginary part")
    };
    assert_eq!(tensors[62], [0.1, 0.1, 0.1, 0.0, 0.0, 0.0]);
    assert_eq!(tensors[0], [0.0; 6]);
}

#[test]
fn arrays_for_numpy_have_their_axes_in_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.npz");
    let grid = cells(SQUARE, Frame::Device, [6, 4, 2]);
    write_grid(&grid, &path).expect("written");
    let mut npz = NpzReader::new(std::fs::File::open(&path).expect("a file")).expect("an archive");
    let [x, y, z]: [Array1<f64>; 3] = ["x", "y", "z"].map(|name| npz.by_name(name).expect("axes"));
    let regions: Array3<u8> = npz.by_name("region").expect("regions");
    let index: Array3<f64> = npz.by_name("index").expect("indices");
    let e: Array5<f64> = npz.by_name("permittivity").expect("tensors");
    assert_eq!((regions.dim(), e.dim()), ((6, 4, 2), (6, 4, 2, 3, 3)));
    let shape = (0..2).flat_map(|k| (0..4).flat_map(move |j| (0..6).map(move |i| (i, j, k))));
    for ((i, j, k), (middle, region, n, [tensor, _])) in shape.zip(points(&grid)) {
        assert_eq!([x[i], y[j], z[k]], middle);
        assert_eq!(regions[(i, j, k)], region);
        assert_eq!(index[(i, j, k)].to_bits(), n.to_bits());
        let entries =
            [((0, 0), 0), ((1, 1), 1), ((2, 2), 2), ((0, 1), 3), ((2, 1), 4), ((2, 0), 5)];
        for ((row, column), entry) in entries {
            assert_eq!(e[(i, j, k, row, column)].to_bits(), tensor[entry].to_bits());
            assert_eq!(e[(i, j, k, column, row)].to_bits(), tensor[entry].to_bits());
        }
    }
    let metadata: Array1<u8> = npz.by_name("metadata").expect("metadata");
    let metadata: serde_json::Value = serde_json::from_slice(&metadata.to_vec()).expect("JSON");
    assert_eq!(metadata["region"], "0 air, 1 material, 2 metal, 3 hidden");
    assert_eq!(metadata["frame"], "device");
}

#[test]
fn vtk_files_are_sound_xml_with_their_bytes_in_place() {
    use base64::prelude::{BASE64_STANDARD, Engine};
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.vti");
    // Two hyphens in a scene must not end the comment it stands in.
    let grid = cells(&format!("# -- <b>\n{SQUARE}"), Frame::Device, [5, 4, 3]);
    write_grid(&grid, &path).expect("written");
    let text = std::fs::read_to_string(&path).expect("a text");
    let xml = roxmltree::Document::parse(&text).expect("XML");
    let root = xml.root_element();
    assert_eq!(root.attribute("type"), Some("ImageData"));
    let node = |name: &str| root.descendants().find(|n| n.has_tag_name(name)).expect("a node");
    assert_eq!(node("ImageData").attribute("WholeExtent"), Some("0 5 0 4 0 3"));
    let numbers = |text: Option<&str>| -> Vec<f64> {
        text.expect("numbers").split(' ').map(|n| n.parse().expect("a number")).collect()
    };
    assert_eq!(numbers(node("ImageData").attribute("Spacing")), grid.grid.spacing.to_array());
    assert_eq!(numbers(node("ImageData").attribute("Origin")), grid.grid.corner.to_array());
    let appended = node("AppendedData").text().expect("data").trim();
    let data = appended.strip_prefix('_').expect("the mark of the beginning");
    let expected = points(&grid);
    for array in root.descendants().filter(|n| n.has_tag_name("DataArray")) {
        let offset: usize = array.attribute("offset").expect("offset").parse().expect("a number");
        let components = array.attribute("NumberOfComponents").expect("components");
        let size = if array.attribute("type") == Some("UInt8") { 1 } else { 8 };
        let bytes = 60 * size * components.parse::<usize>().expect("a number");
        let letters = (bytes + 8).div_ceil(3) * 4;
        let block = BASE64_STANDARD.decode(&data[offset..offset + letters]).expect("base64");
        assert_eq!(block[..8], (bytes as u64).to_le_bytes());
        assert_eq!(block.len(), bytes + 8);
        let number =
            |i: usize| f64::from_le_bytes(block[8 + 8 * i..16 + 8 * i].try_into().expect("8"));
        for (i, (_, region, index, [_, m])) in expected.iter().enumerate() {
            match array.attribute("Name") {
                Some("region") => assert_eq!(block[8 + i], *region),
                Some("index") => assert_eq!(number(i).to_bits(), index.to_bits()),
                Some("permeability") => {
                    let found = [0, 4, 8, 1, 5, 2].map(|entry| number(9 * i + entry).to_bits());
                    assert_eq!(found, m.map(f64::to_bits));
                }
                _ => {}
            }
        }
    }
}

#[test]
fn tables_have_a_line_for_every_cell() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    let grid = cells(SQUARE, Frame::Device, [5, 4, 1]);
    write_grid(&grid, &path).expect("written");
    let text = std::fs::read_to_string(&path).expect("a text");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    assert_eq!(names[..6], ["x_cm", "y_cm", "z_cm", "region", "index", "permittivity_xx"]);
    assert_eq!(names.len(), 17);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 20);
    for (row, (middle, region, index, [e, _])) in rows.iter().zip(points(&grid)) {
        let number = |i: usize| row[i].parse::<f64>().expect("a number");
        assert_eq!([number(0), number(1), number(2)], middle);
        assert_eq!(row[3], CellContent::WORDS[usize::from(region)]);
        assert_eq!(number(4).to_bits(), index.to_bits());
        assert_eq!([5, 6, 7, 8, 9, 10].map(|i| number(i).to_bits()), e.map(f64::to_bits));
    }
}

#[test]
fn grids_fit_around_devices() {
    // Along z the cloak is endless: one layer as thick as the cells are wide.
    let grid = sampled(SQUARE, Frame::Device, Resolution::Spacing(0.5)).expect("a grid");
    assert_eq!((grid.grid.cells, grid.grid.corner[2]), ([40, 40, 1], -0.25));
    let grid = sampled(SQUARE, Frame::Device, Resolution::Default).expect("a grid");
    assert_eq!(grid.grid.cells, [64, 64, 1]);
    let ball = "[[device]]\nkind = \"luneburg-lens\"\nposition = [1, 2, 3]\n";
    let grid = sampled(ball, Frame::World, Resolution::Spacing(4.0)).expect("a grid");
    assert_eq!((grid.grid.cells, grid.grid.corner.to_array()), ([5, 5, 5], [-9.0, -8.0, -7.0]));
}

#[test]
fn what_cannot_be_given_is_said() {
    let device = |resolution| sampled(SQUARE, Frame::Device, resolution);
    assert_eq!(device(Resolution::Cells([0, 3, 3])), Err(MaterialError::EmptyGrid));
    assert_eq!(device(Resolution::Spacing(-1.0)), Err(MaterialError::EmptyGrid));
    let huge = device(Resolution::Spacing(1e-5));
    assert!(matches!(huge, Err(MaterialError::TooLarge { .. })), "{huge:?}");
    for finer in [Resolution::Cells([u32::MAX; 3]), Resolution::Spacing(1e-9)] {
        assert_eq!(device(finer), Err(MaterialError::TooFine));
    }
    for (scene, part) in [
        (format!("{SQUARE}show = \"bare\""), "bare metal"),
        ("[[device]]\nkind = \"mirror-detour\"".to_owned(), "metal alone"),
        ("[[device]]\nkind = \"body\"\nsurface = { color = [1, 1, 1] }".to_owned(), "opaque"),
        (format!("{SQUARE}{SQUARE}position = [40, 0, 0]"), "device 0, device 1"),
        ("[camera]\nseed = 1".to_owned(), "no device 0"),
    ] {
        let error = sampled(&scene, Frame::Device, Resolution::Default).expect_err("must fail");
        assert!(error.to_string().contains(part), "{error}");
    }
}

fn table(scene: &str) -> Result<Vec<cloakroom::material::Segment>, MaterialError> {
    let scene = scene_file::parse(scene, "scene", Path::new(""), &[]).expect("a scene").scene;
    segments(&scene, &assembly(&scene).expect("a bench"), None)
}

#[test]
fn segments_have_the_axes_and_eigenvalues_of_the_paper() {
    // Halimeh & Wegener 2013, section 3: 3.27 and 0.31 at 33.54 degrees, permittivity 2.366.
    for (material, odd) in [("positive-uniaxial", 0), ("negative-uniaxial", 1)] {
        let segments = table(&format!("{SQUARE}material = \"{material}\"")).expect("segments");
        assert_eq!(segments.len(), 5);
        for segment in &segments[..4] {
            let (e, m) = (segment.permittivity.expect("e"), segment.permeability.expect("m"));
            assert!(e.values.iter().all(|value| (value - 2.366).abs() < 5e-4));
            assert!((m.values[0] - 3.2717).abs() < 5e-5 && (m.values[1] - 0.305_65).abs() < 5e-6);
            let optic = segment.optic_axis.expect("an axis");
            let along = |axis: [f64; 3]| (0..3).map(|k| axis[k] * optic[k]).sum::<f64>().abs();
            assert!((along(m.axes[odd]) - 1.0).abs() < 1e-12);
            let angle = m.axes[0][1].atan2(m.axes[0][0]).to_degrees();
            assert!((angle.abs() - 33.5443).abs() < 1e-4, "{angle}");
            assert_eq!(segment.corners_cm.len(), 3);
            assert_eq!(segment.z_cm, None);
        }
        let metal = &segments[4];
        assert_eq!((metal.filling, metal.corners_cm.len()), ("metal", 4));
        assert!(metal.corners_cm.iter().all(|[x, y]| {
            let d = 14.1 / 2f64.sqrt();
            (x.abs() / d + y.abs() * 3f64.sqrt() / d - 1.0).abs() < 1e-12
        }));
        let folder = tempfile::tempdir().expect("a folder");
        let written = |name: &str| {
            let path = folder.path().join(name);
            write_segments(&segments, &path).expect("written");
            std::fs::read_to_string(path).expect("read")
        };
        let csv = written("a.csv");
        let widths: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(widths, [7 + 24 + 8; 6]);
        let back: serde_json::Value = serde_json::from_str(&written("a.JSON")).expect("JSON");
        assert_eq!(
            back[0]["permeability"]["values"][0],
            segments[0].permeability.expect("m").values[0]
        );
        assert_eq!(back[4]["permittivity"], serde_json::Value::Null);
    }
    let graded = table("[[device]]\nkind = \"double-gaussian-cloak\"").expect_err("must fail");
    assert!(graded.to_string().contains("graded"), "{graded}");
}
