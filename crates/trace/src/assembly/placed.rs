//! A device at its place.

use crate::device::{Body, Dispersion, Region, Structure, SurfaceHit};
use glam::DVec3;
use optics::geometry::{Pose, Solid};
use optics::interface::FilmLayer;
use optics::medium::Medium;

/// A device at its place.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Where it stands and how it is turned.
    pub pose: Pose,
    /// What it is made of.
    pub structure: Structure,
    /// How its media depend on the frequency.
    pub dispersion: Dispersion,
}

/// What a ray has just left, and does not meet next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DepartedSurface {
    pub device: u16,
    /// Which of the device's surfaces; the whole device if it is convex.
    pub surface: Option<u16>,
}

impl DepartedSurface {
    /// The surface of the `device`th device that a ray has met.
    pub fn met(device: u16, hit: &SurfaceHit) -> Self {
        Self { device, surface: Some(hit.surface) }
    }

    /// What a ray has left that comes to a surface, which it may have left itself: a curved one is
    /// met again.
    pub fn unless_met(self, device: u16, hit: &SurfaceHit) -> Option<Self> {
        (self != Self::met(device, hit)).then_some(self)
    }
}

impl Placed {
    /// A device in a place.
    #[must_use]
    pub fn new(pose: Pose, structure: Structure) -> Self {
        Self { pose, structure, dispersion: Dispersion::default() }
    }

    /// What a ray has left that runs away from this device, the `number`th: the surface that is
    /// given, or all of the device if it is convex.
    #[inline]
    pub(crate) fn departed(&self, number: u16, surface: Option<u16>) -> Option<DepartedSurface> {
        let convex = self.structure.hull.is_convex();
        let surface = surface.filter(|_| !convex);
        (convex || surface.is_some()).then_some(DepartedSurface { device: number, surface })
    }

    /// Whether a point of the world lies inside the device.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        self.structure.hull.holds(self.pose.to_local(point))
    }

    /// The space that the device takes up in the world.
    #[must_use]
    pub fn solids(&self) -> Vec<Solid> {
        self.structure.hull.solids.iter().map(|solid| solid.placed(&self.pose)).collect()
    }

    /// The sheet of its thin mirror in the world, if it has one.
    pub(super) fn thin_mirror(&self) -> Option<Solid> {
        self.structure.hull.thin_mirror.as_ref().map(|mirror| mirror.placed(&self.pose))
    }

    /// The least and the greatest coordinates of the device and its thin mirror; `None` if it is
    /// nowhere.
    #[must_use]
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let mirror = self.thin_mirror().and_then(|mirror| mirror.bounds());
        [self.structure.hull.bounds(&self.pose), mirror]
            .into_iter()
            .flatten()
            .reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
    }

    /// Whether something of it can stand behind something else of it: it is of several solids, or of
    /// one that is a mesh with dents.
    #[must_use]
    pub fn has_parts(&self) -> bool {
        match &self.structure.hull.solids[..] {
            [Solid::Polyhedron { solid, .. }] => !solid.is_convex(),
            solids => solids.len() > 1,
        }
    }

    /// Whether a surface of it lies in a plane.
    pub(crate) fn is_plane(&self, surface: u16) -> bool {
        let surface = self.structure.surfaces.get(usize::from(surface));
        surface.is_some_and(|surface| surface.plane().is_some())
    }

    /// How large the smallest part of it looks at least, from wherever it is seen but edge on, cm: the
    /// middle one of the sides of a box around it, and of a mesh with dents the width of a triangle.
    /// Infinite if it is nowhere.
    #[must_use]
    pub fn least_extent(&self) -> f64 {
        let extent = |solid: &Solid| {
            if let Solid::Polyhedron { solid, .. } = solid
                && !solid.is_convex()
            {
                return Some(solid.least_width());
            }
            let [low, high] = solid.bounds()?;
            let mut sides = (high - low).to_array();
            sides.sort_by(f64::total_cmp);
            Some(sides[1])
        };
        self.structure.hull.solids.iter().filter_map(extent).fold(f64::INFINITY, f64::min)
    }

    /// The body that it is, if it is one.
    #[must_use]
    pub fn body(&self) -> Option<&Body> {
        self.structure.hull.body.as_ref()
    }

    /// Its region of that number.
    pub(crate) fn region(&self, number: u16) -> &Region {
        &self.structure.regions[usize::from(number)]
    }

    /// How thick the thinnest part of it is that is of a medium, cm: the least distance between two
    /// parallel planes that it fits between. `None` without a medium.
    #[must_use]
    pub fn thickness(&self) -> Option<f64> {
        let Structure { regions, hull, .. } = &self.structure;
        let thickness = hull.solids.iter().map(Solid::thickness).reduce(f64::min)?;
        (!regions.is_empty()).then_some(thickness)
    }

    /// The least difference of the optical paths of two branches that it makes, cm: there and back in a
    /// homogeneous medium, or by its birefringence; 0 of a polarizer, which makes light of it;
    /// infinite without.
    #[must_use]
    pub fn least_path_difference(&self) -> f64 {
        let difference = |medium: &Medium| {
            let reflected = 2.0 * medium.mean_index().abs();
            let birefringence = medium.birefringence();
            if birefringence > 0.0 { reflected.min(birefringence) } else { reflected }
        };
        let least = self.media().map(difference).fold(f64::INFINITY, f64::min);
        if self.structure.polarizes() { 0.0 } else { least * self.thinnest() }
    }

    /// By how much the optical paths of both waves of each of its homogeneous media differ after the
    /// thinnest part, cm, where they do.
    pub(super) fn parted(&self) -> impl Iterator<Item = f64> {
        let parted = self.media().map(Medium::birefringence).filter(|parted| *parted > 0.0);
        parted.map(|parted| parted * self.thinnest())
    }

    /// Its homogeneous media.
    fn media(&self) -> impl Iterator<Item = &Medium> {
        self.structure.regions.iter().filter_map(|region| match region {
            Region::Homogeneous(region) => Some(&region.medium),
            _ => None,
        })
    }

    /// How thick its thinnest part is, cm.
    fn thinnest(&self) -> f64 {
        let solids = &self.structure.hull.solids;
        solids.iter().map(Solid::thickness).fold(f64::INFINITY, f64::min)
    }

    /// Its films in the world's frame.
    pub(super) fn films_in_world(&self) -> Vec<Vec<FilmLayer>> {
        let turned =
            |layer: &FilmLayer| FilmLayer { medium: self.medium_in_world(&layer.medium), ..*layer };
        self.structure.films.iter().map(|film| film.iter().map(turned).collect()).collect()
    }

    /// A medium of the device's frame in the world's.
    pub(crate) fn medium_in_world(&self, medium: &Medium) -> Medium {
        if medium.is_isotropic() {
            return *medium;
        }
        let (permittivity, permeability) = medium.tensors();
        let turn = self.pose.rotation();
        // A medium stays one when it is turned.
        Medium::new(permittivity.turned(&turn), permeability.turned(&turn)).unwrap_or(*medium)
    }
}
