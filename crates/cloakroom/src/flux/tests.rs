use super::result::given_back;
use super::*;
use crate::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn scene(text: &str) -> Scene {
    scene_file::parse(text, "scene", Path::new(""), &[]).expect("a scene").scene
}

fn measured(
    text: &str,
    angles: &[f64],
    tilt: f64,
    sampling: Sampling,
) -> Result<FluxReport, FluxError> {
    let scene = scene(text);
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    let directions = across_range(&scene.receiver, angles, tilt);
    flux(&scene, &directions, sampling, &|_| {}, &supervision)
}

const FEW: Sampling = Sampling { rays: 2048, samples: 4, cells: 40 };
const RECEIVER: &str = "[receiver]\nposition = [30, 0, 0]\nwidth = 50\nlength = 40\n";
const SQUARE: &str = "[[device]]\nkind = \"square-cloak\"\n";

/// That a number is what it should be within five of its errors.
fn agrees(total: Total, expected: f64, name: &str) {
    let off = (total.mean - expected).abs();
    assert!(
        off < 5.0 * total.error + 1e-9,
        "{name}: {} ± {} against {expected}",
        total.mean,
        total.error
    );
}

#[test]
fn free_light_falls_off_with_the_cosine() {
    for (tilt, angle) in [(0.0, 0.0), (0.0, 37.0), (25.0, -50.0)] {
        let report =
            measured(&format!("{RECEIVER}{SQUARE}"), &[angle], tilt, FEW).expect("a report");
        let incidence = &report.incidences[0];
        let cosine = incidence.degrees.to_radians().cos();
        for light in 0..3 {
            agrees(incidence.totals[Stand::Nothing as usize][light], cosine, "nothing");
        }
        let map = &incidence.maps[Stand::Nothing as usize];
        let worst = map.iter().map(|cell| (cell - cosine).abs()).fold(0.0, f64::max);
        assert!(worst < 0.05 * cosine, "{worst}");
    }
}

#[test]
fn bare_metal_takes_its_shadow_and_the_cloak_gives_it_back() {
    // At 0 degrees the rhombus is 2b = 11.51 cm high and reflects nothing forward within the
    // receiver.
    let report = measured(&format!("{RECEIVER}{SQUARE}"), &[0.0], 0.0, FEW).expect("a report");
    let incidence = &report.incidences[0];
    let height = 2.0 * 14.1 / 2f64.sqrt() / 3f64.sqrt();
    // Rays reflected at 30 degrees from the axis are turned by 60: they leave beside the receiver,
    // 30 tan 60° > 25.
    agrees(incidence.totals[Stand::Bare as usize][2], 1.0 - height / 50.0, "bare");
    agrees(incidence.totals[Stand::Cloaked as usize][2], 1.0, "cloaked");
    for gain in incidence.gains {
        let gain = gain.expect("a shadow");
        assert!((gain.percent - 100.0).abs() < 5.0 * gain.error + 1e-6, "{gain:?}");
    }
    let steps: Vec<u64> = incidence.convergence.iter().map(|step| step.rays).collect();
    assert_eq!(steps, [2 * 2048, 4 * 2048]);
    // In the shadow nothing arrives.
    let middle = incidence.maps[Stand::Bare as usize][20];
    assert_eq!(middle, 0.0);
}

#[test]
fn what_has_no_bare_view_stays_and_what_is_in_a_core_goes() {
    let ball = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 3\nsurface = {}\n";
    let square = format!("{SQUARE}length = 30\n");
    let total = |text: &str, stand: Stand| {
        let report = measured(&format!("{RECEIVER}{text}"), &[0.0], 0.0, FEW).expect("a report");
        report.incidences[0].totals[stand as usize]
    };
    let open = total(&format!("{square}core = \"open\"\n{ball}"), Stand::Bare);
    assert_eq!(open, total(&square, Stand::Bare));
    let lens = "[[device]]\nkind = \"luneburg-lens\"\n";
    assert_eq!(total(lens, Stand::Bare), total(lens, Stand::Cloaked));
}

#[test]
fn a_shadow_in_one_sample_alone_has_no_error() {
    assert_eq!(given_back(&[1.0, 1.0], &[1.0, 0.5], &[1.0, 1.0]), None);
    let gain = given_back(&[1.0, 1.0], &[0.6, 0.5], &[1.0, 0.9]).expect("a shadow");
    // 100 · 0.8/0.9, and 100 and 80 without one of them.
    assert!((gain.percent - 800.0 / 9.0).abs() < 1e-12 && (gain.error - 10.0).abs() < 1e-12);
}

#[test]
fn a_narrow_receiver_takes_no_more_rays_than_it_is_told() {
    let text = "[receiver]\nposition = [30, 0, 0]\nwidth = 50\nlength = 0.001\n[[device]]\nkind = \"body\"\n\
                shape = \"sphere\"\nradius = 0.0001\n";
    let report = measured(text, &[0.0], 0.0, FEW).expect("a report");
    assert!(report.incidences[0].convergence[0].rays <= 2 * 2048 + 2, "{report:?}");
}

#[test]
fn a_ball_in_the_way_takes_its_disc() {
    let text = format!("{RECEIVER}[[device]]\nkind = \"sphere-cloak\"\n");
    let sampling = Sampling { rays: 20_000, ..FEW };
    let report = measured(&text, &[0.0], 0.0, sampling).expect("a report");
    assert_eq!(report.cells, [40, 32]);
    let incidence = &report.incidences[0];
    agrees(incidence.totals[Stand::Nothing as usize][2], 1.0, "nothing");
    // Of the light on the ball of radius 4 all that is scattered forward onto the receiver comes
    // back to it: what is turned by less than about 40 degrees, cos²(θ/2) of the disc's edge.
    let disc = std::f64::consts::PI * 16.0 / (50.0 * 40.0);
    let bare = incidence.totals[Stand::Bare as usize][2];
    assert!(bare.mean > 1.0 - disc && bare.mean < 1.0 - 0.8 * disc, "{bare:?} {disc}");
    agrees(incidence.totals[Stand::Cloaked as usize][2], 1.0, "cloaked");
}

#[test]
fn the_sun_stands_highest_at_noon() {
    let receiver = scene(RECEIVER).receiver;
    let day = sun_day(&receiver, 50.0, 23.44, 0.5);
    let incidences: Vec<f64> = day.iter().map(|direction| direction.incidence(&receiver)).collect();
    let least = incidences.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((least - (50.0 - 23.44)).abs() < 1e-9, "{least}");
    // A day of 16 hours and some minutes at midsummer in 50 degrees: cos H = -tan φ tan δ.
    let half =
        (-(50f64.to_radians().tan() * 23.44f64.to_radians().tan())).acos().to_degrees() / 15.0;
    assert!((day[0].label - (12.0 - half)).abs() < 0.6, "{} {half}", day[0].label);
    // In the morning the light comes from the east and goes west, at noon it goes north.
    let noon = day.iter().find(|direction| direction.label == 12.0).expect("noon");
    assert!(noon.along.z > 0.4 && noon.along.y.abs() < 1e-12, "{noon:?}");
    assert!(sun_day(&receiver, 80.0, -23.44, 0.5).is_empty());
}

#[test]
fn the_numbers_do_not_depend_on_the_order_of_work() {
    let text = format!("{RECEIVER}{SQUARE}");
    let twice = [0, 1].map(|_| measured(&text, &[20.0], 0.0, FEW).expect("a report"));
    assert_eq!(twice[0], twice[1]);
}

#[test]
fn files_hold_what_was_measured() {
    let report =
        measured(&format!("{RECEIVER}{SQUARE}"), &[0.0, 30.0], 0.0, FEW).expect("a report");
    let csv = flux_csv(&report);
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.iter().map(Vec::len).collect::<Vec<_>>(), [26; 3]);
    let column = rows[0].iter().position(|name| *name == "unpolarized_cloaked").expect("a column");
    let value: f64 = rows[2][column].parse().expect("a number");
    assert_eq!(value, report.incidences[1].totals[Stand::Cloaked as usize][2].mean);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.npz");
    write_flux_npz(&report, &path).expect("written");
    let mut npz = ndarray_npy::NpzReader::new(std::fs::File::open(&path).expect("a file"))
        .expect("an archive");
    let map: ndarray::Array4<f64> = npz.by_name("map").expect("maps");
    assert_eq!(map.dim(), (2, 3, 1, 40));
    assert_eq!(map[(1, 2, 0, 7)], report.incidences[1].maps[2][7]);
    let given: ndarray::Array2<f64> = npz.by_name("given_back_percent").expect("gains");
    assert_eq!(given[(0, 2)], report.incidences[0].gains[2].expect("a shadow").percent);
}

#[test]
fn what_cannot_be_measured_is_said() {
    let refused = |text: &str, angles: &[f64], part: &str| {
        let error = measured(text, angles, 0.0, FEW).expect_err("refused");
        assert!(error.to_string().contains(part), "{error}");
    };
    refused(&format!("[receiver]\nposition = [5, 0, 0]\n{SQUARE}"), &[0.0], "reaches");
    refused(&format!("{RECEIVER}{SQUARE}"), &[], "no direction");
    refused(&format!("{RECEIVER}{SQUARE}"), &[120.0], "front");
    refused(&format!("{RECEIVER}{SQUARE}"), &[0.0, f64::NAN], "front");
    refused(RECEIVER, &[0.0], "no device");
    refused(&format!("[receiver]\nnormal = [-1, 0, 1]\n{SQUARE}"), &[0.0], "endless along z");
    let none = Sampling { rays: 0, ..FEW };
    let error = measured(&format!("{RECEIVER}{SQUARE}"), &[0.0], 0.0, none).expect_err("refused");
    assert!(error.to_string().contains("number of rays is 0"), "{error}");
    let text = format!(
        "{RECEIVER}{SQUARE}[[device]]\nkind = \"body\"\nposition = [0, 40, 0]\nshape = \"sphere\"\n"
    );
    refused(&text, &[0.0], "give it a `length`");
}
