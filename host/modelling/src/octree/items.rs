//! Items of the index, in the order of locational codes: triangles, and pieces of large ones that are thin and slanted.

use super::build::{OctreeBuilder, octants, place};
use super::bvh::{DIGITS, radix_sorted};
use super::clip::{FAT, LocalBounds};
use super::code::{LocationalCode, MAX_DEPTH};
use glam::DVec3;
use rayon::prelude::*;
use wide::f32x4;

/// Items that one thread takes at a time.
const PARALLEL_ITEMS: usize = 4096;

/// A triangle is held as pieces if each of them saves more than this share of a test of every triangle by every ray.
/// Rays through scanned meshes are no faster with less, and building takes twice as long.
const WORTHWHILE: f32 = 16.0;

/// A triangle is cut only if it fills less than this share of its box.
const THIN: f32 = 1.0 / 8.0;

/// Into cells so many levels below the one that is as large as its box.
const FINER: u32 = 4;

/// About as many items lie in a cell.
const CELL_ITEMS: usize = 16;

/// Bits that make a normal number of any number below 2^28, since arithmetic on others is slow.
const NORMAL: u32 = 1 << 30;

/// A box in local coordinates, with two numbers in the lanes that are left over.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Lowest corner; in the last lane the bits of the number.
    pub low: f32x4,
    /// Highest corner; in the last lane the bits of the weight.
    pub high: f32x4,
}

impl Item {
    /// The box of nothing.
    pub const EMPTY: Self = Self { low: f32x4::new([f32::INFINITY; 4]), high: f32x4::new([f32::NEG_INFINITY; 4]) };

    /// This box with other numbers, both below 2^28.
    pub fn numbered(self, number: u32, weight: u32) -> Self {
        let with = |corner: f32x4, bits: u32| {
            let [x, y, z, _] = corner.to_array();
            f32x4::new([x, y, z, f32::from_bits(bits | NORMAL)])
        };
        Self { low: with(self.low, number), high: with(self.high, weight) }
    }

    /// Number of the triangle, or where the items of a cell begin.
    #[inline]
    pub fn number(&self) -> u32 {
        self.low.as_array()[3].to_bits() & !NORMAL
    }

    /// How many triangles it stands for.
    #[inline]
    pub fn weight(&self) -> usize {
        (self.high.as_array()[3].to_bits() & !NORMAL) as usize
    }

    /// The box around two; its numbers mean nothing.
    #[inline]
    pub fn union(&self, other: &Self) -> Self {
        Self { low: self.low.fast_min(other.low), high: self.high.fast_max(other.high) }
    }

    /// Twice the middle.
    #[inline]
    pub fn centre(&self) -> f32x4 {
        self.low + self.high
    }

    /// Half the surface; proportional to the share of random lines that hit the box.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let [x, y, z, _] = (self.high - self.low).to_array();
        x * y + y * z + z * x
    }
}

/// Local coordinates of vertices, rounded to single precision.
pub fn local(division: &OctreeBuilder<'_>) -> Vec<f32x4> {
    let place = |&vertex: &DVec3| {
        let [x, y, z] = division.cube.local(vertex).as_vec3().to_array();
        f32x4::new([x, y, z, 0.0])
    };
    division.vertices.par_iter().with_min_len(PARALLEL_ITEMS).map(place).collect()
}

/// The items of all triangles that a ray can hit, in the order of the codes of their middles; and the cells of about
/// [`CELL_ITEMS`] that they lie in, each with its first item as its number.
pub fn items(division: &OctreeBuilder<'_>, local: &[f32x4]) -> (Vec<Item>, Vec<Item>) {
    let whole = |triangle: usize| {
        let [a, b, c] = division.triangles[triangle].map(|i| local[i as usize]);
        let item = Item { low: a.fast_min(b).fast_min(c), high: a.fast_max(b).fast_max(c) };
        // Rounding makes no two of one point.
        let is_extended = (a != b && b != c && c != a) || division.is_extended(triangle);
        is_extended.then(|| item.numbered(triangle as u32, 1))
    };
    let triangles = 0..division.triangles.len();
    let mut items: Vec<Item> = triangles.into_par_iter().with_min_len(PARALLEL_ITEMS).filter_map(whole).collect();
    cut(division, &mut items);

    let keys: Vec<u64> =
        items.par_iter().enumerate().with_min_len(PARALLEL_ITEMS).map(|(at, item)| key(item) | at as u64).collect();
    let keys = radix_sorted(keys);
    let items: Vec<Item> =
        keys.par_iter().with_min_len(PARALLEL_ITEMS).map(|&key| items[key as u32 as usize]).collect();

    // Surfaces intersect four times as many cells at each level.
    let level = (items.len() / CELL_ITEMS).max(1).ilog(4).min(DIGITS);
    let cell = |key: u64| key >> 32 >> (3 * (DIGITS - level));
    let mut cells: Vec<Item> = Vec::with_capacity(2 * items.len() / CELL_ITEMS);
    let mut first = 0;
    for run in keys.chunk_by(|&one, &other| cell(one) == cell(other)) {
        let end = first + run.len();
        let around = items[first..end].iter().fold(Item::EMPTY, |all, item| all.union(item));
        cells.push(around.numbered(first as u32, run.len() as u32));
        first = end;
    }
    (items, cells)
}

/// The code of the middle of an item, in the upper half.
fn key(item: &Item) -> u64 {
    let voxels = f32x4::splat((1_u32 << (MAX_DEPTH - 1)) as f32);
    let [x, y, z, _] = (item.centre() * voxels).to_array();
    // What is below zero becomes zero, and the modelling cube has room to spare.
    let code = LocationalCode::containing([x as u32, y as u32, z as u32], DIGITS);
    code.bits() >> (64 - 3 * DIGITS) << 32
}

/// Replaces large triangles that are thin and slanted by their pieces in small cells, if that saves enough.
fn cut(division: &OctreeBuilder<'_>, items: &mut Vec<Item>) {
    let all = items.iter().fold(Item::EMPTY, |all, item| all.union(item)).half_area();
    let threshold = WORTHWHILE * all / items.len() as f32;
    let mut added = Vec::new();
    for item in items.iter_mut().filter(|item| item.half_area() > threshold) {
        let number = item.number();
        let corners = division.corners(number);
        let [a, b, c] = corners;
        // Half the sum of the shadows that it throws along the axes.
        let least = 0.5 * (b - a).cross(c - a).abs().element_sum() as f32;
        if least > item.half_area() * THIN {
            continue;
        }
        let mut pieces = Vec::new();
        collect(division, number, LocationalCode::ROOT, home_level(&corners) + FINER, &mut pieces);
        let area: f32 = pieces.iter().map(LocalBounds::half_area).sum();
        if item.half_area() - area > threshold * pieces.len() as f32 {
            let point = |[x, y, z]: [f32; 3]| f32x4::new([x, y, z, 0.0]);
            let mut pieces =
                pieces.iter().map(|piece| Item { low: point(piece.low), high: point(piece.high) }.numbered(number, 1));
            *item = pieces.next().unwrap_or(*item);
            added.extend(pieces);
        }
    }
    items.extend(added);
}

/// The level of cells that are about as large as the box of a triangle.
fn home_level(&[a, b, c]: &[DVec3; 3]) -> u32 {
    let size = (a.max(b).max(c) - a.min(b).min(c)).max_element();
    (0..MAX_DEPTH).find(|&level| 0.5_f64.powi(level as i32) < 2.0 * size).unwrap_or(MAX_DEPTH)
}

/// Adds the pieces of a triangle in the cells of a level within a cell.
fn collect(
    division: &OctreeBuilder<'_>,
    triangle: u32,
    cell: LocationalCode,
    level: u32,
    pieces: &mut Vec<LocalBounds>,
) {
    let Some(piece) = division.part(triangle, cell) else { return };
    if cell.level() >= level.min(MAX_DEPTH) {
        pieces.push(piece);
        return;
    }
    // Most octants are beside what is in the cell: nothing has to be cut to know that.
    let (low, half) = place(cell);
    let touches = |octant: &LocationalCode| {
        let digit = octant.digit(octant.level()).unwrap_or(0);
        (0..3).all(|axis| match digit >> axis & 1 {
            0 => f64::from(piece.low[axis]) <= low[axis] + half + FAT,
            _ => f64::from(piece.high[axis]) >= low[axis] + half - FAT,
        })
    };
    octants(cell).filter(touches).for_each(|octant| collect(division, triangle, octant, level, pieces));
}
