//! Pictures as files: PNG with eight bits sRGB, OpenEXR with linear 32-bit floats.

use super::source::{PictureReader, Texel, format_of};
use super::{Picture, PictureError, Pixel, Provenance, encoder};
use crate::memory;
use exr::prelude::{SpecificChannels, Vec2, WritableImage};
use files::Destination;
use image::ImageFormat;
use protocol::raster::{light_of_srgb, linear_from_srgb};
use std::path::Path;

impl Picture {
    /// Whether a name is that of an EXR file.
    pub fn is_exr(path: &Path) -> bool {
        matches!(format_of(path), Ok(ImageFormat::OpenExr))
    }

    /// Whether a name ends as that of a picture.
    pub fn is_picture(path: &Path) -> bool {
        format_of(path).is_ok()
    }

    /// Where a picture will be written, tested before a long computation.
    ///
    /// # Errors
    /// [`PictureError::Format`] for a name that does not end in .png or .exr, [`PictureError::Write`] where no file can be
    /// written.
    pub fn destination(path: &Path) -> Result<Destination, PictureError> {
        written_as(path)?;
        Ok(Destination::of(path)?)
    }

    /// Writes the picture: `.png` as opaque eight-bit sRGB, `.exr` as linear 32-bit RGB with the coverage as alpha.
    ///
    /// # Errors
    /// [`PictureError::Format`] for another name, [`PictureError::Write`] if the file cannot be written; it may be kept
    /// elsewhere then.
    pub fn write(&self, destination: &Destination) -> Result<(), PictureError> {
        self.write_with(destination, &Provenance::default())
    }

    /// Writes the picture as [`Picture::write`] does, with what is told of how it was made.
    ///
    /// # Errors
    /// Those of [`Picture::write`].
    pub fn write_with(&self, destination: &Destination, provenance: &Provenance) -> Result<(), PictureError> {
        let (width, height) = (self.width, self.height);
        match written_as(destination.path())? {
            ImageFormat::Png => {
                let bytes = self.to_srgb8();
                destination.write_or_save_elsewhere(|file| encoder::png(file, &bytes, [width, height], provenance))?;
            }
            _ => {
                let pixel = move |at: Vec2<usize>| {
                    let Pixel { radiance: [r, g, b], coverage } = self.pixels[at.y() * width as usize + at.x()];
                    (r, g, b, coverage)
                };
                let channels = SpecificChannels::rgba(pixel);
                let image = encoder::exr([width, height], channels, provenance);
                destination
                    .write_or_save_elsewhere(|file| image.write().to_buffered(file).map_err(encoder::exr_error))?;
            }
        }
        Ok(())
    }

    /// Reads a PNG, EXR or HDR file into linear light. Without an alpha channel, everything counts as covered.
    ///
    /// PNG files hold colours beside their alpha; these are premultiplied by it here, as EXR files hold them.
    ///
    /// # Errors
    /// [`PictureError`] for a file that is missing, broken, of another format or too large.
    pub fn read(path: &Path) -> Result<Picture, PictureError> {
        let source = PictureReader::open(path)?;
        let mut picture = Picture::for_source(&source, path, size_of::<Pixel>())?;
        let width = picture.width as usize;
        source.each(|x, y, texel| picture.pixels[y as usize * width + x as usize] = pixel_of(texel))?;
        Ok(picture)
    }

    /// A black picture of the size of a file, if there is memory for it.
    ///
    /// - `bytes`: for each pixel.
    pub(super) fn for_source(source: &PictureReader<'_>, path: &Path, bytes: usize) -> Result<Picture, PictureError> {
        let [width, height] = source.size();
        let bytes = Picture::pixels_of(width, height)? as u64 * bytes as u64;
        memory::reserve(bytes, || format!("{}: a picture of {width} x {height} pixels", path.display()))?;
        Picture::new(width, height)
    }

    /// Reads a file as [`Picture::read`] does, in which every number must be finite.
    ///
    /// # Errors
    /// Those of [`Picture::read`], and [`PictureError::Number`] for the first pixel with another number.
    pub fn read_finite(path: &Path) -> Result<Picture, PictureError> {
        let picture = Picture::read(path)?;
        picture.check_finite(path)?;
        Ok(picture)
    }

    /// [`PictureError::Number`] for the first pixel that is not finite.
    pub(super) fn check_finite(&self, path: &Path) -> Result<(), PictureError> {
        let is_wrong = |p: &Pixel| !p.coverage.is_finite() || p.radiance.iter().any(|c| !c.is_finite());
        match self.pixels.iter().position(is_wrong) {
            None => Ok(()),
            Some(at) => {
                let (x, y) = (at as u32 % self.width, at as u32 / self.width);
                Err(PictureError::Number { path: path.into(), x, y })
            }
        }
    }
}

/// The format of the name of a picture that is written.
fn written_as(path: &Path) -> Result<ImageFormat, PictureError> {
    match format_of(path) {
        Ok(format) if format != ImageFormat::Hdr => Ok(format),
        _ => Err(PictureError::Format { path: path.into(), endings: ".png or .exr" }),
    }
}

/// The pixel that a file tells. Colors beside a coverage are premultiplied by it.
pub fn pixel_of(texel: Texel) -> Pixel {
    let beside = |light: [f32; 3], coverage: f32| Pixel { radiance: light.map(|c| coverage * c), coverage };
    match texel {
        Texel::Eight([r, g, b, a]) => beside([r, g, b].map(linear_from_srgb), f32::from(a) / 255.0),
        Texel::Sixteen([r, g, b, a]) => {
            let light = [r, g, b].map(|code| light_of_srgb(f64::from(code) / 65_535.0) as f32);
            beside(light, (f64::from(a) / 65_535.0) as f32)
        }
        Texel::Float([r, g, b, a, _]) => Pixel { radiance: [r, g, b], coverage: a },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Picture {
        let mut picture = Picture::new(5, 3).expect("small");
        for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
            let x = i as f32 / 15.0;
            *pixel = Pixel { radiance: [x, 1.5 * x, 3.0 - x], coverage: x };
        }
        picture
    }

    #[test]
    fn an_exr_file_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        sample().write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert_eq!(Picture::read(&path).expect("read"), sample());
    }

    #[test]
    fn a_png_file_reads_back_within_half_a_step() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.png");
        sample().write(&Picture::destination(&path).expect("a destination")).expect("written");
        let back = Picture::read(&path).expect("read");
        assert_eq!(back.to_srgb8(), sample().to_srgb8());
        assert!(back.pixels().iter().all(|p| p.coverage == 1.0));
    }

    #[test]
    fn colours_of_a_png_file_are_premultiplied_by_its_alpha() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.png");
        image::save_buffer(&path, &[255, 255, 255, 51, 9, 9, 9, 0], 2, 1, image::ColorType::Rgba8).expect("written");
        let read = Picture::read_finite(&path).expect("read");
        assert_eq!(read.get(0, 0), Some(Pixel { radiance: [0.2; 3], coverage: 0.2 }));
        assert!(read.get(1, 0) == Some(Pixel::default()) && read.is_matte() && !sample().is_matte());
    }

    #[test]
    fn a_number_that_is_not_finite_is_found() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        let mut picture = sample();
        picture.pixels_mut()[7].radiance[1] = f32::NAN;
        picture.write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert!(matches!(Picture::read_finite(&path), Err(PictureError::Number { x: 2, y: 1, .. })));
    }

    #[test]
    fn other_names_and_broken_files_are_errors() {
        let folder = tempfile::tempdir().expect("folder");
        assert!(matches!(Picture::destination(&folder.path().join("a.gif")), Err(PictureError::Format { .. })));
        assert!(matches!(Picture::destination(&folder.path().join("none/a.png")), Err(PictureError::Write(_))));
        let path = folder.path().join("broken.png");
        std::fs::write(&path, b"no picture").expect("written");
        assert!(matches!(Picture::read(&path), Err(PictureError::Broken { .. })));
        assert!(matches!(Picture::read(&folder.path().join("none.png")), Err(PictureError::Open { .. })));
        assert!(matches!(Picture::new(0, 5), Err(PictureError::Size { .. })));
        assert!(matches!(Picture::new(u32::MAX, u32::MAX), Err(PictureError::Size { .. })));
    }
}
