//! The surface that instances are scattered on.

use super::super::ShapeError;
use super::super::object::{Object, Shape};
use super::super::parameters::parameters;
use super::super::shape_mesh::{ShapeMesh, flat_normals};
use super::super::stretch::largest_stretch;
use super::standing::parts_below;
use crate::illumination::texture::{NumberTexture, TextureFootprint};
use crate::numeric::sampling::{part_of, triangle};
use crate::procedural::terrain::HeightField;
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

/// Triangles in coordinates of the instances.
#[derive(Clone, Debug)]
pub(super) struct ScatterSurface {
    pub(super) corners: Vec<[DVec3; 3]>,
    pub(super) normals: Vec<[DVec3; 3]>,
    /// Where density is told by parameters, and by own coordinates.
    parameters: Vec<[DVec2; 3]>,
    own: Vec<[DVec3; 3]>,
    /// Of the area, the part of the triangles up to each; nothing if it has none.
    pub(super) areas: Vec<f64>,
    /// The ground for which the triangles stand, of terrain.
    pub(super) ground: Option<Arc<ScatterGround>>,
}

/// Ground that is known exactly: what is scattered stands on it, not on the triangles.
#[derive(Clone, Debug)]
pub(super) struct ScatterGround {
    field: HeightField,
    to_own: DAffine3,
    from_own: DAffine3,
    /// How far it is from the triangles at the most, in coordinates of the instances.
    pub(super) off: f64,
}

impl ScatterGround {
    /// That of a terrain without walls; none of other objects.
    ///
    /// - `chord`: how far the ground may be above or below the triangles, own coordinates.
    fn of(on: &Object, chord: f64) -> Result<Option<ScatterGround>, ShapeError> {
        /// The distance is looked at, not proved.
        const SAFETY: f64 = 2.0;
        let Shape::Terrain(terrain) = &on.shape else { return Ok(None) };
        if terrain.base.is_some() {
            return Ok(None);
        }
        let from_own = DAffine3::from_mat4(on.transform);
        let off = SAFETY * chord * largest_stretch(&on.transform);
        Ok(Some(ScatterGround { field: terrain.field()?, to_own: from_own.inverse(), from_own, off }))
    }

    /// The place of the ground above or below one of the triangles, and the unit normal there.
    fn settled(&self, at: DVec3) -> (DVec3, DVec3) {
        let own = self.to_own.transform_point3(at);
        let below = DVec2::new(own.x, own.z);
        let height = self.field.height(below, 0.0);
        let normal = self.to_own.matrix3.transpose() * self.field.normal(below, 0.0);
        (self.from_own.transform_point3(DVec3::new(own.x, height, own.z)), normal.normalize_or(DVec3::Y))
    }
}

/// A place of the surface.
pub(super) struct SurfacePlace {
    pub(super) at: DVec3,
    /// Unit length.
    pub(super) normal: DVec3,
    pub(super) footprint: TextureFootprint,
}

impl ScatterSurface {
    /// The triangles of an object in place.
    ///
    /// - `density`: where it varies, what it needs is kept.
    ///
    /// # Errors
    /// [`ShapeError`], if the surface cannot be tessellated.
    pub(super) fn new(
        on: &Object,
        density: &NumberTexture,
        scene_tolerance: Option<f64>,
        angle: f64,
    ) -> Result<ScatterSurface, ShapeError> {
        let tolerance = on.own_tolerance(scene_tolerance, angle);
        let made = on.shape.tessellate(tolerance)?;
        let ground = ScatterGround::of(on, tolerance.chord)?.map(Arc::new);
        // A mirrored object is turned inside out in place: its second and third corners change places.
        let is_mirrored = on.transform.determinant() < 0.0;
        let parameters = match density.needs_parameters() {
            true => parameters(&made.mesh, &made.surfaces, is_mirrored),
            false => Vec::new(),
        };
        let turned = |[a, b, c]: [DVec3; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let triangles = 0..made.mesh.triangles.len();
        let own = match density.is_varying() {
            true => triangles.clone().map(|triangle| turned(made.mesh.corners(triangle))).collect(),
            false => Vec::new(),
        };
        let ShapeMesh { mut mesh, .. } = on.in_place(ShapeMesh { surfaces: Vec::new(), ..made });
        if mesh.corner_normals.is_empty() {
            mesh.corner_normals = flat_normals(&mesh);
        }
        let corners: Vec<[DVec3; 3]> = triangles.map(|triangle| mesh.corners(triangle)).collect();
        let normals = mesh.corner_normals;
        Ok(ScatterSurface { parameters, own, ground, ..ScatterSurface::of(corners, normals) })
    }

    /// Triangles on which density does not vary.
    pub(super) fn of(corners: Vec<[DVec3; 3]>, normals: Vec<[DVec3; 3]>) -> ScatterSurface {
        let area = |[a, b, c]: &[DVec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
        let areas = parts_below(corners.iter().map(area));
        ScatterSurface { corners, normals, areas, parameters: Vec::new(), own: Vec::new(), ground: None }
    }

    /// A place, by numbers of 0 to 1: the first is the part of the area up to it.
    pub(super) fn place(&self, part: f64, within: [f64; 2]) -> SurfacePlace {
        self.of_triangle(part_of(&self.areas, part).0, within)
    }

    /// A place of a triangle.
    pub(super) fn of_triangle(&self, index: usize, within: [f64; 2]) -> SurfacePlace {
        let [u, v] = triangle(within);
        let weigh = |of: &[DVec3; 3]| of[0] * (1.0 - u - v) + of[1] * u + of[2] * v;
        let corners = &self.corners[index];
        let face = || (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(DVec3::Y);
        let normal = weigh(&self.normals[index]).try_normalize().unwrap_or_else(face);
        let uv = self.parameters.get(index).map_or(DVec2::ZERO, |[a, b, c]| *a * (1.0 - u - v) + *b * u + *c * v);
        let own = self.own.get(index).map_or(DVec3::ZERO, weigh);
        let (at, normal) = match &self.ground {
            Some(ground) => ground.settled(weigh(corners)),
            None => (weigh(corners), normal),
        };
        SurfacePlace { at, normal, footprint: TextureFootprint::point(uv, own) }
    }

    /// Places by own coordinates, where the whole surface is one plane: the parameters there.
    pub(super) fn parameters_at(&self, own: DVec3) -> DVec2 {
        let (Some([p, q, r]), Some([a, b, c])) = (self.parameters.first(), self.own.first()) else {
            return DVec2::ZERO;
        };
        let (one, other, from) = (*b - *a, *c - *a, own - *a);
        let normal = one.cross(other);
        let square = normal.length_squared();
        let (u, v) = (from.cross(other).dot(normal) / square, one.cross(from).dot(normal) / square);
        *p + (*q - *p) * u + (*r - *p) * v
    }
}
