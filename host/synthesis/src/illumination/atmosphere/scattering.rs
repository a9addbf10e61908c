//! Light that air scatters towards the eye: once along the line of sight, and any number of times from all around.

use super::air::{Air, NODES, Spectral, density, extinction, phases};
use super::columns::{Columns, GROUND, TOP, to_ground, to_top};
use super::solar::SUN_RADIUS;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Heights and elevations of the sun at which further scattering is known.
const SIDE: usize = 32;
/// Directions of further scattering: angles from the zenith, and turns to one side of the sun.
const DIRECTIONS: [usize; 2] = [16, 4];
/// Steps along a line of further scattering, and along one of sight.
const STEPS: [usize; 2] = [20, 48];
/// Lines of sight that hit the ground before so many kilometres take so many steps.
const NEAR: (f64, usize) = (20.0, 8);

/// Light in the air under a sun of irradiance 1 at all wavelengths.
pub(super) struct Scattering<'a> {
    air: &'a Air,
    columns: &'a Columns,
    albedo: f64,
    /// Radiance by light that was scattered before, from all around alike, 1/sr: heights in rows, suns in columns.
    further: Vec<Spectral>,
}

impl<'a> Scattering<'a> {
    /// Finds further scattering.
    ///
    /// # Source
    /// Hillaire 2020, section 5.5: scattering of the second order from all around, and a geometric series for all
    /// beyond. What haze scatters straight on counts as not scattered at all, but for the single scattering towards the
    /// eye: Joseph, Wiscombe and Weinman 1976, delta-Eddington; Nakajima and Tanaka 1988.
    pub(super) fn new(air: &'a Air, columns: &'a Columns, albedo: f64) -> Scattering<'a> {
        let mut scattering = Scattering { air, columns, albedo, further: Vec::new() };
        let of = |index: usize| {
            let [x, y] = [index % SIDE, index / SIDE].map(|at| at as f64 / (SIDE - 1) as f64);
            scattering.of_place(GROUND + y * y * (TOP - GROUND), 2.0 * x - 1.0)
        };
        let further = (0..SIDE * SIDE).into_par_iter().map(of).collect();
        scattering.further = further;
        scattering
    }

    /// Radiance from all around that was scattered twice and more.
    fn of_place(&self, radius: f64, sun: f64) -> Spectral {
        let radius = radius.clamp(GROUND + 1e-3, TOP - 1e-3);
        let sun = DVec3::new((1.0 - sun * sun).max(0.0).sqrt(), sun, 0.0);
        let (mut second, mut again) = ([0.0; NODES], [0.0; NODES]);
        let [angles, turns] = DIRECTIONS;
        let count = angles * turns;
        for index in 0..count {
            let cosine = 1.0 - (2.0 * (index / turns) as f64 + 1.0) / angles as f64;
            let turn = ((index % turns) as f64 + 0.5) / turns as f64 * PI;
            let sine = (1.0 - cosine * cosine).sqrt();
            let view = DVec3::new(sine * turn.cos(), cosine, sine * turn.sin());
            self.along(radius, view, sun, STEPS[0], |node, part, scattered, _, lit| {
                // Light is scattered as if every direction were the same.
                second[node] += part * scattered[0] * lit / (4.0 * PI);
                again[node] += part * scattered[0];
            });
            if let Some(ground) = self.ground(radius, view, sun) {
                second.iter_mut().zip(ground).for_each(|(sum, light)| *sum += light);
            }
        }
        let mean = |sum: f64| sum / count as f64;
        std::array::from_fn(|node| mean(second[node]) / (1.0 - mean(again[node])).max(1e-3))
    }

    /// Radiance of the ground by the sun alone that comes through the air along a line; none if the line does not hit
    /// it.
    fn ground(&self, radius: f64, view: DVec3, sun: DVec3) -> Option<Spectral> {
        let distance = to_ground(radius, view.y)?;
        let up = (DVec3::Y * radius + view * distance).normalize();
        let amounts = super::columns::integrated(radius, view.y, distance);
        let lit = self.sun_at(GROUND, up.dot(sun), &self.air.scaled);
        let part = self.albedo / PI * up.dot(sun).max(0.0);
        Some(std::array::from_fn(|node| part * lit[node] * (-extinction(&self.air.scaled, &amounts, node)).exp()))
    }

    /// Goes along a line of sight to the ground or the end of the air.
    ///
    /// - `tell`: for each node and step: how much of what is scattered there arrives, km; the coefficients of
    ///   scattering of both together, without what goes straight on, and of each; radiance by further scattering; and
    ///   the part of the sun that arrives there.
    fn along(
        &self,
        radius: f64,
        view: DVec3,
        sun: DVec3,
        steps: usize,
        mut tell: impl FnMut(usize, f64, [f64; 3], f64, f64),
    ) {
        let distance = to_ground(radius, view.y).unwrap_or_else(|| to_top(radius, view.y));
        let mut transmittance = [1.0; NODES];
        for step in 0..steps {
            let [from, to] = [step, step + 1].map(|step| (step as f64 / steps as f64).powi(2) * distance);
            let place = DVec3::Y * radius + view * (0.5 * (from + to));
            let here = place.length().clamp(GROUND, TOP);
            let cosine = place.dot(sun) / place.length();
            let density = density(here - GROUND);
            let (lit, further) = (self.sun_at(here, cosine, &self.air.scaled), self.further_at(here, cosine));
            for node in 0..NODES {
                let extinction = extinction(&self.air.scaled, &density, node).max(1e-12);
                let kept = (-extinction * (to - from)).exp();
                // The integral over the step of what arrives of an even source.
                let part = transmittance[node] * (1.0 - kept) / extinction;
                let [air, haze] = [0, 1].map(|kind| self.air.scattering[kind][node] * density[kind]);
                tell(node, part, [air + Air::TURNED * haze, air, haze], further[node], lit[node]);
                transmittance[node] *= kept;
            }
        }
    }

    /// Radiance that arrives at an eye, W/(m² sr nm).
    ///
    /// - `height`: of the eye over the ground, km. `view`, `sun`: directions, unit length; y is up.
    pub(super) fn radiance(&self, height: f64, view: DVec3, sun: DVec3) -> Spectral {
        let radius = GROUND + height.max(1e-3);
        let phases = phases(view.dot(sun));
        let mut sums = [0.0; NODES];
        let is_near = to_ground(radius, view.y).is_some_and(|distance| distance < NEAR.0);
        let steps = if is_near { NEAR.1 } else { STEPS[1] };
        self.along(radius, view, sun, steps, |node, part, [both, air, haze], further, lit| {
            sums[node] += part * ((air * phases[0] + haze * phases[1]) * lit + both * further);
        });
        if let Some(distance) = to_ground(radius, view.y) {
            let up = (DVec3::Y * radius + view * distance).normalize();
            let amounts = super::columns::integrated(radius, view.y, distance);
            let (lit, further) =
                (self.sun_at(GROUND, up.dot(sun), &self.air.scaled), self.further_at(GROUND, up.dot(sun)));
            for node in 0..NODES {
                // The sky over the ground is taken for even.
                let arrives = lit[node] * up.dot(sun).max(0.0) + PI * further[node];
                sums[node] += self.albedo / PI * arrives * (-extinction(&self.air.scaled, &amounts, node)).exp();
            }
        }
        std::array::from_fn(|node| sums[node] * self.air.sun[node])
    }

    /// Irradiance of a surface that faces the sun, by the sun alone, W/(m² nm).
    ///
    /// - `height`: km. `cosine`: of the angle of the sun from the zenith.
    pub(super) fn of_sun(&self, height: f64, cosine: f64) -> Spectral {
        let lit = self.sun_at(GROUND + height.max(1e-3), cosine, &self.air.extinction);
        std::array::from_fn(|node| lit[node] * self.air.sun[node])
    }

    /// The part of the sun's light that arrives.
    ///
    /// - `coefficients`: of extinction by air, haze and ozone, 1/km.
    fn sun_at(&self, radius: f64, cosine: f64, coefficients: &[Spectral; 3]) -> Spectral {
        // The part of its disc over the horizon.
        let horizon = -(1.0 - (GROUND / radius).powi(2)).max(0.0).sqrt();
        let over = ((cosine.clamp(-1.0, 1.0).asin() - horizon.asin()) / SUN_RADIUS).clamp(-1.0, 1.0);
        if over <= -1.0 {
            return [0.0; NODES];
        }
        let part = 0.5 + (over * (1.0 - over * over).max(0.0).sqrt() + over.asin()) / PI;
        let amounts = self.columns.to_top(radius, cosine.max(horizon));
        std::array::from_fn(|node| part * (-extinction(coefficients, &amounts, node)).exp())
    }

    /// Radiance from all around by further scattering.
    fn further_at(&self, radius: f64, sun: f64) -> Spectral {
        if self.further.is_empty() {
            return [0.0; NODES];
        }
        let place = |part: f64| {
            let at = part.clamp(0.0, 1.0) * (SIDE - 1) as f64;
            let low = (at as usize).min(SIDE - 2);
            (low, at - low as f64)
        };
        let height = ((radius - GROUND) / (TOP - GROUND)).max(0.0).sqrt();
        let ((x, s), (y, t)) = (place(0.5 * (sun + 1.0)), place(height));
        let at = |x: usize, y: usize| &self.further[y * SIDE + x];
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
        std::array::from_fn(|node| {
            let (above, below) = (a[node] + (b[node] - a[node]) * s, c[node] + (d[node] - c[node]) * s);
            above + (below - above) * t
        })
    }
}
