//! Measures of a distribution: its integral, its reciprocity, and whether it is a distribution at all.

use super::{Distribution, DistributionError};
use crate::numeric::cubature::{Integral, unit_square};
use crate::numeric::sampling::{RandomStream, cosine_hemisphere};
use glam::DVec3;

/// The direction to a light at an angle of incidence, radians, in the plane of x and z.
pub fn light_at(incidence: f64) -> DVec3 {
    let (sin, cos) = incidence.sin_cos();
    DVec3::new(sin, 0.0, cos)
}

/// The share of the flux density that is emitted: the integral of D over the outgoing hemisphere.
///
/// The directions are those of [`Distribution::sample`], so that a narrow lobe is as easy as a wide one: the integral
/// is the mean of density over pdf over the unit square.
///
/// - `tolerance`: the error to stop at. `most`: evaluations to stop at, some 1e3..1e7.
pub fn emitted_share(distribution: &dyn Distribution, light: DVec3, tolerance: f64, most: u32) -> Integral {
    let weight = |point| match distribution.sample(light, point) {
        Some(view) => {
            let (density, sampled) = (distribution.density(light, view), distribution.pdf(light, view));
            if sampled > 0.0 { density / sampled } else { 0.0 }
        }
        None => 0.0,
    };
    unit_square(weight, tolerance, most)
}

/// The share of the light of an even sky that a viewer sees: what a surface of this distribution shows in a picture
/// where light of the same radiance comes from everywhere, the integral of D(light, viewer) (N·L) / (N·V) over all
/// lights.
///
/// A reciprocal distribution has the same integrals with light and viewer exchanged, and this is its [`emitted_share`].
///
/// - `tolerance`, `most`: as in [`emitted_share`].
pub fn received_share(distribution: &dyn Distribution, view: DVec3, tolerance: f64, most: u32) -> Integral {
    let weight = |point| match distribution.sample(view, point) {
        Some(light) => {
            let (density, sampled) = (distribution.density(light, view), distribution.pdf(view, light));
            if sampled > 0.0 { density * light.z / (view.z * sampled) } else { 0.0 }
        }
        None => 0.0,
    };
    unit_square(weight, tolerance, most)
}

/// Pairs of directions as they occur: light anywhere, viewer where the distribution sends it, or anywhere.
///
/// - `count`: how many. `seed`: of the random numbers.
fn pairs(distribution: &dyn Distribution, count: u64, seed: u64) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    (0..count).filter_map(move |index| {
        let mut stream = RandomStream::new(seed, index);
        // Half of the cosines come near grazing, one for each decade down to 89.9999 degrees.
        let mut anywhere = || {
            let direction = cosine_hemisphere(stream.point(), DVec3::Z);
            let grazing = 1.7e-6_f64.powf(stream.uniform());
            let z = if stream.uniform() < 0.5 { grazing } else { direction.z.max(1.7e-6) };
            let along = direction.truncate().try_normalize().unwrap_or(glam::DVec2::X);
            (along * (1.0 - z * z).max(0.0).sqrt()).extend(z)
        };
        let (light, other) = (anywhere(), anywhere());
        let view = if index % 4 == 0 { Some(other) } else { distribution.sample(light, stream.point()) };
        view.map(|view| (light, view))
    })
}

/// How far a distribution is from reciprocal: the largest |f − f'| / (f + f') over random pairs of directions, where f
/// is D / (N·V), and f' the same with light and viewer exchanged.
///
/// - `count`: pairs. `seed`: of the random numbers.
/// - Returns 0..=1; rounding alone gives some 1e-9 at a roughness of 1e-6.
pub fn reciprocity_residual(distribution: &dyn Distribution, count: u64, seed: u64) -> f64 {
    let residual = |(light, view): (DVec3, DVec3)| {
        let (there, back) = (distribution.density(light, view) / view.z, distribution.density(view, light) / light.z);
        let sum = there + back;
        // Both may be too small to be anything but zero.
        if sum > 1e-250 { (there - back).abs() / sum } else { 0.0 }
    };
    pairs(distribution, count, seed).map(residual).fold(0.0, f64::max)
}

/// Looks for directions in which a distribution is negative or not finite.
///
/// - `count`: pairs of directions, down to 0.0001 degrees above the surface. `seed`: of the random numbers.
///
/// # Errors
/// [`DistributionError::Negative`] or [`DistributionError::NotFinite`] with the first pair that is found.
pub fn check(distribution: &dyn Distribution, count: u64, seed: u64) -> Result<(), DistributionError> {
    pairs(distribution, count, seed).try_for_each(|(light, view)| {
        checked(distribution.name(), distribution.density(light, view), light, view)?;
        checked(distribution.name(), distribution.pdf(light, view), light, view).map(|_| ())
    })
}

/// A density, if it is finite and not negative.
pub(super) fn checked(name: &str, value: f64, light: DVec3, view: DVec3) -> Result<f64, DistributionError> {
    if !value.is_finite() {
        return Err(DistributionError::NotFinite { name: name.into(), light, view });
    }
    if value < 0.0 {
        return Err(DistributionError::Negative { name: name.into(), value, light, view });
    }
    Ok(value)
}
