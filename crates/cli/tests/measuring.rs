//! Pictures compared and devices measured: what the commands print and write.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::running::{cloakroom, json, paper, stdout};
use std::fs;

#[test]
fn pictures_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    for (show, name) in [("cloak", "cloak.npz"), ("bare", "bare.npz"), ("cloak", "cloak.png")] {
        let show = format!("device.0.show={show}");
        let size = ["--set", "camera.resolution=[80,60]", "--set", "camera.samples=1"];
        let mut command = cloakroom();
        command.arg("render").arg(paper("6c")).args(size).args(["--set", &show, "-o"]);
        command.arg(file(name)).assert().success();
    }
    let mut command = cloakroom();
    command.arg("compare").args([file("cloak.npz"), file("bare.npz")]);
    let words = String::from_utf8(stdout(&mut command)).unwrap();
    assert!(words.contains("correlation") && words.contains("picture"), "{words}");
    let found = json(&stdout(command.args(["--json", "--region", "0,0,80,5"])));
    assert_eq!((&found["width_pixels"], &found["picture"]["pixels"]), (&80.into(), &4800.into()));
    assert!(found["picture"]["correlation"][1].as_f64().unwrap() < 0.95);
    // The metal is in the middle: at the top, nothing has changed.
    assert!((found["region"]["correlation"][1].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert_eq!(found["region"]["delivered"][1].as_f64().unwrap(), 1.0);
    assert!(found["picture"]["time_of_flight_difference"]["maximum_ns"].is_number());
    let mut command = cloakroom();
    command.arg("compare").args([file("cloak.npz"), file("cloak.png")]).arg("--json");
    let found = json(&stdout(&mut command));
    // Eight bits, and no times.
    assert!(found["picture"]["rms_difference"][0].as_f64().unwrap() < 2e-3);
    assert!(found["picture"]["time_of_flight_difference"].is_null());
}

#[test]
fn quality_is_tabulated_and_plotted() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["a.csv", "a.npz", "a.svg", "a.pdf", "a.png"].map(|name| folder.path().join(name));
    let mut command = cloakroom();
    command.arg("quality").arg(paper("6c"));
    command.args(["--set", "camera.resolution=[32,24]", "--set", "camera.samples=1"]);
    command.args(["--sweep", "device.0.rotation=0..10:5", "--sweep", "device.0.show=cloak,bare"]);
    let words = String::from_utf8(stdout(&mut command)).unwrap();
    assert_eq!(words.lines().filter(|line| line.contains("cloak  ")).count(), 3, "{words}");
    for file in &files {
        command.arg("-o").arg(file);
    }
    let found = json(&stdout(command.arg("--json")));
    assert_eq!(found["rows"].as_array().unwrap().len(), 6);
    assert_eq!(found["rows"][2]["settings"]["device.0.rotation"], "5");
    let figure = &found["rows"][2]["figures"]["ideal_picture_correlation"];
    assert!((figure.as_f64().unwrap() - 1.0).abs() < 1e-9);
    assert!(files.iter().all(|file| fs::metadata(file).unwrap().len() > 100));
}
