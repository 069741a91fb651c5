//! Random rays, and what must hold for the tree of each.

use crate::draws::Draws;
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::device::Dispersion;
use cloakroom::trace::{Launch, Leaf, Outcome, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;

/// How far the account of the power may be off, of what is launched.
pub(crate) const BALANCE: f64 = 1e-9;

/// How far a leaf's direction may be from unit length, and |E|² from its power, for each kilometre of
/// its way or less: the normals of a surface some cm wide are as uncertain as the places on it.
const SOUND: f64 = 1e-9;

/// A kilometre, cm.
const KILOMETRE: f64 = 1e5;

/// How much sooner than light in air a pulse may come by rounding, as a share of the way.
const SOONER: f64 = 1e-6;

/// What is wrong with the tree of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A number in it is none.
    NotFinite,
    /// A leaf is no wave in air.
    Unsound,
    /// What comes out is not what went in, by this share of it.
    Unbalanced(f64),
    /// A pulse has run faster than light, by so much, cm.
    Early(f64),
    /// The account adds up, but so many branches could not be followed.
    Lost(u64),
}

/// A ray towards a place within `reach` (cm) of the origin, as a rule; some run along an axis,
/// through the very middle, or from anywhere to anywhere.
pub fn launch(draws: &mut Draws<'_>, reach: f64) -> Launch<2> {
    const AXES: [DVec3; 6] =
        [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let from = draws.direction() * draws.between(1.5, 4.0) * reach;
    let target = DVec3::new(draws.share(), draws.share(), draws.share()) - DVec3::splat(0.5);
    let target = target * 2.0 * reach;
    let (origin, direction) = match draws.below(16) {
        0..12 => (from, target - from),
        12 | 13 => {
            let axis = *draws.pick(&AXES);
            (target - axis * (4.0 * reach), axis)
        }
        14 => (from, -from),
        _ => {
            let flat = DVec3::new(from.x, from.y, 0.0);
            (flat, DVec3::new(target.x.round(), target.y.round(), 0.0) - flat)
        }
    };
    launch_along(origin, direction)
}

/// A ray of horizontal and vertical light; along x without a direction.
pub(crate) fn launch_along(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.try_normalize().unwrap_or(DVec3::X);
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// The same tracer, working out what pulses take unless a device says that its medium has no
/// dispersion: then they may be faster than light.
#[must_use]
pub fn timed<'a>(tracer: Tracer<'a, 2>, assembly: &Assembly) -> Tracer<'a, 2> {
    let causal = |device: &Placed| device.dispersion == Dispersion::Causal;
    if assembly.devices().iter().all(causal) { tracer.with_group_delays() } else { tracer }
}

/// Whether a ray starts in air.
#[must_use]
pub fn starts_in_air(assembly: &Assembly, launch: &Launch<2>) -> bool {
    assembly.device_containing(launch.origin).is_none()
}

/// Looks at the tree of a ray that starts at `origin`: how far the account of its power is off.
///
/// # Errors
///
/// What is wrong with it.
pub fn examine<const N: usize>(
    origin: DVec3,
    leaves: &[Leaf<N>],
    outcome: &Outcome<N>,
) -> Result<f64, Fault> {
    for leaf in leaves {
        let finite = leaf.position.is_finite()
            && leaf.direction.is_finite()
            && leaf.optical_path.is_finite()
            && leaf.delay_path.is_finite()
            && leaf.power.iter().all(|power| power.is_finite())
            && leaf.electric.iter().all(|field| field.norm_squared().is_finite());
        if !finite {
            return Err(Fault::NotFinite);
        }
        // What ends on an opaque body counts as a leaf in air, too: there the field is that which
        // arrives.
        let sizes = leaf.electric.iter().zip(leaf.power);
        let sound = SOUND * (leaf.optical_path.abs() / KILOMETRE).max(1.0);
        let unsound = (leaf.direction.length() - 1.0).abs() > SOUND
            || leaf.power.iter().any(|power| *power < 0.0)
            || sizes.into_iter().any(|(field, power)| (field.norm_squared() - power).abs() > sound);
        if unsound {
            return Err(Fault::Unsound);
        }
        let straight = leaf.position.distance(origin);
        if let Some(early) = leaf.group_path.map(|path| straight - path)
            && early > SOONER * (1.0 + straight)
        {
            return Err(Fault::Early(early));
        }
    }
    let off = outcome.imbalance(leaves);
    match outcome.stats.lost {
        _ if off == f64::INFINITY => Err(Fault::NotFinite),
        _ if off > BALANCE => Err(Fault::Unbalanced(off)),
        0 => Ok(off),
        lost => Err(Fault::Lost(lost)),
    }
}
