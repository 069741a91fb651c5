//! `cloakroom quality`: how well devices work over a range of settings.

use crate::arguments::QualityArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::interruption;
use crate::progress::supervised;
use crate::render::warn_of_cut_branches;
use crate::report::{self, Result, all, decimals, say};
use crate::scene;
use cloakroom::measure::{Constraint, QualityTable, Sweep, SweepPlan, quality};
use cloakroom::scene_file::Override;
use cloakroom_figures::{TableFormat, write_table};
use std::fmt::Write;

/// The columns that are printed for people; files hold all.
const PRINTED: [(&str, &str); 9] = [
    ("in_place_share", "in place"),
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
pub fn run(arguments: &QualityArguments) -> Result<()> {
    let formats = formats(&arguments.outputs, TableFormat::of)?;
    scene::use_threads(&arguments.threads)?;
    let sweeps =
        arguments.sweeps.iter().map(|text| Sweep::parse(text)).collect::<Result<_, _>>()?;
    let written = scene::text(&arguments.scene.scene)?;
    let set = scene::set(&arguments.scene, &arguments.format);
    let load = |further: &[Override]| written.scene(&[&set[..], further].concat());
    let holds =
        arguments.holds.iter().map(|text| Constraint::parse(text)).collect::<Result<_, _>>()?;
    let plan = SweepPlan::new(sweeps, holds, load)?.with_draws(arguments.draws)?;
    let reference = match &arguments.reference {
        Some(path) => Some(scene::text(path)?.scene(&[])?),
        None => None,
    };
    let plan = match &reference {
        Some(reference) => {
            scene::assembly(reference)?;
            let plan = plan.with_reference(reference.scene.clone());
            plan.reference_stands().map_err(|error| scene::located(reference, &error))?;
            plan
        }
        None => plan,
    };
    plan.check_columns(&arguments.plot)?;
    let inputs = plan.scenes().flat_map(|loaded| scene::inputs(&arguments.scene, loaded));
    let inputs = inputs.chain(arguments.reference.clone());
    check_outputs(&arguments.outputs, &inputs.collect::<Vec<_>>())?;
    let _busy = interruption::busy();
    let table =
        supervised(plan.steps(), "measuring", |_, supervision| quality(&plan, supervision))?;
    warn_of_cut_branches(&table.stats);
    let delivered = table.column("delivered").map(|column| {
        table.rows.iter().map(move |row| row.numbers[column]).filter(|share| !share.is_nan())
    });
    if let Ok(mut delivered) = delivered {
        // In the dark all pictures are alike.
        let brightest = delivered.clone().fold(0.0, f64::max);
        if delivered.next().is_none() {
            say(
                "note: there is nothing to measure: no device is in view (`cloakroom check` says why)",
            );
        } else if brightest == 0.0 {
            say(
                "note: no light of the photograph arrives (`cloakroom check` says why): likeness tells nothing",
            );
        }
    }
    let written =
        write_each(formats, |path, format| Ok(write_table(&table, format, &arguments.plot, path)?));
    let printed = if arguments.json {
        report::print_json(&table.to_json())
    } else {
        let wanted = match arguments.reference {
            Some(_) => "the reference",
            None => "what should be seen: a cloak's flat mirror, else the empty view",
        };
        report::print(&text(&table, wanted)?)
    };
    all([written, printed])
}

/// The table for people; `wanted` is what the scenes were held against.
fn text(table: &QualityTable, wanted: &str) -> Result<String, std::fmt::Error> {
    let mut text = format!("Over the silhouette, against {wanted}\n");
    if table.has_errors() {
        let draws = table.draws;
        writeln!(
            text,
            "Means of {draws} draws, with the standard error of the last digits: 0.98(3) is 0.98 ± 0.03"
        )?;
    }
    writeln!(text)?;
    let longest = |sweep: &Sweep| sweep.values.iter().map(String::len).max().unwrap_or(0);
    let widths: Vec<usize> =
        table.sweeps.iter().map(|sweep| sweep.key.len().max(longest(sweep))).collect();
    for (sweep, width) in table.sweeps.iter().zip(&widths) {
        write!(text, "{:>width$}  ", sweep.key)?;
    }
    // Held keys, which are no figures, are told apart by their dots.
    let held = table.columns.iter().filter(|column| column.name.contains('.'));
    let held = held.map(|column| (column.name.as_str(), column.name.as_str()));
    let printed: Vec<(&str, &str)> = held.chain(PRINTED).collect();
    let column = |title: &str| (title.len() + 2).max(if table.has_errors() { 14 } else { 12 });
    for (_, title) in &printed {
        write!(text, "{title:>width$}", width = column(title))?;
    }
    writeln!(text)?;
    for row in &table.rows {
        for (setting, width) in row.settings.iter().zip(&widths) {
            write!(text, "{setting:>width$}  ")?;
        }
        for (name, title) in &printed {
            let shown = table.column(name).map_or_else(
                |_| "-".to_owned(),
                |index| number(row.numbers[index], row.standard_errors[index]),
            );
            write!(text, "{shown:>width$}", width = column(title))?;
        }
        writeln!(text)?;
    }
    Ok(text)
}

/// A number to four decimals, or to where two digits of its error end; in brackets the error in
/// units of the last one.
fn number(mean: f64, error: f64) -> String {
    if !mean.is_finite() {
        return "-".to_owned();
    }
    if error.is_nan() || error <= 0.0 {
        return decimals(mean, 4);
    }
    let digits = (1.0 - error.log10().floor()).clamp(0.0, 4.0);
    let places = digits as usize;
    let last = (error * 10f64.powf(digits)).round().max(1.0);
    format!("{}({last})", decimals(mean, places))
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn errors_stand_behind_the_digits_they_are_of() {
        assert_eq!(number(0.98765, 0.0), "0.9877");
        assert_eq!(number(0.98765, 0.0312), "0.988(31)");
        assert_eq!(number(-2.5, 0.4), "-2.50(40)");
        assert_eq!(number(12345.6, 123.0), "12346(123)");
        assert_eq!(number(0.5, 1e-7), "0.5000(1)");
        assert_eq!((number(-1e-9, 0.0), number(-1e-9, 0.1)), ("0.0000".into(), "0.00(10)".into()));
        assert_eq!(number(f64::NAN, f64::NAN), "-");
    }
}
