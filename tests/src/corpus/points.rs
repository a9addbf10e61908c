//! Whether points are in a result that are in the set it stands for, tested by solid angles.

use glam::DVec3;
use host::mesh::Mesh;
use host::solid::Expression;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

/// Points that are asked for, half of them anywhere, half of them near a triangle of an operand.
const POINTS: usize = 24;
/// Farther from a whole number than this, a winding number says that the point is on a surface or too near to tell.
const CERTAIN: f64 = 1e-3;

/// Compares a result with an expression over some solids at points by chance, always the same for the same solids.
///
/// # Errors
/// A point that is in one and not in the other.
pub fn compare(solids: &[Mesh], expression: &Expression, result: &Mesh) -> Result<(), String> {
    let vertices = || solids.iter().flat_map(|solid| solid.vertices.iter().copied());
    let (low, high) =
        vertices().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let mut random = Pcg64Mcg::seed_from_u64(vertices().count() as u64);
    for number in 0..POINTS {
        let point = if number % 2 == 0 {
            low + (high - low) * DVec3::from([0; 3].map(|_| random.random_range(0.0..1.0)))
        } else {
            let solid = &solids[random.random_range(0..solids.len())];
            let triangle = random.random_range(0..solid.triangles.len());
            let [a, b, c] = solid.corners(triangle);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            // Far beyond all roundings, and as near as thin plates need.
            let distance = (high - low).max_element() * 10f64.powf(random.random_range(-9.0..-1.0));
            // Not the centre, which of a face of a lattice lies in planes of others.
            let weights = DVec3::from([0; 3].map(|_| random.random_range(0.1..1.0)));
            let place = (a * weights.x + b * weights.y + c * weights.z) / weights.element_sum();
            place + normal * if random.random_range(0..2) == 0 { distance } else { -distance }
        };
        let inside: Option<Vec<bool>> = solids.iter().map(|solid| is_inside(solid, point)).collect();
        let (Some(inside), Some(found)) = (inside, is_inside(result, point)) else { continue };
        if expression.contains(&inside) != found {
            return Err(format!("{point} is {} the result and should not be", if found { "in" } else { "outside" }));
        }
    }
    Ok(())
}

/// Whether the winding number of a closed surface at a point is not 0; `None` too near to it.
fn is_inside(mesh: &Mesh, point: DVec3) -> Option<bool> {
    let angle = |triangle: usize| solid_angle(mesh.corners(triangle).map(|corner| corner - point));
    let winding = (0..mesh.triangles.len()).map(angle).sum::<f64>() / (4.0 * PI);
    ((winding - winding.round()).abs() < CERTAIN).then(|| winding.round() != 0.0)
}

/// The solid angle of a triangle seen from the origin, positive from behind; steradians.
///
/// # Source
/// Van Oosterom and Strackee 1983.
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let [x, y, z] = [a, b, c].map(DVec3::length);
    2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use host::surface::{Tolerance, box_faces, tessellate};

    #[test]
    fn another_set_than_that_of_the_expression_is_noticed() {
        let cube = tessellate(&box_faces(DVec3::ZERO, DVec3::ONE), Tolerance::new(1.0, 90.0)).expect("a cube");
        let other = cube.transformed(&DAffine3::from_translation(DVec3::splat(0.4)));
        let both = vec![Expression::Operand(0), Expression::Operand(1)];
        let solids = [cube.clone(), other.clone()];
        let expressions = [
            Expression::Operand(0),
            Expression::Operand(1),
            Expression::Union(both.clone()),
            Expression::Intersection(both.clone()),
            Expression::SymmetricDifference(both),
        ];
        for (number, expression) in expressions.iter().enumerate() {
            assert_eq!(compare(&solids, expression, &cube).is_ok(), number == 0, "{expression:?}");
            assert_eq!(compare(&solids, expression, &other).is_ok(), number == 1, "{expression:?}");
        }
    }
}
