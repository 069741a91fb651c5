//! Numbers for what pictures show: how alike two views are, how well a device does over a range of
//! its settings.
//!
//! - [`View`] is a picture to be measured, from memory or a file; [`PixelMask`] a part of it.
//! - [`compare`] holds two views against each other: correlation, structural similarity, FLIP,
//!   times of flight, power.
//! - [`survey`](survey()) asks the rays themselves: where they land, against where they should.
//! - [`quality`](quality()) does both for every combination of swept keys ([`Sweep`]).

mod column;
mod comparison;
mod constraint;
mod correlation;
mod counterparts;
mod flip;
mod measured;
mod pixel_mask;
mod plan;
mod plane;
mod quality;
mod quality_error;
mod quality_files;
mod statistics;
mod structural_similarity;
mod survey;
mod sweep;
mod view;
mod waypoint;

pub use column::{Column, UnknownColumn, name_and_unit};
pub use comparison::{Comparison, Figures, FlightFigures, Shifted, compare};
pub use constraint::{Constraint, ConstraintError};
pub use correlation::{BestShift, best_shift, correlation};
pub use counterparts::{bare, empty, ideal};
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, flip};
pub use measured::columns;
pub use pixel_mask::PixelMask;
pub use plan::SweepPlan;
pub use quality::{QualityRow, QualityTable, quality};
pub use quality_error::QualityError;
pub use structural_similarity::structural_similarity;
pub use survey::{CLOAKED_WITHIN_CM, IN_PLACE_WITHIN, Survey, survey};
pub use sweep::{Sweep, SweepError, combinations};
pub use view::View;
pub(crate) use waypoint::{Waypoint, without_rounding};

/// Why something cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// A file cannot be read as a picture.
    #[error(transparent)]
    Unreadable(#[from] crate::output::ReadError),
    /// An image cannot be loaded.
    #[error("{0}")]
    Image(#[from] crate::photograph::LoadError),
    /// A picture lacks a channel that is needed, or has a pixel in it that is infinite or not a
    /// number.
    #[error("{name} {problem}")]
    Channel {
        /// What the picture is called.
        name: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Two pictures, or a picture and a mask, differ in size.
    #[error("the sizes differ: {} x {} pixels and {} x {}", first[0], first[1], second[0], second[1])]
    SizesDiffer {
        /// Width and height of one.
        first: [usize; 2],
        /// Width and height of the other.
        second: [usize; 2],
    },
    /// A region holds no pixels.
    #[error("there are no pixels in the region to be measured")]
    EmptyRegion,
    /// A rectangle reaches beyond the picture.
    #[error("the rectangle reaches beyond the picture of {width} x {height} pixels")]
    OutsidePicture {
        /// Width of the picture.
        width: usize,
        /// Height of the picture.
        height: usize,
    },
    /// There is not enough memory.
    #[error("measuring pictures of {width} x {height} pixels {shortage}; take smaller ones")]
    TooLarge {
        /// Width of the pictures.
        width: usize,
        /// Height of the pictures.
        height: usize,
        /// The memory needed and there.
        shortage: crate::memory::Shortage,
    },
}
