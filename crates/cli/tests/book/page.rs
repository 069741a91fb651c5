//! Pages of Markdown, and what the tests need of them.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A page.
#[derive(Default)]
pub struct Page {
    /// Its path in the repository.
    pub path: String,
    /// Blocks of code: their language, their text.
    pub code: Vec<(String, String)>,
    /// Where its links and images lead.
    pub links: Vec<String>,
    /// The anchors of its headings.
    pub anchors: Vec<String>,
    /// Its sections, cut at every heading.
    pub sections: Vec<Section>,
}

/// What stands under a heading.
#[derive(Default)]
pub struct Section {
    pub title: String,
    pub images: Vec<String>,
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages of the book, and those beside it.
pub fn pages() -> Vec<Page> {
    let beside =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "python/README.md"];
    let mut paths: Vec<String> = beside.map(str::to_owned).to_vec();
    for folder in ["docs", "docs/devices"] {
        for file in fs::read_dir(root().join(folder)).unwrap() {
            let name = file.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") {
                paths.push(format!("{folder}/{name}"));
            }
        }
    }
    paths.sort();
    paths.into_iter().map(read).collect()
}

fn read(path: String) -> Page {
    let text = fs::read_to_string(root().join(&path)).unwrap();
    let mut page = Page { path, ..Page::default() };
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    let (mut heading, mut block) = (None::<String>, None::<(String, String)>);
    for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let title = heading.take().unwrap();
                let anchor = slug(&title);
                let before = times.entry(anchor.clone()).or_default();
                page.anchors.push(match *before {
                    0 => anchor,
                    n => format!("{anchor}-{n}"),
                });
                *before += 1;
                page.sections.push(Section { title, ..Section::default() });
            }
            Event::Start(Tag::CodeBlock(kind)) => {
                let language = match kind {
                    CodeBlockKind::Fenced(language) => language.to_string(),
                    CodeBlockKind::Indented => String::new(),
                };
                block = Some((language, String::new()));
            }
            Event::End(TagEnd::CodeBlock) => page.code.extend(block.take()),
            Event::Start(Tag::Link { dest_url, .. }) => page.links.push(dest_url.to_string()),
            Event::Start(Tag::Image { dest_url, .. }) => {
                page.links.push(dest_url.to_string());
                if let Some(section) = page.sections.last_mut() {
                    section.images.push(dest_url.to_string());
                }
            }
            Event::Text(text) | Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                } else if let Some((_, code)) = &mut block {
                    code.push_str(&text);
                }
            }
            _ => {}
        }
    }
    page
}

/// The anchor that mdBook and GitHub give a heading.
fn slug(title: &str) -> String {
    let kept = title.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}
