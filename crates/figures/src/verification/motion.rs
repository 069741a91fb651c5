//! Section 2: the equation of motion of rays.

use super::finding::{Page, SINGLE, below};
use super::fixture::{CAMERA, Fixture, GAUSSIAN, camera_direction, launch, strongest, tracer};
use super::{Result, VerificationError};
use glam::DVec3;
use num_complex::Complex64;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use optics::transformation::{ConformalMap, GaussianMap};

/// Half the cut along x and y, cm.
const CUT: [f64; 2] = [25.0, 28.57];

/// Rays of design (iv) by the program, and by plain steps along the equation of motion in physical
/// space.
pub(super) fn equation(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let gaussian =
        GaussianMap::new(10.02, 4.25).map_err(|e| VerificationError::Missing(e.to_string()))?;
    let map = ConformalMap::Gaussian(gaussian);
    let assembly = fixture.assembly(GAUSSIAN)?;
    let mut rays = tracer(&assembly, 1e-3);
    let mut off: f64 = 0.0;
    let directions =
        [2.0, 5.0, 9.0].into_iter().flat_map(|up| [0.0, 10.0, 20.0].map(|right| (right, up)));
    for (right, up) in directions {
        let d = camera_direction(right, up);
        let entry = CAMERA + d * ((-CUT[0] - CAMERA.x) / d.x);
        let p = refracted(d, DVec3::X, medium(&map, entry).value).ok_or("a ray")?;
        let start = ReferenceRay {
            position: entry,
            wave_vector: p,
            electric_field: p.any_orthonormal_vector(),
            optical_path: 0.0,
        };
        let inside = |r: DVec3| (CUT[0] - r.x).min(CUT[1] - r.y);
        let end = follow(start, 0.05, 10_000, |r| medium(&map, r), inside)
            .filter(|end| end.position.y < CUT[1] - 1e-3)
            .ok_or("the end of a ray")?;
        let direction = refracted(end.wave_vector, DVec3::X, 1.0).ok_or("the end of a ray")?;
        let (leaves, _) = rays.trace(&launch(CAMERA, d));
        let leaf = strongest(leaves, 0)?;
        let path = entry.distance(CAMERA) + end.optical_path;
        off = off
            .max(leaf.position.distance(end.position))
            .max((leaf.optical_path - path).abs())
            .max(100.0 * leaf.direction.distance(direction));
    }
    page.says("2", "Rays follow an equation of motion derived from Fermat's principle")
        .computed(format!(
            "9 rays through (iv), stepped along it in physical space, differ from the \
             program's by {} in place, optical path, and 100 cm of direction",
            below(off, SINGLE, "cm")
        ))
        .verdict(off < 1e-5);
    Ok(())
}

/// n² = 1/|f'|² and its gradient at a point above the floor.
fn medium(map: &ConformalMap, r: DVec3) -> SquaredIndex {
    let Some(zeta) = map.invert(Complex64::new(r.x, r.y)) else {
        return SquaredIndex { value: f64::NAN, gradient: DVec3::NAN };
    };
    let jet = map.jet(zeta);
    let value = jet.f1.norm_sqr().recip();
    // The gradient of ln n in virtual space is -conj(f''/f'); one more conj(f') takes it to
    // physical space.
    let slope = -2.0 * value * (jet.f2 / (jet.f1 * jet.f1)).conj();
    SquaredIndex { value, gradient: DVec3::new(slope.re, slope.im, 0.0) }
}

/// Snell's law into a medium of squared index `square`.
fn refracted(p: DVec3, onward: DVec3, square: f64) -> Option<DVec3> {
    let across = p - onward * p.dot(onward);
    let normal = square - across.length_squared();
    (normal > 0.0).then(|| across + onward * normal.sqrt())
}
