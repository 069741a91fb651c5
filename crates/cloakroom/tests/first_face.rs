//! The optional channels about the first surface that a camera ray meets, against the checked
//! numbers of the square cloak's designs (i) and (ii).
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::picture;
use cloakroom::output::Picture;

/// One pixel, seen at a horizontal angle (degrees) to the line of sight: its share in the
/// extraordinary wave and its first-face reflectance.
fn first_face(device: &str, azimuth: f64, polarizer: &str) -> [f64; 2] {
    let picture = seen(device, azimuth, polarizer);
    ["extraordinary_share", "first_face_reflectance"].map(|name| {
        let samples = &picture.channel(name).unwrap().samples;
        assert_eq!(samples.len(), 1);
        samples.get(0)
    })
}

fn seen(device: &str, azimuth: f64, polarizer: &str) -> Picture {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    // Level, a little above the edge in front; the photograph is wide enough for the empty view.
    let text = format!(
        "[camera]\nposition = [-60, 3, 0]\ntarget = [{:?}, 3, {:?}]\nprojection = \"orthographic\"\n\
         width = 0.01\nresolution = [1, 1]\nsamples = 1\npolarizer = \"{polarizer}\"\n\
         [picture]\nchannels = [\"extraordinary_share\", \"first_face_reflectance\"]\n{device}",
        -60.0 + cos,
        sin
    );
    picture(&text)
}

fn cloak(material: &str) -> String {
    format!("[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\n")
}

#[test]
fn designs_i_and_ii_reflect_and_split_as_checked() {
    // In percent, to the digits given, at 0, 5, 10, 15, 20 degrees: reflectance H and V, ordinary
    // share of H.
    let expected = [
        (
            "positive-uniaxial",
            [0.0, 0.006, 0.019, 0.029, 0.027],
            [31.3, 31.1, 30.6, 29.7, 28.6],
            [0.0, 5.2, 17.9, 33.2, 47.5],
        ),
        (
            "negative-uniaxial",
            [0.0, 0.013, 0.058, 0.150, 0.327],
            [5.4, 5.5, 5.8, 6.3, 6.9],
            [0.0, 0.13, 0.53, 1.2, 2.1],
        ),
    ];
    for (material, horizontal, vertical, ordinary) in expected {
        let device = cloak(material);
        for (i, azimuth) in [0.0, 5.0, 10.0, 15.0, 20.0].into_iter().enumerate() {
            let [share, h] = first_face(&device, azimuth, "horizontal");
            let [_, v] = first_face(&device, azimuth, "vertical");
            let [_, both] = first_face(&device, azimuth, "none");
            let what = format!("{material}, {azimuth} degrees");
            assert!((100.0 * h - horizontal[i]).abs() <= 0.000_51, "{what}: H {h}");
            assert!((100.0 * v - vertical[i]).abs() <= 0.051, "{what}: V {v}");
            assert!((both - (h + v) / 2.0).abs() < 1e-7, "{what}: {both}");
            let digit = if ordinary[i] < 1.0 { 0.0051 } else { 0.051 };
            let o = 100.0 * (1.0 - share);
            assert!((o - ordinary[i]).abs() <= digit, "{what}: ordinary {o}");
        }
    }
}

#[test]
fn other_surfaces_have_no_extraordinary_share() {
    // Impedance matched: nothing is reflected. Graded, without steps of the index: next to nothing.
    let [share, reflectance] = first_face(&cloak("impedance-matched"), 10.0, "none");
    assert!(share.is_nan() && reflectance.abs() < 1e-12);
    let gaussian = "[[device]]\nkind = \"double-gaussian-cloak\"\n";
    let [share, reflectance] = first_face(gaussian, 10.0, "none");
    assert!(share.is_nan() && reflectance > 1e-5 && reflectance < 6e-4, "{reflectance}");
    // Metal reflects everything; where nothing is, there is no share of anything.
    let bare = format!("{}show = \"bare\"\n", cloak("positive-uniaxial"));
    let [share, reflectance] = first_face(&bare, 10.0, "none");
    assert!(share.is_nan() && (reflectance - 1.0).abs() < 1e-7, "{reflectance}");
    assert!(first_face("", 10.0, "none").iter().all(|value| value.is_nan()));
    // A photograph before the cloak hides it.
    let hidden = format!("[photograph]\nx = -30\n{}", cloak("positive-uniaxial"));
    assert!(first_face(&hidden, 10.0, "none").iter().all(|value| value.is_nan()));
}
