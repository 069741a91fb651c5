//! Section 3, designs (i) and (ii).

use super::Result;
use super::finding::{
    DOUBLE, GOOD, NO_CLOAKING, Page, SEEN, SINGLE, VERY_GOOD, below, list, percent,
};
use super::fixture::{
    CAMERA, DESIGNS, Fidelity, Fixture, GAUSSIAN, HALF_VIEW, TURNS, WIDE_HALF_VIEW, are,
    camera_direction, fact, facts, in_both_views, in_words, largest_difference, launch,
    reflected_inside, square, strongest, tracer, turned_by, undisturbed,
};
use glam::{DVec2, DVec3};

/// The share of the unpolarized power that makes a pulse a main one, and how far apart distinct
/// ones are, ns.
const MAIN_PULSE: f64 = 0.1;
const DISTINCT_NS: f64 = 1e-3;

/// Heights at which rays along the axis meet the cloak, cm.
fn heights() -> impl Iterator<Item = f64> {
    (0..40).map(|i| -9.5 + 19.0 * (f64::from(i) + 0.5) / 40.0)
}

pub(super) fn along_the_axis(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let mut through = [0.0f64; 2];
    for (material, through) in DESIGNS.iter().zip(&mut through) {
        let assembly = fixture.assembly(&square(material))?;
        let mut rays = tracer(&assembly, 1e-7);
        // In the centre vertical plane, from the camera.
        let mut least: f64 = 1.0;
        let mut most: f64 = 0.0;
        for i in 0..40 {
            let up = 5.6 * ((f64::from(i) + 0.5) / 20.0 - 1.0);
            let [h, v] = undisturbed(&mut rays, CAMERA, camera_direction(0.0, up));
            least = least.min(h);
            most = most.max(v);
        }
        for y in heights() {
            let [h, v] = undisturbed(&mut rays, DVec3::new(-100.0, y, 0.0), DVec3::X);
            *through = through.max(0.5 * (h + v));
        }
        let perfect = least > 1.0 - 1e-6;
        let (off, on) = (below(1.0 - least, DOUBLE, ""), percent(most, 1));
        if *material == DESIGNS[0] {
            page.says(
                "3, (i)",
                "Horizontal light in the centre vertical plane is cloaked perfectly",
            )
            .computed(format!("all but {off} of its power is on its own line"))
            .verdict(perfect);
            page.says("3, (i)", "Vertical light there is not cloaked at all")
                .computed(format!("at most {on} of its power is on its own line"))
                .verdict(most < 1e-3);
        } else {
            page.says(
                "3, (ii)",
                "So it is for (ii): horizontal light is cloaked in this plane, vertical light is \
                 not",
            )
            .computed(format!("H: all but {off} on its own line; V: at most {on}"))
            .verdict(perfect && most < 1e-3);
        }
    }
    let [first, second] = through.map(|share| percent(share, 1));
    page.says(
        "4",
        "Cloaks (i) and (ii) work for at most half of the unpolarized light along the axis",
    )
    .computed(format!("of a ray's power at most (i) {first}, (ii) {second} goes on undisturbed"))
    .verdict_on_limit(through[0].max(through[1]), 0.5 + DOUBLE);
    Ok(())
}

/// What light of the centre plane with its field along the axis meets of the segments: the
/// permeability in the plane and the permittivity across it.
pub(super) fn centre_plane(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let met = |material: &str| -> Result<[f64; 3]> {
        let device = square(material);
        let permittivity: [f64; 3] = facts(&device, "permittivity_principal_values")?;
        let [u, v, _]: [f64; 3] = facts(&device, "permeability_principal_values")?;
        Ok([u, v, permittivity[2]])
    };
    let [one, two] = [met(DESIGNS[0])?, met(DESIGNS[1])?];
    let different = one.iter().zip(two).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let assemblies = [DESIGNS[0], DESIGNS[1]].map(|material| fixture.assembly(&square(material)));
    let [first, second] = assemblies;
    let (first, second) = (first?, second?);
    let mut rays = [tracer(&first, 1e-6), tracer(&second, 1e-6)];
    let mut off: f64 = 0.0;
    for i in 0..40 {
        let ray = launch(CAMERA, camera_direction(0.0, 5.6 * ((f64::from(i) + 0.5) / 20.0 - 1.0)));
        let [a, b] = rays.each_mut().map(|rays| strongest(rays.trace(&ray).0, 0));
        let (a, b) = (a?, b?);
        off = off
            .max(a.position.distance(b.position))
            .max((a.optical_path - b.optical_path).abs())
            .max(100.0 * a.direction.distance(b.direction));
    }
    page.says("2", "In the centre vertical plane (i) and (ii) are one material distribution")
        .computed(format!(
            "µ in the plane and ε across it, all that H meets there, differ by {}; rays of H by {} \
             in place, optical path, and 100 cm of direction",
            below(different, DOUBLE, ""),
            below(off, 1e-9, "cm")
        ))
        .verdict(different < 1e-12 && off < 1e-9);
    Ok(())
}

pub(super) fn views(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let metal = format!("{}show = \"bare\"\n", square(DESIGNS[2]));
    let bare = fixture.fidelity(&metal, "", "none")?;
    let mut admixture: f64 = 0.0;
    let mut fidelities = Vec::new();
    let mut off = Vec::new();
    // In place in the middle of the view, and at its sides.
    let mut places = Vec::new();
    for material in &DESIGNS[..2] {
        let device = square(material);
        let [h, v, none] = ["horizontal", "vertical", "none"].map(|p| fixture.show(&device, p));
        let (h, v, none) = (h?, v?, none?);
        let mut mean = h.view.clone();
        for (mean, vertical) in mean.light.iter_mut().zip(&v.view.light) {
            mean.iter_mut().zip(vertical).for_each(|(mean, v)| *mean = 0.5 * (*mean + v));
        }
        admixture = admixture.max(largest_difference(&mean, &none.view));
        let judged = |polarizer| fixture.fidelity(&device, "", polarizer);
        fidelities.push([judged("horizontal")?, judged("vertical")?]);
        off.push(fixture.displacement(&device, "horizontal")?);
        let in_place = fixture.in_place(&device, "", "horizontal")?;
        places.push([0.0..2.0, 10.0..12.0, 18.0..20.0].map(|aside| {
            let pixels = fixture.pixels_aside(aside);
            pixels.map(|pixels| {
                pixels.iter().map(|i| in_place[*i][0]).sum::<f64>() / pixels.len() as f64
            })
        }));
    }
    let [[h1, v1], [h2, v2]] = [fidelities[0], fidelities[1]];
    let against = |seen: Fidelity| format!("{}; bare metal {}", seen.words(), bare.words());
    let difference = below(admixture, SINGLE, "");
    page.says(
        "3, Fig. 2",
        "Unpolarized, the image is an admixture of a cloaked and an uncloaked contribution",
    )
    .computed(format!("it is the mean of H and V; largest difference {difference} of white"))
    .verdict(admixture < 1e-5);
    page.says("3, Fig. 2", "(i), horizontal: cloaking is quite good, albeit not perfect")
        .computed(format!("{}; RMS displacement {:.1} cm", against(h1), off[0]))
        .verdict_in_place(
            are(&[h1], GOOD, &[bare]).map(|good| good && h1.in_place[0] < 1.0 - SINGLE),
        );
    page.says("3, Fig. 2", "(i), vertical: no cloaking at all")
        .computed(against(v1))
        .verdict_in_place(v1.in_place.map(|share| share < NO_CLOAKING));
    page.says("3, 5, Fig. 4", "(ii), horizontal: the cloaking is formidable, great in 3D")
        .computed(format!("{}; RMS displacement {:.1} cm", against(h2), off[1]))
        .verdict_in_place(are(&[h2], VERY_GOOD, &[bare]));
    page.says("3, Fig. 4", "(ii), vertical: not cloaked")
        .computed(against(v2))
        .verdict_in_place(v2.in_place.map(|share| share < NO_CLOAKING));
    let mut words = Vec::new();
    let mut falls = true;
    for (name, places) in ["(i)", "(ii)"].into_iter().zip(places) {
        let [middle, between, side] = places;
        let places = [middle?, between?, side?];
        falls &= places[0] > places[2];
        words.push(format!("{name} {}", list(&places, |share| percent(*share, 1))));
    }
    page.says("5", "(i) and (ii) cloak worse away from the centre vertical plane, horizontal")
        .computed(format!(
            "in place 0 to 2, 10 to 12, 18 to 20 degrees to the side: {}",
            words.join("; ")
        ))
        .verdict(falls);
    Ok(())
}

/// Which wave carries the light beyond the first face, and how many pulses come back.
pub(super) fn waves_and_pulses(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    for (place, polarizer, statement) in [
        ("Fig. 2, 4", "horizontal", "In (d), horizontal, extraordinary light dominates"),
        ("Fig. 2, 4", "vertical", "In (e), vertical, ordinary light dominates"),
    ] {
        let mut words = Vec::new();
        let mut dominates = true;
        for (name, material) in ["(i)", "(ii)"].into_iter().zip(DESIGNS) {
            let shown = fixture.show(&square(material), polarizer)?;
            let shares: Vec<f64> = shown
                .numbers("extraordinary_share")?
                .into_iter()
                .map(|share| if polarizer == "horizontal" { share } else { 1.0 - share })
                .collect();
            let mean = shares.iter().sum::<f64>() / shares.len() as f64;
            let least = shares.into_iter().fold(1.0, f64::min);
            dominates &= mean > 0.5;
            words.push(format!(
                "{name} {} on average, {} at least",
                percent(mean, 1),
                percent(least, 1)
            ));
        }
        page.says(place, statement)
            .computed(format!("its share of what enters the first face: {}", words.join("; ")))
            .verdict(dominates);
    }
    let mut counts = Vec::new();
    for device in DESIGNS.map(square).iter().map(String::as_str).chain([GAUSSIAN]) {
        counts.push(fixture.pulses(device, MAIN_PULSE, DISTINCT_NS)?);
    }
    let share = |counts: &[usize], is: fn(usize) -> bool| {
        counts.iter().filter(|count| is(**count)).count() as f64 / counts.len() as f64
    };
    let several = [0, 1].map(|design| share(&counts[design], |count| count > 1));
    let single = [2, 3].map(|design| share(&counts[design], |count| count == 1));
    let most = [0, 1, 2, 3].map(|design| counts[design].iter().copied().max().unwrap_or(0));
    let main = format!(
        "pulses of {} of the unpolarized power from the photograph, {} ps apart",
        percent(MAIN_PULSE, 0),
        1000.0 * DISTINCT_NS
    );
    page.says(
        "1",
        "One pulse makes several main pulses in (i) and (ii), which has no single time of flight",
    )
    .computed(format!(
        "{main}: several for (i) {}, (ii) {} of the rays, up to {} and {}",
        percent(several[0], 1),
        percent(several[1], 1),
        most[0],
        most[1]
    ))
    .verdict(several.iter().all(|share| *share > 0.5));
    page.says(
        "1",
        "(iii) and (iv), which are independent of polarization, have a single time of flight",
    )
    .computed(format!(
        "{main}: one for (iii) {}, (iv) {} of the rays, at most {} and {}",
        percent(single[0], 1),
        percent(single[1], 1),
        most[2],
        most[3]
    ))
    .verdict(single.iter().all(|share| *share == 1.0));
    Ok(())
}

/// What the cloaks look like when they are turned, and the first reflection then.
pub(super) fn turned(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    // For 0, 5, 10, 20 degrees: against what a flat mirror shows, against the empty view, against
    // (iii); the largest first reflection, and the share of the cloak where one is seen.
    let mut mirror = [[Fidelity::default(); 4]; 2];
    let mut empty = [[Fidelity::default(); 4]; 2];
    let mut ideal = [Fidelity::default(); 4];
    let mut bare = [Fidelity::default(); 4];
    let mut first = [[0.0; 4]; 2];
    let mut is_seen = [[0.0; 4]; 2];
    for i in 0..4 {
        let device = |material: &str| turned_by(&square(material), TURNS[i]);
        let perfect = device(DESIGNS[2]);
        let flat = format!("{perfect}show = \"mirror\"\n");
        let metal = format!("{perfect}show = \"bare\"\n");
        bare[i] = fixture.fidelity(&metal, &flat, "horizontal")?;
        for design in 0..2 {
            let cloak = device(DESIGNS[design]);
            let against = |ideal: &str| fixture.fidelity(&cloak, ideal, "horizontal");
            mirror[design][i] = against(&flat)?;
            empty[design][i] = against("")?;
            if design == 1 {
                ideal[i] = against(&perfect)?;
            }
            let shares = fixture.show(&cloak, "horizontal")?.numbers("first_face_reflectance")?;
            first[design][i] = shares.iter().copied().fold(0.0, f64::max);
            let seen = shares.iter().filter(|share| **share > SEEN).count();
            is_seen[design][i] = seen as f64 / shares.len() as f64;
        }
    }
    let reflected = |design: usize| {
        format!(
            "first reflection at most {}; above {} on {} of the cloak",
            list(&first[design][1..], |share| percent(*share, 2)),
            percent(SEEN, 0),
            list(&is_seen[design][1..], |share| percent(*share, 1))
        )
    };
    page.says("3, Fig. 3", "(i), horizontal, turned by 5, 10, 20 degrees: cloaking is rather good")
        .computed(format!(
            "against the flat mirror {}; bare metal {}",
            in_words(&mirror[0][1..]),
            in_words(&bare[1..])
        ))
        .verdict_in_place(are(&mirror[0][1..], GOOD, &bare[1..]));
    page.says(
        "3, Fig. 3",
        "except for significant Fresnel reflections, total ones of the ordinary wave",
    )
    .computed(reflected(0))
    .verdict(first[0][1..].iter().all(|share| *share > SEEN));
    page.says("3, Fig. 5", "(ii), horizontal, turned: no Fresnel reflections, in contrast to (i)")
        .computed(reflected(1))
        .verdict(first[1][1..].iter().zip(&first[0][1..]).all(|(a, b)| *a < SEEN && a < b));
    page.says(
        "3, Fig. 5",
        "(ii), horizontal, turned: a very good carpet cloak, the illusion of a flat \
         mirror turned by the same angle",
    )
    .computed(format!("against the flat mirror {}", in_words(&mirror[1][1..])))
    .verdict_in_place(are(&mirror[1][1..], VERY_GOOD, &bare[1..]));
    page.says("3", "(ii) cloaks significantly better than (i), horizontal")
        .computed(format!(
            "turned by 0, 5, 10, 20 degrees, against the flat mirror: (ii) {}; (i) {}",
            in_words(&mirror[1]),
            in_words(&mirror[0])
        ))
        .verdict(
            mirror[1].iter().zip(&mirror[0]).all(|(two, one)| two.in_place[0] > one.in_place[0]),
        );
    page.says(
        "3",
        "(ii) is remarkably similar in performance to the ideal cloak (iii), but depends on \
         polarization",
    )
    .computed(format!("H against (iii), turned by 0, 5, 10, 20 degrees: {}", in_words(&ideal)))
    .verdict_in_place(are(&ideal, VERY_GOOD, &bare));
    for (statement, empty) in [
        ("(i) cloaks worse at angles away from the axis, horizontal", empty[0]),
        ("(ii) cloaks worse at angles away from the axis, horizontal", empty[1]),
    ] {
        let falls = |within: usize| {
            empty.windows(2).all(|turns| turns[1].in_place[within] < turns[0].in_place[within])
        };
        page.says("5", statement)
            .computed(format!(
                "turned by 0, 5, 10, 20 degrees, against the empty view: {}",
                in_words(&empty)
            ))
            .verdict_in_place([falls(0), falls(1)]);
    }
    Ok(())
}

/// All the power of horizontal light that comes back from rays at an angle to the side: the largest
/// share.
fn backward(fixture: &Fixture<'_>, material: &str, right: f64) -> Result<f64> {
    // Some paths lead straight up or down, to the last digits; that light does not go on, and
    // counts.
    const STRAIGHT_UP: f64 = 1e-9;
    let assembly = fixture.assembly(&square(material))?;
    let mut rays = tracer(&assembly, 1e-5);
    let mut most: f64 = 0.0;
    for y in heights() {
        let direction = camera_direction(right, 0.0);
        let ray = launch(DVec3::new(0.0, y, 0.0) - direction * 60.0, direction);
        let (leaves, _) = rays.trace(&ray);
        let back = leaves.iter().filter(|leaf| leaf.direction.x < STRAIGHT_UP);
        most = most.max(back.map(|leaf| leaf.power[0]).sum());
    }
    Ok(most)
}

pub(super) fn reflections(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    const VIEWS: [f64; 2] = [HALF_VIEW, WIDE_HALF_VIEW];
    let most = |polarizer: &str| -> Result<[f64; 2]> {
        let [near, wide] =
            VIEWS.map(|view| fixture.reflection(view, &square(DESIGNS[1]), polarizer));
        Ok([near?[1], wide?[1]])
    };
    let (horizontal, vertical) = (most("horizontal")?, most("vertical")?);
    let mut back = [[0.0; 2]; 2];
    let mut first = [[0.0; 2]; 2];
    let mut ordinary = [0.0; 2];
    for design in 0..2 {
        let device = square(DESIGNS[design]);
        for view in 0..2 {
            back[design][view] = backward(fixture, DESIGNS[design], VIEWS[view])?;
            first[design][view] = fixture.reflection(VIEWS[view], &device, "horizontal")?[0];
        }
        let shares = fixture.show(&device, "horizontal")?.numbers("extraordinary_share")?;
        ordinary[design] = 1.0 - shares.into_iter().fold(1.0, f64::min);
    }
    let shares =
        |shares: [f64; 2], decimals| in_both_views(shares, |share| percent(share, decimals));
    page.says(
        "3, Fig. 4",
        "Fresnel reflection of (ii) is of the order of less than 3 %, horizontal",
    )
    .computed(format!(
        "at most {} at the first face; all that comes back of rays at the edge of the view {}",
        shares(horizontal, 2),
        shares(back[1], 1)
    ))
    .verdict_on_limit(horizontal[0].max(back[1][0]), 0.03);
    page.says("3, Fig. 4", "The same, vertical")
        .computed(format!("first face: at most {}", shares(vertical, 1)))
        .verdict_on_limit(vertical[0], 0.03)
        .because(
            "The ordinary index of 2.78 reflects more; the paper's number holds for the \
             polarization it cloaks.",
        );
    page.says(
        "3",
        "(i) has more impedance mismatch to the sides than (ii), horizontal, all surfaces",
    )
    .computed(format!(
        "all that comes back of rays at the edge of the view, at most: (i) {}, (ii) {}; in the \
             ordinary wave, at most: (i) {}, (ii) {}",
        shares(back[0], 1),
        shares(back[1], 1),
        percent(ordinary[0], 0),
        percent(ordinary[1], 1)
    ))
    .verdict(ordinary[0] > ordinary[1] && back[0][0] > back[1][0]);
    page.says("3", "The same at the first face, seen along the axis")
        .computed(format!(
            "reflected on average: (i) {}, (ii) {}",
            shares(first[0], 4),
            shares(first[1], 3)
        ))
        .verdict(first[0][0] > first[1][0])
        .because(
            "Horizontal light meets nearly no mismatch at the first face of (i), though much of it \
             goes on in the ordinary wave; what comes back is reflected further in.",
        );
    Ok(())
}

pub(super) fn trapped_light(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    // The ordinary index of a segment, sqrt(eps mu_o).
    let index = |material: &str, ordinary: usize| -> Result<f64> {
        let device = square(material);
        let permittivity: [f64; 3] = facts(&device, "permittivity_principal_values")?;
        let permeability: [f64; 3] = facts(&device, "permeability_principal_values")?;
        Ok((permittivity[0] * permeability[ordinary]).sqrt())
    };
    let critical = [index(DESIGNS[0], 1)?.asin(), (1.0 / index(DESIGNS[1], 0)?).asin()];
    let [in_air, inside] = critical.map(f64::to_degrees);
    let assembly = fixture.assembly(&square(DESIGNS[1]))?;
    let (main, times) =
        reflected_inside(&assembly, &launch(DVec3::new(-50.0, 4.0, 0.0), DVec3::X))?;
    let angle = main.direction.y.atan2(main.direction.x).to_degrees().abs();
    // The steepest incidence on a front face that the camera sees, at a rotation.
    let corner = 0.5 * fact(&square(DESIGNS[0]), "mirror_width_cm")?;
    let steepest = |rotation: f64, half_view: f64| {
        let at = |degrees: f64| DVec2::from_angle((degrees + rotation).to_radians());
        let cosines = [135.0, 225.0].into_iter().flat_map(|face| {
            (0..=20).flat_map(move |k| {
                let ends = [-45.0, 45.0].map(|turn| corner * at(face + turn));
                let way = ends[0].lerp(ends[1], f64::from(k) / 20.0) - CAMERA.truncate();
                [0.0, half_view].map(|right: f64| {
                    let d = way.extend(way.x * right.to_radians().tan()).normalize();
                    -d.truncate().dot(at(face))
                })
            })
        });
        cosines.fold(1.0, f64::min).acos().to_degrees()
    };
    let [still, turned] =
        [0.0, 20.0].map(|turn| [HALF_VIEW, WIDE_HALF_VIEW].map(|view| steepest(turn, view)));
    let degrees = |angles| in_both_views(angles, |angle| format!("{angle:.1}"));
    let share = percent(main.power[1], 1);
    page.says(
        "3, Fig. 4",
        "(ii), vertical: ordinary light is trapped in a segment and escapes after several \
         total internal reflections",
    )
    .computed(format!(
        "trapped beyond {inside:.2} degrees inside; in the centre plane {share} leaves in \
         one path after {times} reflections in segments, at {angle:.2} degrees"
    ))
    .verdict(main.power[1] > 0.5 && inside < 45.0 && times > 1);
    page.says("3", "(i): ordinary light is reflected totally in air at the first interface")
        .computed(format!(
            "beyond {in_air:.2} degrees of incidence; the view has at most {} at rotation 0, {} at 20",
            degrees(still),
            degrees(turned)
        ))
        .verdict(turned[0] > in_air)
        .because("When turned; at rotation 0 no ray of our view is that steep.");
    Ok(())
}
