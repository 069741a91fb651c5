//! Bad input: one clear message, exit status 1, and no file left behind.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder with a scene in it, small enough to render at once.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn with_scene(scene: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Self { folder }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn write(&self, name: &str, bytes: &[u8]) -> &Self {
        fs::write(self.path().join(name), bytes).unwrap();
        self
    }

    fn cloakroom(&self, arguments: &[&str]) -> Command {
        let mut command = Command::cargo_bin("cloakroom").unwrap();
        command.current_dir(self.path()).args(arguments);
        command
    }

    /// Renders, expecting one message with the given parts, and that no file has appeared.
    fn refuses(&self, parts: &[&str]) {
        self.refuses_with(&["render", "scene.toml", "-o", "out.png"], parts);
    }

    fn refuses_with(&self, arguments: &[&str], parts: &[&str]) {
        let before = self.files();
        let output = self.cloakroom(arguments).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(output.stdout.is_empty());
        assert!(message.starts_with("error: "), "{message}");
        let errors = message.lines().filter(|line| line.starts_with("error"));
        assert_eq!(errors.count(), 1, "{message}");
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
        assert_eq!(self.files(), before, "a file has appeared: {message}");
    }

    fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

const SMALL: &str = "[camera]\nresolution = [16, 12]\nsamples = 1\n";

fn small(rest: &str) -> Desk {
    Desk::with_scene(&format!("{SMALL}{rest}"))
}

#[test]
fn missing_scene() {
    small("").refuses_with(&["render", "nowhere.toml", "-o", "out.png"], &["nowhere.toml"]);
}

#[test]
fn missing_photograph() {
    small("[photograph]\nimage = \"holiday.jpg\"\n").refuses(&["scene.toml:5:9", "holiday.jpg"]);
}

#[test]
fn not_an_image() {
    let desk = small("[photograph]\nimage = \"notes.png\"\n");
    desk.write("notes.png", b"these are words").refuses(&["scene.toml:5:9", "notes.png"]);
}

#[test]
fn truncated_images() {
    for (name, format) in
        [("cut.png", image::ImageFormat::Png), ("cut.jpg", image::ImageFormat::Jpeg)]
    {
        let picture = image::RgbImage::from_fn(200, 200, |x, y| {
            image::Rgb([(x * 7 + y) as u8, (x ^ y) as u8, (y * 3) as u8])
        });
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        let bytes = bytes.into_inner();
        let desk = small(&format!("[photograph]\nimage = \"{name}\"\n"));
        desk.write(name, &bytes[..bytes.len() / 2]).refuses(&["scene.toml:5:9", name]);
    }
}

#[test]
fn unknown_keys_name_the_nearest() {
    small("[[device]]\nkind = \"square-cloak\"\nrotatoin = 3\n").refuses(&[
        "scene.toml:6:1",
        "rotatoin",
        "rotation",
    ]);
    small("[[device]]\nkind = \"square-cloack\"\n").refuses(&[
        "scene.toml:5:8",
        "square-cloack",
        "square-cloak",
    ]);
    small("[camara]\n").refuses(&["scene.toml:4:", "camara", "camera"]);
}

#[test]
fn wrong_types_and_values() {
    small("field_of_view = \"wide\"\n").refuses(&["scene.toml:4:17", "field_of_view"]);
    small("field_of_view = nan\n").refuses(&["scene.toml:4:17", "finite"]);
    small("field_of_view = 0\n").refuses(&["scene.toml:4:17", "field_of_view is 0"]);
    small("position = [-100, inf, 0]\n").refuses(&["scene.toml:4:12", "finite"]);
    small("[[device]]\nkind = \"square-cloak\"\nside = -3\n")
        .refuses(&["scene.toml:6:8", "side is -3 cm"]);
    small("[[device]]\nkind = \"double-gaussian-cloak\"\nh = 20\n")
        .refuses(&["scene.toml:6:5", "h"]);
    small("[photograph]\nwidth = -110\n").refuses(&["scene.toml:5:9", "width is -110 cm"]);
}

#[test]
fn impossible_resolutions() {
    for size in ["[0, 0]", "[100000, 100000]"] {
        Desk::with_scene(&format!("[camera]\nresolution = {size}\n")).refuses(&[
            "scene.toml:2:14",
            "resolution",
            "65536",
        ]);
    }
}

#[test]
fn more_pixels_than_memory() {
    // An image goes into its file strip by strip; data must be there as a whole.
    Desk::with_scene("[camera]\nresolution = [65536, 65536]\n")
        .refuses_with(&["render", "scene.toml", "-o", "out.npz"], &["memory", "resolution"]);
}

#[test]
fn camera_inside_metal() {
    for kind in ["square-cloak", "double-gaussian-cloak"] {
        for show in ["cloak", "bare"] {
            small(&format!(
                "position = [1, 0.5, 0]\n[[device]]\nkind = \"{kind}\"\nshow = \"{show}\"\n"
            ))
            .refuses(&["scene.toml:4:12", "camera", "device 0"]);
        }
    }
}

#[test]
fn devices_in_each_others_way() {
    small(
        "[[device]]\nkind = \"square-cloak\"\n[[device]]\nkind = \"square-cloak\"\n\
         position = [10, 0, 0]\n",
    )
    .refuses(&["scene.toml:6:1", "overlaps"]);
    small("[photograph]\nx = 5\n[[device]]\nkind = \"square-cloak\"\n")
        .refuses(&["cuts through the photograph"]);
}

#[test]
fn sheets_that_lie_on_each_other() {
    let polarizers = |second: &str| {
        let one = "[[device]]\nkind = \"polarizer\"\n";
        small(&format!("{one}rotation = 30\n{one}angle = 45\n{second}"))
    };
    for second in [
        "rotation = 30\n",
        "rotation = 210\n",
        // Along the first.
        "rotation = 30\nwidth = 2\nposition = [-4, 6.9282032302755, 1]\n",
    ] {
        polarizers(second).refuses(&["scene.toml:7:1", "overlaps"]);
    }
    for second in [
        "rotation = 30\nposition = [0.1, 0, 0]\n",
        "rotation = 30\nposition = [-10, 17.320508075689, 0]\n",
        "rotation = 31\nposition = [0.5, 0, 0]\n",
    ] {
        let desk = polarizers(second);
        desk.cloakroom(&["check", "scene.toml"]).assert().success();
    }
}

#[test]
fn outputs_that_cannot_be() {
    let desk = small("");
    let render = |to: &str, parts: &[&str]| {
        desk.refuses_with(&["render", "scene.toml", "-o", to], parts);
    };
    render("out.tiff", &["out.tiff", ".png, .exr or .npz"]);
    render("missing/out.png", &["missing/out.png", "there is no folder"]);
    fs::create_dir(desk.path().join("folder.png")).unwrap();
    render("folder.png", &["folder.png", "it is a folder"]);
}

#[cfg(target_os = "linux")]
#[test]
fn disk_full() {
    let desk = small("");
    for name in ["full.png", "full.exr", "full.npz"] {
        std::os::unix::fs::symlink("/dev/full", desk.path().join(name)).unwrap();
        desk.refuses_with(&["render", "scene.toml", "-o", name], &[name, "no space left"]);
    }
}

#[cfg(unix)]
#[test]
fn disk_quota_reached_in_the_middle() {
    // A limit on the size of files stands for a disk that runs full while a file is written.
    let desk = small("[picture]\nmap = \"delivered\"\n");
    let program = assert_cmd::cargo::cargo_bin("cloakroom");
    let script = format!(
        "ulimit -f 1; exec '{}' render scene.toml --set 'camera.resolution=[256, 256]' \
         -o out.npz",
        program.display()
    );
    let output =
        Command::new("bash").args(["-c", &script]).current_dir(desk.path()).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write out.npz"), "{message}");
    assert_eq!(desk.files(), ["scene.toml"]);
}

#[test]
fn overrides_are_pointed_at() {
    let desk = small("");
    desk.refuses_with(
        &["render", "scene.toml", "-o", "out.png", "--set", "camera.sample=16"],
        &["--set camera.sample=16", "samples"],
    );
}

#[test]
fn swept_values_and_normals_are_pointed_at() {
    let desk = small("[[device]]\nkind = \"square-cloak\"\n");
    let animate =
        |sweep| ["animate", "scene.toml", "--sweep", sweep, "--frames", "2", "-o", "a.gif"];
    let named = ["--sweep device.0.bad=0", "unknown key `bad`"];
    desk.refuses_with(&animate("device.0.bad=0..1"), &named);
    let metal = ["--sweep camera.position=", "inside"];
    desk.refuses_with(&animate("camera.position=[0,0,0],[0,0,1]"), &metal);
    let check = |set| ["check", "scene.toml", "--set", set];
    let normal = ["error: --set photograph.normal=[0,1,0]: up is [0, 1, 0]"];
    desk.refuses_with(&check("photograph.normal=[0,1,0]"), &normal);
    let up = ["error: --set photograph.up=[1,0,0]: up is [1, 0, 0]"];
    desk.refuses_with(&check("photograph.up=[1,0,0]"), &up);
    let target = ["error: --set camera.target=[-100,9,0]: up is [0, 1, 0]"];
    let position = ["check", "scene.toml", "--set", "camera.position=[-100,0,0]", "--set"];
    desk.refuses_with(&[&position[..], &["camera.target=[-100,9,0]"]].concat(), &target);
    desk.refuses_with(&check("trace.tolerance=1e300"), &["tolerance", "above 0 and below 1"]);
}

#[test]
fn wrong_usage_is_another_status() {
    let desk = small("");
    for (arguments, part) in [
        (&["merge", "a.npz"][..], "--output"),
        (&["paint"], "paint"),
        (&["figures", "--only", "6x"], "6x"),
        (&["figures", "--size", "0x4"], "WIDTHxHEIGHT"),
        (&["flux", "scene.toml", "--sun", "91,0"], "LATITUDE,DECLINATION"),
        (&["flux", "scene.toml", "--angles", "0..1:0.0001"], "at most 10000 angles"),
        (&["flux", "scene.toml", "--tilt", "nan"], "less than 90"),
        (&["flux", "scene.toml", "--angles", "nan"], "FROM..TO:STEP"),
        (&["flux", "scene.toml", "--sun", "nan,0"], "LATITUDE,DECLINATION"),
        (&["trace", "-", "--rays", "-"], "standard input"),
        (&["render", "scene.toml", "-o", "out.png", "--threads", "0"], "--threads"),
    ] {
        let output = desk.cloakroom(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
}

#[test]
fn exports_that_cannot_be_made() {
    let square = small("[[device]]\nkind = \"square-cloak\"\n");
    let export = |grid: &'static str| ["export", "scene.toml", "-o", "out.npz", "--grid", grid];
    square.refuses_with(&export("0x3x3"), &["at least one cell"]);
    square.refuses_with(&export("0"), &["positive spacing"]);
    square.refuses_with(&export("4000000000x1000000x1"), &["MB of memory"]);
    for large in ["4000000000x4000000000x4000000000", "1e-9", "1e-300"] {
        square.refuses_with(&export(large), &["so fine a grid is too large"]);
    }
    square.refuses_with(
        &["export", "scene.toml", "-o", "out.png"],
        &[".npz, .vti, .csv, .stl, .glb or .gltf"],
    );
    square.refuses_with(&["export", "scene.toml", "--table", "-o", "out.npz"], &[".csv or .json"]);
    square.refuses_with(&["export", "scene.toml", "--device", "3", "-o", "out.npz"], &["device 3"]);
    square.refuses_with(
        &["export", "scene.toml", "--set", "device.0.show=bare", "-o", "out.npz"],
        &["bare metal"],
    );
    small("").refuses_with(&["export", "scene.toml", "-o", "out.npz"], &["no device"]);
    small("").refuses_with(&["export", "scene.toml", "-o", "out.stl"], &["no device"]);
    square.refuses_with(
        &["export", "scene.toml", "-o", "out.glb"],
        &["device 0", "endless", "`length`"],
    );
}

#[test]
fn diagrams_and_fluxes_that_cannot_be_made() {
    let square = small("[[device]]\nkind = \"square-cloak\"\n");
    square.refuses_with(&["diagram", "scene.toml", "-o", "out.npz"], &[".svg, .pdf or .png"]);
    square.refuses_with(&["diagram", "scene.toml", "-o", "out.svg", "--rays", "0"], &["rays is 0"]);
    square.refuses_with(
        &["diagram", "scene.toml", "-o", "out.svg", "--point", "0,0,0"],
        &["inside device 0"],
    );
    small("").refuses_with(&["diagram", "scene.toml", "-o", "out.svg"], &["no device"]);
    square.refuses_with(
        &["flux", "scene.toml", "-o", "out.csv", "--set", "receiver.position=[5, 0, 0]"],
        &["device 0", "receiver"],
    );
    square.refuses_with(&["flux", "scene.toml", "-o", "out.exr"], &[".csv, .npz"]);
    square.refuses_with(
        &["flux", "scene.toml", "--set", "receiver.normal=[0, 0, 0]"],
        &["normal is [0, 0, 0]"],
    );
    square.refuses_with(&["flux", "scene.toml", "--sun", "80,-23"], &["does not rise"]);
    small("").refuses_with(&["flux", "scene.toml"], &["no device"]);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let desk = Desk::with_scene("[camera]\nresolution = [8, 6]\nsamples = 1\n");
    let render = |size: &str, name: &str| {
        let size = format!("camera.resolution={size}");
        desk.cloakroom(&["render", "scene.toml", "--set", &size, "-o", name]).assert().success();
    };
    render("[8, 6]", "a.npz");
    render("[6, 8]", "b.npz");
    render("[8, 6]", "c.png");
    desk.write("broken.npz", b"not an archive").write("empty.png", b"");
    let refuses = |arguments: &[&str], parts: &[&str]| {
        desk.refuses_with(&[&["compare"], arguments].concat(), parts);
    };
    refuses(&["a.npz", "b.npz"], &["one size", "8 x 6", "6 x 8"]);
    refuses(&["a.npz", "c.png", "--mask", "b.npz"], &["one size"]);
    refuses(&["a.npz", "c.png", "--region", "4,4,5,1"], &["beyond the picture"]);
    refuses(&["a.npz", "c.png", "--region", "4,4,0,1"], &["no pixels"]);
    refuses(&["a.npz", "broken.npz"], &["broken.npz"]);
    refuses(&["a.npz", "empty.png"], &["empty.png is empty"]);
    refuses(&["a.npz", "none.exr"], &["none.exr"]);
    refuses(&["a.npz", "scene.toml"], &["ending"]);
}

#[test]
fn sweeps_without_sense_are_refused() {
    let desk = Desk::with_scene("[[device]]\nkind = \"square-cloak\"\n");
    let refuses = |sweep: &str, parts: &[&str]| {
        let arguments = ["quality", "scene.toml", "--sweep", sweep, "-o", "out.csv"];
        desk.refuses_with(&arguments, parts);
    };
    refuses("device.0.rotation=0..10:-1", &["empty"]);
    refuses("device.0.rotation=", &["missing"]);
    refuses("device.0.rotation=0,inf", &["not a finite number"]);
    refuses("device.0.rotaton=0,1", &["--sweep device.0.rotaton=0", "did you mean `rotation`"]);
    refuses("device.1.rotation=0", &["kind"]);
    let arguments = ["quality", "scene.toml", "--sweep", "device.0.rotation=0"];
    desk.refuses_with(&[&arguments[..], &["-o", "out.txt"]].concat(), &["ending"]);
    desk.refuses_with(
        &[&arguments[..], &["--plot", "corelation", "-o", "out.svg"]].concat(),
        &["no figure `corelation`"],
    );
    desk.refuses_with(&[&arguments[..], &["-o", "nowhere/out.csv"]].concat(), &["no folder"]);
}
