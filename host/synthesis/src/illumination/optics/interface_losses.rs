//! What a rough interface between transparent media loses by one reflection or refraction, over the cosine and the
//! ratio of the indices.
//!
//! Light that facets mask meets others, and leaves at last. Its amount is tabulated, row by row for a ratio of indices,
//! as interfaces ask for it: indices differ over the wavelength, and one body may touch several others.

use super::dielectric::beta;
use crate::illumination::distribution::RoughFacets;
use crate::illumination::distribution::even_table::{LinearPdf, interpolated};
use crate::illumination::fresnel::Dielectric;
use crate::numeric::cubature::{GAUSS, unit_square};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_1_PI, TAU};
use std::sync::OnceLock;

/// Intervals of a row, over the cosine.
const STEPS: usize = 64;
/// Error of the cubature of an entry, and the most evaluations for it.
const TOLERANCE: f64 = 1e-4;
const MOST_EVALUATIONS: u32 = 8_000;
/// Parts of the range of cosines for a mean.
const MEAN_PARTS: usize = 96;
/// The least cosine of a row; below it nothing changes.
const LEAST_COSINE: f64 = 1e-7;
/// How much less than a smooth surface facets of the roughness 1 reflect, as they send light on to each other.
const FURTHER: f64 = 4.8;
/// Rows for ratios of indices on each side of 1.
const ROWS: usize = 250;

/// What light from one side loses at a ratio of indices.
#[derive(Debug)]
struct Row {
    /// Over the place of the cosine.
    lost: Vec<f64>,
    /// The mean of what is lost, weighted with the cosine.
    mean: f64,
    /// The mean of what Fresnel's equations let through.
    through: f64,
    /// The pdf, over the place of the cosine, of what is sent on; empty if nothing is.
    emitted: LinearPdf,
}

/// What a rough interface loses by one reflection or refraction.
#[derive(Debug)]
pub(super) struct InterfaceLosses {
    facets: RoughFacets,
    is_correlated: bool,
    /// The cosine below which half of the places of a row are.
    scale: f64,
    /// For ratios that rise.
    rows: Vec<OnceLock<Row>>,
}

/// What is lost at one ratio of indices: between two rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct LossesOfRatio<'a> {
    losses: &'a InterfaceLosses,
    rows: [&'a Row; 2],
    part: f64,
}

impl InterfaceLosses {
    /// - `is_correlated`: whether heights of light and viewer are.
    pub(super) fn new(facets: RoughFacets, is_correlated: bool) -> InterfaceLosses {
        let scale = 0.25 * facets.roughness().clamp(1e-6, 1.0);
        let rows = std::iter::repeat_with(OnceLock::new).take(2 * ROWS + 1).collect();
        InterfaceLosses { facets, is_correlated, scale, rows }
    }

    /// The losses for light from a medium.
    ///
    /// - `before`, `behind`: the indices of the medium on this side, and on the other.
    pub(super) fn between(&self, before: f64, behind: f64) -> LossesOfRatio<'_> {
        let place = ((behind - before) / (behind + before) + 1.0) * ROWS as f64;
        let first = (place as usize).min(2 * ROWS - 1);
        let row = |index: usize| self.rows[index].get_or_init(|| self.row(index));
        LossesOfRatio { losses: self, rows: [row(first), row(first + 1)], part: place - first as f64 }
    }

    /// Makes ready what light at an interface needs that meets certain indices, on all cores.
    ///
    /// - `ratios`: of indices, of one side over the other.
    pub(super) fn prepare(&self, ratios: impl IntoIterator<Item = f64>) {
        let place = |ratio: f64| ((ratio - 1.0) / (ratio + 1.0) + 1.0) * ROWS as f64;
        let of_ratio = |ratio: f64| [ratio, ratio.recip()].map(|ratio| (place(ratio) as usize).min(2 * ROWS - 1));
        let firsts = ratios.into_iter().flat_map(of_ratio);
        let needed: BTreeSet<usize> = firsts.flat_map(|first| [first, first + 1]).collect();
        let cells: Vec<(usize, usize)> =
            needed.into_iter().flat_map(|row| (0..=STEPS).map(move |step| (row, step))).collect();
        let lost: Vec<f64> = cells.par_iter().map(|(row, step)| self.entry(*row, *step)).collect();
        for (row, lost) in cells.iter().step_by(STEPS + 1).zip(lost.chunks(STEPS + 1)) {
            self.rows[row.0].get_or_init(|| self.row_of(row.0, lost.to_vec()));
        }
    }

    /// The ratio of the indices of a row.
    fn ratio(index: usize) -> f64 {
        (index as f64 / (2 * ROWS - index.min(2 * ROWS)) as f64).clamp(1e-6, 1e6)
    }

    fn row(&self, index: usize) -> Row {
        self.row_of(index, (0..=STEPS).map(|step| self.entry(index, step)).collect())
    }

    /// What is lost at a step of a row.
    fn entry(&self, index: usize, step: usize) -> f64 {
        let cosine = self.cosine(step as f64 / STEPS as f64).max(LEAST_COSINE);
        let surface = Dielectric::new(1.0, InterfaceLosses::ratio(index));
        surface.map_or(0.0, |surface| (1.0 - self.sent(surface, cosine)).clamp(0.0, 1.0))
    }

    /// A row with its means.
    fn row_of(&self, index: usize, lost: Vec<f64>) -> Row {
        let mean_lost = mean(|cosine| interpolated(&lost, self.place(cosine)).clamp(0.0, 1.0));
        // The side from which light is reflected totally has a kink; the mean of the other has none.
        let ratio = InterfaceLosses::ratio(index);
        let surface = Dielectric::new(1.0, ratio.max(ratio.recip()));
        let through = surface.map_or(0.0, |surface| mean(|cosine| surface.transmittance(cosine).mean()));
        let place = |step: usize| step as f64 / STEPS as f64;
        let emission = |step: usize| {
            let cosine = self.cosine(place(step));
            lost[step] * cosine / self.slope(cosine)
        };
        let emitted = LinearPdf::new((0..=STEPS).map(emission).collect());
        Row { lost, mean: mean_lost, through, emitted }
    }

    /// The place of a cosine, 0..=1: half of the places are spread evenly, half of them gather at the horizon.
    fn place(&self, cosine: f64) -> f64 {
        let cosine = cosine.clamp(0.0, 1.0);
        0.5 * cosine * (1.0 + (1.0 + self.scale) / (cosine + self.scale))
    }

    /// The change of the place over that of the cosine.
    fn slope(&self, cosine: f64) -> f64 {
        0.5 * (1.0 + (1.0 + self.scale) * self.scale / (cosine + self.scale).powi(2))
    }

    /// The cosine at a place.
    fn cosine(&self, place: f64) -> f64 {
        // c² + (1 + 2 s − 2 p) c − 2 p s = 0
        let (half, product) = (0.5 + self.scale - place, 2.0 * place * self.scale);
        let root = (half * half + product).sqrt();
        if half > 0.0 { product / (half + root) } else { root - half }.clamp(0.0, 1.0)
    }

    /// The part of light that facets send away by one reflection or refraction.
    fn sent(&self, surface: Dielectric, cosine: f64) -> f64 {
        let view = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        let shown = self.facets.projected(view);
        let of = |facet: DVec3| {
            let cosine = facet.dot(view);
            let fresnel = surface.reflectance(cosine).mean();
            let masked = |light: DVec3, is_through: bool| {
                let above = DVec3::new(light.x, light.y, light.z.abs());
                let shown = [shown, self.facets.projected(above)];
                masking([view.z, above.z], shown, is_through, self.is_correlated) * above.z
            };
            let mirrored = facet * (2.0 * cosine) - view;
            let reflected = if mirrored.z > 0.0 { fresnel * masked(mirrored, false) } else { 0.0 };
            let refracted = surface.refracted(view, facet).filter(|light| light.z < 0.0);
            let through = refracted.map_or(0.0, |light| (1.0 - fresnel) * masked(light, true));
            (reflected + through) * self.facets.shown_over_pdf(view, facet)
        };
        // One half of the directions is the mirror image of the other.
        let sampled = |[x, y]: [f64; 2]| self.facets.normal(view, [x, 0.5 * y]).filter(|facet| facet.dot(view) > 0.0);
        unit_square(|point| sampled(point).map_or(0.0, of), TOLERANCE, MOST_EVALUATIONS).value
    }
}

impl Row {
    /// A cosine of what is sent on, from a uniform number.
    fn sample(&self, losses: &InterfaceLosses, uniform: f64) -> f64 {
        if self.emitted.is_empty() {
            return uniform.sqrt();
        }
        losses.cosine(self.emitted.sample(uniform))
    }

    /// The pdf of [`Row::sample`], 1/sr.
    fn pdf(&self, losses: &InterfaceLosses, cosine: f64) -> f64 {
        if self.emitted.is_empty() {
            return cosine * FRAC_1_PI;
        }
        self.emitted.at(losses.place(cosine)) * losses.slope(cosine) / TAU
    }
}

impl LossesOfRatio<'_> {
    /// A cosine of what is sent on to this side, from a uniform number.
    pub(super) fn sample(&self, uniform: f64) -> f64 {
        let ([a, b], part) = (self.rows, self.part);
        match uniform < part {
            true => b.sample(self.losses, uniform / part),
            false => a.sample(self.losses, (uniform - part) / (1.0 - part)),
        }
    }

    /// The pdf of [`LossesOfRatio::sample`], 1/sr.
    ///
    /// - `cosine`: 0..=1.
    pub(super) fn pdf(&self, cosine: f64) -> f64 {
        let [a, b] = self.rows.map(|row| row.pdf(self.losses, cosine));
        a + (b - a) * self.part
    }

    /// The part of light that is lost, 0..=1.
    ///
    /// - `cosine`: between light and normal, 0..=1.
    pub(super) fn lost(&self, cosine: f64) -> f64 {
        let place = self.losses.place(cosine);
        let [a, b] = self.rows.map(|row| interpolated(&row.lost, place).clamp(0.0, 1.0));
        a + (b - a) * self.part
    }

    /// The mean of what is lost, weighted with the cosine.
    pub(super) fn mean(&self) -> f64 {
        let [a, b] = self.rows.map(|row| row.mean);
        a + (b - a) * self.part
    }

    /// The part of what is lost that leaves on the other side at last, 0..=1.
    ///
    /// With a and b the means of what is lost on the side of the lesser index and on the other, F the mean of Fresnel's
    /// term there, and the ratio η > 1 of the indices, the flux (1 − F / (1 + 4.8 m²)) min(a, η² b) goes to and fro, over
    /// the squares of the indices: seen from both sides, light is the same but for the square of the index.
    ///
    /// - `other`: the losses on the other side. `ratio`: the index on the other side over that on this one.
    ///
    /// # Source
    /// Ours; the factor 4.8 is fitted to random walks on the surface as Heitz and others 2016 describe them.
    pub(super) fn part_through(&self, other: &LossesOfRatio, ratio: f64) -> f64 {
        let (lesser, greater) = if ratio >= 1.0 { (self, other) } else { (other, self) };
        let square = ratio.max(ratio.recip()).powi(2);
        let [a, b] = lesser.rows.map(|row| row.through);
        let fresnel = 1.0 - (a + (b - a) * lesser.part);
        let reflected = fresnel / (1.0 + FURTHER * self.losses.facets.roughness().powi(2));
        let flux = (1.0 - reflected) * lesser.mean().min(greater.mean() * square);
        let own = self.mean() * if ratio >= 1.0 { 1.0 } else { square };
        if own > 0.0 { (flux / own).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// 2 ∫ f μ dμ
fn mean(of: impl Fn(f64) -> f64) -> f64 {
    let term = |part: usize| {
        let of = &of;
        GAUSS.iter().map(move |(at, weight)| {
            // Points gather at grazing angles.
            let root = (part as f64 + at) / MEAN_PARTS as f64;
            of(root * root) * 4.0 * root.powi(3) * weight / MEAN_PARTS as f64
        })
    };
    (0..MEAN_PARTS).flat_map(term).sum()
}

/// The part of a facet that both light and viewer see, over the product of their cosines.
///
/// Reflected light and viewer are on one side: what hides from the one hides from the other, too. Above and below, one
/// hides what the other does not: the part is a beta function of the two Λ.
///
/// - `cosines`: of viewer and light, above 0. `shown`: the area that the facets show to each. `is_through`: whether they
///   are on two sides. `is_correlated`: whether their heights are.
///
/// # Source
/// Heitz 2014, equations 99 and, for light that goes through, of section 6.3.
pub(super) fn masking([v, l]: [f64; 2], shown: [f64; 2], is_through: bool, is_correlated: bool) -> f64 {
    let [of_v, of_l] = shown;
    match (is_through, is_correlated) {
        (_, false) => (of_v * of_l).recip(),
        (false, true) => (v * of_l + l * (of_v - v)).recip(),
        (true, true) => beta(of_v / v, of_l / l) / (v * l),
    }
}
