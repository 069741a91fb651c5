//! The book and the README hold what they promise: every command runs, every scene is sound, every
//! link leads somewhere, and the pages agree with the program.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod commands;
mod links;
mod page;

use crate::running::{cloakroom, json, stdout};
use page::{pages, root};
use std::collections::BTreeSet;
use std::fs;

#[test]
fn the_scene_reference_is_that_of_the_program() {
    let written = fs::read_to_string(root().join("docs/scene-reference.md")).unwrap();
    let printed = String::from_utf8(stdout(cloakroom().args(["schema", "--markdown"]))).unwrap();
    assert!(
        written == printed,
        "make it again: cloakroom schema --markdown > docs/scene-reference.md"
    );
}

#[test]
fn every_page_is_in_the_summary_once() {
    let pages = pages();
    let summary = pages.iter().find(|page| page.path == "docs/SUMMARY.md").unwrap();
    let listed: Vec<String> = summary.links.iter().map(|link| format!("docs/{link}")).collect();
    let unique: BTreeSet<&str> = listed.iter().map(String::as_str).collect();
    assert_eq!(listed.len(), unique.len(), "a page is listed twice");
    let book = pages.iter().map(|page| page.path.as_str()).filter(|path| path.starts_with("docs/"));
    let there: BTreeSet<&str> = book.filter(|path| *path != "docs/SUMMARY.md").collect();
    assert_eq!(unique, there);
}

#[test]
fn every_device_has_its_section_with_a_picture() {
    let devices = json(&stdout(cloakroom().args(["devices", "--json"])));
    let pages = pages();
    let sections: Vec<_> = pages
        .iter()
        .filter(|page| page.path.starts_with("docs/devices/"))
        .flat_map(|page| &page.sections)
        .collect();
    for device in devices["devices"].as_array().unwrap() {
        let kind = device["kind"].as_str().unwrap();
        let words = |title: &str| title.split(&[' ', ',', ':'][..]).any(|word| word == kind);
        let mut named = sections.iter().filter(|section| words(&section.title));
        assert!(
            named.any(|section| !section.images.is_empty()),
            "no section and picture of {kind}"
        );
    }
}

#[test]
fn pictures_of_devices_are_small_and_used() {
    let used: BTreeSet<String> = pages()
        .iter()
        .filter(|page| page.path.starts_with("docs/devices/"))
        .flat_map(|page| page.sections.iter().flat_map(|section| section.images.clone()))
        .collect();
    for file in fs::read_dir(root().join("docs/devices")).unwrap() {
        let file = file.unwrap();
        let name = file.file_name().into_string().unwrap();
        if name.ends_with(".md") {
            continue;
        }
        assert!(used.contains(&name), "{name} is on no page");
        assert!(file.metadata().unwrap().len() < 60_000, "{name} is large");
    }
}
