//! Meshes of four times as many triangles.

use glam::DVec3;

use super::Mesh;
use super::edges::{Edge, EdgeTable};

impl Mesh {
    /// Each triangle divided into four at the middles of its sides; the shape stays. Parameters and surfaces are kept,
    /// normals are interpolated.
    pub fn subdivided(&self) -> Mesh {
        let table = EdgeTable::of(self);
        let mut mesh = divided(self, &table);
        mesh.vertices.extend(table.edges.iter().map(|edge| middle(self, edge)));
        mesh.corner_parameters = quarters(&self.corner_parameters, |a, b| (a + b) * 0.5);
        mesh.corner_normals = quarters(&self.corner_normals, |a, b| (a + b).normalize_or_zero());
        mesh.surfaces = self.surfaces.iter().flat_map(|&surface| [surface; 4]).collect();
        mesh
    }

    /// Each triangle divided into four, and all vertices moved towards a smooth surface (C2 but for the vertices that
    /// do not have six neighbours). Boundaries and non-manifold edges become cubic B-spline curves of their own.
    /// Vertices at the same position move as one; tables per corner are dropped, surfaces are kept.
    ///
    /// # Source
    /// Loop 1987, with the weights of Warren 1995 (3/16 for three neighbours, 3/8n for more).
    pub fn subdivided_smoothly(&self) -> Mesh {
        let table = EdgeTable::of(self);
        let mut mesh = divided(self, &table);
        mesh.surfaces = self.surfaces.iter().flat_map(|&surface| [surface; 4]).collect();
        let rings = Rings::of(self, &table);
        for vertex in 0..self.vertices.len() {
            mesh.vertices[vertex] = rings.smoothed(self, table.same[vertex] as usize);
        }
        mesh.vertices.extend(table.edges.iter().map(|edge| smooth_middle(self, &table, edge)));
        mesh
    }
}

/// The triangles of the divided mesh; the middle of edge k is vertex `vertices.len() + k`, still to be added.
fn divided(mesh: &Mesh, table: &EdgeTable) -> Mesh {
    let first = mesh.vertices.len() as u32;
    let mut middles: Vec<[Option<u32>; 3]> = vec![[None; 3]; mesh.triangles.len()];
    for (index, edge) in table.edges.iter().enumerate() {
        for place in table.uses(edge) {
            middles[place.triangle as usize][usize::from(place.side)] = Some(first + index as u32);
        }
    }
    let divide = |(&[a, b, c], middles): (&[u32; 3], &[Option<u32>; 3])| {
        // A collapsed triangle has no edges: its parts collapse to its corners.
        let [ab, bc, ca] = [middles[0].unwrap_or(a), middles[1].unwrap_or(b), middles[2].unwrap_or(c)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    let triangles = mesh.triangles.iter().zip(&middles).flat_map(divide).collect();
    Mesh { vertices: mesh.vertices.clone(), triangles, ..Mesh::default() }
}

fn quarters<T: Copy>(table: &[[T; 3]], between: impl Fn(T, T) -> T) -> Vec<[T; 3]> {
    let divide = |&[a, b, c]: &[T; 3]| {
        let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    table.iter().flat_map(divide).collect()
}

fn middle(mesh: &Mesh, edge: &Edge) -> DVec3 {
    let [a, b] = edge.ends.map(|vertex| mesh.vertices[vertex as usize]);
    (a + b) * 0.5
}

/// 3/8 of the ends and 1/8 of the two vertices opposite.
fn smooth_middle(mesh: &Mesh, table: &EdgeTable, edge: &Edge) -> DVec3 {
    let [a, b] = table.uses(edge) else { return middle(mesh, edge) };
    let opposite = [a, b].map(|place| mesh.corners(place.triangle as usize)[(usize::from(place.side) + 2) % 3]);
    middle(mesh, edge) * 0.75 + (opposite[0] + opposite[1]) * 0.125
}

/// For each vertex the sum of its neighbours, all of them and those along boundaries.
struct Rings {
    inner: Vec<(DVec3, usize)>,
    border: Vec<(DVec3, usize)>,
}

impl Rings {
    fn of(mesh: &Mesh, table: &EdgeTable) -> Rings {
        let nothing = vec![(DVec3::ZERO, 0); mesh.vertices.len()];
        let mut rings = Rings { inner: nothing.clone(), border: nothing };
        for edge in &table.edges {
            let [a, b] = edge.ends.map(|vertex| vertex as usize);
            for (vertex, neighbour) in [(a, b), (b, a)] {
                add(&mut rings.inner[vertex], mesh.vertices[neighbour]);
                if table.uses(edge).len() != 2 {
                    add(&mut rings.border[vertex], mesh.vertices[neighbour]);
                }
            }
        }
        rings
    }

    fn smoothed(&self, mesh: &Mesh, vertex: usize) -> DVec3 {
        let here = mesh.vertices[vertex];
        match (self.border[vertex], self.inner[vertex]) {
            ((_, 0), (_, 0)) => here,
            ((_, 0), (sum, count)) => {
                let weight = if count == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * count as f64) };
                here * (1.0 - weight * count as f64) + sum * weight
            }
            ((sum, 2), _) => here * 0.75 + sum * 0.125,
            // An end or a crossing of boundaries stays.
            _ => here,
        }
    }
}

fn add((sum, count): &mut (DVec3, usize), position: DVec3) {
    *sum += position;
    *count += 1;
}

#[cfg(test)]
mod tests {
    use super::super::samples::tetrahedron;
    use super::*;

    #[test]
    fn division_at_the_middles_keeps_volume_area_and_closedness() {
        let mesh = tetrahedron().subdivided().subdivided();
        assert!(mesh.is_closed());
        assert_eq!(mesh.triangles.len(), 64);
        assert!((mesh.signed_volume() - tetrahedron().signed_volume()).abs() < 1e-15);
        assert!((mesh.area() - tetrahedron().area()).abs() < 1e-14);
    }

    #[test]
    fn smooth_division_keeps_planes_closedness_and_convexity() {
        let smooth = tetrahedron().subdivided_smoothly().subdivided_smoothly();
        assert!(smooth.is_closed());
        assert_eq!(smooth.triangles.len(), 64);
        assert!(smooth.signed_volume() > 0.0 && smooth.signed_volume() < tetrahedron().signed_volume());
        let grid = (0..25).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.0));
        let mut flat = Mesh { vertices: grid.collect(), ..Mesh::default() };
        for i in (0..20).filter(|i| i % 5 < 4) {
            flat.triangles.extend([[i, i + 1, i + 6], [i, i + 6, i + 5]]);
        }
        let smooth = flat.subdivided_smoothly();
        assert!(smooth.vertices.iter().all(|vertex| vertex.z == 0.0));
        // An inner vertex of a regular mesh stays, by symmetry; so does the middle of a straight boundary.
        assert!((smooth.vertices[12] - flat.vertices[12]).length() < 1e-15);
        assert!((smooth.vertices[2] - flat.vertices[2]).length() < 1e-15);
    }
}
