//! Tests of colors against the standard's own numbers.

use super::*;

#[test]
fn things_keep_their_color_in_daylight() {
    for interpolation in [Interpolation::Polynomial(4), Interpolation::Linear(12)] {
        let bands = Bands::new(&Lamp::D65, interpolation, [390.0, 730.0]);
        let is_all = |color: DMat3| {
            let off = color - DMat3::IDENTITY;
            assert!(off.to_cols_array().iter().all(|entry| entry.abs() < 1e-14), "{off}");
        };
        let of_group = |group: &Group| group.lights.iter().map(|light| light.color).sum::<DMat3>();
        for groups in &bands.levels {
            is_all(groups.iter().map(of_group).sum());
            // Each has its own light, from where the one before it ends.
            assert!(groups.windows(2).all(|pair| pair[0].edges_nm[1] == pair[1].edges_nm[0]));
        }
        is_all(
            bands
                .stretches
                .iter()
                .flat_map(|stretch| &stretch.lights)
                .map(|(_, light)| light.color)
                .sum(),
        );
    }
}
