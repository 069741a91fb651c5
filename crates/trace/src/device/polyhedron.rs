//! Solids with flat faces, of any homogeneous medium or of metal: convex ones by their corners or by
//! the planes of their faces, others as closed meshes of triangles.

use super::graded::here;
use super::{
    Device, DispersiveMedium, Fact, FarSide, HomogeneousRegion, Hull, MediumWords, Region,
    RegionBorder, Request, Shape, Structure, Surface,
};
use crate::key;
use crate::keys::{Given, KeyError, MeshSource, Sampled, Samples, ValueRange, shape_text};
use glam::DVec3;
use optics::geometry::{Plane, Polyhedron, Pose, Solid, Triangles, convex_hull, within_planes};
use optics::medium::Tensor;
use std::sync::Arc;

crate::table! {
    /// A solid with flat faces, of any homogeneous medium or of `metal`: the convex solid around some
    /// corners, the one behind some planes, or whatever a closed mesh of triangles bounds. Without any
    /// of them it is a regular octahedron.
    pub struct FacetedSolid with words: MediumWords {
        /// Points in the device's frame, [x, y, z] each, four at least: the solid is their convex hull.
        /// Or the name of a .npy file, relative to the scene file.
        vertices: Option<Sampled<2, 2>>, "cm", in ValueRange::COORDINATE,
        /// Planes, [nx, ny, nz, d] each: the solid is behind all of them, where the part of its points
        /// along the normal (nx, ny, nz), which may be of any length, is at most d cm. Or the name of a
        /// .npy file.
        planes: Option<Sampled<2, 2>>, in ValueRange::COORDINATE,
        /// A closed mesh of triangles, convex or not: the name of an .stl, .obj, .glb or .gltf file,
        /// relative to the scene file. Coordinates are cm, in glTF metres.
        mesh: Option<MeshSource>,
        /// What the coordinates of the mesh are multiplied by.
        scale: Given<f64> = Given::by_default(1.0), in ValueRange::Within(1e-6, 1e6),
        /// Relative permittivity, in the device's frame; symmetric. By default the square of the
        /// index 1.5168, that of the glass BK7 in yellow light.
        permittivity: Given<Tensor> = Given::by_default((1.5168 * 1.5168).into()),
        /// Relative permeability, in the device's frame; symmetric.
        permeability: Given<Tensor> = Given::by_default(1.0.into()),
        /// Speed of light over the speed of a pulse in it, for `group_delay`, and for times of
        /// flight where the phase runs backwards; where it is absent, as the `dispersion` says.
        group_index: Option<f64>, in ValueRange::Within(1.0, 1e9),
    }
}

/// More corners or planes than these are no device: a mesh says what they say.
const MOST_VERTICES: usize = 2000;
const MOST_PLANES: usize = 200;

/// How far the corners of the octahedron are from its middle, cm.
const RADIUS: f64 = 8.0;

impl Device for FacetedSolid {
    const KIND: &'static str = "polyhedron";
    const TITLE: &'static str = "Solid with flat faces";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a solid with flat faces is no cloak")?;
        let message = "length is given; a polyhedron is as long as its faces make it";
        KeyError::refuse_if(request.length.is_some(), key!(Request.length), message)?;
        let solid = self.solid()?;
        let (far, medium) = self.filling(request)?;
        let region = |medium: DispersiveMedium| HomogeneousRegion {
            group_index: self.group_index,
            ..HomogeneousRegion::new(medium, RegionBorder::Polyhedron(Arc::clone(&solid)))
        };
        let regions = medium.into_iter().map(region).map(Region::Homogeneous).collect();
        let surfaces = vec![Surface::new(Shape::OfPolyhedron(Arc::clone(&solid)), far)];
        let hull = Hull::new(Solid::Polyhedron { solid, pose: Pose::IDENTITY });
        Ok(Structure::new(regions, surfaces, hull))
    }

    fn facts(&self, request: Request) -> Vec<Fact> {
        let Ok(solid) = self.solid() else { return Vec::new() };
        let mut facts = vec![
            Fact::number("volume_cm3", solid.volume()),
            Fact::number("face_count", solid.face_count() as f64),
        ];
        let medium = self.filling(request).ok().and_then(|(_, medium)| medium);
        let index = medium.map(|found| found.medium).filter(|m| m.is_isotropic() && !m.absorbs());
        facts.extend(index.map(|medium| Fact::number("index", medium.mean_index())));
        facts
    }
}

impl FacetedSolid {
    /// What lies behind its faces, and the medium that fills it; none if it is of metal.
    fn filling(&self, request: Request) -> Result<(FarSide, Option<DispersiveMedium>), KeyError> {
        let tensors = [
            (key!(Self.permittivity), self.permittivity),
            (key!(Self.permeability), self.permeability),
        ];
        if !request.metal {
            let medium = super::medium(&self.words, tensors, request.wavelength_nm)?;
            return Ok((FarSide::Region(0), Some(medium)));
        }
        let given = tensors.into_iter().filter_map(|(key, tensor)| tensor.given.then_some(key));
        let group_index = self.group_index.map(|_| key!(Self.group_index));
        if let Some(key) = given.chain(group_index).chain(self.words.word()).next() {
            let message = format!("a polyhedron of metal lets no light in; it has no {key}");
            return Err(KeyError::at(key, message));
        }
        Ok((FarSide::Conductor, None))
    }

    /// The solid, if there is one.
    fn solid(&self) -> Result<Arc<Polyhedron>, KeyError> {
        let given = [
            (key!(Self.vertices), self.vertices.is_some()),
            (key!(Self.planes), self.planes.is_some()),
            (key!(Self.mesh), self.mesh.is_some()),
        ];
        let mut given = given.into_iter().filter_map(|(key, given)| given.then_some(key));
        if let (Some(first), Some(second)) = (given.next(), given.next()) {
            let message =
                format!("{first} and {second} are both given; a polyhedron takes one of them");
            return Err(KeyError::at(second, message));
        }
        let message = "scale is given, and no mesh whose coordinates it would multiply";
        let stray = self.scale.given && self.mesh.is_none();
        KeyError::refuse_if(stray, key!(Self.scale), message)?;
        let (key, triangles) = if let Some(mesh) = &self.mesh {
            let solid = match mesh {
                MeshSource::Here(solid) => solid,
                MeshSource::InFile(file) => {
                    let message =
                        format!("{} has not been read; a device takes the mesh", file.display());
                    return Err(KeyError::at(key!(Self.mesh), message));
                }
            };
            if self.scale.value == 1.0 {
                return Ok(Arc::clone(solid));
            }
            let corners = solid.corners().iter().map(|at| *at * self.scale.value).collect();
            (key!(Self.mesh), Triangles { corners, triangles: solid.triangles().to_vec() })
        } else if let Some(planes) = here(self.planes.as_ref(), key!(Self.planes))? {
            (key!(Self.planes), behind_planes(planes)?)
        } else {
            let key = key!(Self.vertices);
            let points = match here(self.vertices.as_ref(), key)? {
                Some(vertices) => rows::<3>(key, vertices, MOST_VERTICES)?,
                None => DVec3::AXES
                    .into_iter()
                    .flat_map(|a| [a, -a])
                    .map(|a| (RADIUS * a).to_array())
                    .collect(),
            };
            let points: Vec<DVec3> = points.into_iter().map(DVec3::from_array).collect();
            let message = "all vertices lie in one plane; a solid needs one beside it";
            (key, convex_hull(&points).ok_or_else(|| KeyError::at(key, message))?)
        };
        let solid = Polyhedron::new(&triangles);
        solid.map(Arc::new).map_err(|fault| KeyError::at(key, format!("{key}: {fault}")))
    }
}

/// Rows of so many numbers.
fn rows<const N: usize>(
    key: &'static str,
    samples: &Samples,
    most: usize,
) -> Result<Vec<[f64; N]>, KeyError> {
    let shape = samples.shape();
    let message = format!(
        "{key} is {}; it must be rows of {N} numbers, four rows at least and {most} at most",
        shape_text(shape)
    );
    let sound = matches!(shape, [count, each] if *each == N && (4..=most).contains(count));
    KeyError::refuse_if(!sound, key, message)?;
    let row = |row: &[f64]| std::array::from_fn(|i| row[i]);
    Ok(samples.values().chunks_exact(N).map(row).collect())
}

/// The solid behind planes.
fn behind_planes(samples: &Samples) -> Result<Triangles, KeyError> {
    let key = key!(FacetedSolid.planes);
    let plane = |(number, [x, y, z, offset]): (usize, [f64; 4])| {
        let missing = || {
            let message =
                format!("planes[{number}] has the normal [0, 0, 0], which has no direction");
            KeyError::at(key, message)
        };
        let normal = optics::wave::unit(DVec3::new(x, y, z)).ok_or_else(missing)?;
        Ok(Plane { normal, offset })
    };
    let planes = rows::<4>(key, samples, MOST_PLANES)?.into_iter().enumerate();
    let planes = planes.map(plane).collect::<Result<Vec<_>, KeyError>>()?;
    within_planes(&planes).map_err(|fault| KeyError::at(key, fault.to_string()))
}
