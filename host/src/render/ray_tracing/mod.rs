//! Ray tracing over the linear octree: direct light with shadows, and mirrors.
//!
//! Each pixel is the mean over its area (a box filter, so that coverage is the covered share of the area), sampled
//! at the points of a lattice that is shifted at random from pixel to pixel.

mod eye;
mod sample;
mod surface;
mod tracer;

#[cfg(test)]
mod tests;

pub use tracer::ENERGY_CUTOFF;

use super::{Order, RayCounts, RenderError, Renderer, Rendering, Watch};
use crate::octree::{Octree, Settings as OctreeSettings};
use crate::picture::{Picture, Pixel};
use crate::plan::{Plan, Stage};
use crate::scene::{Prepared, View};
use eye::Eye;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use tracer::Tracer;

/// A ray tracer that holds a scene and its octree.
pub struct RayTracer<'a> {
    prepared: &'a Prepared,
    plan: &'a Plan,
    /// None if the plan needs no octree.
    octree: Option<Octree>,
    /// The triangle of the scene behind each triangle of the octree; empty if they are the same.
    triangle_of: Vec<u32>,
}

impl<'a> RayTracer<'a> {
    /// Builds the octree over the objects that the plan keeps.
    ///
    /// # Errors
    /// [`RenderError::Octree`].
    pub fn new(prepared: &'a Prepared, plan: &'a Plan) -> Result<RayTracer<'a>, RenderError> {
        let keeps = |triangle: &u32| plan.keeps_object(prepared.object_of[*triangle as usize] as usize);
        let all = (0..prepared.objects.len()).all(|i| plan.keeps_object(i));
        let settings = OctreeSettings::default();
        let mut triangle_of = Vec::new();
        let octree = if !plan.needs(Stage::Octree) || prepared.triangles.is_empty() {
            None
        } else if all {
            Some(Octree::build(&prepared.vertices, &prepared.triangles, &settings)?)
        } else {
            triangle_of = (0..prepared.triangles.len() as u32).filter(keeps).collect();
            let kept: Vec<[u32; 3]> = triangle_of.iter().map(|&t| prepared.triangles[t as usize]).collect();
            Some(Octree::build(&prepared.vertices, &kept, &settings)?)
        };
        Ok(RayTracer { prepared, plan, octree, triangle_of })
    }

    /// The octree, if the plan needs one.
    pub fn octree(&self) -> Option<&Octree> {
        self.octree.as_ref()
    }
}

impl Renderer for RayTracer<'_> {
    fn name(&self) -> &'static str {
        "ray tracing"
    }

    fn render(&self, view: &View, order: &Order, watch: &Watch<'_>) -> Result<Rendering, RenderError> {
        let start = Instant::now();
        let mut picture = Picture::new(order.width, order.height)?;
        let eye = Eye::new(view, order.width, order.height, &self.prepared.bounds).ok_or(RenderError::View)?;
        let tracer = Tracer::new(self.prepared, self.plan, self.octree.as_ref(), &self.triangle_of);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(order.threads.map_or(0, |n| n.get())).build()?;
        let done = AtomicU64::new(0);
        let width = order.width as usize;
        let results: Vec<Option<RayCounts>> = pool.install(|| {
            let rows = picture.pixels_mut().par_chunks_exact_mut(width).enumerate();
            rows.map(|(y, row)| {
                if watch.is_cancelled() {
                    return None;
                }
                let mut counts = RayCounts::default();
                for (x, pixel) in row.iter_mut().enumerate() {
                    *pixel = render_pixel(&tracer, &eye, order, [x as u32, y as u32], &mut counts);
                }
                (watch.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(order.height));
                Some(counts)
            })
            .collect()
        });
        Ok(Rendering {
            picture,
            rows: results.iter().map(Option::is_some).collect(),
            rays: results.into_iter().flatten().fold(RayCounts::default(), |a, b| a + b),
            seconds: start.elapsed().as_secs_f64(),
            threads: pool.current_num_threads(),
        })
    }
}

fn render_pixel(tracer: &Tracer<'_>, eye: &Eye, order: &Order, [x, y]: [u32; 2], counts: &mut RayCounts) -> Pixel {
    let index = u64::from(y) * u64::from(order.width) + u64::from(x);
    let (mut sum, mut covered) = (DVec3::ZERO, 0u32);
    for position in sample::positions(order.samples, order.seed, index) {
        let at = [f64::from(x) + position[0], f64::from(y) + position[1]];
        let (radiance, hit) = match eye.ray(at) {
            Some(sight) => tracer.radiance(&sight, counts),
            None => (tracer.background(), false),
        };
        sum += radiance;
        covered += u32::from(hit);
    }
    let share = 1.0 / f64::from(order.samples.max(1));
    Pixel { radiance: (sum * share).as_vec3().to_array(), coverage: (f64::from(covered) * share) as f32 }
}
