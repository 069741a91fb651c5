//! Tests of values held against keys.

use super::*;
use crate::photograph::ImageSource;

const SHELF: &str = "builtin:bookshelf";

static KEYS: &[Key] = &[
    Key {
        name: "side",
        doc: "Length of a side.",
        kind: KeyKind::Number { default: Some(14.1), unit: "cm", limits: Limits::LENGTH },
    },
    Key {
        name: "length",
        doc: "Whole length.",
        kind: KeyKind::Number { default: None, unit: "cm", limits: Limits::Positive },
    },
    Key {
        name: "kappa",
        doc: "A ratio.",
        kind: KeyKind::Number { default: Some(0.5), unit: "", limits: Limits::Between(0.0, 1.0) },
    },
    Key {
        name: "samples",
        doc: "Samples.",
        kind: KeyKind::Integer { default: 4, min: 1, max: 65536 },
    },
    Key {
        name: "seed",
        doc: "Seed.",
        kind: KeyKind::Integer { default: 0, min: 0, max: i64::MAX },
    },
    Key { name: "rounded", doc: "A flag.", kind: KeyKind::Flag { default: false } },
    Key {
        name: "show",
        doc: "A choice.",
        kind: KeyKind::Choice { options: &["cloak", "bare", "mirror"] },
    },
    Key {
        name: "channels",
        doc: "Some of a few words.",
        kind: KeyKind::Choices { options: &["stokes", "power"] },
    },
    Key {
        name: "color",
        doc: "A vector.",
        kind: KeyKind::Vector { default: [0.0; 3], unit: "", limits: Limits::Within(0.0, 255.0) },
    },
    Key {
        name: "resolution",
        doc: "A pair.",
        kind: KeyKind::IntegerPair { default: [4, 3], min: 1, max: 65536 },
    },
    Key { name: "image", doc: "An image.", kind: KeyKind::Image { default: Some(SHELF) } },
    Key { name: "sky", doc: "An image.", kind: KeyKind::Image { default: None } },
    Key {
        name: "polarizer",
        doc: "A word or an angle.",
        kind: KeyKind::ChoiceOrNumber { options: &["none", "horizontal"], unit: "degrees" },
    },
];

fn refusal(name: &str, value: impl Into<Value>) -> String {
    let mut values = Values::defaults(KEYS);
    let before = values.get(name);
    let error = values.set(name, value).expect_err(name);
    assert_eq!(error.key, Some(name));
    assert_eq!(values.get(name), before, "a refused value changes nothing");
    assert!(!values.is_given(name));
    error.message
}

#[test]
fn absent_keys_have_their_defaults() {
    let values = Values::defaults(KEYS);
    assert_eq!(values.number("side"), 14.1);
    assert_eq!(values.optional_number("side"), Some(14.1));
    assert_eq!(values.optional_number("length"), None);
    assert_eq!(values.integer("samples"), 4);
    assert!(!values.flag("rounded"));
    assert_eq!(values.choice("show"), "cloak");
    assert!(values.choices("channels").is_empty());
    assert_eq!(values.vector("color"), [0.0; 3]);
    assert_eq!(values.integer_pair("resolution"), [4, 3]);
    assert_eq!(values.image("image").to_string(), SHELF);
    assert_eq!(values.optional_image("sky"), None);
    assert_eq!(values.choice_or_number("polarizer"), ChoiceOrNumber::Choice("none"));
    assert!(KEYS.iter().all(|key| !values.is_given(key.name)));
}

#[test]
fn given_values_come_back() {
    let mut values = Values::defaults(KEYS);
    let given: [(&str, Value); 11] = [
        ("side", 3_i64.into()),
        ("length", 2.5.into()),
        ("samples", 16.0.into()),
        ("rounded", true.into()),
        ("show", "bare".into()),
        ("channels", ["power"].into()),
        ("color", Value::List(vec![1.0.into(), 0_i64.into(), 0.5.into()])),
        ("resolution", [640_i64, 480].into()),
        ("image", "a.png".into()),
        ("sky", "b.png".into()),
        ("polarizer", 30_i64.into()),
    ];
    for (name, value) in given {
        values.set(name, value).expect(name);
        assert!(values.is_given(name));
    }
    assert_eq!(values.number("side"), 3.0);
    assert_eq!(values.optional_number("length"), Some(2.5));
    assert_eq!(values.integer("samples"), 16);
    assert!(values.flag("rounded"));
    assert_eq!(values.choice("show"), "bare");
    assert_eq!(values.choices("channels"), ["power"]);
    assert_eq!(values.vector("color"), [1.0, 0.0, 0.5]);
    assert_eq!(values.integer_pair("resolution"), [640, 480]);
    assert_eq!(values.image("image"), &ImageSource::File("a.png".into()));
    assert_eq!(values.optional_image("sky"), Some(&ImageSource::File("b.png".into())));
    assert_eq!(values.choice_or_number("polarizer"), ChoiceOrNumber::Number(30.0));
    // What `get` returns can be set again.
    let copy = values.clone();
    for key in KEYS {
        if let Some(value) = copy.get(key.name) {
            values.set(key.name, value).expect(key.name);
        }
    }
}

#[test]
fn a_refusal_names_quantity_value_unit_and_what_is_allowed() {
    assert_eq!(refusal("side", -3.0), "side is -3 cm; it must be from 1e-6 to 1000000");
    assert_eq!(refusal("side", 1e308), "side is 1e308 cm; it must be from 1e-6 to 1000000");
    assert_eq!(refusal("length", 0.0), "length is 0 cm; it must be above 0");
    assert_eq!(refusal("kappa", 1.0), "kappa is 1; it must be above 0 and below 1");
    assert_eq!(refusal("samples", 0_i64), "samples is 0; it must be from 1 to 65536");
    assert_eq!(refusal("samples", 1.5), "samples is 1.5; it must be a whole number");
    assert_eq!(refusal("seed", -1_i64), "seed is -1; it must be 0 or above");
    assert_eq!(
        refusal("color", [0.0, -1.0, 0.0]),
        "the second component of color is -1; it must be from 0 to 255"
    );
    assert_eq!(
        refusal("resolution", [1024_i64, 100_000]),
        "the second number of resolution is 100000; it must be from 1 to 65536"
    );
    assert_eq!(refusal("image", ""), "image is empty");
    assert_eq!(
        refusal("sky", "builtin:bookself"),
        "there is no built-in image `builtin:bookself`; there is `builtin:bookshelf`"
    );
    assert_eq!(
        refusal("show", "bear"),
        r#"show is "bear"; it must be "cloak", "bare" or "mirror"; did you mean "bare"?"#
    );
    assert_eq!(
        refusal("channels", ["power", "stoke"]),
        r#"channels holds "stoke"; it must be a list of words, each "stokes" or "power"; did you mean "stokes"?"#
    );
    assert_eq!(
        refusal("polarizer", true),
        r#"polarizer is true; it must be "none", "horizontal" or a number (degrees)"#
    );
}

#[test]
fn a_wrong_type_is_refused_by_every_key() {
    assert_eq!(refusal("side", "big"), r#"side is "big"; it must be a number (cm)"#);
    assert_eq!(refusal("rounded", 1_i64), "rounded is 1; it must be true or false");
    assert_eq!(refusal("image", 5_i64), "image is 5; it must be the name of an image");
    assert_eq!(refusal("color", [1.0, 2.0]), "color is [1, 2]; it must be three numbers");
    assert_eq!(refusal("color", Value::List(vec![])), "color is []; it must be three numbers");
    assert_eq!(
        refusal("resolution", [1.5, 2.0]),
        "resolution is [1.5, 2]; it must be two whole numbers"
    );
    let deep = (0..1000).fold(Value::from(1.0), |value, _| Value::List(vec![value]));
    for key in KEYS {
        refusal(key.name, deep.clone());
    }
}

#[test]
fn numbers_must_be_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for name in ["side", "length", "kappa", "polarizer"] {
            assert!(refusal(name, bad).ends_with("numbers must be finite"), "{name}");
        }
        assert!(refusal("color", [0.0, bad, 0.0]).ends_with("numbers must be finite"));
        refusal("samples", bad);
    }
}

#[test]
fn limits_include_their_ends_where_they_say_so() {
    assert!(!Limits::Positive.allow(0.0) && Limits::Positive.allow(f64::MIN_POSITIVE));
    assert!(Limits::LENGTH_OR_ZERO.allow(0.0) && !Limits::LENGTH_OR_ZERO.allow(-1e-300));
    assert!(
        Limits::LENGTH.allow(1e-6) && !Limits::LENGTH.allow(9e-7) && !Limits::LENGTH.allow(2e6)
    );
    assert!(Limits::COORDINATE.allow(-1e6) && !Limits::COORDINATE.allow(-2e6));
    assert!(!Limits::Between(0.0, 1.0).allow(0.0) && !Limits::Between(0.0, 1.0).allow(1.0));
    assert!(Limits::Within(0.0, 1.0).allow(0.0) && Limits::Within(0.0, 1.0).allow(1.0));
    assert!(!Limits::Finite.allow(f64::NAN) && !Limits::Finite.allow(f64::INFINITY));
}

#[test]
fn an_unknown_key_names_the_nearest() {
    let mut values = Values::defaults(KEYS);
    let error = values.set("sied", 1.0).expect_err("unknown");
    assert_eq!(error.key, None);
    assert_eq!(error.message, "unknown key `sied`; did you mean `side`?");
    let error = values.set("banana", 1.0).expect_err("unknown");
    assert!(error.message.starts_with("unknown key `banana`; known keys: side, length, kappa"));
}

#[test]
#[should_panic(expected = "`banana` is not a key of this table")]
fn asking_for_a_key_that_is_not_there_is_a_programming_error() {
    Values::defaults(KEYS).number("banana");
}

#[test]
#[should_panic(expected = "`length` is not a number with a default")]
fn asking_for_a_number_without_default_is_a_programming_error() {
    let mut values = Values::defaults(KEYS);
    values.set("length", 1.0).expect("allowed");
    values.number("length");
}
