//! The octree of the paper's two-way ray tracing: every node is a voxel, and a point of the surface in it stands for
//! it.
//!
//! In a voxel that holds one surface a point of it is sampled at random and kept. A ray that hits the surface there
//! hits this point, with its normal, whatever triangles the voxel has. So what rays tell is off by about a voxel: to be
//! used where voxels are small beside what matters. Voxels that hold more than one surface, or one that bends, keep
//! their triangles. Where a surface ends within a voxel, its point stands for it up to the voxel's sides.

use super::build::{Leaves, Nodes, OctreeBuilder, PARALLEL_TRIANGLES, TriangleReference, octants, place};
use super::clip::clipped;
use super::prepared_ray::PreparedRay;
use super::walk::Search;
use super::wide_bvh::WideBvh;
use super::{Hit, LocationalCode, Octree, Ray};
use crate::numeric::sampling::{RandomStream, triangle};
use crate::numeric::triangle::weights;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::OnceLock;

/// The highest resolution: voxels grow by a factor of four from one to the next, and take about 40 bytes each.
pub const MAX_POINT_DEPTH: u32 = 11;

/// How far a surface may be from the plane of a point that stands for it, sides of a voxel.
const FLAT: f64 = 0.25;
/// The cosine between their normals at the least.
const LEVEL: f64 = 0.5;
/// So far from where a ray begins triangles count, sides of a voxel: around it is the surface that the ray leaves, and
/// planes of its points would occlude the ray.
const CLEAR: f64 = 2.0;
/// How far beyond its voxel a plane counts, sides of the voxel: planes of neighbours do not quite meet, and no ray is
/// to slip between them.
const SLACK: f64 = 0.5;
/// Cells above this level are divided at once.
const PARALLEL_LEVELS: u32 = 3;

/// Voxels with points that stand for the surface in them. Threads share it freely.
#[derive(Clone, Debug)]
pub struct SurfacePoints {
    /// Its terminal nodes are voxels.
    octree: Octree,
    /// For each of these its point.
    pub(super) points: Vec<Option<VoxelPoint>>,
    /// Side of a voxel, sides of the modelling cube.
    side: f64,
}

/// A point on a triangle, by two barycentric coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VoxelPoint {
    triangle: u32,
    u: f32,
    v: f32,
}

impl SurfacePoints {
    /// Finds the voxels of an octree's triangles and a point for each that holds one surface; on all threads.
    ///
    /// - `depth`: 2 to this power voxels are along the modelling cube; at most [`MAX_POINT_DEPTH`], more counts as
    ///   that.
    /// - `surface`: which surface a triangle belongs to; none for one that no point may stand for.
    /// - `seed`: of the choice of points, which does not depend on the number of threads.
    pub fn new<S: PartialEq>(
        octree: &Octree,
        depth: u32,
        surface: impl Fn(u32) -> Option<S> + Sync,
        seed: u64,
    ) -> SurfacePoints {
        let depth = depth.min(MAX_POINT_DEPTH);
        let division = OctreeBuilder { depth, grain: PARALLEL_TRIANGLES, ..octree.division() };
        let leaves = voxels(&division, LocationalCode::ROOT, division.references(0..octree.triangles.len()));
        let point = |leaf: usize| point(&division, leaves.codes[leaf], leaves.of(leaf), &surface, seed);
        let points = (0..leaves.codes.len()).into_par_iter().map(point).collect();
        let nodes = OnceLock::from(Nodes { homes: Vec::new(), leaves });
        let octree = Octree { depth, nodes, index: WideBvh::default(), ..octree.clone() };
        SurfacePoints { octree, points, side: 0.5_f64.powi(depth as i32) }
    }

    /// Number of voxels that hold surface.
    pub fn voxels(&self) -> usize {
        self.points.len()
    }

    /// Number of voxels in which a point stands for it.
    pub fn points(&self) -> usize {
        self.points.iter().flatten().count()
    }

    /// Side of a voxel, world units.
    pub fn side(&self) -> f64 {
        self.side * self.octree.cube.side
    }

    /// Finds the nearest hit with `t_min < t < t_max`, both exclusive: of a triangle, or of the plane of a point that
    /// stands for one. The hit of a point is where the point is on its triangle, off the ray by about a voxel; `t` is
    /// where the ray hits its plane.
    pub fn closest(&self, ray: &Ray, t_min: f64, t_max: f64) -> Option<Hit> {
        let line = PreparedRay::new(ray, &self.octree.cube, t_min, t_max)?;
        let mut search = Search::new(&self.octree, &line, t_min, t_max, false);
        search.walk_with(|search, leaf, [enter, exit]| match self.points[leaf] {
            Some(kept) if enter > CLEAR * self.side => {
                let [a, b, c] = self.octree.corners(kept.triangle);
                let normal = (b - a).cross(c - a);
                let t = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
                let along = line.single.along(t);
                let slack = SLACK * self.side;
                if along > enter - slack && along < exit + slack {
                    search.offer(Hit { t, triangle: kept.triangle, u: kept.u.into(), v: kept.v.into() });
                }
                false
            }
            _ => search.any_of_leaf(leaf),
        });
        search.found().0
    }
}

/// All voxels in a cell, with the triangles that touch them.
fn voxels(division: &OctreeBuilder<'_>, cell: LocationalCode, references: Vec<TriangleReference>) -> Leaves {
    let mut leaves = Leaves::default();
    if references.is_empty() {
        return leaves;
    }
    if cell.level() >= division.depth {
        leaves.push(cell, references.iter().map(|reference| reference.triangle));
        return leaves;
    }
    let parts: Vec<_> = octants(cell).zip(division.distribute(cell, &references)).collect();
    drop(references);
    let divide = |(octant, references)| voxels(division, octant, references);
    let parts: Vec<Leaves> = match cell.level() < PARALLEL_LEVELS {
        true => parts.into_par_iter().map(divide).collect(),
        false => parts.into_iter().map(divide).collect(),
    };
    parts.iter().for_each(|part| leaves.append(part, 0..part.codes.len()));
    leaves
}

/// A point for a voxel, sampled evenly from the surface in it; none if that is not one, or bends.
fn point<S: PartialEq>(
    division: &OctreeBuilder<'_>,
    voxel: LocationalCode,
    triangles: &[u32],
    surface: impl Fn(u32) -> Option<S>,
    seed: u64,
) -> Option<VoxelPoint> {
    let first = surface(*triangles.first()?)?;
    if triangles.iter().any(|triangle| surface(*triangle).as_ref() != Some(&first)) {
        return None;
    }
    let (low, half) = place(voxel);
    let high = low.map(|x| x + 2.0 * half);
    let polygons: Vec<(u32, Vec<DVec3>)> = triangles
        .iter()
        .map(|triangle| {
            let (corners, count) = clipped(division.corners(*triangle), low, high);
            (*triangle, corners[..count].iter().map(|corner| DVec3::from_array(*corner)).collect())
        })
        .collect();
    let fans = polygons.iter().flat_map(|(triangle, corners)| {
        corners.windows(2).skip(1).map(|edge| (*triangle, [corners[0], edge[0], edge[1]]))
    });
    let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
    let whole: f64 = fans.clone().map(|(_, corners)| area(corners)).sum();
    let mut stream = RandomStream::new(seed, voxel.bits());
    let mut left = stream.uniform() * whole;
    let (triangle_of, [a, b, c]) =
        fans.filter(|(_, corners)| area(*corners) > 0.0).find_map(|(triangle, corners)| {
            left -= area(corners);
            (left <= 0.0).then_some((triangle, corners))
        })?;
    let [u, v] = triangle(stream.point());
    let at = a * (1.0 - u - v) + b * u + c * v;
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).try_normalize();
    let up = normal(division.corners(triangle_of))?;
    let is_level = |triangle: u32| normal(division.corners(triangle)).is_some_and(|n| n.dot(up) >= LEVEL);
    let is_near = |corner: &DVec3| (*corner - at).dot(up).abs() <= FLAT * 2.0 * half;
    if !polygons.iter().all(|(triangle, corners)| is_level(*triangle) && corners.iter().all(is_near)) {
        return None;
    }
    let [_, u, v] = weights(division.corners(triangle_of), at);
    Some(VoxelPoint { triangle: triangle_of, u: u as f32, v: v as f32 })
}
