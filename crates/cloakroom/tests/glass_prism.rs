//! Stokes parameters against the Fresnel formulas of textbooks, worked forwards by hand: a glass
//! prism that polarizes by refraction and retards by total reflection, a face at Brewster's angle,
//! and metal.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::assembly::{Assembly, Placed};
use cloakroom::device::{Face, FarSide, HomogeneousRegion, Hull, Region, Structure, Surface};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};
use num_complex::Complex64;
use optics::geometry::{Extent, Outline, Plane, Pose, Solid, Wall};
use optics::medium::Medium;
use optics::wave::{arriving_stokes, transverse_basis};

const INDEX: f64 = 1.5;

/// A right-angled prism with its legs along x and y, of glass or metal.
fn prism(glass: bool) -> Assembly {
    let corners = [DVec2::ZERO, DVec2::new(10.0, 0.0), DVec2::new(0.0, 10.0)];
    let far = if glass { FarSide::Region(0) } else { FarSide::Conductor };
    let sides = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3]));
    let surfaces =
        sides.map(|(from, to)| Surface::wall(Wall::new(from, to, Extent::ENDLESS), far)).to_vec();
    let faces = sides
        .map(|(from, to)| {
            let normal = -(to - from).perp().normalize().extend(0.0);
            let plane = Plane { normal, offset: normal.dot(from.extend(0.0)) };
            Face::new(plane, FarSide::Outside)
        })
        .to_vec();
    let regions = if glass {
        let medium = Medium::dielectric(INDEX);
        vec![Region::Homogeneous(HomogeneousRegion::between(medium, faces))]
    } else {
        Vec::new()
    };
    let outline = Outline { corners: corners.to_vec() };
    let hull = Hull::new(Solid::Prism { outline, extent: Extent::ENDLESS });
    let structure = Structure::new(regions, surfaces, hull);
    Assembly::new(vec![Placed::new(Pose::new(DVec3::ZERO, 0.0), structure)])
}

/// The ray from the camera through `through` along `direction`, and its strongest leaf.
fn strongest(assembly: &Assembly, through: DVec3, direction: DVec3) -> (Launch<2>, Leaf<2>) {
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let origin = through - direction * 30.0;
    let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
    let mut tracer = Tracer::new(assembly, Limits { min_power: 1e-6, tolerance: 1e-9 });
    let (leaves, _) = tracer.trace(&launch);
    let power = |leaf: &&Leaf<2>| leaf.power[0] + leaf.power[1];
    let leaf = *leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b))).unwrap();
    (launch, leaf)
}

fn stokes(leaf: &Leaf<2>) -> [f64; 4] {
    arriving_stokes(leaf.electric[0], leaf.electric[1])
}

/// Light on its way by the textbook: its direction and its field, whose square times index and
/// cosine is the flux.
struct Light {
    direction: DVec3,
    field: [Complex64; 3],
    /// The flux of a unit field over that of the one which came first.
    flux: f64,
}

impl Light {
    /// Amplitude along a real axis.
    fn along(&self, axis: DVec3) -> Complex64 {
        self.field[0] * axis.x + self.field[1] * axis.y + self.field[2] * axis.z
    }

    /// Refraction, or reflection, at a face with its normal along the light, between indices `from`
    /// and `to`. Fields go as exp(-iωt); p is along k × s before and after (Born & Wolf, 1.5.2).
    fn meet(&mut self, normal: DVec3, from: f64, to: f64, reflected: bool) {
        let k = self.direction;
        let cos_i = k.dot(normal);
        let across = k - normal * cos_i;
        let sine = across.length() * from / to;
        let cos_t = Complex64::new(1.0 - sine * sine, 0.0).sqrt();
        let s = normal.cross(k).normalize();
        let onward = if reflected {
            k - normal * (2.0 * cos_i)
        } else {
            across * (from / to) + normal * cos_t.re
        };
        let (a, b) = (Complex64::from(cos_i), cos_t);
        let [of_s, of_p] = if reflected {
            [(a * from - b * to) / (a * from + b * to), (a * to - b * from) / (a * to + b * from)]
        } else {
            self.flux *= to * cos_t.re / (from * cos_i);
            [a * (2.0 * from) / (a * from + b * to), a * (2.0 * from) / (a * to + b * from)]
        };
        let (amplitude_s, amplitude_p) = (self.along(s) * of_s, self.along(k.cross(s)) * of_p);
        let p = onward.cross(s);
        self.direction = onward;
        self.field = [0, 1, 2].map(|i| amplitude_s * s[i] + amplitude_p * p[i]);
    }
}

#[test]
fn a_prism_polarizes_and_retards_as_textbooks_say() {
    let assembly = prism(true);
    let (mut circular, mut diagonal) = (0.0f64, 0.0f64);
    for (y, z) in [(0.1, 0.5), (-0.2, 0.7), (0.15, -0.9), (-0.1, -0.4), (0.0, 1.1)] {
        let direction = DVec3::new(1.0, y, z).normalize();
        let (launch, leaf) = strongest(&assembly, DVec3::new(0.0, 5.0, 0.0), direction);
        // Forwards: in by the leg along x, totally reflected by the hypotenuse, out by the other
        // leg.
        let mut sums = [0.0; 4];
        let entering = -leaf.direction;
        let first = entering.any_orthonormal_vector();
        for start in [first, entering.cross(first)] {
            let field = start.to_array().map(Complex64::from);
            let mut light = Light { direction: entering, field, flux: 1.0 };
            light.meet(DVec3::Y, 1.0, INDEX, false);
            let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
            light.meet(diagonal, INDEX, 1.0, true);
            light.meet(-DVec3::X, INDEX, 1.0, false);
            assert!((light.direction + direction).length() < 1e-12);
            // The camera's horizontal and vertical, as it sees them.
            let (right, up) = transverse_basis(launch.direction, DVec3::Z, DVec3::X);
            let (h, v) = (light.along(right), light.along(up));
            // By definition: right-handed light is E_V = -i E_H.
            let share = |psi: f64, delta: f64| {
                let (sin, cos) = psi.to_radians().sin_cos();
                let passed = h * cos + v * Complex64::from_polar(sin, -delta.to_radians());
                passed.norm_sqr() * light.flux / 2.0
            };
            let pairs = [(0.0, 0.0, 90.0, 0.0), (45.0, 0.0, -45.0, 0.0), (45.0, -90.0, 45.0, 90.0)];
            sums[0] += share(0.0, 0.0) + share(90.0, 0.0);
            for (sum, (psi, delta, other_psi, other_delta)) in sums[1..].iter_mut().zip(pairs) {
                *sum += share(psi, delta) - share(other_psi, other_delta);
            }
        }
        let traced = stokes(&leaf);
        for k in 0..4 {
            assert!((traced[k] - sums[k]).abs() < 1e-12, "S{k}: {traced:?} {sums:?}");
        }
        circular = circular.max(sums[3].abs());
        diagonal = diagonal.max(sums[2].abs());
    }
    assert!(circular > 0.01 && diagonal > 0.01, "{circular} {diagonal}");
}

#[test]
fn glass_at_brewsters_angle_polarizes_along_its_face() {
    let assembly = prism(true);
    let normal = DVec3::new(1.0, 1.0, 0.0).normalize();
    let brewster = INDEX.atan();
    for turn in [0.0f64, 20.0, 50.0, -35.0, -70.0] {
        // Onto the hypotenuse from outside; `across` is where the plane of incidence meets the
        // face.
        let in_plane = DVec3::new(1.0, -1.0, 0.0).normalize();
        let (sin, cos) = turn.to_radians().sin_cos();
        let across = in_plane * cos + DVec3::Z * sin;
        let direction = across * brewster.sin() - normal * brewster.cos();
        let mut tracer = Tracer::<2>::new(&assembly, Limits { min_power: 1e-6, tolerance: 1e-9 });
        let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
        let origin = DVec3::new(5.0, 5.0, 0.0) - direction * 30.0;
        let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
        let mirrored = direction - normal * (2.0 * direction.dot(normal));
        let (leaves, _) = tracer.trace(&launch);
        // Light from inside the prism may leave in the same direction.
        let leaf = leaves.iter().find(|leaf| (leaf.optical_path - 30.0).abs() < 1e-9).unwrap();
        assert!(leaf.direction.distance(mirrored) < 1e-12);
        let [s0, s1, s2, s3] = stokes(leaf);
        // The normal and the ray span no field: what is left is along the face.
        let along = normal.cross(direction).normalize();
        let psi = along.dot(v).atan2(along.dot(h));
        let reflectance = ((1.0 - INDEX * INDEX) / (1.0 + INDEX * INDEX)).powi(2);
        assert!((s0 - reflectance / 2.0).abs() < 1e-12);
        assert!((s1 - s0 * (2.0 * psi).cos()).abs() < 1e-12, "{turn}: {s1}");
        assert!((s2 - s0 * (2.0 * psi).sin()).abs() < 1e-12, "{turn}: {s2}");
        assert!(s3.abs() < 1e-12);
        if turn == 0.0 {
            // A face along z, which is horizontal: glare is horizontal.
            assert!((s1 - s0).abs() < 1e-12);
        }
    }
}

#[test]
fn metal_leaves_unpolarized_light_unpolarized() {
    let assembly = prism(false);
    let (_, leaf) = strongest(&assembly, DVec3::new(5.0, 5.0, 0.0), DVec3::new(-0.8, 0.0, 0.6));
    let stokes = stokes(&leaf);
    assert!((stokes[0] - 1.0).abs() < 1e-14 && stokes[1..].iter().all(|s| s.abs() < 1e-14));
}
