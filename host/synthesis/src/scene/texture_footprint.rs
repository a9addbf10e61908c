//! Where on its surface, and in its body, a point of a triangle is: parameters and own coordinates, for textures.

use super::prepared::Contents;
use crate::illumination::texture::{FootprintSide, TextureFootprint};
use glam::{DVec2, DVec3};

/// What of a surface a ray stands for at a triangle: a parallelogram of these sides.
pub type Footprint = [DVec3; 2];

/// The sides of the part of a plane that a cone about a ray meets, at right angles: along the view and across.
///
/// - `normal`, `towards`: unit length. `width`: of the cone there.
pub fn footprint(normal: DVec3, towards: DVec3, width: f64) -> Footprint {
    /// A plane that is seen edgewise would be met by an endless part.
    const STEEPEST: f64 = 1e-4;
    /// Sine below which a view is along the normal.
    const UPRIGHT: f64 = 1e-8;
    let cosine = normal.dot(towards).abs().max(STEEPEST);
    let along = towards - normal * normal.dot(towards);
    // Of a view along the normal only rounding errors are left.
    let is_upright = along.length_squared() < UPRIGHT * UPRIGHT;
    let along = if is_upright { normal.any_orthonormal_vector() } else { along.normalize() };
    [along * (width / cosine), normal.cross(along) * width]
}

impl Contents {
    /// Where a point of a triangle is, and what of it is looked at.
    ///
    /// - `weights`: of the corners of the triangle. `sides`: tangents, scene units.
    pub fn texture_place(&self, triangle: u32, weights: [f64; 3], sides: Footprint) -> TextureFootprint {
        let [p, q, r] = self.corners(triangle);
        let object = self.object(triangle);
        let to_own = &object.to_own;
        let own = to_own.transform_point3(p * weights[0] + q * weights[1] + r * weights[2]);
        let (b, c) = (q - p, r - p);
        // Tangents in coordinates along two sides of the triangle: the dual basis.
        let normal = b.cross(c);
        let square = normal.length_squared();
        let duals = if square > 0.0 { [c.cross(normal) / square, normal.cross(b) / square] } else { [DVec3::ZERO; 2] };
        let [uv, across, up] = match self.parameters(triangle) {
            Some([a, b, c]) => [*a * weights[0] + *b * weights[1] + *c * weights[2], *b - *a, *c - *a],
            None => [DVec2::ZERO; 3],
        };
        let side = |scene: DVec3| FootprintSide {
            scene,
            uv: across * duals[0].dot(scene) + up * duals[1].dot(scene),
            own: to_own.transform_vector3(scene),
        };
        let area = across.perp_dot(up);
        let along = if area != 0.0 {
            [(b * up.y - c * across.y) / area, (c * across.x - b * up.x) / area]
        } else {
            [DVec3::ZERO; 2]
        };
        TextureFootprint { uv, own, sides: sides.map(side), along, variation: object.variation }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Object, Scene, Shape};
    use super::*;
    use crate::color::Color;
    use crate::illumination::material::Classic;
    use crate::illumination::texture::{Motif, Paint, Pattern, TextureMapping};
    use crate::scene::Prepared;
    use crate::solid::Primitive;
    use glam::DMat4;

    fn textured(shape: Shape, transform: DMat4) -> Prepared {
        let paints = vec![Paint::grey(0.1), Paint::Plain(Color::grey(0.9))];
        let checker = Pattern { motif: Motif::Checker, laying: TextureMapping::default(), paints };
        let material = Classic { diffuse: Paint::Pattern(Box::new(checker)), ..Classic::default() }.into();
        let object = Object { name: "thing".into(), shape, transform, material: Some(material), tolerance: Some(0.01) };
        Prepared::new(&Scene { objects: vec![object], ..Scene::default() }).expect("a scene")
    }

    #[test]
    fn places_on_a_ball_have_the_parameters_of_the_ball() {
        let transform =
            DMat4::from_translation(DVec3::new(5.0, 1.0, -2.0)) * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let prepared = textured(Shape::from(Primitive::Sphere { radius: 2.0 }), transform);
        let third = [1.0 / 3.0; 3];
        let mut seen = [DVec2::splat(9.0), DVec2::splat(-9.0)];
        for triangle in 0..prepared.triangles.len() as u32 {
            let [a, b, c] = prepared.corners(triangle);
            let normal = (b - a).cross(c - a).normalize();
            let sides = footprint(normal, normal, 0.01);
            let place = prepared.texture_place(triangle, third, sides);
            assert!((place.own.length() - 2.0).abs() < 0.02);
            seen = [seen[0].min(place.uv), seen[1].max(place.uv)];
            for side in place.sides {
                assert!((side.scene.length() - 0.01).abs() < 1e-12 && (side.own.length() - 0.01).abs() < 1e-12);
                // A way in parameters, and back along the derivatives.
                let back = place.along[0] * side.uv.x + place.along[1] * side.uv.y;
                let off = (back - side.scene).length();
                assert!(off < 1e-9, "{triangle}: {off}");
            }
        }
        assert!(seen[0].max_element() < 0.1 && seen[1].min_element() > 0.9, "{seen:?}");
    }

    #[test]
    #[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
    fn a_mesh_without_parameters_has_those_of_its_faces() {
        let prepared = textured(Shape::Bunny, DMat4::IDENTITY);
        for triangle in (0..prepared.triangles.len() as u32).step_by(97) {
            let place = prepared.texture_place(triangle, [0.2, 0.3, 0.5], [DVec3::X * 0.1, DVec3::Y * 0.1]);
            let own = place.own;
            let pairs = [DVec2::new(own.z, own.y), DVec2::new(own.x, own.z), DVec2::new(own.x, own.y)];
            assert!(pairs.iter().any(|uv| (*uv - place.uv).length() < 1e-12));
        }
    }

    #[test]
    fn a_footprint_is_as_long_as_the_plane_is_steep() {
        let towards = DVec3::new(0.6, 0.0, -0.8);
        let [along, across] = footprint(DVec3::Z, towards, 0.5);
        assert!((along - DVec3::X * 0.625).length() < 1e-12 && (across.length() - 0.5).abs() < 1e-12);
        assert!(along.dot(across).abs() < 1e-15);
        assert!(footprint(DVec3::Z, DVec3::X, 1.0)[0].is_finite());
    }
}
