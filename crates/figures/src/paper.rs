//! The figures of the paper: Halimeh & Wegener, "Photorealistic rendering of unidirectional
//! free-space invisibility cloaks", Opt. Express 21, 9457 (2013).
//!
//! Each panel is a scene file in `scenes/paper/`, carried along in the program.

/// A figure of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// What it shows.
    pub title: &'static str,
    /// Its panels, in order, one at least.
    pub panels: &'static [Panel],
}

/// A panel of a figure.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// The figure's number and the panel's letter, as in `6c`.
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

impl Figure {
    /// Its number, with which the names of its panels begin.
    #[must_use]
    pub fn number(&self) -> &'static str {
        self.panels[0].name.trim_end_matches(|c: char| c.is_ascii_alphabetic())
    }
}

impl Panel {
    /// The panel's letter.
    #[must_use]
    pub fn letter(&self) -> &'static str {
        self.name.trim_start_matches(|c: char| c.is_ascii_digit())
    }
}

/// A panel with the scene file that is named for it.
macro_rules! panel {
    ($name:literal, $caption:literal) => {
        panel!($name, $caption, Shows::Picture)
    };
    ($name:literal, $caption:literal, $shows:expr) => {
        Panel {
            name: $name,
            caption: $caption,
            file: concat!("paper/fig", $name, ".toml"),
            scene: include_str!(concat!("../scenes/paper/fig", $name, ".toml")),
            shows: $shows,
        }
    };
}

/// The figures, in the order of the paper.
pub static FIGURES: &[Figure] = &[
    Figure {
        title: "The setting, to scale",
        panels: &[
            panel!("1a", "square cloak, designs (i)-(iii)", Shows::Setting),
            panel!("1b", "double-Gaussian cloak, design (iv)", Shows::Setting),
        ],
    },
    Figure {
        title: "Positive uniaxial square cloak (i), along the transformation axis",
        panels: &[
            panel!("2a", "empty view"),
            panel!("2b", "bare metal"),
            panel!("2c", "cloaked, unpolarized"),
            panel!("2d", "cloaked, horizontal"),
            panel!("2e", "cloaked, vertical"),
        ],
    },
    Figure {
        title: "Positive uniaxial square cloak (i), turned about its axis",
        panels: &[
            panel!("3a", "bare metal, 5°"),
            panel!("3b", "cloaked, horizontal, 5°"),
            panel!("3c", "bare metal, 10°"),
            panel!("3d", "cloaked, horizontal, 10°"),
            panel!("3e", "bare metal, 20°"),
            panel!("3f", "cloaked, horizontal, 20°"),
        ],
    },
    Figure {
        title: "Negative uniaxial square cloak (ii), along the transformation axis",
        panels: &[
            panel!("4a", "empty view"),
            panel!("4b", "bare metal"),
            panel!("4c", "cloaked, unpolarized"),
            panel!("4d", "cloaked, horizontal"),
            panel!("4e", "cloaked, vertical"),
        ],
    },
    Figure {
        title: "Negative uniaxial square cloak (ii), turned about its axis",
        panels: &[
            panel!("5a", "bare metal, 5°"),
            panel!("5b", "cloaked, horizontal, 5°"),
            panel!("5c", "bare metal, 10°"),
            panel!("5d", "cloaked, horizontal, 10°"),
            panel!("5e", "bare metal, 20°"),
            panel!("5f", "cloaked, horizontal, 20°"),
        ],
    },
    Figure {
        title: "Impedance-matched square cloak (iii), along the transformation axis",
        panels: &[
            panel!("6a", "empty view"),
            panel!("6b", "bare metal"),
            panel!("6c", "cloaked"),
            panel!("6d", "time-of-flight difference, (c) less (a)"),
        ],
    },
    Figure {
        title: "Impedance-matched square cloak (iii), turned about its axis",
        panels: &[
            panel!("7a", "bare metal, 5°"),
            panel!("7b", "cloaked, 5°"),
            panel!("7c", "bare metal, 10°"),
            panel!("7d", "cloaked, 10°"),
            panel!("7e", "bare metal, 20°"),
            panel!("7f", "cloaked, 20°"),
        ],
    },
    Figure {
        title: "Double-Gaussian cloak (iv), along the transformation axis",
        panels: &[
            panel!("8a", "empty view"),
            panel!("8b", "bare metal"),
            panel!("8c", "cloaked"),
            panel!("8d", "time-of-flight difference, (c) less (a)"),
        ],
    },
    Figure {
        title: "Double-Gaussian cloak (iv), turned about its axis",
        panels: &[
            panel!("9a", "bare metal, 5°"),
            panel!("9b", "cloaked, 5°"),
            panel!("9c", "bare metal, 10°"),
            panel!("9d", "cloaked, 10°"),
            panel!("9e", "bare metal, 20°"),
            panel!("9f", "cloaked, 20°"),
        ],
    },
];

/// The panels that a list such as `6`, `8c` names, figure by figure in the order of the paper; all
/// of them for an empty list.
///
/// # Errors
///
/// A sentence if the list names something that is not there.
pub fn select(names: &[String]) -> Result<Vec<(&'static Figure, Vec<&'static Panel>)>, String> {
    let names: Vec<String> = names.iter().map(|name| name.trim().to_ascii_lowercase()).collect();
    let is =
        |name: &str, figure: &Figure, panel: &Panel| name == panel.name || name == figure.number();
    let any = |figure: &Figure, name: &str| figure.panels.iter().any(|p| is(name, figure, p));
    if let Some(name) = names.iter().find(|name| !FIGURES.iter().any(|f| any(f, name))) {
        let figures: Vec<&str> = FIGURES.iter().map(Figure::number).collect();
        return Err(format!(
            "there is no figure or panel `{name}`; there are the figures {} and their panels, \
             as in 6c",
            figures.join(", ")
        ));
    }
    let wanted = |figure: &Figure, panel: &Panel| {
        names.is_empty() || names.iter().any(|name| is(name, figure, panel))
    };
    let chosen = FIGURES
        .iter()
        .map(|figure| (figure, figure.panels.iter().filter(|p| wanted(figure, p)).collect()));
    Ok(chosen.filter(|(_, panels): &(_, Vec<_>)| !panels.is_empty()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_panel_is_a_sound_scene() {
        for panel in FIGURES.iter().flat_map(|figure| figure.panels) {
            let loaded = cloakroom::scene_file::parse(panel.scene, panel.name, Path::new(""), &[]);
            let scene = loaded.expect(panel.name).scene;
            cloakroom::render::assembly(&scene).expect(panel.name);
        }
    }

    #[test]
    fn figures_and_panels_are_selected() {
        let names = |list: &[&str]| {
            let list: Vec<String> = list.iter().map(|&name| name.to_owned()).collect();
            select(&list).map(|chosen| {
                chosen
                    .iter()
                    .flat_map(|(_, panels)| panels.iter().map(|p| p.name))
                    .collect::<Vec<_>>()
            })
        };
        assert_eq!(names(&["8c", "6"]), Ok(vec!["6a", "6b", "6c", "6d", "8c"]));
        assert_eq!(names(&[]).map(|all| all.len()), Ok(44));
        assert!(names(&["6x"]).is_err());
    }
}
