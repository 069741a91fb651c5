//! Links lead somewhere.

use super::page::{pages, root};

#[test]
fn links_lead_somewhere() {
    let pages = pages();
    let mut broken = Vec::new();
    for page in &pages {
        let folder = page.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        for link in &page.links {
            if let Some((scheme, rest)) = link.split_once("://") {
                // Nothing is fetched.
                let host = rest.split('/').next().unwrap_or_default();
                let sound = ["http", "https"].contains(&scheme) && host.contains('.');
                if !sound || link.contains(char::is_whitespace) {
                    broken.push(format!("{}: {link} is no address", page.path));
                }
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.path.clone() } else { resolve(folder, file) };
            if !root().join(&target).exists() {
                broken.push(format!("{}: {link} is not there", page.path));
            }
            // The book holds docs/ alone.
            if page.path.starts_with("docs/") && !target.starts_with("docs/") {
                broken.push(format!("{}: {link} leaves the book", page.path));
            }
            let there = |page: &&super::page::Page| page.path == target;
            if !anchor.is_empty()
                && !pages.iter().find(there).is_some_and(|p| p.anchors.iter().any(|a| a == anchor))
            {
                broken.push(format!("{}: {link} has no such heading", page.path));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    let links: usize = pages.iter().map(|page| page.links.len()).sum();
    assert!(links > 100, "only {links} links were found");
}

/// The path of `link` as seen from `folder`.
fn resolve(folder: &str, link: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in link.split('/') {
        match part {
            ".." => {
                parts.pop();
            }
            "." | "" => {}
            part => parts.push(part),
        }
    }
    parts.join("/")
}
