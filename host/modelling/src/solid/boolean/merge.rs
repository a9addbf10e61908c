//! Facets of one plane, joined again where the lines that divided them bound nothing.
//!
//! Facets of one operand that lie beside each other in one plane are a region. A point that was made by the operation
//! and in which two regions of different planes meet, and no third, lies inside a straight edge; one with a single
//! region around it lies inside that. Neither is needed. All neighbours see the same points, so all leave out the same.

use super::arrangement::Arrangement;
use super::facets::{Facet, PlanarRegion};
use super::half_edges::{HalfEdges, of_triangles};
use super::operand::Operands;
use super::parts::{FaceClassification, Parts};
use crate::numeric::implicit::side;
use crate::solid::union_find::UnionFind;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

/// A triangle of the result that was made by the operation.
#[derive(Clone, Copy, Debug)]
pub struct ResultTriangle {
    /// Points, as the face turns.
    pub corners: [u32; 3],
    /// The face whose surface it has.
    pub face: u32,
    /// A face of that surface that each corner lies in.
    pub corner_faces: [u32; 3],
    /// [`FaceClassification::Kept`] or [`FaceClassification::Reversed`], seen from that face.
    pub classification: FaceClassification,
}

/// The facets that stay, in as few result triangles as their points and borders allow.
pub fn result_triangles(
    operands: &Operands,
    arrangement: &Arrangement,
    facets: &[Facet],
    parts: &Parts,
) -> Vec<ResultTriangle> {
    let selected: Vec<ResultTriangle> =
        facets.iter().enumerate().filter_map(|(index, facet)| result_triangle(facet, parts.of_facet(index))).collect();
    let plan = MergePlan::new(operands, arrangement, &selected);
    let mut members: Vec<(u32, u32)> =
        (0..selected.len() as u32).map(|index| (plan.regions.root(index), index)).collect();
    members.par_sort_unstable();
    let regions: Vec<&[(u32, u32)]> = members.chunk_by(|a, b| a.0 == b.0).collect();
    let merged = regions.par_iter().with_min_len(64).fold(Vec::new, |mut merged, members| {
        plan.merge(arrangement, &selected, members, &mut merged);
        merged
    });
    let merged: Vec<Vec<ResultTriangle>> = merged.collect();
    merged.concat()
}

fn result_triangle(facet: &Facet, classification: FaceClassification) -> Option<ResultTriangle> {
    // Of faces that coincide the first that looks the right way gives its surface.
    let wanted = match classification {
        FaceClassification::Discarded => return None,
        FaceClassification::Kept => true,
        FaceClassification::Reversed => false,
    };
    let cover = facet.cover().find(|c| c.is_along == wanted);
    let [a, b, c] = facet.corners;
    let (corners, face, classification) = match cover {
        Some(cover) if !cover.is_along => ([a, c, b], cover.face, FaceClassification::Kept),
        Some(cover) => ([a, b, c], cover.face, classification),
        None => ([a, b, c], facet.face, classification),
    };
    Some(ResultTriangle { corners, face, corner_faces: [face; 3], classification })
}

/// The result triangles that belong together, and the points that are not needed.
struct MergePlan {
    /// Result triangles of one region.
    regions: UnionFind,
    needless: FxHashSet<u32>,
}

impl MergePlan {
    fn new(operands: &Operands, arrangement: &Arrangement, selected: &[ResultTriangle]) -> MergePlan {
        let corners = selected.iter().map(|piece| piece.corners);
        let sides = HalfEdges::new(arrangement.points.len(), of_triangles(corners, 0));
        let mut regions = UnionFind::new(selected.len());
        for (_, beside) in sides.edges() {
            if let [one, two] = beside
                && are_one(operands, arrangement, &selected[one.1 as usize], &selected[two.1 as usize])
            {
                regions.join(one.1, two.1);
            }
        }
        // Of each point that was made here: the regions around it, three at most, and the borders that end there.
        let is_new = |point: u32| arrangement.vertices[point as usize].is_none();
        let mut around: FxHashMap<u32, ([u32; 2], u32, u32)> = FxHashMap::default();
        for (piece, index) in selected.iter().zip(0..) {
            let region = regions.find(index);
            for point in piece.corners.into_iter().filter(|&point| is_new(point)) {
                let (known, count, _) = around.entry(point).or_insert(([u32::MAX; 2], 0, 0));
                if !known.contains(&region) {
                    if let Some(slot) = known.get_mut(*count as usize) {
                        *slot = region;
                    }
                    *count += 1;
                }
            }
        }
        for (ends, beside) in sides.edges() {
            let is_inner = matches!(beside, [one, two] if regions.find(one.1) == regions.find(two.1));
            // A border of one region with itself, or of several result triangles, stays as it is.
            let weight = if is_inner { 0 } else { if beside.len() == 2 { 1 } else { 3 } };
            for point in ends {
                if let Some((.., borders)) = around.get_mut(&point) {
                    *borders += weight;
                }
            }
        }
        let plane = |region: u32| arrangement.faces[selected[region as usize].face as usize].plane();
        let is_needless = |(regions, count, borders): ([u32; 2], u32, u32)| match (count, borders) {
            (1, 0) => true,
            (2, 2) => !are_coplanar(plane(regions[0]), plane(regions[1])),
            _ => false,
        };
        let needless = around.into_iter().filter(|(_, at)| is_needless(*at)).map(|(point, _)| point).collect();
        MergePlan { regions, needless }
    }

    /// Adds the result triangles of a region, made anew if a point is not needed.
    ///
    /// - `members`: the old result triangles, each after the number of the region.
    fn merge(
        &self,
        arrangement: &Arrangement,
        selected: &[ResultTriangle],
        members: &[(u32, u32)],
        merged: &mut Vec<ResultTriangle>,
    ) {
        let old = members.iter().map(|&(_, member)| selected[member as usize]);
        let is_needed = |point: u32| !self.needless.contains(&point);
        if self.needless.is_empty() || old.clone().flat_map(|piece| piece.corners).all(is_needed) {
            merged.extend(old);
            return;
        }
        let old: Vec<ResultTriangle> = old.collect();
        merged.extend(self.straightened(arrangement, &old).unwrap_or(old));
    }

    /// The result triangles of a region without the points that are not needed, if its borders allow.
    fn straightened(&self, arrangement: &Arrangement, old: &[ResultTriangle]) -> Option<Vec<ResultTriangle>> {
        let sides = |piece: &ResultTriangle| [0, 1, 2].map(|k| [piece.corners[k], piece.corners[(k + 1) % 3]]);
        let all: FxHashSet<[u32; 2]> = old.iter().flat_map(sides).collect();
        let borders: Vec<[u32; 2]> = old.iter().flat_map(sides).filter(|[a, b]| !all.contains(&[*b, *a])).collect();
        let next_vertex: FxHashMap<u32, u32> = borders.iter().map(|&[a, b]| (a, b)).collect();
        let mut straight = Vec::new();
        for &[from, mut to] in borders.iter().filter(|[from, _]| !self.needless.contains(from)) {
            // A needless point of a border has one way in and one way out.
            while self.needless.contains(&to) {
                to = *next_vertex.get(&to)?;
            }
            straight.push([from, to]);
        }
        // Each point with a face that it lies in.
        let mut at: Vec<(u32, u32)> = old.iter().flat_map(|piece| piece.corners.map(|p| (p, piece.face))).collect();
        at.sort_unstable();
        at.dedup_by_key(|(point, _)| *point);
        at.retain(|(point, _)| !self.needless.contains(point));
        let points: Vec<u32> = at.iter().map(|(point, _)| *point).collect();
        let face_at = |point: u32| at[at.partition_point(|(other, _)| *other < point)].1;
        let first = old[0];
        let triangles = PlanarRegion { face: first.face, points: &points, borders: &straight }.triangles(arrangement);
        Some(
            triangles
                .into_iter()
                .map(|corners| ResultTriangle { corners, corner_faces: corners.map(face_at), ..first })
                .collect(),
        )
    }
}

/// Whether two result triangles beside each other are of one surface and in one plane.
fn are_one(operands: &Operands, arrangement: &Arrangement, one: &ResultTriangle, two: &ResultTriangle) -> bool {
    if one.face == two.face {
        return one.classification == two.classification;
    }
    let [a, b] = [one, two].map(|piece| arrangement.triangles[piece.face as usize]);
    let operand = operands.of_triangle(a);
    let surface = |triangle: u32| {
        let mesh = operands.meshes()[operand as usize];
        mesh.surfaces.get((triangle - operands.first_triangle(operand)) as usize)
    };
    let plane = |piece: &ResultTriangle| arrangement.faces[piece.face as usize].plane();
    one.classification == two.classification
        && operands.of_triangle(b) == operand
        && surface(a) == surface(b)
        && are_coplanar(plane(one), plane(two))
        // Not folded back onto each other.
        && arrangement.faces[one.face as usize].axis == arrangement.faces[two.face as usize].axis
        && arrangement.faces[one.face as usize].orientation == arrangement.faces[two.face as usize].orientation
}

fn are_coplanar([a, b, c]: [glam::DVec3; 3], other: [glam::DVec3; 3]) -> bool {
    other.into_iter().all(|point| [a, b, c].contains(&point) || side(a, b, c, point) == 0.0)
}
