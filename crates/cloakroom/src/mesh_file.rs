//! Files of meshes of triangles that a scene names: STL, OBJ and glTF.

use crate::device::FacetedSolid;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use cloakroom_trace::key;
use glam::{DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use optics::geometry::{Polyhedron, Triangles};
use std::io::{Cursor, ErrorKind};
use std::path::Path;
use std::sync::Arc;
use tobj::LoadOptions;

/// glTF is in metres.
const CM_PER_METRE: f64 = 100.0;

/// The deepest that nodes of glTF may lie in one another.
const DEEPEST: usize = 64;

/// What the name of a file ends with, in lower case, without the dot.
fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// The solid that a file holds of these bytes.
///
/// # Errors
///
/// Why it holds none, to be read after the name of the file and a colon.
pub(crate) fn solid(path: &Path, bytes: &[u8]) -> Result<Arc<Polyhedron>, String> {
    let triangles = match ending(path).as_str() {
        "stl" => stl(bytes),
        "obj" => obj(bytes),
        _ => of_gltf(bytes),
    };
    let solid = Polyhedron::new(&triangles?);
    solid
        .map(Arc::new)
        .map_err(|fault| format!("{} bounds no solid: {fault}", key!(FacetedSolid.mesh)))
}

fn stl(bytes: &[u8]) -> Result<Triangles, String> {
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => {
            "it is no STL file, or cut short: fewer triangles follow than it says".to_owned()
        }
        _ => format!("it is no STL file: {error}"),
    })?;
    let corner = |at: &stl_io::Vector<f32>| DVec3::from_array(at.0.map(f64::from));
    let mut triangles = Triangles {
        corners: mesh.vertices.iter().map(corner).collect(),
        triangles: Vec::with_capacity(mesh.faces.len()),
    };
    for face in mesh.faces {
        triangles.triangles.push(numbers(face.vertices)?);
    }
    Ok(triangles)
}

/// Numbers of corners, of which there may be as many as 32 bits count.
fn numbers(corners: [usize; 3]) -> Result<[u32; 3], String> {
    let [a, b, c] = corners.map(u32::try_from);
    match (a, b, c) {
        (Ok(a), Ok(b), Ok(c)) => Ok([a, b, c]),
        _ => Err("it has more corners than can be numbered".to_owned()),
    }
}

fn obj(bytes: &[u8]) -> Result<Triangles, String> {
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    // What its surfaces look like does not matter.
    let no_material = |_: &Path| Ok((Vec::new(), Default::default()));
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_material)
        .map_err(|error| format!("it is no OBJ file: {error}"))?;
    let mut all = Triangles::default();
    for model in models {
        let first = all.corners.len() as u32;
        all.corners.extend(model.mesh.positions.chunks_exact(3).map(DVec3::from_slice));
        let triangles = model.mesh.indices.chunks_exact(3);
        all.triangles.extend(triangles.map(|of| [0, 1, 2].map(|i| of[i].saturating_add(first))));
    }
    Ok(all)
}

fn of_gltf(bytes: &[u8]) -> Result<Triangles, String> {
    let Gltf { document, blob } =
        Gltf::from_slice(bytes).map_err(|error| format!("it is no glTF file: {error}"))?;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        buffers.push(match buffer.source() {
            gltf::buffer::Source::Bin => blob.clone().unwrap_or_default(),
            gltf::buffer::Source::Uri(uri) => inline(uri)?,
        });
    }
    let mut all = Triangles::default();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or("there is no scene in it")?;
    for node in scene.nodes() {
        add_node(&node, DMat4::from_scale(DVec3::splat(CM_PER_METRE)), 0, &buffers, &mut all)?;
    }
    Ok(all)
}

/// The data that a URI itself holds.
fn inline(uri: &str) -> Result<Vec<u8>, String> {
    let data = uri.strip_prefix("data:").and_then(|data| data.split_once(";base64,"));
    let Some((_, data)) = data else {
        return Err(format!(
            "its data are in another file, {uri:?}; write it as a .glb, which has them in it"
        ));
    };
    STANDARD.decode(data).map_err(|error| format!("its data are no base64: {error}"))
}

/// Adds the meshes of a node and of those in it, at their places.
fn add_node(
    node: &Node<'_>,
    around: DMat4,
    depth: usize,
    buffers: &[Vec<u8>],
    all: &mut Triangles,
) -> Result<(), String> {
    if depth > DEEPEST {
        return Err(format!("its nodes lie in one another, more than {DEEPEST} deep"));
    }
    let own = DMat4::from_cols_array_2d(&node.transform().matrix().map(|c| c.map(f64::from)));
    let place = around * own;
    for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
        add_primitive(&primitive, place, buffers, all)?;
    }
    node.children().try_for_each(|child| add_node(&child, place, depth + 1, buffers, all))
}

fn add_primitive(
    primitive: &Primitive<'_>,
    place: DMat4,
    buffers: &[Vec<u8>],
    all: &mut Triangles,
) -> Result<(), String> {
    match primitive.mode() {
        Mode::Triangles => {}
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => return Ok(()),
        Mode::TriangleStrip | Mode::TriangleFan => {
            return Err(
                "it has strips or fans of triangles; write it with each triangle by itself"
                    .to_owned(),
            );
        }
    }
    let positions = primitive.get(&Semantic::Positions);
    let accessors = positions.into_iter().chain(primitive.indices());
    accessors.into_iter().try_for_each(|accessor| check_accessor(&accessor, buffers))?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let positions = reader.read_positions().ok_or("a mesh in it has no positions")?;
    let first = all.corners.len();
    let corner = |at: [f32; 3]| place.transform_point3(DVec3::from_array(at.map(f64::from)));
    all.corners.extend(positions.map(corner));
    let count = all.corners.len() - first;
    let numbered: Vec<usize> = match reader.read_indices() {
        Some(indices) => indices.into_u32().map(|index| index as usize).collect(),
        None => (0..count).collect(),
    };
    let mirrored = place.determinant() < 0.0;
    for corners in numbered.chunks_exact(3) {
        let [a, b, c] =
            numbers([corners[0], corners[1], corners[2]].map(|i| i.saturating_add(first)))?;
        all.triangles.push(if mirrored { [a, c, b] } else { [a, b, c] });
    }
    Ok(())
}

/// Refuses what would be read from beyond the end of the data, or as what it is not.
fn check_accessor(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<(), String> {
    let beyond = || "its numbers lie beyond the end of its data".to_owned();
    let view = accessor.view().filter(|_| accessor.sparse().is_none());
    let view = view.ok_or("it has sparse data, which are not read")?;
    let known = match accessor.dimensions() {
        Dimensions::Vec3 => accessor.data_type() == DataType::F32,
        Dimensions::Scalar => {
            matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32)
        }
        _ => false,
    };
    if !known {
        return Err("its positions and indices are of no known type".to_owned());
    }
    let data = buffers.get(view.buffer().index()).ok_or_else(beyond)?;
    let view_end = view.offset().checked_add(view.length());
    let stride = view.stride().unwrap_or(accessor.size());
    let last = accessor.count().saturating_sub(1).checked_mul(stride);
    let end =
        last.and_then(|last| last.checked_add(accessor.offset())?.checked_add(accessor.size()));
    let fits = view_end.is_some_and(|end| end <= data.len())
        && end.is_some_and(|end| end <= view.length());
    if fits { Ok(()) } else { Err(beyond()) }
}
