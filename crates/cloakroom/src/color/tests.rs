//! Tests of colors against the standard's own numbers.

use super::*;
use optics::material::{Dispersion, IndexLaw, Material};

#[test]
fn things_keep_their_color_in_daylight() {
    let bands = Bands::new(&Lamp::D65, 4, [390.0, 730.0]);
    let of_group = |group: &Group| group.lights.iter().map(|light| light.color).sum::<DMat3>();
    for groups in &bands.levels {
        let off = groups.iter().map(of_group).sum::<DMat3>() - DMat3::IDENTITY;
        assert!(off.to_cols_array().iter().all(|entry| entry.abs() < 1e-14), "{off}");
        // Each has its own light, from where the one before it ends.
        assert!(groups.windows(2).all(|pair| pair[0].edges_nm[1] == pair[1].edges_nm[0]));
    }
}

#[test]
fn few_wavelengths_tell_what_a_material_is_at_all() {
    // The squares of indices to 1e-4, as media are wanted for pictures; of rutile, five wavelengths do.
    let off = |law: &IndexLaw, count: usize| {
        let [shortest, longest] = [390.0, 730.0];
        let range = [f64::max(shortest, 1e3 * law.range_um[0] + 1e-9), longest];
        let square = |nm: f64| law.at(1e-3 * nm).expect("in its range").index.re.powi(2);
        let nodes = chebyshev_nodes(count, range);
        let known: Vec<f64> = nodes.iter().map(|nm| square(*nm)).collect();
        let error = |i: u32| {
            let nm = range[0] + (range[1] - range[0]) * f64::from(i) / 200.0;
            let weights = weights(&nodes, nm);
            let told: f64 = weights.iter().zip(&known).map(|(weight, known)| weight * known).sum();
            (told / square(nm) - 1.0).abs()
        };
        (0..=200).map(error).fold(0.0, f64::max)
    };
    for name in Material::NAMES {
        let material = Material::named(name).expect("it comes with the program");
        for law in std::iter::once(&material.ordinary).chain(&material.extraordinary) {
            if !matches!(law.dispersion, Dispersion::Formula { .. }) {
                continue;
            }
            let count = if name == "rutile" { 5 } else { 4 };
            let error = off(law, count);
            assert!(error < 1e-4, "{name}: {error}");
        }
    }
}
