//! Pictures with a depth for each pixel, as EXR files with a layer Z.

use super::file::pixel_of;
use super::source::{PictureReader, Texel};
use super::{Picture, PictureError, Pixel, Provenance, encoder};
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, WritableImage};
use files::Destination;
use std::path::Path;

/// A picture with the depth of what its pixels show.
#[derive(Clone, Debug, PartialEq)]
pub struct Deep {
    pub(super) picture: Picture,
    pub(super) depth: Vec<f32>,
}

impl Deep {
    /// A picture with its depth; none unless there is one depth for each pixel, and none is NaN.
    pub fn new(picture: Picture, depth: Vec<f32>) -> Option<Deep> {
        let fits = depth.len() == picture.pixels.len() && !depth.iter().any(|z| z.is_nan());
        fits.then_some(Deep { picture, depth })
    }

    /// The picture.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Distance to what is seen first, scene units, for each pixel, row by row from the top; infinite where nothing is.
    pub fn depth(&self) -> &[f32] {
        &self.depth
    }

    /// Reads an EXR file with layers R, G, B and Z, and A if it is there, in which every number but Z must be finite.
    ///
    /// # Errors
    /// [`PictureError::Broken`] for a file that is broken or without these layers, [`PictureError::Number`] for one with
    /// other numbers, those of [`Picture::read`] for others.
    pub fn read(path: &Path) -> Result<Deep, PictureError> {
        let broken = |problem: String| PictureError::Broken { path: path.into(), problem };
        let source = PictureReader::open(path)?;
        if !source.has_depth() {
            return Err(broken("has no layer Z, as the files that peris render --layers writes".into()));
        }
        let mut picture = Picture::for_source(&source, path, size_of::<Pixel>() + size_of::<f32>())?;
        let mut depth = vec![f32::INFINITY; picture.pixels.len()];
        let width = picture.width as usize;
        source.each(|x, y, texel| {
            let at = y as usize * width + x as usize;
            picture.pixels[at] = pixel_of(texel);
            if let Texel::Float([.., z]) = texel {
                depth[at] = z;
            }
        })?;
        picture.check_finite(path)?;
        if let Some(at) = depth.iter().position(|z| z.is_nan()) {
            return Err(broken(format!("Z of pixel {},{} is no number", at % width, at / width)));
        }
        Ok(Deep { picture, depth })
    }

    /// Writes an EXR file with layers R, G, B, A and Z.
    ///
    /// # Errors
    /// [`PictureError::Write`]; the file may be kept elsewhere then.
    pub fn write(&self, destination: &Destination) -> Result<(), PictureError> {
        let Picture { width, height, pixels } = &self.picture;
        let layer = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
        let band = |name: &str, band: usize| layer(name, pixels.iter().map(|p| p.radiance[band]).collect());
        let coverage = layer("A", pixels.iter().map(|p| p.coverage).collect());
        let layers = [band("R", 0), band("G", 1), band("B", 2), coverage, layer("Z", self.depth.clone())];
        let channels = AnyChannels::sort(layers.into_iter().collect());
        let image = encoder::exr([*width, *height], channels, &Provenance::default());
        Ok(destination.write_or_save_elsewhere(|file| image.write().to_buffered(file).map_err(encoder::exr_error))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Deep {
        let mut picture = Picture::new(3, 2).expect("small");
        for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
            let x = i as f32 / 6.0;
            *pixel = Pixel { radiance: [x, 2.0 * x, 3.0 * x], coverage: x };
        }
        Deep::new(picture, vec![f32::INFINITY, 1.0, 2.5, 3.0, 4.0, 1e9]).expect("six pixels")
    }

    #[test]
    fn a_file_with_depth_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        sample().write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert_eq!(Deep::read(&path).expect("read"), sample());
        assert_eq!(Picture::read(&path).expect("also a picture"), sample().picture);
    }

    #[test]
    fn files_without_depth_or_with_wrong_numbers_are_errors() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        sample().picture.write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert!(Deep::read(&path).is_err_and(|error| error.to_string().contains("no layer Z")));
        let mut wrong = sample();
        wrong.depth[4] = f32::NAN;
        wrong.write(&Picture::destination(&path).expect("a destination")).expect("written");
        assert!(Deep::read(&path).is_err_and(|error| error.to_string().contains("pixel 1,1")));
        std::fs::write(&path, b"no picture").expect("written");
        assert!(Deep::read(&path).is_err() && Deep::read(&folder.path().join("none.exr")).is_err());
        assert!(Deep::new(sample().picture, vec![1.0]).is_none());
    }
}
