//! The compiled half of the Python package `cloakroom`: what Python hands over is checked and
//! turned into scenes, rays and pictures, and what comes out goes back as numpy arrays. The other
//! half, in `cloakroom/`, is what people see: classes, names and docstrings. No physics is here.

mod drawings;
mod errors;
mod films;
mod flights;
mod images;
mod interfaces;
mod materials;
mod measuring;
mod memory;
mod page;
mod pictures;
mod rays;
mod scatterers;
mod scenes;
mod supervision;
mod tables;
mod values;

/// The compiled half of cloakroom; not to be used by itself.
#[pyo3::pymodule]
mod _cloakroom {
    #[pymodule_export]
    use super::drawings::{Drawing, diagram, setting};
    #[pymodule_export]
    use super::films::{animate, figures};
    #[pymodule_export]
    use super::flights::flight;
    #[pymodule_export]
    use super::images::Image;
    #[pymodule_export]
    use super::interfaces::interface;
    #[pymodule_export]
    use super::materials::{Material, export_grid, export_table};
    #[pymodule_export]
    use super::measuring::{flux, quality, sweep, verify};
    #[pymodule_export]
    use super::memory::check_memory;
    #[pymodule_export]
    use super::page::Page;
    #[pymodule_export]
    use super::pictures::{estimate, merge, png_bytes, pulses, read, render, save, srgb};
    #[pymodule_export]
    use super::rays::{export_paths, trace};
    #[pymodule_export]
    use super::scatterers::{device_bounds, outline_meshes, scatter};
    #[pymodule_export]
    use super::scenes::Scene;
    #[pymodule_export]
    use super::supervision::{fail_on_purpose, set_threads, threads};
    #[pymodule_export]
    use super::tables::{fit, key_names, schema};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
