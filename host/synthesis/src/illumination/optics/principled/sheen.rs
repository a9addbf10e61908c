//! Sheen: fibres that stand up from a cloth are seen, and lit, at grazing angles.

use crate::numeric::sampling::around_z;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// The least roughness of a sheen: below it there is hardly any.
const LEAST: f64 = 0.04;

/// The rim of a cloth: r(V) r(L) / (π r̄) with r = (1 − cosine)ᵏ, k = 1 / roughness, and r̄ its mean 2 / ((k + 1) (k +
/// 2)).
///
/// It reflects r(V) of the light from all around, and is reciprocal.
///
/// # Source
/// The form of Kelemen and Szirmay-Kalos 2001 for what is left of light, with a power of our own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheen {
    power: f64,
}

impl Sheen {
    /// - `roughness`: 0..=1; the rim is about as wide.
    pub(super) fn new(roughness: f64) -> Sheen {
        Sheen { power: roughness.clamp(LEAST, 1.0).recip() }
    }

    /// r at a cosine: the part of light from all around that a viewer gets.
    pub(super) fn albedo(self, cosine: f64) -> f64 {
        (1.0 - cosine.clamp(0.0, 1.0)).powf(self.power)
    }

    /// The mean of r, weighted with the cosine.
    pub(super) fn mean(self) -> f64 {
        2.0 / ((self.power + 1.0) * (self.power + 2.0))
    }

    /// Radiance for a unit of flux density, 1/sr.
    pub(super) fn value(self, view: f64, light: f64) -> f64 {
        self.albedo(view) * self.albedo(light) * FRAC_1_PI / self.mean()
    }

    /// The ground between the fibres: what the rim leaves, spread alike; 1/sr for a reflectance of 1.
    pub(super) fn ground(self, view: f64, light: f64) -> f64 {
        (1.0 - self.albedo(view)) * (1.0 - self.albedo(light)) * FRAC_1_PI / (1.0 - self.mean())
    }

    /// The pdf of samples, 1/sr: in proportion to the value times cosine.
    pub(super) fn pdf(self, light: f64) -> f64 {
        self.albedo(light) * light * FRAC_1_PI / self.mean()
    }

    /// A direction of light.
    pub(super) fn sample(self, point: [f64; 2]) -> DVec3 {
        around_z(self.cosine(point[0]), point[1])
    }

    /// The cosine c of which a part `uniform` lies below: 1 − (1 − c)^(k+1) (1 + (k + 1) c) is that part.
    fn cosine(self, uniform: f64) -> f64 {
        let n = self.power + 1.0;
        let (mut low, mut high) = (0.0, 1.0);
        let mut cosine = (2.0 / (n + 2.0)) * uniform.sqrt();
        for _ in 0..40 {
            let rest = (1.0 - cosine).powf(n);
            let below = 1.0 - rest * (1.0 + n * cosine) - uniform;
            if below < 0.0 {
                low = cosine
            } else {
                high = cosine
            }
            let slope = n * (n + 1.0) * cosine * (1.0 - cosine).powf(n - 1.0);
            let next = cosine - below / slope;
            let next = if (low..=high).contains(&next) { next } else { 0.5 * (low + high) };
            if (next - cosine).abs() < 1e-15 {
                break;
            }
            cosine = next;
        }
        cosine
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cosine_is_that_of_its_uniform_number() {
        for roughness in [0.0, 0.1, 0.3, 1.0] {
            let sheen = Sheen::new(roughness);
            let n = sheen.power + 1.0;
            for step in 1..100 {
                let uniform = f64::from(step) / 100.0;
                let cosine = sheen.cosine(uniform);
                let below = 1.0 - (1.0 - cosine).powf(n) * (1.0 + n * cosine);
                assert!((below - uniform).abs() < 1e-12, "{roughness} {uniform}: {cosine}");
            }
            for end in [0.0, 1.0_f64.next_down(), 1e-300] {
                assert!((0.0..=1.0).contains(&sheen.cosine(end)), "{end}");
            }
        }
    }
}
