//! Light as it leaves its source: what is followed from there.

use super::Patch;
use super::source::{Kind, Source};
use crate::color::Channels;
use crate::color::observer::LUMENS_PER_WATT;
use crate::numeric::cubature::GAUSS;
use crate::numeric::sampling::{disk, sphere};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Parts of the angles over which the power of a luminaire is summed.
const PARTS: usize = 24;

/// Where light leaves a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// From a place, in many directions.
    Place {
        /// Where it is.
        at: DVec3,
        /// The normal of the surface there, if it is one.
        normal: Option<DVec3>,
        /// The area of all of the surface; 0 without one.
        area: f64,
    },
    /// From infinitely far away, in one direction.
    Parallel {
        /// Where it goes, unit length.
        direction: DVec3,
        /// Irradiance of a surface that faces it, W/m², over the density with which the direction was drawn.
        irradiance: Channels,
    },
}

impl Source {
    /// Draws where light leaves the source; none where there is none.
    ///
    /// - `uniform`: a point of the unit square.
    pub fn start(&self, uniform: [f64; 2], comb: usize) -> Option<Start> {
        let place = |at, normal, area| Some(Start::Place { at, normal, area });
        match &self.kind {
            Kind::Point { at } | Kind::Spot { at, .. } | Kind::Luminaire { at, .. } => place(*at, None, 0.0),
            Kind::Directional { towards } => {
                Some(Start::Parallel { direction: -*towards, irradiance: self.strength.of(comb) })
            }
            Kind::Area(patch) => {
                let (at, normal) = start_on(patch, uniform)?;
                place(at, Some(normal), patch.area())
            }
            Kind::Mesh(triangles) => {
                let (at, normal) = triangles.point(uniform);
                place(at, Some(normal), triangles.area)
            }
            Kind::Sky(sky) => {
                let (towards, density) = sky.start(uniform)?;
                let irradiance = sky.radiance(towards, comb) * density.recip();
                Some(Start::Parallel { direction: -towards, irradiance })
            }
        }
    }

    /// Flux in each solid angle that leaves a place of [`Source::start`] in a direction, over the density of the place,
    /// W/sr.
    ///
    /// - `normal`: of the surface there, if it is one. `direction`: where it goes, unit length.
    pub fn intensity(&self, normal: Option<DVec3>, direction: DVec3, comb: usize) -> Channels {
        let strength = self.strength.of(comb);
        match (&self.kind, normal) {
            (Kind::Spot { axis, inner, outer, .. }, _) => {
                let part = ((direction.dot(*axis) - outer) / (inner - outer)).clamp(0.0, 1.0);
                strength * (part * part * (3.0 - 2.0 * part))
            }
            (Kind::Luminaire { axes, table, .. }, _) => {
                strength * (table.candelas(axes.transpose() * direction) / LUMENS_PER_WATT)
            }
            (Kind::Area(patch), Some(normal)) => strength * (patch.area() * normal.dot(direction).max(0.0)),
            (Kind::Mesh(triangles), Some(normal)) => strength * (triangles.area * normal.dot(direction).abs()),
            _ => strength,
        }
    }

    /// All flux that it sends out, W; of light from infinitely far away, what goes through a sphere of a radius.
    pub fn power(&self, radius: f64, comb: usize) -> Channels {
        let strength = self.strength.of(comb);
        let disc = PI * radius * radius;
        match &self.kind {
            Kind::Point { .. } => strength * (2.0 * TAU),
            Kind::Spot { inner, outer, .. } => strength * (TAU * (1.0 - 0.5 * (inner + outer))),
            Kind::Luminaire { table, .. } => {
                let lumens = over_the_sphere(|direction| table.candelas(direction));
                strength * (lumens / LUMENS_PER_WATT)
            }
            Kind::Area(patch) => strength * (PI * patch.area()),
            Kind::Mesh(triangles) => strength * (TAU * triangles.area),
            Kind::Directional { .. } => strength * disc,
            Kind::Sky(sky) => sky.total(comb) * disc,
        }
    }
}

/// A point of a patch, drawn evenly by area, and the normal on the side that emits.
fn start_on(patch: &Patch, uniform: [f64; 2]) -> Option<(DVec3, DVec3)> {
    match *patch {
        Patch::Rectangle { corner, across, up } => {
            Some((corner + across * uniform[0] + up * uniform[1], across.cross(up).try_normalize()?))
        }
        Patch::Disc { center, normal, radius } => {
            let normal = normal.try_normalize()?;
            let (x, y) = normal.any_orthonormal_pair();
            let [a, b] = disk(uniform);
            Some((center + (x * a + y * b) * radius, normal))
        }
        Patch::Sphere { center, radius } => {
            let normal = sphere(uniform);
            Some((center + normal * radius, normal))
        }
    }
}

/// The integral of a function of directions.
fn over_the_sphere(function: impl Fn(DVec3) -> f64) -> f64 {
    let part = (PARTS as f64).recip();
    let points =
        || (0..PARTS).flat_map(|k| GAUSS.iter().map(move |(at, weight)| ((k as f64 + at) * part, weight * part)));
    let ring = |(x, weight): (f64, f64)| {
        let (down, sine) = ((PI * x).cos(), (PI * x).sin());
        let along = |(y, weight): (f64, f64)| {
            let (sin, cos) = (TAU * y).sin_cos();
            function(DVec3::new(sine * cos, sine * sin, down)) * weight
        };
        points().map(along).sum::<f64>() * TAU * PI * sine * weight
    };
    points().map(ring).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Color, Wavelengths};
    use crate::illumination::light::{Goniometry, Light};
    use crate::numeric::sequence::Sequence;

    /// What leaves a source in all directions, by samples.
    fn sampled(source: &Source) -> f64 {
        let sequence = Sequence::new(1, 1);
        let count = 1 << 14;
        let of = |index: u32| {
            let start = source.start(sequence.point(index, 0), 0);
            let Some(Start::Place { normal, .. }) = start else { return 0.0 };
            source.intensity(normal, sphere(sequence.point(index, 1)), 0).0[0] * 2.0 * TAU
        };
        (0..count).map(of).sum::<f64>() / f64::from(count)
    }

    #[test]
    fn what_leaves_a_source_is_its_power() {
        let one = || Color::grey(1.0);
        let area = |patch| Light::Area { patch, radiance: one() };
        let (at, y) = (DVec3::new(1.0, 2.0, 3.0), DVec3::Y);
        // A table of intensities that fall with the height: 1 + cos of the angle from straight down.
        let vertical: Vec<f64> = (0..=180).map(f64::from).collect();
        let candelas = vertical.iter().map(|v| 683.0 * (1.0 + v.to_radians().cos())).collect();
        let goniometry = Goniometry::new(vertical, vec![0.0], candelas).expect("a table");
        let lights = [
            (Light::Point { at, intensity: one() }, 2.0 * TAU),
            (
                Light::Spot { at, direction: y, intensity: one(), inner: 20.0, outer: 60.0 },
                TAU * (1.0 - 0.5 * (20f64.to_radians().cos() + 60f64.to_radians().cos())),
            ),
            (area(Patch::Rectangle { corner: at, across: DVec3::X * 2.0, up: DVec3::Z * 3.0 }), 6.0 * PI),
            (area(Patch::Disc { center: at, normal: y, radius: 2.0 }), 4.0 * PI * PI),
            (area(Patch::Sphere { center: at, radius: 2.0 }), 16.0 * PI * PI),
            (Light::Luminaire { at, down: -y, front: DVec3::X, goniometry, color: one() }, 2.0 * TAU),
        ];
        for (light, expected) in lights {
            let source = Source::new(&light, &Wavelengths::bands());
            let (found, power) = (sampled(&source), source.power(1.0, 0).0[0]);
            assert!((power / expected - 1.0).abs() < 1e-4, "{}: {power} {expected}", light.words());
            assert!((found / expected - 1.0).abs() < 1e-2, "{}: {found} {expected}", light.words());
        }
    }

    #[test]
    fn a_sky_sends_its_light_through_every_disc() {
        let light = Light::Sky { map: None, radiance: Color::grey(2.0), turned: 0.0 };
        let source = Source::new(&light, &Wavelengths::bands());
        let Some(Start::Parallel { irradiance, .. }) = source.start([0.3, 0.7], 0) else { panic!("parallel") };
        assert!((irradiance.0[0] - 4.0 * TAU).abs() < 1e-9);
        assert!((source.power(3.0, 0).0[0] - 4.0 * TAU * 9.0 * PI).abs() < 1e-9);
    }
}
