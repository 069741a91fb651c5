//! Section 4 and 5: design (iv).

use super::finding::{Page, Verdict, above, list, percent};
use super::fixture::{
    CAMERA, DESIGNS, Fixture, GAUSSIAN, camera_direction, fact, largest_difference, launch,
    likeness, square, strongest, tracer,
};
use super::{Result, VerificationError};
use cloakroom::measure::PixelMask;
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;

/// The size of the cloak along x, cm.
const DEPTH: f64 = 50.0;

pub(super) fn index(_: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let exact = format!("{GAUSSIAN}w = 10.0158\nh = 4.2532\n");
    let referenced = format!("{GAUSSIAN}referenced = true\n");
    let (from, to) = (fact(&referenced, "index_min")?, fact(&referenced, "index_max")?);
    let wide = fact(GAUSSIAN, "mirror_width_cm")?;
    let narrow = fact(&square(DESIGNS[2]), "mirror_width_cm")?;
    page.says("4", "w = 10.02 cm and h = 4.25 cm lead to a minimum index of 0.873")
        .number(fact(GAUSSIAN, "index_min")?, (0.873, 3, ""));
    page.says("4", "and to a maximum index of 1.920")
        .number(fact(GAUSSIAN, "index_max")?, (1.920, 3, ""))
        .because(
            "w and h are rounded: 10.0158 and 4.2532 cm, which round to the same digits, give \
             1.920.",
        );
    page.says("4", "The same with w and h that round to the printed digits, 10.0158 and 4.2532 cm")
        .number(fact(&exact, "index_max")?, (1.920, 3, ""));
    page.says("5", "Dividing the index by its minimum references it to 1")
        .computed(format!("{from:.3} to {to:.3}"))
        .verdict(Verdict::number(from, 1.0, 9));
    page.says("4, 5", "Turned, (iv) looks like a wider mirror than (i)-(iii)")
        .computed(format!("{wide:.2} cm against {narrow:.2} cm"))
        .verdict(wide > narrow);
    Ok(())
}

pub(super) fn polarization(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let h = fixture.show(GAUSSIAN, "horizontal")?.view;
    let v = fixture.show(GAUSSIAN, "vertical")?.view;
    let difference = largest_difference(&h, &v);
    let pairs = || h.light.iter().zip(&v.light).flat_map(|(h, v)| h.iter().zip(v));
    let rms = (pairs().map(|(h, v)| (h - v).powi(2)).sum::<f64>() / pairs().count() as f64).sqrt();
    let [delivered, _] = fixture.show(GAUSSIAN, "none")?.statistics("delivered")?;
    page.says("4", "(iv) is polarization insensitive")
        .computed(format!(
            "difference of linear light between H and V: RMS {rms:.4}, at most \
             {difference:.2}; a step of 8 bits is 0.0039"
        ))
        .verdict(Verdict::limit(rms, 1.0 / 255.0));
    page.says("4", "(iv) transmits all of the light along the axis")
        .computed(format!(
            "{} of the view's power comes from the photograph",
            percent(delivered, 1)
        ))
        .verdict(Verdict::number(100.0 * delivered, 100.0, 1));
    Ok(())
}

pub(super) fn views(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let metal = format!("{GAUSSIAN}show = \"bare\"\n");
    let empty = fixture.show("", "none")?.view;
    let cloaked = fixture.show(GAUSSIAN, "none")?.view;
    let bare = fixture.show(&metal, "none")?.view;
    let silhouette = fixture.silhouette(&metal)?;
    let whole = PixelMask::whole(&empty);
    let like = |view, region| likeness(&empty, view, region);
    let [with, without] = [like(&cloaked, &silhouette)?, like(&bare, &silhouette)?];
    let [all_with, all_without] = [like(&cloaked, &whole)?, like(&bare, &whole)?];
    let off = fixture.displacement(GAUSSIAN, "none")?;
    // How much higher than without the cloak light comes from that is seen at an angle upwards, cm.
    let assembly = fixture.assembly(GAUSSIAN)?;
    let mut rays = tracer(&assembly, 1e-3);
    let mut raised = |right: f64, up: f64| {
        let direction = camera_direction(right, up);
        let height = |origin: DVec3, d: DVec3| origin.y + d.y * (50.0 - origin.x) / d.x;
        let (leaves, _) = rays.trace(&launch(CAMERA, direction));
        let leaf = strongest(leaves, 0)?;
        Ok::<_, VerificationError>(
            height(leaf.position, leaf.direction) - height(CAMERA, direction),
        )
    };
    let (near, far) = (raised(18.0, 0.5)?, raised(18.0, 12.0)?);
    let (middle_near, middle_far) = (raised(0.0, 0.5)?, raised(0.0, 12.0)?);
    page.says(
        "4, Fig. 8",
        "The bare corrugation distorts the view severely; with the cloak it vanishes",
    )
    .computed(format!(
        "correlation with the empty view where the metal is seen: cloaked {with:.2}, bare \
         {without:.2}"
    ))
    .verdict(with > without);
    page.says("4, Fig. 8", "The cloaking in three dimensions is also very good")
        .computed(format!(
            "correlation of the whole picture {all_with:.2}, bare {all_without:.2}; RMS \
             displacement {off:.1} cm"
        ))
        .verdict(all_with > all_without)
        .because(
            "The cloak fills the view and displaces its detail towards the sides; bare metal \
             leaves most of it alone.",
        );
    page.says(
        "4, Fig. 8",
        "To the left and right the image is cut around the middle horizontal line and \
         stretched towards it, less so further from it, and not on the middle vertical \
         line",
    )
    .computed(format!(
        "0.5 degrees up, light comes from {near:.2} cm higher than in the empty view 18 \
         degrees to the side, {middle_near:.2} cm in the middle; 12 degrees up, {far:.2} \
         and {middle_far:.2} cm"
    ))
    .verdict(near > middle_near.abs() && (far - middle_far).abs() < (near - middle_near).abs());
    Ok(())
}

pub(super) fn times(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let shown = fixture.show(GAUSSIAN, "none")?;
    let (Some(differences), Some(flights)) =
        (&shown.view.time_of_flight_difference, &shown.view.time_of_flight)
    else {
        return Err("times of flight".into());
    };
    let pairs = || differences.iter().zip(flights).filter(|(d, _)| d.is_finite());
    let largest = pairs().map(|(d, _)| d.abs()).fold(0.0, f64::max);
    let of_flight = pairs().map(|(d, t)| (d / (t - d)).abs()).fold(0.0, f64::max);
    let through = DEPTH / SPEED_OF_LIGHT;
    let of_cloak = largest / through;
    page.says("4, Fig. 8", "The time of flight differs by less than 0.1 ns")
        .computed(format!("at most {largest:.3} ns"))
        .verdict(Verdict::limit(largest, 0.1));
    page.says("4, Fig. 8", "That is a maximum relative error of 6 %")
        .computed(format!(
            "{} of the {through:.2} ns through 50 cm of air; {} of the whole flight from the \
             photograph to the camera",
            percent(of_cloak, 1),
            percent(of_flight, 1)
        ))
        .verdict(Verdict::number(100.0 * of_cloak, 6.0, 0))
        .because(
            "6 % is 0.1 ns over the free flight through the cloak; over the whole flight it \
             is less.",
        );
    Ok(())
}

pub(super) fn reflections(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let reflection = |rotation: i32, polarizer: &str| {
        fixture.reflection(&format!("{GAUSSIAN}rotation = {rotation}\n"), polarizer)
    };
    let [still_mean, still_most] = reflection(0, "none")?;
    let mut most: f64 = 0.0;
    let mut mean: f64 = 0.0;
    for rotation in [0, 5, 10, 20] {
        for polarizer in ["horizontal", "vertical"] {
            let [average, largest] = reflection(rotation, polarizer)?;
            mean = mean.max(average);
            most = most.max(largest);
        }
    }
    let mut others = [0.0; 2];
    for (material, other) in DESIGNS.iter().zip(&mut others) {
        *other = fixture.reflection(&square(material), "none")?[0];
    }
    let [average, largest] = [still_mean, still_most].map(|share| percent(share, 3));
    let [one, two] = others.map(|share| percent(share, 1));
    page.says("4, Fig. 8", "Fresnel reflection along the axis is of the order of 0.01 % or less")
        .computed(format!("first face: {average} on average, at most {largest}"))
        .verdict(Verdict::limit(still_most, 0.0001))
        .because(
            "Fresnel's formulas with the index at the cut, 0.96 in the middle, give 0.06 % \
             there.",
        );
    page.says("4, Fig. 9", "In all settings of Figs. 8 and 9 it is less than 0.2 %")
        .computed(format!(
            "first face, either polarization: at most {} on average over a view, {} anywhere \
             in it",
            percent(mean, 3),
            percent(most, 2)
        ))
        .verdict(Verdict::limit(most, 0.002));
    page.says("4", "It is smaller by orders of magnitude than for (i) and (ii)")
        .computed(format!("on average, unpolarized: (i) {one}, (ii) {two}, (iv) {average}"))
        .verdict(others[0].min(others[1]) > 100.0 * still_mean);
    Ok(())
}

pub(super) fn turned(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let (mut cloak, mut bare) = ([0.0; 3], [0.0; 3]);
    for (i, rotation) in [5, 10, 20].into_iter().enumerate() {
        let device = format!("{GAUSSIAN}rotation = {rotation}\n");
        let silhouette = fixture.silhouette(&format!("{device}show = \"bare\"\n"))?;
        let show = |what| fixture.show(&format!("{device}show = \"{what}\"\n"), "none");
        let mirror = show("mirror")?.view;
        let like = |what| likeness(&mirror, &show(what)?.view, &silhouette);
        (cloak[i], bare[i]) = (like("cloak")?, like("bare")?);
    }
    page.says(
        "4, Fig. 9",
        "Turned by 5, 10, 20 degrees, (iv) behaves as a Gaussian carpet cloak does: as a \
         flat mirror",
    )
    .computed(format!(
        "correlation with a mirror 50 cm wide, where the metal is seen: cloaked {}, bare {}",
        list(cloak),
        list(bare)
    ))
    .verdict(above(cloak, bare));
    Ok(())
}
