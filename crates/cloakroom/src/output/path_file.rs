//! The paths of rays into files: VTK polygonal data.

use super::vtk_file::{self, Appended};
use super::{OutputError, format_of, write_whole};
use crate::trace::PathTable;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes the paths of rays as VTK XML polygonal data (`.vtp`), as ParaView opens it: a line for each
/// path with the arrays `ray`, `leaf`, `parent` and `power` (a component for each launched
/// polarization), and `optical_path` (cm) at its vertices.
///
/// # Errors
///
/// If the ending is another, or the file cannot be written.
///
/// # Example
///
/// ```
/// use cloakroom::output::write_paths;
/// use cloakroom::trace::PathTable;
///
/// let folder = std::env::temp_dir();
/// write_paths(&PathTable::<1>::default(), &[], &folder.join("cloakroom-no-rays.vtp"))?;
/// assert!(write_paths(&PathTable::<1>::default(), &[], &folder.join("rays.obj")).is_err());
/// # Ok::<(), cloakroom::output::OutputError>(())
/// ```
pub fn write_paths<const N: usize>(
    paths: &PathTable<N>,
    metadata: &[(String, String)],
    path: &Path,
) -> Result<(), OutputError> {
    format_of(path, &[("vtp", ())])?;
    write_whole(path, |out| write_vtp(paths, metadata, &mut BufWriter::new(out)))
}

fn write_vtp<const N: usize>(
    paths: &PathTable<N>,
    metadata: &[(String, String)],
    out: &mut dyn Write,
) -> io::Result<()> {
    let (lines, points) = (paths.ray.len(), paths.vertex.len());
    vtk_file::begin(out, "PolyData", metadata)?;
    writeln!(
        out,
        "<PolyData>\n<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"{lines}\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"optical_path\">"
    )?;
    let mut arrays = Appended::default();
    arrays.tell(out, "optical_path", "Float64", 1, 8 * points)?;
    writeln!(out, "</PointData>\n<CellData Scalars=\"power\">")?;
    arrays.tell(out, "ray", "UInt32", 1, 4 * lines)?;
    arrays.tell(out, "leaf", "Int64", 1, 8 * lines)?;
    arrays.tell(out, "parent", "Int64", 1, 8 * lines)?;
    arrays.tell(out, "power", "Float64", N, 8 * N * lines)?;
    writeln!(out, "</CellData>\n<Points>")?;
    arrays.tell(out, "vertex", "Float64", 3, 24 * points)?;
    writeln!(out, "</Points>\n<Lines>")?;
    arrays.tell(out, "connectivity", "Int64", 1, 8 * points)?;
    arrays.tell(out, "offsets", "Int64", 1, 8 * lines)?;
    writeln!(out, "</Lines>\n</Piece>\n</PolyData>")?;
    arrays.begin(out)?;
    let numbers = |numbers: &[f64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let whole = |numbers: &[i64]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    Appended::write(out, numbers(&paths.optical_path))?;
    Appended::write(out, paths.ray.iter().flat_map(|ray| ray.to_le_bytes()).collect())?;
    Appended::write(out, whole(&paths.leaf))?;
    Appended::write(out, whole(&paths.parent))?;
    Appended::write(out, numbers(paths.power.as_flattened()))?;
    Appended::write(out, numbers(paths.vertex.as_flattened()))?;
    Appended::write(out, (0..points as u64).flat_map(u64::to_le_bytes).collect())?;
    Appended::write(out, paths.start[1..].iter().flat_map(|end| end.to_le_bytes()).collect())?;
    arrays.end(out)
}
