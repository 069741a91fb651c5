//! `cloakroom flux`: the light that comes through to a receiver.

use crate::arguments::FluxArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::progress::supervised;
use crate::report::{Failure, Result, all, decimals, say};
use crate::{interruption, render, report, scene};
use cloakroom::flux::{self, Direction, FluxError, FluxReport, Gain, Sampling};
use cloakroom::output;
use cloakroom::scene::Scene;
use cloakroom::trace::TraceStats;
use cloakroom_figures::{Drawing, DrawingFormat, TableFormat, flux_map, flux_plot};
use std::fmt::Write;
use std::path::Path;

/// Measures the flux and writes every file asked for.
pub fn run(arguments: &FluxArguments) -> Result<()> {
    let files = formats(&arguments.outputs, TableFormat::of)?;
    let map = formats(arguments.map.as_slice(), DrawingFormat::of)?;
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let inputs = scene::inputs(&arguments.scene, &loaded);
    check_outputs(arguments.outputs.iter().chain(&arguments.map), &inputs)?;
    let (directions, axis) = directions(arguments, &loaded.scene)?;
    let sampling =
        Sampling { rays: arguments.rays, samples: arguments.samples, cells: arguments.cells };
    let _busy = interruption::busy();
    let measured = supervised(0, "tracing", |bar, supervision| {
        let begun = |steps| bar.set_length(steps);
        flux::flux(&loaded.scene, &directions, sampling, &begun, supervision)
    });
    let measured = measured.map_err(|error| match error {
        FluxError::Scene(error) => scene::located(&loaded, &error),
        error => error.into(),
    })?;
    let mut stats = TraceStats::default();
    measured.incidences.iter().for_each(|incidence| stats += incidence.stats);
    render::warn_of_cut_branches(&stats);
    let written = write_each(files, |path, format| write(&measured, axis, format, path));
    let mapped = write_each(map, |path, format| match flux_map(&measured, axis) {
        Some(drawing) => save(&drawing, "Irradiance of the receiver", &measured, (path, format)),
        None => Ok(()),
    });
    all([written, mapped, report::print(&table(&measured, axis))])
}

/// The directions asked for, and what they are named by.
fn directions(arguments: &FluxArguments, scene: &Scene) -> Result<(Vec<Direction>, &'static str)> {
    let receiver = &scene.receiver;
    if let Some([latitude, declination]) = arguments.sun {
        let day = flux::sun_day(receiver, latitude, declination, 0.5);
        if day.is_empty() {
            return Err(Failure::Failed(
                "the sun does not rise above the receiver that day".to_owned(),
            ));
        }
        return Ok((day, "Solar time (h)"));
    }
    let [from, to, step] = arguments.angles;
    let count = ((to - from) / step + 1e-9).floor() as u32;
    let angles: Vec<f64> = (0..=count).map(|k| from + f64::from(k) * step).collect();
    Ok((flux::across_range(receiver, &angles, arguments.tilt), "Angle of incidence (°)"))
}

fn write(measured: &FluxReport, axis: &str, format: TableFormat, path: &Path) -> Result<()> {
    match format {
        TableFormat::Npz => Ok(flux::write_flux_npz(measured, path)?),
        TableFormat::Csv => {
            let text = flux::flux_csv(measured);
            Ok(output::write_whole(path, |out| out.write_all(text.as_bytes()))?)
        }
        TableFormat::Plot(format) => {
            let drawing = flux_plot(measured, axis).draw();
            save(&drawing, "Flux on the receiver", measured, (path, format))
        }
    }
}

fn save(
    drawing: &Drawing,
    title: &str,
    measured: &FluxReport,
    (path, format): (&Path, DrawingFormat),
) -> Result<()> {
    let size = drawing.pixels();
    if format == DrawingFormat::Png {
        say(&format!("{}: {} x {} pixels", path.display(), size[0], size[1]));
    }
    Ok(drawing.write(format, title, &measured.metadata, size, path)?)
}

/// The totals and their convergence in words.
fn table(measured: &FluxReport, axis: &str) -> String {
    let mut text = format!(
        "{axis:>22} {:>9} {:>9} {:>19} {:>23}\n",
        "nothing", "bare", "cloaked", "shadow given back, %"
    );
    let given = |gain: Option<Gain>| {
        gain.map_or("-".to_owned(), |gain| {
            format!("{} ± {:.3}", decimals(gain.percent, 3), gain.error)
        })
    };
    // Writing to a string cannot fail.
    for incidence in &measured.incidences {
        let [nothing, bare, cloaked] = incidence.totals.map(|stand| stand[2]);
        let given = given(incidence.gains[2]);
        let _ = writeln!(
            text,
            "{:>22} {:>9.5} {:>9.5} {:>9.5} ± {:>7.5} {given:>23}",
            decimals(incidence.direction.label, 4),
            nothing.mean,
            bare.mean,
            cloaked.mean,
            cloaked.error
        );
    }
    if let Some(middle) = measured.incidences.get(measured.incidences.len() / 2) {
        let _ = writeln!(text, "convergence at {}:", middle.direction.label);
        for step in &middle.convergence {
            let given = given(step.gain);
            let _ = writeln!(
                text,
                "{:>12} rays: cloaked {:.5} ± {:.5}, given back {given} %",
                step.rays, step.cloaked.mean, step.cloaked.error
            );
        }
    }
    text
}
