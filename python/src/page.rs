//! The interactive page.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use cloakroom_viewer::{Settings, ViewerError, WayIn, serve};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};

/// A page that is served, until it is closed.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Page {
    address: String,
    way_in: Option<WayIn>,
    /// A server may outlive whoever has begun it.
    stop: &'static AtomicBool,
    server: Mutex<Option<JoinHandle<()>>>,
}

#[pymethods]
impl Page {
    /// Serves a scene on a port of this machine, 0 for any.
    #[new]
    fn new(py: Python<'_>, scene: &Scene, name: String, port: u16) -> Result<Self, Failure> {
        if scene.shows_array() {
            return Err(value_error(
                "an image of the scene is an array; the page shows files: save it as a .png and name that",
            ));
        }
        let (scene, folder) = (scene.loaded().clone(), scene.folder().to_owned());
        let host = Ipv4Addr::LOCALHOST.into();
        let settings = Settings { scene, name, folder, host, port };
        let stop: &'static AtomicBool = Box::leak(Box::new(AtomicBool::new(false)));
        let (ready, news) = channel::<Result<String, ViewerError>>();
        let server = thread::spawn(move || {
            let served = serve(&settings, |address| _ = ready.send(Ok(address.to_owned())), stop);
            if let Err(error) = served {
                // Nobody hears of it if the page has been up before.
                let _ = ready.send(Err(error));
            }
        });
        let ended = |_| PyOSError::new_err("the server has ended before it could be reached");
        let address = py.detach(move || news.recv()).map_err(ended)?;
        let address = address.map_err(|error| match error {
            ViewerError::Scene(message) => value_error(message),
            error => PyOSError::new_err(error.to_string()).into(),
        })?;
        let way_in = WayIn::new(&address).ok();
        Ok(Self { address, way_in, stop, server: Mutex::new(Some(server)) })
    }

    /// Its address.
    #[getter]
    fn address(&self) -> &str {
        &self.address
    }

    /// A file that leads a browser to it, which nobody else can read.
    #[getter]
    fn way_in(&self) -> Option<PathBuf> {
        self.way_in.as_ref().map(WayIn::path)
    }

    /// Ends it.
    fn close(&self, py: Python<'_>) {
        self.stop.store(true, Ordering::Relaxed);
        let server = self.server.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(server) = server {
            // A panic in it has been told on standard error.
            let _ = py.detach(|| server.join());
        }
    }
}
