//! Flux as data: CSV and NPZ.

use super::{FluxReport, STANDS};
use crate::output::{Arrays, OutputError, write_arrays};
use std::fmt::Write;
use std::path::Path;

/// What light is meant.
const LIGHTS: [&str; 3] = ["horizontal", "vertical", "unpolarized"];

/// A line for each direction: `label` (the angle or hour asked for), `incidence_deg`, and then for each polarization the
/// mean irradiance of the receiver for nothing, bare and cloaked with its standard error, and the shadow given back in
/// percent with its standard error (empty where there is no shadow).
#[must_use]
pub fn flux_csv(report: &FluxReport) -> String {
    let mut text = "label,incidence_deg".to_owned();
    for light in LIGHTS {
        for stand in STANDS {
            let name = stand.name();
            let _ = write!(text, ",{light}_{name},{light}_{name}_error");
        }
        let _ = write!(text, ",{light}_given_back_percent,{light}_given_back_error");
    }
    text.push('\n');
    for incidence in &report.incidences {
        let _ = write!(text, "{},{}", incidence.direction.label, incidence.degrees);
        for light in 0..LIGHTS.len() {
            for stand in STANDS {
                let total = incidence.totals[stand as usize][light];
                let _ = write!(text, ",{},{}", total.mean, total.error);
            }
            let _ = match incidence.gains[light] {
                Some(gain) => write!(text, ",{},{}", gain.percent, gain.error),
                None => write!(text, ",,"),
            };
        }
        text.push('\n');
    }
    text
}

/// Arrays for numpy: `label`, `incidence_deg` and `direction` (3) of each direction; `total` and `total_error` with
/// the indices direction, stand (nothing, bare, cloaked), polarization (horizontal, vertical, unpolarized);
/// `given_back_percent` and `given_back_error` with the indices direction, polarization (NaN without a shadow); `map`, the
/// irradiance of unpolarized light, with the indices direction, stand, and cell along and across the receiver, whose
/// middles (cm) are `along` and `across`; and for convergence `rays`, `cloaked_by_rays`, `cloaked_error_by_rays`,
/// `given_back_by_rays` and `given_back_error_by_rays`, indices direction and step.
#[must_use]
pub fn flux_arrays(report: &FluxReport) -> Arrays {
    let all = &report.incidences;
    let count = all.len();
    let mut arrays = Arrays::default();
    let steps = all.first().map_or(0, |incidence| incidence.convergence.len());
    let [wide, long] = report.cells;
    let middles = |cells: usize, size: f64| -> Vec<f64> {
        (0..cells).map(|i| size * ((i as f64 + 0.5) / cells as f64 - 0.5)).collect()
    };
    arrays.add("label", &[count], all.iter().map(|i| i.direction.label));
    arrays.add("incidence_deg", &[count], all.iter().map(|i| i.degrees));
    let along = all.iter().flat_map(|i| i.direction.along.to_array());
    arrays.add("direction", &[count, 3], along);
    let totals = || all.iter().flat_map(|i| i.totals.as_flattened());
    arrays.add("total", &[count, 3, 3], totals().map(|total| total.mean));
    arrays.add("total_error", &[count, 3, 3], totals().map(|total| total.error));
    let gains = || all.iter().flat_map(|i| i.gains);
    let percent = gains().map(|gain| gain.map_or(f64::NAN, |gain| gain.percent));
    arrays.add("given_back_percent", &[count, 3], percent);
    let errors = gains().map(|gain| gain.map_or(f64::NAN, |gain| gain.error));
    arrays.add("given_back_error", &[count, 3], errors);
    let maps = all.iter().flat_map(|i| i.maps.iter().flatten().copied());
    arrays.add("map", &[count, 3, long, wide], maps);
    arrays.add("across", &[wide], middles(wide, report.size[0]).into_iter());
    arrays.add("along", &[long], middles(long, report.size[1]).into_iter());
    let walk = || all.iter().flat_map(|i| &i.convergence);
    let size = [count, steps];
    arrays.add("rays", &size, walk().map(|step| step.rays as f64));
    arrays.add("cloaked_by_rays", &size, walk().map(|step| step.cloaked.mean));
    arrays.add("cloaked_error_by_rays", &size, walk().map(|step| step.cloaked.error));
    let by_rays = walk().map(|step| step.gain.map_or(f64::NAN, |gain| gain.percent));
    arrays.add("given_back_by_rays", &size, by_rays);
    let by_rays = walk().map(|step| step.gain.map_or(f64::NAN, |gain| gain.error));
    arrays.add("given_back_error_by_rays", &size, by_rays);
    arrays
}

/// Writes [`flux_arrays`] as NPZ.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_flux_npz(report: &FluxReport, path: &Path) -> Result<(), OutputError> {
    write_arrays(&flux_arrays(report), &report.metadata, path)
}
