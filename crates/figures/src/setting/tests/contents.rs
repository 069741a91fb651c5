//! What of a scene is in its drawing, and what the key says of it.

use super::*;

#[test]
fn all_shapes_of_a_scene_are_there() {
    // All kinds are in the gallery; here as well without their cloaks, as far as they have any.
    let bare = CATALOGUE.iter().flat_map(|entry| {
        ["bare", "mirror"].map(|show| {
            format!("[[device]]\nkind = \"{}\"\nshow = \"{show}\"\nrotation = 20\n", entry.kind)
        })
    });
    let exhibits = EXHIBITS.iter().map(|exhibit| exhibit.scene.to_owned());
    for text in exhibits.chain(bare) {
        let loaded = scene(&text);
        let Ok(assembly) = cloakroom::render::assembly(&loaded) else {
            assert!(text.contains("show = "), "{text}");
            continue;
        };
        let setting = setting(&loaded).expect(&text);
        let drawn: Vec<(&str, Vec<DVec2>)> =
            setting.drawing.elements.iter().map(|e| (e.class, points(e))).collect();
        for placed in assembly.devices() {
            let (section, _) = placed.structure.drawn_at(&placed.pose);
            if section.is_shadow {
                continue;
            }
            let is_drawn = |class: &str, points: &[DVec2]| {
                let at = |p: &DVec2| setting.view.place(placed.pose.point_to_world(*p));
                let same = |all: &[DVec2]| {
                    all.len() == points.len()
                        && all.iter().zip(points).all(|(a, b)| a.distance(at(b)) < 1e-6)
                };
                drawn.iter().any(|(of_class, all)| *of_class == class && same(all))
            };
            let mut count = 0;
            let mut demand = |class: &str, points: &[DVec2]| {
                assert!(is_drawn(class, points), "{text}: no {class} {points:?}");
                count += 1;
            };
            for region in &section.regions {
                let border: Vec<DVec2> =
                    region.border.iter().flat_map(|contour| contour.points.clone()).collect();
                demand("border", &border);
            }
            for contour in &section.metal {
                demand(if contour.closed { "metal" } else { "mirror" }, &contour.points);
            }
            for contour in &section.polarizers {
                demand("polarizer", &contour.points);
            }
            if section.body.is_some() {
                assert_eq!(section.outlines.len(), 1, "{text}");
                demand("body", &section.outlines[0].points);
            }
            // A cloak without metal leaves nothing bare.
            assert!(count > 0 || text.contains("show = "), "{text}: nothing is drawn");
        }
    }
}

#[test]
fn bodies_are_drawn_with_their_indices() {
    let rod = |name: &str| {
        let exhibit = EXHIBITS.iter().find(|exhibit| exhibit.name == name);
        drawn(exhibit.expect("an exhibit").scene)
    };
    let setting = rod("rod-in-negative-water");
    assert_eq!(labels(&setting, "key"), ["n = 1.5", "n = 1", "n = −1.3", "opaque"]);
    assert_eq!(labels(&setting, "index"), ["n = −1.3"]);
    // The glass alone is measured, and what stands around it is not magnified.
    assert_eq!(labels(&setting, "dimension-label"), ["Ø 10 cm"]);
    assert_eq!(setting.drawing.of_class("inset").count(), 1);
    assert_eq!(labels(&setting, "distance-label"), ["70 cm", "50 cm"]);
    // The liquid lies before the glass, and the rod before the liquid, in whichever order they are
    // told.
    let order = |text: &str| {
        let setting = drawn(text);
        let bodies = setting.drawing.of_class("body");
        bodies.map(|body| points(body)[0].x).collect::<Vec<_>>()
    };
    let ball = |radius: u32, priority: i32| {
        format!(
            "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = {radius}\n\
             permittivity = 2\npriority = {priority}\n"
        )
    };
    assert_eq!(order(&(ball(9, 0) + &ball(4, 1))), order(&(ball(4, 1) + &ball(9, 0))));
    assert_ne!(order(&(ball(9, 0) + &ball(4, 1))), order(&(ball(9, 1) + &ball(4, 0))));
}

#[test]
fn negative_and_large_indices_are_told_apart() {
    let tint = |medium: &str| {
        let text = format!("[[device]]\nkind = \"body\"\nshape = \"sphere\"\n{medium}");
        let setting = drawn(&text);
        setting.drawing.of_class("body").next().and_then(|body| body.fill).expect("a fill").rgb
    };
    assert_eq!(tint("permittivity = 1"), PAPER.rgb);
    let [glass, dense] = ["permittivity = 2.25", "permittivity = 9"].map(tint);
    assert!(glass[0] > dense[0] && glass[2] > glass[0]);
    let negative = tint("permittivity = -1\npermeability = -1");
    assert!(negative[0] > negative[2]);
}

#[test]
fn graded_media_show_their_optic_axes() {
    for (material, along_radius) in [("radial-uniaxial", true), ("azimuthal-uniaxial", false)] {
        let text = format!("[[device]]\nkind = \"cylinder-cloak\"\nmaterial = \"{material}\"");
        let setting = drawn(&text);
        let metal: Vec<Vec<DVec2>> = setting.drawing.of_class("metal").map(points).collect();
        let [low, high] = subject::bounds(metal[1].iter().copied()).expect("the inset's metal");
        let axes: Vec<&[DVec2]> = setting.drawing.of_class("axis").map(line).collect();
        assert!(axes.len() > 20, "{}", axes.len());
        for axis in axes {
            let radius = ((axis[0] + axis[1] - low - high) / 2.0).normalize();
            let cosine = (axis[1] - axis[0]).normalize().dot(radius).abs();
            let wanted = if along_radius { 1.0 } else { 0.0 };
            assert!((cosine - wanted).abs() < 1e-6, "{material}: {cosine}");
        }
        assert_eq!(labels(&setting, "key"), ["optic axis", "metal"]);
    }
    // Isotropic media have none.
    let setting = drawn("[[device]]\nkind = \"luneburg-lens\"");
    assert_eq!(setting.drawing.of_class("axis").count(), 0);
}

#[test]
fn small_devices_in_a_row_have_keys() {
    let setting = drawn(&format!("{SQUARE}position = [0, 12, 0]\n{SQUARE}position = [0, -12, 0]"));
    assert_eq!(labels(&setting, "key"), ["metal"; 2]);
    assert_eq!(labels(&setting, "tensor"), ["ε = μ = 3.27 (u), 0.31 (v), 2.37 (z)"; 2]);
}
