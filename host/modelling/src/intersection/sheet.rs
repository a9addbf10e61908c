//! One side of an intersection: triangles, and the exact surfaces behind them.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::SheetCoordinates;
use crate::mesh::Mesh;
use crate::mesh::edges::{EdgeTable, EdgeUse};
use crate::numeric::triangle::weights;
use crate::solid::ExactSolid;
use crate::surface::Surface;

/// The sagitta of a triangle is taken for so many times what the turn of its normals tells.
const SAGITTA_MARGIN: f64 = 1.5;

/// Triangles, open or closed, that may know their exact surface.
///
/// A triangle knows it if it names a surface that is there, and the parameters of its corners on it. Every other
/// triangle is taken for a part of its plane.
#[derive(Clone, Copy)]
pub struct ExactSheet<'a> {
    pub(super) mesh: &'a Mesh,
    surfaces: &'a [Option<Arc<dyn Surface>>],
}

impl<'a> ExactSheet<'a> {
    /// The triangles of a mesh, and the surfaces that they name.
    pub fn new(mesh: &'a Mesh, surfaces: &'a [Option<Arc<dyn Surface>>]) -> ExactSheet<'a> {
        ExactSheet { mesh, surfaces }
    }
}

impl<'a> From<&'a ExactSolid> for ExactSheet<'a> {
    fn from(solid: &'a ExactSolid) -> ExactSheet<'a> {
        ExactSheet::new(solid.solid().mesh(), solid.surfaces())
    }
}

/// The foot point of a given point: the point of a surface that is nearest to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub point: DVec3,
    pub normal: DVec3,
    pub uv: DVec2,
}

/// A crossing of a border: where it is, and a triangle behind it.
struct Crossing {
    middle: DVec3,
    triangle: u32,
}

/// A sheet that is prepared for many questions.
pub(super) struct PreparedSheet<'a> {
    pub sheet: ExactSheet<'a>,
    /// For each surface the crossings to others, and to its own other end.
    crossings: HashMap<u32, Vec<Crossing>>,
}

impl<'a> PreparedSheet<'a> {
    pub fn new(sheet: ExactSheet<'a>) -> PreparedSheet<'a> {
        let mesh = sheet.mesh;
        let mut ground = PreparedSheet { sheet, crossings: HashMap::new() };
        if mesh.surfaces.is_empty() || mesh.corner_parameters.is_empty() {
            return ground;
        }
        let table = EdgeTable::of(mesh);
        for edge in &table.edges {
            let [a, b] = table.uses(edge) else { continue };
            let uv = |place: &EdgeUse| {
                let corners = mesh.corner_parameters[place.triangle as usize];
                let (from, to) = (corners[usize::from(place.side)], corners[(usize::from(place.side) + 1) % 3]);
                if place.forward { [from, to] } else { [to, from] }
            };
            let (one, two) = (a.triangle as usize, b.triangle as usize);
            if mesh.surfaces[one] == mesh.surfaces[two] && uv(a) == uv(b) {
                continue;
            }
            let middle = edge.ends.map(|end| mesh.vertices[end as usize]).into_iter().sum::<DVec3>() * 0.5;
            for (from, to) in [(one, two), (two, one)] {
                let ways = ground.crossings.entry(mesh.surfaces[from]).or_default();
                ways.push(Crossing { middle, triangle: to as u32 });
            }
        }
        ground
    }

    /// The surface that a triangle knows, and its number.
    pub fn surface(&self, triangle: u32) -> Option<(u32, &Arc<dyn Surface>)> {
        let mesh = self.sheet.mesh;
        mesh.corner_parameters.get(triangle as usize)?;
        let number = *mesh.surfaces.get(triangle as usize)?;
        Some((number, self.sheet.surfaces.get(number as usize)?.as_ref()?))
    }

    /// The place on its surface of a point near a triangle.
    pub fn coordinates(&self, triangle: u32, at: DVec3) -> SheetCoordinates {
        let [a, b, c] = weights(self.sheet.mesh.corners(triangle as usize), at);
        match self.surface(triangle) {
            Some((surface, _)) => {
                let [p, q, r] = self.sheet.mesh.corner_parameters[triangle as usize];
                SheetCoordinates { triangle, surface: Some(surface), uv: p * a + q * b + r * c }
            }
            None => SheetCoordinates { triangle, surface: None, uv: DVec2::new(b, c) },
        }
    }

    /// The nearest point on the surface of a place.
    pub fn foot(&self, place: &SheetCoordinates, at: DVec3) -> Foot {
        if let Some((_, surface)) = self.surface(place.triangle) {
            let uv = surface.nearest(at, place.uv);
            return Foot { point: surface.point(uv), normal: surface.normal(uv), uv };
        }
        let corners = self.sheet.mesh.corners(place.triangle as usize);
        let normal = self.sheet.mesh.face_normal(place.triangle as usize).unwrap_or(DVec3::ZERO);
        let point = at - normal * (at - corners[0]).dot(normal);
        let [_, b, c] = weights(corners, point);
        Foot { point, normal, uv: DVec2::new(b, c) }
    }

    /// The place on a neighbour of the surface that is nearest to a point beyond its border; none if it has no
    /// neighbour.
    pub fn beyond(&self, place: &SheetCoordinates, at: DVec3) -> Option<SheetCoordinates> {
        let ways = self.crossings.get(&place.surface?)?;
        let distance = |way: &Crossing| way.middle.distance_squared(at);
        let way = ways.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(self.coordinates(way.triangle, at))
    }

    /// How far the surface may be from a triangle that stands for it; 0 where they are one.
    pub fn sagitta(&self, triangle: u32) -> f64 {
        let mesh = self.sheet.mesh;
        let (Some(_), Some(normals)) = (self.surface(triangle), mesh.corner_normals.get(triangle as usize)) else {
            return 0.0;
        };
        let corners = mesh.corners(triangle as usize);
        // An arc is as high as an eighth of what its direction turns towards its chord, times the chord.
        let of_side = |k: usize| {
            let (i, j) = (k, (k + 1) % 3);
            (corners[i] - corners[j]).dot(normals[i] - normals[j]).abs() / 8.0
        };
        SAGITTA_MARGIN * (0..3).map(of_side).fold(0.0, f64::max)
    }

    /// A direction and the sine of an angle: the normals over a triangle are no farther from that direction or its
    /// opposite.
    pub fn cone(&self, triangle: u32) -> (DVec3, f64) {
        let axis = self.sheet.mesh.face_normal(triangle as usize).unwrap_or(DVec3::ZERO);
        let known = self.surface(triangle).and_then(|_| self.sheet.mesh.corner_normals.get(triangle as usize));
        let widest = known.map_or(0.0, |normals| normals.iter().map(|n| n.cross(axis).length()).fold(0.0, f64::max));
        (axis, SAGITTA_MARGIN * widest)
    }

    /// The longest side of a triangle.
    pub fn reach(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.sheet.mesh.corners(triangle as usize);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }
}
