//! The part of a triangle that lies in a cell.

use glam::DVec3;

/// How far a cell reaches beyond its sides when it collects triangles, in sides of the modelling cube.
///
/// Two roundings can put a ray into a cell while its triangle is in the next one: that of the corners of a clipped
/// polygon, below 2^-49 of the cube after six cuts, and that of a point on the ray, below 2^-50 (1 + |origin|) in
/// cubes. The bound covers both for rays that start within 2^12 cubes, and is 2^-15 of the smallest voxel.
pub const FAT: f64 = 1.0 / (1_u64 << 36) as f64;

/// Three corners, and one more for each of the six cuts.
const MOST_CORNERS: usize = 9;

/// A box in local coordinates, rounded outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalBounds {
    /// Lowest corner.
    pub low: [f32; 3],
    /// Highest corner.
    pub high: [f32; 3],
}

impl LocalBounds {
    /// The box of points, rounded outwards.
    pub fn of(points: &[[f64; 3]]) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for p in points {
            for axis in 0..3 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        Self { low: low.map(round_down), high: high.map(round_up) }
    }

    /// Half the surface; proportional to the share of random lines that hit the box.
    pub fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| (self.high[axis] - self.low[axis]).max(0.0));
        x * y + y * z + z * x
    }
}

/// The largest single-precision number not above a number.
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The smallest single-precision number not below a number.
fn round_up(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}

/// Bounds of the part of a triangle that lies in a cell with [`FAT`] around it.
///
/// - `corners`: local coordinates.
/// - `low`, `high`: the cell without the fat, local coordinates.
/// - Returns `None` if they have no point in common.
///
/// # Source
/// Sutherland and Hodgman 1974.
pub fn clipped_bounds(corners: [DVec3; 3], low: [f64; 3], high: [f64; 3]) -> Option<LocalBounds> {
    let (polygon, count) = clipped(corners, low, high);
    (count > 0).then(|| LocalBounds::of(&polygon[..count]))
}

/// The part of a triangle that lies in a cell with [`FAT`] around it: a convex polygon, and its number of corners.
///
/// - `corners`, `low`, `high`: as for [`clipped_bounds`].
pub fn clipped(corners: [DVec3; 3], low: [f64; 3], high: [f64; 3]) -> ([[f64; 3]; MOST_CORNERS], usize) {
    let mut polygon = [[0.0; 3]; MOST_CORNERS];
    for (to, from) in polygon.iter_mut().zip(corners) {
        *to = from.to_array();
    }
    let mut count = 3;
    for axis in 0..3 {
        count = cut(&mut polygon, count, axis, 1.0, low[axis] - FAT);
        count = cut(&mut polygon, count, axis, -1.0, high[axis] + FAT);
    }
    (polygon, count)
}

/// Keeps what has `sign (x - plane) >= 0` of a polygon; returns its number of corners.
fn cut(polygon: &mut [[f64; 3]; MOST_CORNERS], count: usize, axis: usize, sign: f64, plane: f64) -> usize {
    if polygon[..count].iter().all(|p| (p[axis] - plane) * sign >= 0.0) {
        return count;
    }
    let source = *polygon;
    let mut kept = 0;
    for i in 0..count {
        let (p, q) = (source[i], source[if i + 1 == count { 0 } else { i + 1 }]);
        let (p_in, q_in) = ((p[axis] - plane) * sign >= 0.0, (q[axis] - plane) * sign >= 0.0);
        if p_in && kept < MOST_CORNERS {
            polygon[kept] = p;
            kept += 1;
        }
        if p_in != q_in && kept < MOST_CORNERS {
            let share = (plane - p[axis]) / (q[axis] - p[axis]);
            let mut point = [0, 1, 2].map(|k| p[k] + (q[k] - p[k]) * share);
            point[axis] = plane;
            polygon[kept] = point;
            kept += 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_cut_to_its_part_in_the_cell() {
        let corners = [DVec3::new(-1.0, 0.25, 0.5), DVec3::new(2.0, 0.25, 0.5), DVec3::new(0.5, 2.0, 0.5)];
        let bounds = clipped_bounds(corners, [0.0; 3], [0.5; 3]).expect("they meet");
        assert!(bounds.low[0] <= 0.0 && bounds.low[0] > -1e-6 && bounds.high[0] >= 0.5 && bounds.high[0] < 0.500001);
        assert_eq!((bounds.low[1], bounds.low[2]), (0.25, 0.5));
        // The cell reaches above the slanted side only at x beyond it.
        assert!(clipped_bounds(corners, [-1.0, 1.9, 0.0], [-0.5, 2.0, 1.0]).is_none());
    }

    #[test]
    fn a_triangle_in_a_face_belongs_to_both_cells() {
        let corners = [DVec3::new(0.25, 0.1, 0.5), DVec3::new(0.4, 0.1, 0.5), DVec3::new(0.25, 0.2, 0.5)];
        for (low, high) in [([0.0; 3], [0.5; 3]), ([0.0, 0.0, 0.5], [0.5, 0.5, 1.0])] {
            assert!(clipped_bounds(corners, low, high).is_some());
        }
    }
}
