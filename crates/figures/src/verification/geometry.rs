//! Section 1 and 2: the trivial cloak, the setting and the materials.

use super::finding::{DOUBLE, GOOD, Page, Verdict, below, percent};
use super::fixture::{
    DESIGNS, Fixture, GAUSSIAN, camera_direction, fact, facts, launch, square, tracer, undisturbed,
};
use super::{Result, VerificationError};
use glam::DVec3;
use optics::interface::{IncidentWave, Side, split};
use optics::medium::Medium;
use optics::wave::SPEED_OF_LIGHT;

/// By how much rays slant that do not come along the axis, degrees.
const SLANT: f64 = 5.0;

pub(super) fn introduction(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let assembly = fixture.assembly("[[device]]\nkind = \"mirror-detour\"\n")?;
    let mut rays = tracer(&assembly, 1e-9);
    let origin = DVec3::new(-60.0, 3.0, 0.0);
    let (leaves, _) = rays.trace(&launch(origin, DVec3::X));
    let leaf = leaves.first().ok_or("a ray through the mirrors")?;
    let straight = leaf.position.x - origin.x;
    let delay = (leaf.optical_path - straight) / SPEED_OF_LIGHT;
    let turned = leaf.direction.distance(DVec3::X);
    let beside = (leaf.position.y - origin.y).abs();
    let whole = leaf.power.iter().all(|power| *power > 1.0 - 1e-9);
    let (angle, off) = (below(turned, DOUBLE, "rad"), below(beside, DOUBLE, "cm"));
    let [h, v] = leaf.power.map(|power| percent(power, 0));
    page.says(
        "1",
        "Plane mirrors can guide rays around an object such that they leave with their \
         direction, for any polarization",
    )
    .computed(format!("along x: turned by {angle}, {off} off its line, power H {h}, V {v}"))
    .verdict(turned < 1e-12 && beside < 1e-9 && whole);
    page.says("1", "The detour makes the optical path longer: a ray cloak, no wave cloak")
        .computed(format!("{:.2} cm longer, {delay:.3} ns late", delay * SPEED_OF_LIGHT))
        .verdict(delay > 1e-6);
    // Rays that would hit what is hidden, along x and slanted, up and to the side.
    let mut on = [0.0; 3];
    for (on, direction) in on.iter_mut().zip([[0.0, 0.0], [0.0, SLANT], [SLANT, 0.0]]) {
        let direction = camera_direction(direction[0], direction[1]);
        for i in 0..40 {
            let y = 7.5 * ((f64::from(i) + 0.5) / 20.0 - 1.0);
            let origin = DVec3::new(0.0, y, 0.0) - direction * 60.0;
            let [h, v] = undisturbed(&mut rays, origin, direction);
            *on += 0.5 * (h + v) / 40.0;
        }
    }
    let [along, up, side] = on.map(|share| percent(share, 0));
    page.says("1", "It works for one viewing direction only")
        .computed(format!(
            "on its own line along x {along}, {SLANT} degrees up {up}, {SLANT} degrees to the side {side} \
             of the power"
        ))
        .verdict(on[0] > 1.0 - 1e-9 && on[1].max(on[2]) < GOOD);
    Ok(())
}

pub(super) fn setting(_: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let cloak = square(DESIGNS[2]);
    let of = |name| fact(&cloak, name);
    page.says("Fig. 1", "A square of side 14.1 cm holds a rhombus of side 11.51 cm")
        .number(of("rhombus_side_cm")?, (11.51, 2, " cm"));
    page.says("Fig. 1", "The axes of the segments are turned by 33.54 degrees")
        .number(of("axis_u_angle_deg")?.abs(), (33.54, 2, " degrees"));
    page.says("Fig. 1", "The region cloaked by (i)-(iii) has 114.83 cm²")
        .number(of("cloaked_area_cm2")?, (114.83, 2, " cm²"))
        .because("The side of 14.1 cm is rounded: 14.103 cm has this area.");
    page.says("Fig. 1", "The region cloaked by (iv) has 114.83 cm²")
        .number(fact(GAUSSIAN, "cloaked_area_cm2")?, (114.83, 2, " cm²"));
    page.says("3", "Turned, (i)-(iii) look like a flat mirror 19.94 cm wide")
        .number(of("mirror_width_cm")?, (19.94, 2, " cm"));
    Ok(())
}

pub(super) fn materials(_: &Fixture<'_>, page: &mut Page) -> Result<()> {
    // Normal incidence, the axis along the surface: the normal parts of p are the indices.
    let (permittivity, ordinary, extraordinary) = (2.366, 0.31, 3.27);
    let medium = Medium::uniaxial_magnetic(permittivity, ordinary, extraordinary, DVec3::Y)
        .map_err(|error| VerificationError::Missing(error.to_string()))?;
    let wave = IncidentWave {
        wave_vector: DVec3::X,
        attenuation: DVec3::ZERO,
        direction: DVec3::X,
        electric: [DVec3::Y.into(), DVec3::Z.into()],
        power: [1.0; 2],
    };
    let mut indices: Vec<f64> = split(&Medium::AIR, &medium, &wave, DVec3::X)
        .iter()
        .filter(|wave| wave.side == Side::Transmitted)
        .map(|wave| wave.wave_vector.x)
        .collect();
    indices.sort_by(f64::total_cmp);
    let expected = [(permittivity * ordinary).sqrt(), (permittivity * extraordinary).sqrt()];
    let worst = indices.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let shown: Vec<String> = indices.iter().map(|n| format!("{n:.4}")).collect();
    page.says("2", "n_o = sqrt(ε µ_o) and n_e = sqrt(ε µ_e)")
        .computed(format!(
            "ε = {permittivity}, µ_o = {ordinary}, µ_e = {extraordinary}: the waves have {}",
            shown.join(" and ")
        ))
        .verdict(indices.len() == 2 && worst < 1e-12);
    for (statement, material, [printed_o, printed_e]) in [
        ("(i) is positive uniaxial: µ_o = 0.31, µ_e = 3.27", DESIGNS[0], [0.31, 3.27]),
        ("(ii) is negative uniaxial: µ_o = 3.27, µ_e = 0.31", DESIGNS[1], [3.27, 0.31]),
    ] {
        let [u, v, z] = facts(&square(material), "permeability_principal_values")?;
        let (ordinary, extraordinary) = if material == DESIGNS[0] { (v, u) } else { (u, v) };
        let agree = [(ordinary, printed_o), (z, printed_o), (extraordinary, printed_e)]
            .into_iter()
            .all(|(value, printed)| Verdict::number(value, printed, 2) == Verdict::Agrees);
        page.says("3", statement)
            .computed(format!("µ_o = {ordinary:.4}, µ_e = {extraordinary:.4}"))
            .verdict(agree);
    }
    Ok(())
}
