//! Spectra as a few numbers: means over bins of wavelengths, or values at one wavelength in each bin.
//!
//! A renderer carries one number for each bin. Means have no noise, but a mean of products is not the product of means:
//! the error falls with the square of the width of the bins. Wavelengths sampled in the bins have noise and no such
//! error. Three bands of a screen are [`super::srgb`] of what is [`super::observer::surface_tristimulus`].

use super::observer::{VISIBLE, functions};
use super::{ColorError, Spectrum, integral};
use glam::DVec3;

/// Neighbouring bins of wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Bins {
    /// The borders, nm: one more than there are bins.
    edges: Vec<f64>,
}

impl Bins {
    /// Bins of equal width over all that is seen, 360 to 830 nm.
    ///
    /// # Errors
    /// [`ColorError::TooFew`] for no bin.
    pub fn visible(count: usize) -> Result<Bins, ColorError> {
        let edge = |i: usize| VISIBLE.0 + (VISIBLE.1 - VISIBLE.0) * i as f64 / count.max(1) as f64;
        Bins::between((0..=count).map(edge).collect())
    }

    /// Bins between rising wavelengths, nm.
    ///
    /// # Errors
    /// [`ColorError`] for fewer than two wavelengths, or some that do not rise.
    pub fn between(edges: Vec<f64>) -> Result<Bins, ColorError> {
        if edges.len() < 2 {
            return Err(ColorError::TooFew(edges.len()));
        }
        let falls = |i: &usize| !(edges[*i] > if *i == 0 { 0.0 } else { edges[i - 1] } && edges[*i].is_finite());
        match (0..edges.len()).find(falls) {
            Some(index) => Err(ColorError::Wavelength { index, wavelength: edges[index] }),
            None => Ok(Bins { edges }),
        }
    }

    /// The borders of each bin, nm.
    pub fn ranges(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.edges.windows(2).map(|pair| (pair[0], pair[1]))
    }

    /// The mean of a spectrum in each bin.
    pub fn means(&self, spectrum: &Spectrum) -> Vec<f64> {
        self.ranges().map(|(from, to)| integral(&[spectrum], from, to) / (to - from)).collect()
    }

    /// The mean of a reflectance in each bin, weighted with a light: right for one reflection of that light.
    ///
    /// A bin without light has the plain mean.
    pub fn means_under(&self, reflectance: &Spectrum, light: &Spectrum) -> Vec<f64> {
        let mean = |(from, to): (f64, f64)| {
            let all = integral(&[light], from, to);
            let plain = all <= 0.0;
            if plain {
                integral(&[reflectance], from, to) / (to - from)
            } else {
                integral(&[reflectance, light], from, to) / all
            }
        };
        self.ranges().map(mean).collect()
    }

    /// One wavelength in each bin, all at the same part of their bins, nm.
    ///
    /// - `part`: 0..1. For a number uniform there, the mean of width times value over all is the integral.
    pub fn wavelengths(&self, part: f64) -> Vec<f64> {
        self.ranges().map(|(from, to)| from + (to - from) * part).collect()
    }

    /// X, Y and Z of a light that has the value 1 in one bin and 0 in the others, for each bin: weights with which
    /// the values of a light in the bins add up to its X, Y and Z. Unit: that of the light times nm.
    pub fn weights(&self) -> Vec<DVec3> {
        let bin = |(from, to)| DVec3::from_array(functions().each_ref().map(|f| integral(&[f], from, to)));
        self.ranges().map(bin).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::observer::tristimulus;
    use super::super::shipped;
    use super::*;

    fn seen(bins: &Bins, values: &[f64]) -> DVec3 {
        bins.weights().iter().zip(values).map(|(weight, value)| *weight * *value).sum()
    }

    #[test]
    fn more_bins_come_nearer_to_the_colour_of_a_spectrum() {
        let light = shipped::D65.times(&shipped::reflectance("red").expect("a patch")).expect("a product");
        let exact = tristimulus(&light);
        let error = |count| {
            let bins = Bins::visible(count).expect("bins");
            (seen(&bins, &bins.means(&light)) - exact).length() / exact.length()
        };
        let errors = [8, 16, 32, 64].map(error);
        assert!(errors[0] < 0.1 && errors[3] < 2e-3, "{errors:?}");
        assert!(errors.windows(2).all(|pair| pair[0] / pair[1] > 3.9), "second order: {errors:?}");
    }

    #[test]
    fn wavelengths_sampled_in_bins_have_no_bias() {
        let bins = Bins::visible(4).expect("bins");
        let exact = tristimulus(&shipped::D65);
        let parts = 200;
        let value = |w: f64| DVec3::from_array(functions().each_ref().map(|f| f.at(w))) * shipped::D65.at(w);
        let estimate = |i: i32| {
            let at = bins.wavelengths((f64::from(i) + 0.5) / f64::from(parts));
            at.into_iter().zip(bins.ranges()).map(|(w, (from, to))| value(w) * (to - from)).sum::<DVec3>()
        };
        let mean = (0..parts).map(estimate).sum::<DVec3>() / f64::from(parts);
        assert!((mean - exact).length() < 1e-4 * exact.length());
    }

    #[test]
    fn one_bin_holds_the_plain_or_weighted_mean() {
        let one = Bins::between(vec![380.0, 780.0]).expect("a bin");
        let red = shipped::reflectance("red").expect("a patch");
        let (plain, weighted) = (one.means(&red)[0], one.means_under(&red, &shipped::light("A").expect("a light"))[0]);
        assert!(plain > 0.2 && weighted > plain, "lamp light is red: {plain} {weighted}");
        assert!(Bins::visible(0).is_err() && Bins::between(vec![500.0, 400.0]).is_err());
    }
}
