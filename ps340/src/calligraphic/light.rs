//! The light that strokes leave on the screen, pixel by pixel.

use rayon::prelude::*;

use super::Exposure;
use super::track::LANES;
use crate::picture::Picture;

/// Light per pixel of a square screen; 1 is the centre of a long stroke of intensity 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    size: usize,
    /// Standard deviation of the spot that wrote it, in pixels.
    spot: f64,
    /// Row after row from the top; in a row all red, then all green, then all blue, each `stride` floats.
    rows: Vec<f32>,
}

impl Light {
    /// A dark screen of `size` by `size` pixels.
    pub(super) fn dark(size: usize, spot: f64) -> Self {
        Self { size, spot, rows: vec![0.0; size * 3 * stride(size)] }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> u32 {
        self.size as u32
    }

    /// Red, green and blue light of the pixel in column `x` from the left and row `y` from the top; `None`
    /// outside the screen.
    pub fn at(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        let (x, y) = (x as usize, y as usize);
        if x >= self.size || y >= self.size {
            return None;
        }
        let row = &self.rows[y * self.row_length()..];
        Some([0, 1, 2].map(|channel| row[channel * stride(self.size) + x]))
    }

    /// All the light on the screen, in red, green and blue.
    ///
    /// Its unit is the light of a stroke of length 1 (in screen units) and intensity 1, so that a stroke
    /// within the screen adds length times mean intensity times colour.
    pub fn total(&self) -> [f64; 3] {
        let stride = stride(self.size);
        let mut sum = [0.0; 3];
        for row in self.rows.chunks_exact(3 * stride) {
            for (sum, plane) in sum.iter_mut().zip(row.chunks_exact(stride)) {
                *sum += plane[..self.size].iter().map(|light| f64::from(*light)).sum::<f64>();
            }
        }
        // Across a line of peak 1 lie sqrt(2 pi) spot pixels of light; a pixel is 2 / size wide.
        let unit = 2.0 / self.size as f64 / ((2.0 * std::f64::consts::PI).sqrt() * self.spot);
        sum.map(|sum| sum * unit)
    }

    /// The picture that an exposure makes of the light.
    pub fn expose(&self, exposure: &Exposure) -> Picture {
        self.map(|light| exposure.respond(light))
    }

    /// The light itself as the pixels of a picture, without any response: may exceed 1.
    pub fn unexposed(&self) -> Picture {
        self.map(|light| light)
    }

    /// A picture with `respond` of every pixel's light.
    fn map(&self, respond: impl Fn([f32; 3]) -> [f32; 3] + Sync) -> Picture {
        let mut pixels = vec![[0.0; 3]; self.size * self.size];
        let stride = stride(self.size);
        pixels.par_chunks_mut(self.size).zip(self.rows.par_chunks(3 * stride)).for_each(|(pixels, row)| {
            for (x, pixel) in pixels.iter_mut().enumerate() {
                *pixel = respond([row[x], row[stride + x], row[2 * stride + x]]);
            }
        });
        Picture::new(self.size as u32, self.size as u32, pixels).expect("size is at least 1, pixels its square")
    }

    /// Floats of one row of pixels.
    pub(super) fn row_length(&self) -> usize {
        3 * stride(self.size)
    }

    /// All rows, from the top.
    pub(super) fn rows_mut(&mut self) -> &mut [f32] {
        &mut self.rows
    }
}

/// Floats of one channel of one row: room for a whole vector of lanes that begins at the last pixel.
fn stride(size: usize) -> usize {
    size.next_multiple_of(LANES) + LANES
}
