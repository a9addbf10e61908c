//! Light from all around: one radiance, or a picture of it.

use super::panorama::Panorama;
use super::portal::{PortalChoice, Portals};
use super::{LightShape, SkyDisc, SkyMap};
use crate::color::{Channels, Color, SpectralTable, WavelengthSets};
use crate::numeric::sampling::{cosine_hemisphere, part_of, sphere};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::Range;
use std::sync::Arc;

/// Most cells that have a block of their own each.
const MOST_SINGLE: usize = 1 << 20;
/// Cells along a side of a block of a larger picture.
const BLOCK: usize = 8;

/// Light from all around, prepared for rendering.
#[derive(Clone, Debug)]
pub struct Sky {
    factor: SpectralTable,
    map: Option<Map>,
    disc: Option<Disc>,
    /// Cosine and sine of the turn about the upright axis.
    turned: DVec2,
    portals: Portals,
}

/// A picture of the sky, of which directions are sampled in proportion to their brightness.
///
/// It is divided into cells between four pixels, in which its radiance is bilinear, and these into blocks. A block is
/// sampled by a table, and a cell in it by going through all of them: of a large picture the table is small.
#[derive(Clone, Debug)]
struct Map {
    panorama: Arc<Panorama>,
    /// Light of red, green and blue.
    primaries: [SpectralTable; 3],
    /// Light of the parts of spectra, where these are known and rays carry wavelengths.
    parts: Vec<SpectralTable>,
    /// Cells along a side of a block.
    side: usize,
    /// Light of all cells.
    all: f64,
    /// The part of all light up to each row of blocks.
    rows: Vec<f64>,
    /// In each row of blocks, the part of its light up to each block.
    columns: Vec<f64>,
}

impl Sky {
    /// - `radiance`: what the map is multiplied with; all of the light without one.
    pub fn new(map: Option<&SkyMap>, radiance: &Color, turned: f64, wavelengths: &WavelengthSets) -> Sky {
        let panorama = map.and_then(|map| map.panorama.clone());
        let disc = map.and_then(|map| map.disc).map(Disc::new);
        let map = panorama.map(|panorama| Map::new(panorama, wavelengths));
        // A map has its own light; what it is multiplied with is then a filter.
        let factor = match &map {
            Some(_) => wavelengths.filter(radiance),
            None => wavelengths.light(radiance),
        };
        let (sin, cos) = turned.to_radians().sin_cos();
        Sky { factor, map, disc, turned: DVec2::new(cos, sin), portals: Portals::default() }
    }

    /// Radiance from a direction, unit length.
    pub fn radiance(&self, towards: DVec3, wavelength_set: usize) -> Channels {
        match &self.map {
            None if self.is_beside(towards) => Channels::ZERO,
            None => self.factor.of(wavelength_set),
            Some(map) => self.factor.of(wavelength_set) * map.radiance(place(self.back(towards)), wavelength_set),
        }
    }

    /// The sky, of which directions are sampled through portals from where these are; a disc of it is small enough
    /// without.
    pub(super) fn with_portals(self, portals: &[LightShape]) -> Sky {
        let portals = if self.disc.is_some() { Portals::default() } else { Portals::new(portals) };
        Sky { portals, ..self }
    }

    /// A direction to light a point from, and its pdf, 1/sr.
    ///
    /// - `normal`: of the element that is lit, unit length; a sky of one radiance is then sampled by its cosine above
    ///   it.
    /// - `uniform`: a point of the unit square.
    pub(super) fn sample(&self, point: DVec3, normal: Option<DVec3>, uniform: [f64; 2]) -> Option<(DVec3, f64)> {
        let towards = match self.portals.sample(point, uniform) {
            PortalChoice::Through(towards) => towards,
            PortalChoice::Anywhere(uniform) => self.sample_anywhere(normal, uniform)?,
            PortalChoice::None => return None,
        };
        Some((towards, self.pdf(point, towards, normal))).filter(|(_, pdf)| *pdf > 0.0)
    }

    /// The pdf of a direction by [`Sky::sample`], 1/sr.
    pub(super) fn pdf(&self, point: DVec3, towards: DVec3, normal: Option<DVec3>) -> f64 {
        self.portals.pdf(point, towards, self.pdf_anywhere(towards, normal))
    }

    /// A direction, sampled about in proportion to its brightness; the normal as in [`Sky::sample`].
    fn sample_anywhere(&self, normal: Option<DVec3>, uniform: [f64; 2]) -> Option<DVec3> {
        match (&self.disc, &self.map, normal) {
            (Some(disc), ..) => Some(self.forth(disc.sample(uniform))),
            (None, Some(map), _) => Some(self.forth(direction(map.sample(uniform)?))),
            (None, None, Some(normal)) => Some(cosine_hemisphere(uniform, normal)),
            (None, None, None) => Some(sphere(uniform)),
        }
    }

    /// The pdf of a direction by [`Sky::sample_anywhere`], 1/sr.
    fn pdf_anywhere(&self, towards: DVec3, normal: Option<DVec3>) -> f64 {
        if let Some(disc) = &self.disc {
            return if self.is_beside(towards) { 0.0 } else { disc.pdf };
        }
        let Some(map) = &self.map else {
            return normal.map_or(0.5 / TAU, |normal| normal.dot(towards).max(0.0) / PI);
        };
        let back = self.back(towards);
        let sine = back.x.hypot(back.z);
        if sine > 0.0 { map.pdf(place(back)) / (sine * PI * TAU) } else { 0.0 }
    }

    /// A direction from which light enters the scene, sampled about in proportion to its brightness, and its pdf, 1/sr.
    pub(super) fn sample_emission(&self, uniform: [f64; 2]) -> Option<(DVec3, f64)> {
        let towards = self.sample_anywhere(None, uniform)?;
        Some((towards, self.pdf_anywhere(towards, None))).filter(|(_, pdf)| *pdf > 0.0)
    }

    /// Whether it has the same radiance in all directions.
    pub fn is_even(&self) -> bool {
        self.map.is_none() && self.disc.is_none()
    }

    /// Towards the middle of the disc that is all of it, unit length; none of another sky.
    pub(super) fn disc(&self) -> Option<DVec3> {
        self.disc.as_ref().map(|disc| self.forth(disc.towards))
    }

    /// Whether a direction, unit length, is beside the disc that is all of it.
    pub(super) fn is_beside(&self, towards: DVec3) -> bool {
        self.disc.as_ref().is_some_and(|disc| !disc.has(self.back(towards)))
    }

    /// The integral of its radiance over all directions.
    pub(super) fn total(&self, wavelength_set: usize) -> Channels {
        let all = match (&self.map, &self.disc) {
            (Some(map), _) => map.total(wavelength_set),
            (None, Some(disc)) => Channels::splat(disc.pdf.recip()),
            (None, None) => Channels::splat(2.0 * TAU),
        };
        self.factor.of(wavelength_set) * all
    }

    fn forth(&self, direction: DVec3) -> DVec3 {
        let DVec2 { x: cos, y: sin } = self.turned;
        DVec3::new(cos * direction.x + sin * direction.z, direction.y, cos * direction.z - sin * direction.x)
    }

    fn back(&self, direction: DVec3) -> DVec3 {
        let DVec2 { x: cos, y: sin } = self.turned;
        DVec3::new(cos * direction.x - sin * direction.z, direction.y, cos * direction.z + sin * direction.x)
    }
}

/// A disc in the sky.
#[derive(Clone, Copy, Debug)]
struct Disc {
    towards: DVec3,
    /// Two directions square to it and to each other.
    aside: [DVec3; 2],
    /// One less the cosine of its radius, without cancellation.
    rise: f64,
    /// The reciprocal of its solid angle, 1/sr.
    pdf: f64,
}

impl Disc {
    fn new(disc: SkyDisc) -> Disc {
        let SkyDisc { towards, radius } = disc;
        let (a, b) = towards.any_orthonormal_pair();
        let rise = 2.0 * (0.5 * radius).sin().powi(2);
        Disc { towards, aside: [a, b], rise, pdf: 1.0 / disc.solid_angle() }
    }

    /// Whether a direction, unit length, is in it.
    fn has(&self, direction: DVec3) -> bool {
        // The square of a chord is twice the rise.
        (direction - self.towards).length_squared() <= 2.0 * self.rise
    }

    /// A direction in it, sampled evenly.
    fn sample(&self, [x, y]: [f64; 2]) -> DVec3 {
        let rise = x * self.rise;
        let sine = (rise * (2.0 - rise)).sqrt();
        let (across, along) = (y * TAU).sin_cos();
        self.towards * (1.0 - rise) + (self.aside[0] * along + self.aside[1] * across) * sine
    }
}

/// The place of a direction in the map, 0..1 from the left and from the top.
fn place(direction: DVec3) -> DVec2 {
    let across = direction.x.atan2(-direction.z) / TAU + 0.5;
    let down = direction.x.hypot(direction.z).atan2(direction.y) / PI;
    DVec2::new(across, down)
}

/// The direction at a place of the map.
fn direction(place: DVec2) -> DVec3 {
    let (sin, cos) = ((place.x - 0.5) * TAU).sin_cos();
    let (up, level) = (FRAC_PI_2 - place.y * PI).sin_cos();
    DVec3::new(sin * level, up, -cos * level)
}

impl Map {
    fn new(panorama: Arc<Panorama>, wavelengths: &WavelengthSets) -> Map {
        let [columns, rows] = panorama.cells();
        Map::divided(panorama, wavelengths, if columns * rows <= MOST_SINGLE { 1 } else { BLOCK })
    }

    /// - `side`: cells along a side of a block, at most [`BLOCK`].
    fn divided(panorama: Arc<Panorama>, wavelengths: &WavelengthSets, side: usize) -> Map {
        let primaries = DVec3::AXES.map(|axis| wavelengths.light(&Color::Bands(axis)));
        let cells = panorama.cells();
        let is_known = panorama.parts().filter(|_| wavelengths.is_spectral());
        let parts = is_known.unwrap_or_default().iter().map(|part| wavelengths.light(&Color::Spectrum(part.clone())));
        let parts = parts.collect();
        let mut map = Map { panorama, primaries, parts, side, all: 0.0, rows: Vec::new(), columns: Vec::new() };
        let [across, down] = cells.map(|count| count.div_ceil(side));
        let blocks = (0..across * down).into_par_iter().with_min_len(1 << 10);
        let mut light: Vec<f64> = blocks.map(|block| map.of_block([block % across, block / across])).collect();
        for row in light.chunks_exact_mut(across) {
            map.all += row.iter().sum::<f64>();
            map.rows.push(map.all);
            add_up(row);
        }
        map.rows.iter_mut().for_each(|below| *below /= map.all.max(f64::MIN_POSITIVE));
        map.columns = light;
        map
    }

    /// The cells of a block along one axis.
    fn cells_of(&self, block: usize, axis: usize) -> Range<usize> {
        let all = self.panorama.cells()[axis];
        (block * self.side).min(all)..((block + 1) * self.side).min(all)
    }

    /// Light of a block.
    fn of_block(&self, block: [usize; 2]) -> f64 {
        let [columns, rows] = [0, 1].map(|axis| self.cells_of(block[axis], axis));
        rows.flat_map(|y| columns.clone().map(move |x| [x, y])).map(|cell| self.of_cell(cell)).sum()
    }

    /// Light of a cell: the mean brightness of its corners times the mean sine of the angle from the zenith.
    fn of_cell(&self, cell: [usize; 2]) -> f64 {
        self.corners(cell).iter().sum::<f64>() / 4.0 * self.sine(cell[1])
    }

    /// Brightness of the corners of a cell: left and right above, left and right below.
    fn corners(&self, [x, y]: [usize; 2]) -> [f64; 4] {
        [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]].map(|corner| self.brightness(corner))
    }

    fn brightness(&self, [x, y]: [usize; 2]) -> f64 {
        self.panorama.texel(x, y).element_sum()
    }

    /// The mean sine of the angle from the zenith in a row of cells.
    fn sine(&self, row: usize) -> f64 {
        let rows = self.panorama.cells()[1] as f64;
        let [above, below] = [row, row + 1].map(|row| (row as f64 / rows * PI).cos());
        (above - below) * rows / PI
    }

    fn radiance(&self, place: DVec2, wavelength_set: usize) -> Channels {
        if self.parts.is_empty() {
            return self.light(self.panorama.at(place), wavelength_set);
        }
        let mut sum = Channels::ZERO;
        self.panorama.parts_at(place, |part, value| sum += self.parts[part].of(wavelength_set) * value);
        sum
    }

    fn light(&self, bands: DVec3, wavelength_set: usize) -> Channels {
        let of = |band: usize| self.primaries[band].of(wavelength_set) * bands[band];
        of(0) + of(1) + of(2)
    }

    /// The integral over all directions.
    fn total(&self, wavelength_set: usize) -> Channels {
        let [width, rows] = self.panorama.cells();
        let step = PI / rows as f64;
        let mut sums = DVec3::ZERO;
        for y in 0..=rows {
            // The integral of the sine times a hat that is 1 in the row and 0 in those beside it.
            let angle = y as f64 * step;
            let hat = match y {
                0 => 1.0 - step.sin() / step,
                y if y == rows => 1.0 - step.sin() / step,
                _ => 2.0 * angle.sin() * (1.0 - step.cos()) / step,
            };
            sums += (0..width).map(|x| self.panorama.texel(x, y)).sum::<DVec3>() * (hat * TAU / width as f64);
        }
        self.light(sums, wavelength_set)
    }

    /// A place, sampled about in proportion to its brightness.
    fn sample(&self, [x, y]: [f64; 2]) -> Option<DVec2> {
        if self.all <= 0.0 {
            return None;
        }
        let across = self.columns.len() / self.rows.len();
        let (row, down) = part_of(&self.rows, y);
        let (column, aside) = part_of(&self.columns[row * across..(row + 1) * across], x);
        let (cell, [s, t]) = if self.side == 1 {
            ([column, row], [aside, down])
        } else {
            self.sample_cell([column, row], [aside, down])
        };
        // Down the means of both sides first, and then across where that is.
        let [a, b, c, d] = self.corners(cell);
        let t = linear(a + b, c + d, t);
        let between = |above: f64, below: f64| above + (below - above) * t;
        let s = linear(between(a, c), between(b, d), s);
        Some(Panorama::place(cell, DVec2::new(s, t), self.panorama.cells()))
    }

    /// A cell of a block, and what is left of the numbers that chose it.
    fn sample_cell(&self, block: [usize; 2], [x, y]: [f64; 2]) -> ([usize; 2], [f64; 2]) {
        let [columns, rows] = [0, 1].map(|axis| self.cells_of(block[axis], axis));
        // Brightness of a row of corners, in pairs.
        let pairs = |y: usize| {
            let mut pairs = [0.0; BLOCK];
            let mut left = self.brightness([columns.start, y]);
            for (x, pair) in columns.clone().zip(&mut pairs) {
                let right = self.brightness([x + 1, y]);
                *pair = left + right;
                left = right;
            }
            pairs
        };
        let mut light = [0.0; BLOCK * BLOCK];
        let mut of_rows = [0.0; BLOCK];
        let mut above = pairs(rows.start);
        for ((y, sum), cells) in rows.clone().zip(&mut of_rows).zip(light.chunks_exact_mut(BLOCK)) {
            let (below, sine) = (pairs(y + 1), self.sine(y));
            for ((cell, above), below) in cells.iter_mut().zip(above).zip(below) {
                *cell = (above + below) / 4.0 * sine;
            }
            *sum = cells.iter().sum();
            above = below;
        }
        let of_rows = &mut of_rows[..rows.len()];
        add_up(of_rows);
        let (row, down) = part_of(of_rows, y);
        let cells = &mut light[row * BLOCK..][..columns.len()];
        add_up(cells);
        let (column, aside) = part_of(cells, x);
        ([columns.start + column, rows.start + row], [aside, down])
    }

    /// The pdf of a place in the map.
    fn pdf(&self, place: DVec2) -> f64 {
        if self.all <= 0.0 {
            return 0.0;
        }
        let ([_, y], _) = self.panorama.cell(place);
        let [columns, rows] = self.panorama.cells();
        self.panorama.at(place).element_sum() * self.sine(y) / self.all * (columns * rows) as f64
    }
}

/// Numbers as the part of their sum up to each; even parts where all are 0.
fn add_up(numbers: &mut [f64]) {
    let (sum, count) = (numbers.iter().sum::<f64>(), numbers.len() as f64);
    let mut below = 0.0;
    for number in numbers {
        below += if sum > 0.0 { *number / sum } else { 1.0 / count };
        *number = below;
    }
}

/// A number, 0..=1, sampled by a pdf that goes from `a` to `b`.
///
/// # Source
/// Pharr, Jakob and Humphreys 2023, section 2.3.2.
fn linear(a: f64, b: f64, uniform: f64) -> f64 {
    if a + b <= 0.0 {
        return uniform;
    }
    let root = (a * a + uniform * (b * b - a * a)).max(0.0).sqrt();
    (uniform * (a + b) / (a + root).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::RandomStream;

    #[test]
    fn blocks_sample_the_same_directions_as_single_cells_do() {
        let radiance = |x: u32, y: u32| {
            DVec3::splat(f64::from((x * 7 + y * 13) % 11) + if x == 5 && y == 9 { 300.0 } else { 0.0 })
        };
        let panorama = Arc::new(Panorama::of(37, 23, radiance).expect("small"));
        let [single, blocks] = [1, BLOCK].map(|side| Map::divided(panorama.clone(), &WavelengthSets::bands(), side));
        assert!((single.all / blocks.all - 1.0).abs() < 1e-12);
        let count = 40_000;
        let (mut stream, mut sums) = (RandomStream::new(3, 5), [DVec2::ZERO; 2]);
        let (mut seen, mut near) = (0.0, [0, 0]);
        for _ in 0..count {
            let uniform = stream.point();
            for (number, map) in [&single, &blocks].into_iter().enumerate() {
                let place = map.sample(uniform).expect("light");
                sums[number] += place;
                near[number] += u32::from((place - DVec2::new(5.5 / 37.0, 9.0 / 22.0)).abs().max_element() < 0.05);
                assert!((map.pdf(place) / single.pdf(place) - 1.0).abs() < 1e-9);
                seen += 0.5 / map.pdf(place);
            }
        }
        let [a, b] = sums.map(|sum| sum / f64::from(count));
        assert!((a - b).abs().max_element() < 0.01 && near[0].abs_diff(near[1]) < count / 50, "{a} {b} {near:?}");
        // The mean of one over the pdf is the area of the map.
        assert!((seen / f64::from(count) - 1.0).abs() < 0.03, "{seen}");
    }
}
