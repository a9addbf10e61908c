//! What the triangles of a rounded solid belong to: the face that they are a part of, or the rounding of an edge.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::faces::{PolygonFaces, SolidEdge, to_segment};
use crate::mesh::Mesh;
use crate::numeric::triangle::weights;
use crate::solid::ExactSolid;
use crate::solid::union_find::UnionFind;
use crate::surface::Surface;

/// Normals of one plane differ by less.
const FLAT: f64 = 1e-9;
/// Parameters are multiples of this, so that rounding does not part those that are the same.
const STEP: f64 = 1.0 / (1 << 26) as f64;

/// A rounded edge.
struct Rounding {
    ends: [DVec3; 2],
    normals: [DVec3; 2],
}

impl Rounding {
    fn new(edge: &SolidEdge, faces: &PolygonFaces, points: &[DVec3]) -> Rounding {
        Rounding {
            ends: edge.ends.map(|end| points[end as usize]),
            normals: edge.faces.map(|face| faces.faces[face].normal),
        }
    }

    /// Where a point of the rounding is: by its normal from one face to the other, and along the edge, both 0 to 1.
    fn parameters(&self, point: DVec3, normal: DVec3) -> DVec2 {
        let [from, to] = self.ends;
        let along = (point - from).dot(to - from) / (to - from).length_squared();
        let across = self.normals[0].angle_between(normal) / self.normals[0].angle_between(self.normals[1]);
        (DVec2::new(across, along) / STEP).round() * STEP
    }
}

/// Gives the triangles of a rounded solid their surfaces, and the parameters and normals on these.
///
/// Those of faces stay what they were in `solid`; each rounded edge has a new one behind them, in the order of `rounded`,
/// its u from face to face and v along the edge, each about 0 to 1. Around a corner the nearest edge counts.
///
/// Returns the surfaces; those of edges are not known exactly.
pub fn assign(
    mesh: &mut Mesh,
    solid: &ExactSolid,
    faces: &PolygonFaces,
    rounded: &[usize],
) -> Vec<Option<Arc<dyn Surface>>> {
    let before = solid.solid().mesh();
    let roundings: Vec<Rounding> =
        rounded.iter().map(|edge| Rounding::new(&faces.edges[*edge], faces, &before.vertices)).collect();
    let mut surfaces = solid.surfaces().to_vec();
    let first = surfaces.len() as u32;
    surfaces.resize(surfaces.len() + roundings.len(), None);
    mesh.corner_parameters = vec![[DVec2::ZERO; 3]; mesh.triangles.len()];
    mesh.surfaces = vec![0; mesh.triangles.len()];
    for (triangle, source) in sources(mesh, before).into_iter().enumerate() {
        if let Some(source) = source {
            let corners = solid.corners_of(mesh, triangle, source);
            mesh.surfaces[triangle] = before.surfaces[source];
            mesh.corner_normals[triangle] = corners.map(|(normal, _)| normal);
            mesh.corner_parameters[triangle] = corners.map(|(_, uv)| uv);
            continue;
        }
        let corners = mesh.corners(triangle);
        let middle = corners.iter().sum::<DVec3>() / 3.0;
        let distance = |k: &usize| to_segment(roundings[*k].ends, middle);
        let Some(near) = (0..roundings.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))) else { continue };
        let normals = mesh.corner_normals[triangle];
        mesh.surfaces[triangle] = first + near as u32;
        mesh.corner_parameters[triangle] = [0, 1, 2].map(|k| roundings[near].parameters(corners[k], normals[k]));
    }
    surfaces
}

/// For each triangle that is a part of a face that stayed, a triangle of that face before.
fn sources(mesh: &Mesh, before: &Mesh) -> Vec<Option<usize>> {
    let flat: Vec<Option<DVec3>> = (0..mesh.triangles.len())
        .map(|t| {
            let [a, b, c] = mesh.corner_normals[t];
            (a.distance(b).max(a.distance(c)) < FLAT).then_some(a)
        })
        .collect();
    let sides = |t: usize| [0, 1, 2].map(|k| [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]]);
    let of_side: HashMap<[u32; 2], usize> =
        (0..mesh.triangles.len()).flat_map(|t| sides(t).map(|side| (side, t))).collect();
    let mut joined = UnionFind::new(mesh.triangles.len());
    for t in 0..mesh.triangles.len() {
        for other in sides(t).iter().filter_map(|[from, to]| of_side.get(&[*to, *from])) {
            if let (Some(one), Some(two)) = (flat[t], flat[*other])
                && one.distance(two) < FLAT
            {
                joined.join(t as u32, *other as u32);
            }
        }
    }
    let normals: Vec<Option<DVec3>> = (0..before.triangles.len()).map(|t| before.face_normal(t)).collect();
    let mut known: HashMap<u32, Option<usize>> = HashMap::new();
    let source = |(t, normal): (usize, &Option<DVec3>)| {
        let normal = (*normal)?;
        *known.entry(joined.root(t as u32)).or_insert_with(|| {
            let middle = mesh.corners(t).iter().sum::<DVec3>() / 3.0;
            let distance = |t: &usize| {
                let corners = before.corners(*t);
                let [a, b, c] = weights(corners, middle);
                (corners[0] * a + corners[1] * b + corners[2] * c).distance_squared(middle)
            };
            // Normals that are made of rounded corners are less exact than those of planes.
            let is_parallel = |t: &usize| normals[*t].is_some_and(|n| n.distance(normal) < FLAT.sqrt());
            let all = (0..before.triangles.len()).filter(is_parallel);
            all.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        })
    };
    flat.iter().enumerate().map(source).collect()
}
