//! What a distribution loses of light over the cosine, and how it is emitted again over the whole hemisphere.

use super::even_table::{LinearPdf, interpolated};
use crate::numeric::cubature::GAUSS;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Intervals of the table of what is lost.
const STEPS: usize = 128;
/// The largest chance to sample what was lost: the rest keeps some, where nearly all is lost.
const MOST_CHANCE: f64 = 0.95;
/// The smallest cosine of the table; below, what is lost does not change any more.
const LEAST_COSINE: f64 = 1e-9;

/// What is lost at each incidence, 1 − E_L, and emitted again as (1 − E_L)(1 − E_V)(N·V) / (π (1 − E)), E the mean.
///
/// # Source
/// Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017.
#[derive(Clone, Debug)]
pub(super) struct Losses {
    /// The cosine below which what is lost is about the same: what hides is seen from there.
    scale: f64,
    /// 1 − E over the incidence, at even steps of [`Losses::place`].
    lost: Vec<f64>,
    mean: f64,
    /// The pdf, over the place in the table, of what is emitted again; empty if nothing is lost.
    emitted: LinearPdf,
}

impl Losses {
    /// - `roughness`: about how wide the distribution is. `lost`: what it loses at a cosine, 0..=1.
    pub(super) fn new(roughness: f64, lost: impl Fn(f64) -> f64 + Sync) -> Losses {
        let scale = 0.01 * roughness.min(1.0 / roughness);
        let mut made = Losses { scale, lost: Vec::new(), mean: 0.0, emitted: LinearPdf::default() };
        let cosine = |step: usize| made.cosine(step as f64 / STEPS as f64).max(LEAST_COSINE);
        let table: Vec<f64> = (0..=STEPS).into_par_iter().map(|step| lost(cosine(step))).collect();
        made.lost = table;
        made.mean = (0..STEPS).map(|step| made.lost_in(step)).sum();
        let emitted = |step: usize| {
            let place = step as f64 / STEPS as f64;
            made.lost[step] * made.cosine(place) * made.stretch(place)
        };
        made.emitted = LinearPdf::new((0..=STEPS).map(emitted).collect());
        made
    }

    /// The place of a cosine in the table, 0..=1: even steps below the scale, and even ratios above it.
    fn place(&self, cosine: f64) -> f64 {
        (cosine / self.scale).asinh() / self.scale.recip().asinh()
    }

    /// The cosine at a place of the table.
    fn cosine(&self, place: f64) -> f64 {
        self.scale * (place * self.scale.recip().asinh()).sinh()
    }

    /// dμ / dplace
    fn stretch(&self, place: f64) -> f64 {
        let all = self.scale.recip().asinh();
        self.scale * all * (place * all).cosh()
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

    /// A cosine of what is emitted again, from a uniform number.
    pub(super) fn sample(&self, uniform: f64) -> f64 {
        self.cosine(self.emitted.sample(uniform))
    }

    /// The pdf of [`Losses::sample`], 1/sr.
    pub(super) fn pdf(&self, cosine: f64) -> f64 {
        let place = self.place(cosine).clamp(0.0, 1.0);
        self.emitted.at(place) / (self.stretch(place) * TAU)
    }

    /// The part of light that is lost, 0..=1.
    ///
    /// - `cosine`: between light and normal, 0..=1.
    pub(super) fn lost(&self, cosine: f64) -> f64 {
        interpolated(&self.lost, self.place(cosine).clamp(0.0, 1.0)).clamp(0.0, 1.0)
    }

    /// The mean of [`Losses::lost`] over the hemisphere, weighted with the cosine.
    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// The chance that a sample is of what was lost.
    pub(super) fn chance(&self, cosine: f64) -> f64 {
        if self.emitted.is_empty() { 0.0 } else { self.lost(cosine).min(MOST_CHANCE) }
    }

    /// D of what is emitted again, 1/sr.
    ///
    /// - `light`, `view`: their cosines.
    pub(super) fn density(&self, light: f64, view: f64) -> f64 {
        if self.mean > 0.0 { self.lost(light) * self.lost(view) * view * FRAC_1_PI / self.mean } else { 0.0 }
    }
}
