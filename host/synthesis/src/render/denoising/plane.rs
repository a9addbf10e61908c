//! Planes of numbers, one for each pixel, with room around them for what looks beyond an edge.

use crate::memory::prefer_large_pages;
use rayon::prelude::*;

/// Pixels of a row that are worked on at once.
pub(super) const LANES: usize = 16;

/// So many rows are summed up at once: sums across them stay in the cache.
const STRIP: usize = 32;

/// One number for each pixel. Beyond its edges the nearest pixel is repeated.
#[derive(Clone, Debug)]
pub(super) struct PixelPlane {
    pub(super) width: usize,
    pub(super) height: usize,
    /// How far it goes beyond each edge, pixels; on the right and below at least so far.
    margin: usize,
    stride: usize,
    values: Vec<f32>,
}

impl PixelPlane {
    /// A plane of numbers that are found pixel by pixel.
    ///
    /// - `size`: columns and rows. `margin`: how far it goes beyond each edge, pixels; without one, lanes cannot be
    ///   read.
    /// - `value`: of the pixel of a number, counted row by row.
    pub(super) fn new([width, height]: [usize; 2], margin: usize, value: impl Fn(usize) -> f32 + Sync) -> PixelPlane {
        let stride = if margin == 0 { width } else { margin + width.next_multiple_of(LANES) + margin };
        let rows = margin + height + margin;
        let mut values = zeros(stride * rows);
        values.par_chunks_exact_mut(stride).enumerate().for_each(|(row, values)| {
            let y = row.saturating_sub(margin).min(height - 1);
            for (x, place) in values[margin..margin + width].iter_mut().enumerate() {
                *place = value(y * width + x);
            }
            let (first, last) = (values[margin], values[margin + width - 1]);
            values[..margin].fill(first);
            values[margin + width..].fill(last);
        });
        PixelPlane { width, height, margin, stride, values }
    }

    /// The number of a pixel, counted row by row.
    pub(super) fn of(&self, pixel: usize) -> f32 {
        if self.margin == 0 {
            return self.values[pixel];
        }
        self.values[self.place((pixel % self.width) as isize, (pixel / self.width) as isize)]
    }

    /// The numbers of a row from a column on; both may be beyond an edge.
    #[inline(always)]
    pub(super) fn from(&self, x: isize, y: isize) -> &[f32] {
        &self.values[self.place(x, y)..]
    }

    /// All numbers, row by row, those beyond the edges included: see [`PixelPlane::place`].
    #[inline(always)]
    pub(super) fn values(&self) -> &[f32] {
        &self.values
    }

    /// The index among all numbers of a column and a row; both may be beyond an edge.
    #[inline(always)]
    pub(super) fn place(&self, x: isize, y: isize) -> usize {
        let margin = self.margin as isize;
        ((y + margin) * self.stride as isize + x + margin) as usize
    }

    /// How far apart places of neighbors are.
    ///
    /// - `x`, `y`: columns and rows from one to the other.
    #[inline(always)]
    pub(super) fn step(&self, x: isize, y: isize) -> isize {
        y * self.stride as isize + x
    }

    /// The plane that is a sum over the surroundings of each pixel, without a margin.
    ///
    /// - `kernel`: how much a pixel counts in rows and in columns by its distance from the middle, the first at 0.
    pub(super) fn convolved(&self, kernel: &[f32]) -> PixelPlane {
        let (width, height) = (self.width, self.height);
        let far = kernel.len() - 1;
        let mut result = zeros(width * height);
        let strips = result.par_chunks_mut(STRIP * width).enumerate();
        strips.for_each_init(<[Vec<f32>; 2]>::default, |[row, across], (strip, sums)| {
            let rows = strip * STRIP..(strip * STRIP + sums.len() / width);
            let first = rows.start.saturating_sub(far);
            let last = (rows.end + far).min(height);
            across.resize((last - first) * width, 0.0);
            for (y, across) in (first..last).zip(across.chunks_exact_mut(width)) {
                let own = &self.from(0, y as isize)[..width];
                // With the pixels at both ends repeated.
                row.clear();
                row.extend(std::iter::repeat_n(own[0], far));
                row.extend_from_slice(own);
                row.extend(std::iter::repeat_n(own[width - 1], far));
                across.iter_mut().zip(own).for_each(|(sum, value)| *sum = kernel[0] * value);
                for (distance, part) in kernel.iter().enumerate().skip(1) {
                    let pairs = row[far - distance..].iter().zip(&row[far + distance..]);
                    across.iter_mut().zip(pairs).for_each(|(sum, (before, after))| *sum += part * (before + after));
                }
            }
            for (y, sums) in rows.zip(sums.chunks_exact_mut(width)) {
                let row = |y: usize| &across[(y - first) * width..][..width];
                sums.iter_mut().zip(row(y)).for_each(|(sum, value)| *sum = kernel[0] * value);
                for (distance, part) in kernel.iter().enumerate().skip(1) {
                    let pairs = row(y.saturating_sub(distance)).iter().zip(row((y + distance).min(height - 1)));
                    sums.iter_mut().zip(pairs).for_each(|(sum, (above, below))| *sum += part * (above + below));
                }
            }
        });
        PixelPlane { margin: 0, stride: width, values: result, ..*self }
    }
}

/// Memory for a plane.
fn zeros(count: usize) -> Vec<f32> {
    let mut values = vec![0.0; count];
    prefer_large_pages(&mut values);
    values
}

/// A bell to sum with, which is 1 in all, up to three standard deviations.
///
/// - `deviation`: standard deviation, pixels.
pub(super) fn bell(deviation: f32) -> Vec<f32> {
    let far = (3.0 * deviation).ceil() as usize;
    let bell: Vec<f32> = (0..=far).map(|far| (-0.5 * (far as f32 / deviation).powi(2)).exp()).collect();
    normalised(bell)
}

/// The mean over a square.
///
/// - `far`: how far it goes to each side, pixels.
pub(super) fn square(far: usize) -> Vec<f32> {
    normalised(vec![1.0; far + 1])
}

fn normalised(kernel: Vec<f32>) -> Vec<f32> {
    let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f32>();
    kernel.into_iter().map(|part| part / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_becomes_the_kernel_and_an_even_plane_stays() {
        let point = PixelPlane::new([9, 7], 2, |pixel| f32::from(u8::from(pixel == 3 * 9 + 4)));
        let kernel = bell(0.7);
        let spread = point.convolved(&kernel);
        for (x, y) in [(4, 3), (5, 3), (4, 1), (6, 4)] {
            let expected = kernel[4usize.abs_diff(x)] * kernel[3usize.abs_diff(y)];
            assert!((spread.of(y * 9 + x) - expected).abs() < 1e-6);
        }
        let even = PixelPlane::new([20, 3], 0, |_| 2.0);
        for kernel in [bell(4.0), square(10)] {
            let smooth = even.convolved(&kernel);
            assert!((0..60).all(|pixel| (smooth.of(pixel) - 2.0).abs() < 1e-5));
        }
    }

    #[test]
    fn beyond_an_edge_the_nearest_pixel_is_repeated() {
        let plane = PixelPlane::new([3, 2], 4, |pixel| pixel as f32);
        assert_eq!([[-4, -4], [-1, 1], [2, 0]].map(|[x, y]| plane.from(x, y)[0]), [0.0, 3.0, 2.0]);
        assert_eq!(plane.from(2, 5)[..4], [5.0; 4]);
        assert_eq!(plane.place(1, -2) as isize + plane.step(-3, 4), plane.place(-2, 2) as isize);
    }
}
