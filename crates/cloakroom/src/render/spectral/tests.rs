//! Pictures in colors against those of each wavelength by itself, and against closed forms.

use crate::color::Lamp;
use crate::output::Samples;
use crate::render::{ChannelSet, PreparedScene, Supervision, render};
use crate::scene::Scene;
use crate::scene_file;
use glam::DVec3;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn scene(toml: &str) -> Scene {
    scene_file::parse(toml, "test", Path::new(""), &[]).expect("a scene").scene
}

/// The linear colors of a picture.
fn colors(prepared: &PreparedScene<'_>) -> Vec<DVec3> {
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| (), stop: &stop };
    let picture = render(prepared, ChannelSet::Image, &supervision).expect("rendered").picture;
    let channel = |name| match &picture.channel(name).expect("an image").samples {
        Samples::F32(values) => values.clone(),
        _ => panic!("an image is in single precision"),
    };
    let [red, green, blue] = ["R", "G", "B"].map(channel);
    let pixels = red.iter().zip(&green).zip(&blue);
    pixels.map(|((r, g), b)| DVec3::new((*r).into(), (*g).into(), (*b).into())).collect()
}

/// The sum of pictures of every wavelength of a lamp that the standard has, each traced alone.
fn brute_force(scene: &Scene, lamp: &Lamp) -> Vec<DVec3> {
    let prepared = PreparedScene::new(scene).expect("sound");
    let mut sum = Vec::new();
    for sample in lamp.samples() {
        // The laws of some hold in less than what is seen.
        let nm = sample.nm.clamp(390.0, 730.0);
        let seen = colors(&prepared.at(nm).expect("a law"));
        sum.resize(seen.len(), DVec3::ZERO);
        for (sum, seen) in sum.iter_mut().zip(seen) {
            *sum += sample.color_of_things() * seen;
        }
    }
    sum
}

/// The mean and the largest difference of two pictures.
fn differences(one: &[DVec3], other: &[DVec3]) -> [f64; 2] {
    let off = || one.iter().zip(other).map(|(one, other)| (*one - *other).abs().max_element());
    [off().sum::<f64>() / one.len() as f64, off().fold(0.0, f64::max)]
}

const PRISM: &str = "[camera]\nresolution = [40, 30]\nsamples = 4\nfield_of_view = 14\n\
    [[device]]\nkind = \"prisms\"\nrotation = 25\n\
    [[device.prism]]\ncorners = [[-9, -16], [9, -16], [0, 16]]\nmaterial = \"sf11\"\n";

/// Holds a picture of a scene, whose light is that of a lamp, against that of all its wavelengths: what it may be off by, in
/// the mean and at most.
fn is_the_sum(scene: &Scene, lamp: &Lamp, [mean, largest]: [f64; 2]) {
    let found = colors(&PreparedScene::new(scene).expect("sound"));
    let off = differences(&found, &brute_force(scene, lamp));
    assert!(off[0] < mean && off[1] < largest, "{off:?} in {:?}", scene.light);
}

#[test]
fn a_picture_is_the_sum_of_those_of_all_wavelengths() {
    for (spectrum, lamp) in [
        ("\"D65\"", Lamp::D65),
        ("\"E\"", Lamp::EqualPower),
        ("{ black_body_k = 2856 }", Lamp::BlackBody(2856.0)),
    ] {
        let scene = scene(&format!("{PRISM}[light]\nspectrum = {spectrum}\n"));
        // Groups of wavelengths share a look as wide as a pixel; the largest differences are in pixels in which
        // light of some wavelengths takes a way that others do not.
        is_the_sum(&scene, &lamp, [7e-3, 7e-2]);
    }
}

#[test]
fn a_design_is_what_it_is_at_each_wavelength() {
    // Ways change all over the spectrum, and with them what is seen where.
    for (law, spectrum, lamp) in [
        ("drude", "\"D65\"", Lamp::D65),
        ("lorentz", "\"E\"", Lamp::EqualPower),
        (
            "drude",
            "{ table = [[530, 0], [531, 1], [570, 1], [571, 0]] }",
            Lamp::Table(vec![[530.0, 0.0], [531.0, 1.0], [570.0, 1.0], [571.0, 0.0]]),
        ),
    ] {
        let scene = scene(&format!(
            "[camera]\nresolution = [40, 30]\nsamples = 4\nfield_of_view = 30\n\
             [light]\nspectrum = {spectrum}\n\
             [[device]]\nkind = \"square-cloak\"\ndispersion = \"{law}\"\n"
        ));
        is_the_sum(&scene, &lamp, [1e-2, 7e-2]);
    }
}

#[test]
fn laws_that_hold_in_nearly_all_light_do_in_daylight() {
    let picture = |lamp: &str, material: &str| {
        let scene = scene(&format!(
            "[camera]\nresolution = [4, 4]\n[light]\nspectrum = {lamp}\n\
             [[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 9\nmaterial = {material}\n"
        ));
        PreparedScene::new(&scene).map(|prepared| colors(&prepared))
    };
    for material in ["\"pmma\"", "\"rutile\"", "\"sf11\""] {
        for lamp in
            ["\"D65\"", "{ table = [[450, 1], [640, 1]] }", "{ table = [[760, 1], [770, 1]] }"]
        {
            let seen = picture(lamp, material).expect("it holds nearly everywhere");
            assert!(seen.iter().all(|pixel| pixel.is_finite()), "{material} {lamp}");
        }
    }
}

#[test]
fn red_green_and_blue_have_no_spectrum() {
    let pane = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 9\n";
    let asked = "[picture]\nchannels = [\"spectrum\"]\n";
    for (medium, light) in
        [("index = 1.5", "rgb"), ("index = 1.5", "auto"), ("material = \"bk7\"", "rgb")]
    {
        let scene = scene(&format!("{asked}[light]\nspectrum = \"{light}\"\n{pane}{medium}\n"));
        let error = PreparedScene::new(&scene).expect_err("there is none").to_string();
        assert!(error.contains("spectrum = \"D65\""), "{error}");
    }
    for (medium, light) in [("index = 1.5", "D65"), ("material = \"bk7\"", "auto")] {
        let scene = scene(&format!("{asked}[light]\nspectrum = \"{light}\"\n{pane}{medium}\n"));
        PreparedScene::new(&scene).expect("it has one");
    }
}

#[test]
fn lines_are_each_traced() {
    let lines = "{ lines = [{ wavelength_nm = 436, power = 2 }, { wavelength_nm = 546.1 }, { wavelength_nm = 578 }] }";
    let scene = scene(&format!("{PRISM}[light]\nspectrum = {lines}\n"));
    let lamp = Lamp::Lines(vec![[436.0, 2.0], [546.1, 1.0], [578.0, 1.0]]);
    is_the_sum(&scene, &lamp, [2e-3; 2]);
}

#[test]
fn what_no_law_disperses_keeps_its_color_in_daylight() {
    let device = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 9\nindex = 1.5\n";
    let toml = |spectrum: &str| {
        let light = format!("[light]\nspectrum = \"{spectrum}\"\n");
        scene(&format!("[camera]\nresolution = [40, 30]\n{light}{device}"))
    };
    let (spectral, rgb) = (toml("D65"), toml("rgb"));
    let [spectral, rgb] = [&spectral, &rgb].map(|s| colors(&PreparedScene::new(s).expect("sound")));
    let [_, largest] = differences(&spectral, &rgb);
    assert!(largest < 1e-6, "{largest:e}");
}

/// A scene in which all is white, but for a device.
fn white(rest: &str) -> Scene {
    // The photograph is out of sight.
    scene(&format!(
        "[camera]\nresolution = [4, 4]\nprojection = \"orthographic\"\nwidth = 1e-3\n\
         [photograph]\nposition = [0, 500, 0]\nwidth = 1\n[surroundings]\ncolor = [1, 1, 1]\n\
         [trace]\nmin_power = 1e-9\n{rest}"
    ))
}

#[test]
fn white_stays_white_behind_glass() {
    let device = "[[device]]\nkind = \"prisms\"\nrotation = 25\n\
        [[device.prism]]\ncorners = [[-9, -16], [9, -16], [0, 16]]\nmaterial = \"sf11\"\n";
    for pixel in colors(&PreparedScene::new(&white(device)).expect("sound")) {
        assert!((pixel - DVec3::ONE).abs().max_element() < 1e-3, "{pixel}");
    }
}

/// Nothing comes from behind the camera.
const BLACK_BEHIND: &str = "[[device]]\nkind = \"body\"\nshape = \"box\"\nposition = [-300, 0, 0]\n\
    size = [1, 200, 200]\nsurface = { color = [0, 0, 0] }\n";

/// The color of white light of which that share is seen.
fn color_of(lamp: &Lamp, share: impl Fn(f64) -> f64) -> DVec3 {
    let samples = lamp.samples();
    samples.iter().map(|sample| sample.color * share(sample.nm)).sum()
}

#[test]
fn thin_films_have_newtons_colors() {
    // A film of water in air, straight ahead against black: what is seen is what it lets through.
    for thickness_um in [0.15_f64, 0.3, 0.5, 0.8] {
        let film = format!(
            "[light]\nspectrum = \"D65\"\n[[device]]\nkind = \"body\"\nshape = \"box\"\n\
             size = [{}, 20, 20]\nindex = 1.8\n\
             {BLACK_BEHIND}",
            thickness_um * 1e-4
        );
        let wanted = color_of(&Lamp::D65, |nm| {
            let (r, phase) =
                ((0.8_f64 / 2.8).powi(2), 4e3 * std::f64::consts::PI * 1.8 * thickness_um / nm);
            let (once, twice) = ((1.0 - r).powi(2), 1.0 + r * r - 2.0 * r * phase.cos());
            once / twice
        });
        for pixel in colors(&PreparedScene::new(&white(&film)).expect("sound")) {
            let off = (pixel - wanted).abs().max_element();
            assert!(off < 3e-3, "{thickness_um} um: {pixel} instead of {wanted}");
        }
    }
}

#[test]
fn coatings_have_the_colors_of_their_films() {
    // Half a wave of green in a film of titania on glass.
    let pane = format!(
        "[light]\nspectrum = \"D65\"\n[[device]]\nkind = \"body\"\nshape = \"box\"\n\
        size = [1, 20, 20]\nindex = 1.5\ncoating = [{{ index = 2.4, thickness_nm = 250 }}]\n{BLACK_BEHIND}"
    );
    // Both sides have one; between them light goes to and fro without a phase.
    let wanted = color_of(&Lamp::D65, |nm| {
        let phase = 4.0 * std::f64::consts::PI * 2.4 * 250.0 / nm;
        let (outer, inner) = ((1.0 - 2.4) / 3.4, (2.4 - 1.5) / 3.9);
        let (both, product) = (outer * outer + inner * inner, outer * inner);
        let cross = 2.0 * product * phase.cos();
        let reflected = (both + cross) / (1.0 + product * product + cross);
        (1.0 - reflected) / (1.0 + reflected)
    });
    for pixel in colors(&PreparedScene::new(&white(&pane)).expect("sound")) {
        assert!((pixel - wanted).abs().max_element() < 3e-3, "{pixel} instead of {wanted}");
    }
}

#[test]
fn a_wedge_between_polarizers_has_the_colors_of_its_delay() {
    for thickness_um in [20.0_f64, 60.0, 110.0] {
        let plate = format!(
            "[light]\nspectrum = \"D65\"\n\
             [[device]]\nkind = \"polarizer\"\nposition = [-20, 0, 0]\nlength = 20\nwidth = 20\n\
             [[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [{}, 18, 18]\n\
             uniaxial = {{ ordinary = 1.544, extraordinary = 1.553, optic_axis = [0, 1, 1] }}\n\
             [[device]]\nkind = \"polarizer\"\nposition = [20, 0, 0]\nlength = 20\nwidth = 20\nangle = 90\n{BLACK_BEHIND}",
            thickness_um * 1e-4
        );
        let wanted = color_of(&Lamp::D65, |nm| {
            let half = std::f64::consts::PI * 9.0 * thickness_um / nm;
            0.5 * half.sin().powi(2)
        });
        for pixel in colors(&PreparedScene::new(&white(&plate)).expect("sound")) {
            // Both faces let less through, and what they send to and fro is delayed more.
            let reflected = (0.5485_f64 / 2.5485).powi(2);
            let through = (1.0 - reflected) / (1.0 + reflected);
            let off = (pixel - wanted * through).abs();
            assert!(off.max_element() < 3e-3, "{thickness_um} um: {pixel} instead of {wanted}");
        }
    }
}
