//! Light in flight: arrays with an axis of time.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::render::{self, Arrivals, Delay, Flash, Flashed, FlightCube, FlightSettings, Gate};
use ndarray::{Array1, Array2, Array3, Array4};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Bins of a gate that is not given, about.
const BINS: usize = 120;

/// The delay of a name.
pub fn delay(name: &str) -> Result<Delay, Failure> {
    Delay::named(name).ok_or_else(|| {
        value_error(format!("delay is \"{name}\"; it must be \"group\" or \"phase\""))
    })
}

/// What a camera with a time gate sees when the photograph flashes. Gives the arrays by their names, the
/// middles of the bins as `time`, and how many branches were cut and lost.
#[pyfunction]
pub fn flight<'py>(
    py: Python<'py>,
    scene: &Scene,
    gate: Option<String>,
    pulse: f64,
    delay: &str,
    flash: &str,
    progress: Option<Py<PyAny>>,
) -> Result<(Bound<'py, PyDict>, (u64, u64)), Failure> {
    let gate: Option<Gate> = gate
        .map(|gate| gate.parse())
        .transpose()
        .map_err(|error| value_error(format!("gate: {error}")))?;
    let flash: Flash = flash.parse().map_err(|error| value_error(format!("flash: {error}")))?;
    if !(0.0..=1e6).contains(&pulse) {
        return Err(value_error(format!("pulse is {pulse}; it must be from 0 to 1000000 ns")));
    }
    let delay = self::delay(delay)?;
    let arrivals = Arrivals { delay, flash };
    let (cube, stats) = supervised(py, progress.as_ref(), |watch, supervision| {
        let prepared = scene.prepared()?;
        watch.begin(render::flight_steps(&prepared));
        let gate = match gate {
            Some(gate) => gate,
            None => {
                let times = render::arrival_times(&prepared, &arrivals).ok_or_else(|| {
                    value_error(
                        "no light of the photograph arrives at any time that is known; give a gate",
                    )
                })?;
                Gate::around([times[0] - pulse, times[1] + pulse], BINS)
            }
        };
        let settings = FlightSettings { gate, width: pulse, arrivals };
        Ok(FlightCube::new(&prepared, &settings, supervision)?)
    })?;
    let ([width, height], bins) = (cube.size, cube.gate.bins());
    let arrays = PyDict::new(py);
    arrays.set_item("time", Array1::from_vec(cube.gate.middles()).into_pyarray(py))?;
    let light = Array4::from_shape_vec((bins, height, width, 3), cube.light.into_flattened());
    arrays.set_item("light", light?.into_pyarray(py))?;
    let power = Array3::from_shape_vec((bins, height, width), cube.power);
    arrays.set_item("power", power?.into_pyarray(py))?;
    let image =
        |values: Vec<[f64; 3]>| Array3::from_shape_vec((height, width, 3), values.into_flattened());
    for (name, beside) in ["before", "after", "untimed"].into_iter().zip(cube.beside) {
        let power = beside.iter().map(|light: &Flashed| light[3]).collect();
        let light = beside.iter().map(|[red, green, blue, _]| [*red, *green, *blue]).collect();
        arrays.set_item(name, image(light)?.into_pyarray(py))?;
        let power = Array2::from_shape_vec((height, width), power);
        arrays.set_item(format!("{name}_power"), power?.into_pyarray(py))?;
    }
    arrays.set_item("steady", image(cube.steady)?.into_pyarray(py))?;
    arrays.set_item("picture", image(cube.picture)?.into_pyarray(py))?;
    Ok((arrays, (stats.endless, stats.lost)))
}
