//! Films as EXR files with layers: what is known of each pixel beside its radiance.

use super::features::PixelFeatures;
use super::film::Film;
use super::tally::{PathClass, Tally};
use crate::picture::{Picture, PictureError, Pixel, Provenance, encoder};
use crate::scene::Prepared;
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, WritableImage};
use files::Destination;

/// A layer: its name, and its value of a pixel.
struct Layer {
    name: &'static str,
    value: fn(&Pixel, &Tally) -> f64,
}

/// Layers of numbers. What no sample saw is at infinite depth, and has no normal.
const LAYERS: &[Layer] = &[
    Layer { name: "R", value: |pixel, _| pixel.radiance[0].into() },
    Layer { name: "G", value: |pixel, _| pixel.radiance[1].into() },
    Layer { name: "B", value: |pixel, _| pixel.radiance[2].into() },
    Layer { name: "A", value: |pixel, _| pixel.coverage.into() },
    Layer { name: "Z", value: |_, tally| seen(tally, tally.distances).unwrap_or(f64::INFINITY) },
    Layer { name: "N.X", value: |_, tally| seen(tally, tally.normals.x).unwrap_or(0.0) },
    Layer { name: "N.Y", value: |_, tally| seen(tally, tally.normals.y).unwrap_or(0.0) },
    Layer { name: "N.Z", value: |_, tally| seen(tally, tally.normals.z).unwrap_or(0.0) },
    Layer { name: "variance.Y", value: |_, tally| tally.variance() },
];

/// The mean over the samples that saw an element.
fn seen(tally: &Tally, sum: f64) -> Option<f64> {
    (tally.elements > 0).then(|| sum / f64::from(tally.elements))
}

impl Film {
    /// Writes an EXR file with layers: R, G, B and A; the distance Z of what is seen first, its normal, its object and
    /// material, counted from 1; the number of samples, and the variance of the mean luminance; and the radiance of
    /// each [`PathClass`] of light, if these were kept apart: together they are R, G and B, as long as these are not
    /// denoised; and the albedo, if the film holds features.
    ///
    /// - `picture`: that of the film, denoised or not, for R, G, B and A.
    ///
    /// # Errors
    /// [`PictureError::Write`]; the file may be kept elsewhere then.
    pub fn write_layers(
        &self,
        picture: &Picture,
        destination: &Destination,
        prepared: &Prepared,
        provenance: &Provenance,
    ) -> Result<(), PictureError> {
        let tallies = self.tallies();
        let floats = LAYERS.iter().map(|layer| {
            let values = picture.pixels().iter().zip(tallies).map(|(pixel, tally)| (layer.value)(pixel, tally) as f32);
            AnyChannel::new(layer.name, FlatSamples::F32(values.collect()))
        });
        let of_albedo = |(name, band): (&'static str, usize)| {
            let value = |(features, tally): (&PixelFeatures, &Tally)| features.albedo[band] / tally.count.max(1) as f32;
            AnyChannel::new(name, FlatSamples::F32(self.features().iter().zip(tallies).map(value).collect()))
        };
        let albedo = [("albedo.R", 0), ("albedo.G", 1), ("albedo.B", 2)].into_iter();
        let albedo = albedo.filter(|_| !self.features().is_empty()).map(of_albedo);
        let of_class = |class: PathClass| {
            let value = move |axis: usize| {
                let pixels = self.classes().iter().zip(tallies);
                pixels
                    .map(|(sums, tally)| (sums[class as usize][axis] / f64::from(tally.count.max(1))) as f32)
                    .collect()
            };
            let name = move |band: &str| format!("{}.{band}", class.word());
            ["R", "G", "B"].into_iter().zip(0..).map(move |(band, axis)| {
                AnyChannel::new(exr::meta::attribute::Text::new_or_panic(name(band)), FlatSamples::F32(value(axis)))
            })
        };
        let classes = PathClass::ALL.into_iter().filter(|_| !self.classes().is_empty()).flat_map(of_class);
        // Materials are counted over all objects.
        let firsts: Vec<u32> = prepared
            .objects
            .iter()
            .scan(1, |next, object| {
                let first = *next;
                *next += object.materials.len() as u32;
                Some(first)
            })
            .collect();
        let of_seen = |number: &dyn Fn([u32; 2]) -> u32| {
            let of = |tally: &Tally| if tally.elements > 0 { number(tally.first_ids) } else { 0 };
            FlatSamples::U32(tallies.iter().map(of).collect())
        };
        let numbers = [
            AnyChannel::new("object.id", of_seen(&|[object, _]| object + 1)),
            AnyChannel::new(
                "material.id",
                of_seen(&|[object, material]| firsts.get(object as usize).map_or(0, |first| first + material)),
            ),
            AnyChannel::new("samples.count", FlatSamples::U32(tallies.iter().map(|tally| tally.count).collect())),
        ];
        let channels = AnyChannels::sort(floats.chain(classes).chain(albedo).chain(numbers).collect());
        let size = [self.width(), self.height()];
        let image = encoder::exr(size, channels, provenance);
        Ok(destination.write_or_save_elsewhere(|file| image.write().to_buffered(file).map_err(encoder::exr_error))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::PixelSample;
    use crate::scene::Scene;
    use exr::prelude::read_first_flat_layer_from_file;
    use glam::DVec3;

    #[test]
    fn layers_hold_what_the_film_knows() {
        let mut film = Film::new(2, 1).expect("small");
        let first = Some((4.0, DVec3::Y, [0, 0]));
        film.tallies_mut()[1].add(&PixelSample {
            radiance: DVec3::new(1.0, 2.0, 3.0),
            covered: true,
            first,
            ..PixelSample::default()
        });
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.exr");
        let prepared = Prepared::new(&Scene::default()).expect("nothing");
        film.write_layers(
            &film.picture().expect("small"),
            &Destination::of(&path).expect("a destination"),
            &prepared,
            &Provenance::default(),
        )
        .expect("written");
        let read = read_first_flat_layer_from_file(&path).expect("layers");
        let value = |name: &str, pixel: usize| {
            let channel = read.layer_data.channel_data.list.iter().find(|c| c.name.to_string() == name).expect("there");
            channel.sample_data.values_as_f32().nth(pixel).expect("two pixels")
        };
        assert_eq!([value("R", 1), value("B", 1), value("A", 1), value("Z", 1)], [1.0, 3.0, 1.0, 4.0]);
        assert_eq!([value("N.Y", 1), value("object.id", 1), value("samples.count", 1)], [1.0, 1.0, 1.0]);
        assert_eq!([value("Z", 0), value("object.id", 0)], [f32::INFINITY, 0.0]);
    }
}
