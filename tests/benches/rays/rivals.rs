//! The others that run on the same rays: the hierarchies of the crate obvhs.

use std::time::{Duration, Instant};

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

use crate::sets::RaySet;
use crate::shapes::Shape;

enum Tree {
    Binary(Bvh2),
    Wide(CwBvh),
}

/// A hierarchy of obvhs with its triangles in the order of its leaves.
pub struct Hierarchy {
    tree: Tree,
    triangles: Vec<RtTriangle>,
    /// Which triangle of the mesh each of `triangles` is.
    indices: Vec<u32>,
    /// How long it took to build.
    pub build: Duration,
}

impl Hierarchy {
    /// Builds the binary hierarchy, or the eight-wide compressed one.
    pub fn build(shape: &Shape, wide: bool) -> Self {
        let point = |p: DVec3| Vec3A::from(p.as_vec3());
        let corners = |&[a, b, c]: &[u32; 3]| [a, b, c].map(|i| point(shape.vertices[i as usize]));
        let triangles: Vec<Triangle> =
            shape.triangles.iter().map(corners).map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect();
        let start = Instant::now();
        let parameters = BvhBuildParams::fast_build();
        let mut core = Duration::ZERO;
        let (tree, indices) = if wide {
            let tree = build_cwbvh_from_tris(&triangles, parameters, &mut core);
            let indices = tree.primitive_indices.clone();
            (Tree::Wide(tree), indices)
        } else {
            let tree = build_bvh2_from_tris(&triangles, parameters, &mut core);
            let indices = tree.primitive_indices.clone();
            (Tree::Binary(tree), indices)
        };
        let triangles = indices.iter().map(|&i| RtTriangle::from(&triangles[i as usize])).collect();
        Self { tree, triangles, indices, build: start.elapsed() }
    }

    /// Memory of nodes, triangles and indices, bytes.
    pub fn bytes(&self) -> usize {
        let nodes = match &self.tree {
            Tree::Binary(tree) => size_of_val(tree.nodes.as_slice()),
            Tree::Wide(tree) => size_of_val(tree.nodes.as_slice()),
        };
        nodes + size_of_val(self.triangles.as_slice()) + size_of_val(self.indices.as_slice())
    }

    /// The rays of a set as this crate wants them.
    pub fn prepare(set: &RaySet) -> Vec<Ray> {
        let vector = |p: DVec3| Vec3A::from(p.as_vec3());
        set.rays.iter().map(|ray| Ray::new(vector(ray.origin), vector(ray.direction), 0.0, set.t_max as f32)).collect()
    }

    /// The nearest hit: parameter and triangle of the mesh.
    #[inline]
    pub fn closest(&self, ray: Ray) -> Option<(f32, u32)> {
        let mut hit = RayHit::none();
        let found = match &self.tree {
            Tree::Binary(tree) => tree.ray_traverse(ray, &mut hit, |ray, i| self.triangles[i].intersect(ray)),
            Tree::Wide(tree) => tree.ray_traverse(ray, &mut hit, |ray, i| self.triangles[i].intersect(ray)),
        };
        found.then(|| (hit.t, self.indices[hit.primitive_id as usize]))
    }

    /// Whether anything is hit.
    #[inline]
    pub fn occluded(&self, ray: Ray) -> bool {
        match &self.tree {
            Tree::Binary(tree) => !tree.ray_traverse_miss(ray, |ray, i| self.triangles[i].intersect(ray)),
            Tree::Wide(tree) => !tree.ray_traverse_miss(ray, |ray, i| self.triangles[i].intersect(ray)),
        }
    }
}
