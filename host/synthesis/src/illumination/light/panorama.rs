//! Pictures of all directions: latitude and longitude.
//!
//! Rows and columns are those of OpenEXR's latitude-longitude maps as renderers read them: the first row is straight
//! up, the last straight down, with rows between them at even angles; columns are turns, each at the middle of its
//! part. Between pixels the radiance is bilinear.

use crate::color::{Color, Spectrum};
use crate::memory;
use crate::picture::source::PictureReader;
use crate::picture::{Picture, PictureError, Pixel, pixel_of};
use glam::{DVec2, DVec3};
use serde::Serialize;
use std::path::Path;

/// Most pixels that are held as they are; those of larger pictures are packed.
const MOST_WHOLE: usize = 1 << 20;
/// Bits of the parts of red, green and blue in a packed pixel, and where each begins; the exponent follows.
const PARTS: [(u32, u32); 3] = [(9, 0), (9, 9), (8, 18)];
/// The bit where the exponent begins, and the exponent for which 0 in it stands.
const EXPONENT: (u32, i32) = (26, -24);
/// The largest exponent.
const MOST_EXPONENT: i32 = EXPONENT.0 as i32 + 13;

/// Radiance from all directions, red, green and blue of linear sRGB, 0 and more.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Panorama {
    width: usize,
    height: usize,
    texels: Texels,
    /// Radiance over the wavelength, if it is known.
    spectra: Option<Spectra>,
}

/// Radiance over the wavelength, W/(m² sr nm): for each pixel how much there is of each part of a spectrum.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Spectra {
    parts: Vec<Spectrum>,
    values: Vec<f32>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
enum Texels {
    /// Three numbers of 32 bits: twelve bytes a pixel.
    Whole(Vec<[f32; 3]>),
    /// Four bytes a pixel: parts of the brightest band's power of two, within 1/500 of the brightest band and 1/250 in
    /// blue.
    Packed(Vec<u32>),
}

impl Panorama {
    /// Reads a picture file, pixel by pixel: a large one takes 4 bytes a pixel. What is below 0 is black.
    ///
    /// # Errors
    /// [`PictureError`], also for a number that is not finite, and where there is no memory for it.
    pub fn read(path: &Path) -> Result<Panorama, PictureError> {
        let source = PictureReader::open(path)?;
        let [width, height] = source.size();
        let count = Picture::pixels_of(width, height)?;
        let bytes = count * if count <= MOST_WHOLE { size_of::<[f32; 3]>() } else { size_of::<u32>() };
        memory::reserve(bytes as u64, || format!("{}: a sky of {width} x {height} pixels", path.display()))?;
        let mut panorama = Panorama::black(width, height);
        let mut wrong = None;
        source.each(|x, y, texel| {
            let Pixel { radiance, .. } = pixel_of(texel);
            if !radiance.iter().all(|band| band.is_finite()) && wrong.is_none() {
                wrong = Some((x, y));
            }
            panorama.set(x, y, radiance);
        })?;
        match wrong {
            Some((x, y)) => Err(PictureError::Number { path: path.into(), x, y }),
            None => Ok(panorama),
        }
    }

    /// A panorama of a function of column and row.
    ///
    /// # Errors
    /// [`PictureError::Size`].
    pub fn of(width: u32, height: u32, radiance: impl Fn(u32, u32) -> DVec3) -> Result<Panorama, PictureError> {
        Picture::pixels_of(width, height)?;
        let mut panorama = Panorama::black(width, height);
        for y in 0..height {
            (0..width).for_each(|x| panorama.set(x, y, radiance(x, y).as_vec3().to_array()));
        }
        Ok(panorama)
    }

    /// A panorama of spectra.
    ///
    /// - `parts`: spectra that are added up, W/(m² sr nm). `values`: for each pixel, row by row, how much of each part.
    ///
    /// # Errors
    /// [`PictureError::Size`].
    pub fn of_spectra(
        width: u32,
        height: u32,
        parts: Vec<Spectrum>,
        values: Vec<f32>,
    ) -> Result<Panorama, PictureError> {
        let bands: Vec<DVec3> = parts.iter().map(|part| Color::Spectrum(part.clone()).bands_of_light()).collect();
        let count = bands.len();
        let at = |x: u32, y: u32| (y as usize * width as usize + x as usize) * count;
        let values = if values.len() == at(0, height) { values } else { vec![0.0; at(0, height)] };
        let radiance =
            |x, y| values[at(x, y)..][..count].iter().zip(&bands).map(|(v, band)| f64::from(*v) * *band).sum();
        let panorama = Panorama::of(width, height, radiance)?;
        Ok(Panorama { spectra: Some(Spectra { parts, values }), ..panorama })
    }

    /// The spectra of which the pixels are made; none where only red, green and blue are known.
    pub(super) fn parts(&self) -> Option<&[Spectrum]> {
        self.spectra.as_ref().map(|spectra| &spectra.parts[..])
    }

    /// How much of each spectrum there is at a place.
    ///
    /// - `tell`: for each of [`Panorama::parts`], in their order.
    pub(super) fn parts_at(&self, place: DVec2, mut tell: impl FnMut(usize, f64)) {
        let Some(Spectra { parts, values }) = &self.spectra else { return };
        let ([x, y], DVec2 { x: s, y: t }) = self.cell(place);
        let of = |x: usize, y: usize| (y.min(self.height - 1) * self.width + x % self.width) * parts.len();
        let corners = [of(x, y), of(x + 1, y), of(x, y + 1), of(x + 1, y + 1)];
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
        for part in 0..parts.len() {
            let mix = corners.iter().zip(weights).map(|(corner, weight)| weight * f64::from(values[corner + part]));
            tell(part, mix.sum());
        }
    }

    fn black(width: u32, height: u32) -> Panorama {
        let count = width as usize * height as usize;
        let texels = match count <= MOST_WHOLE {
            true => Texels::Whole(vec![[0.0; 3]; count]),
            false => Texels::Packed(vec![0; count]),
        };
        Panorama { width: width as usize, height: height as usize, texels, spectra: None }
    }

    fn set(&mut self, x: u32, y: u32, radiance: [f32; 3]) {
        let index = y as usize * self.width + x as usize;
        // Written so that NaN becomes 0.
        let radiance = radiance.map(|band| if band > 0.0 { band } else { 0.0 });
        match &mut self.texels {
            Texels::Whole(whole) => whole[index] = radiance,
            Texels::Packed(packed) => packed[index] = pack(radiance),
        }
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        let texels = match &self.texels {
            Texels::Whole(whole) => size_of_val(&whole[..]),
            Texels::Packed(packed) => size_of_val(&packed[..]),
        };
        texels + self.spectra.as_ref().map_or(0, |spectra| size_of_val(&spectra.values[..]))
    }

    /// The radiance of a pixel.
    ///
    /// - `x`: its column, from which whole turns are taken off. `y`: its row; the last one for rows beyond it.
    pub fn texel(&self, x: usize, y: usize) -> DVec3 {
        let index = y.min(self.height - 1) * self.width + x % self.width;
        match &self.texels {
            Texels::Whole(whole) => DVec3::from_array(whole[index].map(f64::from)),
            Texels::Packed(packed) => unpack(packed[index]),
        }
    }

    /// The cell of four pixels in which a place lies, and where in it, 0..=1 both.
    ///
    /// - `place`: 0..=1 from the left and from the top.
    pub(super) fn cell(&self, place: DVec2) -> ([usize; 2], DVec2) {
        let [columns, rows] = self.cells().map(|count| count as f64);
        let across = (place.x * columns - 0.5).rem_euclid(columns);
        let down = (place.y * rows).clamp(0.0, rows);
        // A remainder may be rounded up to the whole.
        let (x, y) = (across.floor().min(columns - 1.0), down.floor().min(rows - 1.0));
        ([x as usize, y as usize], DVec2::new(across - x, down - y).min(DVec2::ONE))
    }

    /// Columns and rows of cells.
    pub(super) fn cells(&self) -> [usize; 2] {
        [self.width, (self.height - 1).max(1)]
    }

    /// The place in a cell, 0..=1 from the left and from the top.
    pub(super) fn place([x, y]: [usize; 2], within: DVec2, [columns, rows]: [usize; 2]) -> DVec2 {
        let across = (x as f64 + within.x + 0.5) / columns as f64;
        DVec2::new(across.fract(), (y as f64 + within.y) / rows as f64)
    }

    /// The radiance at a place, 0..=1 from the left and from the top.
    pub fn at(&self, place: DVec2) -> DVec3 {
        let ([x, y], DVec2 { x: s, y: t }) = self.cell(place);
        let row = |y: usize| self.texel(x, y).lerp(self.texel(x + 1, y), s);
        row(y).lerp(row(y + 1), t)
    }
}

/// Radiance in 32 bits.
fn pack(radiance: [f32; 3]) -> u32 {
    let brightest = f64::from(radiance.into_iter().fold(0.0, f32::max));
    if brightest < f64::from(EXPONENT.1 - 1).exp2() {
        return 0;
    }
    // One more where rounding would reach the next power of two.
    let floor = brightest.log2().floor() as i32 + 1;
    let is_full = (brightest / f64::from(floor).exp2() * 511.0).round() > 511.0;
    let exponent = (floor + i32::from(is_full)).clamp(EXPONENT.1 + 1, MOST_EXPONENT);
    let parts = PARTS.iter().zip(radiance).fold(0, |packed, ((bits, begin), band)| {
        let most = f64::from((1u32 << bits) - 1);
        let part = (f64::from(band) / f64::from(exponent).exp2() * most).round().min(most);
        packed | (part as u32) << begin
    });
    parts | ((exponent - EXPONENT.1) as u32) << EXPONENT.0
}

/// Radiance of 32 bits.
fn unpack(packed: u32) -> DVec3 {
    let exponent = (packed >> EXPONENT.0) as i32 + EXPONENT.1;
    // Two to the power of the exponent.
    let scale = f64::from_bits(((exponent + 1023) as u64) << 52);
    DVec3::from(PARTS.map(|(bits, begin)| {
        let most = (1u32 << bits) - 1;
        f64::from(packed >> begin & most) * (scale / f64::from(most))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_radiance_is_near_what_it_was() {
        for stops in -230..380 {
            let brightest = (f64::from(stops) / 10.0).exp2() as f32;
            for parts in [[1.0, 0.5, 0.3], [0.01, 1.0, 0.0], [0.2, 0.7, 1.0]] {
                let radiance = parts.map(|part: f32| part * brightest);
                let off = unpack(pack(radiance)) - DVec3::from(radiance.map(f64::from));
                let off = off.abs() / f64::from(brightest);
                assert!(off.x < 1.0 / 500.0 && off.y < 1.0 / 500.0 && off.z < 1.0 / 250.0, "{radiance:?}: {off}");
            }
        }
        assert_eq!([unpack(pack([0.0; 3])), unpack(pack([1e-12; 3]))], [DVec3::ZERO; 2]);
        let most = unpack(pack([f32::MAX; 3]));
        assert!((most / f64::from(MOST_EXPONENT).exp2() - 1.0).abs().max_element() < 1e-9, "{most}");
    }

    #[test]
    fn rows_begin_at_the_poles_and_columns_go_around() {
        let panorama = Panorama::of(8, 5, |x, y| DVec3::new(f64::from(x), f64::from(y), 1.0)).expect("small");
        for (y, v) in [(0.0, 0.0), (1.0, 0.25), (4.0, 1.0), (2.5, 0.625)] {
            assert!((panorama.at(DVec2::new(0.3, v)).y - y).abs() < 1e-12, "{v}");
        }
        // The middle of column 3, and between the last and the first.
        assert!((panorama.at(DVec2::new(3.5 / 8.0, 0.5)).x - 3.0).abs() < 1e-12);
        for u in [0.0, 1.0] {
            assert!((panorama.at(DVec2::new(u, 0.5)).x - 3.5).abs() < 1e-12);
        }
        for place in [DVec2::new(0.01, 0.0), DVec2::new(0.99, 1.0), DVec2::new(0.4, 0.7)] {
            let (cell, within) = panorama.cell(place);
            assert!((Panorama::place(cell, within, panorama.cells()) - place).abs().max_element() < 1e-12, "{place}");
        }
        let one = Panorama::of(1, 1, |_, _| DVec3::splat(2.0)).expect("small");
        assert_eq!(one.at(DVec2::new(0.7, 0.2)), DVec3::splat(2.0));
        assert!(Panorama::of(0, 5, |_, _| DVec3::ZERO).is_err());
    }

    #[test]
    fn a_large_panorama_takes_four_bytes_a_pixel() {
        let panorama = Panorama::of(2048, 1024, |x, y| DVec3::new(f64::from(x), f64::from(y), 0.5)).expect("fits");
        assert_eq!(panorama.bytes(), 4 * 2048 * 1024);
        assert!((panorama.texel(1500, 700) / DVec3::new(1500.0, 700.0, 0.5) - 1.0).x.abs() < 0.002);
    }
}
