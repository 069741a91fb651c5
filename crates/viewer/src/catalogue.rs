//! What a page is told first: the devices with their keys, scenes to begin with, and limits.

use crate::protocol::LARGEST_PHOTOGRAPH;
use crate::scenes::{Opened, tables};
use cloakroom::device::{CATALOGUE, Core, Entry, Imperfection, Request, Show};
use cloakroom::scene_file;
use cloakroom_figures::gallery::EXHIBITS;
use serde_json::{Map, Value, json};

/// What is around the scenes that a page offers.
const ROOM: &str = "builtin:room";

/// What a page is told first.
pub fn greeting(opened: &Opened) -> Value {
    let schema = scene_file::schema();
    let kinds: Map<String, Value> =
        CATALOGUE.iter().map(|entry| (entry.kind.to_owned(), kind(entry, &schema))).collect();
    // Objects of JSON have no order of their own.
    let order: Vec<&str> = CATALOGUE.iter().map(|entry| entry.kind).collect();
    let exhibits: Vec<Value> = EXHIBITS
        .iter()
        .filter_map(|exhibit| {
            let mut scene = tables(exhibit.scene).ok()?;
            // Who turns a device looks past the photograph: the paper's scenes do not say what is there.
            scene.entry("surroundings").or_insert_with(|| json!({ "image": ROOM }));
            let words = format!("{}. {}", exhibit.map, exhibit.reference);
            Some(json!({ "name": exhibit.name, "words": words, "scene": scene }))
        })
        .collect();
    json!({
        "hello": {
            "name": opened.name,
            "scene": opened.tables,
            "kinds": kinds,
            "order": order,
            "exhibits": exhibits,
            "maps": schema["properties"]["picture"]["properties"]["map"]["enum"],
            "largest_photograph_bytes": LARGEST_PHOTOGRAPH,
        }
    })
}

/// A kind of device: its keys as the schema of scene files describes them, and how it can be shown.
fn kind(entry: &Entry, schema: &Value) -> Value {
    let built = |show, core| {
        let request = Request { show, core, ..Request::default() };
        (entry.device)().build(request).ok()
    };
    let mut shows: Vec<&str> =
        [("cloak", Show::Cloak), ("bare", Show::Bare), ("mirror", Show::Mirror)]
            .into_iter()
            .filter(|(word, show)| *word == "cloak" || built(*show, Core::Metal).is_some())
            .map(|(word, _)| word)
            .collect();
    // What hides nothing is taken away by the page's view beside it.
    if shows.len() > 1 {
        shows.push("empty");
    }
    let keys: Vec<&str> = entry.keys.iter().map(|key| key.name).collect();
    // What cannot be built without keys of one's own may be imperfect.
    let is_imperfect = |built| Imperfection::default().apply(built, (0, 0)).is_ok();
    json!({
        "title": entry.title,
        "summary": entry.summary,
        "own_keys": keys,
        "keys": schema["$defs"][entry.kind]["properties"],
        "shows": shows,
        "core_can_be_open": built(Show::Cloak, Core::Open).is_some_and(|built| built.hull.filled.is_some()),
        "can_be_imperfect": built(Show::Cloak, Core::Metal).is_none_or(is_imperfect),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_greeting_describes_every_kind() {
        let loaded = scene_file::parse("", "a", Path::new(""), &[]).expect("a scene");
        let opened = Opened::new(&loaded, "a", Path::new("")).expect("tables");
        let hello = &greeting(&opened)["hello"];
        for entry in CATALOGUE {
            let kind = &hello["kinds"][entry.kind];
            assert!(kind["keys"]["rotation"]["default"].is_number(), "{}", entry.kind);
            for key in entry.keys {
                assert!(kind["keys"][key.name]["description"].is_string(), "{}", key.name);
            }
        }
        assert_eq!(
            hello["kinds"]["square-cloak"]["shows"],
            json!(["cloak", "bare", "mirror", "empty"])
        );
        assert_eq!(hello["kinds"]["square-cloak"]["core_can_be_open"], true);
        assert_eq!(hello["kinds"]["luneburg-lens"]["shows"], json!(["cloak"]));
        for (kind, can) in [
            ("square-cloak", true),
            ("double-gaussian-cloak", true),
            ("prisms", true),
            ("sphere-cloak", false),
            ("mirror", false),
        ] {
            assert_eq!(hello["kinds"][kind]["can_be_imperfect"], can, "{kind}");
        }
        let exhibits = hello["exhibits"].as_array().expect("exhibits");
        assert_eq!(exhibits.len(), EXHIBITS.len());
        let around = |exhibit: &Value| exhibit["scene"]["surroundings"]["image"] == ROOM;
        assert!(exhibits.iter().filter(|exhibit| around(exhibit)).count() + 4 > EXHIBITS.len());
    }
}
