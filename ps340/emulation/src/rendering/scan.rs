//! Scan conversion: which triangle each sample of the raster screen shows.
//!
//! # Model
//! Corners are rounded to 1/4096 of a pixel; from there on it is exact which samples a triangle covers: those inside,
//! and of those on a side the ones on its left or lower sides. So triangles with a common edge cover each sample
//! between them once. A sample shows the nearest triangle, of several equally near ones the first.
//!
//! Pixels have one sample or a square of them. What they show is shaded once for each triangle in a pixel, at the mean
//! of its samples there.
//!
//! # Cost
//! Proportional to the samples covered, and to the rows of samples for each triangle.

use super::project::Projected;
use rayon::prelude::*;

/// Units of length in a pixel.
const UNITS: i64 = 4096;
/// Lines of pixels that are worked on together.
const BAND: usize = 4;
/// Bands between two looks at the budget.
const BATCH: usize = 4;
/// No triangle.
const NONE: u32 = u32::MAX;

/// Triangles on the pixels of an image.
#[derive(Debug)]
pub struct Scan {
    width: usize,
    height: usize,
    /// Samples along a side of a pixel: a power of two, 1..=16.
    side: usize,
    triangles: Vec<Triangle>,
    /// The triangles in each band of lines, from the bottom.
    bands: Vec<Vec<u32>>,
    next: usize,
    pixels: Vec<[f32; 4]>,
}

/// A triangle in units of length.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [[i64; 2]; 3],
    /// The depth key at the origin, and how it changes in a unit to the right and upward.
    nearness: [f64; 3],
    /// Least and most of its corners.
    range: [f64; 2],
    /// How much nearer it must be than what is there.
    slack: f64,
    name: u32,
}

/// The arguments of a shader: a triangle by the number of its facet, and a position on the vector screen, -1..=1.
pub type Shader<'s> = &'s (dyn Fn(u32, [f64; 2]) -> [f32; 3] + Sync);

impl Scan {
    /// Begins an image.
    ///
    /// - `width`, `height`: pixels, at most 640 each.
    /// - `side`: samples along a side of a pixel, 1, 2, 4, 8 or 16.
    pub fn new(projected: &Projected, width: usize, height: usize, side: usize) -> Scan {
        let place = |c: f64, pixels: usize| {
            let units = pixels as f64 * UNITS as f64;
            ((c + 1.0) / 2.0 * units).round().clamp(0.0, units) as i64
        };
        let triangles: Vec<Triangle> = projected
            .pieces
            .iter()
            .filter_map(|piece| {
                let spots = piece.spots.map(|spot| projected.points[spot as usize]);
                let corners = spots.map(|spot| [place(spot.position.x, width), place(spot.position.y, height)]);
                Triangle::new(corners, spots.map(|spot| spot.depth_key), piece.triangle)
            })
            .collect();
        let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
        for (number, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.corners.map(|corner| corner[1]);
            let line = |y: i64| (y / UNITS / BAND as i64) as usize;
            let (first, last) = (line(a.min(b).min(c)), line(a.max(b).max(c)));
            for band in bands.iter_mut().take(last + 1).skip(first) {
                band.push(number as u32);
            }
        }
        Scan { width, height, side, triangles, bands, next: 0, pixels: Vec::with_capacity(width * height) }
    }

    /// Goes on for about so many units of work, each some ten nanoseconds. Returns the image once it is done: sums of
    /// red, green and blue over the covered part of each pixel, and that part, 0..=1; the bottom line first.
    pub fn advance(&mut self, units: u64, shader: Shader) -> Option<Vec<[f32; 4]>> {
        let mut left = units;
        while self.next < self.bands.len() {
            if left == 0 {
                return None;
            }
            let end = (self.next + BATCH).min(self.bands.len());
            let parts: Vec<Vec<[f32; 4]>> =
                (self.next..end).into_par_iter().map(|band| self.band(band, shader)).collect();
            let triangles: usize = self.bands[self.next..end].iter().map(Vec::len).sum();
            let pixels: usize = parts.iter().map(Vec::len).sum();
            left = left.saturating_sub((triangles * 8 + pixels * (4 + self.side * self.side / 4)) as u64);
            self.pixels.extend(parts.into_iter().flatten());
            self.next = end;
        }
        Some(std::mem::take(&mut self.pixels))
    }

    fn band(&self, band: usize, shader: Shader) -> Vec<[f32; 4]> {
        let first = band * BAND;
        let lines = BAND.min(self.height - first);
        let row = self.width * self.side;
        let mut samples = Samples {
            side: self.side,
            row,
            first: first * self.side,
            rows: lines * self.side,
            nearness: vec![f64::NEG_INFINITY; row * lines * self.side],
            names: vec![NONE; row * lines * self.side],
        };
        for number in &self.bands[band] {
            samples.cover(*number, &self.triangles[*number as usize]);
        }
        let shade = |number: u32, x: f64, y: f64| {
            let place = [2.0 * x / self.width as f64 - 1.0, 2.0 * y / self.height as f64 - 1.0];
            shader(self.triangles[number as usize].name, place)
        };
        let mut seen = Vec::new();
        let mut pixels = Vec::with_capacity(self.width * lines);
        for line in 0..lines {
            pixels.extend((0..self.width).map(|column| samples.pixel(column, line, &mut seen, &shade)));
        }
        pixels
    }
}

impl Triangle {
    /// None for a triangle without area.
    fn new(corners: [[i64; 2]; 3], nearness: [f64; 3], name: u32) -> Option<Triangle> {
        let [[ax, ay], [bx, by], [cx, cy]] = corners;
        let area = ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) as f64;
        let (u, v) = (nearness[1] - nearness[0], nearness[2] - nearness[0]);
        let slope_x = (u * (cy - ay) as f64 - v * (by - ay) as f64) / area;
        let slope_y = (v * (bx - ax) as f64 - u * (cx - ax) as f64) / area;
        let origin = nearness[0] - slope_x * ax as f64 - slope_y * ay as f64;
        let [a, b, c] = nearness;
        let largest = a.abs().max(b.abs()).max(c.abs());
        (area != 0.0).then_some(Triangle {
            corners,
            nearness: [origin, slope_x, slope_y],
            range: [a.min(b).min(c), a.max(b).max(c)],
            slack: 2.0 * (slope_x.abs() + slope_y.abs()) + 1e-12 * largest,
            name,
        })
    }

    /// The first sample of a row that lies behind each of the two sides that the row crosses.
    ///
    /// - `y`: the height of the row; `size`: the distance of samples, the first at half of it.
    fn crossings(&self, y: i64, size: i64) -> Option<[i64; 2]> {
        let mut found = [0; 2];
        let mut count = 0;
        for k in 0..3 {
            let (mut a, mut b) = (self.corners[k], self.corners[(k + 1) % 3]);
            if a[1] > b[1] {
                std::mem::swap(&mut a, &mut b);
            }
            // The lower end belongs to the side, the upper one does not.
            if a[1] <= y && y < b[1] && count < 2 {
                let height = b[1] - a[1];
                let across = a[0] * height + (y - a[1]) * (b[0] - a[0]);
                let (ahead, step) = (across - height * (size / 2), height * size);
                found[count] = -(-ahead).div_euclid(step);
                count += 1;
            }
        }
        (count == 2).then_some([found[0].min(found[1]), found[0].max(found[1])])
    }
}

/// The samples of a band.
struct Samples {
    side: usize,
    /// Samples in a row.
    row: usize,
    /// Number of the first row.
    first: usize,
    rows: usize,
    nearness: Vec<f64>,
    names: Vec<u32>,
}

impl Samples {
    fn cover(&mut self, number: u32, triangle: &Triangle) {
        let size = UNITS / self.side as i64;
        let [a, b, c] = triangle.corners.map(|corner| corner[1]);
        let last = (self.first + self.rows) as i64;
        let rows = (a.min(b).min(c) / size).max(self.first as i64)..(a.max(b).max(c) / size + 1).min(last);
        let [origin, slope_x, slope_y] = triangle.nearness;
        let [least, most] = triangle.range;
        for row in rows {
            let y = row * size + size / 2;
            let Some([begin, end]) = triangle.crossings(y, size) else { continue };
            let (begin, end) = (begin.max(0) as usize, end.clamp(0, self.row as i64) as usize);
            if begin >= end {
                continue;
            }
            let place = (row as usize - self.first) * self.row;
            let at_row = origin + slope_y * y as f64 + slope_x * (size / 2) as f64;
            let step = slope_x * size as f64;
            let nearness = &mut self.nearness[place + begin..place + end];
            let names = &mut self.names[place + begin..place + end];
            for (k, (nearest, name)) in nearness.iter_mut().zip(names).enumerate() {
                let here = (at_row + step * (begin + k) as f64).clamp(least, most);
                if here - triangle.slack > *nearest {
                    (*nearest, *name) = (here, number);
                }
            }
        }
    }

    /// The light of a pixel and how much of it is covered.
    ///
    /// - `visible`: scratch for the triangles that it shows, with the number of their samples and the sums of their
    ///   positions.
    fn pixel(
        &self,
        column: usize,
        line: usize,
        visible: &mut Vec<(u32, [usize; 3])>,
        shade: &impl Fn(u32, f64, f64) -> [f32; 3],
    ) -> [f32; 4] {
        visible.clear();
        for y in 0..self.side {
            let place = (line * self.side + y) * self.row + column * self.side;
            for (x, name) in self.names[place..place + self.side].iter().enumerate() {
                if *name == NONE {
                    continue;
                }
                let found = match visible.iter_mut().rev().find(|(known, _)| known == name) {
                    Some((_, found)) => found,
                    None => {
                        visible.push((*name, [0; 3]));
                        let end = visible.len() - 1;
                        &mut visible[end].1
                    }
                };
                *found = [found[0] + 1, found[1] + x, found[2] + y];
            }
        }
        let side = self.side as f64;
        let corner = [(column * self.side) as f64, (self.first + line * self.side) as f64];
        let mut pixel = [0.0; 4];
        for (name, [count, x, y]) in visible.iter() {
            let mean = |sum: usize, corner: f64| (corner + sum as f64 / *count as f64 + 0.5) / side;
            let [r, g, b] = shade(*name, mean(*x, corner[0]), mean(*y, corner[1]));
            let part = *count as f32 / (self.side * self.side) as f32;
            pixel = [pixel[0] + r * part, pixel[1] + g * part, pixel[2] + b * part, pixel[3] + part];
        }
        pixel
    }
}
