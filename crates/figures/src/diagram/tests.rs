#[path = "../../../optics/tests/long.rs"]
mod long;

use super::*;
use cloakroom::scene_file;
use glam::DVec2;
use std::path::Path;

impl Default for DiagramSettings {
    fn default() -> Self {
        Self {
            source: Source::Parallel { degrees: 0.0 },
            // Even, so that none runs on the axis, where cloaks are singular.
            rays: 20,
            layers: 1,
            z: None,
            width: None,
            window: None,
            polarization: [0.5, 0.5],
            wavefronts: None,
            min_power: 0.01,
            space: None,
            size: [1024, 768],
        }
    }
}

fn scene(text: &str) -> Scene {
    scene_file::parse(text, "scene", Path::new(""), &[]).expect("a scene").scene
}

fn drawn(text: &str, settings: &DiagramSettings) -> Result<Drawing, DiagramError> {
    Ok(RayDiagram::new(&scene(text), settings, &AtomicBool::new(false))?.draw(None))
}

/// The points of the wavefronts on the sheet, front by front.
fn fronts(drawing: &Drawing) -> Vec<Vec<DVec2>> {
    let line = |element: &super::super::drawing::Element| match &element.shape {
        super::super::drawing::Shape::Line(points) => points.clone(),
        _ => panic!("a front is a line"),
    };
    drawing.of_class("wavefront").map(line).collect()
}

#[test]
fn a_perfect_cloak_leaves_wavefronts_plane() {
    let settings =
        DiagramSettings { wavefronts: Some(2.0), rays: 40, ..DiagramSettings::default() };
    let drawing = drawn("[[device]]\nkind = \"square-cloak\"", &settings).expect("drawn");
    let view = Scenery::new(
        [DVec2::splat(-9.970_205_614_730_32), DVec2::splat(9.970_205_614_730_32)],
        0.0,
        &settings,
    )
    .section_view(drawing.size, false);
    let behind = view.place(DVec2::new(10.1, 0.0)).x;
    let edge = view.place(DVec2::new(17.0, 0.0)).x;
    let plane = fronts(&drawing)
        .into_iter()
        .filter(|front| front.iter().all(|point| point.x > behind && point.x < edge));
    let mut count = 0;
    for front in plane {
        count += 1;
        assert!(front.len() > 30, "{}", front.len());
        let x = front[0].x;
        assert!(front.iter().all(|point| (point.x - x).abs() < 1e-6), "{front:?}");
    }
    assert!(count >= 3, "{count}");
}

#[test]
fn the_lens_of_luneburg_has_its_focus_on_its_far_side() {
    let settings = DiagramSettings { rays: 9, width: Some(18.0), ..DiagramSettings::default() };
    let scene = scene("[[device]]\nkind = \"luneburg-lens\"");
    let assembly = assembly(&scene).expect("an assembly");
    let devices = Devices::new(&assembly);
    let scenery = Scenery::new(devices.bounds().expect("bounds"), 0.0, &settings);
    for launch in settings.source.launches(&scene, &settings, &scenery) {
        let limits = Limits { min_power: 0.01, tolerance: 1e-6 };
        let tree = lines(&assembly, limits, &launch, [0.5, 0.5], 5.0);
        let inside = tree.iter().find(|line| line.points.len() > 10).expect("a way inside");
        let end = inside.points.last().expect("an end").position;
        assert!(end.distance(DVec3::new(10.0, 0.0, 0.0)) < 1e-9, "{end}");
        let leaf = tree.iter().find(|line| line.leaves).expect("a leaf");
        assert_eq!(leaf.points[0].optical_path, inside.points.last().expect("an end").optical_path);
    }
}

#[test]
fn every_device_can_be_drawn_in_every_way() {
    for entry in cloakroom::device::CATALOGUE {
        let more = match entry.kind {
            "prisms" => "[[device.prism]]\ncorners = [[0, 0], [4, 0], [0, 4]]\npermittivity = 2",
            "body" => "permittivity = 2",
            "graded" => {
                "index = [[1, 1, 1, 1], [1, 1, 1.2, 1], [1, 1.2, 1, 1], [1, 1, 1, 1]]\ninner = 2"
            }
            _ => "",
        };
        let text = format!("[[device]]\nkind = \"{}\"\n{more}", entry.kind);
        let space = Some([30.0, 20.0]);
        for (number, (space, source)) in [
            (None, Source::Parallel { degrees: 200.0 }),
            (None, Source::Camera),
            (space, Source::Point(DVec3::new(-400.0, 60.0, 0.0))),
        ]
        .into_iter()
        .enumerate()
        {
            let settings = DiagramSettings { space, source, rays: 3, ..DiagramSettings::default() };
            let drawing = drawn(&text, &settings).expect("drawn");
            let rays = drawing.of_class("ray").count();
            // Of light that is caught, too.
            assert!((3..10_000).contains(&rays), "{} {source:?}: {rays}", entry.kind);
            // Two of them by default, others for each source.
            let axes = ["[1, 2, -0.5]", "[0, 1, 0]", "[-1, 0, 0]", "[0, 0, -1]"];
            for axis in axes.iter().cycle().skip(number).take(long::count(2, axes.len())) {
                let text = text.replacen("\n", &format!("\naxis = {axis}\n"), 1);
                match drawn(&text, &settings) {
                    Ok(drawing) => {
                        let rays = drawing.of_class("ray").count();
                        assert!(rays >= 3, "{text} {source:?}: {rays}");
                    }
                    // What has no end along the rays is where they would start.
                    Err(error) => assert!(matches!(error, DiagramError::Inside { .. }), "{error}"),
                }
            }
        }
    }
}

#[test]
fn wavefronts_are_drawn_in_space_too() {
    let settings = DiagramSettings {
        space: Some([0.0, 90.0]),
        wavefronts: Some(4.0),
        rays: 6,
        layers: 2,
        ..DiagramSettings::default()
    };
    let drawing = drawn("[[device]]\nkind = \"square-cloak\"", &settings).expect("drawn");
    let fronts = fronts(&drawing);
    assert!(fronts.len() > 20, "{}", fronts.len());
    // Seen from above, pieces of fronts across the light are points: layers are not joined.
    let plane = fronts.iter().filter(|front| front[0].distance(front[1]) < 1e-6).count();
    assert!(plane > 10 && fronts.iter().all(|front| (front[0].y - front[1].y).abs() < 1e-6));
}

/// Plane waves and a mirror's flat sides make plane fronts, each across light that comes or goes: never
/// through the metal, nor from what it sends back to what has missed it.
#[test]
fn wavefronts_at_a_mirror_are_those_of_one_wave_each() {
    let settings = DiagramSettings {
        source: Source::Parallel { degrees: -60.0 },
        wavefronts: Some(3.0),
        rays: 15,
        ..DiagramSettings::default()
    };
    let scene = "[[device]]\nkind = \"prisms\"\n[[device.prism]]\n\
                 corners = [[-9, -1], [9, -1], [9, 0], [-9, 0]]\nmetal = true\n";
    let drawing = drawn(scene, &settings).expect("drawn");
    let fronts = fronts(&drawing);
    assert!(fronts.len() > 10, "{}", fronts.len());
    for pair in fronts.iter().flat_map(|front| front.windows(2)) {
        let chord = (pair[1] - pair[0]).normalize();
        // Across 60 degrees, whichever way it runs.
        assert!((chord.x.abs() - 0.75_f64.sqrt()).abs() < 1e-6, "{chord}");
    }
}

#[test]
fn nonsense_is_refused() {
    let refused = |settings: DiagramSettings, part: &str| {
        let error = drawn("[[device]]\nkind = \"square-cloak\"", &settings).expect_err("refused");
        assert!(error.to_string().contains(part), "{error}");
    };
    let usual = DiagramSettings::default();
    refused(DiagramSettings { rays: 0, ..usual.clone() }, "number of rays is 0");
    refused(DiagramSettings { width: Some(-1.0), ..usual.clone() }, "width");
    refused(DiagramSettings { wavefronts: Some(f64::NAN), ..usual.clone() }, "wavefronts");
    for side in [-1.0, 0.0, 1e-7, f64::NAN] {
        let window = Some([DVec2::ZERO, DVec2::splat(side)]);
        refused(DiagramSettings { window, ..usual.clone() }, "window");
    }
    refused(DiagramSettings { source: Source::Point(DVec3::ZERO), ..usual.clone() }, "device 0");
    let empty = drawn("[camera]\nseed = 1", &usual).expect_err("refused");
    assert!(matches!(empty, DiagramError::NoDevice));
}
