//! What of a device's interfaces is worked out once.

use crate::device::{Beyond, Cell, Finish, Skin, Structure};
use glam::DVec3;
use optics::interface::Reflectionless;
use optics::medium::Medium;

/// Those interfaces of a device that reflect nothing. They are flat, and homogeneous media meet there.
#[derive(Clone, Debug)]
pub(super) struct Interfaces {
    /// From air, by the number of the surface in the device's skin.
    skin: Vec<Option<Reflectionless>>,
    /// Out of each cell, by the number of its face.
    faces: Vec<Vec<Option<Reflectionless>>>,
}

impl Interfaces {
    /// The interfaces of a device.
    pub fn of(structure: &Structure) -> Self {
        let medium = |beyond: Beyond| match beyond {
            Beyond::Air => Some(&Medium::AIR),
            Beyond::Cell(cell) => match structure.cells.get(usize::from(cell)) {
                Some(Cell::Prism(prism)) => Some(&prism.medium),
                _ => None,
            },
            Beyond::Seam(_) | Beyond::Conductor => None,
        };
        let between = |from: &Medium, beyond: Beyond, normal: DVec3| {
            Reflectionless::between(from, medium(beyond)?, normal)
        };
        let entrance = |skin: &Skin| match skin {
            Skin::Wall { wall, beyond: beyond @ Beyond::Cell(_), finish: Finish::Bare } => {
                between(&Medium::AIR, *beyond, -wall.normal())
            }
            Skin::Cap { cap, beyond: beyond @ Beyond::Cell(_), finish: Finish::Bare } => {
                between(&Medium::AIR, *beyond, -cap.normal)
            }
            _ => None,
        };
        let exits = |cell: &Cell| match cell {
            Cell::Prism(prism) => (prism.faces.iter())
                .map(|face| between(&prism.medium, face.beyond, face.plane.normal))
                .collect(),
            Cell::Conformal(_) | Cell::Radial(_) => Vec::new(),
        };
        Self {
            skin: structure.skin.iter().map(entrance).collect(),
            faces: structure.cells.iter().map(exits).collect(),
        }
    }

    /// The way from air into the cell behind a surface of the skin, if nothing is reflected there.
    pub fn entrance(&self, skin: u16) -> Option<&Reflectionless> {
        self.skin.get(usize::from(skin))?.as_ref()
    }

    /// The way out of a cell through one of its faces, if nothing is reflected there.
    pub fn exit(&self, cell: u16, face: u16) -> Option<&Reflectionless> {
        self.faces.get(usize::from(cell))?.get(usize::from(face))?.as_ref()
    }
}
