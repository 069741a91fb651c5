//! The pulses of a pixel against the picture's channels.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::render::{ChannelSet, PreparedScene, PulseList, Supervision, pulses, render};
use cloakroom::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const SIZE: [u32; 2] = [12, 9];

fn text(device: &str, polarizer: &str) -> String {
    format!(
        "[camera]\nresolution = [{}, {}]\nsamples = 1\npolarizer = {polarizer}\n{device}",
        SIZE[0], SIZE[1]
    )
}

#[test]
fn lists_of_pulses_are_what_the_channels_sum_up() {
    let devices = [
        ("[[device]]\nkind = \"square-cloak\"\nmaterial = \"positive-uniaxial\"\n", true),
        (
            "[[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\nrotation = 9\n",
            true,
        ),
        ("[[device]]\nkind = \"double-gaussian-cloak\"\n", false),
        ("", false),
    ];
    for (device, birefringent) in devices {
        for polarizer in ["\"none\"", "30"] {
            let loaded =
                scene_file::parse(&text(device, polarizer), "test", Path::new(""), &[]).unwrap();
            let prepared = PreparedScene::new(&loaded.scene).unwrap();
            let stop = AtomicBool::new(false);
            let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
            let picture = render(&prepared, ChannelSet::Everything, &supervision).unwrap().picture;
            let mut most = 0;
            for row in 0..SIZE[1] {
                for column in 0..SIZE[0] {
                    let list = pulses(&prepared, [column, row]).unwrap();
                    let index = (row * SIZE[0] + column) as usize;
                    let channel = |name: &str| picture.channel(name).unwrap().samples.get(index);
                    compare(&list, channel);
                    most = most.max(list.pulses.len());
                }
            }
            assert_eq!(most > 3, birefringent, "{device}{polarizer}: {most} pulses");
        }
    }
}

fn compare(list: &PulseList, channel: impl Fn(&str) -> f64) {
    let power: f64 = list.pulses.iter().map(|pulse| pulse.power).sum();
    assert!((power + list.escaped + list.absorbed + list.pruned - 1.0).abs() < 1e-10, "{list:?}");
    // Shares are kept in single precision.
    for (name, share) in [
        ("delivered", power),
        ("escaped", list.escaped),
        ("absorbed", list.absorbed),
        ("pruned", list.pruned),
    ] {
        assert!((channel(name) - share).abs() < 1e-6, "{name}: {list:?}");
    }
    let expected = channel("time_of_flight");
    if list.pulses.is_empty() {
        assert!(expected.is_nan() && list.mean_time_of_flight_ns.is_none());
        return;
    }
    // Anew, from the list itself; merging moves no mean, and a spread by less than the resolution.
    let mean = list.pulses.iter().map(|p| p.time_of_flight_ns * p.power).sum::<f64>() / power;
    let variance =
        list.pulses.iter().map(|p| (p.time_of_flight_ns - mean).powi(2) * p.power).sum::<f64>()
            / power;
    assert!((mean - expected).abs() < 1e-13, "{mean} {expected}");
    assert_eq!(list.mean_time_of_flight_ns, Some(expected));
    let spread = channel("time_of_flight_spread");
    assert!((variance.sqrt() - spread).abs() <= list.resolution_ns, "{spread} {list:?}");
    assert_eq!(list.time_of_flight_spread_ns, Some(spread));
    for pair in list.pulses.windows(2) {
        assert!(pair[1].time_of_flight_ns - pair[0].time_of_flight_ns > 0.0);
    }
    for pulse in &list.pulses {
        let landed: f64 = pulse.landings.iter().map(|landing| landing.power).sum();
        assert!((landed - pulse.power).abs() < 1e-14);
        assert!(pulse.landings.iter().all(|l| (l.position_cm[0] - 50.0).abs() < 1e-9));
        let delay = pulse.time_of_flight_ns - list.empty_time_of_flight_ns.unwrap();
        assert!((pulse.delay_ns.unwrap() - delay).abs() < 1e-14);
    }
    let difference = list.pulses.iter().map(|p| p.delay_ns.unwrap() * p.power).sum::<f64>() / power;
    assert!((difference - channel("time_of_flight_difference")).abs() < 1e-13);
}

#[test]
fn the_empty_view_has_one_pulse_on_time() {
    let loaded = scene_file::parse(&text("", "\"none\""), "test", Path::new(""), &[]).unwrap();
    let prepared = PreparedScene::new(&loaded.scene).unwrap();
    let list = pulses(&prepared, [3, 4]).unwrap();
    let [pulse] = list.pulses.as_slice() else { panic!("{list:?}") };
    assert_eq!((pulse.power, pulse.delay_ns), (1.0, Some(0.0)));
    let landing = glam::DVec3::from_array(pulse.landings[0].position_cm);
    let distance = landing.distance(glam::DVec3::new(-100.0, 0.0, 0.0));
    assert!((pulse.time_of_flight_ns - distance / 29.979_245_8).abs() < 1e-14);
    let error = pulses(&prepared, [12, 0]).unwrap_err().to_string();
    assert_eq!(error, "there is no pixel 12,0; the picture has columns 0 to 11 and rows 0 to 8");
}

/// In a thick block parts of a beam come to other places, or to an edge: what one ray has of them
/// does not close.
#[test]
fn powers_of_a_ray_add_up_in_light_of_one_wavelength() {
    for device in [
        "shape = \"box\"\npermittivity = 9",
        "shape = \"box\"\npermittivity = 2.25\nrotation = 10",
        "permittivity = 4\nrotation = 20",
        "permittivity = 4",
        "thickness = 2e-5\npermittivity = 4\nrotation = 20",
        "thickness = 2e-5\npermittivity = [4, 0.01]",
    ] {
        let text = format!(
            "[camera]\nresolution = [16, 12]\nsamples = 1\n[light]\nbandwidth_nm = 0\n[[device]]\nkind = \"body\"\n{device}\n"
        );
        let scene = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap().scene;
        let prepared = PreparedScene::new(&scene).unwrap();
        for pixel in (0..16).flat_map(|x| (0..12).map(move |y| [x, y])) {
            let list = pulses(&prepared, pixel).unwrap();
            let shares = [list.delivered, list.escaped, list.absorbed, list.pruned];
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{device} {shares:?}");
            assert!(shares.iter().all(|share| *share > -1e-6), "{device} {shares:?}");
            assert!(list.pruned < 1e-3, "{device} {shares:?}");
            assert!(list.delivered.is_sign_positive());
        }
    }
}
