//! Bodies that are hardly birefringent, against isotropic ones: both waves stay in phase, and what
//! comes of them at each surface is again what comes of one.

use crate::draws::Draws;
use cloakroom::output::{Channel, Picture};
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Width and height of the pictures.
const SIZE: [u64; 2] = [24, 16];

/// By how much light and shares of power may differ.
const OFF: f64 = 1e-3;

/// How many pixels may have other light: at edges, where the filter of the photograph is a guess.
const AT_EDGES: usize = 8;

/// By how much the shares of a pixel may add up to something else than one, in single precision.
const ROUNDING: f64 = 1e-6;

/// Looks at a body whose indices differ by so little that nothing is seen of it, of any shape from
/// anywhere; how many rays that takes.
///
/// # Panics
///
/// If the picture, or what becomes of the light, is not as of an isotropic body, or power is lost.
pub fn hardly_birefringent(draws: &mut Draws<'_>) -> u64 {
    let shape = match draws.below(3) {
        0 => format!("\"box\"\nsize = [{}, {}, {}]", sizes(draws), sizes(draws), sizes(draws)),
        1 => format!("\"sphere\"\nradius = {}", 0.5 * sizes(draws)),
        _ => format!("\"cylinder\"\nradius = {}\nlength = {}", 0.5 * sizes(draws), sizes(draws)),
    };
    let mut vector = || [0; 3].map(|_| draws.between(-1.0, 1.0));
    let (axis, optic_axis) = (vector(), vector());
    let (rotation, index) = (draws.between(0.0, 90.0), draws.between(1.2, 2.0));
    let last = index + 10f64.powf(draws.between(-12.0, -10.0));
    let [width, height] = SIZE;
    let body = format!(
        "[camera]\nresolution = [{width}, {height}]\nsamples = 1\n[light]\nbandwidth_nm = 100\n\
         [surroundings]\ncolor = [0.5, 0.3, 0.1]\n[[device]]\nkind = \"body\"\naxis = {axis:?}\n\
         rotation = {rotation}\nshape = {shape}\n"
    );
    let pictures = [
        format!("index = {index:?}"),
        format!("uniaxial = {{ ordinary = {index:?}, extraordinary = {last:?}, optic_axis = {optic_axis:?} }}"),
    ]
    .map(|medium| picture(&(body.clone() + &medium + "\n")));
    let [isotropic, birefringent] = &pictures;
    let value = |channel: &Channel, pixel: usize| channel.samples.get(pixel);
    let is_share = |name: &str| ["delivered", "escaped", "absorbed", "pruned"].contains(&name);
    let mut other_light = 0;
    for pixel in 0..(width * height) as usize {
        let mut sum = 0.0;
        let mut is_off = false;
        for (one, other) in isotropic.channels.iter().zip(&birefringent.channels) {
            let [one_value, other_value] = [value(one, pixel), value(other, pixel)];
            let (name, off) = (one.name.as_str(), (one_value - other_value).abs());
            if is_share(name) {
                sum += other_value;
                assert!(
                    off < OFF,
                    "{name} of pixel {pixel}: {one_value}, {other_value}\n{body}{last}, {optic_axis:?}"
                );
            }
            is_off |= ["R", "G", "B"].contains(&name) && off >= OFF;
        }
        other_light += usize::from(is_off);
        assert!((sum - 1.0).abs() < ROUNDING, "pixel {pixel} has {sum} of its power\n{body}");
    }
    assert!(other_light <= AT_EDGES, "{other_light} pixels\n{body}{last}, {optic_axis:?}");
    2 * width * height
}

fn sizes(draws: &mut Draws<'_>) -> f64 {
    draws.between(3.0, 30.0)
}

fn picture(text: &str) -> Picture {
    let loaded = scene_file::parse(text, "soak", Path::new("/nowhere"), &[]).expect("a scene");
    let prepared = PreparedScene::new(&loaded.scene).expect("a sound scene");
    let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
    render(&prepared, ChannelSet::Everything, &supervision).expect("a picture").picture
}
