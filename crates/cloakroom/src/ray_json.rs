//! Rays in, leaves out, as JSON: the form of `cloakroom trace`.

use crate::assembly::Assembly;
use crate::json;
use crate::memory::{self, Shortage};
use crate::trace::{Launch, LeafTable, RaySettings, Stopped};
use glam::DVec3;
use optics::wave::{ComplexVector, transverse_basis, unit};
use serde::{Deserialize, Serialize, Serializer};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How far from transverse a given electric field may be: |E·d|/|E|.
const TRANSVERSE: f64 = 1e-6;

/// A ray to be traced.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RayRequest {
    /// Where it starts, cm.
    pub origin: [f64; 3],
    /// Where it goes, of any length.
    pub direction: [f64; 3],
    /// Its polarization.
    #[serde(default)]
    pub polarization: Polarization,
}

/// The polarization of a ray to be traced.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum Polarization {
    /// E in the plane of the ray and z (along x for a ray along z).
    #[default]
    Horizontal,
    /// E perpendicular to the ray and z.
    Vertical,
    /// Any transverse field, of any norm; each component as [re, im].
    ElectricField([[f64; 2]; 3]),
}

/// What became of one ray.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct RayReport {
    /// The leaves, strongest first.
    pub leaves: Vec<LeafReport>,
    /// Share of the power absorbed, by media or on opaque bodies.
    pub absorbed: f64,
    /// Share of the power in branches too weak to follow.
    pub pruned: f64,
}

/// One leaf of a ray tree.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct LeafReport {
    /// The last point at which it left a device, cm; `None` if it met none.
    pub position: Option<[f64; 3]>,
    /// Its direction, a unit vector.
    pub direction: [f64; 3],
    /// Its share of the power.
    pub power: f64,
    /// Optical path length from the origin to `position`, cm; 0 if it met no device.
    pub optical_path: f64,
    /// The speed of light times what a pulse takes from the origin to `position`, cm, if it was
    /// asked for; NaN, written as null, where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group_path: Option<f64>,
    /// Its electric field, each component as [re, im]; |E|² = power.
    pub electric_field: [[f64; 2]; 3],
}

/// Why rays cannot be traced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RayError {
    /// A ray makes no sense.
    #[error("ray {index} (counted from 0): {problem}")]
    Ray {
        /// Which ray, counted from 0.
        index: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// There are more rays than leaves can be kept of.
    #[error("tracing {count} rays {shortage}; trace them in parts")]
    TooMany {
        /// How many rays.
        count: usize,
        /// The memory needed for their leaves and there.
        shortage: Shortage,
    },
    /// The work was stopped from outside.
    #[error("stopped")]
    Stopped(#[from] Stopped),
}

impl RayRequest {
    /// The ray to launch.
    ///
    /// # Errors
    ///
    /// A sentence if a number is not finite, the direction or the field vanishes, or the field is
    /// not transverse.
    pub fn launch(&self) -> Result<Launch<1>, String> {
        launch(self.origin, self.direction, [self.polarization])
    }
}

/// The ray to launch from a place (cm) in a direction, of any length, with some polarizations at
/// once.
///
/// # Errors
///
/// As [`RayRequest::launch`].
pub fn launch<const N: usize>(
    origin: [f64; 3],
    direction: [f64; 3],
    polarizations: [Polarization; N],
) -> Result<Launch<N>, String> {
    let [origin, direction] = [origin, direction].map(DVec3::from_array);
    if !origin.is_finite() || !direction.is_finite() {
        return Err("origin and direction must be finite numbers".to_owned());
    }
    let direction = unit(direction).ok_or("the direction is zero")?;
    let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
    let mut electric = [ComplexVector::ZERO; N];
    for (field, polarization) in electric.iter_mut().zip(polarizations) {
        *field = match polarization {
            Polarization::Horizontal => horizontal.into(),
            Polarization::Vertical => vertical.into(),
            Polarization::ElectricField(components) => transverse(components, direction)?,
        };
    }
    Ok(Launch { origin, direction, electric })
}

/// A field of unit norm across the direction from one that is given nearly so.
fn transverse(components: [[f64; 2]; 3], direction: DVec3) -> Result<ComplexVector, String> {
    let part = |i: usize| DVec3::from_array(components.map(|component| component[i]));
    let field = ComplexVector::new(part(0), part(1));
    let largest = field.re.abs().max_element().max(field.im.abs().max_element());
    if !field.re.is_finite() || !field.im.is_finite() {
        return Err("the electric field must consist of finite numbers".to_owned());
    }
    if largest == 0.0 {
        return Err("the electric field is zero".to_owned());
    }
    let field = field * (1.0 / largest);
    let along = field.dot_real(direction);
    let norm = field.norm_squared().sqrt();
    if along.norm() > TRANSVERSE * norm {
        return Err(format!(
            "the electric field is not transverse: |E.d|/|E| is {:.3e}, at most {TRANSVERSE:.0e} is \
             allowed",
            along.norm() / norm
        ));
    }
    let across = field - ComplexVector::new(direction * along.re, direction * along.im);
    Ok(across * (1.0 / across.norm_squared().sqrt()))
}

/// Reads rays from JSON, an array of them.
///
/// # Errors
///
/// If the text is none, or there is not enough memory for its rays.
pub fn read_rays(text: &str) -> serde_json::Result<Vec<RayRequest>> {
    let mut rays = Vec::new();
    json::read_list(text, |_, ray| {
        let each = size_of::<RayRequest>();
        memory::make_room(&mut rays, each)
            .map_err(|shortage| format!("reading its rays {shortage}"))?;
        rays.push(ray);
        Ok(())
    })?;
    Ok(rays)
}

/// Traces the rays that `launched(0)` to `launched(count - 1)` give, or say what is wrong with: see
/// [`LeafTable::trace`].
///
/// # Errors
///
/// If a ray makes no sense or starts in metal or an opaque body (the first such one is named),
/// there is not enough memory for the leaves, or the work was stopped.
pub fn leaf_table<const N: usize>(
    assembly: &Assembly,
    settings: impl Into<RaySettings>,
    count: usize,
    launched: &(impl Fn(usize) -> Result<Launch<N>, String> + Sync),
    done: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Result<LeafTable<N>, RayError> {
    let too_many = |shortage| RayError::TooMany { count, shortage };
    // Twice: while the table is put together.
    let needed = count as u64 * 2 * LeafTable::<N>::BYTES_PER_RAY as u64;
    // Rays are numbered in 32 bits.
    let most = u64::from(u32::MAX) * 2 * LeafTable::<N>::BYTES_PER_RAY as u64;
    memory::check(needed, most).map_err(too_many)?;
    // How many leaves a ray has is known when it has been traced.
    let room = memory::available().unwrap_or(u64::MAX);
    let [traced, taken] = [AtomicU64::new(0), AtomicU64::new(0)];
    let add = |sum: &AtomicU64, more: u64| sum.fetch_add(more, Ordering::Relaxed) + more;
    let batch_done = |batch: &LeafTable<N>| {
        add(&traced, batch.absorbed.len() as u64);
        add(&taken, 2 * batch.bytes() as u64);
        done(batch.absorbed.len() as u64);
    };
    // The ray to launch, if it makes sense and starts in air or a medium.
    let launch = |index: usize| {
        let [traced, taken] = [&traced, &taken].map(|sum| sum.load(Ordering::Relaxed));
        if taken > room {
            let each = taken as f64 / traced as f64;
            return Err(too_many(Shortage::new((each * count as f64) as u64, room)));
        }
        let wrong = |problem| RayError::Ray { index, problem };
        let launch = launched(index).map_err(wrong)?;
        assembly.region_around(launch.origin, launch.direction).map_err(|device| {
            wrong(format!(
                "it starts inside device {device} (counted from 0), in metal or an opaque \
                 body; rays start in air or in another medium"
            ))
        })?;
        Ok(launch)
    };
    LeafTable::trace(assembly, settings, count, &launch, &batch_done, stop)
}

/// What became of rays, in order; as JSON the array of the reports.
#[derive(Clone, Debug)]
pub struct RayReports {
    table: LeafTable,
    group_delays: bool,
}

impl RayReports {
    /// The report of each ray.
    pub fn iter(&self) -> impl Iterator<Item = RayReport> {
        let Self { table, group_delays } = self;
        let mut leaves = (0..table.ray.len()).peekable();
        let leaf = |leaf: usize| LeafReport {
            position: Some(table.position[leaf]).filter(|position| !position[0].is_nan()),
            direction: table.direction[leaf],
            power: table.power[leaf][0],
            optical_path: table.optical_path[leaf],
            group_path: group_delays.then(|| table.group_path[leaf]),
            electric_field: table.electric_field[leaf][0].map(|c| [c.re, c.im]),
        };
        let report = move |ray: usize| {
            let of_ray =
                std::iter::from_fn(|| leaves.next_if(|leaf| table.ray[*leaf] as usize == ray));
            RayReport {
                leaves: of_ray.map(leaf).collect(),
                absorbed: table.absorbed[ray][0],
                pruned: table.pruned[ray][0],
            }
        };
        (0..table.absorbed.len()).map(report)
    }
}

impl Serialize for RayReports {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// Traces rays, in order.
///
/// # Errors
///
/// If a ray makes no sense or starts in metal or an opaque body, there is not enough memory for the
/// leaves, or the work was stopped.
pub fn trace_rays(
    assembly: &Assembly,
    settings: impl Into<RaySettings>,
    rays: &[RayRequest],
    stop: &AtomicBool,
) -> Result<RayReports, RayError> {
    let settings = settings.into();
    let launched = |ray: usize| rays[ray].launch();
    let table = leaf_table(assembly, settings, rays.len(), &launched, &|_| {}, stop)?;
    Ok(RayReports { table, group_delays: settings.group_delays })
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;

    use crate::trace::{Limits, Tracer};
    use crate::{render, scene_file};
    use std::path::Path;

    fn parse(json: &str) -> RayRequest {
        serde_json::from_str(json).expect("a ray")
    }

    #[test]
    fn polarizations_are_read_as_documented() {
        let horizontal = parse(r#"{"origin": [0,0,0], "direction": [2,0,0]}"#).launch();
        assert_eq!(horizontal.map(|launch| launch.electric[0]), Ok(DVec3::Z.into()));
        let vertical =
            parse(r#"{"origin": [0,0,0], "direction": [1,0,0], "polarization": "vertical"}"#);
        assert_eq!(vertical.launch().map(|launch| launch.electric[0]), Ok(DVec3::Y.into()));
        let along_z = parse(r#"{"origin": [0,0,0], "direction": [0,0,-3]}"#).launch();
        assert_eq!(along_z.map(|launch| launch.electric[0]), Ok(DVec3::X.into()));
        let circular = parse(
            r#"{"origin": [0,0,0], "direction": [1,0,0],
                "polarization": {"electric_field": [[0,0],[3,0],[0,4]]}}"#,
        );
        let field = circular.launch().expect("transverse").electric[0];
        assert!((field.re.y - 0.6).abs() < 1e-15 && (field.im.z - 0.8).abs() < 1e-15);
    }

    #[test]
    fn nonsense_is_refused() {
        let refused = |json: &str| parse(json).launch().expect_err("must be refused");
        assert!(refused(r#"{"origin": [0,0,0], "direction": [0,0,0]}"#).contains("zero"));
        let along = r#"{"origin": [0,0,0], "direction": [1,0,0],
            "polarization": {"electric_field": [[1,0],[1,0],[0,0]]}}"#;
        assert!(refused(along).contains("not transverse"));
        let unknown: Result<RayRequest, _> =
            serde_json::from_str(r#"{"origin": [0,0,0], "direction": [1,0,0], "colour": 1}"#);
        assert!(unknown.is_err());
    }

    #[test]
    fn rays_are_those_that_are_traced_alone() {
        // Deep trees and flat ones, rays that miss, two devices with cells of their own.
        let text = "[[device]]\nkind = \"double-gaussian-cloak\"\n\
                    [[device]]\nkind = \"gaussian-carpet\"\nposition = [0, -60, 0]\n\
                    [[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\nposition = [0, 60, 0]\n";
        let scene = scene_file::parse(text, "a test", Path::new(""), &[]).unwrap().scene;
        let assembly = render::assembly(&scene).unwrap();
        let limits = Limits { min_power: 1e-6, tolerance: 1e-5 };
        let count = 165;
        let ray = |index: usize| RayRequest {
            origin: [-100.0, 0.0, 0.0],
            direction: [100.0, (index * 17 % 181) as f64 - 90.0, (index * 5 % 31) as f64 - 15.0],
            polarization: Polarization::Horizontal,
        };
        let stop = AtomicBool::new(false);
        let launched = |index: usize| ray(index).launch();
        let together = leaf_table(&assembly, limits, count, &launched, &|_| {}, &stop).unwrap();
        let mut alone = LeafTable::default();
        let mut tracer = Tracer::<1>::new(&assembly, limits);
        for index in 0..count {
            let (leaves, outcome) = tracer.trace(&ray(index).launch().unwrap());
            alone.push(index, leaves, outcome, &mut Vec::new());
        }
        // NaN stands for what met nothing.
        assert_eq!(format!("{together:?}"), format!("{alone:?}"));
        assert!(together.position.iter().any(|position| position[0].is_nan()));
        assert!(together.ray.len() > 2 * count);
    }
}
