//! The polylines in which the triangles of two sheets meet, and the pairs of triangles behind which surfaces may touch.

use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

use super::sheet::PreparedSheet;
use crate::mesh::{Mesh, bits};
use crate::numeric::bounds::Bounds;
use crate::octree::TriangleBvh;
use crate::solid::boolean::{Contact, ConvexFace, PointKey};

/// A run of points, and the triangles of both sheets between each and the next.
#[derive(Clone, Debug, Default)]
pub struct TrianglePolyline {
    /// The points.
    pub points: Vec<DVec3>,
    /// The triangles, one pair for each line.
    pub lines: Vec<[u32; 2]>,
    /// Whether the last line ends at the first point.
    pub is_closed: bool,
}

/// The polylines of the triangles, and pairs of them whose surfaces may touch.
#[derive(Clone, Debug, Default)]
pub struct TrianglePolylines {
    /// The polylines.
    pub polylines: Vec<TrianglePolyline>,
    /// Pairs of triangles whose surfaces may touch, one for each triangle and surface of the other sheet.
    pub near: Vec<[u32; 2]>,
    /// Pairs tested.
    pub pairs: usize,
    /// Pairs that overlap in one plane.
    pub coincident: usize,
}

/// A line between two named points.
struct Line {
    ends: [u32; 2],
    triangles: [u32; 2],
}

/// Finds them.
pub fn find(sheets: &[PreparedSheet<'_>; 2]) -> TrianglePolylines {
    let pairs = near_pairs(sheets);
    let mut raw = TrianglePolylines { pairs: pairs.len(), ..TrianglePolylines::default() };
    let names = Names::new([sheets[0].sheet.mesh, sheets[1].sheet.mesh]);
    let contact = |pair: &[u32; 2]| {
        let faces = [0, 1].map(|k| names.face(k, pair[k]));
        let [Some(one), Some(two)] = faces else { return None };
        let contact = Contact::of(&one, &two);
        let keys: Vec<PointKey> = contact.points.iter().map(|point| point.key).collect();
        (keys.len() > 1).then_some((*pair, keys, contact.coplanar))
    };
    let contacts: Vec<_> = pairs.par_iter().with_min_len(256).filter_map(contact).collect();
    let mut points: Vec<DVec3> = Vec::new();
    let mut of_key: HashMap<PointKey, u32> = HashMap::new();
    let mut known: HashMap<[u32; 2], ()> = HashMap::new();
    let mut lines: Vec<Line> = Vec::new();
    for (triangles, keys, coplanar) in contacts {
        if coplanar {
            raw.coincident += usize::from(keys.len() > 2);
            continue;
        }
        let ends = [keys[0], keys[1]].map(|key| {
            *of_key.entry(key).or_insert_with(|| {
                points.push(names.position(key, triangles));
                points.len() as u32 - 1
            })
        });
        let sorted = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if ends[0] != ends[1] && known.insert(sorted, ()).is_none() {
            lines.push(Line { ends, triangles });
        }
    }
    raw.polylines = polylines(&points, &lines);
    raw.near = touching(sheets, &pairs);
    raw
}

/// Pairs of triangles whose boxes touch when each is wider by what its surface may be away.
fn near_pairs(sheets: &[PreparedSheet<'_>; 2]) -> Vec<[u32; 2]> {
    let boxes = sheets.each_ref().map(|ground| {
        let mesh = ground.sheet.mesh;
        let widened = |triangle: usize| {
            let (bounds, by) = (Bounds::of(mesh.corners(triangle)), ground.sagitta(triangle as u32));
            [bounds.min - by, bounds.max + by]
        };
        let corners: Vec<[DVec3; 2]> = (0..mesh.triangles.len()).into_par_iter().map(widened).collect();
        corners
    });
    let [one, two] = boxes.each_ref().map(|boxes| {
        let triangles: Vec<[u32; 3]> = (0..boxes.len() as u32).map(|k| [2 * k, 2 * k + 1, 2 * k + 1]).collect();
        TriangleBvh::new(boxes.as_flattened(), &triangles)
    });
    one.pairs(&two)
}

/// Pairs of triangles whose surfaces may have a common tangent plane and be as near as their triangles are to them.
fn touching(sheets: &[PreparedSheet<'_>; 2], pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let may_touch = |pair: &&[u32; 2]| {
        let sagittas = [0, 1].map(|k| sheets[k].sagitta(pair[k]));
        let reach = sagittas[0] + sagittas[1];
        if reach == 0.0 {
            return false;
        }
        let [(n, a), (m, b)] = [0, 1].map(|k| sheets[k].cone(pair[k]));
        if n.cross(m).length() > a + b {
            return false;
        }
        let corners = [0, 1].map(|k| sheets[k].sheet.mesh.corners(pair[k] as usize));
        let apart = |k: usize, normal: DVec3| {
            let heights = corners[1 - k].map(|corner| (corner - corners[k][0]).dot(normal));
            heights.iter().all(|h| *h > reach) || heights.iter().all(|h| *h < -reach)
        };
        !apart(0, n) && !apart(1, m)
    };
    let mut near: Vec<[u32; 2]> = pairs.par_iter().with_min_len(256).filter(may_touch).copied().collect();
    // The smaller triangle tells better where, and each needs to do so once for a surface.
    let key = |pair: &[u32; 2]| {
        let small = usize::from(sheets[0].reach(pair[0]) > sheets[1].reach(pair[1]));
        let other = 1 - small;
        let surface = sheets[other].surface(pair[other]).map(|(number, _)| number);
        (small, pair[small], surface.ok_or(pair[other]))
    };
    near.sort_by_cached_key(|pair| (key(pair), *pair));
    near.dedup_by_key(|pair| key(pair));
    near
}

/// Names of vertices: those at one place have one, in both meshes.
struct Names<'a> {
    meshes: [&'a Mesh; 2],
    names: [Vec<u32>; 2],
    places: Vec<DVec3>,
}

impl<'a> Names<'a> {
    fn new(meshes: [&'a Mesh; 2]) -> Names<'a> {
        let mut of_place: HashMap<[u64; 3], u32> = HashMap::new();
        let mut places = Vec::new();
        let mut name = |at: &DVec3| {
            *of_place.entry(bits(*at)).or_insert_with(|| {
                places.push(*at);
                places.len() as u32 - 1
            })
        };
        let names = meshes.map(|mesh| mesh.vertices.iter().map(&mut name).collect());
        Names { meshes, names, places }
    }

    /// A triangle as contacts know it; none if it has no area.
    fn face(&self, side: usize, triangle: u32) -> Option<ConvexFace> {
        let corners = self.meshes[side].corners(triangle as usize);
        let vertices = self.meshes[side].triangles[triangle as usize].map(|v| self.names[side][v as usize]);
        let id = if side == 0 { triangle } else { self.meshes[0].triangles.len() as u32 + triangle };
        ConvexFace::new(id, vertices, corners)
    }

    /// About where a point is that two triangles have in common.
    fn position(&self, key: PointKey, triangles: [u32; 2]) -> DVec3 {
        let at = |vertex: u32| self.places[vertex as usize];
        match key {
            PointKey::Vertex(vertex) => at(vertex),
            PointKey::Pierced([a, b], face) => {
                let first = self.meshes[0].triangles.len() as u32;
                let side = usize::from(face >= first);
                let [p, q, r] = self.meshes[side].corners((face - if side == 0 { 0 } else { first }) as usize);
                let normal = (q - p).cross(r - p);
                let (low, high) = ((at(a) - p).dot(normal), (at(b) - p).dot(normal));
                at(a).lerp(at(b), part(low, low - high))
            }
            PointKey::Edges([a, b], [c, d]) => {
                // Where the first is nearest to the second.
                let (along, other, offset) = (at(b) - at(a), at(d) - at(c), at(c) - at(a));
                let normal = along.cross(other);
                at(a).lerp(at(b), part(offset.cross(other).dot(normal), normal.length_squared()))
            }
            // Contacts of two triangles have no such points.
            PointKey::Faces(_) => self.meshes[0].corners(triangles[0] as usize)[0],
        }
    }
}

fn part(over: f64, under: f64) -> f64 {
    let part = over / under;
    if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 }
}

/// Lines as runs that end where other than two of them meet.
fn polylines(points: &[DVec3], lines: &[Line]) -> Vec<TrianglePolyline> {
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
    for (line, index) in lines.iter().zip(0..) {
        line.ends.iter().for_each(|&end| at[end as usize].push(index));
    }
    let mut is_used = vec![false; lines.len()];
    let mut polylines = Vec::new();
    let mut walk = |first: u32, line: u32| {
        let mut polyline = TrianglePolyline { points: vec![points[first as usize]], ..TrianglePolyline::default() };
        let (mut here, mut line) = (first, line);
        while !std::mem::replace(&mut is_used[line as usize], true) {
            let Line { ends, triangles } = &lines[line as usize];
            here = if ends[0] == here { ends[1] } else { ends[0] };
            polyline.lines.push(*triangles);
            if here == first && at[here as usize].len() == 2 {
                polyline.is_closed = true;
                break;
            }
            polyline.points.push(points[here as usize]);
            match at[here as usize][..] {
                [one, two] => line = if one == line { two } else { one },
                _ => break,
            }
        }
        if !polyline.lines.is_empty() {
            polylines.push(polyline);
        }
    };
    for ends_first in [true, false] {
        for (node, lines) in (0..).zip(&at) {
            if (lines.len() != 2) == ends_first {
                lines.iter().for_each(|&line| walk(node, line));
            }
        }
    }
    polylines
}
