//! What is drawn about pictures of invisibility cloaks, and made of many of them: maps of channels
//! in colour, plots, ray diagrams, settings to scale, sheets like the figures of a paper, tables,
//! films; the figures of the paper, the gallery and the example scenes; and the paper's statements,
//! verified.
//!
//! Pictures and numbers come from [`cloakroom`], which knows nothing of letters and lines.

mod axes;
mod color_bar;
mod color_scale;
mod diagram;
mod drawing;
pub mod examples;
pub mod film;
mod flux_pictures;
pub mod gallery;
pub mod panels;
pub mod paper;
pub mod paper_figures;
mod picture_file;
mod plot;
mod quality_plot;
mod quantity;
mod scalar_map;
mod setting;
mod sheet;
mod shrink;
mod table;
mod ticks;
pub mod verification;

pub use color_bar::ColorBar;
pub use color_scale::ColorScale;
pub use diagram::{DiagramError, DiagramSettings, Pulse, RayDiagram, Source};
pub use drawing::{Drawing, DrawingFormat, Element, Face, Ink, Shape, Stroke, Words};
pub use flux_pictures::{flux_map, flux_plot};
pub use picture_file::{PictureFormat, shown, write_picture};
pub use plot::{Curve, CurvePoint, Plot, PlotPanel};
pub use quality_plot::{STANDARD_PLOT, TableFormat, quality_plot, write_table};
pub use quantity::{Dimension, Quantity, Unit, short};
pub use scalar_map::ScalarMap;
pub use setting::{Setting, View, setting};
pub use sheet::{SheetPanel, sheet};
pub use table::{TablePicture, TableRow, table};

use cloakroom::measure::UnknownColumn;
use cloakroom::output::OutputError;
use std::path::PathBuf;

/// Why an illustration cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IllustrationError {
    /// The picture has no channel of that name.
    #[error("the picture has no channel `{name}`; it has {}", known.join(", "))]
    UnknownChannel {
        /// The name asked for.
        name: String,
        /// The channels there are.
        known: Vec<String>,
    },
    /// The channel does not hold one number for each pixel.
    #[error(
        "channel `{name}` holds {samples} numbers, not one for each of {width} x {height} pixels"
    )]
    WrongSize {
        /// The channel.
        name: String,
        /// How many numbers it holds.
        samples: usize,
        /// The picture's width in pixels.
        width: usize,
        /// The picture's height in pixels.
        height: usize,
    },
    /// A drawing with so many pixels does not fit into the memory.
    #[error("a drawing of {width} x {height} pixels does not fit into the memory; take fewer")]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A drawing was asked for of a picture that is shown as it is.
    #[error(
        "{} would be a map with its colour bar; set picture.map, as in picture.map=delivered, or use .png, .exr or .npz",
        path.display()
    )]
    NoMap {
        /// The file.
        path: PathBuf,
    },
    /// There is no such column in a table.
    #[error(transparent)]
    UnknownColumn(#[from] UnknownColumn),
    /// The file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// The size of type that suits a picture of so many pixels: 24 for 1024 x 768, in proportion, and
/// 13 at least.
fn type_size(width: u32, height: u32) -> f64 {
    let side = (f64::from(width) * f64::from(height)).sqrt();
    // A strip much longer than wide is lettered for its short side.
    let side = side.min(2.0 * f64::from(width.min(height)));
    (side / 37.0).round().max(13.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn type_grows_with_the_picture() {
        assert_eq!(type_size(1, 1), 13.0);
        assert_eq!(type_size(640, 480), 15.0);
        assert_eq!(type_size(1024, 768), 24.0);
        assert_eq!(type_size(4096, 3072), 96.0);
        assert_eq!(type_size(65_536, 4), 13.0);
    }
}
