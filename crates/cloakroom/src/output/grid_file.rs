//! Data on a regular grid of cells, into files: NPZ, VTK image data and CSV.

use super::{OutputError, format_of, write_npz, write_whole};
use base64::prelude::{BASE64_STANDARD, Engine};
use glam::DVec3;
use ndarray::ShapeBuilder;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A regular grid of cells; what is said of a cell is so in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The corner of the least coordinates, cm.
    pub corner: DVec3,
    /// The sides of a cell, cm.
    pub spacing: DVec3,
    /// Cells along x, y and z.
    pub cells: [usize; 3],
}

impl Grid {
    /// How many cells there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().product()
    }

    /// The middle of a cell, the cells being counted along x, then y, then z.
    #[must_use]
    pub fn middle(&self, index: usize) -> DVec3 {
        let [nx, ny, _] = self.cells;
        let at = [index % nx, index / nx % ny, index / (nx * ny)];
        DVec3::from([0, 1, 2].map(|axis| self.coordinate(axis, at[axis])))
    }

    /// The coordinate of the middles of the cells of that number along an axis, cm.
    #[must_use]
    pub fn coordinate(&self, axis: usize, number: usize) -> f64 {
        self.corner[axis] + (number as f64 + 0.5) * self.spacing[axis]
    }
}

/// Arrays on a regular grid of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct GridFile {
    /// The grid.
    pub grid: Grid,
    /// The arrays, of one value a cell, along x first, then y, then z.
    pub arrays: Vec<GridArray>,
    /// Pairs of key and text that say what it is.
    pub metadata: Vec<(String, String)>,
}

/// One array on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridArray {
    /// Its name in files.
    pub name: &'static str,
    /// Its values.
    pub values: GridValues,
}

/// The values of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum GridValues {
    /// Codes that stand for the words, counted from 0.
    Codes(Vec<u8>, &'static [&'static str]),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Symmetric tensors: xx, yy, zz, xy, yz, xz.
    SymmetricTensors(Vec<[f64; 6]>),
}

/// A format of files for data on grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridFormat {
    /// Arrays for numpy.
    Npz,
    /// VTK XML image data, as ParaView opens it.
    Vti,
    /// A table, one cell a line.
    Csv,
}

impl GridFormat {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        format_of(path, &[("npz", Self::Npz), ("vti", Self::Vti), ("csv", Self::Csv)])
    }
}

/// The entries of a 3 x 3 tensor by rows among xx, yy, zz, xy, yz, xz.
const ENTRIES: [usize; 9] = [0, 3, 5, 3, 1, 4, 5, 4, 2];

/// Names of the six entries of a symmetric tensor.
const ENTRY_NAMES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Writes data on a grid in the format that the file's ending asks for.
///
/// # Errors
///
/// If the ending is unknown, or the file cannot be written.
pub fn write_grid(grid: &GridFile, path: &Path) -> Result<(), OutputError> {
    match GridFormat::of(path)? {
        GridFormat::Npz => grid.write_npz(path),
        GridFormat::Vti => write_whole(path, |out| grid.write_vti(&mut BufWriter::new(out))),
        GridFormat::Csv => write_whole(path, |out| grid.write_csv(&mut BufWriter::new(out))),
    }
}

impl GridFile {
    /// Arrays `x`, `y`, `z` of the middles of the cells, and each array with the indices of x, y
    /// and z, and of row and column for a tensor; the metadata as the array of bytes `metadata`, a
    /// JSON object.
    fn write_npz(&self, path: &Path) -> Result<(), OutputError> {
        write_npz(path, &self.metadata, |npz| {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let middles = (0..self.grid.cells[axis]).map(|i| self.grid.coordinate(axis, i));
                npz.add(name, self.grid.cells[axis], &middles.collect::<Vec<f64>>())?;
            }
            let [nx, ny, nz] = self.grid.cells;
            for GridArray { name, values } in &self.arrays {
                match values {
                    GridValues::Codes(codes, _) => npz.add(name, (nx, ny, nz).f(), codes)?,
                    GridValues::Numbers(numbers) => npz.add(name, (nx, ny, nz).f(), numbers)?,
                    GridValues::SymmetricTensors(tensors) => {
                        let entries =
                            tensors.iter().flat_map(|six| ENTRIES.map(|entry| six[entry]));
                        let steps = (9, 9 * nx, 9 * nx * ny, 3, 1);
                        let shape = (nx, ny, nz, 3, 3).strides(steps);
                        npz.add(name, shape, &entries.collect::<Vec<f64>>())?;
                    }
                }
            }
            Ok(())
        })
    }

    /// VTK XML image data with all arrays on its cells, little-endian and appended in base64.
    fn write_vti(&self, out: &mut dyn Write) -> io::Result<()> {
        let three = |vector: DVec3| vector.to_array().map(|number| number.to_string()).join(" ");
        let [nx, ny, nz] = self.grid.cells;
        let extent = format!("0 {nx} 0 {ny} 0 {nz}");
        let (origin, spacing) = (three(self.grid.corner), three(self.grid.spacing));
        writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
        for (key, text) in &self.metadata {
            // Two hyphens would end a comment.
            writeln!(out, "<!-- {key}: {} -->", text.replace('-', "\u{2010}"))?;
        }
        writeln!(
            out,
            "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        )?;
        writeln!(
            out,
            "<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\">\n\
             <Piece Extent=\"{extent}\">\n<CellData Scalars=\"index\" Tensors=\"permittivity\">"
        )?;
        let mut offset = 0;
        for GridArray { name, values } in &self.arrays {
            let (kind, components) = match values {
                GridValues::Codes(..) => ("UInt8", 1),
                GridValues::Numbers(_) => ("Float64", 1),
                GridValues::SymmetricTensors(_) => ("Float64", 9),
            };
            writeln!(
                out,
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                 format=\"appended\" offset=\"{offset}\"/>"
            )?;
            // In base64 three bytes are four letters.
            offset += (8 + values.bytes()).div_ceil(3) * 4;
        }
        write!(out, "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"base64\">\n_")?;
        for GridArray { values, .. } in &self.arrays {
            let mut bytes = Vec::with_capacity(8 + values.bytes());
            bytes.extend((values.bytes() as u64).to_le_bytes());
            match values {
                GridValues::Codes(codes, _) => bytes.extend(codes),
                GridValues::Numbers(numbers) => {
                    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
                }
                GridValues::SymmetricTensors(tensors) => {
                    bytes.extend(tensors.iter().flat_map(|six| {
                        ENTRIES.into_iter().flat_map(|entry| six[entry].to_le_bytes())
                    }))
                }
            }
            // Whole groups of three bytes go together.
            for piece in bytes.chunks(3 << 20) {
                out.write_all(BASE64_STANDARD.encode(piece).as_bytes())?;
            }
        }
        writeln!(out, "\n</AppendedData>\n</VTKFile>")?;
        out.flush()
    }

    /// A line of names, then a line for each cell: `x_cm`, `y_cm`, `z_cm`, words for codes,
    /// numbers, and the six entries of tensors.
    fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut names = ["x_cm", "y_cm", "z_cm"].map(str::to_owned).to_vec();
        for GridArray { name, values } in &self.arrays {
            match values {
                GridValues::SymmetricTensors(_) => {
                    names.extend(ENTRY_NAMES.map(|entry| format!("{name}_{entry}")));
                }
                _ => names.push((*name).to_owned()),
            }
        }
        writeln!(out, "{}", names.join(","))?;
        for cell in 0..self.grid.count() {
            let DVec3 { x, y, z } = self.grid.middle(cell);
            write!(out, "{x},{y},{z}")?;
            for GridArray { values, .. } in &self.arrays {
                match values {
                    GridValues::Codes(codes, words) => {
                        write!(out, ",{}", words[usize::from(codes[cell])])?;
                    }
                    GridValues::Numbers(numbers) => write!(out, ",{}", numbers[cell])?,
                    GridValues::SymmetricTensors(tensors) => {
                        for entry in tensors[cell] {
                            write!(out, ",{entry}")?;
                        }
                    }
                }
            }
            writeln!(out)?;
        }
        out.flush()
    }
}

impl GridValues {
    /// How many bytes they take in a file.
    fn bytes(&self) -> usize {
        match self {
            Self::Codes(codes, _) => codes.len(),
            Self::Numbers(numbers) => 8 * numbers.len(),
            Self::SymmetricTensors(tensors) => 72 * tensors.len(),
        }
    }
}
