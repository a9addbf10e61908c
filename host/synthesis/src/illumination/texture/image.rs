//! Images as textures: smaller and smaller copies of them, from which the mean over a part is had quickly.

use super::TextureFootprint;
use super::texels::{TexelStorage, Texels};
use crate::memory;
use crate::picture::source::{PictureReader, Texel, TexelFormat};
use crate::picture::{Picture, PictureError};
use glam::{DVec2, DVec3};
use protocol::raster::light_of_srgb;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Most lookups in an image for one mean, side by side along the longer side of the part.
const MOST_PROBES: f64 = 16.0;

/// An image of fractions, 0..=1 in three bands, row 0 at the top (v = 1).
///
/// Bytes of a file are held as they are; other fractions are rounded to 1/65535, those of images with three bands of
/// more than eight bits and more than 1024 x 1024 pixels to a thousandth of what they are. There are copies of half the
/// size, of a quarter, and so on to one pixel, all with the same mean. With them a pixel takes 5 bytes, 2.7 where it is
/// grey, 8 where three bands have sixteen bits, and 5.3 in the large ones.
#[derive(Clone)]
pub struct Image {
    name: String,
    levels: Arc<Vec<Level>>,
    /// The least and the greatest of each band, found when they are first asked for.
    range: Arc<OnceLock<[DVec3; 2]>>,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Texels,
}

/// The meaning of the numbers of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageContent {
    /// Fractions of light.
    Color,
    /// Numbers, that were taken for light of sRGB when they were read: they are encoded again.
    Numbers,
}

impl fmt::Debug for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (size, mean) = (self.size(), self.mean());
        f.debug_struct("Image")
            .field("name", &self.name)
            .field("size", &size)
            .field("mean", &mean)
            .finish_non_exhaustive()
    }
}

impl PartialEq for Image {
    fn eq(&self, other: &Image) -> bool {
        self.name == other.name && (Arc::ptr_eq(&self.levels, &other.levels) || self.is_like(other))
    }
}

impl Image {
    /// Reads a PNG or EXR file. What is below 0 or above 1 is cut off; coverage is not heeded.
    ///
    /// # Errors
    /// [`PictureError`], also for a file with a number that is not finite, and where the image would take more memory
    /// than there is.
    pub fn read(path: &Path, content: ImageContent) -> Result<Image, PictureError> {
        let source = PictureReader::open(path)?;
        let [width, height] = source.size();
        let kind = match (source.precision(), content) {
            (TexelFormat::Eight, ImageContent::Color) => TexelStorage::Light,
            (TexelFormat::Eight, ImageContent::Numbers) => TexelStorage::Numbers,
            (TexelFormat::Sixteen { grey: true } | TexelFormat::Float { grey: true }, _) => TexelStorage::Grey,
            (TexelFormat::Sixteen { .. } | TexelFormat::Float { .. }, _) => TexelStorage::Bands,
        };
        let pixels = Picture::pixels_of(width, height)?;
        memory::reserve(bytes_of(kind, pixels), || {
            format!("{}: an image of {width} x {height} pixels", path.display())
        })?;
        let mut finest = Level { width: width as usize, height: height as usize, texels: Texels::new(kind, pixels) };
        let mut wrong = None;
        source.each(|x, y, texel| {
            let at = y as usize * finest.width + x as usize;
            match texel {
                // Nothing shines where nothing covers.
                Texel::Eight([.., 0]) | Texel::Sixteen([.., 0]) => {}
                Texel::Eight([r, g, b, _]) => finest.texels.set_bytes(at, [r, g, b]),
                Texel::Sixteen([r, g, b, _]) => {
                    let numbers = DVec3::from_array([r, g, b].map(|number| f64::from(number) / f64::from(u16::MAX)));
                    let is_light = content == ImageContent::Color;
                    finest.texels.set(at, if is_light { numbers.map(light_of_srgb) } else { numbers });
                }
                Texel::Float([r, g, b, a, _]) => {
                    let light = DVec3::from_array([r, g, b].map(f64::from));
                    if !(light.is_finite() && a.is_finite()) && wrong.is_none() {
                        wrong = Some((x, y));
                    }
                    finest.texels.set(at, if a > 0.0 { light / f64::from(a) } else { light });
                }
            }
        })?;
        if let Some((x, y)) = wrong {
            return Err(PictureError::Number { path: path.into(), x, y });
        }
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        Ok(Image::of(name, finest))
    }

    /// An image of a picture. What is below 0 or above 1 is cut off; coverage is not heeded.
    pub fn of_picture(name: String, picture: &Picture, content: ImageContent) -> Image {
        let texel = |x: u32, y: u32| {
            let pixel = picture.get(x, y).unwrap_or_default();
            let cover = if pixel.coverage > 0.0 { f64::from(pixel.coverage) } else { 1.0 };
            let linear = DVec3::from_array(pixel.radiance.map(f64::from)) / cover;
            if content == ImageContent::Numbers { linear.map(encoded) } else { linear }
        };
        Image::new(name, picture.width(), picture.height(), texel)
    }

    /// An image of a function of column and row.
    ///
    /// - `width`, `height`: 1 and more.
    pub fn new(name: String, width: u32, height: u32, texel: impl Fn(u32, u32) -> DVec3) -> Image {
        let (width, height) = (width.max(1), height.max(1));
        let mut texels = Texels::new(TexelStorage::Bands, width as usize * height as usize);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        places.enumerate().for_each(|(at, (x, y))| texels.set(at, texel(x, y)));
        Image::of(name, Level { width: width as usize, height: height as usize, texels })
    }

    fn of(name: String, finest: Level) -> Image {
        let mut levels = vec![finest];
        while let Some(last) = levels.last().filter(|level| level.width > 1 || level.height > 1) {
            levels.push(last.halved());
        }
        Image { name, levels: Arc::new(levels), range: Arc::default() }
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.levels[0].width, self.levels[0].height]
    }

    /// The mean of all of it.
    pub fn mean(&self) -> DVec3 {
        self.levels.last().map_or(DVec3::ZERO, |level| level.texel(0, 0))
    }

    /// The least and the greatest of each band.
    pub fn range(&self) -> [DVec3; 2] {
        *self.range.get_or_init(|| {
            let finest = &self.levels[0];
            let texels = (0..finest.width * finest.height).map(|at| finest.texels.at(at));
            texels.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[least, most], texel| {
                [least.min(texel), most.max(texel)]
            })
        })
    }

    /// Whether every pixel is the same in sixteen bits.
    fn is_like(&self, other: &Image) -> bool {
        self.size() == other.size() && self.levels[0].texels.words().eq(other.levels[0].texels.words())
    }

    /// The mean over a part; the image repeats in both directions.
    ///
    /// Along the longer side of the part several lookups are taken, each of which is about as wide as the shorter side
    /// and goes between two of the copies.
    ///
    /// # Source
    /// Williams 1983, pyramidal parametrics; McCormack and others 1999, Feline: several lookups along the longer axis.
    pub fn at(&self, footprint: &TextureFootprint) -> DVec3 {
        let [width, height] = self.size().map(|n| n as f64);
        let texels = DVec2::new(width, height);
        let sides = footprint.sides.map(|side| side.uv * texels);
        let (long, short) = match sides.map(DVec2::length) {
            [a, b] if a >= b => ((a, footprint.sides[0].uv), b),
            [a, b] => ((b, footprint.sides[1].uv), a),
        };
        if !footprint.uv.is_finite() || !long.0.is_finite() {
            return self.mean();
        }
        let looks = if long.0 <= 1.0 { 1.0 } else { (long.0 / short.max(1.0)).ceil().clamp(1.0, MOST_PROBES) };
        let level = short.max(long.0 / looks).max(1.0).log2().min((self.levels.len() - 1) as f64);
        let mut sum = DVec3::ZERO;
        for look in 0..looks as u32 {
            sum += self.between(footprint.uv + long.1 * ((f64::from(look) + 0.5) / looks - 0.5), level);
        }
        sum / looks
    }

    /// Between two copies.
    fn between(&self, uv: DVec2, level: f64) -> DVec3 {
        let (finer, part) = (level as usize, level.fract());
        let value = self.levels[finer].at(uv);
        if part == 0.0 { value } else { value.lerp(self.levels[finer + 1].at(uv), part) }
    }
}

impl Level {
    fn texel(&self, x: usize, y: usize) -> DVec3 {
        self.texels.at(y * self.width + x)
    }

    /// Between four pixels.
    fn at(&self, uv: DVec2) -> DVec3 {
        let place = |t: f64, count: usize| {
            let at = (t - t.floor()) * count as f64 - 0.5;
            let low = at.floor();
            // The remainder can only be one below 0 or at the end.
            let low_index = (low as i64).rem_euclid(count as i64) as usize;
            (low_index, if low_index + 1 == count { 0 } else { low_index + 1 }, at - low)
        };
        let (x0, x1, s) = place(uv.x, self.width);
        let (y0, y1, t) = place(1.0 - uv.y, self.height);
        let row = |y: usize| self.texel(x0, y).lerp(self.texel(x1, y), s);
        row(y0).lerp(row(y1), t)
    }

    /// A copy of half the size, rounded down, whose pixels are means over what they cover.
    fn halved(&self) -> Level {
        let [width, height] = [self.width, self.height].map(|n| (n / 2).max(1));
        let (columns, rows) = (shares(self.width, width), shares(self.height, height));
        let mut texels = self.texels.for_means(width * height);
        for (row, parts) in rows.iter().enumerate() {
            for (column, across) in columns.iter().enumerate() {
                let mut sum = DVec3::ZERO;
                for (y, b) in parts.clone() {
                    for (x, a) in across.clone() {
                        sum += self.texel(x, y) * (a * b);
                    }
                }
                texels.set(row * width + column, sum);
            }
        }
        Level { width, height, texels }
    }
}

/// For each of `to` pixels, those of `from` pixels that it covers, and how much of its mean they are.
fn shares(from: usize, to: usize) -> Vec<impl Iterator<Item = (usize, f64)> + Clone> {
    let span = from as f64 / to as f64;
    let covered = move |index: usize| {
        let (low, high) = (index as f64 * span, (index + 1) as f64 * span);
        let last = (high.ceil() as usize).min(from);
        (low as usize..last).map(move |pixel| {
            let part = (high.min((pixel + 1) as f64) - low.max(pixel as f64)).max(0.0);
            (pixel, part / span)
        })
    };
    (0..to).map(covered).collect()
}

/// Bytes of an image and its smaller copies, a little more than it takes.
fn bytes_of(kind: TexelStorage, pixels: usize) -> u64 {
    let copies = if kind == TexelStorage::Grey { TexelStorage::Grey } else { TexelStorage::Bands };
    // A copy has a quarter of the pixels; in sixteen bits there are fewer of them.
    (Texels::bytes_of(kind, pixels) + Texels::bytes_of(copies, pixels / 3)) as u64
}

/// The number of an eight-bit file, 0..=1, whose decoded light is known.
///
/// # Source
/// IEC 61966-2-1.
fn encoded(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// An image in a record: its name and its finest copy.
#[derive(Serialize, Deserialize)]
struct Stored {
    name: String,
    width: u32,
    height: u32,
    texels: Vec<[u16; 3]>,
}

impl Serialize for Image {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [width, height] = self.size().map(|n| n as u32);
        Stored { name: self.name.clone(), width, height, texels: self.levels[0].texels.words().collect() }
            .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Image {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Image, D::Error> {
        let Stored { name, width, height, texels } = Stored::deserialize(deserializer)?;
        let (width, height) = (width as usize, height as usize);
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            let problem = format!("an image of {width} x {height} has {} pixels", texels.len());
            return Err(serde::de::Error::custom(problem));
        }
        Ok(Image::of(name, Level { width, height, texels: Texels::of_words(texels) }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::FootprintSide;
    use super::*;

    fn part(uv: DVec2, across: DVec2, up: DVec2) -> TextureFootprint {
        let side = |uv| FootprintSide { uv, ..FootprintSide::default() };
        TextureFootprint { uv, sides: [side(across), side(up)], ..TextureFootprint::default() }
    }

    fn ramp(width: u32, height: u32) -> Image {
        let texel = |x: u32, y: u32| {
            DVec3::new((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height), 0.25)
        };
        Image::new("ramp".into(), width, height, texel)
    }

    #[test]
    fn all_copies_have_the_same_mean_whatever_the_size() {
        for (width, height) in [(1, 1), (1, 7), (5, 3), (64, 64), (100, 37), (16_384, 3)] {
            let image = ramp(width, height);
            assert!((image.mean() - DVec3::new(0.5, 0.5, 0.25)).abs().max_element() < 2e-4, "{width} x {height}");
            assert_eq!(image.levels.last().map(|level| level.texels.words().count()), Some(1));
        }
    }

    #[test]
    fn pixels_are_found_in_their_middles_and_the_first_row_is_on_top() {
        let image = ramp(8, 4);
        for y in 0..4 {
            for x in 0..8 {
                let uv = DVec2::new((f64::from(x) + 0.5) / 8.0, 1.0 - (f64::from(y) + 0.5) / 4.0);
                let found = image.at(&TextureFootprint::point(uv, DVec3::ZERO));
                assert!((found - DVec3::new(uv.x, 1.0 - uv.y, 0.25)).abs().max_element() < 1e-5);
                let again = image.at(&TextureFootprint::point(uv + DVec2::new(3.0, -5.0), DVec3::ZERO));
                assert!((found - again).length() < 1e-9, "it repeats");
            }
        }
    }

    #[test]
    fn the_mean_over_a_part_is_that_of_its_pixels() {
        let image = Image::new("stripes".into(), 256, 256, |x, _| DVec3::splat(f64::from(x / 64 % 2)));
        let mean = |uv: DVec2, across: f64, up: f64| image.at(&part(uv, DVec2::X * across, DVec2::Y * up)).x;
        // Whole periods of the stripes, in whichever direction they lie.
        assert!((mean(DVec2::splat(0.3), 0.5, 0.01) - 0.5).abs() < 0.01);
        assert!((mean(DVec2::splat(0.3), 1.0, 1.0) - 0.5).abs() < 1e-4);
        // Along the stripes the part may be long.
        assert!(mean(DVec2::new(0.125, 0.5), 0.01, 0.4).abs() < 1e-4);
        assert!((mean(DVec2::new(0.375, 0.5), 0.01, 0.4) - 1.0).abs() < 1e-4);
        assert!(image.at(&part(DVec2::NAN, DVec2::X, DVec2::Y)).is_finite());
        assert!(image.at(&part(DVec2::splat(1e300), DVec2::X * 1e300, DVec2::Y)).is_finite());
    }

    #[test]
    fn a_file_of_numbers_is_not_decoded() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("numbers.png");
        let bytes: Vec<u8> = (0..=255).flat_map(|i| [i, 255 - i, 128]).collect();
        image::save_buffer(&path, &bytes, 256, 1, image::ColorType::Rgb8).expect("written");
        let numbers = Image::read(&path, ImageContent::Numbers).expect("read");
        for i in 0..256usize {
            let found = numbers.levels[0].texel(i, 0) * 255.0;
            assert!((found - DVec3::new(i as f64, 255.0 - i as f64, 128.0)).abs().max_element() < 0.02, "{i} {found}");
        }
        let color = Image::read(&path, ImageContent::Color).expect("read");
        assert!((color.levels[0].texel(128, 0).x - 0.2158).abs() < 1e-3);
    }

    #[test]
    fn a_record_gives_the_image_back_and_a_damaged_one_is_refused() {
        let image = ramp(5, 3);
        let json = serde_json::to_string(&image).expect("written");
        assert_eq!(serde_json::from_str::<Image>(&json).expect("read"), image);
        assert!(serde_json::from_str::<Image>(&json.replace("\"width\":5", "\"width\":6")).is_err());
    }
}
