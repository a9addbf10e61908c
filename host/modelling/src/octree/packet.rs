//! Packets of eight triangles, which a ray tests at a time.

use super::lanes::{Eight, LANES, Lanes};
use super::prepared_ray::SinglePrecisionRay;
use glam::DVec3;

/// Growth of the size of a triangle by rounding its corners, at the most.
const ROUNDING: f32 = 1.0 / (1_u32 << 22) as f32;

/// The place of a corner that is not there.
const NOWHERE: u8 = u8::MAX;

/// Points in a packet: eight triangles side by side have nine or ten corners, and eleven points fill ten lines of the
/// cache. One triangle in two hundred finds no room for its own.
const POINTS: usize = 11;

/// Eight triangles in local coordinates, rounded to single precision, lane by lane.
#[derive(Clone, Debug)]
pub struct Packet {
    /// By corner, then axis.
    corners: [[Eight; 3]; 3],
    /// Longest side of the box of each, rounded up; less than nothing where there is no triangle, so that it is missed.
    size: Eight,
    /// Indices of the triangles.
    pub triangles: [u32; LANES],
    /// Places of their corners among the points; none where there is no room.
    places: [[u8; 3]; LANES],
    /// Vertices in double precision, beside the triangles so that what decides comes with them.
    points: [DVec3; POINTS],
}

impl Packet {
    /// Packs up to eight of all triangles; `place` gives the local coordinates of a vertex.
    pub fn new(
        chosen: impl Iterator<Item = u32>,
        vertices: &[DVec3],
        all: &[[u32; 3]],
        place: impl Fn(u32) -> [f32; 3],
    ) -> Self {
        // Which vertices the points are.
        let (mut known, mut count) = ([u32::MAX; POINTS], 0);
        let mut packet = Self {
            corners: [[Eight([0.0; LANES]); 3]; 3],
            size: Eight([f32::NEG_INFINITY; LANES]),
            triangles: [u32::MAX; LANES],
            places: [[NOWHERE; 3]; LANES],
            points: [DVec3::ZERO; POINTS],
        };
        for (lane, triangle) in chosen.take(LANES).enumerate() {
            let corners = all[triangle as usize];
            let [a, b, c] = corners.map(&place);
            let mut size = 0.0_f32;
            for axis in 0..3 {
                for (corner, point) in [a, b, c].iter().enumerate() {
                    packet.corners[corner][axis].0[lane] = point[axis];
                }
                let low = a[axis].min(b[axis]).min(c[axis]);
                let high = a[axis].max(b[axis]).max(c[axis]);
                size = size.max(high - low);
            }
            packet.size.0[lane] = size + ROUNDING;
            packet.triangles[lane] = triangle;
            for (corner, vertex) in corners.into_iter().enumerate() {
                let at = known[..count].iter().position(|other| *other == vertex).unwrap_or(count);
                if at == count && count < POINTS {
                    known[count] = vertex;
                    packet.points[count] = vertices[vertex as usize];
                    count += 1;
                }
                packet.places[lane][corner] = if at < count { at as u8 } else { NOWHERE };
            }
        }
        packet
    }

    /// The corners of a triangle, world units, if they are here.
    #[inline(always)]
    pub fn corners(&self, lane: usize) -> Option<[DVec3; 3]> {
        let [a, b, c] = self.places[lane].map(|place| self.points.get(usize::from(place)));
        Some([*a?, *b?, *c?])
    }

    /// The triangles that the ray may hit between the start of the frame and `limit`, and for `ANY` those that it
    /// certainly hits between the lengths `within`: one bit a lane.
    ///
    /// A lane that is left out is certainly missed, also in the double precision that decides: let e be the tolerance
    /// of the frame, by which a sheared coordinate may be off, and s the size of the triangle. If the ray hits the
    /// triangle, its sheared corners lie within 2 s of the ray, so that an edge function is off by at most 8 e s + 2
    /// e^2, and by 12 s^2 2^-24 < 3 e s from the products: by less than d = 16 e (s + e) in all.
    ///
    /// The length to the triangle is the mean of those to its corners, weighted by the edge functions. With weights
    /// that are off it is off by 3 d s; their sum, which is at most 6 d more than the whole, is off by as much and
    /// their products by 2^-22 of it: together less than 8 d (s + e) + 2 e whole, after multiplication by the whole.
    #[inline(always)]
    pub fn candidates<L: Lanes, const ANY: bool>(
        &self,
        proof: L::Proof,
        frame: &SinglePrecisionRay,
        limit: f32,
        within: [f32; 2],
    ) -> (u32, u32) {
        let [a, b, c] = &self.corners;
        let ((ax, ay), (bx, by), (cx, cy)) =
            (across::<L>(proof, a, frame), across::<L>(proof, b, frame), across::<L>(proof, c, frame));
        let first = cx.times_minus(by, cy.times(bx));
        let second = ax.times_minus(cy, ay.times(cx));
        let third = bx.times_minus(ay, by.times(ax));
        let tolerance = L::splat(proof, frame.tolerance);
        let size = L::load(proof, &self.size).plus(tolerance);
        let error = size.times(L::splat(proof, frame.error_scale));
        let low = first.least(second).least(third).plus(error);
        let high = first.most(second).most(third).minus(error);
        let zero = L::splat(proof, 0.0);
        let mut lanes = zero.is_at_most(low) | high.is_at_most(zero);
        if lanes == 0 {
            return (0, 0);
        }
        let (az, bz, cz) = (along::<L>(proof, a, frame), along::<L>(proof, b, frame), along::<L>(proof, c, frame));
        let whole = first.plus(second).plus(third);
        let length = az.times(first).plus(bz.times(second)).plus(cz.times(third)).signed_by(whole);
        let whole = whole.signed_by(whole);
        let aside = tolerance.plus(tolerance).times(whole).plus(size.times(error.times(L::splat(proof, 8.0))));
        lanes &=
            length.minus(aside).is_at_most(whole.times(L::splat(proof, limit))) & zero.is_at_most(length.plus(aside));
        if !ANY {
            return (lanes, 0);
        }
        let inside = error.is_at_most(first.least(second).least(third))
            | first.most(second).most(third).plus(error).is_at_most(zero);
        let between = length.plus(aside).is_at_most(whole.times(L::splat(proof, within[1])))
            & whole.times(L::splat(proof, within[0])).is_at_most(length.minus(aside));
        (lanes, inside & between)
    }
}

/// Coordinates of corners beside the ray.
#[inline(always)]
fn across<L: Lanes>(proof: L::Proof, corners: &[Eight; 3], frame: &SinglePrecisionRay) -> (L, L) {
    let [x, y, z] = frame.axes;
    let along = L::load(proof, &corners[z]);
    let across = |axis: usize| {
        let beside = L::load(proof, &corners[axis]).minus(L::splat(proof, frame.beside[axis]));
        L::splat(proof, frame.shear[axis]).times_from(along, beside)
    };
    (across(x), across(y))
}

/// Coordinates of corners along the ray.
#[inline(always)]
fn along<L: Lanes>(proof: L::Proof, corners: &[Eight; 3], frame: &SinglePrecisionRay) -> L {
    L::load(proof, &corners[frame.axes[2]]).times_minus(L::splat(proof, frame.sign_z), L::splat(proof, frame.base_z))
}
