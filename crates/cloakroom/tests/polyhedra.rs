//! Solids with flat faces against boxes and prisms, a ball, a prism of dispersive glass, and the account
//! of the power; and the files that meshes come in.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::rays::{Numbers, assembly, launch, launches_around, placed, refusal, try_bench};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use optics::geometry::{Triangles, convex_hull};
use std::fmt::Write;
use std::fs;
use std::path::Path;

const LIMITS: Limits = Limits { min_power: 1e-3, tolerance: 1e-9 };

fn leaves_of(tracer: &mut Tracer<'_, 2>, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let (leaves, outcome) = tracer.trace(launch);
    outcome.assert_balanced(leaves, 1e-12, launch);
    let mut leaves = leaves.to_vec();
    leaves.sort_by(|a, b| b.power[0].total_cmp(&a.power[0]));
    leaves
}

/// The three strongest leaves are the same.
fn assert_alike(one: &str, other: &str, rays: u32) {
    let (one, other) = (assembly(one), assembly(other));
    let (mut one, mut other) = (Tracer::new(&one, LIMITS), Tracer::new(&other, LIMITS));
    for launch in launches_around(rays, [60.0, 40.0], DVec3::splat(11.0)) {
        let (leaves, others) = (leaves_of(&mut one, &launch), leaves_of(&mut other, &launch));
        for (a, b) in leaves.iter().zip(&others).take(3) {
            assert!((a.power[0] - b.power[0]).abs() < 1e-9, "{launch:?} {a:?} {b:?}");
            let far = (a.position - b.position).length() > 1e-8;
            assert!(!far || a.power[0] < 0.02, "{launch:?} {a:?} {b:?}");
        }
    }
}

fn rows(points: impl IntoIterator<Item = DVec3>) -> String {
    let rows: Vec<String> = points.into_iter().map(|at| format!("{:?}", at.to_array())).collect();
    format!("[{}]", rows.join(", "))
}

const BOX_CORNERS: &str = "[[-3,-4,-3.5],[3,-4,-3.5],[-3,4,-3.5],[3,4,-3.5],[-3,-4,3.5],[3,-4,3.5],[-3,4,3.5],[3,4,3.5],[0,0,0]]";
const BOX_PLANES: &str =
    "[[2,0,0,3],[-1,0,0,3],[0,1,0,4],[0,-5,0,4],[0,0,1,3.5],[0,0,-1,3.5],[1,1,1,40]]";
const PLACE: &str = "rotation = 23\nposition = [1, -2, 0.5]\naxis = [0.3, -0.2, 1]\n";
const CRYSTAL: &str = "permittivity = [[2.5, 0.3, 0.1], [0.3, 1.8, 0], [0.1, 0, [1.4, 2e-7]]]\n";

fn polyhedron(keys: &str) -> String {
    format!("[[device]]\nkind = \"polyhedron\"\n{keys}\n")
}

#[test]
fn a_box_by_its_corners_or_planes_is_the_box() {
    for (medium, layers) in [
        (CRYSTAL, ""),
        ("index = 1.3\n", "coating = [{ thickness_nm = 100, index = 1.38 }]\n"),
        ("metal = true\n", ""),
    ] {
        let common = format!("{PLACE}{medium}{layers}");
        let boxed =
            format!("[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [6, 8, 7]\n{common}");
        assert_alike(&polyhedron(&format!("vertices = {BOX_CORNERS}\n{common}")), &boxed, 150);
        assert_alike(&polyhedron(&format!("planes = {BOX_PLANES}\n{common}")), &boxed, 150);
    }
}

/// A prism of an L, which is not convex, as a mesh of an OBJ file and as polygons.
const L: [[f64; 2]; 6] =
    [[-4.0, -3.0], [4.0, -3.0], [4.0, 0.0], [0.0, 0.0], [0.0, 4.0], [-4.0, 4.0]];

fn l_shaped_obj() -> String {
    let mut text = String::new();
    for z in [-3.0, 3.0] {
        for [x, y] in L {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    // The ends in two convex pieces each, from below and from above.
    text += "f 1 4 3 2\nf 1 6 5 4\nf 7 8 9 10\nf 7 10 11 12\n";
    for i in 0..6 {
        let j = (i + 1) % 6;
        writeln!(text, "f {} {} {} {}", i + 1, j + 1, j + 7, i + 7).unwrap();
    }
    text
}

#[test]
fn a_mesh_that_is_not_convex_is_the_prism() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("l.obj");
    fs::write(&path, l_shaped_obj()).unwrap();
    let corners = rows(L.map(|[x, y]| DVec3::new(x, y, 0.0))).replace(", 0.0]", "]");
    for medium in ["index = 1.4\n", CRYSTAL, "metal = true\n"] {
        let mesh = polyhedron(&format!("mesh = {path:?}\n{PLACE}{medium}"));
        let prism = format!(
            "[[device]]\nkind = \"prisms\"\nlength = 6\n{PLACE}[[device.prism]]\ncorners = {corners}\n{medium}"
        );
        assert_alike(&mesh, &prism, 200);
    }
    let half = polyhedron(&format!("mesh = {path:?}\nscale = 0.5\nindex = 1.4\n{PLACE}"));
    let prism = format!(
        "[[device]]\nkind = \"prisms\"\nlength = 3\n{PLACE}[[device.prism]]\ncorners = {}\nindex = 1.4\n",
        rows(L.map(|[x, y]| DVec3::new(x, y, 0.0) * 0.5)).replace(", 0.0]", "]")
    );
    assert_alike(&half, &prism, 100);
}

/// Points of a ball, evenly spread (a Fibonacci lattice).
fn on_ball(count: u32) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, across * sin, z) * 5.0
    };
    (0..count).map(point).collect()
}

fn stl(mesh: &Triangles) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0; 12]);
        for corner in triangle {
            let at = mesh.corners[*corner as usize].as_vec3().to_array();
            bytes.extend(at.iter().flat_map(|number| number.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn a_ball_of_more_and_more_faces_becomes_the_ball() {
    let folder = tempfile::tempdir().unwrap();
    let ball = assembly("[[device]]\nkind = \"body\"\nshape = \"sphere\"\nindex = 1.5\n");
    let mut whole = Tracer::new(&ball, Limits { min_power: 0.5, ..LIMITS });
    let mut last = f64::INFINITY;
    for count in [500, 8000, 128_000] {
        let points = on_ball(count.min(8000));
        let mesh = if count <= 8000 { convex_hull(&points).unwrap() } else { break };
        let path = folder.path().join("ball.stl");
        fs::write(&path, stl(&mesh)).unwrap();
        let faceted = assembly(&polyhedron(&format!("mesh = {path:?}\nindex = 1.5")));
        let mut tracer = Tracer::new(&faceted, Limits { min_power: 0.5, ..LIMITS });
        let mut off = Vec::new();
        for launch in launches_around(300, [40.0, 20.0], DVec3::splat(5.0)) {
            let (one, _) = tracer.trace(&launch);
            let (other, _) = whole.trace(&launch);
            if let ([one], [other]) = (one, other) {
                off.push(one.direction.angle_between(other.direction));
            }
        }
        off.sort_by(f64::total_cmp);
        let median = off[off.len() / 2];
        assert!(off.len() > 200 && median < 0.5 * last, "{count} {median} {last}");
        last = median;
    }
    assert!(last < 0.02, "{last}");
}

#[test]
fn light_is_accounted_for_also_at_edges_and_corners() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("l.obj");
    fs::write(&path, l_shaped_obj()).unwrap();
    let mut numbers = Numbers(17);
    for medium in [
        "index = 1.5",
        "permittivity = -1\npermeability = -1",
        "metal = true",
        "index = [1.4, 3e-6]",
    ] {
        let pose = numbers.pose();
        let place = placed(pose.origin, &pose.rotation());
        let text = polyhedron(&format!("mesh = {path:?}\n{medium}\n{place}"));
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-4, tolerance: 1e-9 });
        for k in 0..1500 {
            let corner = |k: usize| DVec3::new(L[k % 6][0], L[k % 6][1], [-3.0, 3.0][k / 6 % 2]);
            let (a, b) = (corner(k), corner(k + 1));
            let target = match k % 3 {
                0 => a,
                1 => a.lerp(b, numbers.next()),
                _ => a.lerp(b, numbers.next()).lerp(DVec3::ZERO, 1e-13),
            };
            let direction = if k % 5 == 0 { DVec3::AXES[k % 3] } else { numbers.direction() };
            let launch =
                launch(pose.to_world(target - 30.0 * direction), pose.vector_to_world(direction));
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-12, &launch);
        }
    }
}

/// At the least deviation, n = sin((A + D)/2)/sin(A/2), of each colour its own.
#[test]
fn a_prism_of_glass_deviates_each_colour_as_its_index_says() {
    let apex = 60f64.to_radians();
    for nm in [400.0, 550.0, 700.0] {
        let corners = [-90.0, 30.0, 150.0_f64].map(|angle| {
            let (sin, cos) = (angle + 120.0 - 90.0 + 90.0).to_radians().sin_cos();
            DVec3::new(4.0 * cos, 4.0 * sin, 0.0)
        });
        let both = corners.iter().flat_map(|at| [*at - DVec3::Z * 5.0, *at + DVec3::Z * 5.0]);
        let text = format!(
            "[light]\nwavelength_nm = {nm}\n{}",
            polyhedron(&format!("vertices = {}\nmaterial = \"bk7\"", rows(both)))
        );
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-9 });
        // Schott's Sellmeier formula.
        let squared = (nm / 1000.0_f64).powi(2);
        let term = |b: f64, c: f64| b * squared / (squared - c);
        let index = (1.0
            + term(1.03961212, 0.00600069867)
            + term(0.231792344, 0.0200179144)
            + term(1.01046945, 103.560653))
        .sqrt();
        let incidence = (index * (apex / 2.0).sin()).asin();
        // Through the middles of two faces, symmetric about the third corner's line.
        let apex_at = corners[0];
        let axis = apex_at.normalize();
        let across = DVec3::Z.cross(axis);
        let tilt = incidence - apex / 2.0;
        let direction = (across * tilt.cos() + axis * tilt.sin()).normalize();
        let entry = apex_at.lerp(
            if (corners[1] - corners[2]).dot(across) < 0.0 { corners[1] } else { corners[2] },
            0.5,
        );
        let (leaves, _) = tracer.trace(&launch(entry - 20.0 * direction, direction));
        let leaf = leaves.iter().max_by(|a, b| a.power[1].total_cmp(&b.power[1])).unwrap();
        let deviation = leaf.direction.angle_between(direction);
        assert!((deviation - 2.0 * tilt).abs() < 1e-9, "{nm} {deviation} {}", 2.0 * tilt);
    }
}

/// The box as glTF with its data in it: metres, a node that moves, and short indices.
fn gltf_box() -> String {
    use base64::Engine;
    let mesh = convex_hull(
        &(0..8_u8)
            .map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)))
            .collect::<Vec<_>>(),
    )
    .unwrap();
    let mut data: Vec<u8> = Vec::new();
    for at in &mesh.corners {
        data.extend(at.as_vec3().to_array().iter().flat_map(|number| number.to_le_bytes()));
    }
    let positions = data.len();
    data.extend(mesh.triangles.iter().flatten().flat_map(|corner| (*corner as u16).to_le_bytes()));
    let uri = base64::engine::general_purpose::STANDARD.encode(&data);
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"children": [1], "translation": [-0.03, -0.04, -0.035]}}, {{"mesh": 0, "scale": [0.06, 0.08, 0.07]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}},
        {{"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {positions}}}, {{"buffer": 0, "byteOffset": {positions}, "byteLength": 72}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{uri}"}}]}}"#,
        data.len()
    )
}

#[test]
fn a_gltf_file_is_read_in_metres_with_its_nodes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.gltf");
    fs::write(&path, gltf_box()).unwrap();
    let mesh = polyhedron(&format!("mesh = {path:?}\nindex = 1.3\n{PLACE}"));
    let [solid] = &assembly(&mesh).devices()[0].solids()[..] else { panic!() };
    let size = solid.thickness();
    assert!((size - 6.0).abs() < 1e-5, "{size}");
    let boxed = format!(
        "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [6, 8, 7]\nindex = 1.3\n{PLACE}"
    );
    let (one, other) = (assembly(&mesh), assembly(&boxed));
    let (mut one, mut other) = (Tracer::new(&one, LIMITS), Tracer::new(&other, LIMITS));
    let launch = launch(DVec3::new(-40.0, 3.0, 2.0), DVec3::new(1.0, -0.1, -0.05));
    let (a, b) = (leaves_of(&mut one, &launch), leaves_of(&mut other, &launch));
    // Its numbers are of 32 bits.
    assert!(
        (a[0].position - b[0].position).length() < 1e-5
            && (a[0].power[0] - b[0].power[0]).abs() < 1e-5
    );
}

#[test]
fn what_is_no_solid_is_refused_with_its_fault() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        refusal(&polyhedron(&format!("mesh = {path:?}")))
    };
    let open = l_shaped_obj().replace("f 1 4 3 2\n", "");
    let cut = gltf_box().replace("\"count\": 36", "\"count\": 360");
    let elsewhere = gltf_box().replace("data:application", "other/file");
    for (error, words) in [
        (
            of("a.obj", open.as_bytes()),
            "is not closed: 4 edges are of one triangle only, as the one from (",
        ),
        (of("b.stl", b"nothing"), "no STL file, or cut short"),
        (of("c.obj", b"v 1 2 x\nf 1 2 3"), "no OBJ file"),
        (of("d.glb", b"glTF"), "no glTF file"),
        (of("e.gltf", cut.as_bytes()), "beyond the end of its data"),
        (of("f.gltf", elsewhere.as_bytes()), "in another file"),
        (of("g.obj", b""), "it has no triangles; a solid has four"),
    ] {
        assert!(error.starts_with("test:3:8") && error.contains(words), "{words}\n{error}");
    }
    for (keys, place, words) in [
        ("mesh = \"nowhere.stl\"", "test:3:8", "cannot read nowhere.stl"),
        ("mesh = \"a.ply\"", "test:3:8", "ends with .stl, .obj, .glb, .gltf"),
        ("vertices = [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]", "test:3:12", "in one plane"),
        ("vertices = [[0,0],[1,0],[0,1],[1,1]]", "test:3:12", "rows of 3 numbers"),
        ("planes = [[1,0,0,1],[-1,0,0,1],[0,1,0,1],[0,-1,0,1]]", "test:3:10", "has no end"),
        (
            "planes = [[0,0,0,1],[-1,0,0,1],[0,1,0,1],[0,-1,0,1]]",
            "test:3:10",
            "planes[0] has the normal",
        ),
        ("planes = [[0,0,1,1]]\nvertices = [[0,0,0]]", "test:3:10", "both given"),
        ("scale = 2", "test:3:9", "no mesh"),
        ("length = 2", "test:3:10", "as long as its faces"),
        ("metal = true\nindex = 1.5", "test:4:9", "lets no light in"),
        ("show = \"mirror\"", "test:3:8", "is no cloak"),
    ] {
        let error = refusal(&polyhedron(keys));
        assert!(error.starts_with(place) && error.contains(words), "{keys}\n{error}");
    }
    assert!(!Path::new("nowhere.stl").exists());
}

#[test]
fn polyhedra_stand_in_water_and_in_nobodys_way() {
    let water = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 20\nindex = 1.33\n";
    let glass = polyhedron("index = 1.5\nposition = [2, 1, 0]");
    let immersed = assembly(&format!("{water}{glass}"));
    let mut tracer = Tracer::new(&immersed, Limits { min_power: 1e-4, tolerance: 1e-9 });
    for launch in launches_around(200, [60.0, 40.0], DVec3::splat(14.0)) {
        let (leaves, outcome) = tracer.trace(&launch);
        outcome.assert_balanced(leaves, 1e-12, &launch);
    }
    // Of the same medium it is not there.
    let same = assembly(&format!("{water}{}", polyhedron("index = 1.33")));
    let alone = assembly(water);
    let (mut one, mut other) = (Tracer::new(&same, LIMITS), Tracer::new(&alone, LIMITS));
    for launch in launches_around(100, [60.0, 40.0], DVec3::splat(14.0)) {
        let (a, b) = (leaves_of(&mut one, &launch), leaves_of(&mut other, &launch));
        assert!(
            (a[0].position - b[0].position).length() < 1e-9 && a.len() == b.len(),
            "{launch:?}"
        );
    }
    for (x, free) in [(15.9, false), (16.1, true)] {
        let two = format!("{glass}{}", polyhedron(&format!("position = [{}, 1, 0]", 2.0 + x)));
        assert_eq!(try_bench(&two).is_ok(), free, "{x}");
    }
}
