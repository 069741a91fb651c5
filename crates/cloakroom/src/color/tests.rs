//! Tests of colors against the standard's own numbers.

use super::*;

#[test]
fn things_keep_their_color_in_daylight() {
    let bands = Bands::new(&Lamp::D65, 4, [390.0, 730.0]);
    let of_group = |group: &Group| group.lights.iter().map(|light| light.color).sum::<DMat3>();
    let off = of_group(&bands.levels[0][0]) - DMat3::IDENTITY;
    assert!(off.to_cols_array().iter().all(|entry| entry.abs() < 1e-14), "{off}");
}
