//! Facets with all reflections between them: what the first reflection loses is emitted after further ones.

use super::{Distribution, DistributionError, Microfacet, SlopeDistribution};
use crate::numeric::cubature::{GAUSS, unit_square};
use crate::numeric::sampling::around_z;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Intervals of the table of what is lost.
const STEPS: usize = 128;
/// Error of the cubature of an entry.
const TOLERANCE: f64 = 1e-5;
/// Most evaluations for an entry.
const MOST_EVALUATIONS: u32 = 20_000;
/// Taken off what is lost, so that errors of the table never create energy.
const MARGIN: f64 = 3e-5;
/// The largest chance to sample the second term: the first keeps some, where nearly all is lost.
const MOST_CHANCE: f64 = 0.95;
/// The smallest cosine of the table; below, what is lost does not change any more.
const LEAST_COSINE: f64 = 1e-9;

/// Beckmann's or GGX's facets, exactly normalised at every incidence: D + (1 − E_L)(1 − E_V)(N·V) / (π (1 − E)).
///
/// E_L is the integral of D for the light's direction, E its mean over the hemisphere, weighted with the cosine. The
/// second term is reciprocal, and its integral is what D lost, 1 − E_L, to 1e-4 for roughness up to 1, and to 2e-4 up
/// to 10; never more. It says where the light goes only roughly: over the whole hemisphere. In a metal each further
/// reflection has its own K: then the two terms are needed apart, see [`Compensated::parts`].
///
/// # Source
/// Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017. The table is ours.
#[derive(Clone, Debug)]
pub struct Compensated {
    first: Microfacet,
    name: &'static str,
    roughness: f64,
    /// 1 − E over the incidence, at even steps of [`Compensated::place`].
    lost: Vec<f64>,
    mean_lost: f64,
    /// The pdf, over the place in the table, of what is emitted again.
    emitted: Vec<f64>,
    /// The integral of that pdf up to the end of each interval; empty if nothing is lost.
    below: Vec<f64>,
}

impl Compensated {
    /// With a roughness m, 1e-8..=1000, the same along x and y. Its table takes some tenths of a second on two cores:
    /// keep what is made.
    ///
    /// # Errors
    /// [`DistributionError::Roughness`].
    pub fn new(facets: SlopeDistribution, roughness: f64) -> Result<Compensated, DistributionError> {
        let first = Microfacet::new(facets, DVec2::splat(roughness))?;
        let name = match facets {
            SlopeDistribution::Beckmann => "Beckmann, all",
            SlopeDistribution::Ggx => "GGX, all",
        };
        let mut made = Compensated {
            first,
            name,
            roughness,
            lost: vec![0.0; STEPS + 1],
            mean_lost: 0.0,
            emitted: Vec::new(),
            below: Vec::new(),
        };
        let lost = |step| {
            let cosine = made.cosine(step as f64 / STEPS as f64).max(LEAST_COSINE);
            let light = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
            // One half of the directions is the mirror image of the other.
            let weight = |[x, y]: [f64; 2]| {
                made.first.sample(light, [x, 0.5 * y]).map_or(0.0, |view| made.first.weight(light, view))
            };
            let share = unit_square(weight, TOLERANCE, MOST_EVALUATIONS);
            (1.0 - share.value - MARGIN).max(0.0)
        };
        let table: Vec<f64> = (0..=STEPS).into_par_iter().map(lost).collect();
        made.lost = table;
        made.mean_lost = (0..STEPS).map(|step| made.lost_in(step)).sum();
        made.emitted = (0..=STEPS)
            .map(|step| {
                let place = step as f64 / STEPS as f64;
                made.lost[step] * made.cosine(place) * made.stretch(place)
            })
            .collect();
        let intervals = made.emitted.windows(2).map(|pair| pair[0] + pair[1]);
        let all: f64 = intervals.clone().sum();
        if all > 0.0 {
            made.below = intervals
                .scan(0.0, |sum, part| {
                    *sum += part / all;
                    Some(*sum)
                })
                .collect();
            made.emitted.iter_mut().for_each(|value| *value *= 2.0 * STEPS as f64 / all);
        }
        Ok(made)
    }

    /// The cosine below which what is lost is about the same: facets that hide each other are seen from there.
    fn scale(&self) -> f64 {
        0.01 * self.roughness.min(1.0 / self.roughness)
    }

    /// The place of a cosine in the table, 0..=1: even steps below the scale, and even ratios above it.
    fn place(&self, cosine: f64) -> f64 {
        (cosine / self.scale()).asinh() / self.scale().recip().asinh()
    }

    /// The cosine at a place of the table.
    fn cosine(&self, place: f64) -> f64 {
        self.scale() * (place * self.scale().recip().asinh()).sinh()
    }

    /// dμ / dplace
    fn stretch(&self, place: f64) -> f64 {
        let all = self.scale().recip().asinh();
        self.scale() * all * (place * all).cosh()
    }

    /// 2 ∫ (1 − E) μ dμ over an interval of the table, by Gauss's rule.
    fn lost_in(&self, step: usize) -> f64 {
        let term = |(part, weight): (f64, f64)| {
            let place = (step as f64 + part) / STEPS as f64;
            let cosine = self.cosine(place);
            2.0 * self.lost(cosine) * cosine * self.stretch(place) * weight / STEPS as f64
        };
        GAUSS.into_iter().map(term).sum()
    }

    /// A cosine of what is emitted after further reflections, from a uniform number.
    fn further(&self, uniform: f64) -> f64 {
        let step = self.below.partition_point(|below| *below <= uniform).min(STEPS - 1);
        let before = if step == 0 { 0.0 } else { self.below[step - 1] };
        let (from, to) = (self.emitted[step], self.emitted[step + 1]);
        // The pdf is linear in the interval: from x + (to − from) x² / 2 is what is left.
        let left = ((uniform - before) * STEPS as f64).max(0.0);
        let root = (from * from + 2.0 * (to - from) * left).max(0.0).sqrt();
        let part = if from + root > 0.0 { (2.0 * left / (from + root)).min(1.0) } else { 0.0 };
        self.cosine((step as f64 + part) / STEPS as f64)
    }

    /// The pdf of [`Compensated::further`], 1/sr.
    fn further_pdf(&self, cosine: f64) -> f64 {
        let place = self.place(cosine).clamp(0.0, 1.0);
        let step = ((place * STEPS as f64) as usize).min(STEPS - 1);
        let part = place * STEPS as f64 - step as f64;
        (self.emitted[step] * (1.0 - part) + self.emitted[step + 1] * part) / (self.stretch(place) * TAU)
    }

    /// The part of light that the first reflection loses, 0..=1.
    ///
    /// - `cosine`: between light and normal, 0..=1.
    pub fn lost(&self, cosine: f64) -> f64 {
        let place = self.place(cosine).clamp(0.0, 1.0) * STEPS as f64;
        let first = (place as usize).saturating_sub(1).min(STEPS - 3);
        let x = place - first as f64;
        // Lagrange's cubic through four entries.
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.lost[first + i]);
        let cubic = a * (1.0 - x) * (2.0 - x) * (3.0 - x) / 6.0
            + b * x * (2.0 - x) * (3.0 - x) / 2.0
            + c * x * (x - 1.0) * (3.0 - x) / 2.0
            + d * x * (x - 1.0) * (x - 2.0) / 6.0;
        cubic.clamp(0.0, 1.0)
    }

    /// The mean of [`Compensated::lost`] over the hemisphere, weighted with the cosine.
    pub fn mean_lost(&self) -> f64 {
        self.mean_lost
    }

    /// The chance that a sample is of the second term.
    fn chance(&self, light: DVec3) -> f64 {
        if self.below.is_empty() { 0.0 } else { self.lost(light.z).min(MOST_CHANCE) }
    }

    /// D of what is reflected once, and of what is reflected more often, 1/sr; each may have its own K.
    pub fn parts(&self, light: DVec3, view: DVec3) -> [f64; 2] {
        let further = if self.mean_lost > 0.0 {
            self.lost(light.z) * self.lost(view.z) * view.z * FRAC_1_PI / self.mean_lost
        } else {
            0.0
        };
        [self.first.density(light, view), further]
    }
}

impl Distribution for Compensated {
    fn name(&self) -> &str {
        self.name
    }

    fn density(&self, light: DVec3, view: DVec3) -> f64 {
        self.parts(light, view).iter().sum()
    }

    fn sample(&self, light: DVec3, point: [f64; 2]) -> Option<DVec3> {
        // The first coordinate chooses between the two terms, and is then stretched to be used again.
        let lost = self.chance(light);
        if point[0] < lost {
            Some(around_z(self.further(point[0] / lost), point[1])).filter(|view| view.z > 0.0)
        } else {
            self.first.sample(light, [(point[0] - lost) / (1.0 - lost), point[1]])
        }
    }

    fn pdf(&self, light: DVec3, view: DVec3) -> f64 {
        let lost = self.chance(light);
        let further = if lost > 0.0 { lost * self.further_pdf(view.z) } else { 0.0 };
        further + (1.0 - lost) * self.first.pdf(light, view)
    }
}
