//! Rays near the axis against the lensmaker's matrices.

use super::{after, assert_near, face, gap, matrix};
use crate::rays::{Numbers, assembly};

#[test]
fn thick_lenses_are_those_of_the_lensmaker() {
    let mut numbers = Numbers(3);
    for k in 0..40 {
        let mut radius = || {
            let size = numbers.between(8.0, 40.0);
            if numbers.next() < 0.5 { size } else { -size }
        };
        let (front, back) = (radius(), if k % 5 == 0 { 0.0 } else { radius() });
        let (index, thickness) = (numbers.between(1.2, 2.5), numbers.between(1.0, 6.0));
        // Conic constants do not matter near the axis.
        let conic = numbers.between(-3.0, 1.0);
        let bench = assembly(&format!(
            "[[device]]\nkind = \"lens\"\nfront_radius = {front:?}\nback_radius = {back:?}\n\
             thickness = {thickness:?}\ndiameter = 2\nindex = {index:?}\nfront_conic = {conic:?}"
        ));
        let lens = after(face(back, index, 1.0), after(gap(thickness), face(front, 1.0, index)));
        let ways = gap(20.0 - 0.5 * thickness);
        let wanted = after(ways, after(lens, ways));
        assert_near(
            matrix(&bench, [-20.0, 20.0]),
            wanted,
            1e-9,
            &format!("{front} {back} {index}"),
        );
    }
}

#[test]
fn a_cemented_doublet_is_that_of_the_textbook() {
    // Two lenses that share a face: an achromat of crown and flint glass.
    let [r, glue, s] = [12.2, -12.4, -26.5];
    let (crown, flint) = (1.5168, 1.7847);
    let (thick, thin) = (1.1, 0.4);
    let bench = assembly(&format!(
        "[[device]]\nkind = \"lens\"\nfront_radius = {r}\nback_radius = {glue}\nthickness = {thick}\n\
         diameter = 5\nindex = {crown}\nposition = [{:?}, 0, 0]\n\
         [[device]]\nkind = \"lens\"\nfront_radius = {glue}\nback_radius = {s}\nthickness = {thin}\n\
         diameter = 5\nindex = {flint}\nposition = [{:?}, 0, 0]",
        0.5 * thick,
        thick + 0.5 * thin
    ));
    let faces = after(
        face(s, flint, 1.0),
        after(gap(thin), after(face(glue, crown, flint), after(gap(thick), face(r, 1.0, crown)))),
    );
    let wanted = after(gap(10.0 - thick - thin), after(faces, gap(10.0)));
    assert_near(matrix(&bench, [-10.0, 10.0]), wanted, 1e-9, "doublet");
}
