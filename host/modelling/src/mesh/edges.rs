//! Edges of a mesh as vectors: each once, classified by what they are to the viewer.

use glam::DVec3;
use robust::{Coord3D, orient3d};

use super::Mesh;
use super::measure::{angle_between, unit_normal};

/// Normals of one plane differ by less.
const FLAT: f64 = 1e-9;
/// Normals at an edge that differ by less are those of one smooth surface (sine of the angle).
const SMOOTH: f64 = 2e-3;

/// All edges of a mesh and the triangles at each. Vertices at the same position count as one.
#[derive(Clone, Debug)]
pub struct EdgeTable {
    /// The edges, sorted by their ends.
    pub edges: Vec<Edge>,
    uses: Vec<EdgeUse>,
    /// For each vertex the lowest vertex at its position.
    pub(super) same: Vec<u32>,
}

/// An edge of an [`EdgeTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its vertices, the lower index first; each is the lowest index at its position.
    pub ends: [u32; 2],
    first_use: u32,
    use_count: u32,
}

/// A triangle at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeUse {
    /// The triangle.
    pub triangle: u32,
    /// The number of a side of the triangle, 0..3; side k goes from corner k to the next.
    pub side: u8,
    /// Whether the triangle runs from the lower to the higher end.
    pub forward: bool,
}

/// Where the viewer is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewer {
    /// At a point.
    Point(DVec3),
    /// Infinitely far in this direction (from the mesh towards the viewer).
    Direction(DVec3),
}

/// The edges inside smooth parts that are selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SmoothEdges {
    /// None.
    #[default]
    None,
    /// Those along which one surface parameter is constant: the grid of a tessellated surface without its diagonals.
    /// All edges of a mesh that has no parameters. None within a plane.
    Isoparametric,
    /// All.
    All,
}

/// The edges of a mesh that become vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSelection {
    /// Edges of one triangle. (Edges of more than two are always creases.)
    pub boundary: bool,
    /// Edges where the two surfaces meet at more than this angle, degrees, 0..=180; `None` for no creases. The planes
    /// of the triangles must do so, and the normals that the mesh has there: coarse triangles are no creases.
    pub crease_degrees: Option<f64>,
    /// Edges between triangles of different surfaces, whatever their angle.
    pub seams: bool,
    /// Edges that are none of the above.
    pub smooth: SmoothEdges,
    /// The outline that this viewer sees. Where the mesh has normals that are the same on both sides of its edges, it
    /// is made of lines through triangles, along which these normals turn away; else of edges between a triangle that
    /// faces the viewer and one that does not.
    pub outline: Option<Viewer>,
}

impl EdgeSelection {
    /// Every edge.
    pub const ALL: EdgeSelection = EdgeSelection {
        boundary: true,
        crease_degrees: Some(0.0),
        seams: true,
        smooth: SmoothEdges::All,
        outline: None,
    };

    /// Boundaries, and creases sharper than `degrees`.
    pub fn creases(degrees: f64) -> EdgeSelection {
        EdgeSelection {
            boundary: true,
            crease_degrees: Some(degrees),
            seams: false,
            smooth: SmoothEdges::None,
            outline: None,
        }
    }

    /// Boundaries, creases sharper than `degrees`, and the outline that `eye` sees.
    pub fn drawing(degrees: f64, eye: Viewer) -> EdgeSelection {
        EdgeSelection { outline: Some(eye), ..EdgeSelection::creases(degrees) }
    }

    /// Boundaries, creases sharper than `degrees`, and the parameter lines of tessellated surfaces.
    pub fn grid(degrees: f64) -> EdgeSelection {
        EdgeSelection { seams: true, smooth: SmoothEdges::Isoparametric, ..EdgeSelection::creases(degrees) }
    }
}

impl EdgeTable {
    /// Finds the edges of `mesh`; triangles that use one position twice have no part in it.
    ///
    /// # Panics
    /// If an index of the mesh is out of range.
    pub fn of(mesh: &Mesh) -> EdgeTable {
        let same = mesh.first_of_each_position();
        let mut sides = Vec::with_capacity(mesh.triangles.len() * 3);
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|vertex| same[vertex as usize]);
            if a == b || b == c || c == a {
                continue;
            }
            for (side, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                let place = EdgeUse { triangle: triangle as u32, side: side as u8, forward: from < to };
                sides.push(([from.min(to), from.max(to)], place));
            }
        }
        sides.sort_unstable_by_key(|(ends, place)| (*ends, place.triangle));
        let mut edges: Vec<Edge> = Vec::with_capacity(sides.len() / 2);
        for (index, (ends, _)) in sides.iter().enumerate() {
            match edges.last_mut().filter(|edge| edge.ends == *ends) {
                Some(edge) => edge.use_count += 1,
                None => edges.push(Edge { ends: *ends, first_use: index as u32, use_count: 1 }),
            }
        }
        EdgeTable { edges, uses: sides.into_iter().map(|(_, place)| place).collect(), same }
    }

    /// The triangles at `edge`, by rising index.
    pub fn uses(&self, edge: &Edge) -> &[EdgeUse] {
        &self.uses[edge.first_use as usize..(edge.first_use + edge.use_count) as usize]
    }

    /// The edges of `mesh` that `selection` asks for; `mesh` must be the one that this table was made of.
    ///
    /// Outlines within smooth parts are no edges and do not come.
    pub fn select<'a>(&'a self, mesh: &'a Mesh, selection: &'a EdgeSelection) -> impl Iterator<Item = &'a Edge> + 'a {
        let facing = selection.outline.map(|eye| facing(mesh, eye));
        self.edges.iter().filter(move |edge| self.is_selected(mesh, selection, facing.as_deref(), edge))
    }

    pub(super) fn is_collapsed(&self, mesh: &Mesh, triangle: usize) -> bool {
        let [a, b, c] = mesh.triangles[triangle].map(|vertex| self.same[vertex as usize]);
        a == b || b == c || c == a
    }

    fn is_selected(&self, mesh: &Mesh, selection: &EdgeSelection, facing: Option<&[bool]>, edge: &Edge) -> bool {
        let (a, b) = match self.uses(edge) {
            [_] => return selection.boundary,
            [a, b] => (a, b),
            _ => return selection.crease_degrees.is_some() || selection.boundary,
        };
        if let Some(facing) = facing
            && !is_smooth(mesh, a, b)
            && facing[a.triangle as usize] != (facing[b.triangle as usize] ^ (a.forward == b.forward))
        {
            return true;
        }
        if let Some(degrees) = selection.crease_degrees
            && self.dihedral_degrees(mesh, edge).is_some_and(|angle| angle > degrees)
            && normals_turn_degrees(mesh, a, b).is_none_or(|angle| angle > degrees)
        {
            return true;
        }
        let surface = |place: &EdgeUse| mesh.surfaces.get(place.triangle as usize);
        if selection.seams && surface(a) != surface(b) {
            return true;
        }
        match selection.smooth {
            SmoothEdges::None => false,
            SmoothEdges::Isoparametric if self.is_within_plane(mesh, edge, a, b) => false,
            SmoothEdges::Isoparametric => is_isoparametric(mesh, a) || is_isoparametric(mesh, b),
            SmoothEdges::All => true,
        }
    }

    /// The angle between the planes of the two triangles of an edge, degrees, 0 where they continue each other; `None`
    /// unless there are exactly two and both have an area.
    pub fn dihedral_degrees(&self, mesh: &Mesh, edge: &Edge) -> Option<f64> {
        let [a, b] = self.uses(edge) else { return None };
        let normal_a = mesh.face_normal(a.triangle as usize)?;
        let normal_b = mesh.face_normal(b.triangle as usize)?;
        let turned = if a.forward == b.forward { -normal_b } else { normal_b };
        Some(angle_between(normal_a, turned).to_degrees())
    }

    /// Whether both triangles of an edge are parts of one plane, by the normals that the mesh has or else by their own.
    fn is_within_plane(&self, mesh: &Mesh, edge: &Edge, a: &EdgeUse, b: &EdgeUse) -> bool {
        let corners = [a, b].map(|place| mesh.corner_normals.get(place.triangle as usize));
        let [Some(one), Some(two)] = corners else {
            return self.dihedral_degrees(mesh, edge).is_some_and(|angle| angle.to_radians() < FLAT);
        };
        let side = if a.forward == b.forward { -1.0 } else { 1.0 };
        one.iter().all(|n| n.distance(one[0]) < FLAT) && two.iter().all(|n| (*n * side).distance(one[0]) < FLAT)
    }
}

/// For each triangle whether `eye` sees its outside; edge-on counts as not. Exact for a viewer at a point.
fn facing(mesh: &Mesh, eye: Viewer) -> Vec<bool> {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    let faces = |triangle| {
        let [a, b, c] = mesh.corners(triangle);
        match eye {
            Viewer::Point(eye) => orient3d(coord(a), coord(b), coord(c), coord(eye)) < 0.0,
            Viewer::Direction(eye) => unit_normal(a, b, c).is_some_and(|normal| normal.dot(eye) > 0.0),
        }
    };
    (0..mesh.triangles.len()).map(faces).collect()
}

/// Whether the normals at both ends of an edge are the same on both sides: it has then no part in an outline.
fn is_smooth(mesh: &Mesh, a: &EdgeUse, b: &EdgeUse) -> bool {
    let ends = |place: &EdgeUse| {
        let normals = mesh.corner_normals.get(place.triangle as usize)?;
        let [from, to] = [usize::from(place.side), (usize::from(place.side) + 1) % 3].map(|corner| normals[corner]);
        Some(if place.forward { [from, to] } else { [to, from] })
    };
    let side = if a.forward == b.forward { -1.0 } else { 1.0 };
    match (ends(a), ends(b)) {
        (Some(one), Some(two)) => one.iter().zip(two).all(|(p, q)| *p != DVec3::ZERO && p.distance(q * side) < SMOOTH),
        _ => false,
    }
}

/// The angle between the normals that the mesh has at both sides of an edge, in the mean over its ends, degrees; `None`
/// where there are none.
fn normals_turn_degrees(mesh: &Mesh, a: &EdgeUse, b: &EdgeUse) -> Option<f64> {
    let mean = |place: &EdgeUse| {
        let normals = mesh.corner_normals.get(place.triangle as usize)?;
        (normals[usize::from(place.side)] + normals[(usize::from(place.side) + 1) % 3]).try_normalize()
    };
    let side = if a.forward == b.forward { -1.0 } else { 1.0 };
    Some(angle_between(mean(a)?, mean(b)? * side).to_degrees())
}

/// Whether one parameter is the same at both ends of a side; true where there are no parameters.
fn is_isoparametric(mesh: &Mesh, place: &EdgeUse) -> bool {
    let Some(corners) = mesh.corner_parameters.get(place.triangle as usize) else { return true };
    let (from, to) = (corners[usize::from(place.side)], corners[(usize::from(place.side) + 1) % 3]);
    from.x == to.x || from.y == to.y
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::super::measure::bits;
    use super::super::samples::{self, tetrahedron};
    use super::super::wire;
    use super::*;

    /// The unit cube with vertices of its own for each triangle, as many files have it.
    fn cube() -> Mesh {
        let joined = samples::cube();
        let mut mesh = Mesh::default();
        for triangle in 0..joined.triangles.len() {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(joined.corners(triangle));
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        mesh
    }

    const SLICES: u32 = 64;
    const STACKS: u32 = 32;

    fn ball() -> Mesh {
        samples::ball(SLICES, STACKS)
    }

    #[test]
    fn a_cube_has_twelve_creases_and_no_diagonals() {
        let wires = wire(&cube(), &EdgeSelection::creases(20.0));
        assert_eq!(wires.len(), 12);
        assert!(wires.iter().all(|[a, b]| ((*a - *b).length() - 1.0).abs() < 1e-15));
        assert_eq!(wire(&cube(), &EdgeSelection::ALL).len(), 18);
    }

    #[test]
    fn a_smooth_sphere_has_no_creases() {
        assert!(wire(&ball(), &EdgeSelection::creases(20.0)).is_empty());
    }

    #[test]
    fn every_edge_of_a_closed_mesh_comes_once() {
        let mesh = ball();
        let wires = wire(&mesh, &EdgeSelection::ALL);
        assert_eq!(wires.len(), mesh.triangles.len() * 3 / 2);
        let keys: HashSet<_> = wires.iter().map(|[a, b]| (bits(*a).min(bits(*b)), bits(*a).max(bits(*b)))).collect();
        assert_eq!(keys.len(), wires.len());
    }

    #[test]
    fn the_grid_of_a_sphere_is_its_edges_without_one_diagonal_a_quad() {
        let all = wire(&ball(), &EdgeSelection::ALL).len();
        let grid = wire(&ball(), &EdgeSelection::grid(20.0)).len();
        // Triangles at the two poles, quads between.
        assert_eq!(all - grid, (SLICES * (STACKS - 2)) as usize);
        assert_eq!(grid, (SLICES * (STACKS - 1) + SLICES * STACKS) as usize);
    }

    #[test]
    fn a_cube_seen_along_its_diagonal_has_an_outline_of_six_edges() {
        let outline = |eye| EdgeSelection { boundary: false, crease_degrees: None, ..EdgeSelection::drawing(0.0, eye) };
        assert_eq!(wire(&cube(), &outline(Viewer::Direction(DVec3::ONE))).len(), 6);
        assert_eq!(wire(&cube(), &outline(Viewer::Point(DVec3::splat(5.0)))).len(), 6);
        assert_eq!(wire(&cube(), &outline(Viewer::Point(DVec3::new(0.4, 0.3, 5.0)))).len(), 4);
        assert_eq!(wire(&cube(), &outline(Viewer::Point(DVec3::splat(0.4)))).len(), 0);
    }

    #[test]
    fn coarse_triangles_of_a_smooth_surface_are_no_creases() {
        let mut mesh = Mesh { corner_normals: Vec::new(), ..samples::ball(6, 3) };
        assert!(!wire(&mesh, &EdgeSelection::creases(20.0)).is_empty());
        mesh.corner_normals = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(DVec3::normalize)).collect();
        assert!(wire(&mesh, &EdgeSelection::creases(20.0)).is_empty());
        let mut flat = cube();
        flat.corner_normals = (0..flat.triangles.len()).map(|t| [flat.face_normal(t).unwrap(); 3]).collect();
        assert_eq!(wire(&flat, &EdgeSelection::creases(20.0)).len(), 12);
    }

    #[test]
    fn the_grid_has_no_lines_within_a_plane() {
        let mut mesh = cube();
        assert_eq!(wire(&mesh, &EdgeSelection::grid(20.0)).len(), 12);
        mesh.corner_normals = (0..mesh.triangles.len()).map(|t| [mesh.face_normal(t).unwrap(); 3]).collect();
        assert_eq!(wire(&mesh, &EdgeSelection::grid(20.0)).len(), 12);
    }

    #[test]
    fn the_outline_of_a_sphere_is_closed_and_nearly_a_great_circle() {
        let selection = EdgeSelection {
            boundary: false,
            crease_degrees: None,
            ..EdgeSelection::drawing(0.0, Viewer::Direction(DVec3::new(0.3, 0.5, 0.8)))
        };
        let outline = wire(&ball(), &selection);
        let mut degree = std::collections::HashMap::new();
        outline.iter().flatten().for_each(|end| *degree.entry(bits(*end)).or_insert(0) += 1);
        assert!(!outline.is_empty() && degree.values().all(|count| count % 2 == 0));
        let eye = DVec3::new(0.3, 0.5, 0.8).normalize();
        assert!(outline.iter().flatten().all(|end| end.dot(eye).abs() < 0.2));
    }

    #[test]
    fn edges_of_three_triangles_are_creases() {
        let mut mesh = tetrahedron();
        mesh.vertices.push(DVec3::splat(-1.0));
        mesh.triangles.push([0, 1, 4]);
        let wires = wire(&mesh, &EdgeSelection { boundary: false, ..EdgeSelection::creases(179.0) });
        assert_eq!(wires, [[DVec3::ZERO, DVec3::X]]);
    }
}
