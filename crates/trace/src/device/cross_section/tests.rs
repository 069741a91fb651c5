use super::super::{Device, MediumWords, PrismOfMedium, Prisms, Request, Show};
use super::*;

fn built(kind: &str, show: Show, length: Option<f64>) -> Structure {
    super::super::built(kind, &[], Request { show, length, ..Request::default() })
}

fn area(contour: &Contour) -> f64 {
    let p = &contour.points;
    let twice: f64 = (0..p.len()).map(|i| p[i].perp_dot(p[(i + 1) % p.len()])).sum();
    (twice / 2.0).abs()
}

#[test]
fn the_square_cloak_has_four_triangles_around_a_rhombus() {
    for length in [None, Some(5.0)] {
        let structure = built("square-cloak", Show::Cloak, length);
        let section = structure.cross_section();
        let [square] = &section.outlines[..] else { panic!("{:?}", section.outlines) };
        assert!(square.closed && square.corners().len() == 4);
        assert!((area(square) - 14.1 * 14.1).abs() < 1e-9);
        let [rhombus] = &section.metal[..] else { panic!("{:?}", section.metal) };
        assert!(rhombus.closed && rhombus.corners().len() == 4);
        assert!((area(rhombus) - 114.78).abs() < 5e-3);
        assert_eq!(section.regions.len(), 4);
        let cells: f64 = section.regions.iter().map(|region| area(&region.border[0])).sum();
        assert!((cells + area(rhombus) - area(square)).abs() < 1e-9);
        for region in &section.regions {
            assert_eq!(region.border[0].corners().len(), 3);
            assert!(!region.region.is_graded() && region.region.medium_at(DVec2::ZERO).is_some());
        }
        assert!(section.regions[0].holds(DVec2::new(3.0, 5.0)));
        assert!(!section.regions[1].holds(DVec2::new(3.0, 5.0)));
    }
}

#[test]
fn the_double_gaussian_cloak_has_two_halves_around_a_lens() {
    for length in [None, Some(5.0)] {
        let structure = built("double-gaussian-cloak", Show::Cloak, length);
        let section = structure.cross_section();
        let [cut] = &section.outlines[..] else { panic!("{:?}", section.outlines) };
        assert_eq!(cut.corners().len(), 4);
        assert!((area(cut) - 50.0 * 57.14).abs() < 1e-9);
        let [lens] = &section.metal[..] else { panic!("{:?}", section.metal) };
        assert!(lens.closed);
        // Chords of a curve: a little less, or more where it is hollow.
        assert!((area(lens) - 114.83).abs() < 0.05, "{}", area(lens));
        let [upper, lower] = &section.regions[..] else { panic!() };
        assert!((area(&upper.border[0]) - area(&lower.border[0])).abs() < 1e-9);
        let all = area(&upper.border[0]) + area(&lower.border[0]) + area(lens);
        assert!((all - area(cut)).abs() < 1e-9);
        let index = |region: &Section<'_>, y: f64| {
            let medium = region.region.medium_at(DVec2::new(0.0, y));
            medium.map(|medium| medium.permittivity().x_axis.x.sqrt())
        };
        assert!(index(upper, 4.25).is_some_and(|n| (n - 1.918).abs() < 5e-4));
        assert_eq!(index(upper, 10.0), index(lower, -10.0));
        assert_eq!(index(upper, -10.0), None);
    }
}

#[test]
fn concave_prisms_are_whole() {
    // An L beside a square that fills its corner.
    let prism = |corners: &[[f64; 2]], index: f64| PrismOfMedium {
        corners: Some(corners.to_vec()),
        words: MediumWords { index: Some(index.into()), ..MediumWords::default() },
        ..PrismOfMedium::default()
    };
    let l = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];
    let square = [[1.0, 1.0], [4.0, 1.0], [4.0, 4.0], [1.0, 4.0]];
    let prism = vec![prism(&l, 1.5), prism(&square, 2.0)];
    let prisms = Prisms { prism, ..Prisms::default() };
    let structure = prisms.build(Request::default()).expect("a device");
    assert!(structure.regions.len() > 2, "the L is cut");
    let section = structure.cross_section();
    let corners = |region: &Section<'_>| {
        assert_eq!(region.border.len(), 1);
        (region.border[0].corners().len(), area(&region.border[0]))
    };
    let [l, square] = &section.regions[..] else { panic!("{:?}", section.regions) };
    assert_eq!((corners(l), corners(square)), ((6, 7.0), (4, 9.0)));
    assert_eq!(structure.media().values().sum::<usize>(), 2);
    assert!(l.holds(DVec2::new(0.5, 3.0)) && !l.holds(DVec2::new(2.0, 2.0)));
}

#[test]
fn bare_metal_and_mirrors_have_no_cells() {
    for kind in ["square-cloak", "double-gaussian-cloak"] {
        let bare = built(kind, Show::Bare, None);
        let section = bare.cross_section();
        assert!(section.regions.is_empty() && section.metal == section.outlines);
        let [metal] = &section.metal[..] else { panic!("{:?}", section.metal) };
        assert!(metal.closed && metal.surrounds(DVec2::ZERO));
        assert!((area(metal) - 114.8).abs() < 0.1);
        let mirror = built(kind, Show::Mirror, None);
        let section = mirror.cross_section();
        let [strip] = &section.metal[..] else { panic!("{:?}", section.metal) };
        assert!(!strip.closed && strip.points.len() == 2);
    }
}

#[test]
fn lines_are_joined_whichever_way_they_run() {
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let square = [
        vec![p(0.0, 0.0), p(1.0, 0.0)],
        vec![p(0.0, 1.0), p(1.0, 1.0)],
        vec![p(0.0, 0.0), p(0.0, 1.0)],
        vec![p(1.0, 1.0), p(1.0, 0.0)],
    ]
    .map(|points| Edge { points, far: FarSide::Outside });
    let contours = joined(&square);
    assert_eq!(contours.len(), 1);
    assert!(contours[0].closed && contours[0].points.len() == 4);
    assert!(contours[0].surrounds(p(0.5, 0.5)) && !contours[0].surrounds(p(1.5, 0.5)));
    // Without one side it is open, wherever one begins.
    for missing in 0..4 {
        let contours = joined((0..4).filter(|i| *i != missing).map(|i| &square[i]));
        assert_eq!(contours.len(), 1);
        assert!(!contours[0].closed && contours[0].points.len() == 4);
        assert_eq!(contours[0].corners().len(), 4);
    }
}
