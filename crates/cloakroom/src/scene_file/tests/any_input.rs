//! Whatever is read, the answer is a scene or an error that can be shown.

use std::path::Path;

use proptest::prelude::*;

use super::{EVERYTHING, parse, said};

/// Reads, and checks what can be checked of any answer.
fn answer(text: &str, overrides: &[String]) {
    let overrides: Vec<_> = overrides.iter().map(|text| text.as_str().into()).collect();
    match parse(text, "scene.toml", Path::new(""), &overrides) {
        Err(error) => {
            assert!(!error.to_string().is_empty());
            let lines = text.matches('\n').count() + 1;
            assert!(error.line.is_none_or(|line| (1..=lines).contains(&(line as usize))));
        }
        Ok(loaded) => {
            // The written scene is the scene that was read.
            let again = parse(&loaded.scene.source, "again", Path::new(""), &[]);
            let again = again.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(said(&again.scene), said(&loaded.scene));
            for path in ["camera.up", "device.0.side", "", ".", "..."] {
                assert!(!loaded.locations.error_at(path, "wrong").to_string().is_empty());
            }
        }
    }
}

/// Pieces that scene files and overrides are made of.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("[camera]\n".to_owned()),
        Just("[[device]]\n".to_owned()),
        Just("kind = 'square-cloak'\n".to_owned()),
        prop::sample::select(vec![
            "position",
            "up",
            "samples",
            "projection",
            "width",
            "image",
            "rotation",
            "side",
            "color",
            "map",
            "device",
            "camera",
            "0",
            "1",
            "seed",
            "polarizer",
        ])
        .prop_map(str::to_owned),
        prop::sample::select(vec![
            " = ", ".", "=", "\n", "\r\n", "[", "]", "{", "}", ",", "'", "\"", "#", "\t",
            "\u{feff}", "é", "\0",
        ])
        .prop_map(str::to_owned),
        prop::sample::select(vec![
            "nan",
            "inf",
            "-1",
            "0",
            "4",
            "1e400",
            "-0.0",
            "1e-320",
            "[1, 2, 3]",
            "[0, 0, 0]",
            "99999999999999999999",
            "2024-01-01",
            "true",
            "'orthographic'",
            "0xff",
            "{}",
        ])
        .prop_map(str::to_owned),
        any::<f64>().prop_map(|number| format!("{number:?}")),
    ]
}

fn pieces(most: usize) -> impl Strategy<Value = String> {
    prop::collection::vec(piece(), 0..most).prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 512,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_text_is_answered(
        text in any::<String>(),
        overrides in prop::collection::vec(any::<String>(), 0..3),
    ) {
        answer(&text, &overrides);
        answer(EVERYTHING, &overrides);
    }

    #[test]
    fn text_made_of_the_right_pieces_is_answered(
        text in pieces(24),
        overrides in prop::collection::vec(pieces(6), 0..3),
    ) {
        answer(&text, &overrides);
        answer("", &overrides);
    }

    #[test]
    fn a_scene_with_a_piece_replaced_is_answered(
        start in 0..EVERYTHING.len(),
        length in 0_usize..12,
        inserted in pieces(4),
        overrides in prop::collection::vec(pieces(6), 0..2),
    ) {
        // The text is ASCII: every byte is a character.
        let end = (start + length).min(EVERYTHING.len());
        let text = format!("{}{inserted}{}", &EVERYTHING[..start], &EVERYTHING[end..]);
        answer(&text, &overrides);
    }

    #[test]
    fn any_number_in_any_place_is_answered(number in any::<f64>(), key in prop::sample::select(vec![
        "camera.field_of_view", "camera.position.0", "camera.target.0", "camera.up.0",
        "camera.width", "camera.seed", "camera.polarizer", "photograph.x", "photograph.width",
        "trace.min_power", "trace.tolerance", "device.0.rotation", "device.0.side",
    ])) {
        answer(EVERYTHING, &[format!("{key}={number:?}")]);
        answer("", &[format!("{key}={number:?}")]);
    }
}
