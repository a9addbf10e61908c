//! Pictures in linear light, with coverage: files, how far two of them are apart, how two become one, and how many
//! become one that moves.

/// The words of the rows of a table, for scripts and the command line.
macro_rules! words {
    ($rows:expr) => {{
        let mut words = [""; $rows.len()];
        let mut row = 0;
        while row < $rows.len() {
            words[row] = $rows[row].word;
            row += 1;
        }
        words
    }};
}

/// The words of a table of rows, each with the value that it stands for.
macro_rules! named {
    ($rows:expr, $field:ident) => {{
        let mut named = [("", $rows[0].$field); $rows.len()];
        let mut row = 0;
        while row < $rows.len() {
            named[row] = ($rows[row].word, $rows[row].$field);
            row += 1;
        }
        named
    }};
}

mod animated_png;
mod compose;
mod depth;
mod difference;
pub mod display;
pub mod encoder;
mod error;
mod file;
mod filter;
mod flip;
mod frame_rate;
mod provenance;
pub mod source;
mod y4m;

pub use animated_png::animated_png;
pub use compose::{Operator, compose, compose_by_depth};
pub use depth::Deep;
pub use difference::{Difference, RELATIVE_FLOOR, difference};
pub use error::PictureError;
pub use file::pixel_of;
pub use filter::Filter;
pub use flip::{Flip, PIXELS_PER_DEGREE, PIXELS_PER_DEGREE_RANGE, error_map, flip};
pub use frame_rate::FrameRate;
pub use provenance::Provenance;
pub use y4m::{y4m_frame, y4m_header};

use crate::memory::prefer_large_pages;
use protocol::raster::srgb_from_linear;
use serde::{Deserialize, Serialize};

/// Most pixels that a picture may have (16384 x 16384).
pub const MAX_PIXELS: u64 = 1 << 28;

/// A picture of linear radiance in three bands, with the share of each pixel that an object covers.
///
/// Row 0 is the *top* row. The radiance of a pixel already includes the background behind and beside the objects, unless
/// the picture is a *matte*: then only covered samples have radiance, which is thus premultiplied by the coverage, as
/// [`compose`] needs it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<Pixel>,
}

/// What one pixel holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Pixel {
    /// Mean radiance over the pixel, W/(m² sr) in the red, green and blue band.
    pub radiance: [f32; 3],
    /// Share of the pixel's area in which the view ray meets an object, 0..=1.
    pub coverage: f32,
}

impl Picture {
    /// A black picture that nothing covers.
    ///
    /// # Errors
    /// [`PictureError::Size`] for an empty side or more than [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32) -> Result<Picture, PictureError> {
        let mut pixels = bytemuck::zeroed_vec(Picture::pixels_of(width, height)?);
        prefer_large_pages(&mut pixels);
        Ok(Picture { width, height, pixels })
    }

    /// How many pixels a picture has.
    ///
    /// # Errors
    /// [`PictureError::Size`] for an empty side or more than [`MAX_PIXELS`].
    pub fn pixels_of(width: u32, height: u32) -> Result<usize, PictureError> {
        let count = u64::from(width) * u64::from(height);
        let possible = (1..=MAX_PIXELS).contains(&count);
        possible.then_some(count as usize).ok_or(PictureError::Size { width, height })
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// All pixels, row by row from the top.
    pub fn pixels_mut(&mut self) -> &mut [Pixel] {
        &mut self.pixels
    }

    /// The pixel in column `x` of row `y`, or none outside the picture.
    pub fn get(&self, x: u32, y: u32) -> Option<Pixel> {
        (x < self.width && y < self.height).then(|| self.pixels[(y * self.width + x) as usize])
    }

    /// The picture as eight bits a band, sRGB, three bytes a pixel, from the top row on.
    ///
    /// Radiance 1 becomes 255; what is brighter is clipped.
    pub fn to_srgb8(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|p| p.radiance.map(srgb_from_linear)).collect()
    }

    /// The coverage as eight bits a pixel, from the top row on; 255 is full coverage.
    pub fn coverage8(&self) -> Vec<u8> {
        self.pixels.iter().map(|p| (p.coverage.clamp(0.0, 1.0) * 255.0).round() as u8).collect()
    }

    /// Whether nothing has radiance where nothing is covered, as in a matte.
    pub fn is_matte(&self) -> bool {
        self.pixels.iter().all(|p| p.coverage > 0.0 || p.radiance == [0.0; 3])
    }

    /// Whether every number in it is finite.
    pub fn is_finite(&self) -> bool {
        self.pixels.iter().all(|p| p.radiance.iter().all(|c| c.is_finite()) && p.coverage.is_finite())
    }
}
