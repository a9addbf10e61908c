//! The triangles of trimmed surfaces: a constrained Delaunay triangulation of the parameters that is refined until it
//! follows the surface.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::super::accuracy::{distances, lattice};
use super::super::tessellation::estimated_segments;
use super::super::{Surface, TessellationError, Tolerance};
use super::edges::Edges;
use super::{TrimError, TrimmedSurface};
use crate::mesh::Mesh;

/// The most that the scales of the two directions may differ.
const MOST_UNEVEN: f64 = 1e3;
/// The most triangles of a face, and of all of them.
const MAX_TRIANGLES: usize = 1 << 20;
const MAX_TRIANGLES_OF_ALL: usize = 1 << 24;
/// Faces that are refined at the same time.
const AT_ONCE: usize = 16;
/// The finest chord of an outline, as a part of what was asked for, that is tried for outlines that cross.
const FINEST_OUTLINE: f64 = 1e-4;
/// Rounds of refining; each halves the longest edges of the triangles that are too far away.
const MAX_ROUNDS: usize = 64;
/// The part of the chord that may be measured: a little more may be found between the places of measuring.
const MEASURED_PART: f64 = 0.85;
/// Where triangles are this part of the way over which an even bend would turn by the angle, they are not divided for the
/// sake of it: at a sharp edge or the tip of a cone the normals differ however near they are.
const SHARP: f64 = 0.3;
/// Triangles flatter than this, as height by length, are not divided in their middle.
const FLAT: f64 = 1e-4;
/// Steps of a side of the lattice where the triangles are measured as long as there are few.
const DENSE_STEPS: usize = 6;
const FEW_TRIANGLES: usize = 256;
/// Where the distance of a triangle from the surface is measured, as weights of its corners.
const MEASURED_AT: [[f64; 3]; 7] = {
    const T: f64 = 1.0 / 3.0;
    const N: f64 = 1.0 / 6.0;
    const F: f64 = 4.0 / 6.0;
    [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [T, T, T], [F, N, N], [N, F, N], [N, N, F]]
};

/// Approximates what is there of trimmed surfaces by triangles, as [`super::super::tessellate`] does for whole ones: with
/// exact normals and parameters at the corners, and the place of its surface in `faces` for each triangle.
///
/// Edges that several faces share are divided once, and their vertices serve all of them: there are no cracks.
///
/// # Errors
/// [`TrimError`] if the tolerance is not positive or too fine, a surface is not finite, or the loops of a face cross.
pub fn tessellate_trimmed<S: Surface>(faces: &[TrimmedSurface<S>], tolerance: Tolerance) -> Result<Mesh, TrimError> {
    let Tolerance { chord, angle } = tolerance;
    if !(chord > 0.0 && angle > 0.0) {
        return Err(TessellationError::Tolerance { chord, angle }.into());
    }
    // Outlines that are near each other may cross when they are coarse: then they are made finer.
    let mut outline = Tolerance::new(chord, angle);
    let (mut edges, regions) = loop {
        let edges = Edges::of(faces, outline)?;
        match regions(faces, &edges, tolerance) {
            Err(TrimError::Crossing { .. }) if outline.chord > FINEST_OUTLINE * chord => outline.chord *= 0.125,
            result => break (edges, result?),
        }
    };
    for &(a, b) in regions.iter().flat_map(|region| &region.same) {
        edges.join(a, b);
    }
    let mut mesh = Mesh::default();
    let mut outline: HashMap<usize, u32> = HashMap::new();
    for region in &regions {
        region.append(&mut mesh, &edges, &mut outline);
    }
    Ok(mesh)
}

/// The triangles of all faces over the vertices of their edges.
fn regions<'a, S: Surface>(
    faces: &'a [TrimmedSurface<S>],
    edges: &Edges,
    tolerance: Tolerance,
) -> Result<Vec<Region<'a, S>>, TrimError> {
    let outlined =
        faces.par_iter().enumerate().map(|(face, trimmed)| Region::outlined(face, trimmed, edges, tolerance));
    let mut regions = outlined.collect::<Result<Vec<_>, _>>()?;
    let mut triangles = 0;
    // Together they could be too many, so not all at once.
    for some in regions.chunks_mut(AT_ONCE) {
        let refined: Vec<Result<(), TrimError>> = some.par_iter_mut().map(|region| region.refine(tolerance)).collect();
        refined.into_iter().collect::<Result<(), _>>()?;
        triangles += some.iter().map(|region| 2 * region.corners.len()).sum::<usize>();
        if triangles > MAX_TRIANGLES_OF_ALL {
            let surface = some.first().map_or(0, |region| region.face);
            return Err(TessellationError::TooFine { surface, segments: triangles }.into());
        }
    }
    Ok(regions)
}

/// Approximates whole surfaces by triangles that are small only where the surface bends.
///
/// It keeps what [`super::super::tessellate`] keeps, takes fewer triangles for surfaces that are uneven, and more for even
/// ones, whose grids are hard to beat.
///
/// # Errors
/// [`TrimError`] if the tolerance is not positive or too fine, or a surface is not finite.
pub fn tessellate_adaptively<S: Surface>(surfaces: &[S], tolerance: Tolerance) -> Result<Mesh, TrimError> {
    let whole = |surface| TrimmedSurface::with_holes(surface, Vec::new());
    tessellate_trimmed(&surfaces.iter().map(whole).collect::<Result<Vec<_>, _>>()?, tolerance)
}

/// A corner of the triangulation.
struct Corner {
    uv: DVec2,
    position: DVec3,
    normal: DVec3,
    /// The vertex of the outline that it is.
    vertex: Option<usize>,
}

/// One face in the making.
struct Region<'a, S> {
    face: usize,
    surface: &'a S,
    /// The parameters, scaled as [`measures`] says.
    plane: ConstrainedDelaunayTriangulation<Point2<f64>>,
    scale: DVec2,
    corners: Vec<Corner>,
    /// Vertices of the outline that have the same parameters.
    same: Vec<(usize, usize)>,
    size: f64,
}

impl<'a, S: Surface> Region<'a, S> {
    fn outlined(
        face: usize,
        trimmed: &'a TrimmedSurface<S>,
        edges: &Edges,
        tolerance: Tolerance,
    ) -> Result<Region<'a, S>, TrimError> {
        let surface = &trimmed.surface;
        let (scale, size) = measures(surface, tolerance).ok_or(TessellationError::NotFinite { surface: face })?;
        let plane = ConstrainedDelaunayTriangulation::new();
        let mut region = Region { face, surface, plane, scale, corners: Vec::new(), same: Vec::new(), size };
        for ring in 0..trimmed.loops.len() {
            let corners = edges.corners(face, ring, trimmed);
            let handles = corners
                .iter()
                .map(|&(uv, vertex)| region.insert(uv, Some(vertex)).ok_or(TrimError::Crossing { face, at: uv }))
                .collect::<Result<Vec<FixedVertexHandle>, _>>()?;
            for (k, &from) in handles.iter().enumerate() {
                let to = handles[(k + 1) % handles.len()];
                if from == to {
                    continue;
                }
                if !region.plane.can_add_constraint(from, to) || region.plane.exists_constraint(from, to) {
                    return Err(TrimError::Crossing { face, at: corners[k].0 });
                }
                region.plane.add_constraint(from, to);
            }
        }
        Ok(region)
    }

    /// Another corner; `None` if its parameters are no numbers.
    fn insert(&mut self, uv: DVec2, vertex: Option<usize>) -> Option<FixedVertexHandle> {
        let at = uv * self.scale;
        // Numbers too small for the triangulation are as good as zero.
        let small = |x: f64| if x.abs() < 1e-100 { 0.0 } else { x };
        let handle = self.plane.insert(Point2::new(small(at.x), small(at.y))).ok()?;
        if let Some(known) = self.corners.get(handle.index()) {
            self.same.extend(known.vertex.zip(vertex));
        } else {
            let (position, normal) = (self.surface.point(uv), self.surface.normal(uv));
            self.corners.push(Corner { uv, position, normal, vertex });
        }
        Some(handle)
    }

    /// The triangles that are there: those that an odd number of constraints divides from the outside.
    fn triangles(&self) -> Vec<[usize; 3]> {
        let mut is_inside: Vec<Option<bool>> = vec![None; self.plane.num_all_faces()];
        let outer = self.plane.outer_face().fix();
        is_inside[outer.index()] = Some(false);
        let mut stack: Vec<_> = self.plane.convex_hull().map(|edge| edge.fix()).collect();
        while let Some(edge) = stack.pop() {
            let edge = self.plane.directed_edge(edge);
            let from = is_inside[edge.face().fix().index()].unwrap_or(false);
            let face = edge.rev().face();
            if is_inside[face.fix().index()].is_none() {
                is_inside[face.fix().index()] = Some(from ^ edge.is_constraint_edge());
                stack.extend(face.as_inner().into_iter().flat_map(|face| face.adjacent_edges()).map(|edge| edge.fix()));
            }
        }
        let there = self.plane.inner_faces().filter(|face| is_inside[face.fix().index()] == Some(true));
        there.map(|face| face.vertices().map(|vertex| vertex.fix().index())).collect()
    }

    /// Adds corners until all triangles are near enough.
    fn refine(&mut self, tolerance: Tolerance) -> Result<(), TrimError> {
        for _ in 0..MAX_ROUNDS {
            let triangles = self.triangles();
            if triangles.len() > MAX_TRIANGLES {
                let segments = triangles.len();
                return Err(TessellationError::TooFine { surface: self.face, segments }.into());
            }
            // While the triangles are few and large, something may hide between a few places of measuring.
            let dense = lattice(DENSE_STEPS);
            let places = if triangles.len() < FEW_TRIANGLES { &dense[..] } else { &MEASURED_AT[..] };
            let is_far = |triangle: &[usize; 3]| self.is_far(*triangle, tolerance, places);
            let far = triangles.par_iter().map(is_far).collect::<Vec<bool>>();
            let wanted: Vec<_> =
                triangles.iter().zip(far).filter(|(_, far)| *far).map(|(triangle, _)| *triangle).collect();
            if wanted.is_empty() {
                return Ok(());
            }
            let mut divided = HashSet::new();
            let places: Vec<DVec2> =
                wanted.into_iter().filter_map(|triangle| self.division(triangle, &mut divided)).collect();
            let before = self.corners.len();
            for uv in places {
                self.insert(uv, None);
            }
            if self.corners.len() == before {
                break;
            }
        }
        self.check(tolerance.chord)
    }

    /// Whether what could not be divided is near enough after all: by its nearest points, which are nearer than those of
    /// equal parameters where the parameters are uneven.
    fn check(&self, chord: f64) -> Result<(), TrimError> {
        let off = self.triangles().into_iter().filter(|triangle| self.distance(*triangle, &MEASURED_AT) > chord);
        let nearest = |triangle: [usize; 3]| {
            let positions = triangle.map(|corner| self.corners[corner].position);
            distances(self.surface, positions, triangle.map(|corner| self.corners[corner].uv), &MEASURED_AT).0
        };
        let error = off.map(nearest).fold(0.0, f64::max);
        if error <= chord { Ok(()) } else { Err(TessellationError::NotReached { surface: self.face, error }.into()) }
    }

    /// Whether a triangle is too far from the surface, or its normals differ by too much.
    fn is_far(&self, triangle: [usize; 3], tolerance: Tolerance, places: &[[f64; 3]]) -> bool {
        if self.distance(triangle, places) > MEASURED_PART * tolerance.chord {
            return true;
        }
        let [a, b, c] = triangle.map(|corner| &self.corners[corner]);
        let longest =
            a.position.distance(b.position).max(b.position.distance(c.position)).max(c.position.distance(a.position));
        let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| a.normal.angle_between(b.normal).to_degrees());
        turns.into_iter().any(|turn| turn > tolerance.angle) && longest > self.size * (SHARP * tolerance.angle / 360.0)
    }

    /// The distance between a triangle and the surface as measured at `places`, the weights of its corners.
    fn distance(&self, triangle: [usize; 3], places: &[[f64; 3]]) -> f64 {
        let [a, b, c] = triangle.map(|corner| &self.corners[corner]);
        let off = places.iter().map(|[x, y, z]| {
            let uv = a.uv * *x + b.uv * *y + c.uv * *z;
            let offset = a.position * *x + b.position * *y + c.position * *z - self.surface.point(uv);
            offset.dot(self.surface.normal(uv)).abs()
        });
        off.fold(0.0, f64::max)
    }

    /// Where to divide a triangle: in the middle of its longest edge, or, where that belongs to the outline, in its own
    /// middle. `None` if the edge has been divided.
    fn division(&self, triangle: [usize; 3], divided: &mut HashSet<[usize; 2]>) -> Option<DVec2> {
        let scaled = |corner: usize| self.corners[corner].uv * self.scale;
        let edges = [0, 1, 2].map(|k| [triangle[k], triangle[(k + 1) % 3]]);
        let length = |[a, b]: [usize; 2]| scaled(a).distance_squared(scaled(b));
        let [a, b] = edges.into_iter().max_by(|x, y| length(*x).total_cmp(&length(*y)))?;
        let handle = FixedVertexHandle::from_index;
        if self.plane.exists_constraint(handle(a), handle(b)) {
            let [p, q, r] = triangle.map(scaled);
            let is_flat = (q - p).perp_dot(r - p).abs() < FLAT * length([a, b]);
            return (!is_flat).then(|| triangle.iter().map(|corner| self.corners[*corner].uv).sum::<DVec2>() / 3.0);
        }
        divided.insert([a.min(b), a.max(b)]).then(|| (self.corners[a].uv + self.corners[b].uv) * 0.5)
    }

    /// Puts the triangles into a mesh; `outline` knows the vertices of outlines that are in it.
    fn append(&self, mesh: &mut Mesh, edges: &Edges, outline: &mut HashMap<usize, u32>) {
        let mut own: Vec<Option<u32>> = vec![None; self.corners.len()];
        for triangle in self.triangles() {
            let vertices = triangle.map(|index| {
                let corner = &self.corners[index];
                let mut add = |position: DVec3| {
                    mesh.vertices.push(position);
                    mesh.vertices.len() as u32 - 1
                };
                match corner.vertex.map(|vertex| edges.root(vertex)) {
                    Some(root) => *outline.entry(root).or_insert_with(|| add(edges.position(root))),
                    None => *own[index].get_or_insert_with(|| add(corner.position)),
                }
            });
            let [a, b, c] = vertices;
            if a == b || b == c || c == a {
                continue;
            }
            mesh.triangles.push(vertices);
            mesh.corner_normals.push(triangle.map(|index| self.corners[index].normal));
            mesh.corner_parameters.push(triangle.map(|index| self.corners[index].uv));
            mesh.surfaces.push(self.face as u32);
        }
    }
}

/// The scale of the parameters in which triangles with equal sides serve the tolerance best, and the length of the surface
/// in space; `None` if a point is not finite.
fn measures<S: Surface>(surface: &S, tolerance: Tolerance) -> Option<(DVec2, f64)> {
    const STEPS: usize = 8;
    let [low, high] = surface.domain();
    let at = |i: usize, j: usize| surface.point(low + (high - low) * DVec2::new(i as f64, j as f64) / STEPS as f64);
    let (mut along_u, mut along_v) = (0.0, 0.0);
    for i in 0..=STEPS {
        for j in 0..STEPS {
            along_u += at(j, i).distance(at(j + 1, i));
            along_v += at(i, j).distance(at(i, j + 1));
        }
    }
    let wanted = DVec2::from_array(estimated_segments(surface, tolerance)?).max(DVec2::ONE);
    // A direction that bends much more than the other: needles beyond this would help no more.
    let wanted = wanted.max(DVec2::splat(wanted.max_element() / MOST_UNEVEN));
    Some((wanted / (high - low), f64::max(along_u, along_v) / (STEPS + 1) as f64))
}
