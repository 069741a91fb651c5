//! Data on a regular grid of cells, into files: NPZ, VTK image data and CSV.

use super::vtk_file::{self, Appended};
use super::{OutputError, format_of, write_npz, write_whole};
use glam::DVec3;
use ndarray::{Array, Array1, ArrayView, ArrayViewD, CowArray, IxDyn, ShapeBuilder};
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

/// An array with the indices of numpy.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapedArray<'a> {
    /// Codes.
    Codes(ArrayViewD<'a, u8>),
    /// Numbers.
    Numbers(CowArray<'a, f64, IxDyn>),
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
    /// Its arrays by their names, as numpy has them: `x`, `y`, `z` of the middles of the cells, and
    /// each array with the indices of x, y and z, and of row and column for a tensor.
    #[must_use]
    pub fn shaped(&self) -> Vec<(&'static str, ShapedArray<'_>)> {
        let mut arrays = Vec::new();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let middles = (0..self.grid.cells[axis]).map(|i| self.grid.coordinate(axis, i));
            let middles = Array1::from_iter(middles).into_dyn();
            arrays.push((name, ShapedArray::Numbers(middles.into())));
        }
        let [nx, ny, nz] = self.grid.cells;
        let shape = (nx, ny, nz).f();
        for GridArray { name, values } in &self.arrays {
            // There is a value for each cell.
            let shaped = match values {
                GridValues::Codes(codes, _) => ArrayView::from_shape(shape, codes)
                    .map(|codes| ShapedArray::Codes(codes.into_dyn())),
                GridValues::Numbers(numbers) => ArrayView::from_shape(shape, numbers)
                    .map(|numbers| ShapedArray::Numbers(numbers.into_dyn().into())),
                GridValues::SymmetricTensors(tensors) => {
                    let entries = tensors.iter().flat_map(|six| ENTRIES.map(|entry| six[entry]));
                    let steps = (9, 9 * nx, 9 * nx * ny, 3, 1);
                    let shape = (nx, ny, nz, 3, 3).strides(steps);
                    Array::from_shape_vec(shape, entries.collect())
                        .map(|entries| ShapedArray::Numbers(entries.into_dyn().into()))
                }
            };
            arrays.extend(shaped.map(|shaped| (*name, shaped)));
        }
        arrays
    }

    /// The arrays of [`GridFile::shaped`]; the metadata as the array of bytes `metadata`, a JSON
    /// object.
    fn write_npz(&self, path: &Path) -> Result<(), OutputError> {
        write_npz(path, &self.metadata, |npz| {
            self.shaped().iter().try_for_each(|(name, array)| match array {
                ShapedArray::Codes(codes) => npz.add_array(name, codes),
                ShapedArray::Numbers(numbers) => npz.add_array(name, numbers),
            })
        })
    }

    /// VTK XML image data with all arrays on its cells, little-endian and appended in base64.
    fn write_vti(&self, out: &mut dyn Write) -> io::Result<()> {
        let three = |vector: DVec3| vector.to_array().map(|number| number.to_string()).join(" ");
        let [nx, ny, nz] = self.grid.cells;
        let extent = format!("0 {nx} 0 {ny} 0 {nz}");
        let (origin, spacing) = (three(self.grid.corner), three(self.grid.spacing));
        vtk_file::begin(out, "ImageData", &self.metadata)?;
        writeln!(
            out,
            "<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\">\n\
             <Piece Extent=\"{extent}\">\n<CellData Scalars=\"index\" Tensors=\"permittivity\">"
        )?;
        let mut arrays = Appended::default();
        for GridArray { name, values } in &self.arrays {
            let (kind, components) = match values {
                GridValues::Codes(..) => ("UInt8", 1),
                GridValues::Numbers(_) => ("Float64", 1),
                GridValues::SymmetricTensors(_) => ("Float64", 9),
            };
            arrays.tell(out, name, kind, components, values.bytes())?;
        }
        writeln!(out, "</CellData>\n</Piece>\n</ImageData>")?;
        arrays.begin(out)?;
        for GridArray { values, .. } in &self.arrays {
            match values {
                GridValues::Codes(codes, _) => Appended::write(out, codes.clone())?,
                GridValues::Numbers(numbers) => {
                    Appended::write(out, numbers.iter().flat_map(|n| n.to_le_bytes()).collect())?;
                }
                GridValues::SymmetricTensors(tensors) => {
                    let entries = tensors.iter().flat_map(|six| ENTRIES.map(|entry| six[entry]));
                    Appended::write(out, entries.flat_map(f64::to_le_bytes).collect())?;
                }
            }
        }
        arrays.end(out)
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
