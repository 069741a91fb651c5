//! The commands at work: what they print and write.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long;
use crate::running::{cloakroom, json, paper, stdout};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Renders a panel of the paper at a small size into a PNG and returns its pixels.
fn pixels(folder: &Path, panel: &str, more: &[&str]) -> image::RgbImage {
    let out = folder.join("out.png");
    let mut command = cloakroom();
    command.arg("render").arg(paper(panel)).arg("-o").arg(&out);
    command.args(["--set", "camera.resolution=[320, 240]", "--set", "camera.samples=2"]);
    for change in more {
        command.args(["--set", change]);
    }
    command.assert().success().stdout("").stderr("");
    image::open(&out).unwrap().into_rgb8()
}

/// The largest difference of two pictures and the share of pixels that differ at all.
fn difference(a: &image::RgbImage, b: &image::RgbImage) -> (u8, f64) {
    let differences: Vec<u8> = a
        .pixels()
        .zip(b.pixels())
        .map(|(a, b)| (0..3).map(|i| a.0[i].abs_diff(b.0[i])).max().unwrap())
        .collect();
    let differing = differences.iter().filter(|d| **d > 0).count();
    (*differences.iter().max().unwrap(), differing as f64 / differences.len() as f64)
}

#[test]
fn the_cloaked_view_is_the_empty_view() {
    let folder = tempfile::tempdir().unwrap();
    let empty = pixels(folder.path(), "6a", &[]);
    let cloaked = pixels(folder.path(), "6c", &[]);
    let (largest, share) = difference(&empty, &cloaked);
    assert!(largest <= 1 && share <= 1e-4, "{largest} {share}");
    // The bare metal is far from invisible.
    let (_, share) = difference(&empty, &pixels(folder.path(), "6b", &[]));
    assert!(share > 0.1, "{share}");
}

#[test]
fn the_turned_cloak_is_a_flat_mirror() {
    let folder = tempfile::tempdir().unwrap();
    for panel in ["7b", "7d", "7f"] {
        let cloaked = pixels(folder.path(), panel, &[]);
        let mirror = pixels(folder.path(), panel, &["device.0.show=mirror"]);
        let (largest, share) = difference(&cloaked, &mirror);
        assert!(largest <= 1 && share <= 1e-4, "{panel}: {largest} {share}");
    }
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    let render = |threads: &str, name: &str| {
        let out = folder.path().join(name);
        cloakroom()
            .arg("render")
            .arg(paper("9d"))
            .args(["--set", "camera.resolution=[131, 97]", "--threads", threads, "-o"])
            .arg(&out)
            .assert()
            .success();
        fs::read(out).unwrap()
    };
    for ending in ["png", "exr", "npz"] {
        let one = render("1", &format!("one.{ending}"));
        let three = render("3", &format!("three.{ending}"));
        assert!(one == three, "{ending} differs");
    }
}

#[test]
fn a_large_image_in_strips_is_the_whole_image() {
    let folder = tempfile::tempdir().unwrap();
    let render = |names: &[&str]| {
        let mut command = cloakroom();
        command.arg("render").arg(paper(long::count("6a", "7d")));
        // More pixels than a strip has.
        command.args(["--set", "camera.resolution=[4200, 1001]", "--set", "camera.samples=1"]);
        for name in names {
            command.arg("-o").arg(folder.path().join(name));
        }
        command.assert().success();
        image::open(folder.path().join(names[0])).unwrap().into_rgb8()
    };
    assert!(render(&["strips.png"]) == render(&["whole.png", "again.png"]));
}

#[test]
fn rays_are_traced() {
    let rays = r#"[
        {"origin": [-100, 3, 1], "direction": [1, 0, 0]},
        {"origin": [-100, 30, 0], "direction": [1, 0, 0], "polarization": "vertical"},
        {"origin": [-100, 1, 0], "direction": [2, 0.01, 0.1],
         "polarization": {"electric_field": [[0.05, 0], [0, 0], [-1, 0]]}}]"#;
    let mut command = cloakroom();
    command.arg("trace").arg(paper("6c")).args(["--rays", "-"]).write_stdin(rays);
    let reports = json(&stdout(&mut command));
    let leaf = &reports[0]["leaves"][0];
    assert!((leaf["power"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!((leaf["direction"][0].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!((leaf["position"][1].as_f64().unwrap() - 3.0).abs() < 1e-12);
    let x = leaf["position"][0].as_f64().unwrap();
    assert!((leaf["optical_path"].as_f64().unwrap() - (100.0 + x)).abs() < 1e-11);
    assert_eq!(leaf["electric_field"][2].as_array().unwrap().len(), 2);
    let missed = &reports[1]["leaves"][0];
    assert!(missed["position"].is_null());
    assert_eq!(missed["optical_path"].as_f64(), Some(0.0));
    assert_eq!(missed["electric_field"][1][0].as_f64().map(f64::abs), Some(1.0));
    for report in reports.as_array().unwrap() {
        let leaves = report["leaves"].as_array().unwrap();
        let sum: f64 = leaves.iter().map(|leaf| leaf["power"].as_f64().unwrap()).sum();
        let rest = report["absorbed"].as_f64().unwrap() + report["pruned"].as_f64().unwrap();
        assert!((sum + rest - 1.0).abs() < 1e-12);
    }
}

#[test]
fn bad_rays_are_refused() {
    for (rays, part) in [
        (r#"[{"origin": [0, 0, 0], "direction": [1, 0, 0]}]"#, "inside device 0"),
        (r#"[{"origin": [-50, 0, 0], "direction": [0, 0, 0]}]"#, "direction is zero"),
        (r#"[{"origin": [-50, 0], "direction": [0, 0, 0]}]"#, "line 1"),
        ("nonsense", "line 1"),
    ] {
        let mut command = cloakroom();
        command.arg("trace").arg(paper("6c")).args(["--rays", "-"]).write_stdin(rays);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(output.stdout.is_empty());
        assert!(String::from_utf8(output.stderr).unwrap().contains(part), "{part}");
    }
}

#[test]
fn the_catalogue_has_the_papers_numbers() {
    let catalogue = json(&stdout(cloakroom().args(["devices", "--json"])));
    let devices = catalogue["devices"].as_array().unwrap();
    let find = |kind: &str| devices.iter().find(|device| device["kind"] == kind).unwrap();
    let number = |device: &Value, name: &str| device[name].as_f64().unwrap();
    let gaussian = find("double-gaussian-cloak");
    assert!((number(gaussian, "index_min") - 0.873).abs() < 5e-4);
    assert!((number(gaussian, "index_max") - 1.918).abs() < 5e-4);
    assert!((number(gaussian, "cloaked_area_cm2") - 114.83).abs() < 5e-3);
    let square = find("square-cloak");
    assert!((number(square, "cloaked_area_cm2") - 114.78).abs() < 5e-3);
    assert!((number(square, "mirror_width_cm") - 19.94).abs() < 5e-3);
    let text = String::from_utf8(stdout(cloakroom().arg("devices"))).unwrap();
    for device in devices {
        assert!(text.contains(device["kind"].as_str().unwrap()));
    }
}

#[test]
fn pulses_of_a_pixel_are_listed() {
    let mut command = cloakroom();
    command.arg("pulses").arg(paper("2c")).args(["--pixel", "300,300", "--json"]);
    let list = json(&stdout(&mut command));
    let pulses = list["pulses"].as_array().unwrap();
    assert!(pulses.len() > 3);
    let number = |value: &Value, name: &str| value[name].as_f64().unwrap();
    let sum: f64 = pulses.iter().map(|pulse| number(pulse, "power")).sum();
    let rest: f64 = ["escaped", "absorbed", "pruned"].map(|name| number(&list, name)).iter().sum();
    assert!((sum + rest - 1.0).abs() < 1e-10);
    for pulse in pulses {
        let empty = number(&list, "empty_time_of_flight_ns");
        let delay = number(pulse, "time_of_flight_ns") - empty;
        assert!((number(pulse, "delay_ns") - delay).abs() < 1e-13);
        assert_eq!(pulse["landings"][0]["position_cm"][0].as_f64(), Some(50.0));
    }
    // For people: the same pulses, a line each.
    let mut command = cloakroom();
    let text = stdout(command.arg("pulses").arg(paper("2c")).args(["--pixel", "300,300"]));
    let text = String::from_utf8(text).unwrap();
    assert_eq!(
        text.lines().filter(|line| line.contains('(') && line.ends_with(')')).count(),
        pulses.len()
    );
    let outside = cloakroom().arg("pulses").arg(paper("2c")).args(["--pixel", "1024,0"]).output();
    assert_eq!(outside.unwrap().status.code(), Some(2));
}

#[test]
fn optional_channels_are_written_when_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let render = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let mut command = cloakroom();
        command.arg("render").arg(paper("2c")).arg("-o").arg(&out).args(more);
        command.args(["--set", "camera.resolution=[16, 12]", "--set", "camera.samples=1"]);
        (command.output().unwrap().status.code(), out)
    };
    let size = |path: &Path| fs::metadata(path).unwrap().len();
    let (code, plain) = render("plain.npz", &[]);
    assert_eq!(code, Some(0));
    let (code, more) = render("more.npz", &["--channels", "stokes,first_face_reflectance"]);
    assert_eq!(code, Some(0));
    // Four Stokes images of three floats a pixel and one of one, and their headers.
    let grown = size(&more) - size(&plain);
    assert!(grown > 16 * 12 * 52 && grown < 16 * 12 * 52 + 3000, "{grown}");
    assert_eq!(render("a.npz", &["--set", "picture.channels=[\"stokes\"]"]).0, Some(0));
    // A PNG holds none, but shows a scalar one as a map.
    assert_eq!(render("a.png", &["--channels", "stokes"]).0, Some(2));
    let map = ["--set", "picture.map=extraordinary_share"];
    assert_eq!(render("b.png", &map).0, Some(0));
}

#[test]
fn what_is_not_followed_and_what_takes_far_longer_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("pane.toml");
    let pane = |keys: &str| {
        let body = "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [5, 20, 20]\n";
        let camera = "[camera]\nresolution = [32, 24]\nsamples = 1\n";
        fs::write(&scene, format!("{camera}{body}{keys}")).unwrap();
    };
    let render = |min_power: &str| {
        let mut command = cloakroom();
        command.arg("render").arg(&scene).arg("-o").arg(folder.path().join("pane.png"));
        let ran = command.args(["--set", min_power]).assert().success();
        String::from_utf8(ran.get_output().stderr.clone()).unwrap()
    };
    pane("index = 1.5");
    assert_eq!(render("trace.min_power=1e-6"), "");
    // Each face reflects 4 %.
    let told = render("trace.min_power=0.1");
    assert!(told.contains("up to 8 % is in branches too weak to follow"), "{told}");
    let checked = || String::from_utf8(stdout(cloakroom().arg("check").arg(&scene))).unwrap();
    assert!(!checked().contains("interferes"));
    pane("uniaxial = { ordinary = 1.5, extraordinary = 1.500001 }\n[trace]\nmin_power = 1e-3");
    let text = checked();
    assert!(text.contains("interferes, because of device 0 (a polarizer, thin"), "{text}");
    pane("index = 1.5\n[light]\nbandwidth_nm = 20\n[trace]\nmin_power = 1e-3");
    let text = checked();
    assert!(text.contains("interferes, because light.bandwidth_nm is written"), "{text}");
    assert!(text.contains("down to 1e-3 of its power"), "{text}");
}

#[test]
fn scenes_are_checked() {
    let text = String::from_utf8(stdout(cloakroom().arg("check").arg(paper("8c")))).unwrap();
    for part in ["1024 x 768", "double-gaussian-cloak", "index_max", "estimate"] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}

/// Calcite with its optic axis along (0, 0.6, 0.8), typed in ten digits, is no general medium.
#[test]
fn media_are_named_for_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let (ordinary, extraordinary) = (2.749_407_3, 2.207_693_2);
    let [across, along, mixed] = [0.36, 0.64, 0.48].map(|share| share * (extraordinary - ordinary));
    let [across, along] = [across, along].map(|change| ordinary + change);
    for (off, class) in [(0.0, "1 uniaxial"), (1e-3, "1 biaxial")] {
        let text = format!(
            "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 2\n\
             permittivity = [[{}, 0, 0], [0, {across:.10}, {mixed:.10}], [0, {mixed:.10}, {along:.10}]]\n",
            ordinary + off
        );
        fs::write(&scene, text).unwrap();
        let text = String::from_utf8(stdout(cloakroom().arg("check").arg(&scene))).unwrap();
        assert!(text.contains(class), "{text}");
    }
    let text = String::from_utf8(stdout(cloakroom().arg("devices"))).unwrap();
    assert!(text.contains("4 impedance matched"), "{text}");
}

#[test]
fn films_made_of_bodies_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("film.toml");
    for (thickness, warned) in [("20e-6", true), ("5.4e-4", true), ("5.6e-4", false), ("5", false)]
    {
        let slab = format!("shape = \"slab\"\nthickness = {thickness}\npermittivity = 2");
        let prism = format!(
            "[[device]]\nkind = \"prisms\"\n[[device.prism]]\npermittivity = 2\n\
             corners = [[-20, 0], [-20, {thickness}], [-30, {thickness}], [-30, 0]]\n"
        );
        let text = format!("[[device]]\nkind = \"body\"\n{slab}\n{prism}");
        fs::write(&scene, text).unwrap();
        let text = String::from_utf8(stdout(cloakroom().arg("check").arg(&scene))).unwrap();
        for device in ["device 0 is", "device 1 is"] {
            assert_eq!(text.contains(device), warned, "{text}");
        }
        assert_eq!(text.contains("make it a `coating`"), warned, "{text}");
    }
    // A coating is no body, nor are the sheets of mirrors and polarizers.
    let text = "[[device]]\nkind = \"body\"\ncoating = [{ index = [0.06, 3.6], thickness_nm = 20 }]\n\
                [[device]]\nkind = \"polarizer\"\nposition = [-20, 0, 0]\n\
                [[device]]\nkind = \"mirror-detour\"\nposition = [-60, 0, 0]\n";
    fs::write(&scene, text).unwrap();
    let text = String::from_utf8(stdout(cloakroom().arg("check").arg(&scene))).unwrap();
    assert!(!text.contains("warning"), "{text}");
}

#[test]
fn the_schema_knows_every_device() {
    let schema = stdout(cloakroom().arg("schema"));
    let text = String::from_utf8(schema).unwrap();
    for part in ["square-cloak", "double-gaussian-cloak", "field_of_view", "min_power"] {
        assert!(text.contains(part), "{part}");
    }
    assert!(json(text.as_bytes()).is_object());
}

#[test]
fn figures_come_as_panels_and_sheets() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("figures");
    cloakroom()
        .args(["figures", "--only", "6,8d", "--size", "96x72", "--samples", "1", "--out"])
        .arg(&out)
        .assert()
        .success();
    for name in ["fig6a", "fig6b", "fig6c", "fig6d", "fig8d"] {
        let panel = image::open(out.join(format!("{name}.png"))).unwrap();
        assert_eq!((panel.width(), panel.height()), (96, 72), "{name}");
    }
    // What is drawn is lines, too; a picture is not.
    for name in ["fig6.png", "fig6.svg", "fig6.pdf", "fig6d.svg", "fig6d.pdf", "fig8d.svg"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    assert!(!out.join("fig6a.svg").exists() && !out.join("fig8.png").exists());
}

#[test]
fn panels_that_share_their_rays_are_those_made_alone() {
    let folder = tempfile::tempdir().unwrap();
    let make = |only: &str| {
        let mut command = cloakroom();
        command.args(["figures", "--only", only, "--size", "96x72", "--samples", "2", "--out"]);
        command.arg(folder.path().join(only)).assert().success();
        folder.path().join(only)
    };
    let together = make("2c,2d,2e,4c,4d,4e,8c,8d");
    for panel in ["2c", "2d", "2e", "4c", "4d", "4e", "8c", "8d"] {
        let name = format!("fig{panel}.png");
        let alone = fs::read(make(panel).join(&name)).unwrap();
        assert!(fs::read(together.join(&name)).unwrap() == alone, "{panel}");
    }
}

#[test]
fn the_gallery_has_a_picture_and_a_map_of_each_exhibit() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gallery");
    let gallery = |only: &str| {
        let mut command = cloakroom();
        command.args(["gallery", "--only", only, "--size", "64x48", "--samples", "1", "--out"]);
        command.arg(&out);
        command
    };
    gallery("eaton-lens,square-cloak").assert().success().stdout("");
    let mut names: Vec<String> = fs::read_dir(&out)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected = [
        "eaton-lens-time-of-flight.pdf",
        "eaton-lens-time-of-flight.png",
        "eaton-lens-time-of-flight.svg",
        "eaton-lens.png",
        "square-cloak-time-of-flight.pdf",
        "square-cloak-time-of-flight.png",
        "square-cloak-time-of-flight.svg",
        "square-cloak.png",
    ];
    assert_eq!(names, expected);
    for name in ["eaton-lens.png", "square-cloak.png"] {
        let picture = image::open(out.join(name)).unwrap();
        assert_eq!((picture.width(), picture.height()), (64, 48), "{name}");
    }
    // With a colour bar beside it.
    assert!(image::open(out.join("eaton-lens-time-of-flight.png")).unwrap().width() > 80);
    let output = gallery("eaton-lense").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = "error: there is no exhibit `eaton-lense`; did you mean `eaton-lens`?\n";
    assert_eq!(String::from_utf8(output.stderr).unwrap(), message);
}

#[test]
fn the_table_of_the_gallery_is_made_with_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = cloakroom();
    command.args(["gallery", "--size", "16x12", "--samples", "1", "--out"]).arg(folder.path());
    command.assert().success();
    let table = image::open(folder.path().join("gallery.png")).unwrap();
    assert!(table.width() > 1000 && table.height() > 1000);
    assert!(["svg", "pdf"].iter().all(|e| folder.path().join(format!("gallery.{e}")).is_file()));
}

#[test]
fn the_setting_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let red = folder.path().join("red.png");
    image::RgbImage::from_pixel(8, 6, image::Rgb([255, 0, 0])).save(&red).unwrap();
    let figures = |out: &str, more: &[&str]| {
        let out = folder.path().join(out);
        let mut command = cloakroom();
        command.args(["figures", "--only", "1", "--size", "200x150", "--out"]).arg(&out);
        command.args(more).assert().success();
        out
    };
    let plain = figures("plain", &[]);
    for (panel, label) in [("fig1a", "11.51 cm"), ("fig1b", "57.14 cm")] {
        let image = image::open(plain.join(format!("{panel}.png"))).unwrap();
        assert_eq!((image.width(), image.height()), (200, 150));
        let svg = fs::read_to_string(plain.join(format!("{panel}.svg"))).unwrap();
        assert!(svg.contains(&format!("aria-label=\"{label}\"")) && svg.contains("[[device]]"));
    }
    for name in ["fig1.png", "fig1.svg", "fig1.pdf", "fig1a.pdf"] {
        assert!(plain.join(name).is_file(), "{name}");
    }
    // The photograph in the drawing is the one that is looked at.
    let other = figures("other", &["--photo", red.to_str().unwrap()]);
    let reds = |folder: &Path| {
        let image = image::open(folder.join("fig1b.png")).unwrap().into_rgb8();
        image.pixels().filter(|pixel| pixel.0 == [255, 0, 0]).count()
    };
    assert_eq!(reds(&plain), 0);
    assert!(reds(&other) > 100);
}

#[test]
fn a_map_has_a_colour_bar() {
    let folder = tempfile::tempdir().unwrap();
    let map = pixels(folder.path(), "8d", &[]);
    // The map in a frame, the bar to its right.
    assert!(map.width() > 360 && map.height() >= 240);
    let plain = pixels(folder.path(), "8d", &["picture.color_bar=false"]);
    assert_eq!(plain.dimensions(), (320, 240));
}

#[test]
fn a_map_is_drawn_for_print() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["a.svg", "a.pdf"].map(|name| folder.path().join(name));
    let render = |more: &[&str]| {
        let mut command = cloakroom();
        command.arg("render").arg(paper("6c")).args(["--set", "camera.resolution=[32,24]"]);
        command.args(["--set", "camera.samples=1"]).args(more);
        files.iter().for_each(|file| _ = command.arg("-o").arg(file));
        command.assert()
    };
    let refused = render(&[]).failure().get_output().stderr.clone();
    assert!(String::from_utf8(refused).unwrap().contains("a.svg would be a map"));
    render(&["--set", "picture.map=delivered"]).success();
    assert!(fs::read_to_string(&files[0]).unwrap().contains("power delivered (%)"));
    assert!(fs::read(&files[1]).unwrap().starts_with(b"%PDF"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("cloakroom"))
        .arg("render")
        .arg(paper("8c"))
        .args(["--set", "camera.samples=4096", "-o"])
        .arg(&out)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(700));
    assert!(child.try_wait().unwrap().is_none(), "it ended before it could be interrupted");
    let id = child.id().to_string();
    // Twice at once, as `timeout` does it: that is not impatience.
    let kill = format!("kill -TERM {id}; kill -TERM {id}");
    assert!(std::process::Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    assert_eq!(String::from_utf8(ended.stderr).unwrap(), "interrupted\n");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn interfaces_are_solved() {
    let glass = r#"{"incident": {"permittivity": 1, "permeability": 1},
        "transmitted": {"permittivity": 2.25, "permeability": 1},
        "normal": [1, 0, 0], "tangential": [0, 0, 0]}"#;
    let solve =
        |text: String| json(&stdout(cloakroom().args(["interface", "-"]).write_stdin(text)));
    let one = solve(glass.to_owned());
    for mode in 0..2 {
        assert!((one["total_reflected"][mode].as_f64().unwrap() - 0.04).abs() < 1e-14);
        assert!((one["total_transmitted"][mode].as_f64().unwrap() - 0.96).abs() < 1e-14);
    }
    assert_eq!(one["power"].as_array().unwrap().len(), 4);
    let metal = glass.replace(r#"{"permittivity": 2.25, "permeability": 1}"#, r#""metal""#);
    let both = solve(format!("[{glass}, {metal}]"));
    assert_eq!(both[0], one);
    assert!((both[1]["total_reflected"][0].as_f64().unwrap() - 1.0).abs() < 1e-14);
    let mut command = cloakroom();
    command.args(["interface", "-"]).write_stdin(glass.replace("2.25", "\"two\""));
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("transmitted.permittivity"));
}

/// What is exported as a mesh is a solid that can be read again.
#[test]
fn outlines_of_devices_are_solids_again() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let solids = "[[device]]\nkind = \"body\"\nname = \"crate\"\nshape = \"box\"\nsize = [4, 6, 8]\nrotation = 30\n\
                  index = 1.5\n[[device]]\nkind = \"lens\"\nposition = [20, 0, 0]\n";
    fs::write(&scene, solids).unwrap();
    for (name, device) in [("a.stl", "0"), ("a.glb", "0"), ("a.gltf", "1")] {
        let mesh = folder.path().join(name);
        let mut export = cloakroom();
        export.arg("export").arg(&scene).args(["--device", device, "-o"]).arg(&mesh);
        export.assert().success().stdout("").stderr("");
        let again = folder.path().join("again.toml");
        fs::write(&again, format!("[[device]]\nkind = \"polyhedron\"\nmesh = {mesh:?}\n")).unwrap();
        let text = String::from_utf8(stdout(cloakroom().arg("check").arg(&again))).unwrap();
        let volume = text.lines().find_map(|line| line.trim().strip_prefix("volume_cm3"));
        let volume: f64 = volume.unwrap().trim().parse().unwrap();
        assert!(device == "1" || (volume - 192.0).abs() < 1e-3, "{name} {volume}");
    }
    let both = folder.path().join("both.stl");
    cloakroom().arg("export").arg(&scene).arg("-o").arg(&both).assert().success();
    let bytes = fs::read(&both).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert!(count > 100 && bytes.len() == 84 + 50 * count);
}
