//! The homogeneous segments of a device as a table: corners, axes, tensors.

use super::{MaterialError, chosen};
use crate::assembly::Assembly;
use crate::device::{HomogeneousRegion, Region, RegionBorder};
use crate::output::{OutputError, WriteSeek, format_of, write_whole};
use crate::scene::Scene;
use glam::{DMat3, DVec2, DVec3};
use optics::medium::{Medium, principal_axes};
use serde::Serialize;
use std::io;
use std::path::Path;

/// A piece of a device: a prism of one medium, or a piece of metal. All in the device's frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Segment {
    /// Its number among the device's segments; metal comes last.
    pub segment: usize,
    /// `medium` or `metal`.
    pub filling: &'static str,
    /// The corners of its cross-section in the xy-plane, in order around it, cm.
    pub corners_cm: Vec<[f64; 2]>,
    /// From where to where it reaches along z, cm; `None` if it is endless.
    pub z_cm: Option<[f64; 2]>,
    /// Its permittivity; `None` for metal.
    pub permittivity: Option<Principal>,
    /// Its permeability; `None` for metal.
    pub permeability: Option<Principal>,
    /// The optic axis of a uniaxial medium, a unit vector with x ≥ 0.
    pub optic_axis: Option<[f64; 3]>,
}

/// A symmetric tensor by its principal values. Those in the xy-plane come first, the greater of
/// them before the smaller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Principal {
    /// The principal values.
    pub values: [f64; 3],
    /// The unit vectors along them, with x ≥ 0.
    pub axes: [[f64; 3]; 3],
}

impl Principal {
    fn of(tensor: &DMat3) -> Self {
        let (values, axes) = principal_axes(tensor);
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| axes.col(i).z.abs().total_cmp(&axes.col(j).z.abs()));
        order[..2].sort_by(|&i, &j| values[j].total_cmp(&values[i]));
        Self { values: order.map(|i| values[i]), axes: order.map(|i| towards_x(axes.col(i))) }
    }
}

/// The sense of an axis with x ≥ 0, and y > 0 where x is 0.
fn towards_x(axis: DVec3) -> [f64; 3] {
    let first = axis.to_array().into_iter().find(|component| *component != 0.0);
    let axis = if first.is_some_and(|component| component < 0.0) { -axis } else { axis };
    // No negative zeros in files.
    axis.to_array().map(|component| component + 0.0)
}

/// The segments of a device of homogeneous media, then its metal. `device` may be left out if there
/// is only one.
///
/// # Errors
///
/// If there is no such device, or it has no segments.
pub fn segments(
    scene: &Scene,
    assembly: &Assembly,
    device: Option<usize>,
) -> Result<Vec<Segment>, MaterialError> {
    let (device, placed) = chosen(scene, assembly, device)?;
    let structure = &placed.structure;
    let section = structure.cross_section();
    let z_cm = scene.devices[device].placement.length.map(|length| [-length / 2.0, length / 2.0]);
    let segment = |points: Vec<DVec2>, medium: Option<&Medium>| Segment {
        segment: 0,
        filling: if medium.is_some() { "medium" } else { "metal" },
        corners_cm: points.into_iter().map(|p| (p + 0.0).to_array()).collect(),
        z_cm,
        permittivity: medium.map(|medium| Principal::of(medium.permittivity())),
        permeability: medium.map(|medium| Principal::of(medium.permeability())),
        optic_axis: medium.and_then(Medium::optic_axis).map(towards_x),
    };
    let of_medium = section.regions.iter().filter_map(|region| {
        // Of what is round or ends at slanted faces a cut says too little.
        let Region::Homogeneous(HomogeneousRegion { medium, border, .. }) = &region.region else {
            return None;
        };
        if !matches!(border, RegionBorder::Faces(_)) {
            return None;
        }
        Some(segment(region.border.first()?.corners(), Some(medium)))
    });
    let mut segments: Vec<Segment> = of_medium.collect();
    if segments.is_empty() {
        let (device, kind) = (scene.device_name(device), scene.devices[device].kind());
        let problem =
            "has no homogeneous segments to list: it is no prism, or its medium is graded";
        return Err(MaterialError::Unsuitable { device, kind, problem });
    }
    let metal = section.metal.iter().filter(|contour| contour.closed);
    segments.extend(metal.map(|contour| segment(contour.corners(), None)));
    for (number, segment) in segments.iter_mut().enumerate() {
        segment.segment = number;
    }
    Ok(segments)
}

/// Writes segments as the ending of the file's name asks for. `.json`: an array of [`Segment`]s.
/// `.csv`: a line each with `segment`, `filling`, `z_min_cm`, `z_max_cm`, the optic axis, principal
/// values 1 to 3 of both tensors with their axes, and the corners; what a segment does not have is
/// left empty.
///
/// # Errors
///
/// If the ending is another, or the file cannot be written.
pub fn write_segments(segments: &[Segment], path: &Path) -> Result<(), OutputError> {
    let is_json = format_of(path, &[("csv", false), ("json", true)])?;
    write_whole(path, |out| match is_json {
        true => Ok(serde_json::to_writer_pretty(out, segments)?),
        false => csv(segments, out),
    })
}

fn csv(segments: &[Segment], out: &mut dyn WriteSeek) -> io::Result<()> {
    let most = segments.iter().map(|segment| segment.corners_cm.len()).max().unwrap_or(0);
    let mut names = ["segment", "filling", "z_min_cm", "z_max_cm"].map(str::to_owned).to_vec();
    names.extend(["x", "y", "z"].map(|axis| format!("optic_axis_{axis}")));
    for tensor in ["permittivity", "permeability"] {
        for i in 1..=3 {
            names.push(format!("{tensor}_{i}"));
            names.extend(["x", "y", "z"].map(|axis| format!("{tensor}_axis_{i}_{axis}")));
        }
    }
    for corner in 1..=most {
        names.extend(["x", "y"].map(|axis| format!("corner_{corner}_{axis}_cm")));
    }
    let mut table = csv::Writer::from_writer(out);
    table.write_record(&names)?;
    for segment in segments {
        let mut numbers: Vec<Option<f64>> = Vec::new();
        numbers.extend([0, 1].map(|end| segment.z_cm.map(|z| z[end])));
        numbers.extend([0, 1, 2].map(|i| segment.optic_axis.map(|axis| axis[i])));
        for tensor in [segment.permittivity, segment.permeability] {
            for i in 0..3 {
                numbers.push(tensor.map(|tensor| tensor.values[i]));
                numbers.extend([0, 1, 2].map(|k| tensor.map(|tensor| tensor.axes[i][k])));
            }
        }
        for corner in 0..most {
            let at = segment.corners_cm.get(corner);
            numbers.extend([0, 1].map(|axis| at.map(|at| at[axis])));
        }
        let first = [segment.segment.to_string(), segment.filling.to_owned()];
        let text = |number: Option<f64>| number.map(|n| n.to_string()).unwrap_or_default();
        table.write_record(first.into_iter().chain(numbers.into_iter().map(text)))?;
    }
    table.flush()
}
