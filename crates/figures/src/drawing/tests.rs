use super::*;
use crate::{ScalarMap, SheetPanel, TablePicture, TableRow, sheet, table};
use cloakroom::output::{Channel, Picture, Samples};
use cloakroom::scene::PictureSettings;
use image::Rgb;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

const RED: Ink = Ink::new([255, 0, 0]);

fn square(from: f64, to: f64) -> Vec<DVec2> {
    [(from, from), (to, from), (to, to), (from, to)].map(DVec2::from).to_vec()
}

#[test]
fn shapes_become_pixels() {
    let mut drawing = Drawing::new(DVec2::new(100.0, 100.0), 10.0);
    drawing.add("ring", Shape::Area(vec![square(10.0, 90.0), square(30.0, 70.0)])).filled(RED);
    drawing
        .add("half", Shape::Circle { centre: DVec2::new(50.0, 50.0), radius: 10.0 })
        .filled(Ink::new([0, 0, 255]).faint(0.5))
        .within(vec![
            vec![(0.0, 0.0), (50.0, 0.0), (50.0, 100.0), (0.0, 100.0)]
                .into_iter()
                .map(DVec2::from)
                .collect(),
        ]);
    let image = drawing.to_image([200, 200]).expect("an image");
    let at = |x, y| image.get_pixel(x, y).0;
    assert_eq!(at(40, 40), [255, 0, 0]);
    assert_eq!(at(70, 70), [255, 255, 255]);
    assert_eq!(at(5, 5), [255, 255, 255]);
    let half = at(94, 100);
    assert!(half[0].abs_diff(128) <= 1 && half[2] == 255, "{half:?}");
    assert_eq!(at(106, 100), [255, 255, 255]);
}

#[test]
fn images_lie_where_they_are_placed() {
    let mut image = RgbImage::from_pixel(2, 2, Rgb([9, 9, 9]));
    image.put_pixel(1, 0, Rgb([200, 0, 0]));
    let mut drawing = Drawing::new(DVec2::new(40.0, 40.0), 10.0);
    // Turned a quarter counterclockwise: the right side is up.
    let place =
        DAffine2::from_cols(DVec2::new(0.0, -20.0), DVec2::new(20.0, 0.0), DVec2::new(10.0, 30.0));
    drawing.add("image", Shape::Image { image, cells: false, place });
    let pixels = drawing.to_image([40, 40]).expect("an image");
    let red = |x, y| pixels.get_pixel(x, y).0[0];
    assert!(red(12, 12) > 150 && red(28, 12) < 60 && red(12, 28) < 60);
    assert_eq!(red(5, 20), 255);
}

#[test]
fn words_stand_where_they_are_put() {
    let mut drawing = Drawing::new(DVec2::new(200.0, 60.0), 10.0);
    let words = Words::new("50 cm", DVec2::new(100.0, 30.0), 20.0);
    let corners = words.corners();
    drawing.add("label", Shape::Words(words)).filled(RED);
    let svg = drawing.to_svg("A <title> & more", &[("scene".into(), "a < b".into())]);
    assert!(svg.contains("aria-label=\"50 cm\"") && svg.contains("A &lt;title&gt; &amp; more"));
    assert!(svg.contains("a &lt; b"));
    let image = drawing.to_image([200, 60]).expect("an image");
    let inked: Vec<(u32, u32)> = image
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0[1] < 128)
        .map(|(x, y, _)| (x, y))
        .collect();
    let range = |of: fn(&(u32, u32)) -> u32| {
        (inked.iter().map(of).min().unwrap_or(0), inked.iter().map(of).max().unwrap_or(0))
    };
    let ((left, right), (top, bottom)) = (range(|p| p.0), range(|p| p.1));
    assert!(f64::from(left) >= corners[0].x && f64::from(right) <= corners[1].x);
    // The digits are as high as capitals, and lie evenly about the line.
    assert!((f64::from(top + bottom + 1) / 2.0 - 30.0).abs() <= 1.0, "{top} {bottom}");
    assert!((bottom - top).abs_diff(14) <= 1);
}

#[test]
fn the_same_drawing_gives_the_same_bytes() {
    let mut drawing = Drawing::new(DVec2::new(50.0, 50.0), 10.0);
    let line = vec![DVec2::new(1.0, 1.0), DVec2::new(40.0, 30.0)];
    drawing.add("line", Shape::Line(line)).stroked(RED, 2.0).dashed(3.0, 1.0);
    let svg = || drawing.to_svg("", &[]);
    assert_eq!(svg(), svg());
    assert_eq!(drawing.to_image([70, 90]), drawing.to_image([70, 90]));
}

#[test]
fn a_drawing_that_is_too_large_is_refused() {
    let drawing = Drawing::new(DVec2::new(50.0, 50.0), 10.0);
    assert!(drawing.to_image([0, 10]).is_err());
    assert!(drawing.to_image([1 << 30, 1 << 30]).is_err());
}

/// The text of a PDF, with what its streams hold in place of them.
fn inflated(pdf: &[u8]) -> String {
    use std::io::Read;
    let mut text = String::new();
    let mut rest = pdf;
    let find = |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).position(|w| w == what);
    while let Some(start) = find(rest, b"stream\n") {
        text += &String::from_utf8_lossy(&rest[..start]);
        rest = &rest[start + 7..];
        let end = find(rest, b"\nendstream").expect("an end");
        let mut stream = Vec::new();
        flate2::read::ZlibDecoder::new(&rest[..end]).read_to_end(&mut stream).expect("sound");
        text += &String::from_utf8_lossy(&stream);
        rest = &rest[end + 10..];
    }
    text + &String::from_utf8_lossy(rest)
}

#[test]
fn a_pdf_is_a_page_as_large_as_on_paper() {
    // Type of size 28 is 2.8 mm high: ten units a millimetre.
    let mut drawing = Drawing::new(DVec2::new(508.0, 254.0), 28.0);
    let line = vec![DVec2::ZERO, DVec2::new(508.0, 254.0)];
    drawing.add("line", Shape::Line(line)).stroked(RED.faint(0.5), 2.0).dashed(3.0, 1.0);
    drawing.add("area", Shape::Area(vec![square(10.0, 90.0)])).filled(RED);
    drawing.add("label", Shape::Words(Words::new("W", DVec2::splat(50.0), 28.0))).filled(RED);
    drawing.add_framed(RgbImage::from_pixel(3, 2, Rgb([65, 66, 67])), true, DVec2::ZERO, 1.0);
    let metadata = [("scene".to_owned(), "[camera]".to_owned())];
    let pdf = drawing.to_pdf("A title", &metadata);
    assert_eq!(pdf, drawing.to_pdf("A title", &metadata));
    let text = inflated(&pdf);
    for part in [
        "/MediaBox [0 0 144 72]",
        "/Title (A title)",
        "/scene ([camera])",
        "0.28346458 0 0 -0.28346458 0 72 cm",
        "/o0 gs\n1 0 0 RG\n2 w\n1 j\n[3 1] 0 d\n0 0 m\n508 254 l\nS",
        "10 10 m\n90 10 l\n90 90 l\n10 90 l\nh\nf*",
        "/Width 3",
        "ABCABCABCABCABCABC",
        "3 0 0 -2 0 2 cm\n/i0 Do",
        "/CA 0.5",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let svg = drawing.to_svg("", &[]);
    assert!(svg.contains("width=\"50.8mm\"") && svg.contains("height=\"25.4mm\""), "{svg}");
}

#[test]
fn an_svg_shows_what_the_png_beside_it_does() {
    let numbers = (0..61 * 43).map(|i: i32| f64::from(i * i % 97) * 1e-15).collect();
    let samples = Samples::F64(numbers);
    let channels = vec![Channel { name: "time_of_flight_difference".to_owned(), samples }];
    let picture = Picture { width: 61, height: 43, channels, metadata: Vec::new() };
    let map = ScalarMap::new(&picture, "time_of_flight_difference", &PictureSettings::default())
        .expect("a map");
    let panel = SheetPanel {
        image: map.image.clone(),
        label: "(a)".to_owned(),
        caption: "a map".to_owned(),
        bar: Some(map.bar.clone()),
    };
    let pictures = vec![TablePicture::new(&map.image), TablePicture::of_map(&map, "")];
    let row =
        TableRow { title: "A row".to_owned(), words: vec![("of", "one".to_owned())], pictures };
    let drawings =
        [map.draw(false), map.draw(true), sheet("A sheet", &[panel]), table("A table", &[row])];
    for drawing in drawings {
        let svg = Drawing { mm: 1.0, ..drawing.clone() }.to_svg("A < B", &[]);
        roxmltree::Document::parse(&svg).expect("XML");
        let [width, height] = drawing.pixels();
        let mut pixels = Pixmap::new(width, height).expect("pixels");
        // A pixel a unit.
        let tree = Tree::from_str(&svg.replace("mm\"", "\""), &Options::default()).expect("SVG");
        resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
        let png = drawing.to_image([width, height]).expect("an image");
        assert!(pixels.data().chunks_exact(4).map(|pixel| &pixel[..3]).eq(png.chunks_exact(3)));
    }
}

#[test]
fn drawings_are_written_as_their_names_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut drawing = Drawing::new(DVec2::new(40.0, 20.0), 10.0);
    drawing.add("area", Shape::Area(vec![square(0.0, 20.0)])).filled(RED);
    for (name, begins) in [("a.svg", "<svg"), ("a.PDF", "%PDF-"), ("a.png", "\u{89}PNG")] {
        let path = folder.path().join(name);
        let format = DrawingFormat::of(&path).expect(name);
        drawing.write(format, "A", &[], drawing.pixels(), &path).expect(name);
        let bytes = std::fs::read(&path).expect(name);
        let begun: String = bytes.iter().take(8).map(|byte| char::from(*byte)).collect();
        assert!(begun.starts_with(begins), "{begun}");
    }
    let png = image::open(folder.path().join("a.png")).expect("an image").into_rgb8();
    assert_eq!((png.dimensions(), png.get_pixel(5, 5).0), ((40, 20), RED.rgb));
    let message = DrawingFormat::of("a.jpg".as_ref()).expect_err("no format").to_string();
    assert!(message.ends_with("use .svg, .pdf or .png"), "{message}");
    let error =
        drawing.write(DrawingFormat::Pdf, "A", &[], [1, 1], &folder.path().join("no/a.pdf"));
    assert!(error.is_err());
}
