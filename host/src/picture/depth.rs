//! Pictures with a depth for each pixel, as EXR files with a layer Z.

use super::{Picture, PictureError, Pixel, encoder};
use exr::meta::MetaData;
use exr::prelude::{
    AnyChannel, AnyChannels, FlatSamples, Image, ReadChannels, ReadLayers, ReadSpecificChannel, WritableImage, read,
};
use files::Destination;
use std::io::BufReader;
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
    /// [`PictureError::Layers`] for a file that is missing, broken or without these layers, [`PictureError::Size`] for
    /// one that is too large, [`PictureError::Number`] for one with other numbers.
    pub fn read(path: &Path) -> Result<Deep, PictureError> {
        let failed = |problem: String| PictureError::Layers { path: path.into(), problem };
        // Sizes are looked at before there is memory for them.
        let open = || files::open(path).map(BufReader::new).map_err(|error| failed(error.to_string()));
        let known = MetaData::read_from_buffered(open()?, false).map_err(|error| failed(error.to_string()))?;
        for header in &known.headers {
            let [width, height] =
                [header.layer_size.0, header.layer_size.1].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
            Picture::pixels_of(width, height)?;
        }
        let has = |name: &str| {
            known.headers.iter().any(|header| header.channels.list.iter().any(|channel| channel.name.eq(name)))
        };
        if let Some(name) = ["R", "G", "B", "Z"].into_iter().find(|name| !has(name)) {
            return Err(failed(format!("has no layer {name}, as those that peris render --layers writes")));
        }
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required("R")
            .required("G")
            .required("B")
            .required("Z")
            .optional("A", 1.0f32)
            .collect_pixels(
                |size, _| (size.0, vec![(Pixel::default(), f32::INFINITY); size.0 * size.1]),
                |(width, pixels), at, (r, g, b, z, a): (f32, f32, f32, f32, f32)| {
                    pixels[at.1 * *width + at.0] = (Pixel { radiance: [r, g, b], coverage: a }, z);
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(open()?)
            .map_err(|error| failed(error.to_string()))?;
        let size = image.layer_data.size;
        let (pixels, depth): (Vec<Pixel>, Vec<f32>) = image.layer_data.channel_data.pixels.1.into_iter().unzip();
        let picture = Picture { width: size.0 as u32, height: size.1 as u32, pixels };
        picture.check_finite(path)?;
        if let Some(at) = depth.iter().position(|z| z.is_nan()) {
            return Err(failed(format!("Z of pixel {},{} is no number", at % size.0, at / size.0)));
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
        let image = Image::from_channels((*width as usize, *height as usize), channels);
        Ok(destination.write_or_keep(|file| image.write().to_buffered(file).map_err(encoder::exr_error))?)
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
