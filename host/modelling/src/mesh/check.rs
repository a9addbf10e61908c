//! Whether a mesh can be trusted: finite, in range, closed, consistently oriented.

use super::edges::EdgeTable;
use super::triangles::MAX_COUNT;
use super::{Fault, FaultLocation, Mesh, MeshProblem};

/// What the edges say of a mesh. Vertices at the same position (same bits) count as one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeReport {
    /// Different edges.
    pub edges: usize,
    /// Edges with a triangle on one side only.
    pub boundary: usize,
    /// Non-manifold edges: those of more than two triangles.
    pub non_manifold: usize,
    /// Edges of two triangles that traverse it in the same direction.
    pub misoriented: usize,
    /// Triangles that use one position twice; they have no part in the counts above.
    pub collapsed: usize,
    /// Degenerate triangles: others without area, all corners on one line.
    pub degenerate: usize,
    /// Vertices at different positions that a triangle uses.
    pub vertices: usize,
    /// Triangles with three different positions.
    pub triangles: usize,
}

impl EdgeReport {
    /// Whether every edge has exactly two triangles, which traverse it in opposite directions.
    pub fn is_closed(&self) -> bool {
        self.edges > 0 && self.boundary + self.non_manifold + self.misoriented == 0
    }

    /// Vertices - edges + triangles: 2 for each closed piece without handles, 0 for a torus.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }
}

impl Mesh {
    /// Checks that vertices are finite, indices in range, and tables as long as they must be.
    ///
    /// # Errors
    /// The first vertex, triangle or table that is not.
    pub fn validate(&self) -> Result<(), Fault> {
        for (what, count) in [("vertices", self.vertices.len()), ("triangles", self.triangles.len())] {
            if count > MAX_COUNT {
                let problem = MeshProblem::TooMany { what, count: count as u64, limit: MAX_COUNT as u64 };
                return Err(FaultLocation::Mesh.fault(problem));
            }
        }
        if let Some(vertex) = self.vertices.iter().position(|position| !position.is_finite()) {
            return Err(FaultLocation::Vertex(vertex).fault(MeshProblem::NotFinite));
        }
        let count = self.vertices.len();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
                let problem = MeshProblem::Index { index: index.into(), count, table: "vertices" };
                return Err(FaultLocation::Triangle(triangle).fault(problem));
            }
        }
        let triangles = self.triangles.len();
        let lengths = [
            ("corner_normals", self.corner_normals.len()),
            ("corner_parameters", self.corner_parameters.len()),
            ("surfaces", self.surfaces.len()),
        ];
        match lengths.into_iter().find(|&(_, length)| length != 0 && length != triangles) {
            Some((table, length)) => Err(FaultLocation::Mesh.fault(MeshProblem::Length { table, length, triangles })),
            None => Ok(()),
        }
    }

    /// Counts triangles that have the same three positions as an earlier one, however they are oriented.
    pub fn duplicate_triangles(&self) -> usize {
        let same = self.first_of_each_position();
        let corners = |triangle: &[u32; 3]| {
            let mut corners = triangle.map(|vertex| same[vertex as usize]);
            corners.sort_unstable();
            corners
        };
        let mut seen = std::collections::HashSet::with_capacity(self.triangles.len());
        self.triangles.iter().filter(|triangle| !seen.insert(corners(triangle))).count()
    }

    /// Counts what the edges say of the mesh.
    pub fn edge_report(&self) -> EdgeReport {
        let table = EdgeTable::of(self);
        let mut report = EdgeReport { edges: table.edges.len(), ..EdgeReport::default() };
        for edge in &table.edges {
            match table.uses(edge) {
                [_] => report.boundary += 1,
                [a, b] => report.misoriented += usize::from(a.forward == b.forward),
                _ => report.non_manifold += 1,
            }
        }
        let mut used = vec![false; self.vertices.len()];
        for triangle in 0..self.triangles.len() {
            if table.is_collapsed(self, triangle) {
                report.collapsed += 1;
                continue;
            }
            report.triangles += 1;
            report.degenerate += usize::from(self.face_normal(triangle).is_none());
            for vertex in self.triangles[triangle] {
                used[table.same[vertex as usize] as usize] = true;
            }
        }
        report.vertices = used.iter().filter(|&&used| used).count();
        report
    }

    /// Whether the mesh is closed and consistently oriented, so that it has an inside.
    pub fn is_closed(&self) -> bool {
        self.edge_report().is_closed()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::samples::tetrahedron;
    use super::*;

    #[test]
    fn a_tetrahedron_is_closed_and_has_its_volume_and_area() {
        let mesh = tetrahedron();
        let report = mesh.edge_report();
        assert!(report.is_closed());
        assert_eq!((report.vertices, report.edges, report.triangles), (4, 6, 4));
        assert_eq!(report.euler_characteristic(), 2);
        assert!((mesh.signed_volume() - 1.0 / 6.0).abs() < 1e-15);
        assert!((mesh.area() - (1.5 + 3f64.sqrt() / 2.0)).abs() < 1e-15);
        assert!((mesh.reversed().signed_volume() + 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn volume_keeps_its_digits_far_from_the_origin() {
        let far = tetrahedron().transformed(&glam::DAffine3::from_translation(DVec3::splat(1e7)));
        assert!((far.signed_volume() - 1.0 / 6.0).abs() < 1e-8);
    }

    #[test]
    fn holes_crowds_and_turned_triangles_are_counted() {
        let mut open = tetrahedron();
        open.triangles.pop();
        assert_eq!(open.edge_report().boundary, 3);
        let mut turned = tetrahedron();
        turned.triangles[0].swap(0, 1);
        assert_eq!(turned.edge_report().misoriented, 3);
        let mut crowded = tetrahedron();
        crowded.vertices.push(DVec3::splat(-1.0));
        crowded.triangles.push([0, 1, 4]);
        assert_eq!((crowded.edge_report().non_manifold, crowded.edge_report().boundary), (1, 2));
    }

    #[test]
    fn collapsed_triangles_and_slivers_are_told_apart() {
        let mut mesh = tetrahedron();
        mesh.vertices.extend([DVec3::ZERO, DVec3::X * 2.0]);
        mesh.triangles.extend([[0, 4, 1], [0, 1, 5]]);
        let report = mesh.edge_report();
        assert_eq!((report.collapsed, report.degenerate), (1, 1));
    }

    #[test]
    fn bad_meshes_are_refused_with_their_place() {
        let mut mesh = tetrahedron();
        mesh.vertices[2].y = f64::NAN;
        assert_eq!(mesh.validate().unwrap_err().location, FaultLocation::Vertex(2));
        let mut mesh = tetrahedron();
        mesh.triangles[1][2] = 4;
        assert_eq!(mesh.validate().unwrap_err().to_string(), "triangle 1: index 4 is outside the 4 vertices");
        let mut mesh = tetrahedron();
        mesh.surfaces = vec![0; 3];
        assert!(matches!(mesh.validate().unwrap_err().problem, MeshProblem::Length { table: "surfaces", .. }));
    }
}
