//! The inside test: on which side of a closed surface a point lies, exactly.

use glam::{DVec2, DVec3};
use robust::{Coord3D, orient3d};

use super::cube::Cube;
use super::{Location, LocationalCode, MAX_DEPTH, Octree, TriangleBvh};
use crate::numeric::bounds::Bounds;
use crate::numeric::predicates::turn;

/// On which side of a closed surface a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Containment {
    /// The surface winds around it.
    Inside,
    /// The surface does not wind around it.
    Outside,
    /// It lies in a triangle, its edges and corners included.
    Surface,
}

impl Octree {
    /// Says on which side of the surface a point lies; the surface must be closed and consistently oriented.
    ///
    /// Tests the cells that a ray along x hits, by binary search. All signs are exact; the ray is thought to be moved a
    /// little along y and much less along z, so that it hits neither edge nor corner. Triangles without an area are not
    /// tested.
    ///
    /// - Returns [`Containment::Outside`] for a point that is not finite, and [`Containment::Inside`] wherever the
    ///   surface winds around the point, however often and in whichever direction.
    pub fn containment(&self, point: DVec3) -> Containment {
        let Some(mut voxel) = self.cube.voxel(point) else { return Containment::Outside };
        let mut ahead = Vec::new();
        loop {
            let (cell, leaf) = match self.locate_leaf(LocationalCode::containing(voxel, MAX_DEPTH)) {
                Ok(leaf) => (self.leaves().codes[leaf], Some(leaf)),
                Err(Location::Empty { code, .. }) => (code, None),
                Err(_) => break,
            };
            ahead.extend(leaf.map_or(&[][..], |leaf| self.leaves().of(leaf)));
            voxel[0] = cell.corner()[0] + cell.side();
            if voxel[0] >= 1 << MAX_DEPTH {
                break;
            }
        }
        ahead.sort_unstable();
        ahead.dedup();
        let corners = |&triangle: &u32| self.triangles[triangle as usize].map(|i| self.vertices[i as usize]);
        containment(point, ahead.iter().map(corners), self.cube.side.recip())
    }
}

impl TriangleBvh {
    /// Says on which side of the triangles a point lies, as [`Octree::containment`] does.
    ///
    /// - `corners`: the corners of a triangle.
    pub fn containment(&self, point: DVec3, corners: impl Fn(u32) -> [DVec3; 3]) -> Containment {
        let bounds = self.bounds();
        if !bounds.touches(Bounds { min: point, max: point }) {
            return Containment::Outside;
        }
        let mut ahead = Vec::new();
        self.touching(Bounds { min: point, max: point.with_x(f64::INFINITY) }, |triangle| {
            ahead.push(corners(triangle))
        });
        containment(point, ahead.into_iter(), Cube::around(bounds.min, bounds.max).side.recip())
    }
}

/// On which side of a surface a point lies; `ahead` are all triangles, each once, that a ray along x may hit.
///
/// - `scale`: a power of two that brings the surface to about size 1, so that no product leaves the range of numbers.
fn containment(point: DVec3, ahead: impl Iterator<Item = [DVec3; 3]>, scale: f64) -> Containment {
    let point = point * scale;
    let mut winding = 0;
    for corners in ahead {
        let corners = corners.map(|corner| corner * scale);
        let bounds = Bounds::of(corners);
        if bounds.max.x < point.x || (0..3).any(|k| k > 0 && !(bounds.min[k]..=bounds.max[k]).contains(&point[k])) {
            continue;
        }
        let [a, b, c, p] = [corners[0], corners[1], corners[2], point].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
        let height = orient3d(a, b, c, p);
        if height == 0.0 && is_in_plane_of(corners, point) {
            return Containment::Surface;
        }
        winding += passes(corners, point, height);
    }
    if winding == 0 { Containment::Outside } else { Containment::Inside }
}

/// A point seen along an axis, so that the other two turn from the next to the one after it.
fn projected(point: DVec3, axis: usize) -> DVec2 {
    DVec2::new(point[(axis + 1) % 3], point[(axis + 2) % 3])
}

/// Whether a point of its plane lies in a triangle; its edges count, a triangle without area does not.
fn is_in_plane_of([a, b, c]: [DVec3; 3], point: DVec3) -> bool {
    let facing = |axis: &usize| turn(projected(a, *axis), projected(b, *axis), projected(c, *axis));
    let Some((axis, facing)) = (0..3).map(|axis| (axis, facing(&axis))).find(|(_, facing)| *facing != 0.0) else {
        return false;
    };
    let turns = |from, to| turn(projected(point, axis), projected(from, axis), projected(to, axis));
    [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| turns(from, to) * facing.signum() >= 0.0)
}

/// 1 if the ray along x leaves through the front of a triangle, -1 if through its back, 0 if not at all.
///
/// - `height`: above the triangle, negative in front of it.
fn passes([a, b, c]: [DVec3; 3], point: DVec3, height: f64) -> i32 {
    let facing = turn(projected(a, 0), projected(b, 0), projected(c, 0));
    if facing == 0.0 {
        return 0;
    }
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let mut turns = turn(projected(point, 0), projected(from, 0), projected(to, 0));
        if turns == 0.0 {
            // The derivatives of the turn by y and by z.
            let by = [from.z - to.z, to.y - from.y];
            turns = if by[0] != 0.0 { by[0] } else { by[1] };
        }
        if (turns < 0.0) != (facing < 0.0) {
            return 0;
        }
    }
    // A front that faces x has its back, where heights are positive, on the side of the point.
    let is_ahead = (height > 0.0) == (facing > 0.0);
    if is_ahead { facing.signum() as i32 } else { 0 }
}
