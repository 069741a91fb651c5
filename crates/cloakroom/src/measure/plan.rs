//! What is to be measured, read and checked before the work.

use super::column::{Column, UnknownColumn, find_column, name_and_unit};
use super::constraint::Constraint;
use super::counterparts::ideal;
use super::measured::columns;
use super::quality_error::{QualityError, located};
use super::sweep::{Sweep, SweepError, combinations};
use crate::device::Imperfection;
use crate::render::{PreparedScene, PreparedSceneError, assembly};
use crate::scene::Scene;
use crate::scene_file::{Loaded, Override, SceneFileError};

/// A sweep with all its scenes read.
#[derive(Debug)]
pub struct SweepPlan {
    pub(super) sweeps: Vec<Sweep>,
    pub(super) holds: Vec<Constraint>,
    pub(super) scenes: Vec<Combination>,
    pub(super) draws: u32,
    /// What should be seen instead of the ideal, in place of the devices.
    pub(super) reference: Option<Scene>,
}

/// One combination of settings.
#[derive(Debug)]
pub(super) struct Combination {
    /// The value of each swept key.
    pub settings: Vec<String>,
    /// The value of each held key.
    pub held: Vec<f64>,
    pub loaded: Loaded,
}

impl SweepPlan {
    /// Reads the scene of every combination; `load` reads the scene with further overrides, such as
    /// `device.0.rotation=5`. Every scene is built once, so that what cannot be is told before the
    /// work. Held keys follow the swept ones so that a computed fact of their device stays what it
    /// is in the scene without sweeps.
    ///
    /// # Errors
    ///
    /// If the sweeps make no sense, a scene cannot be read or built, or a fact cannot be held.
    pub fn new(
        sweeps: Vec<Sweep>,
        holds: Vec<Constraint>,
        load: impl Fn(&[Override]) -> Result<Loaded, SceneFileError>,
    ) -> Result<Self, QualityError> {
        let load = |overrides: &[Override]| {
            load(overrides).map_err(|error| QualityError::Scene(Box::new(error)))
        };
        let both = |hold: &&Constraint| sweeps.iter().any(|sweep| sweep.key == hold.key);
        if let Some(hold) = holds.iter().find(both) {
            return Err(hold.refused("the key is both swept and held").into());
        }
        for (i, hold) in holds.iter().enumerate() {
            if holds[..i].iter().any(|other| other.key == hold.key) {
                return Err(SweepError::Twice(hold.key.clone()).into());
            }
        }
        let chosen = combinations(&sweeps)?;
        let targets: Vec<f64> = if holds.is_empty() {
            Vec::new()
        } else {
            let scene = load(&[])?.scene;
            holds.iter().map(|hold| hold.target(&scene)).collect::<Result<_, _>>()?
        };
        let scene = |chosen: Vec<usize>| {
            let chosen = || sweeps.iter().zip(&chosen);
            let settings = chosen().map(|(sweep, i)| sweep.values[*i].clone()).collect();
            let mut overrides: Vec<Override> = chosen().map(|(sweep, i)| sweep.set(*i)).collect();
            let swept: Vec<String> = overrides.iter().map(ToString::to_string).collect();
            let mut loaded = load(&overrides)?;
            let mut held = Vec::new();
            for (hold, target) in holds.iter().zip(&targets) {
                let value = hold.solve(&loaded.scene, *target, &swept)?;
                overrides.push(
                    Override::value(&hold.key, value)
                        .by(format!("--hold {}={}", hold.key, hold.fact)),
                );
                held.push(value);
                loaded = load(&overrides)?;
            }
            assembly(&loaded.scene).map_err(|error| located(&loaded, &error))?;
            Ok(Combination { settings, held, loaded })
        };
        let scenes = chosen.into_iter().map(scene);
        let scenes = scenes.collect::<Result<Vec<_>, QualityError>>()?;
        Ok(Self { sweeps, holds, scenes, draws: 1, reference: None })
    }

    /// The same plan, whose devices should look as those of another scene: an own carpet as its flat
    /// floor. Camera, light and photograph are those of the scene that is measured; what is swept
    /// changes nothing in the reference.
    #[must_use]
    pub fn with_reference(self, reference: Scene) -> Self {
        Self { reference: Some(reference), ..self }
    }

    /// Checks that the reference can stand in the place of the first scene.
    ///
    /// # Errors
    ///
    /// What is wrong with it there, such as that it cuts through the photograph.
    pub fn reference_stands(&self) -> Result<(), PreparedSceneError> {
        match self.scenes.first() {
            Some(one) if self.reference.is_some() => {
                PreparedScene::new(&self.wanted(&one.loaded.scene)).map(drop)
            }
            _ => Ok(()),
        }
    }

    /// What should be seen in the place of a scene.
    pub(super) fn wanted(&self, scene: &Scene) -> Scene {
        let Some(reference) = &self.reference else { return ideal(scene) };
        let mut wanted = Scene { devices: reference.devices.clone(), ..scene.clone() };
        for device in &mut wanted.devices {
            device.wavelength_nm = scene.light.wavelength_nm;
        }
        wanted
    }

    /// The same plan with that many draws of the devices' random errors for each combination, one
    /// at least.
    ///
    /// # Errors
    ///
    /// If there are several and nothing is random.
    pub fn with_draws(self, draws: u32) -> Result<Self, QualityError> {
        let random = self.scenes.iter().any(|one| is_random(&one.loaded.scene));
        if draws > 1 && !random {
            return Err(QualityError::NothingRandom(draws));
        }
        Ok(Self { draws: draws.max(1), ..self })
    }

    /// The scenes that are measured.
    pub fn scenes(&self) -> impl Iterator<Item = &Loaded> {
        self.scenes.iter().map(|combination| &combination.loaded)
    }

    /// How often a scene is drawn.
    pub(super) fn draws_of(&self, scene: &Scene) -> u32 {
        if is_random(scene) { self.draws } else { 1 }
    }

    /// The steps of its progress: the rows of all pictures, and of the surveys of rays.
    #[must_use]
    pub fn steps(&self) -> u64 {
        let steps = |one: &Combination| {
            let scene = &one.loaded.scene;
            let pictures = FIXED_PICTURES + PICTURES_A_DRAW * u64::from(self.draws_of(scene));
            pictures * u64::from(scene.camera.resolution[1])
        };
        self.scenes.iter().map(steps).sum()
    }

    /// What the numbers of each row will be: the held keys, then the figures.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        let held = self.holds.iter().map(|hold| {
            let (title, unit) = name_and_unit(&hold.key);
            Column { name: hold.key.clone(), title, unit }
        });
        held.chain(columns()).collect()
    }

    /// Checks before the work that a table will have columns of these names.
    ///
    /// # Errors
    ///
    /// If one has not.
    pub fn check_columns(&self, names: &[String]) -> Result<(), UnknownColumn> {
        let columns = self.columns();
        names.iter().try_for_each(|name| find_column(&columns, name).map(drop))
    }
}

/// The ideal and the empty view.
const FIXED_PICTURES: u64 = 2;

/// The scene, and the survey of rays.
const PICTURES_A_DRAW: u64 = 2;

fn is_random(scene: &Scene) -> bool {
    let placements = scene.devices.iter().map(|device| &device.placement);
    placements.flat_map(|placement| &placement.imperfection).any(Imperfection::is_random)
}

/// A scene with that draw of its devices' random errors.
pub(super) fn drawn(scene: &Scene, draw: u32) -> Scene {
    let mut scene = scene.clone();
    for device in &mut scene.devices {
        device.draw = draw;
    }
    scene
}
