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
        Shape::Line(points) => points.clone(),
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
fn wavefronts_that_no_one_could_tell_apart_are_refused() {
    let settings =
        DiagramSettings { wavefronts: Some(0.01), rays: 3, ..DiagramSettings::default() };
    let refused = drawn("[[device]]\nkind = \"square-cloak\"", &settings).expect_err("too many");
    assert!(refused.to_string().starts_with("the distance of wavefronts is 0.01; "), "{refused}");
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

/// Rays that have missed a device are of no front with those that it has held up and turned by a few degrees.
#[test]
fn wavefronts_break_where_a_device_ends() {
    let settings = DiagramSettings { wavefronts: Some(2.0), ..DiagramSettings::default() };
    let cloak = "[[device]]\nkind = \"double-gaussian-cloak\"\n";
    let fronts = fronts(&drawn(cloak, &settings).expect("drawn"));
    let right = fronts.iter().flatten().map(|point| point.x).fold(0.0, f64::max);
    let behind = |pair: &&[DVec2]| pair.iter().all(|point| point.x > 0.85 * right);
    let chords = fronts.iter().flat_map(|front| front.windows(2)).filter(behind);
    let slopes: Vec<f64> = chords.map(|pair| (pair[1] - pair[0]).normalize().x.abs()).collect();
    assert!(slopes.len() > 50 && slopes.iter().all(|slope| *slope < 0.12), "{slopes:?}");
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

/// cm/ns.
const LIGHT: f64 = 29.979_245_8;

fn followed(text: &str, settings: &DiagramSettings) -> RayDiagram {
    RayDiagram::new(&scene(text), settings, &AtomicBool::new(false)).expect("followed")
}

/// The pieces of a pulse at a time, ns.
fn pulse(diagram: &RayDiagram, time: f64, delay: Delay) -> Vec<pulse::Front> {
    let joints = Joints { assembly: &diagram.assembly, apart: 10.0 };
    pulse::fronts(&diagram.trees, &joints, diagram.way(time), delay)
}

const CLOAK: &str = "[[device]]\nkind = \"square-cloak\"\n";

#[test]
fn in_air_a_pulse_comes_as_far_as_light_does() {
    let from = DVec3::new(-60.0, 5.0, 0.0);
    for (source, time) in [
        (Source::Point(from), 1.2),
        (Source::Parallel { degrees: 0.0 }, -0.5),
        (Source::Parallel { degrees: 90.0 }, -0.4),
    ] {
        for delay in [Delay::Group, Delay::Phase] {
            let settings = DiagramSettings { source, ..DiagramSettings::default() };
            let fronts = pulse(&followed(CLOAK, &settings), time, delay);
            assert_eq!(fronts.len(), 1);
            assert_eq!((fronts[0].points.len(), fronts[0].power), (20, 1.0));
            for point in &fronts[0].points {
                let way = match source {
                    Source::Point(from) => point.distance(from),
                    Source::Parallel { degrees } if degrees > 45.0 => point.y,
                    _ => point.x,
                };
                assert!((way - time * LIGHT).abs() < 1e-9, "{source:?} {way}");
            }
        }
    }
}

#[test]
fn behind_the_perfect_cloak_the_phase_is_on_time_and_a_pulse_is_late() {
    let settings = DiagramSettings { rays: 40, ..DiagramSettings::default() };
    let fronts = pulse(&followed(CLOAK, &settings), 15.0 / LIGHT, Delay::Phase);
    assert_eq!((fronts.len(), fronts[0].points.len()), (1, 40));
    for (number, point) in fronts[0].points.iter().enumerate() {
        let width = 1.06 * 2.0 * 9.970_205_614_730_32;
        let straight = DVec3::new(15.0, width * ((number as f64 + 0.5) / 40.0 - 0.5), 0.0);
        assert!(point.distance(straight) < 1e-9, "{point} {straight}");
    }
    let narrow = DiagramSettings { rays: 2, width: Some(1e-4), ..settings };
    let diagram = followed(CLOAK, &narrow);
    let late = 1.451_40;
    let fronts = pulse(&diagram, 15.0 / LIGHT + late, Delay::Group);
    for point in fronts.iter().flat_map(|front| &front.points) {
        assert!((point.x - 15.0).abs() < 1e-5 * LIGHT, "{point}");
    }
    // It is seen until it has left the picture.
    let [first, last] = diagram.seen(Delay::Group).expect("seen");
    let [_, on_time] = diagram.seen(Delay::Phase).expect("seen");
    assert!((last - on_time - late).abs() < 1e-5 && first < -10.0 / LIGHT, "{first} {last}");
}

/// With no loss, all power of a ray is somewhere on it at every time; where a birefringent cloak has split
/// it, in several places.
#[test]
fn a_pulse_in_a_birefringent_cloak_is_many_that_have_all_power() {
    for material in ["positive-uniaxial", "negative-uniaxial"] {
        let settings = DiagramSettings {
            rays: 10,
            z: Some(6.0),
            min_power: 1e-7,
            ..DiagramSettings::default()
        };
        let diagram = followed(&format!("{CLOAK}material = \"{material}\""), &settings);
        let mut most = 0;
        for step in 0..40 {
            let way = diagram.way(-0.5 + 0.05 * f64::from(step));
            for delay in [Delay::Group, Delay::Phase] {
                for tree in &diagram.trees {
                    let points = tree.iter().filter_map(|line| pulse::point_at(line, way, delay));
                    let powers: Vec<f64> = points.map(|point| point.power).collect();
                    let sum: f64 = powers.iter().sum();
                    assert!((sum - 1.0).abs() < 1e-4, "{material} {delay:?} {way}: {sum}");
                    most = most.max(powers.iter().filter(|power| **power > 0.05).count());
                }
            }
        }
        assert!(most > 1, "{material}: {most}");
        let strong = pulse(&diagram, 20.0 / LIGHT + 0.8, Delay::Group);
        let strong = strong.iter().filter(|front| front.power > 0.05 && front.points.len() > 1);
        assert!(strong.count() > 1, "{material}");
    }
}

/// ∫ n dx along the axis of the lens of Luneburg, n² = 2 - (x/R)².
#[test]
fn in_a_graded_lens_a_pulse_is_where_the_integral_of_the_index_says() {
    let settings = DiagramSettings { rays: 2, width: Some(1e-4), ..DiagramSettings::default() };
    let diagram = followed("[[device]]\nkind = \"luneburg-lens\"", &settings);
    let path = |x: f64| 0.5 * (x * (2.0 - x * x).sqrt() + 2.0 * (x / 2.0_f64.sqrt()).asin());
    for delay in [Delay::Group, Delay::Phase] {
        for x in [-9.0, -4.0, 0.5, 3.0, 8.0] {
            let time = (-10.0 + 10.0 * (path(x / 10.0) - path(-1.0))) / LIGHT;
            let fronts = pulse(&diagram, time, delay);
            assert_eq!(fronts.len(), 1);
            for point in &fronts[0].points {
                assert!((point.x - x).abs() < 2e-3, "{delay:?} {x}: {point}");
            }
        }
    }
}

#[test]
fn a_pulse_is_drawn_over_the_rays_with_its_time() {
    for space in [None, Some([30.0, 20.0])] {
        let settings = DiagramSettings { space, ..DiagramSettings::default() };
        let diagram = followed(CLOAK, &settings);
        let at = Pulse { time: 0.5, delay: Delay::Group, step: 0.01 };
        let drawing = diagram.draw(Some(&at));
        assert!(drawing.of_class("pulse").count() > 0);
        let words = drawing.of_class("key").filter_map(|element| match &element.shape {
            Shape::Words(words) => Some(words.text()),
            _ => None,
        });
        assert!(words.into_iter().any(|words| words == "pulse at 0.50 ns"));
        // Without it, and before it comes and after it has gone, there is none.
        for time in [None, Some(-9.0), Some(99.0)] {
            let pulse = time.map(|time| Pulse { time, ..at });
            assert_eq!(diagram.draw(pulse.as_ref()).of_class("pulse").count(), 0);
        }
    }
}
