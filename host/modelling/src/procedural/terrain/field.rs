//! A height field: a function of height over a rectangle of the plane.

use super::enclosure::Enclosure;
use super::error::TerrainError;
use super::form::Disc;
use super::function::{HeightFunction, PreparedHeights};
use super::point::PointHeight;
use crate::numeric::bounds::Bounds;
use glam::{DVec2, DVec3};

/// Sides of the rectangle may be this long, units of length.
const MOST_REACH: f64 = 1e12;

/// The surface y = h(x, z) over a rectangle, a function that is stored nowhere.
///
/// Heights are known at every place to every octave, with rigorous bounds over discs: that is what rays and triangles
/// are found by. All answers depend on the function and the arguments alone. A footprint is the width of what is seen
/// as one; octaves whose cells are smaller are left out, those of about its size in part, with a continuous slope. 0
/// leaves nothing out.
#[derive(Clone, Debug)]
pub struct HeightField {
    function: PreparedHeights,
    region: [DVec2; 2],
    heights: [f64; 2],
}

impl HeightField {
    /// A height field over a rectangle.
    ///
    /// - `region`: its least and its greatest x and z, up to 1e12 from the origin.
    ///
    /// # Errors
    /// [`TerrainError`] for numbers out of range, an octave too fine for doubles, heights that overflow.
    pub fn new(function: &HeightFunction, region: [DVec2; 2]) -> Result<HeightField, TerrainError> {
        let reach = region[0].abs().max(region[1].abs()).max_element();
        let is_region = reach <= MOST_REACH && region[0].cmplt(region[1]).all() && !region[0].is_nan();
        if !is_region {
            return Err(TerrainError::Region);
        }
        let function = function.prepare(reach, 0)?;
        let all: Enclosure = function.heights(&Disc::everywhere(), 0.0);
        let [low, high] = all.range();
        // A little more, so that rays are seen on both sides even of a plane.
        let margin = (1e-6 * low.abs().max(high.abs())).max(1e-9);
        let heights = [low - margin, high + margin];
        if !(heights[0].is_finite() && heights[1].is_finite() && all.slope_error.is_finite()) {
            return Err(TerrainError::NotFinite);
        }
        Ok(HeightField { function, region, heights })
    }

    /// The least and the greatest x and z.
    pub fn region(&self) -> [DVec2; 2] {
        self.region
    }

    /// Holds the surface, at every footprint.
    pub fn bounds(&self) -> Bounds {
        let [low, high] = self.heights;
        let [from, to] = self.region;
        Bounds { min: DVec3::new(from.x, low, from.y), max: DVec3::new(to.x, high, to.y) }
    }

    /// The height at a place, units of length.
    pub fn height(&self, at: DVec2, footprint: f64) -> f64 {
        self.function.heights::<PointHeight>(&at, footprint).0
    }

    /// The derivatives of the height by x and z.
    pub fn slope(&self, at: DVec2, footprint: f64) -> DVec2 {
        self.enclosure(at, 0.0, footprint).slope
    }

    /// The unit normal above a place, which points up.
    pub fn normal(&self, at: DVec2, footprint: f64) -> DVec3 {
        normal_of(self.slope(at, footprint))
    }

    /// The height over a disc, between two parallel planes; they bound what is exact and what doubles make of it.
    ///
    /// - `radius`: of the disc, 0 and more.
    #[inline]
    pub fn enclosure(&self, at: DVec2, radius: f64, footprint: f64) -> Enclosure {
        self.function.heights(&Disc::new(at, radius), footprint)
    }

    /// The function.
    pub(super) fn function(&self) -> &PreparedHeights {
        &self.function
    }

    /// A lattice of this spacing shows whatever there is, however coarsely; infinite where there is nothing.
    pub(super) fn coarsest_spacing(&self) -> f64 {
        1.0 / self.function.coarsest()
    }

    /// Length of the finest cells, of noise or of a grid; infinite where there are none.
    pub(super) fn finest_cell(&self) -> f64 {
        1.0 / self.function.finest()
    }
}

/// The unit normal that points up, of a slope along x and z.
pub(super) fn normal_of(slope: DVec2) -> DVec3 {
    DVec3::new(-slope.x, 1.0, -slope.y).normalize()
}
