//! A rock: a Voronoi cell whose edges are worn, with bumps of all sizes.

use crate::numeric::noise::octaves;
use crate::numeric::sampling::{RandomStream, mix, sphere};
use crate::procedural::{Varied, VariedError, channel};
use glam::DVec3;

/// The exponent of a rock whose edges are as sharp as can be, and of the roundest one.
const EXPONENTS: [f64; 2] = [80.0, 2.0];
/// Most planes.
const MOST_PLANES: f64 = 200.0;
/// Least distance of neighbours in a cloud of them, in parts of how many there are: their cells have no slivers.
const SPREAD: f64 = 0.6;
/// Draws of a neighbour until it is far enough from the others.
const TRIES: u32 = 30;

/// The numbers of rocks: means with largest deviations, drawn for each rock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RockNumbers {
    /// Its widths along x, y and z, units of length, above 0.
    pub size: [Varied; 3],
    /// How many planes cut it, 4 to 200.
    pub planes: Varied,
    /// How far its edges are worn: 0 sharp, 1 a pebble.
    pub wear: Varied,
    /// Height of its largest bumps, in parts of its size, 0 to 0.5.
    pub roughness: Varied,
    /// Size of its largest bumps, in parts of its size, above 0.
    pub grain: Varied,
}

/// A reason for which numbers are those of no rock.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RockError {
    /// Some of what may be drawn is out of range.
    #[error("{name} {least} to {most} is not within {low} to {high}")]
    Range {
        /// The number.
        name: &'static str,
        /// The least that may be drawn.
        least: f64,
        /// The most that may be drawn.
        most: f64,
        /// The least that it may be.
        low: f64,
        /// The most that it may be.
        high: f64,
    },
    /// A mean or a deviation that is none.
    #[error("{name}: {problem}")]
    Varied {
        /// The number.
        name: &'static str,
        /// What is wrong.
        problem: VariedError,
    },
}

impl RockNumbers {
    /// The numbers with their names and ranges.
    fn rows(&self) -> [(&'static str, Varied, [f64; 2]); 7] {
        const LENGTH: [f64; 2] = [1e-9, 1e9];
        [
            ("size along x", self.size[0], LENGTH),
            ("size along y", self.size[1], LENGTH),
            ("size along z", self.size[2], LENGTH),
            ("planes", self.planes, [4.0, MOST_PLANES]),
            ("wear", self.wear, [0.0, 1.0]),
            ("roughness", self.roughness, [0.0, 0.5]),
            ("grain", self.grain, [1e-3, 10.0]),
        ]
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first [`RockError`].
    pub fn check(&self) -> Result<(), RockError> {
        for (name, varied, [low, high]) in self.rows() {
            varied.check().map_err(|problem| RockError::Varied { name, problem })?;
            let [least, most] = [varied.mean - varied.deviation, varied.mean + varied.deviation];
            if least < low || most > high {
                return Err(RockError::Range { name, least, most, low, high });
            }
        }
        Ok(())
    }
}

/// A rock around the origin.
///
/// Seen from its middle its surface is, in a direction u,
///
/// r(u) = (sum of max(0, n_i·u / d_i)^p)^(-1/p) (1 + h b(u))
///
/// with the planes n_i·x = d_i of the Voronoi cell of the middle among neighbours by chance: for a large p it is this cell,
/// and the smaller p, the rounder are its edges and corners. b is noise of several octaves on the surface.
///
/// # Source
/// Ours; cells after Voronoi 1908, the sum of powers as in superquadrics (Barr 1981).
#[derive(Clone, Debug)]
pub struct Rock {
    planes: Vec<(DVec3, f64)>,
    exponent: f64,
    roughness: f64,
    grain: f64,
    half: DVec3,
    shift: DVec3,
}

impl Rock {
    /// One of the rocks of some numbers.
    ///
    /// # Errors
    /// [`RockError`].
    pub fn new(numbers: &RockNumbers, seed: u32) -> Result<Rock, RockError> {
        numbers.check()?;
        let drawn = numbers.rows().map(|(name, varied, _)| varied.draw(seed, channel(name)));
        let [x, y, z, count, wear, roughness, grain] = drawn;
        let count = count.round() as u32;
        let mut random = RandomStream::new(mix(u64::from(seed)), channel("planes of a rock"));
        let apart = SPREAD * (16.0 / f64::from(count)).sqrt();
        let mut planes: Vec<(DVec3, f64)> = Vec::with_capacity(count as usize);
        for _ in 0..count {
            let mut normal = sphere(random.point());
            for _ in 0..TRIES {
                if planes.iter().all(|(other, _)| other.distance(normal) > apart) {
                    break;
                }
                normal = sphere(random.point());
            }
            // Half as far as the neighbour is.
            planes.push((normal, 0.72 + 0.28 * random.uniform()));
        }
        let [sharp, round] = EXPONENTS;
        let exponent = sharp * (round / sharp).powf(wear);
        let shift = DVec3::new(random.uniform(), random.uniform(), random.uniform()) * 1000.0;
        let mut rock = Rock { planes, exponent, roughness, grain, half: DVec3::ONE, shift };
        // As wide along each axis as was asked for.
        let [mut least, mut most] = [DVec3::MAX, DVec3::MIN];
        for point in directions(2_000) {
            let at = point * rock.smooth(point);
            (least, most) = (least.min(at), most.max(at));
        }
        rock.half = DVec3::new(x, y, z) / (most - least);
        Ok(rock)
    }

    /// The distance of the surface without bumps in a direction from the middle, before it is stretched.
    fn smooth(&self, direction: DVec3) -> f64 {
        let sum: f64 = self
            .planes
            .iter()
            .map(|(normal, distance)| (normal.dot(direction) / distance).max(0.0).powf(self.exponent))
            .sum();
        // Where no plane is ahead, a ball ends it.
        (sum + FAR.powf(-self.exponent)).powf(-self.exponent.recip())
    }

    /// The surface in a direction.
    ///
    /// - `direction`: unit length, before the rock is stretched to its size.
    /// - `footprint`: bumps that are smaller are left out, units of length.
    pub fn at(&self, direction: DVec3, footprint: f64) -> DVec3 {
        let smooth = direction * self.smooth(direction);
        let width = footprint / (self.half.max_element() * 2.0 * self.grain);
        let bump = octaves(smooth / (2.0 * self.grain) + self.shift, OCTAVES, width);
        smooth * (1.0 + self.roughness * bump) * self.half
    }

    /// The largest distance between two of its points, about, units of length.
    pub fn diameter(&self) -> f64 {
        2.0 * FAR * self.half.max_element()
    }

    /// A box around it, whatever its bumps.
    pub fn half_box(&self) -> DVec3 {
        self.half * (FAR * (1.0 + 2.0 * self.roughness))
    }
}

/// The farthest that a rock reaches from its middle, before it is stretched.
const FAR: f64 = 1.5;
/// Sizes of bumps.
const OCTAVES: u32 = 12;

/// Directions spread evenly: a spiral.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |k| {
        let y = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * cos, y, r * sin)
    })
}
