//! The table of what pruning costs in `docs/polarization.md` is true, and what is followed for one
//! polarization makes no difference to the image of another.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::{picture, rendered};
use cloakroom::render::ChannelSet;
use std::path::Path;

/// Mean and largest share of a pixel's power that is pruned, in percent.
fn pruned(design: &str, rotation: &str, min_power: &str) -> [f64; 2] {
    let device = match design {
        "(i)" => "kind = \"square-cloak\"\nmaterial = \"positive-uniaxial\"",
        "(ii)" => "kind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"",
        "(iii)" => "kind = \"square-cloak\"",
        "(iv)" => "kind = \"double-gaussian-cloak\"",
        other => panic!("there is no design {other}"),
    };
    let text = format!(
        "[camera]\nresolution = [128, 96]\nsamples = 1\n[trace]\nmin_power = {min_power}\n\
         [[device]]\n{device}\nrotation = {rotation}\n"
    );
    let picture = picture(&text);
    let samples = &picture.channel("pruned").unwrap().samples;
    let shares: Vec<f64> = (0..samples.len()).map(|i| 100.0 * samples.get(i)).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    [mean, shares.into_iter().fold(0.0, f64::max)]
}

#[test]
fn the_documented_cost_of_pruning_is_what_pictures_have() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/polarization.md");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| line.starts_with("| (i") && line.contains('°'));
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, design, rotation, numbers @ .., _] = cells.as_slice() else { panic!("{row}") };
        let rotation = rotation.trim_end_matches('°');
        for (min_power, documented) in ["1e-4", "1e-6"].into_iter().zip(numbers.chunks(2)) {
            for (computed, digits) in pruned(design, rotation, min_power).iter().zip(documented) {
                // To the last digit given.
                let places = digits.split_once('.').unwrap().1.len() as i32;
                let off = (computed - digits.parse::<f64>().unwrap()).abs();
                assert!(off < 0.6 * 10f64.powi(-places), "{row} {min_power}: {computed}");
                count += 1;
            }
        }
    }
    assert_eq!(count, 8 * 4);
}

#[test]
fn images_through_polarizers_are_those_of_pictures_through_them_alone() {
    for (material, rotation) in [("positive-uniaxial", 7), ("negative-uniaxial", 20)] {
        let seen = |polarizer: &str, wanted| {
            let text = format!(
                "[camera]\nresolution = [96, 72]\nsamples = 1\npolarizer = \"{polarizer}\"\n\
                 [[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\n\
                 rotation = {rotation}\n"
            );
            rendered(Path::new(""), &text, wanted)
        };
        let both = seen("none", ChannelSet::Polarizers);
        assert_eq!(both.image_through(""), seen("none", ChannelSet::Image).image_through(""));
        for polarizer in ["horizontal", "vertical"] {
            let alone = seen(polarizer, ChannelSet::Image).image_through("");
            assert_eq!(both.image_through(polarizer), alone, "{material} {polarizer}");
        }
    }
}
