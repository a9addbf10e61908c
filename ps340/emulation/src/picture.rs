//! A picture of either screen: linear red, green and blue, as PNG or OpenEXR.

use files::{Destination, Sandbox, WriteError};
use protocol::raster::srgb_from_linear;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use image::ExtendedColorType::{Rgb8, Rgb32F};
use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ImageEncoder, ImageError};
use rayon::prelude::*;

/// A rectangle of linear red, green and blue, 1 = the white of the display; top row first.
///
/// Equal pixels always give equal bytes of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

/// The reason why a picture was not made or not written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The number of pixels is not width times height, or the picture is empty.
    #[error("a picture of {width} by {height} cannot have {pixels} pixels")]
    Shape {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// Pixels given.
        pixels: usize,
    },
    /// The name of the file does not end in `.png` or `.exr`.
    #[error("cannot write a picture to {}: the name must end in .png or .exr", path.display())]
    Extension {
        /// The file asked for.
        path: PathBuf,
    },
    /// The encoder refused.
    #[error("cannot encode the picture for {}: {source}", path.display())]
    Encode {
        /// The file asked for.
        path: PathBuf,
        /// What the encoder says.
        source: ImageError,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl Picture {
    /// Makes a picture of `pixels`, top row first, left to right.
    ///
    /// # Errors
    /// [`PictureError::Shape`] if there are not `width * height` pixels, or none.
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Result<Self, PictureError> {
        let expected = u64::from(width) * u64::from(height);
        if expected == 0 || pixels.len() as u64 != expected {
            return Err(PictureError::Shape { width, height, pixels: pixels.len() });
        }
        Ok(Self { width, height, pixels })
    }

    /// Width in pixels, at least 1.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels, at least 1.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, top row first, left to right.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The pixel in column `x` from the left and row `y` from the top; `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        let inside = x < self.width && y < self.height;
        inside.then(|| self.pixels[y as usize * self.width as usize + x as usize])
    }

    /// The pixels as bytes of sRGB, three a pixel: what a PNG of the picture holds.
    pub fn to_srgb(&self) -> Vec<u8> {
        let mut bytes = vec![0; self.pixels.len() * 3];
        let row = self.width as usize;
        bytes.par_chunks_mut(row * 3).zip(self.pixels.par_chunks(row)).for_each(|(bytes, pixels)| {
            for (byte, value) in bytes.iter_mut().zip(pixels.as_flattened()) {
                *byte = srgb_from_linear(*value);
            }
        });
        bytes
    }

    /// The picture as a PNG file: 8 bits a channel, sRGB.
    ///
    /// # Errors
    /// What the encoder says, if it refuses the size.
    pub fn to_png(&self) -> Result<Vec<u8>, ImageError> {
        let mut file = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut file, CompressionType::Default, FilterType::Adaptive);
        encoder.write_image(&self.to_srgb(), self.width, self.height, Rgb8)?;
        Ok(file)
    }

    /// The picture as an OpenEXR file: 32-bit floats, linear, not clamped.
    ///
    /// # Errors
    /// What the encoder says, if it refuses the size.
    pub fn to_exr(&self) -> Result<Vec<u8>, ImageError> {
        let samples: Vec<u8> = self.pixels.as_flattened().iter().flat_map(|value| value.to_ne_bytes()).collect();
        let mut file = Cursor::new(Vec::new());
        OpenExrEncoder::new(&mut file).write_image(&samples, self.width, self.height, Rgb32F)?;
        Ok(file.into_inner())
    }

    /// Where a picture will be written, tested before it is made. The ending of the name says how: `.png` or `.exr`, in
    /// either case of letters.
    ///
    /// # Errors
    /// Another ending, or that no file can be written there; each names the path.
    pub fn destination(path: &Path) -> Result<Destination, PictureError> {
        Format::of(path)?;
        Ok(Destination::of(path)?)
    }

    /// Where a picture will be written below a folder, tested before it is made, by the ending of its name as in
    /// [`Picture::destination`].
    ///
    /// # Errors
    /// Another ending, or that no file can be written there; each names the path.
    pub fn destination_below(folder: &Sandbox, path: &Path) -> Result<Destination, PictureError> {
        Format::of(path)?;
        Ok(folder.destination(path)?)
    }

    /// Writes the picture to a file.
    ///
    /// # Errors
    /// What the encoder or the file system says; each names the path.
    pub fn write(&self, destination: &Destination) -> Result<(), PictureError> {
        let path = destination.path();
        let encoded = match Format::of(path)? {
            Format::Png => self.to_png(),
            Format::Exr => self.to_exr(),
        };
        let bytes = encoded.map_err(|source| PictureError::Encode { path: path.into(), source })?;
        Ok(destination.write(|file| file.write_all(&bytes))?)
    }
}

/// How a picture is written.
enum Format {
    Png,
    Exr,
}

impl Format {
    fn of(path: &Path) -> Result<Format, PictureError> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("png") => Ok(Format::Png),
            Some("exr") => Ok(Format::Exr),
            _ => Err(PictureError::Extension { path: path.into() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Picture {
        let pixels = (0..35).map(|index| [index as f32 / 34.0, 0.25, 2.0 - index as f32]).collect();
        Picture::new(7, 5, pixels).unwrap()
    }

    #[test]
    fn a_png_holds_the_srgb_bytes() {
        let read = image::load_from_memory(&gradient().to_png().unwrap()).unwrap().into_rgb8();
        assert_eq!((read.width(), read.height()), (7, 5));
        assert_eq!(read.into_raw(), gradient().to_srgb());
    }

    #[test]
    fn an_exr_holds_the_linear_floats_unclamped() {
        let read = image::load_from_memory(&gradient().to_exr().unwrap()).unwrap().into_rgb32f();
        assert_eq!(read.into_raw(), gradient().pixels().as_flattened());
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        assert_eq!(gradient().to_png().unwrap(), gradient().to_png().unwrap());
        assert_eq!(gradient().to_exr().unwrap(), gradient().to_exr().unwrap());
    }

    #[test]
    fn the_ending_chooses_the_format_and_errors_name_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let png = folder.path().join("a.PNG");
        gradient().write(&Picture::destination(&png).unwrap()).unwrap();
        assert_eq!(std::fs::read(&png).unwrap(), gradient().to_png().unwrap());
        let exr = folder.path().join("a.exr");
        gradient().write(&Picture::destination(&exr).unwrap()).unwrap();
        assert_eq!(std::fs::read(&exr).unwrap(), gradient().to_exr().unwrap());

        for (name, kind) in
            [("a.gif", "must end in"), ("a", "must end in"), ("no/such/folder/a.png", "there is no folder")]
        {
            let path = folder.path().join(name);
            let message = Picture::destination(&path).unwrap_err().to_string();
            assert!(message.contains(kind) && message.contains(path.to_str().unwrap()), "{message}");
        }
    }

    #[test]
    fn a_wrong_number_of_pixels_is_refused() {
        assert!(matches!(Picture::new(2, 2, vec![[0.0; 3]; 3]), Err(PictureError::Shape { pixels: 3, .. })));
        assert!(Picture::new(0, 2, vec![]).is_err());
    }

    #[test]
    fn pixels_are_addressed_from_the_top_left() {
        let picture = gradient();
        assert_eq!(picture.pixel(6, 0), Some(picture.pixels()[6]));
        assert_eq!(picture.pixel(0, 4), Some(picture.pixels()[28]));
        assert_eq!(picture.pixel(7, 0), None);
        assert_eq!(picture.pixel(0, 5), None);
    }
}
