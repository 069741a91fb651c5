//! `cloakroom figures`: the figures of the paper, drawn and rendered.

use crate::arguments::FiguresArguments;
use crate::panels;
use crate::report::{Failure, Result};
use cloakroom_figures::paper;
use cloakroom_figures::paper_figures::{make, names};

/// Makes panels and sheets.
pub fn run(arguments: &FiguresArguments) -> Result<()> {
    let chosen = paper::select(&arguments.only).map_err(Failure::Usage)?;
    panels::made(&arguments.panels, &arguments.out, names(&chosen), |maker| make(&chosen, maker))
}
