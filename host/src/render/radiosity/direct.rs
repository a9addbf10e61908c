//! Light that comes to elements straight from lights.

use super::elements::Exitance;
use super::hierarchy::{Node, Patch};
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

/// More of them where some are hidden and some are not.
const MORE: u32 = 4;
/// How far points are from the corners and edges of an element, as a part of the way to its middle: on an edge may lie
/// another surface.
const INWARDS: f64 = 1e-3;

/// What comes from elsewhere than other elements to a point of an element, W/m². In spectra, lanes are means over all combs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lit {
    /// Irradiance straight from lights.
    pub(super) direct: Channels,
    /// Exitance from elsewhere.
    pub(super) extra: Channels,
}

/// The same at the three corners of an element, and in the middles of the edges from each to the next.
pub(super) type Around = [Lit; 6];

/// Which of them are the corners of each quarter.
const OF_QUARTERS: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [4, 5, 3]];

/// What is known at the corners of quarters.
pub(super) fn of_quarters(around: &Around) -> [[Lit; 3]; 4] {
    OF_QUARTERS.map(|places| places.map(|place| around[place]))
}

/// The mean over an element, exact for what is quadratic.
pub(super) fn mean(around: &Around) -> Lit {
    let mean = |of: &dyn Fn(&Lit) -> Channels| (of(&around[3]) + of(&around[4]) + of(&around[5])) * (1.0 / 3.0);
    Lit { direct: mean(&|lit| lit.direct), extra: mean(&|lit| lit.extra) }
}

/// By how much it is off in the middle of an edge if it is taken for linear, W/m² at the most.
pub(super) fn bend(around: &Around) -> f64 {
    let off = |i: usize| {
        let of = |part: &dyn Fn(&Lit) -> Channels| {
            let linear = (part(&around[i]) + part(&around[(i + 1) % 3])) * 0.5;
            (part(&around[3 + i]) - linear).map(f64::abs).max()
        };
        of(&|lit| lit.direct).max(of(&|lit| lit.extra))
    };
    (0..3).map(off).fold(0.0, f64::max)
}

impl Sight<'_> {
    /// What comes to the corners of an element and to the middles of its edges.
    ///
    /// - `corners`: what is known already.
    pub(super) fn lit(
        &self,
        (patch, node): (&Patch, &Node),
        corners: Option<[Lit; 3]>,
        (exitance, shadows): (Option<Exitance<'_>>, bool),
    ) -> Around {
        if node.is_dark {
            return Around::default();
        }
        let lanes = self.world.appearance.wavelengths.lanes();
        let at = |point: DVec3| {
            let point = point + (node.middle - point) * INWARDS;
            let extra = exitance.map_or(Channels::ZERO, |of| of(patch.triangle, patch.outside, point));
            let extra = Channels(std::array::from_fn(|lane| if lane < lanes { extra.0[lane] } else { 0.0 }));
            Lit { direct: self.light_at(point, node.normal, shadows), extra }
        };
        let [a, b, c] = corners.unwrap_or_else(|| node.corners.map(at));
        let [p, q, r] = node.corners;
        let [ab, bc, ca] = [0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)].map(at);
        [a, b, c, ab, bc, ca]
    }

    /// The irradiance at a point of an element.
    pub(super) fn light_at(&self, point: DVec3, normal: DVec3, shadows: bool) -> Channels {
        let appearance = &self.world.appearance;
        let combs = appearance.wavelengths.combs();
        let least = appearance.prepared.settings.light_samples;
        let mut sum = Channels::ZERO;
        for (index, (number, source)) in appearance.sources.iter().enumerate() {
            let mut samples = match source.is_sharp() {
                true => 1,
                false if source.is_sky() => least.max(LEAST_OF_SKY),
                false => least.max(LEAST_SAMPLES),
            };
            let most = if source.is_sharp() || source.is_sky() { samples } else { MORE * samples };
            let (mut asked, mut seen) = (0, 0);
            // The same points of a light for all elements: their light differs as smoothly as they do.
            let sequence = Sequence::new(0, *number as u64);
            let mut part = Channels::ZERO;
            let mut sample = 0;
            while sample < samples {
                let uniform = sequence.point(sample, 0);
                sample += 1;
                if sample == samples && seen > 0 && seen < asked {
                    samples = most;
                }
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
                asked += 1;
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
                    seen += u32::from(comb == 0);
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
