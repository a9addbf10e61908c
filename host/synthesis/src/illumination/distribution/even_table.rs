//! Tables at even steps of a place 0..=1: what is between them, and places sampled by a pdf of such a table.

/// The value at a place, by Lagrange's cubic through the four nearest entries.
///
/// - `values`: four and more. `place`: 0..=1.
pub(in crate::illumination) fn interpolated(values: &[f64], place: f64) -> f64 {
    let place = place * (values.len() - 1) as f64;
    let first = (place as usize).saturating_sub(1).min(values.len() - 4);
    let x = place - first as f64;
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| values[first + i]);
    a * (1.0 - x) * (2.0 - x) * (3.0 - x) / 6.0
        + b * x * (2.0 - x) * (3.0 - x) / 2.0
        + c * x * (x - 1.0) * (3.0 - x) / 2.0
        + d * x * (x - 1.0) * (x - 2.0) / 6.0
}

/// A pdf over the places 0..=1 that is linear between even steps.
#[derive(Clone, Debug, Default)]
pub(in crate::illumination) struct LinearPdf {
    /// The pdf at each step.
    values: Vec<f64>,
    /// Its integral up to the end of each interval; empty if nothing is to be sampled.
    below: Vec<f64>,
}

impl LinearPdf {
    /// The pdf in proportion to values at even steps, two and more, none below 0.
    pub(in crate::illumination) fn new(mut values: Vec<f64>) -> LinearPdf {
        let intervals = || values.windows(2).map(|pair| pair[0] + pair[1]);
        let all: f64 = intervals().sum();
        let mut below = Vec::new();
        if all > 0.0 {
            let up_to = |sum: &mut f64, part: f64| {
                *sum += part / all;
                Some(*sum)
            };
            below = intervals().scan(0.0, up_to).collect();
            values.iter_mut().for_each(|value| *value *= 2.0 * below.len() as f64 / all);
        }
        LinearPdf { values, below }
    }

    /// Whether all values are 0: nothing is to be sampled.
    pub(in crate::illumination) fn is_empty(&self) -> bool {
        self.below.is_empty()
    }

    /// A place; of a pdf that is not empty.
    ///
    /// - `uniform`: 0..=1.
    pub(in crate::illumination) fn sample(&self, uniform: f64) -> f64 {
        let steps = self.below.len();
        let step = self.below.partition_point(|below| *below <= uniform).min(steps - 1);
        let before = if step == 0 { 0.0 } else { self.below[step - 1] };
        let (from, to) = (self.values[step], self.values[step + 1]);
        // From x + (to − from) x² / 2 is what is left.
        let left = ((uniform - before) * steps as f64).max(0.0);
        let root = (from * from + 2.0 * (to - from) * left).max(0.0).sqrt();
        let part = if from + root > 0.0 { (2.0 * left / (from + root)).min(1.0) } else { 0.0 };
        (step as f64 + part) / steps as f64
    }

    /// The pdf at a place, 0..=1.
    pub(in crate::illumination) fn at(&self, place: f64) -> f64 {
        let steps = self.values.len() - 1;
        let place = place * steps as f64;
        let step = (place as usize).min(steps - 1);
        let part = place - step as f64;
        self.values[step] * (1.0 - part) + self.values[step + 1] * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_met_everywhere() {
        let cubic = |x: f64| 1.0 - 2.0 * x + 3.0 * x * x - x * x * x;
        let values: Vec<f64> = (0..=7).map(|step| cubic(f64::from(step) / 7.0)).collect();
        for place in [0.0, 0.03, 0.2, 0.5, 0.77, 1.0] {
            assert!((interpolated(&values, place) - cubic(place)).abs() < 1e-14, "{place}");
        }
    }

    #[test]
    fn places_are_sampled_as_the_pdf_tells_and_zeros_are_empty() {
        assert!(LinearPdf::new(vec![0.0; 3]).is_empty());
        let pdf = LinearPdf::new(vec![0.0, 3.0, 1.0, 1.0]);
        assert!(!pdf.is_empty());
        // The integral of the pdf up to a sampled place is the uniform number.
        let integral = |place: f64| {
            let part = |step: u32| place * (f64::from(step) + 0.5) / 3e4;
            (0..30_000).map(|step| pdf.at(part(step))).sum::<f64>() * place / 3e4
        };
        assert!((integral(1.0) - 1.0).abs() < 1e-8);
        for uniform in [0.0, 0.1, 0.3, 0.5, 0.83, 1.0] {
            assert!((integral(pdf.sample(uniform)) - uniform).abs() < 1e-7, "{uniform}");
        }
    }
}
