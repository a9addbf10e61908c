//! The hierarchies of the crates `bvh` and `parry3d` on the same rays. Both are given single precision.

use std::time::Duration;

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use glam::Vec3A;
use nalgebra::{Point3, Vector3};
use obvhs::ray::Ray;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use parry3d::math::Vector;
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;

use crate::processor_seconds;
use crate::sets::RaySet;
use crate::shapes::Shape;

/// A triangle as `bvh` wants it; it brings no test of both sides of a triangle, so that of `obvhs` decides.
struct Facet {
    triangle: RtTriangle,
    bounds: Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Facet {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Facet {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The hierarchy of `bvh`.
pub struct Binary {
    tree: Bvh<f32, 3>,
    facets: Vec<Facet>,
    /// How long it took to build.
    pub build: Duration,
}

impl Binary {
    /// Builds it.
    pub fn build(shape: &Shape) -> Self {
        let corners = |&[a, b, c]: &[u32; 3]| [a, b, c].map(|i| Vec3A::from(shape.vertices[i as usize].as_vec3()));
        let start = processor_seconds();
        let facet = |[v0, v1, v2]: [Vec3A; 3]| {
            let point = |p: Vec3A| Point3::new(p.x, p.y, p.z);
            let bounds = Aabb::with_bounds(point(v0.min(v1).min(v2)), point(v0.max(v1).max(v2)));
            Facet { triangle: RtTriangle::from(&Triangle { v0, v1, v2 }), bounds, node: 0 }
        };
        let mut facets: Vec<Facet> = shape.triangles.iter().map(corners).map(facet).collect();
        let tree = Bvh::build(&mut facets);
        Self { tree, facets, build: Duration::from_secs_f64(processor_seconds() - start) }
    }

    /// The rays of a set as this crate wants them, with those of the test of triangles.
    pub fn prepare(set: &RaySet, singles: &[Ray]) -> Vec<(bvh::ray::Ray<f32, 3>, Ray)> {
        let ray = |(ray, single): (&host::octree::Ray, &Ray)| {
            let (from, towards) = (ray.origin.as_vec3(), ray.direction.as_vec3());
            let origin = Point3::new(from.x, from.y, from.z);
            (bvh::ray::Ray::new(origin, Vector3::new(towards.x, towards.y, towards.z)), *single)
        };
        set.rays.iter().zip(singles).map(ray).collect()
    }

    /// Whether anything is hit; for the nearest hit all boxes that the ray meets are looked into.
    pub fn hits(&self, (ray, single): &(bvh::ray::Ray<f32, 3>, Ray), any: bool) -> bool {
        let mut single = *single;
        let mut found = false;
        for facet in self.tree.traverse_iterator(ray, &self.facets) {
            let t = facet.triangle.intersect(&single);
            if t < single.tmax {
                (single.tmax, found) = (t, true);
                if any {
                    break;
                }
            }
        }
        found
    }
}

/// The triangle mesh of `parry3d`.
pub struct Parry {
    mesh: TriMesh,
    /// How long it took to build.
    pub build: Duration,
}

impl Parry {
    /// Builds it.
    pub fn build(shape: &Shape) -> Self {
        let vector = |p: &glam::DVec3| Vector::new(p.x as f32, p.y as f32, p.z as f32);
        let start = processor_seconds();
        let vertices = shape.vertices.iter().map(vector).collect();
        let mesh = TriMesh::new(vertices, shape.triangles.clone()).expect("a sound mesh");
        Self { mesh, build: Duration::from_secs_f64(processor_seconds() - start) }
    }

    /// The rays of a set as this crate wants them.
    pub fn prepare(set: &RaySet) -> Vec<parry3d::query::Ray> {
        let vector = |p: glam::DVec3| Vector::new(p.x as f32, p.y as f32, p.z as f32);
        set.rays.iter().map(|ray| parry3d::query::Ray::new(vector(ray.origin), vector(ray.direction))).collect()
    }

    /// Whether anything is hit before `t_max`; it has no search for any hit.
    pub fn hits(&self, ray: &parry3d::query::Ray, t_max: f64) -> bool {
        self.mesh.cast_local_ray(ray, t_max as f32, false).is_some()
    }
}
