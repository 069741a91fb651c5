//! The example scenes: every file of the folder `scenes/`, carried along in the program.

use crate::gallery::EXHIBITS;
use crate::paper::{PANELS, Panel, TITLES};
use cloakroom::keys::{hint, nearest};

/// A scene file.
#[derive(Clone, Debug)]
pub struct Example {
    /// Where it is in `scenes/`, with `/` between folder and file.
    pub path: &'static str,
    /// What it shows.
    pub words: String,
    /// The scene, TOML.
    pub text: &'static str,
}

/// A scene file with what it shows.
macro_rules! other {
    ($file:literal => $words:literal) => {
        (concat!($file, ".toml"), $words, include_str!(concat!("../scenes/", $file, ".toml")))
    };
}

/// Scenes that are neither a panel of the paper nor an exhibit: path, words, text.
const OTHERS: [(&str, &str, &str); 17] = [
    other!("flux/solar-cell" => "For `cloakroom flux`: a contact on a solar cell, under a cloak"),
    other!("flux/window" => "For `cloakroom flux`: an advertising column before a window"),
    other!("real/calcite-carpet" =>
        "Two glued prisms of calcite hide a bump of a mirror, after Zhang et al. and Chen et al. 2011"),
    other!("real/calcite-carpet-in-liquid" =>
        "The same under a liquid of the index of the glass that it looks like"),
    other!("real/prism-cloak" =>
        "Glass prisms hide what stands in a hexagon from six directions, after Chen et al. 2013"),
    other!("real/water-cloak" =>
        "Tanks of water hide what stands in a square from four directions, after Zheng et al. 2014"),
    other!("real/four-mirrors" => "Four mirrors lead light over what they hide"),
    other!("real/mirror-box" => "A magician's cabinet: two mirrors hide what stands behind them"),
    other!("real/rochester-cloak" => "Four achromatic lenses that are empty space near their axis"),
    other!("real/rochester-cloak-singlets" => "The same of single lenses of BK7: its colors"),
    other!("real/glass-prism" => "A prism of heavy flint glass in daylight"),
    other!("real/newtons-colors" => "A wedge of quartz between crossed polarizers: Newton's colors"),
    other!("unmask/square-cloak" =>
        "A LIDAR finds the perfect cloak, design (iii): pulses take longer through it"),
    other!("unmask/double-gaussian-cloak" => "A LIDAR finds the double-Gaussian cloak, design (iv)"),
    other!("unmask/invisible-sphere" =>
        "A LIDAR finds the invisible sphere: pulses are late by its circumference"),
    other!("unmask/calcite-carpet" => "A LIDAR finds the calcite carpet"),
    other!("shop-window" =>
        "For `cloakroom animate`: a cloak with an open core that turns in a shop window"),
];

/// Cloak (iii) of the paper, turned by 10 degrees, in the room around its photograph: the scene to
/// begin with.
pub const FIRST: &str = concat!(
    include_str!("../scenes/paper/fig7d.toml"),
    "\n[surroundings]\nimage = \"builtin:room\"\n"
);

/// The example scene of that name, with or without its ending: `gallery/prisms`.
#[must_use]
pub fn named(name: &str) -> Option<Example> {
    let is_it = |path: &str| path == name || path.strip_suffix(".toml") == Some(name);
    all().into_iter().find(|example| is_it(example.path))
}

/// The end of a message about a scene of a name that is neither a file nor an example: what may be
/// meant. The name alone, without its folder, tells enough.
#[must_use]
pub fn meant_by(name: &str) -> String {
    let all = all();
    let known = all.iter().filter_map(|example| example.path.strip_suffix(".toml"));
    let bare = name.trim_end_matches(".toml");
    let is_meant = |path: &&str| path.rsplit_once('/').is_some_and(|(_, last)| last == bare);
    let meant = known.clone().find(is_meant).or_else(|| nearest(name, known));
    meant.map(|meant| format!("; did you mean `{meant}`?")).unwrap_or_default()
}

/// All example scenes: those of the paper, those of the gallery, the others.
#[must_use]
pub fn all() -> Vec<Example> {
    let panels = PANELS.iter().map(|Panel { figure, caption, file, scene, .. }| Example {
        path: file,
        words: format!("Figure {figure}, {}: {caption}", TITLES[figure - 1]),
        text: scene,
    });
    let exhibits = EXHIBITS.iter().filter(|exhibit| exhibit.file.starts_with("gallery/"));
    let exhibits = exhibits.map(|exhibit| Example {
        path: exhibit.file,
        words: format!("{}: {}", exhibit.title, exhibit.map),
        text: exhibit.scene,
    });
    let others = OTHERS.map(|(path, words, text)| Example { path, words: words.to_owned(), text });
    panels.chain(exhibits).chain(others).collect()
}

/// The scenes that a list names by file (`gallery/prisms.toml`, `.toml` or not) or by folder
/// (`gallery`), in the order of [`all`]; all of them for an empty list.
///
/// # Errors
///
/// A sentence if the list names something that is not there.
pub fn select(names: &[String]) -> Result<Vec<Example>, String> {
    let names: Vec<&str> = names.iter().map(|name| name.trim().trim_end_matches('/')).collect();
    let named = |example: &Example, name: &str| {
        let folder = example.path.strip_prefix(name).is_some_and(|rest| rest.starts_with('/'));
        folder || example.path.trim_end_matches(".toml") == name.trim_end_matches(".toml")
    };
    let examples = all();
    if let Some(name) = names.iter().find(|name| !examples.iter().any(|e| named(e, name))) {
        let mut known: Vec<&str> = examples.iter().map(|example| example.path).collect();
        known.extend(["paper", "gallery", "flux", "real", "unmask"]);
        let hint = hint(name, &known, "there are");
        return Err(format!("there is no example scene `{name}`{hint}"));
    }
    let wanted = |e: &Example| names.is_empty() || names.iter().any(|name| named(e, name));
    Ok(examples.into_iter().filter(wanted).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::fs;
    use std::path::Path;

    /// Adds the scene files of a folder: path within `scenes/`, text. The rooms are files of other programs.
    fn files(folder: &Path, prefix: &str, found: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = format!("{prefix}{}", path.file_name().expect("a name").display());
            if path.is_dir() {
                files(&path, &format!("{name}/"), found);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                found.insert(name, fs::read_to_string(&path).expect("a text"));
            }
        }
    }

    #[test]
    fn every_scene_file_of_the_folder_is_carried_along_once() {
        let mut there = BTreeMap::new();
        files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"), "", &mut there);
        let carried = all();
        assert_eq!(carried.len(), there.len());
        for example in carried {
            assert_eq!(there.get(example.path).map(String::as_str), Some(example.text));
        }
    }

    #[test]
    fn scenes_are_selected_by_file_and_folder() {
        let paths = |list: &[&str]| {
            let list: Vec<String> = list.iter().map(|&name| name.to_owned()).collect();
            select(&list).map(|chosen| chosen.iter().map(|e| e.path).collect::<Vec<_>>())
        };
        let chosen = paths(&["shop-window", "paper/fig1b.toml", "flux/"]);
        let expected =
            ["paper/fig1b.toml", "flux/solar-cell.toml", "flux/window.toml", "shop-window.toml"];
        assert_eq!(chosen, Ok(expected.to_vec()));
        assert_eq!(paths(&[]).map(|all| all.len()), Ok(all().len()));
        let message = paths(&["galery/prisms"]).expect_err("none of that name");
        assert!(message.contains("did you mean `gallery/prisms.toml`?"), "{message}");
    }
}
