//! `cloakroom flight`: films and arrays of light in flight; `cloakroom diagram --pulse`: pulses from the side.

use crate::running::cloakroom;
use image::RgbImage;
use std::fs;
use std::path::Path;
use std::process::Output;

const SCENE: &str =
    "[camera]\nresolution = [70, 50]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn flight(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = cloakroom();
    command.current_dir(folder).args(["flight", "scene.toml"]).args(arguments);
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn films_and_arrays_are_made_of_one_flight() {
    let folder = folder();
    let words = ["--gate", "4.9..6.9:0.2", "-o", "a.npz", "-o", "a.gif", "-o", "frames"];
    let output = flight(folder.path(), &words);
    assert!(output.status.success() && output.stdout.is_empty(), "{output:?}");
    assert!(!said(&output).contains("note"), "{}", said(&output));
    let at = |name: &str| folder.path().join(name);
    let bytes = fs::read(at("a.gif")).unwrap();
    assert!(bytes.starts_with(b"GIF89a") && bytes[6..10] == [70, 0, 50, 0]);
    assert!(fs::read(at("a.npz")).unwrap().starts_with(b"PK") && !at("a.gif.frames").exists());
    assert_eq!(fs::read_dir(at("frames")).unwrap().count(), 11);
    // Light past the cloak comes first, and no other then.
    let frame = |number: u32| -> RgbImage {
        let path = at("frames").join(format!("frame-{number:06}.png"));
        image::open(path).unwrap().into_rgb8()
    };
    let light = |image: &RgbImage, [x, y]: [u32; 2]| {
        image.get_pixel(x, y).0.map(u32::from).iter().sum::<u32>()
    };
    let (beside, through) = ([35, 3], [35, 25]);
    let first = frame(1);
    assert!(light(&first, beside) > 20 && light(&first, through) == 0);
    // On the axis 1.45 ns later: in the bins about 6.45 ns.
    assert!((7..9).any(|bin| light(&frame(bin), through) > 20));
    assert!((4..10).all(|bin| light(&frame(bin), beside) == 0));
    // Nothing else is left.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
}

#[test]
fn a_gate_is_found_and_light_outside_of_one_is_told() {
    let folder = folder();
    let output = flight(folder.path(), &["-o", "a.npz", "--time-last"]);
    assert!(output.status.success(), "{output:?}");
    let words = said(&output);
    // The first light comes past the cloak, 1.5 m and a little away.
    let gate = words.strip_prefix("--gate ").and_then(|gate| gate.split_once(".."));
    let start: f64 = gate.unwrap().0.parse().unwrap();
    assert!((4.9..5.1).contains(&start) && !words.contains("note"), "{words}");
    let output = flight(folder.path(), &["-o", "a.npz", "--gate", "4.9..5.3:0.1"]);
    assert!(
        said(&output).contains("% of the light comes after the gate 4.9..5.3:0.1"),
        "{output:?}"
    );
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder();
    // Before it is looked for when light arrives.
    fs::write(folder.path().join("a.gif.frames"), "").unwrap();
    for (words, message) in [
        (vec!["-o", "a.gif", "--gate", "5..4:1"], "the gate 5..4:1 has no bins"),
        (vec!["-o", "a.gif", "--gate", "5"], "write START..END:STEP in ns"),
        (vec!["-o", "a.gif", "--flash", "lamp"], "`lamp` is no flash"),
        (vec!["-o", "a.gif", "--pulse=-1"], "write ns, from 0"),
        (vec!["-o", "a.avi"], "use .npz, .gif"),
        (vec!["-o", "nowhere/a.npz"], "there is no folder nowhere"),
        (vec!["-o", "a.gif"], "cannot make the folder a.gif.frames"),
        (vec!["-o", "a.npz", "-o", "a.npz"], "another output of this run is that file"),
    ] {
        let output = flight(folder.path(), &words);
        assert!(!output.status.success() && output.stdout.is_empty(), "{words:?} {output:?}");
        assert!(said(&output).contains(message), "{words:?}: {}", said(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

fn diagram(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = cloakroom();
    let small = ["--size", "120x90", "--rays", "6"];
    command.current_dir(folder).args(["diagram", "scene.toml"]).args(small).args(arguments);
    command.output().unwrap()
}

#[test]
fn a_pulse_is_filmed_from_the_side() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let words = ["--pulse", "0..1:0.25", "-o", "a.gif", "-o", "frames", "--fps", "5"];
    let output = diagram(folder.path(), &words);
    assert!(output.status.success() && output.stdout.is_empty(), "{output:?}");
    let bytes = fs::read(at("a.gif")).unwrap();
    assert!(bytes.starts_with(b"GIF89a") && bytes[6..10] == [120, 0, 90, 0]);
    assert_eq!(fs::read_dir(at("frames")).unwrap().count(), 5);
    let frames =
        [0, 4].map(|number| fs::read(at("frames").join(format!("frame-00000{number}.png"))));
    assert_ne!(frames[0].as_ref().unwrap(), frames[1].as_ref().unwrap());
    // A single time is a drawing.
    let output = diagram(folder.path(), &["--pulse", "-0.1", "--delay", "phase", "-o", "a.svg"]);
    assert!(output.status.success(), "{output:?}");
    let drawing = fs::read_to_string(at("a.svg")).unwrap();
    assert!(drawing.contains("<g class=\"pulse\"") && drawing.contains("phase"), "{drawing}");
    // Without times it is looked at while it is seen.
    let output = diagram(folder.path(), &["-o", "b.webp", "--pulse"]);
    assert!(output.status.success() && said(&output).contains("--pulse=-0."), "{output:?}");
    assert!(fs::read(at("b.webp")).unwrap().starts_with(b"RIFF"));
    // Nothing else is left.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
    for (words, message) in [
        (vec!["--pulse", "-o", "c.svg"], "give --pulse a single time"),
        (
            vec!["--pulse", "0.5", "-o", "c.gif"],
            "for a film, give --pulse without a time, or times",
        ),
        (vec!["-o", "c.gif"], "for a film, give --pulse without a time, or times"),
        (vec!["--pulse", "soon", "-o", "c.svg"], "write ns, as in 1.2, or START..END:STEP"),
        (vec!["--pulse", "2..1:1", "-o", "c.gif"], "the gate 2..1:1 has no bins"),
        (vec!["--pulse", "1", "--setting", "-o", "c.svg"], "cannot be used with"),
        (vec!["--delay", "phase", "-o", "c.svg"], "--pulse"),
        (vec!["--pulse", "-o", "nowhere/c.gif"], "there is no folder nowhere"),
    ] {
        let output = diagram(folder.path(), &words);
        assert!(!output.status.success() && output.stdout.is_empty(), "{words:?} {output:?}");
        assert!(said(&output).contains(message), "{words:?}: {}", said(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
}
