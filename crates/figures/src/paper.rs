//! The figures of the paper: Halimeh & Wegener, "Photorealistic rendering of unidirectional
//! free-space invisibility cloaks", Opt. Express 21, 9457 (2013).
//!
//! Each panel is a scene file in `scenes/paper/`, carried along in the program.

/// A panel of a figure.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// The number of its figure, from 1.
    pub figure: usize,
    /// Its letter.
    pub letter: &'static str,
    /// Both, as in `6c`.
    pub name: &'static str,
    /// A few words under the panel.
    pub caption: &'static str,
    /// Where its scene file is in `scenes/`.
    pub file: &'static str,
    /// Its scene file.
    pub scene: &'static str,
    /// What of the scene is shown.
    pub shows: Shows,
}

/// What a panel shows of its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// What the camera sees, rendered.
    Picture,
    /// Camera, devices and photograph, drawn.
    Setting,
}

/// A panel with the scene file that is named for it.
macro_rules! panel {
    ($figure:literal $letter:literal, $caption:literal) => {
        panel!($figure $letter, $caption, Shows::Picture)
    };
    ($figure:literal $letter:literal, $caption:literal, $shows:expr) => {
        Panel {
            figure: $figure,
            letter: $letter,
            name: concat!($figure, $letter),
            caption: $caption,
            file: concat!("paper/fig", $figure, $letter, ".toml"),
            scene: include_str!(concat!("../scenes/paper/fig", $figure, $letter, ".toml")),
            shows: $shows,
        }
    };
}

/// The titles of the figures, in the order of the paper.
pub static TITLES: [&str; 9] = [
    "The setting, to scale; distance and field of view of the camera are our assumption",
    "Positive uniaxial square cloak (i), along the transformation axis",
    "Positive uniaxial square cloak (i), turned about its axis",
    "Negative uniaxial square cloak (ii), along the transformation axis",
    "Negative uniaxial square cloak (ii), turned about its axis",
    "Impedance-matched square cloak (iii), along the transformation axis",
    "Impedance-matched square cloak (iii), turned about its axis",
    "Double-Gaussian cloak (iv), along the transformation axis",
    "Double-Gaussian cloak (iv), turned about its axis",
];

/// The panels of all figures, in the order of the paper.
pub static PANELS: &[Panel] = &[
    panel!(1 "a", "square cloak, designs (i)-(iii)", Shows::Setting),
    panel!(1 "b", "double-Gaussian cloak, design (iv)", Shows::Setting),
    panel!(2 "a", "empty view"),
    panel!(2 "b", "bare metal"),
    panel!(2 "c", "cloaked, unpolarized"),
    panel!(2 "d", "cloaked, horizontal"),
    panel!(2 "e", "cloaked, vertical"),
    panel!(3 "a", "bare metal, 5°"),
    panel!(3 "b", "cloaked, horizontal, 5°"),
    panel!(3 "c", "bare metal, 10°"),
    panel!(3 "d", "cloaked, horizontal, 10°"),
    panel!(3 "e", "bare metal, 20°"),
    panel!(3 "f", "cloaked, horizontal, 20°"),
    panel!(4 "a", "empty view"),
    panel!(4 "b", "bare metal"),
    panel!(4 "c", "cloaked, unpolarized"),
    panel!(4 "d", "cloaked, horizontal"),
    panel!(4 "e", "cloaked, vertical"),
    panel!(5 "a", "bare metal, 5°"),
    panel!(5 "b", "cloaked, horizontal, 5°"),
    panel!(5 "c", "bare metal, 10°"),
    panel!(5 "d", "cloaked, horizontal, 10°"),
    panel!(5 "e", "bare metal, 20°"),
    panel!(5 "f", "cloaked, horizontal, 20°"),
    panel!(6 "a", "empty view"),
    panel!(6 "b", "bare metal"),
    panel!(6 "c", "cloaked"),
    panel!(6 "d", "time-of-flight difference, (c) less (a)"),
    panel!(7 "a", "bare metal, 5°"),
    panel!(7 "b", "cloaked, 5°"),
    panel!(7 "c", "bare metal, 10°"),
    panel!(7 "d", "cloaked, 10°"),
    panel!(7 "e", "bare metal, 20°"),
    panel!(7 "f", "cloaked, 20°"),
    panel!(8 "a", "empty view"),
    panel!(8 "b", "bare metal"),
    panel!(8 "c", "cloaked"),
    panel!(8 "d", "time-of-flight difference, (c) less (a)"),
    panel!(9 "a", "bare metal, 5°"),
    panel!(9 "b", "cloaked, 5°"),
    panel!(9 "c", "bare metal, 10°"),
    panel!(9 "d", "cloaked, 10°"),
    panel!(9 "e", "bare metal, 20°"),
    panel!(9 "f", "cloaked, 20°"),
];

/// The panels that a list such as `6`, `8c` names, in the order of the paper; all of them for an
/// empty list.
///
/// # Errors
///
/// A sentence if the list names something that is not there.
pub fn select(names: &[String]) -> Result<Vec<&'static Panel>, String> {
    let names: Vec<String> = names.iter().map(|name| name.trim().to_ascii_lowercase()).collect();
    let is = |name: &str, panel: &Panel| name == panel.name || name == panel.figure.to_string();
    if let Some(name) = names.iter().find(|name| !PANELS.iter().any(|panel| is(name, panel))) {
        let figures: Vec<String> = (1..=TITLES.len()).map(|number| number.to_string()).collect();
        return Err(format!(
            "there is no figure or panel `{name}`; there are the figures {} and their panels, \
             as in 6c",
            figures.join(", ")
        ));
    }
    let wanted = |panel: &&Panel| names.is_empty() || names.iter().any(|name| is(name, panel));
    Ok(PANELS.iter().filter(wanted).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_panel_is_a_sound_scene() {
        for panel in PANELS {
            let loaded = cloakroom::scene_file::parse(panel.scene, panel.name, Path::new(""), &[]);
            let scene = loaded.expect(panel.name).scene;
            cloakroom::render::assembly(&scene).expect(panel.name);
        }
    }

    #[test]
    fn figures_and_panels_are_selected() {
        let names = |list: &[&str]| {
            let list: Vec<String> = list.iter().map(|&name| name.to_owned()).collect();
            select(&list).map(|chosen| chosen.iter().map(|p| p.name).collect::<Vec<_>>())
        };
        assert_eq!(names(&["8c", "6"]), Ok(vec!["6a", "6b", "6c", "6d", "8c"]));
        assert_eq!(names(&[]).map(|all| all.len()), Ok(44));
        assert!(names(&["6x"]).is_err());
    }
}
