//! Four triangles at a time: which of them can a ray hit?

use glam::DVec3;
use wide::f32x4;

use super::clip::round_up;
use super::frame::Frame;

/// Triangles in a packet.
pub const LANES: usize = 4;

/// A coordinate outside every cube, for lanes without a triangle.
const NOWHERE: f32 = 1e18;

/// Four triangles in local coordinates, rounded to single precision, lane by lane.
#[derive(Clone, Debug)]
pub struct Packet {
    /// By corner, then axis.
    corners: [[f32x4; 3]; 3],
    /// Longest side of the box of each, rounded up.
    size: f32x4,
    /// Indices of the triangles.
    pub triangles: [u32; LANES],
}

impl Packet {
    /// Packs up to four triangles; `corners` gives the local coordinates of one.
    pub fn new(triangles: impl Iterator<Item = u32>, corners: impl Fn(u32) -> [DVec3; 3]) -> Self {
        let mut coordinates = [[[NOWHERE; LANES]; 3]; 3];
        let mut size = [0.0; LANES];
        let mut indices = [u32::MAX; LANES];
        for (lane, triangle) in triangles.take(LANES).enumerate() {
            let points = corners(triangle);
            for (corner, point) in points.iter().enumerate() {
                for axis in 0..3 {
                    coordinates[corner][axis][lane] = point[axis] as f32;
                }
            }
            let [a, b, c] = points;
            size[lane] = round_up((a.max(b).max(c) - a.min(b).min(c)).max_element());
            indices[lane] = triangle;
        }
        Self { corners: coordinates.map(|corner| corner.map(f32x4::new)), size: f32x4::new(size), triangles: indices }
    }

    /// The triangles that the ray may hit between the start of the frame and `limit`: one bit a lane.
    ///
    /// A lane that is left out is certainly missed, also in the double precision that decides: let e be the
    /// tolerance of the frame, by which a sheared coordinate may be off, and s the size of the triangle. If the ray
    /// meets the triangle, its sheared corners lie within 2 s of the ray, so that an edge function is off by at most
    /// 8 e s + 2 e^2, and by 12 s^2 2^-24 < 3 e s from the products.
    #[inline]
    pub fn candidates(&self, frame: &Frame, limit: f32) -> u32 {
        let [x, y, z] = frame.axes;
        let place = |corner: &[f32x4; 3]| {
            let along = (corner[z] - frame.base[2]) * frame.sign_z;
            (
                corner[x] - frame.base[0] - frame.slope_x * along,
                corner[y] - frame.base[1] - frame.slope_y * along,
                along,
            )
        };
        let (ax, ay, az) = place(&self.corners[0]);
        let (bx, by, bz) = place(&self.corners[1]);
        let (cx, cy, cz) = place(&self.corners[2]);
        let first = cx * by - cy * bx;
        let second = ax * cy - ay * cx;
        let third = bx * ay - by * ax;
        let error = (self.size + frame.tolerance) * frame.error_scale;
        let low = first.fast_min(second).fast_min(third);
        let high = first.fast_max(second).fast_max(third);
        let beside = low.simd_lt(-error) & high.simd_gt(error);
        let beyond = az.fast_min(bz).fast_min(cz).simd_gt(f32x4::splat(limit));
        let before = az.fast_max(bz).fast_max(cz).simd_lt(frame.start);
        !(beside | beyond | before).to_bitmask() & 0xf
    }
}
