//! Tests of values held against keys.

use super::*;
use crate::key;
use optics::medium::Tensor;
use std::path::{Path, PathBuf};

const SHELF: &str = "builtin:bookshelf";

crate::choice! {
    /// A choice.
    pub enum Look {
        /// The first.
        Cloak = "cloak",
        /// The second.
        Bare = "bare",
        /// The third.
        Mirror = "mirror",
    }
}

crate::choice! {
    /// Some of a few words.
    pub enum Channel {
        /// The first.
        Stokes = "stokes",
        /// The second.
        Power = "power",
    }
}

crate::table! {
    /// Of every kind of key one.
    /// In two lines.
    pub struct Everything {
        /// Length of a side,
        /// in two lines.
        side: f64 = 14.1, "cm", in ValueRange::LENGTH,
        /// Whole length.
        length: Option<f64>, "cm", in ValueRange::Positive,
        /// A ratio.
        kappa: f64 = 0.5, in ValueRange::Between(0.0, 1.0),
        /// Of which it matters whether it is given.
        power: Given<f64> = Given::by_default(0.25), in ValueRange::Within(0.0, 1.0),
        /// Samples.
        samples: u32 = 4, in ValueRange::Whole(1, 65_536),
        /// Seed.
        seed: u64, in ValueRange::SEED,
        /// A flag.
        rounded: bool,
        /// A choice.
        show: Look,
        /// Some of a few words.
        channels: Vec<Channel>,
        /// A vector.
        color: [f64; 3] = [0.0; 3], in ValueRange::Within(0.0, 255.0),
        /// A pair.
        resolution: [u32; 2] = [4, 3], in ValueRange::Whole(1, 65_536),
        /// An image.
        image: PathBuf = SHELF.into(),
        /// An image.
        sky: Option<PathBuf>,
        /// A tensor.
        permittivity: Tensor = 1.0.into(),
        /// Corners.
        corners: Option<Vec<[f64; 2]>>, "cm", in ValueRange::COORDINATE,
        /// Numbers on a grid.
        index: Option<Sampled>, in ValueRange::Between(0.0, 1000.0),
        /// A table.
        inner: Option<Inner>,
        /// Tables.
        list: Vec<Inner>,
    }
}

crate::table! {
    /// A table within.
    pub struct Inner {
        /// A size.
        size: f64 = 1.0, "cm", in ValueRange::Positive,
        /// A picture.
        picture: Option<PathBuf>,
    }
}

fn refusal(name: &str, value: impl Into<Value>) -> String {
    let mut table = Everything::default();
    let error = table.set(name, value.into()).expect_err(name);
    assert_eq!(error.key, Some(name));
    assert_eq!(table, Everything::default(), "a refused value changes nothing");
    error.message
}

fn grid() -> Value {
    Value::from([[1.0, 2.0], [3.0, 4.0]])
}

#[test]
fn the_declaration_gives_keys_and_defaults() {
    assert_eq!(Everything::SUMMARY, "Of every kind of key one. In two lines.");
    assert_eq!(Inner::SUMMARY, "A table within.");
    let side = &Everything::KEYS[0];
    assert_eq!((side.name, side.doc), ("side", "Length of a side, in two lines."));
    assert_eq!((side.unit, side.limits), ("cm", ValueRange::LENGTH));
    let table = Everything::default();
    assert_eq!((table.side, table.length, table.samples, table.seed), (14.1, None, 4, 0));
    assert_eq!(table.power, Given { value: 0.25, given: false });
    assert_eq!((table.show, table.channels.len(), table.resolution), (Look::Cloak, 0, [4, 3]));
    assert_eq!((table.image.to_str(), &table.sky), (Some(SHELF), &None));
    for key in Everything::KEYS {
        assert_eq!(table.get(key.name), (key.default)(), "{}", key.name);
    }
    assert_eq!(key!(Everything.side), "side");
}

#[test]
fn given_values_come_back() {
    let mut table = Everything::default();
    let inner = |size: Value| Value::Table(vec![("size".to_owned(), size)]);
    let given: [(&str, Value, Value); 17] = [
        ("side", 3_i64.into(), 3.0.into()),
        ("length", 2.5.into(), 2.5.into()),
        ("power", 0.25.into(), 0.25.into()),
        ("samples", 16.0.into(), 16_i64.into()),
        ("seed", i64::MAX.into(), i64::MAX.into()),
        ("rounded", true.into(), true.into()),
        ("show", "bare".into(), "bare".into()),
        ("channels", ["power"].into(), ["power"].into()),
        ("color", [1_i64, 0, 2].into(), [1.0, 0.0, 2.0].into()),
        ("resolution", [640_i64, 480].into(), [640_i64, 480].into()),
        ("image", "a.png".into(), "a.png".into()),
        ("sky", "b.png".into(), "b.png".into()),
        ("permittivity", [2_i64, 1].into(), [2.0, 1.0].into()),
        (
            "corners",
            [[0.0; 2], [1.0, 0.0], [0.0, 1.0]].into(),
            [[0.0; 2], [1.0, 0.0], [0.0, 1.0]].into(),
        ),
        ("index", grid(), grid()),
        ("inner", inner(2_i64.into()), inner(2.0.into())),
        ("list", Value::List(vec![inner(3_i64.into())]), Value::List(vec![inner(3.0.into())])),
    ];
    for (name, value, expected) in given {
        table.set(name, value).expect(name);
        assert_eq!(table.get(name), Some(expected), "{name}");
    }
    assert_eq!(table.power, 0.25.into());
    assert_eq!((table.show, table.channels.as_slice()), (Look::Bare, &[Channel::Power][..]));
    assert_eq!((table.seed, table.resolution), (i64::MAX as u64, [640, 480]));
    assert_eq!(table.inner, Some(Inner { size: 2.0, picture: None }));
    // What is written is the table.
    let mut again = Everything::default();
    for (name, value) in table.written() {
        again.set(&name, value).expect("as it was written");
    }
    assert_eq!(again, table);
    assert_eq!(table.check(), Ok(()));
}

#[test]
fn a_struct_is_held_against_its_keys() {
    let good = Everything::default();
    assert_eq!(good.check(), Ok(()));
    let message = |table: Everything| table.check().expect_err("refused").message;
    let bad = Everything { side: -3.0, ..good.clone() };
    assert_eq!(message(bad), "side is -3 cm; it must be from 1e-6 to 1000000");
    let bad = Everything { power: f64::NAN.into(), ..good.clone() };
    assert_eq!(message(bad), "power is not a number (nan); numbers must be finite");
    let bad = Everything { list: vec![Inner { size: 0.0, picture: None }], ..good.clone() };
    assert_eq!(message(bad), "in list: size is 0 cm; it must be above 0");
    let samples = Samples::new(&[vec![1.0, 2.0], vec![3.0, 0.0]]).expect("a grid");
    let bad = Everything { index: Some(Sampled::Here(samples)), ..good };
    assert_eq!(message(bad), "index[1][1] is 0; it must be above 0 and below 1000");
}

#[test]
fn files_are_shown_with_their_keys() {
    let inner = || Inner { picture: Some("a.png".into()), ..Inner::default() };
    let mut table = Everything {
        sky: Some("b.png".into()),
        index: Some(Sampled::InFile("c.npy".into())),
        inner: Some(inner()),
        list: vec![inner()],
        ..Everything::default()
    };
    let mut shown = Vec::new();
    table.visit_files("t", &mut |path, file| {
        shown.push(path.to_owned());
        *file.path = Path::new("folder").join(&*file.path);
    });
    assert_eq!(shown, ["t.sky", "t.index", "t.inner.picture", "t.list.0.picture"]);
    assert_eq!(table.list[0].picture.as_deref(), Some(Path::new("folder/a.png")));
    assert_eq!(table.image.to_str(), Some(SHELF));
}

#[test]
fn a_refusal_names_quantity_value_unit_and_what_is_allowed() {
    assert_eq!(refusal("side", -3.0), "side is -3 cm; it must be from 1e-6 to 1000000");
    assert_eq!(refusal("side", 1e308), "side is 1e308 cm; it must be from 1e-6 to 1000000");
    assert_eq!(refusal("length", 0.0), "length is 0 cm; it must be above 0");
    for range in ["0..20:5", "-1.5..2"] {
        let told = refusal("kappa", range);
        assert!(
            told.ends_with(
                "one alone; a range is for --sweep, of `cloakroom quality` and `animate`"
            ),
            "{told}"
        );
    }
    assert!(!refusal("kappa", "../20").contains("--sweep"));
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
        "there is no built-in image `builtin:bookself`; there is `builtin:bookshelf`, `builtin:room`"
    );
    assert_eq!(
        refusal("show", "bear"),
        r#"show is "bear"; it must be "cloak", "bare" or "mirror"; did you mean "bare"?"#
    );
    assert_eq!(
        refusal("channels", ["power", "stoke"]),
        r#"channels holds "stoke"; it must be a list of words, each "stokes" or "power"; did you mean "stokes"?"#
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
    for key in Everything::KEYS {
        refusal(key.name, deep.clone());
    }
}

#[test]
fn numbers_must_be_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for name in ["side", "length", "kappa", "power"] {
            assert!(refusal(name, bad).ends_with("numbers must be finite"), "{name}");
        }
        assert!(refusal("color", [0.0, bad, 0.0]).ends_with("numbers must be finite"));
        refusal("samples", bad);
    }
}

#[test]
fn limits_include_their_ends_where_they_say_so() {
    assert!(!ValueRange::Positive.allow(0.0) && ValueRange::Positive.allow(f64::MIN_POSITIVE));
    assert!(ValueRange::LENGTH_OR_ZERO.allow(0.0) && !ValueRange::LENGTH_OR_ZERO.allow(-1e-300));
    assert!(
        ValueRange::LENGTH.allow(1e-6)
            && !ValueRange::LENGTH.allow(9e-7)
            && !ValueRange::LENGTH.allow(2e6)
    );
    assert!(ValueRange::COORDINATE.allow(-1e6) && !ValueRange::COORDINATE.allow(-2e6));
    assert!(!ValueRange::Between(0.0, 1.0).allow(0.0) && !ValueRange::Between(0.0, 1.0).allow(1.0));
    assert!(ValueRange::Within(0.0, 1.0).allow(0.0) && ValueRange::Within(0.0, 1.0).allow(1.0));
    assert!(!ValueRange::Finite.allow(f64::NAN) && !ValueRange::Finite.allow(f64::INFINITY));
}

#[test]
fn an_unknown_key_names_the_nearest() {
    let mut table = Everything::default();
    let error = table.set("sied", 1.0.into()).expect_err("unknown");
    assert_eq!(error.key, None);
    assert_eq!(error.message, "unknown key `sied`; did you mean `side`?");
    let error = table.set("banana", 1.0.into()).expect_err("unknown");
    assert!(error.message.starts_with("unknown key `banana`; known keys: side, length, kappa"));
}
