//! Light in flight in memory.

use super::super::{PreparedScene, RenderError, Supervision};
use super::{Flashed, FlightSettings, FlightTile, Gate, PixelBins, flight};
use crate::trace::TraceStats;
use std::sync::Mutex;

/// Light in flight in memory: every array frame by frame, row by row from the top left.
#[derive(Clone, Debug)]
pub struct FlightCube {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// When the gate was open.
    pub gate: Gate,
    /// Red, green and blue in each bin: (time, height, width, color).
    pub light: Vec<[f64; 3]>,
    /// The share of the power in each bin: (time, height, width).
    pub power: Vec<f64>,
    /// What comes before all bins, after them, and nobody knows when.
    pub beside: [Vec<Flashed>; 3],
    /// What does not flash.
    pub steady: Vec<[f64; 3]>,
    /// The picture without any gate, its leaves added by power.
    pub picture: Vec<[f64; 3]>,
}

impl FlightCube {
    /// Looks at light in flight.
    ///
    /// # Errors
    ///
    /// If it would not fit into memory, or the work was stopped.
    pub fn new(
        prepared: &PreparedScene<'_>,
        settings: &FlightSettings,
        supervision: &Supervision<'_>,
    ) -> Result<(Self, TraceStats), RenderError> {
        let [width, height] = prepared.scene.camera.resolution;
        let (gate, bins) = (settings.gate, settings.gate.bins());
        let pixels = width as usize * height as usize;
        crate::memory::check((pixels * bins * size_of::<Flashed>()) as u64, u64::MAX)
            .map_err(|shortage| RenderError::TooLarge { width, height, shortage })?;
        let flashed = || vec![[0.0; 4]; pixels];
        let cube = Mutex::new(Self {
            size: [width as usize, height as usize],
            gate,
            light: vec![[0.0; 3]; pixels * bins],
            power: vec![0.0; pixels * bins],
            beside: [flashed(), flashed(), flashed()],
            steady: vec![[0.0; 3]; pixels],
            picture: vec![[0.0; 3]; pixels],
        });
        let stats = flight(prepared, settings, supervision, |tile| {
            // A thread that panicked has taken the program with it.
            if let Ok(mut cube) = cube.lock() {
                cube.place(&tile);
            }
            Ok::<_, RenderError>(())
        })?;
        let cube = cube.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        Ok((cube, stats))
    }

    fn place(&mut self, part: &FlightTile) {
        let pixels = self.size[0] * self.size[1];
        for (number, index) in part.tile.places(self.size[0]).enumerate() {
            let PixelBins { first, light } = &part.bins[number];
            for (bin, flashed) in (*first..).zip(light) {
                let [red, green, blue, power] = *flashed;
                self.light[bin * pixels + index] = [red, green, blue];
                self.power[bin * pixels + index] = power;
            }
            let [before, after] = &part.outside;
            for (all, part) in self.beside.iter_mut().zip([before, after, &part.untimed]) {
                all[index] = part[number];
            }
            self.steady[index] = part.steady[number];
            self.picture[index] = part.picture[number];
        }
    }
}
