//! The winding number of a closed surface at a point, by one ray.

use super::contact::planar_orientation;
use super::operand::Operands;
use crate::numeric::bounds::Bounds;
use crate::numeric::implicit::{ImplicitPoint, PointDefinition, side_of, turn};
use glam::DVec3;

/// The winding number of an operand at a point that is not on its surface.
///
/// Counts the triangles beside a ray along x. The ray is thought to be moved a little along y and much less along z, so
/// that it meets neither vertex nor edge.
pub fn winding(operands: &Operands, operand: u32, point: &ImplicitPoint, rays: &mut u64) -> i32 {
    let near = point.bounds();
    if !operands.bounds(operand).touches(near) {
        return 0;
    }
    *rays += 1;
    let mesh = operands.meshes()[operand as usize];
    let beside = Bounds { min: near.min, max: near.max.with_x(f64::INFINITY) };
    let mut winding = 0;
    operands.sorted(operand).touching(beside, |triangle| {
        winding += passes(point, mesh.corners(triangle as usize));
    });
    winding
}

/// 1 if the ray along x leaves through the front of a triangle, -1 if through its back, 0 if not at all.
pub fn passes(point: &ImplicitPoint, corners: [DVec3; 3]) -> i32 {
    let [a, b, c] = corners;
    let facing = planar_orientation(0, a, b, c);
    if facing == 0.0 {
        return 0;
    }
    for (p, q) in [(a, b), (b, c), (c, a)] {
        let mut turns = match point.definition() {
            &PointDefinition::Given(point) => planar_orientation(0, point, p, q),
            _ => turn(
                0,
                point,
                &ImplicitPoint::new(PointDefinition::Given(p)),
                &ImplicitPoint::new(PointDefinition::Given(q)),
            ),
        };
        if turns == 0.0 {
            // The derivatives of the turn by y and by z.
            let by = [p.z - q.z, q.y - p.y];
            turns = if by[0] != 0.0 { by[0] } else { by[1] };
        }
        if turns * facing < 0.0 {
            return 0;
        }
    }
    let is_ahead = side_of(corners, point) * facing > 0.0;
    if is_ahead { facing as i32 } else { 0 }
}
