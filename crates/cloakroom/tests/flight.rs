//! Light in flight: all of it is accounted for, it arrives when the maps of times say, and known
//! delays are seen.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::render::{
    Arrivals, ChannelSet, Delay, Flash, FlightCube, FlightSettings, FlightTile, Gate, PixelBins,
    PreparedScene, RenderError, Supervision, arrival_times, flight, render,
};
use cloakroom::scene::Scene;
use cloakroom::scene_file;
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

/// cm/ns.
const LIGHT: f64 = 29.979_245_8;

fn scene(text: &str) -> Scene {
    scene_file::parse(text, "test", Path::new("../.."), &[]).unwrap().scene
}

fn supervised<T>(work: impl FnOnce(&Supervision<'_>) -> T) -> T {
    work(&Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) })
}

fn settings(gate: &str, width: f64, delay: Delay) -> FlightSettings {
    let arrivals = Arrivals { delay, flash: Flash::Photograph };
    FlightSettings { gate: gate.parse().unwrap(), width, arrivals }
}

fn cube(scene: &Scene, settings: &FlightSettings) -> FlightCube {
    let prepared = PreparedScene::new(scene).unwrap();
    supervised(|supervision| FlightCube::new(&prepared, settings, supervision).unwrap().0)
}

/// Per pixel: when its power arrives in the mean, ns, and how much does.
fn moments(cube: &FlightCube) -> Vec<(f64, f64)> {
    let pixels = cube.size[0] * cube.size[1];
    let of_pixel = |pixel: usize| {
        let (mut sum, mut moment) = (0.0, 0.0);
        for (bin, middle) in cube.gate.middles().iter().enumerate() {
            let power = cube.power[bin * pixels + pixel];
            sum += power;
            moment += power * middle;
        }
        (moment / sum, sum)
    };
    (0..pixels).map(of_pixel).collect()
}

const SIZE: &str = "[camera]\nresolution = [70, 50]\n";

/// Scenes with birefringence, gradients, absorption, things that do not flash, polarizers, colors
/// and interference.
const SCENES: [&str; 8] = [
    "samples = 4\n[[device]]\nkind = 'square-cloak'\nmaterial = 'positive-uniaxial'\n",
    "samples = 2\npolarizer = 30\n[[device]]\nkind = 'square-cloak'\nmaterial = 'negative-uniaxial'\nrotation = 9\n",
    "samples = 2\n[[device]]\nkind = 'double-gaussian-cloak'\nrotation = 5\n",
    "samples = 3\nadaptive = 0.01\n[surroundings]\ncolor = [0.1, 0.3, 0.2]\n[photograph]\nwidth = 30\n[[device]]\nkind = 'body'\nshape = 'sphere'\nradius = 6\nindex = 1.5\nposition = [0, 3, 0]\n[[device]]\nkind = 'body'\nshape = 'box'\nsize = [4, 4, 4]\nsurface = { color = [0.6, 0.1, 0.1] }\nposition = [0, -8, 5]\n",
    "samples = 1\n[[device]]\nkind = 'body'\nshape = 'sphere'\nradius = 9\npermittivity = [2.25, 1e-6]\n",
    "samples = 2\n[light]\nspectrum = 'D65'\n[[device]]\nkind = 'body'\nshape = 'sphere'\nradius = 9\nmaterial = 'bk7'\n",
    "samples = 2\n[light]\nbandwidth_nm = 20\n[[device]]\nkind = 'body'\nshape = 'slab'\nthickness = 0.001\nindex = 1.5\n",
    "samples = 1\n",
];

/// A gate that leaves something before it and something after it.
const SHORT: &str = "5.0..5.3:0.01";

#[test]
fn all_light_is_before_in_or_after_the_bins_or_steady() {
    for text in SCENES {
        for (delay, width) in [(Delay::Group, 0.0), (Delay::Phase, 0.07)] {
            let scene = scene(&format!("{SIZE}{text}"));
            let prepared = PreparedScene::new(&scene).unwrap();
            let settings = settings(SHORT, width, delay);
            let parts: Mutex<Vec<FlightTile>> = Mutex::new(Vec::new());
            supervised(|supervision| {
                flight(&prepared, &settings, supervision, |tile| {
                    parts.lock().unwrap().push(tile);
                    Ok::<_, RenderError>(())
                })
                .unwrap()
            });
            let picture = supervised(|supervision| {
                render(&prepared, ChannelSet::Image, supervision).unwrap().picture
            });
            let (mut pixels, mut within, mut outside) = (0, 0.0, [0.0; 2]);
            for part in parts.into_inner().unwrap() {
                let bins = settings.gate.bins();
                for index in 0..part.steady.len() {
                    let column = part.tile.left as usize + index % part.tile.width as usize;
                    let row = part.tile.top as usize + index / part.tile.width as usize;
                    for (color, name) in ["R", "G", "B"].into_iter().enumerate() {
                        let PixelBins { first, light } = &part.bins[index];
                        assert!(first + light.len() <= bins || light.is_empty());
                        let in_bins: f64 = light.iter().map(|bin| bin[color]).sum();
                        let [before, after] = part.outside.each_ref().map(|all| all[index][color]);
                        let sum = in_bins
                            + before
                            + after
                            + part.untimed[index][color]
                            + part.steady[index][color];
                        let all = part.picture[index][color];
                        assert!((sum - all).abs() < 1e-12, "{text} {delay:?}: {sum} {all}");
                        if prepared.coherence.is_none() {
                            let seen =
                                picture.channel(name).unwrap().samples.get(row * 70 + column);
                            assert!(
                                (all - seen).abs() < 2e-6,
                                "{text} {column} {row}: {all} {seen}"
                            );
                        }
                        within += in_bins;
                        outside = [outside[0] + before, outside[1] + after];
                    }
                    pixels += 1;
                }
            }
            assert_eq!(pixels, 70 * 50);
            assert!(within > 100.0 && outside[1] > 1.0, "{text}: {within} {outside:?}");
        }
    }
}

#[test]
fn light_arrives_in_the_mean_when_the_maps_say() {
    // The branches that a picture through a polarizer follows are others where all channels are wanted.
    let scenes = SCENES[..5].iter().filter(|text| !text.contains("polarizer"));
    let scenes = scenes.map(|text| format!("{SIZE}{text}[picture]\nchannels = ['group_delay']\n"));
    for text in scenes {
        let scene = scene(&text);
        let prepared = PreparedScene::new(&scene).unwrap();
        let picture = supervised(|supervision| {
            render(&prepared, ChannelSet::Everything, supervision).unwrap().picture
        });
        for (delay, channel) in [(Delay::Group, "group_delay"), (Delay::Phase, "time_of_flight")] {
            for width in [0.0, 0.05] {
                let cube = cube(&scene, &settings("4.5..12:0.02", width, delay));
                let times = &picture.channel(channel).unwrap().samples;
                let mut compared = 0;
                for (pixel, (mean, power)) in moments(&cube).into_iter().enumerate() {
                    let delivered = picture.channel("delivered").unwrap().samples.get(pixel);
                    let [early, late, untimed] = [0, 1, 2].map(|i| cube.beside[i][pixel][3]);
                    let all = power + early + late + untimed;
                    assert!((all - delivered).abs() < 1e-6, "{text}: {all} {delivered}");
                    if power > 0.0 && early + late + untimed == 0.0 {
                        // Paths are interpolated, to 1e-6 cm, where a picture is; those of pulses are worked out to 1e-4 cm.
                        let off = (mean - times.get(pixel)).abs();
                        let exact = if delay == Delay::Group { 1e-4 } else { 1e-6 };
                        assert!(
                            off < exact / LIGHT,
                            "{text} {delay:?} {pixel}: {mean}, off by {off}"
                        );
                        compared += 1;
                    }
                }
                assert!(compared > 400, "{text} {compared}");
            }
        }
    }
}

#[test]
fn the_power_of_colored_light_is_that_of_its_rays() {
    // Through glass, beside it, and at its edges, where a pixel has rays of both.
    let device = "[camera]\nresolution = [50, 36]\nsamples = 4\n[picture]\nchannels = ['group_delay']\n\
        [[device]]\nkind = 'body'\nshape = 'box'\nsize = [5, 20, 20]\nrotation = 10\nmaterial = 'bk7'\n";
    for (spectrum, nm) in [
        ("590", Some(590.0)),
        ("650", Some(650.0)),
        ("'D65'", None),
        ("'E'", None),
        ("{ black_body_k = 2856 }", None),
        ("{ lines = [{ wavelength_nm = 436 }, { wavelength_nm = 546.1, power = 2 }] }", None),
    ] {
        let of_maps = nm.unwrap_or(550.0);
        let scene =
            scene(&format!("{device}[light]\nspectrum = {spectrum}\nwavelength_nm = {of_maps}\n"));
        let prepared = PreparedScene::new(&scene).unwrap();
        let picture = supervised(|supervision| {
            render(&prepared, ChannelSet::Everything, supervision).unwrap().picture
        });
        let [delivered, delay] =
            ["delivered", "group_delay"].map(|name| &picture.channel(name).unwrap().samples);
        let cube = cube(&scene, &settings("4.5..12:0.02", 0.0, Delay::Group));
        for (pixel, (mean, power)) in moments(&cube).into_iter().enumerate() {
            let all = power + cube.beside.iter().map(|beside| beside[pixel][3]).sum::<f64>();
            let exact = if nm.is_some() { 1e-6 } else { 4e-3 };
            let off = (all - delivered.get(pixel)).abs();
            assert!(off < exact, "{spectrum} {pixel}: {all}, off by {off}");
            if nm.is_some() && power == all {
                let off = (mean - delay.get(pixel)).abs();
                assert!(off < 1e-4 / LIGHT, "{spectrum} {pixel}: {mean}, off by {off}");
            }
        }
    }
}

/// One sample a pixel: each is one ray.
fn of_rays(device: &str) -> Scene {
    scene(&format!("[camera]\nresolution = [60, 44]\nsamples = 1\n{device}"))
}

#[test]
fn the_invisible_sphere_is_late_by_its_circumference_on_every_ray() {
    let device = "position = [-60, 0, 0]\n[[device]]\nkind = 'invisible-sphere'\n";
    let late = 2.0 * PI * 10.0 / LIGHT;
    for delay in [Delay::Phase, Delay::Group] {
        let settings = settings("3..7:0.01", 0.0, delay);
        let empty = moments(&cube(&of_rays("position = [-60, 0, 0]\n"), &settings));
        let (mut through, mut past) = (0, 0);
        for ((time, power), (straight, _)) in
            moments(&cube(&of_rays(device), &settings)).into_iter().zip(empty)
        {
            assert!((power - 1.0).abs() < 1e-9);
            if (time - straight).abs() < 1e-9 {
                past += 1;
            } else {
                assert!((time - straight - late).abs() < 1e-9, "{}", time - straight);
                through += 1;
            }
        }
        assert!(through > 300 && past > 300, "{through} {past}");
    }
}

#[test]
fn the_film_of_a_perfect_cloak_is_that_of_nothing_but_for_pulses() {
    let device = "[[device]]\nkind = 'square-cloak'\n";
    let phase = settings("4.9..5.9:0.005", 0.0, Delay::Phase);
    let (cloak, empty) = (of_rays(device), of_rays(""));
    let [seen, nothing] = [&cloak, &empty].map(|scene| cube(scene, &phase));
    let mut brightest: f64 = 0.0;
    for (one, other) in seen.light.as_flattened().iter().zip(nothing.light.as_flattened()) {
        assert!((one - other).abs() < 1e-9, "{one} {other}");
        brightest = brightest.max(*one);
    }
    assert!(brightest > 0.3);
    // In the middle of a picture of an odd number of pixels, on the axis.
    let pulse = |device: &str| {
        let text = format!(
            "[camera]\nresolution = [41, 41]\nsamples = 1\nfield_of_view = 0.001\n{device}"
        );
        let settings = settings("4.9..7.9:0.005", 0.0, Delay::Group);
        moments(&cube(&scene(&text), &settings))[20 * 41 + 20].0
    };
    let late = pulse(device) - pulse("");
    assert!((late - 1.4514).abs() < 1e-4, "{late}");
}

#[test]
fn a_centimeter_of_calcite_parts_a_pulse_by_6_453_picoseconds() {
    for (delay, expected) in [(Delay::Group, 6.453), (Delay::Phase, 5.744)] {
        let time = |polarizer: &str| {
            let text = format!(
                "[camera]\nresolution = [3, 3]\nsamples = 1\nfield_of_view = 0.001\npolarizer = '{polarizer}'\n\
                 [light]\nspectrum = 590\n[[device]]\nkind = 'body'\nshape = 'slab'\nthickness = 1\n\
                 material = 'calcite'\noptic_axis = [0, 1, 0]\n"
            );
            // Light that has gone to and fro in the slab comes later than this gate.
            moments(&cube(&scene(&text), &settings("5.0..5.06:0.0005", 0.0, delay)))[4].0
        };
        let split = (time("horizontal") - time("vertical")).abs() * 1e3;
        assert!((split - expected).abs() < 1e-3, "{split}");
    }
}

/// The mirror image of the photograph is as far behind the mirror as it is before it.
#[test]
fn a_mirror_makes_the_way_longer_as_its_image_says() {
    let text = "[camera]\nresolution = [30, 22]\nsamples = 1\nposition = [-40, 0, 0]\ntarget = [0, 0, 0]\nfield_of_view = 20\n\
        [photograph]\nposition = [0, 50, 0]\nnormal = [0, -1, 0]\nup = [1, 0, 0]\nwidth = 60\n\
        [[device]]\nkind = 'mirror'\nrotation = 135\nwidth = 40\nheight = 40\n";
    let scene = scene(text);
    let cube = cube(&scene, &settings("2.9..3.4:0.003", 0.0, Delay::Group));
    let mut seen = 0;
    for (pixel, (mean, power)) in moments(&cube).into_iter().enumerate() {
        let ray = scene.camera.ray((pixel % 30) as f64 + 0.5, (pixel / 30) as f64 + 0.5);
        // The image of the plane y = 50 in the mirror x = y is the plane x = 50.
        let path = 90.0 / ray.direction.x;
        if power > 0.0 {
            assert!((power - 1.0).abs() < 1e-12);
            assert!((mean - path / LIGHT).abs() < 1e-12, "{mean} {}", path / LIGHT);
            seen += 1;
        }
    }
    assert_eq!(seen, 30 * 22);
}

#[test]
fn what_flashes_is_seen_when_its_light_comes() {
    let scene = scene("[camera]\nresolution = [24, 18]\nsamples = 1\n");
    let of = |flash: Flash| {
        let gate: Gate = "0..20:0.01".parse().unwrap();
        let arrivals = Arrivals { delay: Delay::Group, flash };
        cube(&scene, &FlightSettings { gate, width: 0.0, arrivals })
    };
    let straight = |pixel: usize| {
        let ray = scene.camera.ray((pixel % 24) as f64 + 0.5, (pixel / 24) as f64 + 0.5);
        let point = ray.origin + ray.direction * (150.0 / ray.direction.x);
        (point, point.distance(ray.origin) / LIGHT)
    };
    let source = DVec3::new(50.0, 0.0, 30.0);
    let plane = DVec3::new(0.0, 3.0, 4.0);
    let point = moments(&of(Flash::Point(source)));
    let wave = moments(&of(Flash::PlaneWave(plane)));
    let of_spot = of(Flash::Spot { middle: DVec3::new(20.0, 5.0, 5.0), radius: 2.0 });
    let (spot, all) = (moments(&of_spot), of(Flash::Photograph).picture);
    for pixel in 0..24 * 18 {
        let (place, time) = straight(pixel);
        assert!((point[pixel].0 - time - place.distance(source) / LIGHT).abs() < 1e-12);
        assert!((wave[pixel].0 - time - place.dot(plane / 5.0) / LIGHT).abs() < 1e-12);
        let off = (place - DVec3::new(50.0, 5.0, 5.0)).length_squared() / 4.0;
        assert!((spot[pixel].1 - 0.5_f64.powf(off)).abs() < 1e-12);
        let lit = all[pixel].map(|light| light * 0.5_f64.powf(off));
        for (lit, found) in lit.into_iter().zip(of_spot.picture[pixel]) {
            assert!((lit - found).abs() < 1e-12, "{pixel}: {lit} {found}");
        }
    }
}

#[test]
fn the_range_of_times_holds_nearly_all_light() {
    for text in [SCENES[0], SCENES[2], SCENES[7]] {
        let scene = scene(&format!("{SIZE}{text}"));
        let prepared = PreparedScene::new(&scene).unwrap();
        let arrivals = Arrivals::default();
        let range = arrival_times(&prepared, &arrivals).unwrap();
        let gate = Gate::around(range, 100);
        let cube = cube(&scene, &FlightSettings { gate, width: 0.0, arrivals });
        let within: f64 = cube.power.iter().sum();
        let beside: f64 = cube.beside.iter().flatten().map(|light| light[3]).sum();
        assert!(beside < 2e-3 * within, "{text}: {within} {beside}");
    }
}

#[test]
fn light_that_is_caught_for_long_does_not_stretch_the_range_of_times() {
    let text = "[camera]\nresolution = [40, 30]\nposition = [-70, 60, 0]\ntarget = [0, 4, 0]\n\
        [[device]]\nkind = 'body'\nshape = 'box'\nsize = [70, 40, 60]\nposition = [0, 20, 0]\nindex = 1.5\n\
        [[device]]\nkind = 'mirror'\nrotation = 90\nposition = [0, -0.1, 0]\nwidth = 70\nheight = 60\n";
    let scene = scene(text);
    let prepared = PreparedScene::new(&scene).unwrap();
    let [first, last] = arrival_times(&prepared, &Arrivals::default()).unwrap();
    // A few ways to and fro through the glass, not hundreds.
    assert!(first > 3.0 && last < 60.0, "{first} {last}");
}

/// Depths by the first and by the strongest pulse, cm.
fn depths(text: &str) -> (Scene, [Vec<f64>; 2]) {
    let scene = scene(&format!("{text}\n[picture]\nchannels = ['pulse_depth']\n"));
    let prepared = PreparedScene::new(&scene).unwrap();
    let picture = supervised(|supervision| {
        render(&prepared, ChannelSet::Everything, supervision).unwrap().picture
    });
    let depths = ["first_pulse_depth", "strongest_pulse_depth"].map(|name| {
        let samples = &picture.channel(name).unwrap().samples;
        (0..samples.len()).map(|pixel| samples.get(pixel)).collect()
    });
    (scene, depths)
}

#[test]
fn a_lidar_finds_the_invisible_sphere_and_what_stands_before_the_photograph() {
    let text = "[camera]\nresolution = [40, 30]\nsamples = 1\nposition = [-60, 0, 0]\n[photograph]\nwidth = 40\n\
        [[device]]\nkind = 'invisible-sphere'\n[[device]]\nkind = 'body'\nshape = 'box'\nsize = [2, 2, 40]\n\
        surface = { color = [1, 0, 0] }\nposition = [20, -14, 0]\n";
    let (scene, [first, strongest]) = depths(text);
    let mut found = [0; 4];
    for pixel in 0..40 * 30 {
        let ray = scene.camera.ray((pixel % 40) as f64 + 0.5, (pixel / 40) as f64 + 0.5);
        let straight = 110.0 / ray.direction.x;
        let depth = strongest[pixel];
        assert!(depth == first[pixel] || depth.is_nan() && first[pixel].is_nan());
        let late = depth - straight;
        let kind = if depth.is_nan() {
            0
        } else if late.abs() < 1e-9 {
            1
        } else if (late - 20.0 * PI).abs() < 1e-8 {
            2
        } else {
            // On the front or the top of the box.
            let point = ray.origin + ray.direction * depth;
            assert!((point.x - 19.0).abs() < 1e-9 || (point.y + 13.0).abs() < 1e-9, "{point}");
            3
        };
        found[kind] += 1;
    }
    assert!(found.iter().all(|count| *count > 10), "{found:?}");
}

#[test]
fn the_first_pulse_through_calcite_is_not_the_strongest() {
    // 30 degrees from horizontal: three quarters of the light take the one way, a quarter the other.
    let text = |angle: f64| {
        format!(
            "[camera]\nresolution = [3, 3]\nsamples = 1\nfield_of_view = 0.001\npolarizer = {angle:?}\n\
             [light]\nspectrum = 590\n[[device]]\nkind = 'body'\nshape = 'slab'\nthickness = 1\n\
             material = 'calcite'\noptic_axis = [0, 1, 0]\n"
        )
    };
    let split = 6.453e-3 * LIGHT;
    for (angle, apart) in [(30.0, true), (60.0, false)] {
        let (_, [first, strongest]) = depths(&text(angle));
        let late = strongest[4] - first[4];
        // The extraordinary wave, whose field is vertical, is the faster one.
        let expected = if apart { split } else { 0.0 };
        assert!((late - expected).abs() < 1e-4, "{angle}: {late}");
    }
}
