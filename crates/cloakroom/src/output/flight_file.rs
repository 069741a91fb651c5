//! Light in flight on disk: a picture for each bin of time is more than memory may hold.

use super::npz_file::UntilError;
use super::{OutputError, write_whole};
use crate::render::{Flashed, FlightTile, Gate, PixelBins, Tile};
use bytemuck::{cast_slice, cast_slice_mut};
use ndarray::{ArrayView, Dimension, StrideShape};
use ndarray_npy::{WritableElement, WriteNpyExt};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// In which order the arrays of a file of light in flight go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FlightOrder {
    /// (time, height, width, color): frame by frame.
    #[default]
    TimeFirst,
    /// (height, width, time, color): pixel by pixel, as mitransient has it.
    TimeLast,
}

/// What is kept of light in flight, in single precision.
type Kept = [f32; 4];

/// Numbers in memory at once while a file is written.
const MOST_IN_MEMORY: usize = 1 << 21;

/// Light in flight, kept in a temporary file that has no name, tile by tile.
#[derive(Debug)]
pub struct FlightStore {
    width: usize,
    height: usize,
    gate: Gate,
    kept: Mutex<Tiles>,
}

#[derive(Debug)]
struct Tiles {
    file: File,
    length: u64,
    /// Of each tile, where each of its bins begins that has anything.
    tiles: Vec<(Tile, Vec<Option<u64>>)>,
    /// What comes before all bins, after them, and nobody knows when.
    beside: [Vec<Kept>; 3],
    steady: Vec<[f32; 3]>,
    picture: Vec<[f32; 3]>,
}

impl FlightStore {
    /// For a picture of that size, in a folder in which there is room.
    ///
    /// # Errors
    ///
    /// If no file can be made there.
    pub fn new(folder: &Path, [width, height]: [u32; 2], gate: Gate) -> Result<Self, OutputError> {
        let file =
            tempfile::tempfile_in(folder).map_err(|error| OutputError::new(folder, &error))?;
        let [width, height] = [width, height].map(|side| side as usize);
        let blank = || vec![[0.0; 4]; width * height];
        let kept = Tiles {
            file,
            length: 0,
            tiles: Vec::new(),
            beside: [blank(), blank(), blank()],
            steady: vec![[0.0; 3]; width * height],
            picture: vec![[0.0; 3]; width * height],
        };
        Ok(Self { width, height, gate, kept: Mutex::new(kept) })
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// When the gate was open.
    #[must_use]
    pub fn gate(&self) -> &Gate {
        &self.gate
    }

    fn kept(&self) -> MutexGuard<'_, Tiles> {
        // What a thread has left half done ends with an error elsewhere.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps a tile.
    ///
    /// # Errors
    ///
    /// If the disk is full.
    pub fn put(&self, part: &FlightTile) -> io::Result<()> {
        let (pixels, bins) = (part.steady.len(), self.gate.bins());
        let kept = |flashed: &Flashed| flashed.map(|part| part as f32);
        // The planes of the bins that have anything, and where each begins among all planes.
        let (mut begins, mut planes) = (vec![None; bins], Vec::new());
        for (pixel, PixelBins { first, light }) in part.bins.iter().enumerate() {
            for (begin, flashed) in begins.iter_mut().skip(*first).zip(light) {
                if *flashed == [0.0; 4] {
                    continue;
                }
                let begin = *begin.get_or_insert_with(|| {
                    let begin = planes.len();
                    planes.resize(begin + pixels, [0.0; 4]);
                    begin
                });
                planes[begin + pixel] = kept(flashed);
            }
        }
        let mut all = self.kept();
        let length = all.length;
        all.file.seek(SeekFrom::Start(length))?;
        all.file.write_all(cast_slice(&planes))?;
        all.length += size_of_val(&planes[..]) as u64;
        let byte = |begin: usize| length + (begin * size_of::<Kept>()) as u64;
        let places = begins.into_iter().map(|begin| begin.map(byte)).collect();
        for (number, index) in part.tile.places(self.width).enumerate() {
            let [before, after] = &part.outside;
            for (all, part) in all.beside.iter_mut().zip([before, after, &part.untimed]) {
                all[index] = kept(&part[number]);
            }
            all.steady[index] = part.steady[number].map(|light| light as f32);
            all.picture[index] = part.picture[number].map(|light| light as f32);
        }
        all.tiles.push((part.tile, places));
        Ok(())
    }

    /// What is in a bin: red, green, blue and power of each pixel.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn frame(&self, bin: usize) -> io::Result<Vec<Kept>> {
        let mut frame = Vec::new();
        self.read_rows(bin, [0, self.height], &mut frame)?;
        Ok(frame)
    }

    /// What does not flash.
    #[must_use]
    pub fn steady(&self) -> Vec<[f32; 3]> {
        self.kept().steady.clone()
    }

    /// What comes before all bins.
    #[must_use]
    pub fn before(&self) -> Vec<Kept> {
        self.kept().beside[0].clone()
    }

    /// The share of all that flashes which comes before the bins, after them, and nobody knows when.
    #[must_use]
    pub fn shares_beside(&self) -> [f64; 3] {
        let kept = self.kept();
        let sum = |light: &[f32]| light[..3].iter().copied().map(f64::from).sum::<f64>();
        let picture: f64 = kept.picture.iter().map(|light| sum(light)).sum();
        let steady: f64 = kept.steady.iter().map(|light| sum(light)).sum();
        let all = picture - steady;
        kept.beside.each_ref().map(|beside| {
            let light: f64 = beside.iter().map(|light| sum(light)).sum();
            if all > 0.0 { light / all } else { 0.0 }
        })
    }

    /// Puts the rows from one to another of what is in a bin in the place of others: memory for them is not
    /// asked for again and again.
    fn read_rows(
        &self,
        bin: usize,
        [first, end]: [usize; 2],
        rows: &mut Vec<Kept>,
    ) -> io::Result<()> {
        rows.clear();
        rows.resize(self.width * (end - first), [0.0; 4]);
        let mut kept = self.kept();
        let Tiles { file, tiles, .. } = &mut *kept;
        for (tile, places) in tiles {
            let Some(place) = places[bin] else { continue };
            let [left, top, width, height] =
                [tile.left, tile.top, tile.width, tile.height].map(|side| side as usize);
            let (from, to) = (first.max(top), end.min(top + height));
            if from >= to {
                continue;
            }
            let mut read: Vec<Kept> = vec![[0.0; 4]; (to - from) * width];
            file.seek(SeekFrom::Start(place + ((from - top) * width * size_of::<Kept>()) as u64))?;
            file.read_exact(cast_slice_mut(&mut read))?;
            for (row, pixels) in (from..to).zip(read.chunks_exact(width)) {
                rows[(row - first) * self.width + left..][..width].copy_from_slice(pixels);
            }
        }
        Ok(())
    }

    /// Gives all that is in the bins, in that order, piece by piece.
    fn in_order(
        &self,
        order: FlightOrder,
        mut take: impl FnMut(&[Kept]) -> io::Result<()>,
    ) -> io::Result<()> {
        let bins = self.gate.bins();
        let mut rows = Vec::new();
        if order == FlightOrder::TimeFirst {
            return (0..bins).try_for_each(|bin| {
                self.read_rows(bin, [0, self.height], &mut rows)?;
                take(&rows)
            });
        }
        let at_once = (MOST_IN_MEMORY / (self.width * bins)).max(1);
        let mut pixels = Vec::new();
        for first in (0..self.height).step_by(at_once) {
            let end = self.height.min(first + at_once);
            pixels.clear();
            pixels.resize(self.width * (end - first) * bins, [0.0; 4]);
            for bin in 0..bins {
                self.read_rows(bin, [first, end], &mut rows)?;
                for (pixel, light) in rows.iter().enumerate() {
                    pixels[pixel * bins + bin] = *light;
                }
            }
            take(&pixels)?;
        }
        Ok(())
    }

    /// Writes it as an archive of arrays (NPZ): `light`, red, green and blue, and `power` in each bin
    /// in that order of axes; `time_ns`, the middles of the bins; and images of what is `before` all bins,
    /// `after` them, `untimed`, `steady`, and of the whole `picture`, with the powers of the first three.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npz(
        &self,
        path: &Path,
        order: FlightOrder,
        metadata: &[(String, String)],
    ) -> Result<(), OutputError> {
        write_whole(path, |out| {
            let mut zip = Archive(ZipWriter::new(UntilError::new(out)));
            let (height, width, bins) = (self.height, self.width, self.gate.bins());
            zip.add("time_ns", bins, &self.gate.middles())?;
            let axes = match order {
                FlightOrder::TimeFirst => [bins, height, width],
                FlightOrder::TimeLast => [height, width, bins],
            };
            zip.begin("light", &[axes[0], axes[1], axes[2], 3])?;
            let mut light: Vec<[f32; 3]> = Vec::new();
            self.in_order(order, |all| {
                light.clear();
                light.extend(all.iter().map(|[r, g, b, _]| [*r, *g, *b]));
                zip.go_on(light.as_flattened())
            })?;
            zip.begin("power", &axes)?;
            let mut power: Vec<f32> = Vec::new();
            self.in_order(order, |all| {
                power.clear();
                power.extend(all.iter().map(|light| light[3]));
                zip.go_on(&power)
            })?;
            let kept = self.kept();
            for (name, beside) in ["before", "after", "untimed"].into_iter().zip(&kept.beside) {
                let light: Vec<[f32; 3]> = beside.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
                let power: Vec<f32> = beside.iter().map(|light| light[3]).collect();
                zip.add(name, (height, width, 3), light.as_flattened())?;
                zip.add(&format!("{name}_power"), (height, width), &power)?;
            }
            for (name, image) in [("steady", &kept.steady), ("picture", &kept.picture)] {
                zip.add(name, (height, width, 3), image.as_flattened())?;
            }
            let metadata: serde_json::Map<_, _> =
                metadata.iter().map(|(key, text)| (key.clone(), text.clone().into())).collect();
            let bytes = serde_json::to_vec(&metadata)?;
            zip.add("metadata", bytes.len(), &bytes)?;
            zip.0.finish().map(drop).map_err(io::Error::other)
        })
    }
}

/// An archive of arrays, the large ones of which come piece by piece.
struct Archive<'o>(ZipWriter<UntilError<'o>>);

impl Archive<'_> {
    fn start(&mut self, name: &str) -> io::Result<()> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(true);
        self.0.start_file(format!("{name}.npy"), options).map_err(io::Error::other)
    }

    /// Adds a whole array.
    fn add<T: WritableElement, D: Dimension>(
        &mut self,
        name: &str,
        shape: impl Into<StrideShape<D>>,
        values: &[T],
    ) -> io::Result<()> {
        self.start(name)?;
        let array = ArrayView::from_shape(shape, values).map_err(io::Error::other)?;
        array.write_npy(&mut self.0).map_err(io::Error::other)
    }

    /// Begins an array of numbers in single precision.
    fn begin(&mut self, name: &str, shape: &[usize]) -> io::Result<()> {
        self.start(name)?;
        let sides: Vec<String> = shape.iter().map(ToString::to_string).collect();
        let header = format!(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': ({}), }}",
            sides.join(", ")
        );
        // NPY 1.0: magic, version, length of the header, which is filled up to a multiple of 64.
        const FIXED: usize = 10;
        let length = (FIXED + header.len() + 1).next_multiple_of(64) - FIXED;
        self.0.write_all(b"\x93NUMPY\x01\x00")?;
        self.0.write_all(&u16::try_from(length).map_err(io::Error::other)?.to_le_bytes())?;
        self.0.write_all(format!("{header:<width$}\n", width = length - 1).as_bytes())
    }

    /// Adds the next numbers of it.
    fn go_on(&mut self, values: &[f32]) -> io::Result<()> {
        if cfg!(target_endian = "little") {
            return self.0.write_all(cast_slice(values));
        }
        values.iter().try_for_each(|value| self.0.write_all(&value.to_le_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array1, Array2, Array3, Array4};
    use ndarray_npy::NpzReader;

    /// Of a picture of 5 x 3 pixels in two tiles, in which each number says where it stands.
    fn store() -> (FlightStore, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        let gate = Gate::new([1.0, 2.0], 0.25).expect("a gate");
        let store = FlightStore::new(folder.path(), [5, 3], gate).expect("a store");
        for tile in ["3,0,2,3", "0,0,3,3"] {
            let tile: Tile = tile.parse().expect("a tile");
            let places: Vec<usize> = tile.places(5).collect();
            let flashed = |index: usize, bin: usize| {
                // Nothing in the second bin, and nothing at the left in the third.
                let dark = bin == 1 || bin == 2 && tile.left == 0;
                std::array::from_fn(
                    |i| if dark { 0.0 } else { (index * 100 + bin * 10 + i) as f64 },
                )
            };
            let image: Vec<[f64; 3]> = places.iter().map(|index| [*index as f64; 3]).collect();
            let beside = || places.iter().map(|index| [*index as f64 + 0.5; 4]).collect();
            store
                .put(&FlightTile {
                    tile,
                    bins: places
                        .iter()
                        .map(|index| PixelBins {
                            first: 0,
                            light: (0..5).map(|bin| flashed(*index, bin)).collect(),
                        })
                        .collect(),
                    outside: [beside(), beside()],
                    untimed: beside(),
                    steady: image.clone(),
                    picture: image,
                })
                .expect("kept");
        }
        (store, folder)
    }

    #[test]
    fn what_is_kept_is_written_in_either_order() {
        let (store, folder) = store();
        let path = folder.path().join("a.npz");
        let mut cubes = Vec::new();
        for order in [FlightOrder::TimeFirst, FlightOrder::TimeLast] {
            store.write_npz(&path, order, &[("seed".into(), "7".into())]).expect("written");
            let mut npz = NpzReader::new(File::open(&path).expect("a file")).expect("an archive");
            let light: Array4<f32> = npz.by_name("light").expect("an array");
            let power: Array3<f32> = npz.by_name("power").expect("an array");
            let times: Array1<f64> = npz.by_name("time_ns").expect("an array");
            assert_eq!(times.to_vec(), [1.0, 1.25, 1.5, 1.75, 2.0]);
            let before: Array3<f32> = npz.by_name("before").expect("an array");
            let after: Array2<f32> = npz.by_name("after_power").expect("an array");
            assert_eq!((before[(2, 1, 0)], after[(2, 1)]), (11.5, 11.5));
            let metadata: Array1<u8> = npz.by_name("metadata").expect("an array");
            assert_eq!(metadata.to_vec(), br#"{"seed":"7"}"#);
            cubes.push((light, power));
        }
        let [(first, powers), (last, last_powers)] = &cubes[..] else { panic!("two") };
        assert_eq!((first.dim(), last.dim()), ((5, 3, 5, 3), (3, 5, 5, 3)));
        for ((bin, row, column), power) in powers.indexed_iter() {
            let index = row * 5 + column;
            let dark = bin == 1 || bin == 2 && column < 3;
            let number = if dark { 0.0 } else { (index * 100 + bin * 10) as f32 };
            assert_eq!(*power, if dark { 0.0 } else { number + 3.0 });
            assert_eq!(last_powers[(row, column, bin)], *power);
            assert_eq!(first[(bin, row, column, 0)], number);
            for color in 0..3 {
                assert_eq!(first[(bin, row, column, color)], last[(row, column, bin, color)]);
            }
        }
    }
}
