//! Light that comes to elements straight from lights.

use super::hierarchy::{Node, POINTS};
use super::sight::Sight;
use crate::color::Channels;
use crate::numeric::ray::Ray;
use crate::numeric::sequence::Sequence;
use glam::DVec3;

/// How much shorter a ray to a triangle that emits is, so that it does not meet it.
const SHORT: f64 = 1.0 - 1e-7;
/// Points of a light with a size, and directions to a sky, that are asked for at the least.
const LEAST_SAMPLES: u32 = 16;
const LEAST_OF_SKY: u32 = 64;

/// Irradiance at the points of an element, by what comes straight from lights, W/m².
pub(super) type Lit = [Channels; POINTS];

impl Sight<'_> {
    /// The irradiance at the middles of the quarters of an element, unless something is between it and the lights.
    ///
    /// In spectra, lanes are means over all combs.
    pub(super) fn light(&self, node: &Node, shadows: bool) -> Lit {
        node.quarters().map(|[a, b, c]| self.light_at((a + b + c) / 3.0, node.normal, shadows))
    }

    /// The irradiance at a point of an element.
    pub(super) fn light_at(&self, point: DVec3, normal: DVec3, shadows: bool) -> Channels {
        let appearance = &self.world.appearance;
        let combs = appearance.wavelengths.combs();
        let least = appearance.prepared.settings.light_samples;
        let mut sum = Channels::ZERO;
        for (index, (number, source)) in appearance.sources.iter().enumerate() {
            let samples = match source.is_sharp() {
                true => 1,
                false if source.is_sky() => least.max(LEAST_OF_SKY),
                false => least.max(LEAST_SAMPLES),
            };
            // The same points of a light for all elements: their light differs as smoothly as they do.
            let sequence = Sequence::new(0, *number as u64);
            let mut part = Channels::ZERO;
            for sample in 0..samples {
                let uniform = sequence.point(sample, 0);
                let Some(beam) = source.beam(point, Some(normal), uniform, 0) else { continue };
                let cosine = beam.towards.dot(normal);
                if cosine <= 0.0 {
                    continue;
                }
                let origin = point + normal * self.clearance;
                let (ray, t_max) = match beam.distance.is_finite() {
                    false => (Ray { origin, direction: beam.towards }, f64::INFINITY),
                    true => {
                        let end = if source.is_sharp() || source.is_surface() { 1.0 } else { SHORT };
                        (Ray { origin, direction: point + beam.towards * beam.distance - origin }, end)
                    }
                };
                for comb in 0..combs {
                    let passed = match (shadows, comb) {
                        (false, _) => Channels::ONE,
                        (true, 0) => self.world.passed(&ray, t_max, (index, None), (0, 0.0)),
                        (true, _) if !appearance.passing => Channels::ONE,
                        (true, comb) => self.world.passed(&ray, t_max, (index, None), (comb, 0.0)),
                    };
                    if passed == Channels::ZERO {
                        break;
                    }
                    let beam = if comb == 0 { Some(beam) } else { source.beam(point, Some(normal), uniform, comb) };
                    let arriving = beam.map_or(Channels::ZERO, |beam| beam.irradiance * passed * cosine);
                    part += if arriving.is_finite() { arriving } else { Channels::ZERO };
                }
            }
            sum += part * f64::from(samples).recip();
        }
        sum * (combs as f64).recip()
    }
}
