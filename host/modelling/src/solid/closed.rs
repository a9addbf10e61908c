//! Solids as closed surfaces, with what operations find out about them.

use super::boolean::{Operand, quad_partners};
use crate::mesh::Mesh;
use crate::octree::TriangleBvh;
use std::sync::{Arc, OnceLock};

/// What a closed surface bounds.
///
/// Its mesh is closed and consistently oriented: every edge is traversed as often one way as the other. No triangle
/// lacks an area. The surface is simple: its winding number is 1 inside and 0 outside. It may
/// touch itself, as where two cubes share an edge.
///
/// Results have rounded points. Where surfaces lie within a few roundings of each other, that could make a result cross
/// itself; it is then freed of self-intersections, for which points move by a few roundings more, or refused. An
/// expression that is given to [`Solid::evaluate`] as a whole is rounded only once.
///
/// Coordinates below 8e-62 of the largest, of one solid or of all operands of an operation, are rounded to 9e-78 of
/// that.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    pub(super) mesh: Mesh,
    /// Its triangles by location, once someone asked for them.
    sorted: OnceLock<Arc<TriangleBvh>>,
    /// The quad partners of its triangles, once an operation asked for them.
    quad_partners: OnceLock<Arc<Vec<u32>>>,
}

impl PartialEq for Solid {
    fn eq(&self, other: &Solid) -> bool {
        self.mesh == other.mesh
    }
}

impl Solid {
    /// A mesh that is known to be what a solid has.
    pub(super) fn of(mesh: Mesh) -> Solid {
        Solid { mesh, sorted: OnceLock::new(), quad_partners: OnceLock::new() }
    }

    /// Its surface.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Its surface, for keeps.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// Its triangles by location.
    pub fn sorted(&self) -> &TriangleBvh {
        self.sorted.get_or_init(|| Arc::new(TriangleBvh::new(&self.mesh.vertices, &self.mesh.triangles)))
    }

    pub(super) fn operand(&self) -> Operand<'_> {
        let partners = self.quad_partners.get_or_init(|| Arc::new(quad_partners(&self.mesh)));
        Operand { mesh: &self.mesh, sorted: self.sorted(), quad_partners: partners, overlaps: &[] }
    }
}
