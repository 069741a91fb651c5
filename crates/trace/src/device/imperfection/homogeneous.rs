//! Homogeneous segments and bodies: the principal values of their tensors.

use super::super::structure::segments;
use super::super::{Region, Structure};
use super::{Deviates, Imperfection, Process, TABLE};
use crate::keys::KeyError;
use glam::{DMat3, DVec3};
use optics::medium::{Medium, Tensor, principal_axes};

/// Principal values closer than this, relative to the largest, are one value.
const SAME: f64 = 1e-9;

/// Makes the media of a structure without graded regions imperfect.
pub(super) fn apply(
    imperfection: &Imperfection,
    deviates: &Deviates,
    structure: &mut Structure,
) -> Result<(), KeyError> {
    let groups = segments(&structure.regions);
    let regions = structure.regions.iter_mut().zip(groups.into_iter().map(|first| first as u64));
    let media = regions.filter_map(|(region, group)| match region {
        Region::Homogeneous(region) => Some((group, &mut region.medium)),
        Region::Conformal(_) | Region::Radial(_) | Region::ClosedForm(_) | Region::Spatial(_) => {
            None
        }
    });
    let mut media: Vec<(u64, &mut Medium)> = media.collect();
    let values = media.iter().flat_map(|(_, medium)| {
        let (permittivity, permeability) = medium.tensors();
        [permittivity, permeability].into_iter().filter(|tensor| !is_vacuum(tensor))
    });
    let design = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, largest], tensor| {
        let values = principal_axes(&tensor.re).0;
        [least.min(values.min_element()), largest.max(values.max_element())]
    });
    let process = imperfection.process(design);
    for (group, medium) in &mut media {
        let (permittivity, permeability) = medium.tensors();
        let made = |tensor: &Tensor, first: u64| {
            let normal = |k: u64| deviates.normal(group.wrapping_mul(6) + first + k);
            made(imperfection, &process, tensor, &normal)
        };
        let made = (made(&permittivity, 0), made(&permeability, 3));
        if made == (permittivity, permeability) {
            continue;
        }
        **medium = Medium::new(made.0, made.1).map_err(|error| {
            KeyError::at(TABLE, format!("with this imperfection there is no medium left: {error}"))
        })?;
    }
    Ok(())
}

fn is_vacuum(tensor: &Tensor) -> bool {
    tensor.re == DMat3::IDENTITY && tensor.im == DMat3::ZERO
}

/// What is made of a tensor: its real part, and its loss beside what it has by design.
fn made(
    imperfection: &Imperfection,
    process: &Process,
    tensor: &Tensor,
    normal: &dyn Fn(u64) -> f64,
) -> Tensor {
    if is_vacuum(tensor) {
        return *tensor;
    }
    let (values, axes) = principal_axes(&tensor.re);
    let largest = values.abs().max_element();
    let mut factors = DVec3::ZERO;
    for i in 0..3 {
        let first = (0..i).find(|&j| (values[j] - values[i]).abs() <= SAME * largest);
        factors[i] = first.map_or_else(
            || process.made(values[i]) / values[i] * (1.0 + imperfection.error * normal(i as u64)),
            |j| factors[j],
        );
    }
    let changed = values * factors;
    let built = |values: DVec3| Tensor::from(DMat3::from_diagonal(values)).turned(&axes).re;
    let re = if factors == DVec3::ONE { tensor.re } else { built(changed) };
    let loss = imperfection.loss_tangent;
    let im = if loss > 0.0 { tensor.im + built(changed.abs() * loss) } else { tensor.im };
    Tensor { re, im }
}
