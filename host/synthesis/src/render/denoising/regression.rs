//! The regression at the heart of the denoiser: each pixel by a plane through the colors around it, over its features.
//!
//! How much a neighbor counts is found from another picture of the same scene with independent noise: how far the
//! patches around both are apart beyond their noise. The plane lies over albedo, normal, logarithm of the distance and
//! place: where these tell the colors apart, edges and gradients stay, however many neighbors count.

use super::plane::{LANES, PixelPlane, square};
use processes::widest::{self, Work};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::LazyLock;

/// How far neighbors are looked for, pixels to each side.
const FAR: isize = 12;
/// Up to here all neighbors are taken, beyond one of [`SPARSE`], pixels.
const NEAR: isize = 3;
const SPARSE: isize = 5;
/// Half of a patch, without its middle, pixels.
const PATCH: isize = 3;
/// Margin of the planes: what is read beyond an edge, with room for the lanes beside it.
pub(super) const MARGIN: usize = 32;
/// The side of a tile, pixels.
const TILE_WIDTH: usize = 64;
const TILE_HEIGHT: usize = 32;

/// How far patches may be apart, in their noise, so that one counts much for the other.
///
/// # Source
/// Rousselle, Knaus and Zwicker 2012, who take 0.45 for means; planes bear less: at 0.35 the errors to the eye (FLIP)
/// are least at four samples a pixel.
const BANDWIDTH: f32 = 0.35;
/// Summand of variances, of pictures whose mean is 1.
const LEAST_VARIANCE: f32 = 1e-8;
/// A neighbor counts less if its variance is more than so many times the mean over the patch: it hit rare light.
const MOST_VARIANCE: f32 = 8.0;
/// Features, beside the place.
pub(super) const FEATURES: usize = 7;
/// The ridge of each of them.
const RIDGE_OF: [usize; FEATURES] = [0, 0, 0, 1, 1, 1, 2];
/// The unit of places, and their ridge in it.
const PLACE_UNIT: f32 = 10.0;
const PLACE_RIDGE: f32 = 0.1;
/// Unknowns: a slope for each feature and both axes, and the value in the middle.
const UNKNOWNS: usize = FEATURES + 3;

/// The neighbors that are taken, from row to row.
static NEIGHBORS: LazyLock<Vec<[isize; 2]>> = LazyLock::new(|| {
    let all = (-FAR..=FAR).flat_map(|y| (-FAR..=FAR).map(move |x| [x, y]));
    all.filter(|[x, y]| x.abs().max(y.abs()) <= NEAR || (x + 2 * y).rem_euclid(SPARSE) == 0).collect()
});

/// A plane for each band.
pub(super) type RgbPlanes = [PixelPlane; 3];

/// A picture with its noise.
pub(super) struct NoisyPicture {
    pub(super) bands: RgbPlanes,
    /// The variance in each.
    pub(super) variances: RgbPlanes,
    /// The greatest variance with which a neighbor of each pixel counts in full, and one over that of each pixel; as
    /// means over the bands.
    reliable: [PixelPlane; 2],
}

impl NoisyPicture {
    /// - `bands`: of a picture whose mean is 1. `variances`: in each of them.
    pub(super) fn new(bands: RgbPlanes, variances: RgbPlanes) -> NoisyPicture {
        let size = [bands[0].width, bands[0].height];
        let mean = |pixel: usize| variances.iter().map(|band| band.of(pixel)).sum::<f32>() / 3.0 + LEAST_VARIANCE;
        let over = PixelPlane::new(size, MARGIN, |pixel| 1.0 / mean(pixel));
        let around = PixelPlane::new(size, 0, mean).convolved(&square(PATCH as usize));
        let most = PixelPlane::new(size, MARGIN, |pixel| MOST_VARIANCE * around.of(pixel));
        NoisyPicture { bands, variances, reliable: [most, over] }
    }
}

/// Planes of the features: albedo in three bands, the normal along three axes, and the logarithm of the distance; and
/// the ridge of each of the three, which is greater where it is noisy itself.
pub(super) struct FeaturePlanes {
    pub(super) values: [PixelPlane; FEATURES],
    pub(super) ridges: [PixelPlane; 3],
}

/// A picture, of which each pixel is found by those around it.
///
/// - `other`: of the same scene, with independent noise; it tells how much neighbors count.
/// - `quiet`: which pixels have no noise to speak of. Where all of some pixels in a row are quiet, they stay as they
///   are, and nothing is computed.
/// - `is_cancelled`: asked from time to time; what is left then stays as it was.
pub(super) fn filtered(
    picture: &NoisyPicture,
    other: &NoisyPicture,
    features: &FeaturePlanes,
    quiet: &[bool],
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> RgbPlanes {
    let [width, height] = [picture.bands[0].width, picture.bands[0].height];
    let mut rows: Vec<[f32; 3]> = vec![[0.0; 3]; width * height];
    let room = || vec![[0.0; LANES]; NEIGHBORS.len() * TILE_HEIGHT * TILE_WIDTH / LANES];
    rows.par_chunks_mut(TILE_HEIGHT * width).enumerate().for_each_init(room, |weights, (row, pixels)| {
        let first = row * TILE_HEIGHT * width;
        let quiet = &quiet[first..][..pixels.len()];
        for (pixel, place) in pixels.iter_mut().enumerate() {
            *place = [0, 1, 2].map(|band| picture.bands[band].of(first + pixel));
        }
        for x in (0..width).step_by(TILE_WIDTH) {
            let columns = x..width.min(x + TILE_WIDTH);
            let Some([columns, rows]) = noisy_part(quiet, width, columns) else { continue };
            if !is_cancelled() {
                let from = rows.start * width;
                let (quiet, pixels) = (&quiet[from..], &mut pixels[from..]);
                let at = [columns.start, row * TILE_HEIGHT + rows.start];
                let size = [columns.len(), rows.len()];
                widest::run(Filtering { picture, other, features, quiet, at, size, weights, pixels });
            }
        }
    });
    [0, 1, 2].map(|band| PixelPlane::new([width, height], 0, |pixel| rows[pixel][band]))
}

/// The least rectangle of columns and rows that holds all noisy pixels of a tile; none if all are quiet.
///
/// - `quiet`: of rows of a picture. `width`: of these. `columns`: of the tile.
fn noisy_part(quiet: &[bool], width: usize, columns: Range<usize>) -> Option<[Range<usize>; 2]> {
    let is_noisy = |row: usize, column: usize| !quiet[row * width + column];
    let rows = 0..quiet.len() / width;
    let hull = |noisy: &mut dyn DoubleEndedIterator<Item = usize>| {
        let first = noisy.next()?;
        Some(first..noisy.next_back().unwrap_or(first) + 1)
    };
    let of_rows = hull(&mut rows.clone().filter(|row| columns.clone().any(|column| is_noisy(*row, column))))?;
    let of_columns = hull(&mut columns.clone().filter(|column| of_rows.clone().any(|row| is_noisy(row, *column))))?;
    Some([of_columns, of_rows])
}

/// One number for each of some pixels in a row.
#[derive(Clone, Copy)]
struct Lanes([f32; LANES]);

impl Lanes {
    #[inline(always)]
    fn splat(value: f32) -> Lanes {
        Lanes([value; LANES])
    }

    /// The numbers of a row, from a place on.
    #[inline(always)]
    fn read(values: &[f32], place: usize) -> Lanes {
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&values[place..place + LANES]);
        Lanes(lanes)
    }

    #[inline(always)]
    fn each(self, other: Lanes, of: impl Fn(f32, f32) -> f32) -> Lanes {
        let mut result = self.0;
        for (a, b) in result.iter_mut().zip(other.0) {
            *a = of(*a, b);
        }
        Lanes(result)
    }

    /// The product with another, and a third is added.
    #[inline(always)]
    fn times_plus(self, factor: Lanes, sum: Lanes) -> Lanes {
        let mut result = self.0;
        for ((a, b), c) in result.iter_mut().zip(factor.0).zip(sum.0) {
            *a = a.mul_add(b, c);
        }
        Lanes(result)
    }

    #[inline(always)]
    fn times(self, factor: Lanes) -> Lanes {
        self.each(factor, |a, b| a * b)
    }

    #[inline(always)]
    fn plus(self, other: Lanes) -> Lanes {
        self.each(other, |a, b| a + b)
    }

    #[inline(always)]
    fn minus(self, other: Lanes) -> Lanes {
        self.each(other, |a, b| a - b)
    }
}

/// Filters a tile.
struct Filtering<'a> {
    picture: &'a NoisyPicture,
    other: &'a NoisyPicture,
    features: &'a FeaturePlanes,
    /// Whether each pixel of the rows is quiet.
    quiet: &'a [bool],
    /// Its first column and row.
    at: [usize; 2],
    /// Its columns and rows.
    size: [usize; 2],
    /// Room for the weights of each neighbor, for all lanes of the tile.
    weights: &'a mut [[f32; LANES]],
    /// The rows of the picture in which the tile is.
    pixels: &'a mut [[f32; 3]],
}

impl Work for Filtering<'_> {
    #[inline(always)]
    fn run(self) {
        let Filtering { picture, other, features, quiet, at, size: [columns, rows], weights, pixels } = self;
        let groups = columns.div_ceil(LANES);
        let width = picture.bands[0].width;
        let each = groups * rows;
        for (neighbor, weights) in NEIGHBORS.iter().zip(weights.chunks_exact_mut(each)) {
            weigh(other, at, [groups, rows], *neighbor, weights);
        }
        for row in 0..rows {
            for group in 0..groups {
                let first = row * width + at[0] + group * LANES;
                let lanes = first..first + LANES.min(columns - group * LANES);
                if quiet[lanes.clone()].iter().all(|quiet| *quiet) {
                    continue;
                }
                let place = [(at[0] + group * LANES) as isize, (at[1] + row) as isize];
                let own = &weights[row * groups + group..];
                let found = fit(picture, features, place, own, each);
                for (lane, pixel) in pixels[lanes].iter_mut().enumerate() {
                    *pixel = found.map(|band| band.0[lane]);
                }
            }
        }
    }
}

/// How much a neighbor counts for each pixel of a tile: less the farther the patches around both are apart, beyond
/// their noise.
///
/// # Source
/// Rousselle, Knaus and Zwicker 2012, the dual-buffer non-local means.
#[inline(always)]
fn weigh(
    picture: &NoisyPicture,
    at: [usize; 2],
    [groups, rows]: [usize; 2],
    [dx, dy]: [isize; 2],
    weights: &mut [[f32; LANES]],
) {
    const STRIDE: usize = TILE_WIDTH + LANES;
    const ROWS: usize = TILE_HEIGHT + 2 * PATCH as usize;
    let [x0, y0] = at.map(|at| at as isize);
    let (width, height) = (picture.bands[0].width as isize, picture.bands[0].height as isize);
    let mut apart = [0.0f32; STRIDE * ROWS];
    let bands = picture.bands.each_ref().map(PixelPlane::values);
    let variances = picture.variances.each_ref().map(PixelPlane::values);
    for row in 0..rows + 2 * PATCH as usize {
        let first = picture.bands[0].place(x0 - PATCH, y0 - PATCH + row as isize);
        for group in 0..=groups {
            let here = first + group * LANES;
            let beside = here.wrapping_add_signed(picture.bands[0].step(dx, dy));
            let mut sum = Lanes::splat(0.0);
            for (band, variance) in bands.into_iter().zip(variances) {
                let (one, two) = (Lanes::read(band, here), Lanes::read(band, beside));
                let (own, there) = (Lanes::read(variance, here), Lanes::read(variance, beside));
                let difference = one.minus(two);
                let noise = own.each(there, |own, there| own + own.min(there));
                let scale = own
                    .each(there, |own, there| reciprocal((BANDWIDTH * BANDWIDTH).mul_add(own + there, LEAST_VARIANCE)));
                sum = difference.times_plus(difference, Lanes::splat(0.0)).minus(noise).times_plus(scale, sum);
            }
            apart[row * STRIDE + group * LANES..][..LANES].copy_from_slice(&sum.0);
        }
    }
    let patch = 2 * PATCH as usize + 1;
    let mean = 1.0 / (3 * patch * patch) as f32;
    let [most, over] = picture.reliable.each_ref().map(PixelPlane::values);
    let mut down = [0.0f32; STRIDE];
    for row in 0..rows {
        let is_outside = !(0..height).contains(&(y0 + row as isize + dy));
        for group in 0..=groups {
            let mut sum = Lanes::splat(0.0);
            for line in row..row + patch {
                sum = sum.plus(Lanes::read(&apart, line * STRIDE + group * LANES));
            }
            down[group * LANES..][..LANES].copy_from_slice(&sum.0);
        }
        for group in 0..groups {
            let mut sum = Lanes::splat(0.0);
            for column in 0..patch {
                sum = sum.plus(Lanes::read(&down, group * LANES + column));
            }
            let here = picture.bands[0].place(x0 + (group * LANES) as isize, y0 + row as isize);
            let beside = here.wrapping_add_signed(picture.bands[0].step(dx, dy));
            let reliable = Lanes::read(most, here).each(Lanes::read(over, beside), |most, over| (most * over).min(1.0));
            let mut weight = sum.each(reliable, |sum, reliable| reliable * falling(sum * mean)).0;
            let first = x0 + (group * LANES) as isize + dx;
            if is_outside || first < 0 || first + LANES as isize > width {
                for (lane, weight) in weight.iter_mut().enumerate() {
                    if is_outside || !(0..width).contains(&(first + lane as isize)) {
                        *weight = 0.0;
                    }
                }
            }
            weights[row * groups + group] = weight;
        }
    }
}

/// One over a positive number, within a few parts in a hundred thousand.
#[inline(always)]
fn reciprocal(x: f32) -> f32 {
    let guess = f32::from_bits(0x7ef3_11c3u32.wrapping_sub(x.to_bits()));
    let better = guess * (2.0 - x * guess);
    better * (2.0 - x * better)
}

/// exp(-x), and 1 for x below 0; within a hundred-thousandth part of it, and at least 2^-100.
#[inline(always)]
fn falling(x: f32) -> f32 {
    /// Adding it leaves the integer nearest to a number in its last bits.
    const ROUNDS: f32 = 12_582_912.0;
    let exponent = (-std::f32::consts::LOG2_E * x).clamp(-100.0, 0.0);
    let rounded = exponent + ROUNDS;
    let rest = exponent - (rounded - ROUNDS);
    let terms = [1.339_887_4e-3, 9.618_437e-3, 5.550_332_5e-2, 2.402_264_8e-1, 6.931_472e-1, 1.0];
    let power = terms.into_iter().fold(0.0f32, |sum, term| sum.mul_add(rest, term));
    f32::from_bits(power.to_bits().wrapping_add(rounded.to_bits() << 23))
}

/// Sums up rows of normal equations: `row: columns` for each. Written out, so that sums stay in registers.
macro_rules! normal_equations {
    (
        $regression:ident, $plane:ident, $place:ident, $weights:ident, $step:ident, $matrix:ident, $right:ident;
        $($row:literal: $($column:literal)*);*
    ) => { $({
        let mut sums = [Lanes::splat(0.0); $row + 1];
        let mut bands = [Lanes::splat(0.0); 3];
        for (neighbor, &[dx, dy]) in NEIGHBORS.iter().enumerate() {
            let beside = $place.wrapping_add_signed($plane.step(dx, dy));
            let weight = Lanes($weights[neighbor * $step]);
            let weighted = weight.times($regression.apart::<$row>(beside, dx, dy));
            $( sums[$column] = weighted.times_plus($regression.apart::<$column>(beside, dx, dy), sums[$column]); )*
            bands[0] = weighted.times_plus(Lanes::read($regression.bands[0], beside), bands[0]);
            bands[1] = weighted.times_plus(Lanes::read($regression.bands[1], beside), bands[1]);
            bands[2] = weighted.times_plus(Lanes::read($regression.bands[2], beside), bands[2]);
        }
        $( $matrix[$row][$column] = sums[$column]; )*
        $right[$row] = bands;
    })* };
}

/// The values of planes that fit best, in the middle of each of some pixels in a row; none below 0.
///
/// - `weights`: of the first neighbor, and each `step` later those of the next.
///
/// # Source
/// Bitterli and others 2016, nonlinearly weighted first-order regression.
#[inline(always)]
fn fit(
    picture: &NoisyPicture,
    features: &FeaturePlanes,
    place: [isize; 2],
    weights: &[[f32; LANES]],
    step: usize,
) -> [Lanes; 3] {
    let plane = &picture.bands[0];
    let place = plane.place(place[0], place[1]);
    let values = features.values.each_ref().map(PixelPlane::values);
    let middle = values.map(|values| Lanes::read(values, place));
    let regression = Regression { bands: picture.bands.each_ref().map(PixelPlane::values), values, middle };
    let mut matrix = [[Lanes::splat(0.0); UNKNOWNS]; UNKNOWNS];
    let mut right = [[Lanes::splat(0.0); 3]; UNKNOWNS];
    normal_equations!(regression, plane, place, weights, step, matrix, right;
        0: 0; 1: 0 1; 2: 0 1 2; 3: 0 1 2 3; 4: 0 1 2 3 4; 5: 0 1 2 3 4 5; 6: 0 1 2 3 4 5 6; 7: 0 1 2 3 4 5 6 7;
        8: 0 1 2 3 4 5 6 7 8; 9: 0 1 2 3 4 5 6 7 8 9);
    let count = matrix[UNKNOWNS - 1][UNKNOWNS - 1];
    for (unknown, row) in matrix.iter_mut().enumerate().take(UNKNOWNS - 1) {
        let ridge = match RIDGE_OF.get(unknown) {
            Some(ridge) => Lanes::read(features.ridges[*ridge].values(), place),
            None => Lanes::splat(PLACE_RIDGE),
        };
        row[unknown] = ridge.times_plus(count, row[unknown]);
    }
    // By Cholesky. The value in the middle is the last unknown: it is known as soon as the others are eliminated.
    for row in 0..UNKNOWNS {
        for column in 0..=row {
            let products = matrix[row].iter().zip(&matrix[column]).take(column);
            let sum = products.fold(matrix[row][column], |sum, (a, b)| sum.minus(a.times(*b)));
            matrix[row][column] = match row == column {
                // The reciprocal of the diagonal.
                true => sum.each(sum, |sum, _| 1.0 / sum.max(1e-20).sqrt()),
                false => sum.times(matrix[column][column]),
            };
        }
        let (known, unknown) = right.split_at_mut(row);
        for (band, value) in unknown[0].iter_mut().enumerate() {
            let products = matrix[row].iter().zip(known.iter());
            let sum = products.fold(*value, |sum, (a, b)| sum.minus(a.times(b[band])));
            *value = sum.times(matrix[row][row]);
        }
    }
    let last = UNKNOWNS - 1;
    right[last].map(|band| band.times(matrix[last][last]).each(band, |value, _| value.max(0.0)))
}

/// The regression of some pixels in a row: what its normal equations are summed up of.
struct Regression<'a> {
    bands: [&'a [f32]; 3],
    /// The features.
    values: [&'a [f32]; FEATURES],
    /// The features in the middle.
    middle: [Lanes; FEATURES],
}

impl Regression<'_> {
    /// How far a neighbor is from the middle in what an unknown is the slope of; 1 for the value itself.
    ///
    /// - `beside`: where the neighbors begin. `dx`, `dy`: columns and rows to them.
    #[inline(always)]
    fn apart<const UNKNOWN: usize>(&self, beside: usize, dx: isize, dy: isize) -> Lanes {
        match UNKNOWN {
            0..FEATURES => Lanes::read(self.values[UNKNOWN], beside).minus(self.middle[UNKNOWN]),
            7 => Lanes::splat(dx as f32 / PLACE_UNIT),
            8 => Lanes::splat(dy as f32 / PLACE_UNIT),
            _ => Lanes::splat(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array::from_fn;

    #[test]
    fn approximations_are_as_near_as_they_say() {
        for step in 0..4000 {
            let x = step as f32 * 0.02;
            assert!((falling(x) - (-x).exp()).abs() <= 1e-5 * (-x).exp() + 1e-30, "{x}");
            let x = 1e-8 * 1.01f32.powi(step);
            assert!((reciprocal(x) * x - 1.0).abs() < 5e-5, "{x}");
        }
        assert_eq!(falling(-3.0), 1.0);
    }

    #[test]
    fn wide_and_plain_instructions_give_the_same_bits() {
        let size = [70, 40];
        let mut seed = 1u32;
        let noise: Vec<f32> = (0..size[0] * size[1] * 16)
            .map(|_| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 8) as f32 / 16_777_216.0
            })
            .collect();
        let plane = |number: usize, least: f32| {
            PixelPlane::new(size, MARGIN, |pixel| least + noise[number * size[0] * size[1] + pixel])
        };
        let noisy = |first: usize| {
            let plane = |number: usize, least: f32| plane(first + number, least);
            let variances = [0; 3].map(|_| PixelPlane::new(size, MARGIN, |_| 0.08));
            NoisyPicture::new([plane(0, 0.5), plane(1, 0.5), plane(2, 0.5)], variances)
        };
        let (picture, other) = (noisy(0), noisy(3));
        let features = FeaturePlanes {
            values: from_fn(|features| plane(6 + features, 0.0)),
            ridges: [0; 3].map(|_| PixelPlane::new(size, MARGIN, |_| 1e-3)),
        };
        let by = |way: &dyn Fn(Filtering<'_>)| {
            let mut weights = vec![[0.0; LANES]; NEIGHBORS.len() * TILE_HEIGHT * TILE_WIDTH / LANES];
            let mut pixels = vec![[0.0; 3]; size[0] * TILE_HEIGHT];
            way(Filtering {
                picture: &picture,
                other: &other,
                features: &features,
                quiet: &vec![false; size[0] * TILE_HEIGHT],
                at: [64, 0],
                size: [6, TILE_HEIGHT],
                weights: &mut weights,
                pixels: &mut pixels,
            });
            pixels
        };
        let first = by(&|work| widest::run(work));
        assert!(first[64].iter().all(|value| *value > 0.0));
        for way in 0..widest::ways::<Filtering<'_>>().len() {
            assert_eq!(by(&|work| widest::ways()[way](work)), first);
        }
    }
}
