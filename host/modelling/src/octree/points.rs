//! Points sorted by locational code, and those around a place.

use super::cube::Cube;
#[cfg(target_arch = "x86_64")]
use super::lanes::Avx;
use super::{LocationalCode, MAX_DEPTH};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Digits of a code by which runs are found without a search.
const TABLE_LEVEL: u32 = 5;
/// Bits behind them.
const BEHIND: u32 = 64 - 3 * TABLE_LEVEL;

/// Points in the order of the codes of their voxels.
///
/// Each cube of any size is one run of them, found by binary search. Building takes one sort.
#[derive(Clone, Debug)]
pub struct SortedPoints {
    cube: Cube,
    /// Codes of the voxels, rising.
    codes: Vec<u64>,
    /// Local coordinates, 0..=1 in the cube, for each axis; behind them some that are nowhere.
    positions: [Vec<f32>; 3],
    /// Begin of the points of each cube of the table's level.
    table: Vec<u32>,
}

/// The points around a place.
#[derive(Clone, Debug, PartialEq)]
pub struct NearbyPoints {
    /// All points within this distance are among them, scene units.
    pub reach: f64,
    /// How many there are.
    pub count: usize,
    /// Runs of the points, cube by cube.
    pub runs: [Range<u32>; 8],
}

impl SortedPoints {
    /// Points that are looked at together.
    const BLOCK: usize = 8;

    /// Sorts points; the number of each among those given comes beside, in the new order.
    ///
    /// Points beyond 2^32 − 1, and all that are not finite, are left out.
    pub fn new(points: &[DVec3]) -> (SortedPoints, Vec<u32>) {
        let finite = || points.iter().filter(|point| point.is_finite());
        let low = finite().copied().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
        let high = finite().copied().reduce(DVec3::max).unwrap_or(DVec3::ZERO);
        let cube = Cube::around(low, high);
        let code = |(number, point): (usize, &DVec3)| {
            let voxel = cube.voxel(*point).filter(|_| point.is_finite())?;
            Some((LocationalCode::containing(voxel, MAX_DEPTH).bits(), u32::try_from(number).ok()?))
        };
        let mut keys: Vec<(u64, u32)> = points.par_iter().enumerate().filter_map(code).collect();
        keys.par_sort_unstable();
        let local = |(_, number): &(u64, u32)| cube.local(points[*number as usize]).as_vec3().to_array();
        let positions = [0, 1, 2].map(|axis| {
            let mut along: Vec<f32> = keys.par_iter().map(|key| local(key)[axis]).collect();
            along.extend([f32::NAN; SortedPoints::BLOCK]);
            along
        });
        let codes: Vec<u64> = keys.iter().map(|(code, _)| *code).collect();
        let cubes = 1 << (3 * TABLE_LEVEL);
        let table = (0..=cubes as u64).map(|k| match k {
            k if k == cubes as u64 => codes.len() as u32,
            k => codes.partition_point(|code| *code < k << BEHIND) as u32,
        });
        let table = table.collect();
        (SortedPoints { cube, codes, positions, table }, keys.into_iter().map(|(_, number)| number).collect())
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        let positions: usize = self.positions.iter().map(|along| size_of_val(&along[..])).sum();
        size_of_val(&self.codes[..]) + positions + size_of_val(&self.table[..])
    }

    /// A point, scene units: to 6e-8 of the side of the cube.
    pub fn position(&self, place: usize) -> DVec3 {
        let local = DVec3::from_array([0, 1, 2].map(|axis| f64::from(self.positions[axis][place])));
        self.cube.origin + local * self.cube.side
    }

    /// The points around a place: within a radius, or within a half, a quarter and so on of it, so that there are not
    /// many.
    ///
    /// - `most`: so many are not many.
    pub fn nearby(&self, place: DVec3, radius: f64, most: usize) -> NearbyPoints {
        let local = self.cube.local(place);
        // Of a cube twice as wide as the radius and its three nearest neighbours along each axis.
        let mut level = (0.5 * self.cube.side / radius).log2().floor().clamp(0.0, f64::from(MAX_DEPTH)) as u32;
        loop {
            let side = 0.5_f64.powi(level as i32);
            let mut around =
                NearbyPoints { reach: radius.min(0.5 * side * self.cube.side), count: 0, runs: Default::default() };
            let corner = local.to_array().map(|x| (x / side - 0.5).floor());
            let mut runs = 0;
            for digit in 0..8 {
                let cell = [0, 1, 2].map(|axis| corner[axis] + f64::from(digit >> axis & 1));
                let run = self.run(cell, level);
                if !run.is_empty() {
                    around.count += run.len();
                    around.runs[runs] = run;
                    runs += 1;
                }
            }
            if around.count <= most || level >= MAX_DEPTH {
                return around;
            }
            level += 1;
        }
    }

    /// Gives the points around a place that are within a flat disc there: the number of each, and the square of its
    /// distance along the disc, sides of the cube.
    ///
    /// - `normal`: of the disc, unit length. `squares`: of its radius, and of how far above and below a point may be,
    ///   sides of the cube.
    pub fn within(
        &self,
        around: &NearbyPoints,
        place: DVec3,
        normal: DVec3,
        squares: [f32; 2],
        give: impl FnMut(u32, f32),
    ) {
        let (local, normal) = (self.local(place), normal.as_vec3().to_array());
        #[cfg(target_arch = "x86_64")]
        {
            // Products are not rounded together with sums: the result is the same on every processor.
            #[target_feature(enable = "avx2")]
            fn within_wide(
                _: Avx,
                points: &SortedPoints,
                around: &NearbyPoints,
                places: [[f32; 3]; 2],
                squares: [f32; 2],
                give: impl FnMut(u32, f32),
            ) {
                points.within_by_blocks(around, places, squares, give);
            }
            if let Some(avx) = Avx::detected() {
                // SAFETY: `avx` proves that the processor has what the function is compiled for.
                return unsafe { within_wide(avx, self, around, [local, normal], squares, give) };
            }
        }
        self.within_by_blocks(around, [local, normal], squares, give);
    }

    #[inline(always)]
    fn within_by_blocks(
        &self,
        around: &NearbyPoints,
        [local, normal]: [[f32; 3]; 2],
        [flat, high]: [f32; 2],
        mut give: impl FnMut(u32, f32),
    ) {
        for run in &around.runs {
            for first in run.clone().step_by(SortedPoints::BLOCK) {
                let (mut squares, mut heights) = ([0.0_f32; SortedPoints::BLOCK], [0.0_f32; SortedPoints::BLOCK]);
                for axis in 0..3 {
                    let along = &self.positions[axis][first as usize..first as usize + SortedPoints::BLOCK];
                    for k in 0..SortedPoints::BLOCK {
                        let offset = along[k] - local[axis];
                        squares[k] += offset * offset;
                        heights[k] += offset * normal[axis];
                    }
                }
                let mut near = 0_u32;
                for k in 0..SortedPoints::BLOCK {
                    heights[k] *= heights[k];
                    squares[k] -= heights[k];
                    near |= u32::from((squares[k] < flat) & (heights[k] <= high)) << k;
                }
                // What lies beyond the run is of another.
                near &= u32::MAX >> (32 - (run.end - first).min(SortedPoints::BLOCK as u32));
                while near != 0 {
                    let k = near.trailing_zeros();
                    give(first + k, squares[k as usize]);
                    near &= near - 1;
                }
            }
        }
    }

    /// The offset of a point from a place, in sides of the cube; the place in local coordinates.
    #[inline]
    pub fn local_offset(&self, local: [f32; 3], place: usize) -> [f32; 3] {
        [0, 1, 2].map(|axis| self.positions[axis][place] - local[axis])
    }

    /// Local coordinates of a place.
    pub fn local(&self, place: DVec3) -> [f32; 3] {
        self.cube.local(place).as_vec3().to_array()
    }

    /// The side of the cube, scene units.
    pub fn side(&self) -> f64 {
        self.cube.side
    }

    /// The points of a cube, by its place among those of a level.
    fn run(&self, cell: [f64; 3], level: u32) -> Range<u32> {
        let cells = f64::from(1_u32 << level);
        if cell.iter().any(|x| !(0.0..cells).contains(x)) {
            return 0..0;
        }
        let voxel = cell.map(|x| (x as u32) << (MAX_DEPTH - level));
        let code = LocationalCode::containing(voxel, level).bits();
        let mark = code & code.wrapping_neg();
        let (first, last) = (code - mark, (code - mark) | (mark - 1) | mark);
        let [from, to] = [first, last].map(|code| (code >> BEHIND) as usize);
        if level <= TABLE_LEVEL {
            return self.table[from]..self.table[to + 1];
        }
        let found = |near: usize, is_before: &dyn Fn(u64) -> bool| {
            let (start, end) = (self.table[near] as usize, self.table[near + 1] as usize);
            (start + self.codes[start..end].partition_point(|code| is_before(*code))) as u32
        };
        found(from, &|code| code < first)..found(to, &|code| code <= last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::sampling::RandomStream;

    #[test]
    fn the_points_around_a_place_are_those_within_reach() {
        let mut stream = RandomStream::new(4, 1);
        // Dense towards a corner, far from the origin.
        let mut coordinate = || 1e4 + stream.uniform().powi(3) * 7.0;
        let given: Vec<DVec3> = (0..20_000).map(|_| DVec3::new(coordinate(), coordinate(), 5.0)).collect();
        let (points, order) = SortedPoints::new(&given);
        assert_eq!(points.len(), given.len());
        for (place, number) in order.iter().enumerate() {
            assert!(points.position(place).distance(given[*number as usize]) < 1e-5);
        }
        for centre in given.iter().step_by(997) {
            for (radius, most) in [(3.0, 100_000), (1.0, 300), (0.1, 50)] {
                let around = points.nearby(*centre, radius, most);
                assert!(around.count <= most && around.reach <= radius);
                let runs = around.runs.iter().flat_map(|run| run.clone());
                let local = points.local(*centre);
                let reach = around.reach * 0.9999;
                let near = |place: usize| {
                    let offset = points.local_offset(local, place).map(f64::from);
                    DVec3::from_array(offset).length() * points.side() < reach
                };
                let found = runs.filter(|place| near(*place as usize)).count();
                // All of them are in a plane.
                let mut within = 0;
                let square = (reach / points.side()).powi(2) as f32;
                points.within(&around, *centre, DVec3::Z, [square, square], |_, _| within += 1);
                assert!(within >= found && within < found + 3, "{within}, not {found}");
                let expected = (0..points.len()).filter(|place| near(*place)).count();
                assert_eq!(found, expected, "{radius} {most}");
            }
        }
        let far = points.nearby(DVec3::splat(-1e6), 1.0, 10);
        assert_eq!(far.count, 0);
    }

    #[test]
    fn points_at_one_place_and_no_points_are_no_trouble() {
        let (points, _) = SortedPoints::new(&vec![DVec3::splat(2.0); 1000]);
        assert_eq!(points.nearby(DVec3::splat(2.0), 1.0, 10).count, 1000);
        let (none, _) = SortedPoints::new(&[DVec3::NAN]);
        assert!(none.is_empty() && none.nearby(DVec3::ZERO, 1.0, 10).count == 0);
    }
}
