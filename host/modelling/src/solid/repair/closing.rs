//! Closes a surface by patches for its boundary loops that meet nothing else.

use super::super::boolean::{NamedTriangle, overlap};
use super::super::error::OpenLoop;
use super::super::union_find::UnionFind;
use super::patches::{ClosingPatch, LoopPlane, Method, ThirdCorners};
use crate::mesh::edges::EdgeTable;
use crate::mesh::{BoundaryLoop, Mesh};
use crate::octree::TriangleBvh;
use std::collections::{BTreeMap, HashMap, HashSet};

/// What became of the boundary loops of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClosingReport {
    /// Loops that were closed.
    pub(super) loops: usize,
    /// Triangles that were added.
    pub(super) triangles: usize,
    /// Loops that stay open since every patch meets the surface, the longest first.
    pub(super) open: Vec<OpenLoop>,
}

/// Loops that are closed at once, and how.
struct Hole<'a> {
    loops: Vec<&'a BoundaryLoop>,
    plane: LoopPlane,
    length: f64,
    /// The methods that are left to be tried, the next first.
    methods: &'static [Method],
    patch: ClosingPatch,
    /// The first patch that met others than its own component only.
    second_best: Option<ClosingPatch>,
    /// Whether the patch may meet other components.
    may_meet_others: bool,
}

/// What a patch has more in common with than edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Obstacle {
    Others,
    OwnComponent,
}

impl<'a> Hole<'a> {
    fn of(loops: Vec<&'a BoundaryLoop>, mesh: &Mesh) -> Hole<'a> {
        let length = loops.iter().map(|boundary| boundary.length(&mesh.vertices)).sum();
        let plane = LoopPlane::of(loops[0], &mesh.vertices);
        let methods = match &loops[..] {
            [boundary] => Method::of(boundary, &plane),
            _ => &[Method::Projected],
        };
        let (patch, second_best) = (ClosingPatch::default(), None);
        Hole { loops, plane, length, methods, patch, second_best, may_meet_others: false }
    }

    /// Takes the patch of the next method that has one, after them the second best; whether there is one.
    fn try_next(&mut self, mesh: &Mesh, beside: &ThirdCorners) -> bool {
        while let Some((method, rest)) = self.methods.split_first() {
            self.methods = rest;
            if let Some(patch) = method.patch(&self.loops, &self.plane, &mesh.vertices, beside) {
                self.patch = patch;
                return true;
            }
        }
        self.may_meet_others = true;
        self.patch = self.second_best.take().unwrap_or_default();
        !self.patch.triangles.is_empty()
    }

    /// Whether what the patch met rules it out.
    fn is_ruled_out(&mut self, met: Obstacle) -> bool {
        if met == Obstacle::Others && !self.may_meet_others && self.second_best.is_none() {
            self.second_best = Some(self.patch.clone());
        }
        met == Obstacle::OwnComponent || !self.may_meet_others
    }
}

/// Closes the boundary loops of a mesh whose triangles are oriented alike. Loops in one plane are closed at once, so
/// that one within another leaves a hole. A patch is taken if an exact test finds that it has nothing in common with
/// the surface and with other patches but the edges between; where there is none, one that has nothing in common with
/// its own component, which then is a shell that crosses others. A patch gets the surface number of a triangle beside
/// it. Normals and parameters of corners are dropped if anything is added.
///
/// Cost: about that of a few looks at all triangles, and k^3 / 6 steps for a loop of k edges up to a limit.
pub(super) fn close(mesh: &mut Mesh) -> ClosingReport {
    let loops = mesh.boundary_loops();
    if loops.is_empty() {
        return ClosingReport::default();
    }
    let beside = third_corners(mesh, &loops);
    let mut open: Vec<OpenLoop> = Vec::new();
    let mut untried = in_planes(&loops, mesh);
    let mut holes: Vec<Hole> = Vec::new();
    loop {
        while let Some(mut hole) = untried.pop() {
            if hole.try_next(mesh, &beside) {
                holes.push(hole);
                continue;
            }
            match &hole.loops[..] {
                [boundary] => open.push(open_loop(boundary, mesh)),
                // Each is tried on its own.
                several => untried.extend(several.iter().map(|boundary| Hole::of(vec![boundary], mesh))),
            }
        }
        // The longest first: of two that meet, the shorter is tried in another way.
        holes.sort_by(|one, two| two.length.total_cmp(&one.length).then(two.loops[0].0.cmp(&one.loops[0].0)));
        for (hole, met) in blocked_holes(mesh, &holes).into_iter().rev() {
            if holes[hole].is_ruled_out(met) {
                untried.push(holes.remove(hole));
            }
        }
        if untried.is_empty() {
            break;
        }
    }
    let (mut closed, count) = (ClosingReport::default(), mesh.vertices.len());
    let surfaces = surfaces_beside(mesh, &holes);
    for (hole, surface) in holes.iter().zip(surfaces) {
        closed.loops += hole.loops.len();
        closed.triangles += hole.patch.triangles.len();
        add(mesh, &hole.patch, count);
        mesh.surfaces.resize(if mesh.surfaces.is_empty() { 0 } else { mesh.triangles.len() }, surface);
    }
    if closed.triangles > 0 {
        mesh.corner_normals.clear();
        mesh.corner_parameters.clear();
    }
    open.sort_by(|one, two| two.length.total_cmp(&one.length));
    ClosingReport { open, ..closed }
}

/// The loops of each plane together, and each that is in none on its own.
fn in_planes<'a>(loops: &'a [BoundaryLoop], mesh: &Mesh) -> Vec<Hole<'a>> {
    let mut holes: Vec<Hole<'a>> = Vec::new();
    // Holes whose planes face in about the same direction, whichever way.
    let mut facing: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for boundary in loops {
        let plane = LoopPlane::of(boundary, &mesh.vertices);
        let length = boundary.length(&mesh.vertices);
        let direction = plane.direction();
        let near = facing.range(direction - 1..=direction + 1).flat_map(|(_, holes)| holes).copied();
        let is_same = |hole: &usize| holes[*hole].plane.is_same(&plane, length.max(holes[*hole].length));
        match near.filter(|_| plane.is_flat).find(is_same) {
            Some(hole) => {
                holes[hole].loops.push(boundary);
                holes[hole].length += length;
                holes[hole].methods = &[Method::Projected];
            }
            None => {
                if plane.is_flat {
                    facing.entry(direction).or_default().push(holes.len());
                }
                holes.push(Hole::of(vec![boundary], mesh));
            }
        }
    }
    holes
}

/// The third corners of the triangles at the edges of loops.
fn third_corners(mesh: &Mesh, loops: &[BoundaryLoop]) -> ThirdCorners {
    let edges: HashSet<[u32; 2]> = loops.iter().flat_map(BoundaryLoop::edges).collect();
    let third = |&[a, b, c]: &[u32; 3]| [([b, a], c), ([c, b], a), ([a, c], b)];
    mesh.triangles.iter().flat_map(third).filter(|(edge, _)| edges.contains(edge)).collect()
}

fn open_loop(boundary: &BoundaryLoop, mesh: &Mesh) -> OpenLoop {
    let BoundaryLoop(points) = boundary;
    let near = points.first().map_or(glam::DVec3::ZERO, |&point| mesh.vertices[point as usize]);
    OpenLoop { edges: points.len(), length: boundary.length(&mesh.vertices), near }
}

/// Adds a patch that was made for a mesh with so many vertices.
fn add(mesh: &mut Mesh, ClosingPatch { triangles, vertex }: &ClosingPatch, count: usize) {
    let own = mesh.vertices.len() as u32;
    let number = |corner: u32| if corner as usize == count { own } else { corner };
    mesh.vertices.extend(*vertex);
    mesh.triangles.extend(triangles.iter().map(|corners| corners.map(number)));
}

/// For each hole the surface number of a triangle at its first edge; 0 where there are none.
fn surfaces_beside(mesh: &Mesh, holes: &[Hole]) -> Vec<u32> {
    if mesh.surfaces.is_empty() {
        return vec![0; holes.len()];
    }
    // The triangle runs the other way.
    let first = |hole: &Hole| hole.loops[0].edges().next().map(|[from, to]| [to, from]);
    let of_edge: HashMap<[u32; 2], usize> =
        holes.iter().map(first).zip(0..).filter_map(|(edge, k)| Some((edge?, k))).collect();
    let same = mesh.first_of_each_position();
    let mut surfaces = vec![0; holes.len()];
    for (corners, &surface) in mesh.triangles.iter().zip(&mesh.surfaces) {
        let [a, b, c] = corners.map(|corner| same[corner as usize]);
        for edge in [[a, b], [b, c], [c, a]] {
            if let Some(&hole) = of_edge.get(&edge) {
                surfaces[hole] = surface;
            }
        }
    }
    surfaces
}

/// The holes whose patches have more in common with the surface, or with the patch of a longer one, than edges, and
/// with what; by rising number.
fn blocked_holes(mesh: &Mesh, holes: &[Hole]) -> Vec<(usize, Obstacle)> {
    let mut tried = Mesh { vertices: mesh.vertices.clone(), triangles: mesh.triangles.clone(), ..Mesh::default() };
    let mut of_patch = Vec::new();
    for (hole, number) in holes.iter().zip(0..) {
        add(&mut tried, &hole.patch, mesh.vertices.len());
        of_patch.resize(tried.triangles.len() - mesh.triangles.len(), number);
    }
    let mut components = UnionFind::new(tried.triangles.len());
    let table = EdgeTable::of(&tried);
    for uses in table.edges.iter().map(|edge| table.uses(edge)) {
        uses.iter().for_each(|at| components.join(uses[0].triangle, at.triangle));
    }
    let first = mesh.triangles.len() as u32;
    let tile = |t: u32| NamedTriangle { names: tried.triangles[t as usize], corners: tried.corners(t as usize) };
    let sorted = TriangleBvh::new(&tried.vertices, &tried.triangles);
    let meet = |a: u32, b: u32| {
        // Those without an area are dissolved later; they are on the edges of others.
        let (one, two) = (tile(a).with_plane(), tile(b).with_plane());
        b >= first && !one.is_flat() && !two.is_flat() && overlap(&one, &tile(b), || two)
    };
    let mut met: BTreeMap<usize, Obstacle> = BTreeMap::new();
    for [a, b] in sorted.pairs_within(meet) {
        let what = if components.find(a) == components.find(b) { Obstacle::OwnComponent } else { Obstacle::Others };
        let known = met.entry(of_patch[(b - first) as usize]).or_insert(what);
        *known = what.max(*known);
    }
    met.into_iter().collect()
}
