//! Light from all around: one radiance, or a picture of it.

use super::SkyMap;
use crate::color::{Channels, Color, Curve, Wavelengths};
use crate::numeric::sampling::{cosine_hemisphere, sphere};
use crate::picture::Picture;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Light from all around, ready for rendering.
#[derive(Clone, Debug)]
pub struct Sky {
    factor: Curve,
    map: Option<Map>,
    /// Cosine and sine of the turn about the upright axis.
    turned: DVec2,
}

/// A picture of the sky, from which directions are drawn as bright as they are.
#[derive(Clone, Debug)]
struct Map {
    picture: Arc<Picture>,
    /// Light of red, green and blue.
    primaries: [Curve; 3],
    /// The part of all light up to each row.
    rows: Vec<f64>,
    /// In each row, the part of its light up to each pixel.
    columns: Vec<f64>,
}

impl Sky {
    /// - `radiance`: what the map is multiplied with; all of the light without one.
    pub fn new(map: Option<&SkyMap>, radiance: &Color, turned: f64, wavelengths: &Wavelengths) -> Sky {
        let picture = map.and_then(|map| map.picture.clone());
        let map = picture.map(|picture| Map::new(picture, wavelengths));
        // A map has its own light; what it is multiplied with is then a filter.
        let factor = match &map {
            Some(_) => wavelengths.filter(radiance),
            None => wavelengths.light(radiance),
        };
        let (sin, cos) = turned.to_radians().sin_cos();
        Sky { factor, map, turned: DVec2::new(cos, sin) }
    }

    /// Radiance from a direction, unit length.
    pub fn radiance(&self, towards: DVec3, comb: usize) -> Channels {
        match &self.map {
            None => self.factor.of(comb),
            Some(map) => self.factor.of(comb) * map.radiance(place(self.back(towards)), comb),
        }
    }

    /// A direction, about as bright as it is, and its density, 1/sr.
    ///
    /// - `normal`: of the element that is lit, unit length; a sky of one radiance is then drawn by its cosine above it.
    pub(super) fn draw(&self, [x, y]: [f64; 2], normal: Option<DVec3>) -> Option<(DVec3, f64)> {
        let Some(map) = &self.map else {
            let towards = normal.map_or_else(|| sphere([x, y]), |normal| cosine_hemisphere([x, y], normal));
            return Some((towards, self.density(towards, normal))).filter(|(_, density)| *density > 0.0);
        };
        let at = map.draw([x, y])?;
        let towards = self.forth(direction(at));
        Some((towards, self.density(towards, normal))).filter(|(_, density)| *density > 0.0)
    }

    /// The density of a direction, 1/sr; the normal as in [`Sky::draw`].
    pub(super) fn density(&self, towards: DVec3, normal: Option<DVec3>) -> f64 {
        let Some(map) = &self.map else {
            return normal.map_or(0.5 / TAU, |normal| normal.dot(towards).max(0.0) / PI);
        };
        let back = self.back(towards);
        let sine = back.x.hypot(back.z);
        if sine > 0.0 { map.density(place(back)) / (sine * PI * TAU) } else { 0.0 }
    }

    /// Whether it has the same radiance in all directions.
    pub fn is_even(&self) -> bool {
        self.map.is_none()
    }

    /// The integral of its radiance over all directions.
    pub(super) fn total(&self, comb: usize) -> Channels {
        let all = self.map.as_ref().map_or_else(|| Channels::splat(2.0 * TAU), |map| map.total(comb));
        self.factor.of(comb) * all
    }

    /// About the mean of its luminance over all directions.
    pub fn mean(&self) -> f64 {
        self.factor.mean().max() * self.map.as_ref().map_or(1.0, Map::mean)
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

/// Where a direction is in the map, 0..1 from the left and from the top.
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
    fn new(picture: Arc<Picture>, wavelengths: &Wavelengths) -> Map {
        let primaries = DVec3::AXES.map(|axis| wavelengths.light(&Color::Bands(axis)));
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let mut columns = Vec::with_capacity(width * height);
        let mut rows = Vec::with_capacity(height);
        let mut all = 0.0;
        for (y, row) in picture.pixels().chunks_exact(width).enumerate() {
            let sine = ((y as f64 + 0.5) / height as f64 * PI).sin();
            let bright = |p: &crate::picture::Pixel| p.radiance.iter().map(|v| f64::from(v.max(0.0))).sum::<f64>();
            let sum: f64 = row.iter().map(bright).sum();
            let mut below = 0.0;
            columns.extend(row.iter().enumerate().map(|(x, pixel)| {
                below += bright(pixel);
                if sum > 0.0 { below / sum } else { (x + 1) as f64 / width as f64 }
            }));
            all += sum * sine;
            rows.push(all);
        }
        if all > 0.0 {
            rows.iter_mut().for_each(|below| *below /= all);
        }
        Map { picture, primaries, rows, columns }
    }

    fn size(&self) -> [usize; 2] {
        [self.picture.width() as usize, self.picture.height() as usize]
    }

    fn pixel(&self, place: DVec2) -> [usize; 2] {
        let [width, height] = self.size();
        [((place.x * width as f64) as usize).min(width - 1), ((place.y * height as f64) as usize).min(height - 1)]
    }

    fn radiance(&self, place: DVec2, comb: usize) -> Channels {
        let [x, y] = self.pixel(place);
        let pixel = self.picture.pixels()[y * self.size()[0] + x];
        let of = |band: usize| self.primaries[band].of(comb) * f64::from(pixel.radiance[band].max(0.0));
        of(0) + of(1) + of(2)
    }

    /// The integral over all directions: each row has the solid angle between two latitudes.
    fn total(&self, comb: usize) -> Channels {
        let [width, height] = self.size();
        let mut sums = DVec3::ZERO;
        for (y, row) in self.picture.pixels().chunks_exact(width).enumerate() {
            let [above, below] = [y, y + 1].map(|y| (y as f64 / height as f64 * PI).cos());
            let bands = |p: &crate::picture::Pixel| DVec3::from_array(p.radiance.map(|v| f64::from(v.max(0.0))));
            sums += row.iter().map(bands).sum::<DVec3>() * (TAU / width as f64 * (above - below));
        }
        let of = |band: usize| self.primaries[band].of(comb) * sums[band];
        of(0) + of(1) + of(2)
    }

    fn mean(&self) -> f64 {
        let [width, height] = self.size();
        let sum: f64 = self.picture.pixels().iter().map(|p| f64::from(p.radiance[1].max(0.0))).sum();
        sum / (width * height) as f64
    }

    /// A place, by the light that comes from its pixel.
    fn draw(&self, [x, y]: [f64; 2]) -> Option<DVec2> {
        if self.rows.last().is_none_or(|all| *all <= 0.0) {
            return None;
        }
        let [width, height] = self.size();
        let (row, down) = within(&self.rows, y);
        let (column, across) = within(&self.columns[row * width..(row + 1) * width], x);
        Some(DVec2::new((column as f64 + across) / width as f64, (row as f64 + down) / height as f64))
    }

    /// The density of a place in the map.
    fn density(&self, place: DVec2) -> f64 {
        let [width, height] = self.size();
        let [x, y] = self.pixel(place);
        let part = |below: &[f64], i: usize| below[i] - if i == 0 { 0.0 } else { below[i - 1] };
        let row = &self.columns[y * width..(y + 1) * width];
        part(&self.rows, y) * part(row, x) * (width * height) as f64
    }
}

/// The part in which a number falls, and where in it, 0..1.
fn within(below: &[f64], uniform: f64) -> (usize, f64) {
    let index = below.partition_point(|part| *part <= uniform).min(below.len() - 1);
    let from = if index == 0 { 0.0 } else { below[index - 1] };
    let size = below[index] - from;
    (index, if size > 0.0 { ((uniform - from) / size).clamp(0.0, 1.0_f64.next_down()) } else { 0.5 })
}
