//! The axes of anisotropic media, and what their tensors are along them.

use super::super::drawing::{Drawing, Face, Ink, Shape, Words};
use super::dimension::arrow_head;
use super::{BLUE, GRAY, INK, TEXT, THICK, THIN, VERMILION, rounded};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::Pose;
use optics::medium::{Medium, principal_axes};

/// The length of an arrow head.
const HEAD: f64 = 14.0;

/// The principal axes of an anisotropic medium in its cell: in the plane, u of the larger and v of
/// the smaller principal value; and the third.
pub(super) struct MediumAxes {
    pub u: DVec3,
    pub v: DVec3,
    third: DVec3,
    optic: Option<DVec3>,
}

/// An axis as it is drawn.
pub(super) struct Drawn {
    pub name: &'static str,
    /// In the plane, of length 1 at most.
    pub direction: DVec2,
    /// Its length, that of the longest being 1.
    pub length: f64,
    pub ink: Ink,
}

impl MediumAxes {
    /// The axes of a medium; none if it is isotropic.
    pub fn of(medium: &Medium) -> Option<Self> {
        let tensor = [medium.permeability(), medium.permittivity()]
            .into_iter()
            .find(|tensor| is_anisotropic(tensor))?;
        let (values, axes) = principal_axes(tensor);
        let mut order = [0, 1, 2];
        // The axis out of the plane last, the greatest value of the others first.
        order.sort_by(|&i, &j| axes.col(i).z.abs().total_cmp(&axes.col(j).z.abs()));
        order[..2].sort_by(|&i, &j| values[j].total_cmp(&values[i]));
        let [u, v, third] = order.map(|i| axes.col(i));
        Some(Self { u, v, third, optic: medium.optic_axis() })
    }

    /// Those to draw: the optic axis alone if there is one, else u and v.
    pub fn drawn(&self) -> Vec<Drawn> {
        let [u, v] = [("u", self.u, 1.0, VERMILION), ("v", self.v, 0.6, BLUE)].map(
            |(name, axis, length, ink)| Drawn { name, direction: axis.truncate(), length, ink },
        );
        match self.optic {
            None => vec![u, v],
            Some(optic) if optic.z.abs() > 0.9 => Vec::new(),
            Some(optic) if optic.dot(self.u).abs() > optic.dot(self.v).abs() => vec![u],
            Some(_) => vec![Drawn { length: 1.0, ..v }],
        }
    }

    /// What the tensors are along u, v and z, in lines of text.
    pub fn lines(&self, medium: &Medium) -> Vec<Vec<(Face, String)>> {
        let (e, m) = (medium.permittivity(), medium.permeability());
        if e.abs_diff_eq(*m, 1e-9 * size(e)) {
            return vec![self.line("ε = μ", e)];
        }
        vec![self.line("ε", e), self.line("μ", m)]
    }

    fn line(&self, name: &str, tensor: &DMat3) -> Vec<(Face, String)> {
        let name = (Face::Italic, name.to_owned());
        let value = |axis: DVec3| rounded(axis.dot(*tensor * axis));
        if !is_anisotropic(tensor) {
            return vec![name, (Face::Regular, format!(" = {}", value(self.u)))];
        }
        let mut line = vec![name, (Face::Regular, " = ".to_owned())];
        for (comma, name, axis) in [("", "u", self.u), (", ", "v", self.v), (", ", "z", self.third)]
        {
            line.push((Face::Regular, format!("{comma}{} (", value(axis))));
            line.push((Face::Italic, name.to_owned()));
            line.push((Face::Regular, ")".to_owned()));
        }
        line
    }

    /// Draws them about a point of the sheet; `reach` says how far one may go in a direction.
    pub fn draw_cross(
        &self,
        drawing: &mut Drawing,
        pose: &Pose,
        at: DVec2,
        reach: impl Fn(DVec2) -> f64,
    ) {
        let drawn = self.drawn();
        let Some(first) = drawn.first() else { return };
        let longest = reach(turned(pose, first.direction));
        for axis in drawn {
            let direction = turned(pose, axis.direction);
            let half = direction * reach(direction).min(longest * axis.length);
            let head = (0.4 * half.length()).min(HEAD);
            // Too small to be told from a blot.
            if head > 3.0 {
                let back = half.normalize_or(DVec2::X) * head;
                let shaft = [at - half + 0.8 * back, at + half - 0.8 * back];
                drawing.add_line("axis", shaft, (axis.ink, THICK));
                for tip in [half, -half] {
                    let head = arrow_head(at + tip, -tip.normalize_or(DVec2::X), head);
                    drawing.add("head", head).filled(axis.ink);
                }
            }
        }
    }

    /// Draws them large, with their names and the angle of the first from the device's x axis.
    pub fn draw_key(&self, drawing: &mut Drawing, pose: &Pose, at: DVec2, radius: f64) {
        let drawn = self.drawn();
        let level = turned(pose, DVec2::X);
        let line = [at - radius * level, at + 1.25 * radius * level];
        drawing.add_line("level", line, (GRAY, THIN)).dashed(7.0, 5.0);
        self.draw_cross(drawing, pose, at, |_| radius);
        // The end to the right of the device's y axis.
        let right =
            |axis: &Drawn| if axis.direction.x < 0.0 { -axis.direction } else { axis.direction };
        for axis in &drawn {
            let end = turned(pose, right(axis)) * (radius * axis.length);
            let beside = at + end + 0.6 * TEXT * end.normalize_or(DVec2::X);
            let name = Shape::Words(Words::of(Face::Italic, axis.name, beside, TEXT));
            drawing.add("axis-name", name).filled(axis.ink);
        }
        let Some(direction) = drawn.first().map(right) else { return };
        let angle = direction.y.atan2(direction.x);
        if angle.abs().to_degrees() < 0.005 || angle.abs().to_degrees() > 89.995 {
            return;
        }
        let at_angle = |share: f64, r: f64| at + r * turned(pose, DVec2::from_angle(share * angle));
        let arc = (0..=24).map(|k| at_angle(f64::from(k) / 24.0, 0.72 * radius));
        drawing.add_line("angle", arc.collect::<Vec<_>>(), (INK, THIN));
        let text = format!("{}°", rounded(angle.to_degrees().abs()));
        let words = Words::new(text, at_angle(0.5, 0.84 * radius), TEXT).anchored(0.0);
        drawing.add_words("angle-label", words);
    }
}

fn size(tensor: &DMat3) -> f64 {
    tensor.to_cols_array().into_iter().fold(0.0, |size, entry| entry.abs().max(size))
}

fn is_anisotropic(tensor: &DMat3) -> bool {
    let scalar = DMat3::from_diagonal(DVec3::splat(tensor.x_axis.x));
    !tensor.abs_diff_eq(scalar, 1e-9 * size(tensor))
}

/// A vector of a device's frame in the plane, as a direction of the sheet.
pub(super) fn turned(pose: &Pose, v: DVec2) -> DVec2 {
    let world = pose.vector_to_world(v.extend(0.0)).truncate();
    DVec2::new(world.x, -world.y)
}
