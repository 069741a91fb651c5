//! Outlines as STL and glTF files.

use super::{Matter, OutlineMesh};
use crate::output::{OutputError, WriteSeek, format_of, write_whole};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use serde_json::{Value, json};
use std::io;
use std::path::Path;

/// A kind of file for meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Binary STL: triangles alone, cm.
    Stl,
    /// glTF with its data in it, as one binary file.
    Glb,
    /// The same as text.
    Gltf,
}

impl MeshFormat {
    /// The endings of their names.
    pub const ENDINGS: [(&str, Self); 3] =
        [("stl", Self::Stl), ("glb", Self::Glb), ("gltf", Self::Gltf)];

    /// The format that the ending of a file's name says.
    ///
    /// # Errors
    ///
    /// If it says none.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        format_of(path, &Self::ENDINGS)
    }
}

/// Writes outlines as the ending of the file's name asks for. `.stl`: all triangles, in cm. `.glb` and
/// `.gltf`: a mesh for each part with its name and a simple material; numbers are cm in a node that is
/// scaled by 0.01, since glTF is in metres.
///
/// # Errors
///
/// If the ending is of no such file, or it cannot be written.
pub fn write_mesh(meshes: &[OutlineMesh], path: &Path) -> Result<(), OutputError> {
    let format = MeshFormat::of(path)?;
    write_whole(path, |out| match format {
        MeshFormat::Stl => stl(meshes, out),
        MeshFormat::Glb => glb(meshes, out),
        MeshFormat::Gltf => {
            let data = data(meshes);
            let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&data));
            Ok(serde_json::to_writer(out, &document(meshes, data.len(), Some(uri)))?)
        }
    })
}

fn single(at: DVec3) -> [f32; 3] {
    at.as_vec3().to_array()
}

fn stl(meshes: &[OutlineMesh], out: &mut dyn WriteSeek) -> io::Result<()> {
    let mut header = [b' '; 80];
    let words = b"cloakroom: outlines of devices, cm";
    header[..words.len()].copy_from_slice(words);
    out.write_all(&header)?;
    let count: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let count = u32::try_from(count).map_err(io::Error::other)?;
    out.write_all(&count.to_le_bytes())?;
    for [a, b, c] in meshes.iter().flat_map(|mesh| &mesh.triangles) {
        let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
        for number in [normal, *a, *b, *c].into_iter().flat_map(single) {
            out.write_all(&number.to_le_bytes())?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

/// The corners of all triangles, one mesh after the other.
fn data(meshes: &[OutlineMesh]) -> Vec<u8> {
    let corners = meshes.iter().flat_map(|mesh| mesh.triangles.iter().flatten());
    corners.flat_map(|at| single(*at)).flat_map(f32::to_le_bytes).collect()
}

/// A mesh for each outline, whose corners lie one after the other.
fn document(meshes: &[OutlineMesh], length: usize, uri: Option<String>) -> Value {
    const BYTES_PER_CORNER: usize = 12;
    let mut offset = 0;
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    for (number, mesh) in meshes.iter().enumerate() {
        let count = 3 * mesh.triangles.len();
        let bytes = BYTES_PER_CORNER * count;
        views.push(
            json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes, "target": 34962 }),
        );
        let corners = || mesh.triangles.iter().flatten().copied();
        let end = |all: Option<DVec3>| single(all.unwrap_or_default());
        accessors.push(json!({
            "bufferView": number, "componentType": 5126, "count": count, "type": "VEC3",
            "min": end(corners().reduce(DVec3::min)), "max": end(corners().reduce(DVec3::max)),
        }));
        offset += bytes;
    }
    let of_each = |what: &dyn Fn(usize, &OutlineMesh) -> Value| -> Vec<Value> {
        meshes.iter().enumerate().map(|(number, mesh)| what(number, mesh)).collect()
    };
    let mut buffer = json!({ "byteLength": length });
    if let Some(uri) = uri {
        buffer["uri"] = uri.into();
    }
    let root = json!({
        "name": "cm", "scale": [0.01, 0.01, 0.01],
        "children": (1..=meshes.len()).collect::<Vec<_>>(),
    });
    let mut nodes = vec![root];
    nodes.extend(of_each(&|number, mesh| json!({ "name": mesh.name, "mesh": number })));
    json!({
        "asset": { "version": "2.0", "generator": "cloakroom", "extras": { "unit": "cm below the node of that name" } },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": nodes,
        "meshes": of_each(&|number, mesh| json!({
            "name": mesh.name,
            "primitives": [{ "attributes": { "POSITION": number }, "material": number }],
        })),
        "materials": of_each(&|_, mesh| material(mesh.matter)),
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [buffer],
    })
}

/// What a part looks like, about.
fn material(matter: Matter) -> Value {
    let (name, [r, g, b, alpha], metallic, roughness) = match matter {
        Matter::Medium => ("medium", [0.75, 0.85, 1.0, 0.35], 0.0, 0.05),
        Matter::Metal => ("metal", [0.8, 0.8, 0.82, 1.0], 1.0, 0.05),
        Matter::Polarizer => ("polarizer", [0.2, 0.2, 0.2, 0.5], 0.0, 0.5),
        Matter::Opaque([r, g, b]) => {
            ("opaque", [r.min(1.0), g.min(1.0), b.min(1.0), 1.0], 0.0, 1.0)
        }
    };
    json!({
        "name": name,
        "doubleSided": true,
        "alphaMode": if alpha < 1.0 { "BLEND" } else { "OPAQUE" },
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, alpha], "metallicFactor": metallic, "roughnessFactor": roughness,
        },
    })
}

/// One binary file: the document, then the corners.
fn glb(meshes: &[OutlineMesh], out: &mut dyn WriteSeek) -> io::Result<()> {
    let data = data(meshes);
    let mut text = serde_json::to_vec(&document(meshes, data.len(), None))?;
    // Chunks are of whole words.
    text.resize(text.len().next_multiple_of(4), b' ');
    let chunks = [(b"JSON", &text), (b"BIN\0", &data)];
    let whole = chunks.iter().map(|(_, chunk)| 8 + chunk.len()).sum::<usize>() + 12;
    let size = |bytes: usize| u32::try_from(bytes).map(u32::to_le_bytes).map_err(io::Error::other);
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&size(whole)?)?;
    for (kind, chunk) in chunks {
        out.write_all(&size(chunk.len())?)?;
        out.write_all(kind)?;
        out.write_all(chunk)?;
    }
    Ok(())
}
