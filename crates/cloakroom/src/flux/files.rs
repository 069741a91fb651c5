//! Flux as data: CSV and NPZ.

use super::{FluxReport, Gain, STANDS};
use crate::output::{OutputError, write_npz};
use std::fmt::Write;
use std::path::Path;

/// Name, shape and values of each of a few arrays, the last index running fastest.
pub type Arrays = Vec<(&'static str, Vec<usize>, Vec<f64>)>;

/// What light is meant.
const LIGHTS: [&str; 3] = ["horizontal", "vertical", "unpolarized"];

/// A line for each direction: `label` (the angle or hour asked for), `incidence_deg`, and then for
/// each polarization the mean irradiance of the receiver for nothing, bare and cloaked with its
/// standard error, and the shadow given back in percent with its standard error (empty where there
/// is no shadow).
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

/// Arrays for numpy: `label`, `incidence_deg` and `direction` (3) of each direction; `total` and
/// `total_error` with the indices direction, stand (nothing, bare, cloaked), polarization
/// (horizontal, vertical, unpolarized); `given_back_percent` and `given_back_error` with the
/// indices direction, polarization (NaN without a shadow); `map`, the irradiance of unpolarized
/// light, with the indices direction, stand, and cell along and across the receiver, whose middles
/// (cm) are `along` and `across`; and for convergence `rays`, `cloaked_by_rays`,
/// `cloaked_error_by_rays`, `given_back_by_rays` and `given_back_error_by_rays`, indices direction
/// and step.
#[must_use]
pub fn flux_arrays(report: &FluxReport) -> Arrays {
    let all = &report.incidences;
    let count = all.len();
    let steps = all.first().map_or(0, |incidence| incidence.convergence.len());
    let [wide, long] = report.cells;
    let middles = |cells: usize, size: f64| {
        (0..cells).map(move |i| size * ((i as f64 + 0.5) / cells as f64 - 0.5))
    };
    let percent = |gain: Option<Gain>| gain.map_or(f64::NAN, |gain| gain.percent);
    let error = |gain: Option<Gain>| gain.map_or(f64::NAN, |gain| gain.error);
    let totals = || all.iter().flat_map(|i| i.totals.as_flattened());
    let gains = || all.iter().flat_map(|i| i.gains);
    let mut maps = all.iter().flat_map(|i| i.maps.iter().flatten().copied());
    let walk = || all.iter().flat_map(|i| &i.convergence);
    let size = [count, steps];
    let mut arrays = Arrays::new();
    let mut add = |name, shape: &[usize], values: &mut dyn Iterator<Item = f64>| {
        arrays.push((name, shape.to_vec(), values.collect()));
    };
    add("label", &[count], &mut all.iter().map(|i| i.direction.label));
    add("incidence_deg", &[count], &mut all.iter().map(|i| i.degrees));
    let mut along = all.iter().flat_map(|i| i.direction.along.to_array());
    add("direction", &[count, 3], &mut along);
    add("total", &[count, 3, 3], &mut totals().map(|total| total.mean));
    add("total_error", &[count, 3, 3], &mut totals().map(|total| total.error));
    add("given_back_percent", &[count, 3], &mut gains().map(percent));
    add("given_back_error", &[count, 3], &mut gains().map(error));
    add("map", &[count, 3, long, wide], &mut maps);
    add("across", &[wide], &mut middles(wide, report.size[0]));
    add("along", &[long], &mut middles(long, report.size[1]));
    add("rays", &size, &mut walk().map(|step| step.rays as f64));
    add("cloaked_by_rays", &size, &mut walk().map(|step| step.cloaked.mean));
    add("cloaked_error_by_rays", &size, &mut walk().map(|step| step.cloaked.error));
    add("given_back_by_rays", &size, &mut walk().map(|step| percent(step.gain)));
    add("given_back_error_by_rays", &size, &mut walk().map(|step| error(step.gain)));
    arrays
}

/// Writes [`flux_arrays`] as NPZ.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_flux_npz(report: &FluxReport, path: &Path) -> Result<(), OutputError> {
    write_npz(path, &report.metadata, |npz| {
        let arrays = flux_arrays(report);
        arrays.iter().try_for_each(|(name, shape, values)| npz.add(name, &shape[..], values))
    })
}
