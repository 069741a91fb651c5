use super::*;

const KEYS: [&str; 4] = ["position", "target", "field_of_view", "resolution"];

#[test]
fn slips_abbreviations_and_spelling_are_recognized() {
    for (word, meant) in [
        ("positon", Some("position")),
        ("Position", Some("position")),
        ("pos", Some("position")),
        ("field-of-view", Some("field_of_view")),
        ("traget", Some("target")),
        ("resolutoin", Some("resolution")),
        ("po", None),
        ("banana", None),
        ("", None),
    ] {
        assert_eq!(nearest(word, KEYS), meant, "{word}");
    }
}

#[test]
fn long_words_are_not_compared() {
    assert_eq!(nearest(&"position".repeat(100_000), KEYS), None);
}

#[test]
fn a_hint_lists_what_is_known_where_nothing_is_near() {
    assert_eq!(hint("positon", &KEYS, "known keys"), "; did you mean `position`?");
    assert_eq!(hint("x", &["a", "bcd"], "known keys"), "; known keys: a, bcd");
    assert_eq!(hint("x", &[], "known keys"), "");
}
