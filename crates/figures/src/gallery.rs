//! The gallery: a picture of every transformation-optics device that the program knows.
//!
//! Its first rows are those of the table that closes Halimeh & Wegener, Opt. Express 21, 9457
//! (2013), in its order and with its references to who rendered them first; then come the devices
//! that the paper names in passing, the classics, and devices of one's own. Each is a scene file in
//! `scenes/gallery/` or `scenes/paper/`, carried along in the program.

use cloakroom::keys::hint;

/// One row of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct Exhibit {
    /// What its files are called.
    pub name: &'static str,
    /// What kind of device it is.
    pub title: &'static str,
    /// The map or the material behind it.
    pub map: &'static str,
    /// Whether it works for one polarization alone, `dependent`, or for any.
    pub polarization: &'static str,
    /// From where it works: `omni`, `uni`, or in words.
    pub direction: &'static str,
    /// Where it was rendered, or described, before.
    pub reference: &'static str,
    /// Where its scene file is in `scenes/`.
    pub file: &'static str,
    /// Its scene file.
    pub scene: &'static str,
}

impl Exhibit {
    /// What is said about it beside its title: a word for it, and what there is to say.
    #[must_use]
    pub fn words(&self) -> [(&'static str, &'static str); 4] {
        [
            ("", self.map),
            ("Polarization:", self.polarization),
            ("Direction:", self.direction),
            ("Ref.:", self.reference),
        ]
    }
}

/// The title of the whole.
pub const TITLE: &str = "Transformation optics: what it looks like, and how long light takes";

/// An exhibit with its scene file, which is in `gallery/` and named for it unless it says
/// otherwise.
macro_rules! exhibit {
    ($name:literal => $($words:literal),*) => {
        exhibit!($name in concat!("gallery/", $name) => $($words),*)
    };
    ($name:literal in $file:expr => $title:literal, $map:literal,
     $polarization:literal, $direction:literal, $reference:literal) => {
        Exhibit {
            name: $name,
            title: $title,
            map: $map,
            polarization: $polarization,
            direction: $direction,
            reference: $reference,
            file: concat!($file, ".toml"),
            scene: include_str!(concat!("../scenes/", $file, ".toml")),
        }
    };
}

/// All exhibits in their order.
pub static EXHIBITS: &[Exhibit] = &[
    exhibit!("quasi-conformal-carpet" => "Carpet cloak", "Quasi-conformal map, graded index",
        "independent", "omni", "Halimeh et al., Opt. Express 17, 19328 (2009)"),
    exhibit!("gaussian-carpet" => "Carpet cloak", "Conformal map, graded index",
        "independent", "omni", "Halimeh, Schmied & Wegener, Opt. Express 19, 6078 (2011)"),
    exhibit!("grating-carpet" => "Carpet cloak", "Periodic grating cloak, graded index",
        "independent", "omni", "Halimeh, Schmied & Wegener, Opt. Express 19, 6078 (2011)"),
    exhibit!("cylinder-cloak" => "Free-space cloak", "Impedance matched, cylindrical",
        "independent", "omni", "Halimeh & Wegener, Opt. Express 20, 63 (2012)"),
    exhibit!("cylinder-cloak-radial" => "Free-space cloak",
        "Uniaxial dielectric, cylindrical, optic axis along the radius",
        "dependent", "omni", "Halimeh & Wegener, Opt. Express 20, 28330 (2012)"),
    exhibit!("cylinder-cloak-azimuthal" => "Free-space cloak",
        "Uniaxial dielectric, cylindrical, optic axis around the cylinder",
        "dependent", "omni", "Halimeh & Wegener, Opt. Express 20, 28330 (2012)"),
    exhibit!("square-cloak-positive-uniaxial" in "paper/fig2c" => "Free-space cloak (i)",
        "Homogeneous pieces, birefringent magnetic, cuboidal, positive uniaxial",
        "dependent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("square-cloak-negative-uniaxial" in "paper/fig4c" => "Free-space cloak (ii)",
        "Homogeneous pieces, birefringent magnetic, cuboidal, negative uniaxial",
        "dependent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("square-cloak" in "paper/fig7d" => "Free-space cloak (iii)",
        "Homogeneous pieces, impedance matched, cuboidal; here turned by 10°",
        "independent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("double-gaussian-cloak" in "paper/fig8c" => "Free-space cloak (iv)", "Conformal map, graded index, cuboidal",
        "independent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("invisible-sphere-regularized" => "360-degree sphere", "\"Invisible sphere\", regularized",
        "dependent", "omni", "Danner, Opt. Express 18, 3332 (2010)"),
    exhibit!("invisible-sphere" => "360-degree sphere", "\"Invisible sphere\", graded index",
        "independent", "omni", "Halimeh & Wegener, Opt. Express 20, 63 (2012)"),
    exhibit!("bending-sphere" => "90-degree sphere", "Graded index",
        "independent", "omni", "Halimeh et al., Phys. Unserer Zeit 41, 170 (2010)"),
    exhibit!("rod-in-water" => "Rod in water", "Homogeneous pieces, n = 1.3; for comparison",
        "independent", "omni", "Dolling et al., Opt. Express 14, 1842 (2006)"),
    exhibit!("rod-in-negative-water" => "Negative-index materials", "Homogeneous pieces: a rod in a liquid of n = -1.3",
        "independent", "omni", "Dolling et al., Opt. Express 14, 1842 (2006)"),
    exhibit!("rod-in-matched-negative-water" => "Negative-index materials",
        "Homogeneous pieces: a rod in a liquid of n = -1, impedance matched",
        "independent", "omni", "Dolling et al., Opt. Express 14, 1842 (2006)"),
    exhibit!("bodies" => "Negative-index materials", "Homogeneous balls of n = 1.5, -1.3 and -1, and a box that absorbs",
        "independent", "omni", "Danner, Opt. Express 18, 3332 (2010)"),
    exhibit!("lens" => "Lenses", "Two conic faces of glass: one that magnifies, one that makes small, a doublet",
        "independent", "omni", "textbooks"),
    exhibit!("polyhedron" => "Solids with flat faces", "A diamond in the single cut, an octahedron of glass, a wedge of silver",
        "independent", "any", "textbooks"),
    exhibit!("mirror" => "Plane mirrors", "A periscope of silver; a ball of gold, a perfectly reflecting box",
        "independent", "any", "textbooks"),
    exhibit!("mirror-detour-orthographic" => "Cloak of plane mirrors", "A detour in air; seen along parallel rays",
        "independent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("mirror-detour-perspective" => "Cloak of plane mirrors", "A detour in air; seen in perspective",
        "independent", "uni", "Halimeh & Wegener, Opt. Express 21, 9457 (2013)"),
    exhibit!("sphere-cloak" => "Free-space cloak", "Impedance matched, spherical",
        "independent", "omni", "Pendry, Schurig & Smith, Science 312, 1780 (2006)"),
    exhibit!("eaton-lens" => "Eaton lens", "Graded index: light returns",
        "independent", "omni", "Eaton, Trans. IRE Antennas Propag. 4, 66 (1952)"),
    exhibit!("luneburg-lens" => "Luneburg lens", "Graded index: parallel light meets on the far rim",
        "independent", "omni", "Luneburg, Mathematical Theory of Optics (1944)"),
    exhibit!("fisheye-lens" => "Maxwell's fish-eye", "Graded index: each point has its image opposite",
        "independent", "omni", "Maxwell, Camb. Dublin Math. J. 8, 188 (1854)"),
    exhibit!("fisheye-hemisphere" => "Half of Maxwell's fish-eye", "Graded index: parallel light onto the cut meets on the round side",
        "independent", "from the cut", "Maxwell, Camb. Dublin Math. J. 8, 188 (1854)"),
    exhibit!("quartz-wedge" => "Wedge between crossed polarizers", "Quartz, 0 to 0.6 mm: ten orders in a line of 10 nm",
        "dependent", "any", "this program"),
    exhibit!("open-core" => "Free-space cloak (iii), open", "Air in the hidden region, and a red ball; turned by 14°",
        "independent", "uni", "this program"),
    exhibit!("prisms" => "Device of one's own", "Prisms of any tensors: here those of cloak (iii), turned by 10°",
        "any", "any", "this program"),
    exhibit!("prisms-on-floor" => "Carpet of one's own", "Prisms of any tensors on a mirror floor: here over a triangle of metal",
        "independent", "omni", "this program"),
    exhibit!("graded" => "Device of one's own", "Any graded index: here a rod whose n² falls as a parabola",
        "independent", "any", "this program"),
    exhibit!("graded-3d" => "Device of one's own", "Any graded index in space: here a ball whose n² falls as a parabola",
        "independent", "omni", "this program"),
    exhibit!("graded-box" => "Graded box", "n² grows evenly along a direction: rays are parabolas",
        "independent", "any", "Born & Wolf, Principles of Optics, section 3.2"),
    exhibit!("crossed-cloaks" => "Free-space cloaks (iii) crosswise",
        "One with its axis across the picture, one upright behind it", "independent", "uni", "this program"),
    exhibit!("standing-cylinder-cloak" => "Free-space cloak, standing",
        "Impedance matched, cylindrical, upright in the picture and with ends",
        "independent", "from the side", "this program"),
    exhibit!("carpet-in-glass" => "Carpet cloak in glass", "A Gaussian carpet on its floor within a block of n = 1.5",
        "independent", "uni", "this program"),
    exhibit!("tilted-box" => "Tilted box", "Homogeneous glass, n = 1.5; for comparison",
        "independent", "any", "this program"),
    exhibit!("coated-panes" => "Coated panes", "Glass of n = 1.9: bare, with a quarter wave of √n, with 10 nm of silver",
        "dependent", "any", "this program"),
];

/// The exhibits that a list names, in the order of the gallery; all of them for an empty list.
///
/// # Errors
///
/// A sentence if the list names something that is not there.
pub fn select(names: &[String]) -> Result<Vec<&'static Exhibit>, String> {
    let names: Vec<String> = names.iter().map(|name| name.trim().to_ascii_lowercase()).collect();
    let known: Vec<&str> = EXHIBITS.iter().map(|exhibit| exhibit.name).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        let hint = hint(name, &known, "there are");
        return Err(format!("there is no exhibit `{name}`{hint}"));
    }
    let wanted = |exhibit: &&Exhibit| names.is_empty() || names.iter().any(|n| n == exhibit.name);
    Ok(EXHIBITS.iter().filter(wanted).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::device::CATALOGUE;
    use cloakroom::render::PreparedScene;
    use cloakroom::scene_file;
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn every_kind_of_device_is_there_and_every_scene_is_sound() {
        let mut kinds = BTreeSet::new();
        for exhibit in EXHIBITS {
            let loaded = scene_file::parse(exhibit.scene, exhibit.name, Path::new(""), &[]);
            let scene = loaded.expect(exhibit.name).scene;
            PreparedScene::new(&scene).expect(exhibit.name);
            kinds.extend(scene.devices.iter().map(|device| device.kind()));
        }
        let all: BTreeSet<&str> = CATALOGUE.iter().map(|entry| entry.kind).collect();
        assert_eq!(kinds, all);
    }

    #[test]
    fn every_scene_of_the_folder_is_an_exhibit() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery");
        for file in std::fs::read_dir(folder).expect("the folder") {
            let text = std::fs::read_to_string(file.expect("a file").path()).expect("a text");
            assert!(EXHIBITS.iter().any(|exhibit| exhibit.scene == text), "{text}");
        }
    }

    #[test]
    fn exhibits_are_selected_by_name() {
        let names = |list: &[&str]| {
            let list: Vec<String> = list.iter().map(|&name| name.to_owned()).collect();
            select(&list).map(|chosen| chosen.iter().map(|e| e.name).collect::<Vec<_>>())
        };
        assert_eq!(names(&["prisms", " Bodies"]), Ok(vec!["bodies", "prisms"]));
        assert_eq!(names(&[]).map(|all| all.len()), Ok(EXHIBITS.len()));
        let message = names(&["eaton-lense"]).expect_err("none of that name");
        assert_eq!(message, "there is no exhibit `eaton-lense`; did you mean `eaton-lens`?");
        assert!(names(&["banana"]).is_err_and(|message| message.contains("there are: quasi-con")));
        let unique: BTreeSet<&str> = EXHIBITS.iter().map(|exhibit| exhibit.name).collect();
        assert_eq!(unique.len(), EXHIBITS.len());
    }
}
