//! The checked numbers of the square cloak's designs (i) and (ii) (Halimeh & Wegener, Opt. Express
//! 21, 9457 (2013)) at one interface.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::{DMat3, DVec2, DVec3};
use optics::interface::{IncidentWave, OutgoingWave, Side, split};
use optics::medium::{Heading, Medium, ModeKind};
use optics::transformation::StripToRhombus;
use optics::wave::transverse_basis;

/// One segment of design (i) (`positive`) or (ii), in the quadrant x, y > 0.
fn design(positive: bool, quadrant: DVec2) -> Medium {
    let map = StripToRhombus::new(14.1 * 0.5f64.sqrt(), 1.0 / 3f64.sqrt());
    let (DVec3 { x: along_u, y: along_v, z: permittivity }, angle) = map.principal_values();
    let turn = DMat3::from_rotation_z((angle * quadrant.x * quadrant.y).to_radians());
    if positive {
        Medium::uniaxial_magnetic(permittivity, along_v, along_u, turn * DVec3::X).unwrap()
    } else {
        Medium::uniaxial_magnetic(permittivity, along_u, along_v, turn * DVec3::Y).unwrap()
    }
}

/// First-face reflectances of horizontal and vertical light, and the ordinary share of the
/// transmitted horizontal light, at a horizontal angle (degrees) to the line of sight.
fn first_face(medium: &Medium, quadrant: DVec2, azimuth: f64) -> [f64; 3] {
    let alpha = azimuth.to_radians();
    let direction = DVec3::new(alpha.cos(), 0.0, alpha.sin());
    let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let wave = IncidentWave {
        wave_vector: direction,
        attenuation: DVec3::ZERO,
        direction,
        electric: [horizontal.into(), vertical.into()],
        power: [1.0; 2],
    };
    let inward = -quadrant.extend(0.0) * 0.5f64.sqrt();
    let waves = split(&Medium::AIR, medium, &wave, inward);
    let sum = |polarization: usize, of: &dyn Fn(&OutgoingWave<2>) -> bool| {
        waves.iter().filter(|w| of(w)).map(|w| w.power[polarization]).sum::<f64>()
    };
    let reflected = |w: &OutgoingWave<2>| w.side == Side::Reflected;
    [
        sum(0, &reflected),
        sum(1, &reflected),
        sum(0, &|w| w.mode == ModeKind::Ordinary) / sum(0, &|w| !reflected(w)),
    ]
}

#[test]
fn the_first_face_of_designs_i_and_ii() {
    let azimuths = [0.0, 5.0, 10.0, 15.0, 20.0];
    // In percent, to the digits given: reflectance H, V; ordinary share of H.
    let expected = [
        (
            true,
            [0.0, 0.006, 0.019, 0.029, 0.027],
            [31.3, 31.1, 30.6, 29.7, 28.6],
            [0.0, 5.2, 17.9, 33.2, 47.5],
        ),
        (
            false,
            [0.0, 0.013, 0.058, 0.150, 0.327],
            [5.4, 5.5, 5.8, 6.3, 6.9],
            [0.0, 0.13, 0.53, 1.2, 2.1],
        ),
    ];
    for (positive, horizontal, vertical, ordinary) in expected {
        for quadrant in [DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0)] {
            let medium = design(positive, quadrant);
            for (i, azimuth) in azimuths.into_iter().enumerate() {
                let [h, v, o] = first_face(&medium, quadrant, azimuth).map(|share| share * 100.0);
                assert!((h - horizontal[i]).abs() <= 0.000_51, "{positive} {azimuth}: H {h}");
                assert!((v - vertical[i]).abs() <= 0.051, "{positive} {azimuth}: V {v}");
                let digit = if ordinary[i] < 1.0 { 0.0051 } else { 0.051 };
                assert!((o - ordinary[i]).abs() <= digit, "{positive} {azimuth}: o {o}");
            }
        }
    }
}

#[test]
fn critical_angles_of_designs_i_and_ii() {
    // (i): beyond 58.26 degrees in air the ordinary wave is evanescent.
    let ordinary = |positive: bool, tangential: f64| {
        let normal = DVec3::new(1.0, 1.0, 0.0).normalize();
        let across = DVec3::new(-1.0, 1.0, 0.0).normalize();
        let medium = design(positive, DVec2::new(-1.0, -1.0));
        medium.modes(across * tangential, normal, Heading::Forward)[0]
    };
    let below = ordinary(true, 58.25f64.to_radians().sin());
    let above = ordinary(true, 58.27f64.to_radians().sin());
    assert!(below.is_propagating() && !above.is_propagating());
    // (ii): ordinary light inside leaves up to an angle of 21.06 degrees.
    let trapped = |angle: f64| {
        let index = ordinary(false, 0.1).wave_vector.re.length();
        let tangential = index * angle.to_radians().sin();
        let across = DVec3::new(-1.0, 1.0, 0.0).normalize();
        let normal = DVec3::new(1.0, 1.0, 0.0).normalize();
        let [air, _] = Medium::AIR.modes(across * tangential, normal, Heading::Forward);
        !air.is_propagating()
    };
    assert!(!trapped(21.05) && trapped(21.07));
}

#[test]
fn the_rotation_at_which_design_i_begins_to_reflect_totally() {
    // The ordinary wave, in air, on the face that turns away from the line of sight: from 13.26
    // degrees on in the centre plane, sooner at an azimuth, never at rotation 0.
    let medium = design(true, DVec2::new(-1.0, -1.0));
    let onset = |azimuth: f64| {
        let alpha = azimuth.to_radians();
        let (mut below, mut above) = (0.0, 45.0);
        for _ in 0..50 {
            let middle = f64::midpoint(below, above);
            // The line of sight in the frame of a cloak turned by so much.
            let turn = DMat3::from_rotation_z(-f64::to_radians(middle));
            let direction = turn * DVec3::new(alpha.cos(), 0.0, alpha.sin());
            let normal = DVec3::new(1.0, 1.0, 0.0).normalize();
            let [ordinary, _] = medium.modes(direction, normal, Heading::Forward);
            *(if ordinary.is_propagating() { &mut below } else { &mut above }) = middle;
        }
        below
    };
    assert!((onset(0.0) - 13.26).abs() < 0.005, "{}", onset(0.0));
    // By hand: cos α cos(45° + φ) = cos 58.26°.
    for azimuth in [5.0, 10.0, 15.0, 20.0] {
        let cosine = 58.26f64.to_radians().cos() / f64::to_radians(azimuth).cos();
        let expected = cosine.acos().to_degrees() - 45.0;
        assert!((onset(azimuth) - expected).abs() < 0.006, "{azimuth}: {}", onset(azimuth));
        assert!(expected > 10.0 && expected < 13.26);
    }
}
