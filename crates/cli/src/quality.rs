//! `cloakroom quality`: how well devices work over a range of settings.

use crate::arguments::QualityArguments;
use crate::interruption;
use crate::progress;
use crate::render::tell_rarities;
use crate::report::{self, Failure};
use crate::scene;
use cloakroom::measure::{Plan, QualityError, QualityTable, Sweep, TableFormat, quality};
use cloakroom::output;
use cloakroom::render::{RenderError, Supervision};
use cloakroom::scene_file;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// The columns that are printed for people; files hold all.
const PRINTED: [(&str, &str); 8] = [
    ("ideal_silhouette_correlation", "correlation"),
    ("ideal_silhouette_correlation_maximum", "best shift"),
    ("ideal_silhouette_structural_similarity", "SSIM"),
    ("ideal_silhouette_flip", "FLIP"),
    ("displacement_rms_cm", "off (cm)"),
    ("direction_error_rms_deg", "off (deg)"),
    ("delivered", "delivered"),
    ("uncloaked_area_cm2", "bad (cm2)"),
];

/// Measures every combination, writes every file asked for and prints the table.
pub fn run(arguments: &QualityArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let formats = formats(&arguments.outputs)?;
    scene::use_threads(arguments.threads)?;
    let sweeps: Vec<Sweep> = arguments
        .sweeps
        .iter()
        .map(|text| Sweep::parse(text))
        .collect::<Result<_, _>>()
        .map_err(Failure::from_error)?;
    let load = |further: &[String]| {
        scene_file::load(&arguments.scene.scene, &[&arguments.scene.overrides, further].concat())
    };
    let plan = Plan::new(sweeps, load).map_err(failure)?;
    plan.check_columns(&arguments.plot).map_err(Failure::from_error)?;
    for path in &arguments.outputs {
        output::check_writable(path).map_err(Failure::from_error)?;
    }
    let _busy = interruption::busy();
    let bar = progress::bar(plan.steps(), "measuring");
    let supervision = Supervision { rows_done: &|rows| bar.inc(rows), stop };
    let table = quality(&plan, &supervision);
    bar.finish_and_clear();
    let table = table.map_err(failure)?;
    tell_rarities(&table.rarities);
    for (path, format) in formats {
        table.write(format, &arguments.plot, path).map_err(Failure::from_error)?;
    }
    if arguments.json {
        return report::print_json(&table.to_json());
    }
    report::print(&text(&table).map_err(Failure::from_error)?)
}

fn failure(error: QualityError) -> Failure {
    match error {
        QualityError::Render(RenderError::Stopped) => Failure::Interrupted,
        error => Failure::from_error(error),
    }
}

/// The files to write with their formats.
fn formats(outputs: &[PathBuf]) -> Result<Vec<(&PathBuf, TableFormat)>, Failure> {
    let format = |path| {
        TableFormat::of(path).ok_or_else(|| {
            Failure::Failed(format!(
                "cannot tell the format of {} by its ending; use .csv, .npz, .svg or .png",
                path.display()
            ))
        })
    };
    outputs.iter().map(|path| Ok((path, format(path)?))).collect()
}

/// The table for people.
fn text(table: &QualityTable) -> Result<String, std::fmt::Error> {
    let mut text = String::from(
        "Over the silhouette, against what should be seen: a cloak's flat mirror, else the empty view\n\n",
    );
    let longest = |sweep: &Sweep| sweep.values.iter().map(String::len).max().unwrap_or(0);
    let widths: Vec<usize> =
        table.sweeps.iter().map(|sweep| sweep.key.len().max(longest(sweep))).collect();
    for (sweep, width) in table.sweeps.iter().zip(&widths) {
        write!(text, "{:>width$}  ", sweep.key)?;
    }
    for (_, title) in PRINTED {
        write!(text, "{title:>12}")?;
    }
    writeln!(text)?;
    for row in &table.rows {
        for (setting, width) in row.settings.iter().zip(&widths) {
            write!(text, "{setting:>width$}  ")?;
        }
        for (name, _) in PRINTED {
            let number = table.column(name).map_or(f64::NAN, |index| row.numbers[index]);
            let shown = if number.is_finite() { format!("{number:.4}") } else { "-".to_owned() };
            write!(text, "{shown:>12}")?;
        }
        writeln!(text)?;
    }
    Ok(text)
}
