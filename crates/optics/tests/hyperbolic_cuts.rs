//! Indefinite media that are cut such that a tensor has no normal-normal entry: one wave vector has
//! no bounds, and the other waves are as exact as elsewhere.
#![allow(clippy::unwrap_used, reason = "a test may")]

use glam::{DMat3, DVec3};
use optics::interface::Scattering;
use optics::medium::{Medium, Tensor};

#[test]
fn modes_solve_maxwells_equations() {
    let full = DMat3::from_cols(
        DVec3::new(0.0, 1.0, 3.0),
        DVec3::new(1.0, -1.0, 2.0),
        DVec3::new(3.0, 2.0, 0.0),
    );
    let [plain, indefinite, three] = [[2.0, 3.0, 4.0], [1.0, -1.0, 2.0], [-1.0, -3.0, 2.0]]
        .map(|d| DMat3::from_diagonal(d.into()));
    let lossy = |re: DMat3| Tensor { re, im: DMat3::from_diagonal(DVec3::new(0.1, 0.2, 0.0)) };
    let media = [
        (Medium::new(indefinite, 1.0), DVec3::new(1.0, 1.0, 0.0)),
        (Medium::new(plain, indefinite), DVec3::new(1.0, 1.0, 0.0)),
        (Medium::new(indefinite, indefinite), DVec3::new(1.0, 1.0, 0.0)),
        (Medium::new(three, full), DVec3::Z),
        (Medium::new(full, plain), DVec3::Z),
        (Medium::new(lossy(full), full), DVec3::Z),
        (Medium::new(full, full * 1e-9), DVec3::X),
    ];
    for (medium, normal) in media {
        let (medium, normal) = (medium.unwrap(), normal.normalize());
        for along in [DVec3::ZERO, DVec3::X, DVec3::new(0.3, -0.7, 0.4), DVec3::new(-1.9, 1.4, 2.5)]
        {
            let along = along - normal * along.dot(normal);
            let glass = Medium::dielectric(1.5);
            let solved = Scattering::new(&medium, Some(&glass), along, normal);
            for mode in solved.incident.iter().chain(&solved.reflected) {
                assert!(medium.residual(mode) < 1e-6, "{mode:?} {medium:?}");
            }
            for power in solved.power.iter().flatten() {
                let sum: f64 = power.iter().sum();
                assert!(medium.absorbs() || (sum - 1.0).abs() < 1e-9, "{power:?} {medium:?}");
            }
            let back = Scattering::new(&glass, Some(&medium), along, normal);
            for mode in back.transmitted.iter().flatten() {
                assert!(medium.residual(mode) < 1e-6, "{mode:?} {medium:?}");
            }
        }
    }
}
