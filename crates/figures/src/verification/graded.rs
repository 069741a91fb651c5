//! Section 4 and 5: design (iv).

use super::finding::{GOOD, Page, SEEN, VERY_GOOD, Verdict, list, percent};
use super::fixture::{
    CAMERA, DESIGNS, Fidelity, Fixture, GAUSSIAN, HALF_VIEW, MainPath, TURNS, WIDE_HALF_VIEW, are,
    camera_direction, fact, in_both_views, in_words, launch, square, strongest, tracer, turned_by,
};
use super::{Result, VerificationError};
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;
use std::f64::consts::PI;

/// The views that are looked at.
const VIEWS: [f64; 2] = [HALF_VIEW, WIDE_HALF_VIEW];

/// What may leave the main path without being more than the paper says, as a share of the power.
const WEAK: f64 = 0.002;

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

/// A thinner, higher bump that hides the same area.
pub(super) fn thinner_bump(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    /// Its width parameter, cm, of which the paper's is 10.02.
    const THINNER: f64 = 9.0;
    const PAPERS: f64 = 10.02;
    let area = fact(GAUSSIAN, "cloaked_area_cm2")?;
    let narrow = fact(&square(DESIGNS[2]), "mirror_width_cm")?;
    // 2 (sqrt(pi) h w - h²) is the area; it is largest for h = sqrt(pi) w/2, where the index is
    // infinite.
    let half = 0.5 * PI.sqrt() * THINNER;
    let height = half - (half * half - 0.5 * area).sqrt();
    let thinnest = (2.0 * area / PI).sqrt();
    // Cut where the metal is as low, measured in w.
    let bump =
        |w: f64, h: f64| format!("{GAUSSIAN}w = {w}\nh = {h}\nwidth = {}\n", DEPTH * w / PAPERS);
    let bump = bump(THINNER, height);
    let hidden = fact(&bump, "cloaked_area_cm2")?;
    let wide = fact(&bump, "mirror_width_cm")?;
    let index = fact(&bump, "index_max")?;
    let turned = |device: &str| {
        let [still, turned] =
            [0, 5].map(|degrees| fixture.fidelity(&turned_by(device, degrees), "", "none"));
        Ok::<_, VerificationError>([still?, turned?])
    };
    let (thin, papers) = (turned(&bump)?, turned(GAUSSIAN)?);
    page.says("4", "A thinner, higher bump, cut properly, avoids the wider mirror")
        .computed(format!(
            "w = {THINNER} and h = {height:.2} cm hide {hidden:.2} cm² behind a mirror {wide:.2} cm wide, \
             with an index up to {index:.2}; against the empty view, turned by 0 and 5 degrees: {}; the paper's bump {}",
            in_words(&thin),
            in_words(&papers)
        ))
        .verdict(wide <= narrow)
        .because(format!(
            "It makes it narrower, but by little at the same hidden area: no bump of this map below \
             w = {thinnest:.2} cm hides as much, which leaves {:.1} cm against {narrow:.2}.",
            DEPTH * thinnest / PAPERS
        ));
    Ok(())
}

pub(super) fn polarization(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let paths = fixture.main_paths(HALF_VIEW, GAUSSIAN)?;
    let differences = || paths.iter().map(|path| path.between_polarizations);
    let most = differences().fold(0.0, f64::max);
    let seen = differences().filter(|share| *share > SEEN).count() as f64 / paths.len() as f64;
    let [h, v] = ["horizontal", "vertical"].map(|p| fixture.fidelity(GAUSSIAN, "", p));
    let (h, v) = (h?, v?);
    let least = |half_view| -> Result<f64> {
        let shown = fixture.show_at(half_view, GAUSSIAN, "none")?;
        Ok(shown.numbers("delivered")?.into_iter().fold(1.0, f64::min))
    };
    let delivered = [least(HALF_VIEW)?, least(WIDE_HALF_VIEW)?];
    page.says("4", "(iv) is polarization insensitive")
        .computed(format!(
            "H and V part with at most {} of a ray's power, with more than {} on {} of the view; H {}, V {}",
            percent(most, 1),
            percent(SEEN, 0),
            percent(seen, 1),
            h.words(),
            v.words()
        ))
        .verdict_in_place([0, 1].map(|within| (h.in_place[within] - v.in_place[within]).abs() < SEEN));
    page.says("4", "(iv) transmits all of the light along the axis")
        .computed(format!(
            "at least {} of a ray's power comes from the photograph",
            in_both_views(delivered, |share| percent(share, 1))
        ))
        .verdict_on_number(100.0 * delivered[0], 100.0, 1);
    Ok(())
}

pub(super) fn views(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let metal = format!("{GAUSSIAN}show = \"bare\"\n");
    let cloaked = fixture.fidelity(GAUSSIAN, "", "none")?;
    let bare = fixture.fidelity(&metal, "", "none")?;
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
    let against = format!("{}; bare metal {}", cloaked.words(), bare.words());
    page.says(
        "4, Fig. 8",
        "The bare corrugation distorts the view severely; with the cloak it vanishes completely",
    )
    .computed(against.clone())
    .verdict_in_place(are(&[cloaked], VERY_GOOD, &[bare]));
    page.says("4, 5, Fig. 8", "The cloaking in three dimensions is also very good, amazingly good")
        .computed(format!("{against}; RMS displacement {off:.1} cm"))
        .verdict_in_place(are(&[cloaked], VERY_GOOD, &[bare]));
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
    // The largest difference of the times, and that as a share of the whole flight.
    let largest = |half_view| -> Result<[f64; 2]> {
        let shown = fixture.show_at(half_view, GAUSSIAN, "none")?;
        let (Some(differences), Some(flights)) =
            (&shown.view.time_of_flight_difference, &shown.view.time_of_flight)
        else {
            return Err("times of flight".into());
        };
        let pairs = || differences.iter().zip(flights).filter(|(d, _)| d.is_finite());
        Ok([
            pairs().map(|(d, _)| d.abs()).fold(0.0, f64::max),
            pairs().map(|(d, t)| (d / (t - d)).abs()).fold(0.0, f64::max),
        ])
    };
    let [near, wide] = [largest(HALF_VIEW)?, largest(WIDE_HALF_VIEW)?];
    let through = DEPTH / SPEED_OF_LIGHT;
    let of_cloak = [near[0], wide[0]].map(|difference| difference / through);
    page.says("4, Fig. 8", "The time of flight differs by less than 0.1 ns")
        .computed(format!(
            "at most {}",
            in_both_views([near[0], wide[0]], |difference| format!("{difference:.3} ns"))
        ))
        .verdict_on_limit(near[0], 0.1);
    page.says("4, Fig. 8", "That is a maximum relative error of 6 %")
        .computed(format!(
            "{} of the {through:.2} ns through 50 cm of air; {} of the whole flight from the \
             photograph to the camera",
            in_both_views(of_cloak, |share| percent(share, 1)),
            in_both_views([near[1], wide[1]], |share| percent(share, 1))
        ))
        .verdict_on_number(100.0 * of_cloak[0], 6.0, 0)
        .because(
            "6 % is 0.1 ns over the free flight through the cloak, and it grows with the field of \
             view, which the paper does not give; over the whole flight it is less.",
        );
    Ok(())
}

pub(super) fn reflections(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let first =
        |half_view, device: &str, polarizer: &str| fixture.reflection(half_view, device, polarizer);
    let mut still = [0.0; 2];
    // The largest first reflection, and the share of the view where more than the paper says leaves
    // the main path and where a reflection at a face of the cloak is seen, for each turn; its
    // largest share.
    let mut most: [f64; 2] = [0.0; 2];
    let mut more = [[0.0; 2]; 4];
    let mut mirrored = [[0.0; 2]; 4];
    let mut strongest_mirrored: [f64; 2] = [0.0; 2];
    for view in 0..2 {
        still[view] = first(VIEWS[view], GAUSSIAN, "none")?[1];
        for turn in 0..4 {
            let device = turned_by(GAUSSIAN, TURNS[turn]);
            for polarizer in ["horizontal", "vertical"] {
                most[view] = most[view].max(first(VIEWS[view], &device, polarizer)?[1]);
            }
            let paths = fixture.main_paths(VIEWS[view], &device)?;
            let share = |is: fn(&MainPath) -> bool| {
                paths.iter().filter(|path| is(path)).count() as f64 / paths.len() as f64
            };
            more[turn][view] = share(|path| path.off > WEAK);
            mirrored[turn][view] = share(|path| path.reflected_at_a_face > SEEN);
            let reflected = paths.iter().map(|path| path.reflected_at_a_face);
            strongest_mirrored[view] = reflected.fold(strongest_mirrored[view], f64::max);
        }
    }
    let [one, two, four] = [square(DESIGNS[0]), square(DESIGNS[1]), GAUSSIAN.to_owned()];
    let means = |polarizer: &str| -> Result<[f64; 3]> {
        let [one, two, four] =
            [&one, &two, &four].map(|device| first(HALF_VIEW, device, polarizer));
        Ok([one?[0], two?[0], four?[0]])
    };
    let turns = |shares: &[[f64; 2]; 4]| {
        list(shares, |share| in_both_views(*share, |share| percent(share, 1)))
    };
    page.says("4, Fig. 8", "Fresnel reflection along the axis is of the order of 0.01 % or less")
        .computed(format!(
            "first face, unpolarized: at most {}",
            in_both_views(still, |share| percent(share, 3))
        ))
        .verdict_on_limit(still[0], 0.0001)
        .because(
            "Fresnel's formulas with the index at the cut, 0.96 in the middle, give 0.06 % \
             there.",
        );
    page.says("4, Fig. 9", "In all settings of Figs. 8 and 9 it is less than 0.2 %")
        .computed(format!(
            "first face, either polarization: at most {}; all surfaces: more than {} leaves the main \
             path, turned by 0, 5, 10, 20 degrees, on {} of the view",
            in_both_views(most, |share| percent(share, 2)),
            percent(WEAK, 1),
            turns(&more)
        ))
        .verdict(most[0] <= WEAK && more.iter().all(|share| share[0] == 0.0))
        .because(
            "It holds at the first face; light that reaches the upper and lower face from inside at a \
             slant is reflected there.",
        );
    page.says("4, Figs. 8, 9", "One sees no specular reflections on the surface of the cloak")
        .computed(format!(
            "faces of the cloak reflect, from inside, more than {} of what is seen on {} of the view, \
             turned by 0, 5, 10, 20 degrees, and up to {}",
            percent(SEEN, 0),
            turns(&mirrored),
            in_both_views(strongest_mirrored, |share| percent(share, 0))
        ))
        .verdict(mirrored.iter().all(|share| share[0] == 0.0))
        .because(
            "Light reaches the upper and lower face at a slant from inside: Fig. 8(c) shows books mirrored \
             at top and bottom.",
        );
    for (polarizer, statement) in [
        ("vertical", "It is smaller by orders of magnitude than for (i) and (ii), vertical"),
        ("horizontal", "The same, horizontal"),
    ] {
        let [one, two, four] = means(polarizer)?;
        let finding = page.says("4", statement);
        finding
            .computed(format!(
                "first face, on average: (i) {}, (ii) {}, (iv) {}",
                percent(one, 4),
                percent(two, 4),
                percent(four, 4)
            ))
            .verdict(one.min(two) > 100.0 * four);
        if polarizer == "horizontal" {
            finding.because("(i) hardly reflects horizontal light there, less than (iv).");
        }
    }
    Ok(())
}

pub(super) fn turned(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let half = |rotation: i32| {
        format!("[[device]]\nkind = \"gaussian-carpet\"\nfloor = 0\nrotation = {rotation}\n")
    };
    // Against two carpets and against a flat mirror, for 5, 10, 20 degrees.
    let (mut carpets, mut mirror, mut bare) = (Vec::new(), Vec::new(), Vec::new());
    // Of all designs, horizontal, against the empty view, for 0, 5, 10, 20 degrees.
    let mut empty = vec![Vec::new(); 4];
    for turn in TURNS {
        let device = turned_by(GAUSSIAN, turn);
        let show = |what: &str| format!("{device}show = \"{what}\"\n");
        if turn > 0 {
            let two = half(turn) + &half(turn + 180);
            carpets.push(fixture.fidelity(&device, &two, "none")?);
            mirror.push(fixture.fidelity(&device, &show("mirror"), "none")?);
            bare.push(fixture.fidelity(&show("bare"), &show("mirror"), "none")?);
        }
        let designs = DESIGNS.map(|material| turned_by(&square(material), turn));
        for (empty, device) in empty.iter_mut().zip(designs.iter().chain([&device])) {
            empty.push(fixture.fidelity(device, "", "horizontal")?);
        }
    }
    let shares = |of: &[Fidelity]| list(of, |seen| percent(seen.in_place[0], 1));
    page.says(
        "4, Fig. 9",
        "Turned by 5, 10, 20 degrees, (iv) behaves similarly to the Gaussian carpet cloak",
    )
    .computed(format!("against two of these back to back: {}", in_words(&carpets)))
    .verdict_in_place(are(&carpets, VERY_GOOD, &bare));
    page.says("4, Fig. 9", "which gives the illusion of a flat mirror")
        .computed(format!(
            "against a mirror 50 cm wide: {}; bare metal {}",
            in_words(&mirror),
            in_words(&bare)
        ))
        .verdict_in_place(are(&mirror, GOOD, &bare));
    let words: Vec<String> = ["(i)", "(ii)", "(iii)", "(iv)"]
        .iter()
        .zip(&empty)
        .map(|(name, empty)| format!("{name} {}", shares(empty)))
        .collect();
    page.says("5", "The range of viewing angles of (iv) is narrower than that of (i)-(iii)")
        .computed(format!(
            "H against the empty view, turned by 0, 5, 10, 20 degrees, in place: {}",
            words.join("; ")
        ))
        .verdict((1..4).all(|turn| {
            (0..3).all(|design| empty[3][turn].in_place[0] < empty[design][turn].in_place[0])
        }));
    Ok(())
}
