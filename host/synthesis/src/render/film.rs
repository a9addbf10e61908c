//! Films: the sums of the samples of all pixels.

use super::features::PixelFeatures;
use super::tally::{PixelSample, RadianceByClass, Tally};
use crate::memory::prefer_large_pages;
use crate::numeric::hilbert::hilbert_place;
use crate::picture::{Picture, PictureError};
use rayon::prelude::*;

/// Pixels along each side of a block.
const BLOCK: u32 = 16;

/// Samples of a picture, added up pixel by pixel. More can be added at any time.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    tallies: Vec<Tally>,
    /// Sums of each class of light; none unless they are asked for.
    classes: Vec<RadianceByClass>,
    /// Features for a denoiser; none unless they are asked for.
    features: Vec<PixelFeatures>,
    /// Whether the samples of a pixel come one by one, so that halves of them tell the error of all.
    in_turn: bool,
    /// How far pixels have come that get as many samples as their errors ask for.
    adaptive: Option<AdaptiveSampling>,
}

/// Adaptive sampling: how far it has come. Each pass decides by the errors before it which pixels get more samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AdaptiveSampling {
    /// The relative error at which a pixel has samples enough.
    pub(super) target: f64,
    /// Samples at the end of the last pass that was finished.
    pub(super) finished: u32,
    /// How many samples each pixel is to have after the pass that has begun; none between passes.
    pub(super) goals: Vec<u32>,
}

impl AdaptiveSampling {
    /// Begins a pass, unless one has begun already: pixels that are uncertain get more samples.
    ///
    /// - `samples`: of a pixel after the pass. `most`: of them in this pass.
    pub(super) fn begin_pass(&mut self, film: &Film, samples: u32, most: u32) {
        if self.goals.is_empty() {
            let goal = |(tally, is_uncertain): (&Tally, bool)| match is_uncertain {
                true => tally.count.max(samples.min(tally.count.saturating_add(most))),
                false => tally.count,
            };
            self.goals = film.tallies.iter().zip(film.uncertain(self.target)).map(goal).collect();
        }
    }

    /// Ends a pass.
    pub(super) fn end_pass(&mut self, samples: u32) {
        self.finished = samples;
        self.goals.clear();
    }
}

/// A block of a film: a square of pixels, which is cut off at the borders.
pub(super) struct FilmBlock<'a> {
    /// Column and row of its first pixel.
    pub(super) first: [u32; 2],
    /// Its part of each row.
    pub(super) rows: Vec<FilmRow<'a>>,
}

/// A row of a film, or a part of it.
pub(super) struct FilmRow<'a> {
    /// The pixels of the row.
    pub(super) tallies: &'a mut [Tally],
    /// The sums of each class of light, if they are kept.
    classes: Option<&'a mut [RadianceByClass]>,
    /// Features for a denoiser, if they are kept.
    features: Option<&'a mut [PixelFeatures]>,
}

impl<'a> FilmRow<'a> {
    /// This row in parts, each but the last as long as a block.
    fn parts(self) -> impl Iterator<Item = FilmRow<'a>> {
        let mut classes = self.classes.map(|all| all.chunks_mut(BLOCK as usize));
        let mut features = self.features.map(|all| all.chunks_mut(BLOCK as usize));
        self.tallies.chunks_mut(BLOCK as usize).map(move |tallies| FilmRow {
            tallies,
            classes: classes.as_mut().and_then(Iterator::next),
            features: features.as_mut().and_then(Iterator::next),
        })
    }

    /// Adds a sample to the pixel in a column.
    ///
    /// - `classes`: its radiance by class.
    pub(super) fn add(&mut self, x: usize, sample: &PixelSample, classes: &RadianceByClass) {
        if let Some(features) = &mut self.features {
            features[x].add(sample, &self.tallies[x]);
        }
        self.tallies[x].add(sample);
        if let Some(sums) = &mut self.classes {
            let finite = sums[x].iter_mut().zip(classes).filter(|(_, light)| light.is_finite());
            finite.for_each(|(sum, light)| *sum += *light);
        }
    }
}

impl Film {
    /// A film without samples, to which they are added one by one.
    ///
    /// # Errors
    /// [`PictureError::Size`].
    pub fn new(width: u32, height: u32) -> Result<Film, PictureError> {
        let mut film = Film::untouched(width, height)?;
        film.tallies.par_chunks_mut(1 << 14).for_each(|tallies| tallies.fill(Tally::default()));
        film.in_turn = true;
        Ok(film)
    }

    /// A film without samples whose memory is not got yet, for one who writes all of it before reading any: to read
    /// first makes the system give each page twice. Samples may be added in any order.
    pub(super) fn untouched(width: u32, height: u32) -> Result<Film, PictureError> {
        let mut tallies = bytemuck::zeroed_vec(Picture::pixels_of(width, height)?);
        prefer_large_pages(&mut tallies);
        Ok(Film { width, height, tallies, classes: Vec::new(), features: Vec::new(), in_turn: false, adaptive: None })
    }

    /// This film, which keeps the classes of light apart from now on.
    pub fn with_classes(mut self) -> Film {
        self.classes = vec![RadianceByClass::default(); self.tallies.len()];
        self
    }

    /// This film, which keeps what a denoiser needs from now on; it has to be asked for before the first sample.
    pub fn with_features(mut self) -> Film {
        self.features = bytemuck::zeroed_vec(self.tallies.len());
        prefer_large_pages(&mut self.features);
        // See [`Film::untouched`] for why they are written.
        self.features.par_chunks_mut(1 << 14).for_each(|features| features.fill(PixelFeatures::default()));
        self
    }

    /// A film of pixels that are known; none if there are not as many as that.
    ///
    /// - `features`: for a denoiser, of each of them; none if they are not kept.
    pub(super) fn of_tallies(
        width: u32,
        height: u32,
        tallies: Vec<Tally>,
        features: Vec<PixelFeatures>,
    ) -> Option<Film> {
        let possible = Picture::pixels_of(width, height).is_ok_and(|count| count == tallies.len());
        possible.then_some(Film {
            width,
            height,
            tallies,
            classes: Vec::new(),
            features,
            in_turn: true,
            adaptive: None,
        })
    }

    /// How far adaptive sampling has come that continues towards a target: where it stopped, if that was the target
    /// before.
    pub(super) fn adaptive(&self, target: Option<f64>) -> Option<AdaptiveSampling> {
        let target = target?;
        let before = self.adaptive.clone().filter(|before| before.target == target);
        Some(before.unwrap_or(AdaptiveSampling { target, finished: 0, goals: Vec::new() }))
    }

    /// How far adaptive sampling has come; none if all pixels get as many samples.
    pub(super) fn progress(&self) -> Option<&AdaptiveSampling> {
        self.adaptive.as_ref()
    }

    /// Takes up how far adaptive sampling has come.
    pub(super) fn set_adaptive(&mut self, adaptive: Option<AdaptiveSampling>) {
        self.adaptive = adaptive;
    }

    /// The part of the pixels that have a greater relative error than a target, 0..=1.
    pub fn missing(&self, target: f64) -> f64 {
        let missing = self.tallies.iter().filter(|tally| tally.relative_error() > target).count();
        missing as f64 / self.tallies.len() as f64
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
    pub fn tallies(&self) -> &[Tally] {
        &self.tallies
    }

    /// All pixels, row by row from the top.
    pub fn tallies_mut(&mut self) -> &mut [Tally] {
        &mut self.tallies
    }

    /// Sums of the radiance of each class over all samples, pixel by pixel; none unless they are kept.
    pub fn classes(&self) -> &[RadianceByClass] {
        &self.classes
    }

    /// Features for a denoiser, pixel by pixel; none unless they are kept.
    pub fn features(&self) -> &[PixelFeatures] {
        &self.features
    }

    /// Features for a denoiser, pixel by pixel; none unless they are kept.
    #[cfg(test)]
    pub(super) fn features_mut(&mut self) -> &mut [PixelFeatures] {
        &mut self.features
    }

    /// All rows.
    pub(super) fn rows_mut(&mut self) -> Vec<FilmRow<'_>> {
        let width = self.width as usize;
        let mut classes = self.classes.chunks_exact_mut(width);
        let mut features = self.features.chunks_exact_mut(width);
        let row = |tallies| FilmRow { tallies, classes: classes.next(), features: features.next() };
        self.tallies.chunks_exact_mut(width).map(row).collect()
    }

    /// All blocks, along a Hilbert curve: what is seen in one is for the most part near what was seen in the one before.
    pub(super) fn blocks_mut(&mut self) -> Vec<FilmBlock<'_>> {
        let [columns, rows] = [self.width, self.height].map(|side| side.div_ceil(BLOCK));
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let mut blocks: Vec<FilmBlock<'_>> =
            cells.map(|cell| FilmBlock { first: cell.map(|at| at * BLOCK), rows: Vec::new() }).collect();
        for (y, row) in self.rows_mut().into_iter().enumerate() {
            let of_row = &mut blocks[y / BLOCK as usize * columns as usize..][..columns as usize];
            row.parts().zip(of_row).for_each(|(part, block)| block.rows.push(part));
        }
        let bits = columns.max(rows).next_power_of_two().trailing_zeros();
        blocks.sort_by_cached_key(|block| hilbert_place(bits, block.first.map(|at| at / BLOCK)));
        blocks
    }

    /// The picture so far; pixels without samples are black and uncovered.
    pub fn picture(&self) -> Result<Picture, PictureError> {
        let mut picture = Picture::new(self.width, self.height)?;
        let pixels = picture.pixels_mut().par_iter_mut().with_min_len(1 << 14).zip(&self.tallies);
        pixels.for_each(|(pixel, tally)| *pixel = tally.pixel());
        Ok(picture)
    }

    /// Whether each pixel, or one beside it, has a greater relative error than asked for.
    pub fn uncertain(&self, target: f64) -> Vec<bool> {
        let (width, height) = (self.width as usize, self.height as usize);
        let errors: Vec<f64> = self.tallies.iter().map(Tally::relative_error).collect();
        let is_uncertain = |index: usize| {
            let (x, y) = (index % width, index / width);
            let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
            let mut rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
            rows.any(|row| columns.clone().any(|column| errors[row * width + column] > target))
        };
        (0..errors.len()).map(is_uncertain).collect()
    }

    /// Root of the mean variance of all pixels: about the RMSE of the luminance, as far as chance goes.
    ///
    /// Of pixels that saw photons of one pass only, their chance counts as if photon paths were independent; they are
    /// evenly spread, so that it is less by a factor of up to 3. Light that no sample found is in no error.
    pub fn standard_error(&self) -> f64 {
        let variance = |tally: &Tally| {
            let halves = if self.in_turn { tally.variance_of_halves() } else { None };
            halves.unwrap_or_else(|| tally.variance())
        };
        let finite = self.tallies.iter().map(variance).filter(|variance| variance.is_finite());
        let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), variance| (sum + variance, count + 1.0));
        if count > 0.0 { f64::sqrt(sum / count) } else { f64::INFINITY }
    }

    /// Fewest and most samples of a pixel.
    pub fn samples(&self) -> [u32; 2] {
        self.tallies.iter().fold([u32::MAX, 0], |[least, most], t| [least.min(t.count), most.max(t.count)])
    }
}

#[cfg(test)]
mod tests {
    use super::super::tally::SHARING;
    use super::*;
    use glam::DVec3;

    fn sample(value: f64) -> PixelSample {
        PixelSample { radiance: DVec3::splat(value), covered: true, ..PixelSample::default() }
    }

    #[test]
    fn what_samples_share_is_in_the_error_of_their_mean() {
        // Each group is wrong by 1: its samples agree, and only what they say of themselves, or another group, tells.
        let (mut film, one) = (Film::new(1, 1).expect("small"), PixelSample { shared: 1.0, ..sample(1.0) });
        (0..SHARING).for_each(|_| film.tallies_mut()[0].add(&one));
        assert!((film.standard_error() - 1.0).abs() < 1e-12 && (film.tallies()[0].variance() - 1.0).abs() < 1e-12);
        (0..SHARING).for_each(|_| film.tallies_mut()[0].add(&PixelSample { radiance: DVec3::splat(3.0), ..one }));
        assert!((film.standard_error() - 1.0).abs() < 1e-12, "{}", film.standard_error());
        let apart = 1.0 / f64::from(2 * SHARING - 1);
        assert!((film.tallies()[0].variance() - apart - 0.5).abs() < 1e-12);
    }

    #[test]
    fn halves_tell_the_error_of_independent_samples_in_the_mean() {
        // -1 or 1, in all orders: the variance of the mean of n is 1 / n.
        for count in 2..12u32 {
            let mut film = Film::new(1 << count, 1).expect("small");
            for (order, tally) in film.tallies_mut().iter_mut().enumerate() {
                (0..count).for_each(|bit| tally.add(&sample(2.0 * f64::from(order as u32 >> bit & 1) - 1.0)));
            }
            assert!((film.standard_error().powi(2) * f64::from(count) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn blocks_hold_each_pixel_once_and_follow_each_other() {
        for [width, height] in [[1, 1], [16, 16], [17, 40], [200, 100]] {
            let mut film = Film::new(width, height).expect("small").with_classes().with_features();
            let blocks = film.blocks_mut();
            assert_eq!(blocks.len() as u32, width.div_ceil(BLOCK) * height.div_ceil(BLOCK));
            for FilmBlock { first: [x, y], mut rows } in blocks {
                for (dy, row) in rows.iter_mut().enumerate() {
                    for dx in 0..row.tallies.len() {
                        let value = f64::from(x) + dx as f64 + 1000.0 * (f64::from(y) + dy as f64);
                        let classes = RadianceByClass::default().map(|_| DVec3::splat(value));
                        row.add(dx, &sample(value), &classes);
                    }
                }
            }
            let of = |pixel: usize| (pixel % width as usize + 1000 * (pixel / width as usize)) as f64;
            assert!(film.tallies.iter().enumerate().all(|(n, tally)| tally.count == 1 && tally.sum.x == of(n)));
            assert!(film.classes.iter().enumerate().all(|(n, classes)| classes[0].x == of(n)));
        }
    }

    #[test]
    fn pixels_beside_uncertain_ones_are_uncertain() {
        let mut film = Film::new(5, 5).expect("small");
        film.tallies_mut().iter_mut().for_each(|tally| [1.0, 1.0].iter().for_each(|v| tally.add(&sample(*v))));
        film.tallies_mut()[12].add(&sample(9.0));
        let uncertain = film.uncertain(0.1);
        assert_eq!(uncertain.iter().filter(|u| **u).count(), 9);
        assert_eq!((film.samples(), film.picture().expect("small").get(0, 0).expect("inside").coverage), ([2, 3], 1.0));
    }
}
