//! What is said about scenes that cannot be read.

use super::{read, read_with};

/// The first line of the message, without the name of the file.
fn message(text: &str) -> String {
    let error = read(text).expect_err(text).to_string();
    let line = error.lines().next().unwrap_or_default();
    line.strip_prefix("scene.toml:").unwrap_or(line).to_owned()
}

fn override_message(text: &str, override_text: &str) -> String {
    let error = read_with(text, &[override_text]).expect_err(override_text).to_string();
    let prefix = format!("--set {override_text}: ");
    assert!(error.starts_with(&prefix), "{error}");
    error[prefix.len()..].to_owned()
}

#[test]
fn words_without_quotes_are_told() {
    for (word, part) in [
        ("nix", "text must be quoted: \"nix\""),
        ("impossible", "text must be quoted: \"impossible\""),
        ("abc", "must be quoted"),
    ] {
        let text = format!("[[device]]\nkind = \"square-cloak\"\nmaterial = {word}\n");
        let error = read(&text).expect_err("no text");
        assert!(error.message.contains(part), "{}", error.message);
        assert_eq!((error.line, error.column), (Some(3), Some(12)));
    }
}

#[test]
fn an_unknown_key_is_shown_with_the_nearest_known_one() {
    let error = read("# a scene\n[camera]\npositon = [-100, 0, 0]\n").expect_err("a slip");
    assert_eq!(
        error.to_string(),
        "scene.toml:3:1: unknown key `positon` in [camera]; did you mean `position`?\n  \
         3 | positon = [-100, 0, 0]\n    | ^^^^^^^"
    );
    assert_eq!((error.line, error.column), (Some(3), Some(1)));
    assert_eq!(error.file, "scene.toml");
}

#[test]
fn unknown_words_are_answered_with_known_ones() {
    for (text, expected) in [
        ("[camra]", "1:2: unknown table `camra`; did you mean `camera`?"),
        ("[[devices]]", "1:3: unknown table `devices`; did you mean `device`?"),
        (
            "[banana]",
            "1:2: unknown table `banana`; known tables: camera, light, photograph, surroundings, \
             trace, picture, receiver, device",
        ),
        ("samples = 4", "1:1: `samples` stands outside of its table, [camera]"),
        ("kind = 'square-cloak'", "1:1: `kind` stands outside of its table, [[device]]"),
        (
            "[[device]]\nkind = 'square'",
            "2:8: there is no kind of device `square`; did you mean `square-cloak`?",
        ),
        (
            "[[device]]\nkind = 'square-cloak'\nrotaton = 5",
            "3:1: unknown key `rotaton` in a square-cloak; did you mean `rotation`?",
        ),
        (
            "[light]\ncolor = 5",
            "2:1: unknown key `color` in [light]; known keys: wavelength_nm, bandwidth_nm, spectrum",
        ),
        (
            "[picture]\nmap = 'time_of_fligth'",
            "2:7: map is \"time_of_fligth\"; it must be \"none\", \"time_of_flight\", \
             \"time_of_flight_spread\", \"time_of_flight_difference\", \"group_delay\", \
             \"group_delay_spread\", \"group_delay_difference\", \"first_pulse_depth\", \
             \"strongest_pulse_depth\", \"delivered\", \
             \"escaped\", \"absorbed\", \"pruned\", \"extraordinary_share\" or \
             \"first_face_reflectance\"; did you mean \"time_of_flight\"?",
        ),
    ] {
        assert_eq!(message(text), expected, "{text}");
    }
}

#[test]
fn values_that_do_not_fit_are_named_with_what_would() {
    let device = "[[device]]\nkind = 'square-cloak'\n";
    for (text, expected) in [
        (format!("{device}side = -3"), "3:8: side is -3 cm; it must be from 1e-6 to 1000000"),
        (format!("{device}side = nan"), "3:8: side is not a number (nan); numbers must be finite"),
        (format!("{device}side = 1e999"), "3:8: side is infinite; numbers must be finite"),
        (format!("{device}side = '14 cm'"), "3:8: side is \"14 cm\"; it must be a number (cm)"),
        (format!("{device}side = {{}}"), "3:8: side is a table; it must be a number (cm)"),
        (
            "[camera]\nsamples = 99999999999999999999".to_owned(),
            "2:11: whole numbers must fit into 64 bits",
        ),
        (
            "[camera]\nposition = [1, 2]".to_owned(),
            "2:12: position is [1, 2]; it must be three numbers (cm)",
        ),
        (
            "[camera]\nposition = [1, 2, inf]".to_owned(),
            "2:12: the third component of position is infinite; numbers must be finite",
        ),
        (
            "[camera]\nseed = 2024-01-01".to_owned(),
            "2:8: seed is a date or a time; it must be a whole number",
        ),
        (
            "[camera]\nposition = [1, 2, 1979-05-27]".to_owned(),
            "2:12: position is a date or a time; it must be three numbers (cm)",
        ),
        ("camera = 5".to_owned(), "1:1: camera is 5; it must be a table: [camera]"),
        ("[[camera]]".to_owned(), "1:3: camera is a list of tables; it must be a table: [camera]"),
        (
            "[device]".to_owned(),
            "1:1: device is a table; each device is a table of its own: [[device]]",
        ),
        (
            "device = [5]".to_owned(),
            "1:11: device is 5; each device is a table of its own: [[device]]",
        ),
    ] {
        assert_eq!(message(&text), expected, "{text}");
    }
}

#[test]
fn a_device_needs_a_kind() {
    assert!(message("[[device]]\n").starts_with("1:1: this device has no `kind`; known kinds: "));
    let text = "[[device]]\ntype = 'square-cloak'";
    assert_eq!(message(text), "1:1: a device's kind is written `kind`, not `type`");
    assert!(message("[[device]]\nkind = 5").starts_with("2:8: kind is 5; it must be one of "));
}

#[test]
fn keys_that_do_not_go_together_are_refused_at_one_of_them() {
    for (text, start) in [
        ("[camera]\nposition = [50, 0, 0]", "1:1: position and target are both [50, 0, 0] cm"),
        ("[camera]\nup = [1, 0, 0]", "2:6: up is [1, 0, 0], along the line of sight"),
        ("[camera]\nwidth = 5", "2:9: width belongs to orthographic cameras"),
        ("[camera]\nprojection = 'orthographic'", "2:14: an orthographic camera needs width"),
        ("[photograph]\nimage = 'builtin:shelf'", "2:9: there is no built-in image"),
        ("[surroundings]\ncolor = [0, 0, 0]\nimage = 'a'", "3:9: color and image are both"),
    ] {
        assert!(message(text).starts_with(start), "{}", message(text));
    }
}

#[test]
fn broken_toml_is_shown_in_its_place() {
    for (text, start) in [
        ("[camera]\nsamples = 1\nsamples = 2\n", "3:1: `samples` is given twice"),
        ("[camera]\n[camera]\n", "2:2: `camera` is given twice"),
        ("[camera\n", "1:8: "),
        ("[camera]\nup = [1, 2", "2:11: "),
        ("[camera]\nprojection = perspective\n", "2:14: string values must be quoted"),
    ] {
        assert!(message(text).starts_with(start), "{}", message(text));
    }
}

#[test]
fn overrides_point_at_themselves() {
    let two = "[[device]]\nkind = 'square-cloak'\n[[device]]\nkind = 'square-cloak'\n";
    for (text, override_text, expected) in [
        ("", "camera.sample=16", "unknown key `sample` in [camera]; did you mean `samples`?"),
        ("", "camra.samples=16", "unknown table `camra`; did you mean `camera`?"),
        ("", "fov=30", "there is no `fov`; here it is called `camera.field_of_view`"),
        ("", "rotation=5", "`rotation` is a key of devices, as in device.0.rotation"),
        ("", "tilt=5", "there is no `tilt`; here it is called `device.0.rotation`"),
        (two, "side=5", "`side` is a key of devices, as in device.0.side"),
        (two, "edge_length=5", "there is no `edge_length`; here it is called `device.0.side`"),
        (
            "",
            "camera.position=-80,0,0",
            "position is \"-80,0,0\"; it must be three numbers (cm), in brackets: [-80, 0, 0]",
        ),
        (
            "",
            "camera.position.y=5",
            "the entries of camera.position have numbers and no names: camera.position.1",
        ),
        ("", "device[0].rotation=5", "entries of lists follow a dot: `device.0.rotation`"),
        ("", "camera.samples=many", "samples is \"many\"; it must be a whole number"),
        ("", "camera.samples=", "samples is \"\"; it must be a whole number"),
        ("", "camera.samples", "an override is written KEY=VALUE, such as camera.samples=16"),
        ("", "=5", "a key is missing; write it as in camera.samples=16"),
        ("", "camera..x=5", "a key is missing; write it as in camera.samples=16"),
        (
            two,
            "device.3.rotation=5",
            "there is no device.3: the scene has 2 devices, device.0 to device.1; device.2.kind=... would \
             add one",
        ),
        (
            "",
            "device.1.kind=square-cloak",
            "there is no device.1: the scene has no devices; device.0.kind=... would add one",
        ),
        (
            two,
            "device.first.rotation=5",
            "no device is called `first`; devices are counted from 0, as in device.0, and device.* is every \
             one",
        ),
        (two, "device.0.side=0", "side is 0 cm; it must be from 1e-6 to 1000000"),
        (two, "device.0=5", "device is 5; each device is a table of its own: [[device]]"),
        (
            "[camera]\nsamples = 4",
            "camera.samples.x=5",
            "camera.samples is 4; there is no `x` in it",
        ),
        (
            two,
            "device.0.coating.0.optic_axis.1=5",
            "device.0.coating.0.optic_axis is not written in the scene, so an entry of it \
             cannot be set alone; set all of it: device.0.coating.0.optic_axis=[...]",
        ),
        (
            "[camera]\nposition = [1, 2, 3]",
            "camera.position.3=5",
            "there is no camera.position.3: camera.position has the entries 0 to 2",
        ),
    ] {
        assert_eq!(override_message(text, override_text), expected, "{override_text}");
    }
    let one = "[[device]]\nkind = 'square-cloak'\n";
    for (text, override_text, expected) in [
        (one, "device.1.rotation=5", "there is no device.1: the scene has one device, device.0;"),
        ("", "device.0.rotation=5", "there is no device.0: the scene has no devices;"),
        ("", "device.*.rotation=5", "there is no device.*: the scene has no devices"),
        (
            two,
            "device.*.tilt=5",
            "unknown key `tilt` in a square-cloak; here it is called `rotation`",
        ),
        ("", "camera.fov=5", "unknown key `fov` in [camera]; here it is called `field_of_view`"),
        (
            "",
            "camera.position.3=5",
            "there is no camera.position.3: camera.position has the entries",
        ),
    ] {
        let message = override_message(text, override_text);
        assert!(message.starts_with(expected), "{message}");
    }
    let deep = format!("{}=5", ["a"; 100_000].join("."));
    assert_eq!(override_message("", &deep), "no key lies that deep");
}

#[test]
fn an_override_of_a_misplaced_table_leaves_the_message_about_the_file() {
    let error = read_with("[device]\nkind = 'square-cloak'", &["device.0.rotation=5"]);
    let error = error.expect_err("a misplaced table");
    assert_eq!(error.line, Some(1), "{error}");
}
