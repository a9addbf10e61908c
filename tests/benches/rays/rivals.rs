//! The others that run on the same rays: the hierarchies of the crate obvhs, and Embree.

use std::process::Command;
use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

use crate::processor_seconds;
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
    /// The triangle of the mesh that each of `triangles` is.
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
        let start = processor_seconds();
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
        Self { tree, triangles, indices, build: Duration::from_secs_f64(processor_seconds() - start) }
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

/// What Embree needs.
pub struct Embree {
    /// Processor time of building, with all threads.
    pub build: Duration,
    /// Millions of rays per second, one figure a set.
    pub rates: Vec<f64>,
}

/// Measures Embree through the Python package `embreex`.
///
/// # Errors
/// A line that says why there is nothing.
pub fn embree(shape: &Shape, sets: &[RaySet]) -> Result<Embree, String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let installed = Command::new(&python).args(["-c", "import embreex, numpy"]).output();
    if !installed.is_ok_and(|output| output.status.success()) {
        return Err("not installed".to_owned());
    }
    let mut numbers: Vec<f64> = vec![shape.vertices.len() as f64, shape.triangles.len() as f64];
    numbers.extend(sets.iter().map(|set| set.rays.len() as f64));
    numbers.extend(shape.vertices.iter().flat_map(|p| p.to_array()));
    numbers.extend(shape.triangles.iter().flatten().map(|&i| f64::from(i)));
    let rays = sets.iter().flat_map(|set| &set.rays);
    numbers.extend(rays.flat_map(|ray| [ray.origin.to_array(), ray.direction.to_array()]).flatten());
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let file = tempfile::NamedTempFile::new().map_err(|error| error.to_string())?;
    std::fs::write(file.path(), bytes).map_err(|error| error.to_string())?;
    let script = include_str!("embree.py");
    let output =
        Command::new(&python).args(["-c", script]).arg(file.path()).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let figures: Vec<f64> = text.lines().filter_map(|line| line.split(' ').next()?.parse().ok()).collect();
    if let [build, rates @ ..] = figures.as_slice()
        && rates.len() == sets.len()
    {
        return Ok(Embree { build: Duration::from_secs_f64(*build), rates: rates.to_vec() });
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Err(errors.lines().last().unwrap_or("failed without a message").to_owned())
}
