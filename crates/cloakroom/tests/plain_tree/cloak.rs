//! The square cloak as triangles and tensors in the world's frame, from its map alone.

use super::waves::Material;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// What lies beyond a face of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FarSide {
    Air,
    Metal,
    Triangle(usize),
}

/// A triangle of the cross-section; side `i` runs from corner `i` to the next one.
#[derive(Clone, Debug)]
pub struct Triangle {
    pub corners: [DVec2; 3],
    pub beyond: [FarSide; 3],
    pub material: Material,
}

/// The cloak. It ends at ± half its length along z.
#[derive(Clone, Debug)]
pub struct Cloak {
    pub triangles: Vec<Triangle>,
    pub half_length: f64,
}

/// Designs (i), (ii), (iii).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Design {
    Positive,
    Negative,
    Matched,
}

fn upright(matrix: DMat2, z: f64) -> DMat3 {
    let mut tensor = DMat3::from_mat2(matrix);
    tensor.z_axis.z = z;
    tensor
}

/// u uᵀ.
fn dyad(u: DVec2) -> DMat2 {
    DMat2::from_cols(u * u.x, u * u.y)
}

/// Permittivity and permeability in the quadrant with the given signs, in the cloak's frame.
fn material(design: Design, rounded: bool, quadrant: DVec2) -> Material {
    let kappa = 1.0 / 3f64.sqrt();
    // x = X, y = Y (1 - κ) + b (1 - X/d) with b = κ d in the quadrant x, y > 0.
    let jacobian = DMat2::from_cols(
        DVec2::new(1.0, -kappa * quadrant.x * quadrant.y),
        DVec2::new(0.0, 1.0 - kappa),
    );
    let exact = jacobian * jacobian.transpose() * (1.0 / jacobian.determinant());
    let (mut largest, mut z) = (0.0, 1.0 / jacobian.determinant());
    // The larger root of det(M - λ) = 0, and the vector that M - 1/λ leaves.
    let mut u = DVec2::ZERO;
    if rounded {
        let angle = 33.54f64.to_radians();
        (largest, z) = (3.27, 2.366);
        u = DVec2::new(angle.cos(), -angle.sin() * quadrant.x * quadrant.y);
    } else {
        let half = 0.5 * (exact.x_axis.x + exact.y_axis.y);
        largest += half + (half * half - exact.determinant()).sqrt();
        u += (exact.x_axis - DVec2::X / largest).normalize();
    }
    let smallest = if rounded { 0.31 } else { 1.0 / largest };
    let (uu, vv) = (dyad(u), DMat2::IDENTITY - dyad(u));
    let in_plane = uu * largest + vv * smallest;
    let scalar = DMat3::from_diagonal(DVec3::splat(z));
    match design {
        Design::Positive => {
            Material { permittivity: scalar, permeability: upright(in_plane, smallest) }
        }
        Design::Negative => {
            Material { permittivity: scalar, permeability: upright(in_plane, largest) }
        }
        Design::Matched => {
            Material { permittivity: upright(in_plane, z), permeability: upright(in_plane, z) }
        }
    }
}

impl Cloak {
    /// The paper's cloak, turned by `rotation` degrees.
    pub fn new(design: Design, rounded: bool, rotation: f64, half_length: f64) -> Self {
        let turn = DMat2::from_angle(rotation.to_radians());
        let turn3 = upright(turn, 1.0);
        let d = 14.1 / 2f64.sqrt();
        let b = d / 3f64.sqrt();
        let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(DVec2::from);
        let triangles = signs.iter().map(|sign| {
            // The neighbour across x = 0 has the other sign of x.
            let other = DVec2::new(-sign.x, sign.y);
            let neighbour = signs.iter().position(|s| *s == other).expect("a neighbour");
            let corners = [DVec2::new(d, 0.0), DVec2::new(0.0, d), DVec2::new(0.0, b)];
            let Material { permittivity, permeability } = material(design, rounded, *sign);
            let turned = |tensor: DMat3| turn3 * tensor * turn3.transpose();
            Triangle {
                corners: corners.map(|corner| turn * (corner * *sign)),
                beyond: [FarSide::Air, FarSide::Triangle(neighbour), FarSide::Metal],
                material: Material {
                    permittivity: turned(permittivity),
                    permeability: turned(permeability),
                },
            }
        });
        Self { triangles: triangles.collect(), half_length }
    }
}
