//! Pictures whose rays share their neighbours' work, against those of rays traced one by one.

use crate::draws::Draws;
use crate::scenes::scene_seen;
use cloakroom::output::to_srgb;
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use toml::{Table, Value};

/// Width and height of the pictures: six patches.
const SIZE: [i64; 2] = [96, 64];

/// How many pixels may differ, by one step of 8 bits: what lies between two steps.
const ROUNDED: usize = 3;

/// Looks at a random device from anywhere; how many rays that takes.
///
/// # Panics
///
/// If the picture differs from that of rays traced one by one.
pub fn interpolate(draws: &mut Draws<'_>) -> u64 {
    let samples = 4;
    let scene = scene_seen(draws, SIZE, samples);
    // Pictures differ within the tolerance: coarser ones would show.
    let tolerance = 10f64.powf(draws.between(-9.0, -6.0));
    let looked_at = |exact: bool| {
        let mut scene = scene.clone();
        let trace: [(_, Value); 2] = [("tolerance", tolerance.into()), ("exact", exact.into())];
        let trace = trace.map(|(key, value)| (key.to_owned(), value));
        scene.insert("trace".to_owned(), Value::Table(Table::from_iter(trace)));
        let text = scene.to_string();
        let loaded = scene_file::parse(&text, "soak", Path::new("/nowhere"), &[]).ok()?;
        let prepared = PreparedScene::new(&loaded.scene).ok()?;
        let stop = AtomicBool::new(false);
        let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
        let picture =
            render(&prepared, ChannelSet::Image, &supervision).expect("a picture").picture;
        Some(to_srgb(&picture).expect("an image"))
    };
    let (Some(shared), Some(exact)) = (looked_at(false), looked_at(true)) else { return 1 };
    let mut differ = 0;
    for (shared, exact) in shared.pixels().zip(exact.pixels()) {
        let steps = shared.0.iter().zip(exact.0).map(|(one, other)| one.abs_diff(other));
        let most = steps.max().unwrap_or(0);
        assert!(most <= 1, "a pixel is off by {most} steps:\n{scene}");
        differ += usize::from(most > 0);
    }
    assert!(differ <= ROUNDED, "{differ} pixels differ:\n{scene}");
    (2 * samples * SIZE[0] * SIZE[1]).unsigned_abs()
}
