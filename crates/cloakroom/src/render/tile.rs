//! Tiles: rectangles of a picture that are rendered apart, by other processes or machines, and put
//! together again.

use crate::color::BINS;
use crate::memory::{self, Shortage};
use crate::output::{Channel, Picture, RgbImage, Samples};
use std::fmt;
use std::str::FromStr;

#[cfg(test)]
mod tests;

/// The keys under which the metadata of a tile say which one it is.
const TILE: &str = "tile";
const RESOLUTION: &str = "resolution";

/// A rectangle of a picture, in pixels. It is written `LEFT,TOP,WIDTH,HEIGHT`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Its first column, counted from 0.
    pub left: u32,
    /// Its first row, counted from 0 at the top.
    pub top: u32,
    /// How many columns it has.
    pub width: u32,
    /// How many rows it has.
    pub height: u32,
}

/// What is wrong with a tile.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TileError {
    /// This is not written as a tile.
    #[error("`{0}` is no tile; write LEFT,TOP,WIDTH,HEIGHT in pixels, such as 0,0,512,384")]
    Unreadable(String),
    /// It has no pixels, or some that the picture has not.
    #[error("the tile {tile} is empty or reaches beyond the picture of {width} x {height} pixels")]
    Outside {
        /// The tile.
        tile: Tile,
        /// Width of the picture.
        width: u32,
        /// Height of the picture.
        height: u32,
    },
}

impl Tile {
    /// Checks that a tile is a part of a picture of that resolution.
    ///
    /// # Errors
    ///
    /// If it is empty or reaches beyond the picture.
    pub fn check(self, [width, height]: [u32; 2]) -> Result<Self, TileError> {
        let within = |first: u32, count: u32, all: u32| {
            count > 0 && first.checked_add(count).is_some_and(|end| end <= all)
        };
        if within(self.left, self.width, width) && within(self.top, self.height, height) {
            Ok(self)
        } else {
            Err(TileError::Outside { tile: self, width, height })
        }
    }

    /// What the metadata of a tile say beside those of the picture.
    pub(super) fn metadata(self, [width, height]: [u32; 2]) -> [(String, String); 2] {
        [(TILE, self.to_string()), (RESOLUTION, format!("{width},{height}"))]
            .map(|(key, text)| (key.to_owned(), text))
    }

    /// Where its pixels are in a picture of that width, row by row.
    pub fn places(self, width: usize) -> impl Iterator<Item = usize> {
        let [left, top, columns, rows] =
            [self.left, self.top, self.width, self.height].map(|side| side as usize);
        (top..top + rows)
            .flat_map(move |row| (left..left + columns).map(move |column| row * width + column))
    }

    fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    fn overlaps(self, other: Self) -> bool {
        let meet = |a: u32, b: u32, first: u32, count: u32| a < first + count && first < a + b;
        meet(self.left, self.width, other.left, other.width)
            && meet(self.top, self.height, other.top, other.height)
    }

    /// Puts the pixels of the tile where they belong in a picture of that width.
    fn place<T: Copy>(self, whole: &mut [T], width: usize, pixels: &[T]) {
        let own = self.width as usize;
        for (row, pixels) in pixels.chunks_exact(own).enumerate() {
            let first = (self.top as usize + row) * width + self.left as usize;
            whole[first..first + own].copy_from_slice(pixels);
        }
    }
}

impl fmt::Display for Tile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{},{}", self.left, self.top, self.width, self.height)
    }
}

impl FromStr for Tile {
    type Err = TileError;

    fn from_str(text: &str) -> Result<Self, TileError> {
        let [left, top, width, height] =
            numbers(text).ok_or_else(|| TileError::Unreadable(text.to_owned()))?;
        Ok(Self { left, top, width, height })
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[u32; N]> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// Why tiles cannot be put together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// A file, which is called so, is no tile, or not the one that it says.
    #[error("{0} is not a tile of a picture: its metadata do not say which, or of another size")]
    NoTile(String),
    /// Two tiles are not of one picture, or have a pixel in common.
    #[error("{first} and {second} {problem}")]
    Pair {
        /// What one tile is called.
        first: String,
        /// What the other is called.
        second: String,
        /// What is wrong with them.
        problem: String,
    },
    /// Pixels are missing.
    #[error(
        "the tiles have {pixels} of the picture's {width} x {height} pixels; some tiles are missing"
    )]
    Missing {
        /// How many pixels there are.
        pixels: u64,
        /// Width of the picture.
        width: u32,
        /// Height of the picture.
        height: u32,
    },
    /// There is not enough memory for the picture beside its tiles.
    #[error("the picture {0}")]
    TooLarge(#[from] Shortage),
}

/// Refuses a picture that would not fit into memory, and the copy that its files are made from.
fn check_memory(bytes: usize) -> Result<(), MergeError> {
    Ok(memory::check(2 * bytes as u64, u64::MAX)?)
}

/// Pairs of key and text.
type Metadata = Vec<(String, String)>;

/// A tile to be put together with others: what it is called, its metadata and its pixels.
pub type Piece<T> = (String, Metadata, T);

/// Which tiles pieces are, the resolution of their picture, and its metadata.
type Layout = (Vec<Tile>, [u32; 2], Metadata);

/// The error of two tiles of different pictures.
fn differ(first: &str, second: &str, what: &str) -> MergeError {
    let problem = format!("are not tiles of one picture: their {what} differ");
    MergeError::Pair { first: first.to_owned(), second: second.to_owned(), problem }
}

/// Finds the places of pieces of one picture, which they cover; `size` is a piece's in pixels.
fn layout<T>(pieces: &[Piece<T>], size: impl Fn(&T) -> [usize; 2]) -> Result<Layout, MergeError> {
    let mut tiles: Vec<Tile> = Vec::new();
    let mut picture: Option<([u32; 2], Metadata)> = None;
    for (name, metadata, pixels) in pieces {
        let say = |key: &str| Some(metadata.iter().find(|(known, _)| known == key)?.1.as_str());
        let place = || {
            let resolution: [u32; 2] = numbers(say(RESOLUTION)?)?;
            let tile: Tile = say(TILE)?.parse().ok()?;
            // Before memory is taken for what the metadata say.
            let of_size = size(pixels) == [tile.width, tile.height].map(|side| side as usize);
            Some((tile.check(resolution).ok().filter(|_| of_size)?, resolution))
        };
        let (tile, resolution) = place().ok_or_else(|| MergeError::NoTile(name.clone()))?;
        let rest = metadata.iter().filter(|(key, _)| key != TILE && key != RESOLUTION);
        let rest: Metadata = rest.cloned().collect();
        let (known, of_first) = picture.get_or_insert_with(|| (resolution, rest.clone()));
        let what = if *known != resolution {
            Some("resolutions".to_owned())
        } else if *of_first != rest {
            let other = of_first.iter().zip(&rest).find(|(a, b)| a != b);
            Some(other.map_or("metadata".to_owned(), |(a, _)| format!("`{}` metadata", a.0)))
        } else {
            None
        };
        if let Some(what) = what {
            return Err(differ(&pieces[0].0, name, &what));
        }
        if let Some(other) = tiles.iter().position(|other| other.overlaps(tile)) {
            let (first, second) = (pieces[other].0.clone(), name.clone());
            return Err(MergeError::Pair { first, second, problem: "overlap".to_owned() });
        }
        tiles.push(tile);
    }
    let ([width, height], metadata) = picture.unwrap_or_default();
    let pixels = tiles.iter().map(|tile| tile.pixels()).sum();
    if pixels == 0 || pixels != u64::from(width) * u64::from(height) {
        return Err(MergeError::Missing { pixels, width, height });
    }
    Ok((tiles, [width, height], metadata))
}

/// Puts tiles of data together: the picture that they are parts of, as if it had been rendered
/// whole.
///
/// # Errors
///
/// If they are not tiles of one picture, overlap, or do not cover it.
pub fn merge(pieces: &[Piece<Picture>]) -> Result<Picture, MergeError> {
    let (tiles, size, metadata) = layout(pieces, |piece| [piece.width, piece.height])?;
    let [width, height] = size.map(|side| side as usize);
    let size = width * height;
    let blank = |channel: &Channel| Channel {
        name: channel.name.clone(),
        samples: match channel.samples {
            Samples::F32(_) => Samples::F32(vec![0.0; size]),
            Samples::Rgb(_) => Samples::Rgb(vec![[0.0; 3]; size]),
            Samples::Bins(_) => Samples::Bins(vec![[0.0; BINS]; size]),
            Samples::F64(_) => Samples::F64(vec![0.0; size]),
        },
    };
    let samples = pieces.iter().flat_map(|(_, _, piece)| &piece.channels);
    check_memory(samples.map(|channel| channel.samples.bytes()).sum())?;
    let mut channels: Vec<Channel> = pieces[0].2.channels.iter().map(blank).collect();
    for ((name, _, piece), tile) in pieces.iter().zip(&tiles) {
        let differ = || differ(&pieces[0].0, name, "channels");
        if piece.channels.len() != channels.len() {
            return Err(differ());
        }
        for (channel, part) in channels.iter_mut().zip(&piece.channels) {
            match (&mut channel.samples, &part.samples) {
                _ if channel.name != part.name => return Err(differ()),
                (Samples::F32(whole), Samples::F32(part)) => tile.place(whole, width, part),
                (Samples::Rgb(whole), Samples::Rgb(part)) => tile.place(whole, width, part),
                (Samples::Bins(whole), Samples::Bins(part)) => tile.place(whole, width, part),
                (Samples::F64(whole), Samples::F64(part)) => tile.place(whole, width, part),
                _ => return Err(differ()),
            }
        }
    }
    Ok(Picture { width, height, channels, metadata })
}

/// As [`merge`], for 8-bit images.
///
/// # Errors
///
/// As [`merge`].
pub fn merge_images(pieces: &[Piece<RgbImage>]) -> Result<(RgbImage, Metadata), MergeError> {
    let size = |piece: &RgbImage| [piece.width(), piece.height()].map(|side| side as usize);
    let (tiles, [width, height], metadata) = layout(pieces, size)?;
    check_memory(3 * width as usize * height as usize)?;
    let mut whole = RgbImage::new(width, height);
    for ((_, _, piece), tile) in pieces.iter().zip(&tiles) {
        let (whole, _) = whole.as_chunks_mut::<3>();
        tile.place(whole, width as usize, piece.as_raw().as_chunks::<3>().0);
    }
    Ok((whole, metadata))
}
