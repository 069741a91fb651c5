mod contents;

use super::super::drawing::{Element, Shape};
use super::*;
use crate::gallery::EXHIBITS;
use cloakroom::device::CATALOGUE;
use cloakroom::photograph::{ImageSource, LinearImage, Texels};
use cloakroom::scene_file;
use proptest::prelude::*;
use std::path::Path;

/// The scene with a small photograph of the built-in one's form, which takes no time to read.
fn scene(text: &str) -> Scene {
    let mut scene = scene_file::parse(text, "test", Path::new(""), &[]).expect(text).scene;
    let [width, height] = [16, 20];
    let texels = Texels::Linear(vec![0.5; width * height * 3]);
    let image = LinearImage { width, height, texels };
    scene.photograph.image = ImageSource::memory(image).expect("an image");
    scene.photograph.width.get_or_insert(110.0);
    scene
}

/// On a sheet of the aspect of the picture.
fn setting(scene: &Scene) -> Result<Setting, PreparedSceneError> {
    super::setting(scene, scene.camera.resolution)
}

fn drawn(text: &str) -> Setting {
    setting(&scene(text)).expect(text)
}

/// What is written in labels of a class.
fn labels(setting: &Setting, class: &str) -> Vec<String> {
    let words = setting.drawing.of_class(class).map(|element| match &element.shape {
        Shape::Words(words) => words.text(),
        other => panic!("{other:?} is no label"),
    });
    words.collect()
}

fn area(element: &Element) -> &[Vec<DVec2>] {
    match &element.shape {
        Shape::Area(contours) => contours,
        other => panic!("{other:?} is no area"),
    }
}

fn line(element: &Element) -> &[DVec2] {
    match &element.shape {
        Shape::Line(points) => points,
        other => panic!("{other:?} is no line"),
    }
}

/// All points of an element.
fn points(element: &Element) -> Vec<DVec2> {
    match &element.shape {
        Shape::Area(contours) => contours.concat(),
        Shape::Line(points) => points.clone(),
        Shape::Circle { centre, radius } => vec![*centre - *radius, *centre + *radius],
        Shape::Image { place, .. } => [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|corner| place.transform_point2(DVec2::from(corner)))
            .to_vec(),
        Shape::Words(words) => words.corners().to_vec(),
    }
}

const SQUARE: &str = "[[device]]\nkind = \"square-cloak\"\n";
const GAUSSIAN: &str = "[[device]]\nkind = \"double-gaussian-cloak\"\n";

#[test]
fn the_square_cloak_has_the_numbers_of_the_paper() {
    let setting = drawn(SQUARE);
    assert_eq!(labels(&setting, "dimension-label"), ["14.1 cm", "11.51 cm"]);
    assert_eq!(labels(&setting, "distance-label"), ["100 cm", "50 cm"]);
    assert_eq!(labels(&setting, "angle-label"), ["33.54°"]);
    assert_eq!(labels(&setting, "tensor"), ["ε = μ = 3.27 (u), 0.31 (v), 2.37 (z)"]);
    // Four segments and the rhombus, in the scene and magnified.
    assert_eq!(setting.drawing.of_class("medium").count(), 8);
    assert_eq!(setting.drawing.of_class("metal").count(), 2);
    assert_eq!(setting.drawing.of_class("index-map").count(), 0);
    // In the scene, to scale and at their places.
    let d = 14.1 * 0.5_f64.sqrt();
    let b = d / 3.0_f64.sqrt();
    let place = |x: f64, y: f64| setting.view.place(DVec2::new(x, y));
    let has = |element: &Element, corner: DVec2| {
        area(element)[0].iter().any(|p| p.distance(corner) < 1e-6)
    };
    let quadrants = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    for (segment, (x, y)) in setting.drawing.of_class("medium").zip(quadrants) {
        assert_eq!(area(segment)[0].len(), 3);
        let corners = [place(x * d, 0.0), place(0.0, y * d), place(0.0, y * b)];
        assert!(corners.iter().all(|corner| has(segment, *corner)), "{segment:?}");
    }
    let rhombus = setting.drawing.of_class("metal").next().expect("metal");
    assert!(has(rhombus, place(d, 0.0)) && has(rhombus, place(0.0, b)));
    let photograph = setting.drawing.of_class("photograph").next().expect("a photograph");
    // 110 cm wide, and as high as its image has it.
    let image = cloakroom::photograph::dimensions(&scene(SQUARE).photograph.image);
    let (width, height) = image.expect("an image");
    let half = 55.0 * f64::from(height) / f64::from(width);
    for (end, y) in line(photograph).iter().zip([-half, half]) {
        assert!(end.distance(place(50.0, y)) < 1e-6, "{end}");
    }
}

#[test]
fn optic_axes_point_where_the_media_say() {
    // Degrees from x of the longer axes of the segments, modulo half a turn.
    let angles = |text: &str| {
        let setting = drawn(text);
        let axes = setting.drawing.of_class("axis").map(|axis| {
            let along = line(axis)[1] - line(axis)[0];
            (along.length(), (-along.y).atan2(along.x).to_degrees().rem_euclid(180.0))
        });
        axes.collect::<Vec<_>>()
    };
    let u = 33.5443;
    for (material, rotation, expected) in [
        ("positive-uniaxial", 0.0, [-u, u, -u, u]),
        ("positive-uniaxial", 20.0, [-u, u, -u, u]),
        ("negative-uniaxial", 0.0, [90.0 - u, 90.0 + u, 90.0 - u, 90.0 + u]),
    ] {
        let found = angles(&format!("{SQUARE}material = \"{material}\"\nrotation = {rotation:?}"));
        // Four segments, and the key.
        assert_eq!(found.len(), 5, "{material} {rotation}");
        for ((_, found), expected) in found.iter().zip(expected) {
            let off = (found - expected - rotation + 90.0).rem_euclid(180.0) - 90.0;
            assert!(off.abs() < 1e-3, "{material} {rotation}: {found} {expected}");
        }
    }
    // Both axes at right angles where the medium is impedance matched, u the longer one.
    let both = angles(SQUARE);
    assert_eq!(both.len(), 10);
    for pair in both.chunks(2) {
        let between = (pair[0].1 - pair[1].1).rem_euclid(180.0);
        assert!((between - 90.0).abs() < 1e-3 && pair[0].0 > pair[1].0, "{pair:?}");
    }
}

#[test]
fn the_double_gaussian_cloak_is_a_map_of_its_index() {
    let setting = drawn(GAUSSIAN);
    assert_eq!(labels(&setting, "dimension-label"), ["50 cm", "57.14 cm", "8.5 cm"]);
    assert_eq!(labels(&setting, "color-bar-title"), ["refractive index"]);
    assert_eq!(labels(&setting, "tick-label"), ["1.0", "1.2", "1.4", "1.6", "1.8"]);
    let maps: Vec<_> = setting.drawing.of_class("index-map").collect();
    assert_eq!(maps.len(), 2);
    // Brightest at the top of the metal, in the middle of the lower edge of the upper half.
    let Shape::Image { image, place, .. } = &maps[0].shape else { panic!("no image") };
    let brightness =
        |x: u32, y: u32| image.get_pixel(x, y).0.iter().map(|c| u32::from(*c)).sum::<u32>();
    let (width, height) = image.dimensions();
    let at_peak = DVec2::new(0.0, 4.6);
    let inside = place.inverse().transform_point2(setting.view.place(at_peak));
    let pixel = (inside * DVec2::new(f64::from(width), f64::from(height))).floor();
    let peak = brightness(pixel.x as u32, pixel.y as u32);
    for (x, y) in
        [(0, 0), (width - 1, 0), (width / 2, 0), (0, height / 2), (width / 4, height - 20)]
    {
        assert!(brightness(x, y) < peak, "({x}, {y})");
    }
    // Cut to the halves: the clip is the border.
    let clip = maps[0].clip.as_ref().expect("a clip");
    let corner = setting.view.place(DVec2::new(25.0, 28.57));
    assert!(clip[0].iter().any(|p| p.distance(corner) < 1e-6));
}

#[test]
fn dimensions_are_those_of_the_scene() {
    let setting = drawn(&format!("{SQUARE}side = 30\nkappa = 0.75\nposition = [-12.5, 3, 0]"));
    // The side of the rhombus is d sqrt(1 + kappa^2), d = side/sqrt(2).
    assert_eq!(labels(&setting, "dimension-label"), ["30 cm", "26.52 cm"]);
    assert_eq!(labels(&setting, "distance-label"), ["87.5 cm", "62.5 cm"]);
    let other = drawn("[camera]\nposition = [-60, 0, 0]\n[photograph]\nx = 33.3\n");
    assert_eq!(labels(&other, "distance-label"), ["93.3 cm"]);
    assert!(labels(&other, "dimension-label").is_empty());
}

#[test]
fn the_field_of_view_is_the_cameras() {
    let field = |text: &str| {
        let setting = drawn(text);
        let element = setting.drawing.of_class("field-of-view").next().cloned();
        (setting.view, element.map(|element| area(&element)[0].clone()))
    };
    let has = |shape: &[DVec2], corner: DVec2| shape.iter().any(|p| p.distance(corner) < 1e-6);
    // Its height is that of the picture: 40 degrees across, 4 to 3.
    let (view, shape) = field("");
    let half = 150.0 * 20.0_f64.to_radians().tan() * 0.75;
    let shape = shape.expect("a field of view");
    assert_eq!(shape.len(), 3);
    for corner in [(-100.0, 0.0), (50.0, half), (50.0, -half)] {
        assert!(has(&shape, view.place(DVec2::from(corner))), "{corner:?}");
    }
    let (view, shape) = field("[camera]\nprojection = \"orthographic\"\nwidth = 60");
    let shape = shape.expect("a field of view");
    for corner in [(-100.0, 22.5), (-100.0, -22.5), (50.0, 22.5), (50.0, -22.5)] {
        assert!(has(&shape, view.place(DVec2::from(corner))), "{corner:?}");
    }
    // Along z nothing of it lies in the plane.
    let (_, shape) = field("[camera]\nposition = [-60, 0, 90]\ntarget = [-60, 0, 0]");
    assert_eq!(shape, None);
}

/// Every device in every view, turned, moved and short.
fn variants() -> Vec<(String, Setting)> {
    let (mut settings, mut texts) = (Vec::new(), Vec::new());
    for entry in CATALOGUE {
        for show in ["cloak", "bare", "mirror"] {
            for more in [
                "",
                "rotation = 20",
                "position = [-20.0, 9.0, 5.0]\nrotation = 90\nlength = 7",
                "axis = [1, 2, -0.5]\nrotation = 20",
                "axis = [0, 1, 0]\nlength = 7",
                "axis = [0, 0, -1]\nrotation = 20",
            ] {
                let text =
                    format!("[[device]]\nkind = \"{}\"\nshow = \"{show}\"\n{more}\n", entry.kind);
                // Some devices have no other views, and an endless slab across the photograph is in
                // its way.
                if let Ok(setting) = setting(&scene(&text)) {
                    settings.push((text, setting));
                }
            }
        }
    }
    texts.extend(
        [
            "",
            "[camera]\nprojection = \"orthographic\"\nwidth = 60",
            "[camera]\nposition = [-80, 60, 30]\ntarget = [0, 0, 0]",
            "[camera]\nposition = [-60, 0, 90]\ntarget = [-60, 0, 0]",
            "[camera]\nposition = [150, 10, 0]\ntarget = [50, 0, 0]",
            "[camera]\nposition = [-100000, 0, 0]\nfield_of_view = 0.03",
            "[photograph]\nposition = [40, 5, 30]\nnormal = [-1, 0, -1]\nwidth = 20",
            "[photograph]\nposition = [40, 0, -60]\nnormal = [0, 0, 1]\nwidth = 20",
            "[photograph]\nposition = [50, -60, 0]\nnormal = [0, 1, 0]\nup = [1, 0, 0]",
            "[camera]\nresolution = [1600, 400]",
            "[camera]\nresolution = [300, 900]",
        ]
        .into_iter()
        .flat_map(|camera| [SQUARE, GAUSSIAN, ""].map(|device| format!("{camera}\n{device}"))),
    );
    texts.extend(EXHIBITS.iter().map(|exhibit| exhibit.scene.to_owned()));
    texts.push(format!(
        "{SQUARE}position = [-40, 12, 0]\n{SQUARE}position = [-40, -12, 0]\n{GAUSSIAN}"
    ));
    settings.extend(texts.into_iter().map(|text| {
        let setting = drawn(&text);
        (text, setting)
    }));
    settings
}

#[test]
fn every_device_can_be_drawn_and_labels_are_apart() {
    for (text, setting) in variants() {
        let sheet = setting.drawing.size;
        let names = [
            "camera-label",
            "photograph-label",
            "distance-label",
            "dimension-label",
            "tick-label",
            "coordinate-name",
        ];
        let written: Vec<&Element> =
            names.iter().flat_map(|class| setting.drawing.of_class(class)).collect();
        for (i, a) in written.iter().enumerate() {
            let box_of = |element: &Element| subject::bounds(points(element)).expect("a box");
            let [low, high] = box_of(a);
            let inside = low.min_element() >= 0.0 && high.x <= sheet.x && high.y <= sheet.y;
            assert!(inside, "{text}: {:?} {low} {high}", a.shape);
            for b in &written[..i] {
                let [from, to] = box_of(b);
                let apart = low.x >= to.x || from.x >= high.x || low.y >= to.y || from.y >= high.y;
                assert!(apart, "{text}: {:?} {:?}", a.shape, b.shape);
            }
        }
        for element in setting.drawing.elements.iter().filter(|element| element.clip.is_none()) {
            assert!(points(element).iter().all(|p| p.is_finite()), "{text}: {element:?}");
        }
    }
}

#[test]
fn what_is_tilted_is_drawn_as_the_outline_of_its_projection() {
    let setting = drawn(&format!("{SQUARE}axis = [0, 1, 0]\nlength = 16"));
    let at = |x: f64, y: f64| setting.view.place(DVec2::new(x, y));
    let half = 14.1 / 2f64.sqrt();
    let shapes: Vec<Vec<DVec2>> = setting.drawing.of_class("medium").map(points).collect();
    // The others are of the key.
    let [shape, ..] = &shapes[..] else { panic!("{shapes:?}") };
    for corner in [at(-half, -8.0), at(half, -8.0), at(half, 8.0), at(-half, 8.0)] {
        assert!(shape.iter().any(|point| point.distance(corner) < 1e-9), "{shape:?} {corner}");
    }
    assert_eq!(setting.drawing.of_class("dimension-label").count(), 0);
    let bare = drawn(&format!("{SQUARE}axis = [0, 1, 0]\nlength = 16\nshow = \"bare\""));
    assert!(bare.drawing.of_class("metal").count() > 0);
}

#[test]
fn several_devices_are_all_there() {
    let setting =
        drawn(&format!("{SQUARE}position = [0, 12, 0]\n{SQUARE}position = [0, -12, 0]\n"));
    assert_eq!(setting.drawing.of_class("medium").count(), 16);
    assert_eq!(setting.drawing.of_class("inset").count(), 2);
    assert_eq!(setting.drawing.of_class("device-axis").count(), 2);
    assert_eq!(labels(&setting, "distance-label"), ["100 cm", "50 cm"]);
}

#[test]
fn a_scene_that_cannot_be_looked_at_is_refused() {
    let error = setting(&scene(&format!("{SQUARE}{SQUARE}"))).expect_err("two in one place");
    assert_eq!(error.key(), "device.1");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    for text in [SQUARE, GAUSSIAN] {
        let svg = || drawn(text).drawing.to_svg("test", &[]);
        assert!(svg() == svg());
        let image = || drawn(text).drawing.to_image([160, 120]).expect("an image");
        assert!(image() == image());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_sheet_is_filled(width in 1_u32..3000, height in 1_u32..3000) {
        let setting = drawn(&format!("[camera]\nresolution = [{width}, {height}]\n{SQUARE}"));
        let size = setting.drawing.size;
        prop_assert!((size.x / size.y * f64::from(height) / f64::from(width) - 1.0).abs() < 1e-9);
        prop_assert!((size.x * size.y - 1024.0 * 768.0).abs() < 1e-3);
        prop_assert!(setting.view.scale > 0.0);
    }
}
