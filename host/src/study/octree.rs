//! The knobs of the octree: leaf size and depth. They change no answer, only what it costs.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::numeric::ray::{Hit, Ray};
use crate::numeric::sampling::{RandomStream, sphere};
use crate::octree::brute_force::{Agreement, agreement, closest_many};
use crate::octree::{Octree, OctreeSettings, Walk};
use crate::render::Watch;
use crate::scene::{Prepared, Scene};
use rayon::prelude::*;
use std::time::Instant;

/// What is set.
#[derive(Clone, Copy, PartialEq)]
enum OctreeParameter {
    LeafTriangles,
    Depth,
}

/// Octrees of a scene, and rays through them.
struct OctreeStudy {
    prepared: Prepared,
    rays: Vec<Ray>,
    settings: u32,
    parameter: OctreeParameter,
}

/// What the rays hit: down the index, and from cell to cell.
struct Hits {
    hits: [Vec<Option<Hit>>; 2],
}

/// Makes the study of the leaf size.
pub(super) fn leaf_size(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    sweep(&OctreeStudy::new(scene, options, OctreeParameter::LeafTriangles)?, watch)
}

/// Makes the study of the depth.
pub(super) fn depth(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    sweep(&OctreeStudy::new(scene, options, OctreeParameter::Depth)?, watch)
}

impl OctreeStudy {
    fn new(scene: &Scene, options: &Options, what: OctreeParameter) -> Result<OctreeStudy, StudyError> {
        let mut scene = scene.clone();
        scene.settings.geometry.copies_instances = true;
        let prepared = Prepared::new(&scene)?;
        if prepared.triangles.is_empty() {
            return Err(StudyError::Nothing("the scene has no triangles"));
        }
        let (center, radius) = (prepared.bounds.center(), prepared.bounds.diagonal() * 0.5);
        // Chords of the sphere around the scene, as many as a square picture of the width has pixels.
        let chord = |index| {
            let mut stream = RandomStream::new(prepared.settings.image.seed, index);
            let [from, to] = [0; 2].map(|_| center + sphere(stream.point()) * radius);
            Ray { origin: from, direction: to - from }
        };
        let rays = (0..u64::from(options.width).pow(2)).map(chord).collect();
        Ok(OctreeStudy { prepared, rays, settings: options.settings.clamp(1, 16), parameter: what })
    }

    fn reference(&self) -> f64 {
        match self.parameter {
            // All triangles in one leaf.
            OctreeParameter::LeafTriangles => self.prepared.triangles.len() as f64,
            OctreeParameter::Depth => 0.0,
        }
    }
}

impl Knob for OctreeStudy {
    type Answer = Hits;

    fn setting(&self) -> &'static str {
        match self.parameter {
            OctreeParameter::LeafTriangles => "triangles in a leaf",
            OctreeParameter::Depth => "levels",
        }
    }

    fn settings(&self) -> (Vec<f64>, f64) {
        let tried = (0..self.settings).map(|i| match self.parameter {
            OctreeParameter::LeafTriangles => 2f64.powi(i as i32),
            OctreeParameter::Depth => f64::from(i) + 1.0,
        });
        (tried.collect(), self.reference())
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Hits>, StudyError> {
        let (vertices, triangles) = (&self.prepared.vertices, &self.prepared.triangles);
        if setting == self.reference() {
            let hits = closest_many(vertices, triangles, &self.rays, 0.0, f64::INFINITY);
            return Ok(Trial { answer: Hits { hits: [hits.clone(), hits] }, seconds: 0.0, counts: Vec::new() });
        }
        let settings = match self.parameter {
            OctreeParameter::LeafTriangles => {
                OctreeSettings { leaf_triangles: setting as usize, ..OctreeSettings::default() }
            }
            OctreeParameter::Depth => OctreeSettings { depth: setting as u32, ..OctreeSettings::default() },
        };
        let walk = |octree: &Octree| {
            let start = Instant::now();
            let hit = |ray| octree.closest(ray, 0.0, f64::INFINITY);
            let hits: Vec<_> = self.rays.par_iter().with_min_len(256).map(hit).collect();
            (hits, start.elapsed().as_secs_f64())
        };
        let start = Instant::now();
        let octree = Octree::build(vertices, triangles, &settings)?.divided();
        let build = start.elapsed().as_secs_f64();
        let megabytes = octree.statistics().bytes as f64 / 1e6;
        let (by_index, index) = walk(&octree);
        let (by_cells, cells) = walk(&octree.with_walk(Walk::LeadingDirection));
        let counts = vec![
            ("build (s)", build),
            ("rays down the index (s)", index),
            ("rays from cell to cell (s)", cells),
            ("memory (MB)", megabytes),
        ];
        Ok(Trial { answer: Hits { hits: [by_index, by_cells] }, seconds: build + index + cells, counts })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["rays that differ"]
    }

    fn errors(&self, trial: &Trial<Hits>, reference: &Trial<Hits>) -> Result<Vec<f64>, StudyError> {
        let pairs = trial.answer.hits.iter().flatten().zip(reference.answer.hits.iter().flatten());
        let differ = pairs.filter(|(one, other)| agreement(**one, **other) == Agreement::Differ).count();
        Ok(vec![differ as f64])
    }
}
