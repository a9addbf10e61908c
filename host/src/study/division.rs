//! The knob of subdivision: how many steps bring a polyhedron how near to its limit surface.

use super::{Knob, Options, Study, StudyError, Trial, sweep};
use crate::mesh::Mesh;
use crate::octree::{TriangleBvh, hausdorff};
use crate::render::Watch;
use crate::scene::{Prepared, Scene};
use crate::subdivision::Polyhedron;
use glam::DVec3;
use rayon::prelude::*;
use std::time::Instant;

/// Tolerance of the triangles that are subdivided, as a part of the diagonal of the scene.
const COARSE: f64 = 1.0 / 50.0;
/// Steps of the reference beyond those of the finest setting; its points lie on the limit surface.
const REFERENCE_STEPS: u32 = 1;
/// The most steps: each makes four times as many corners.
const MOST_STEPS: u32 = 6;
/// At most so many points of a surface are measured.
const MOST_SAMPLES: usize = 20_000;

/// Polyhedra of a scene.
struct Steps {
    polyhedra: Vec<Polyhedron>,
    most: u32,
}

/// Makes the study of a scene.
pub(super) fn study(scene: &Scene, options: &Options, watch: &Watch<'_>) -> Result<Study, StudyError> {
    let mut scene = scene.clone();
    scene.settings.geometry.tolerance = Some(Prepared::new(&scene)?.bounds.diagonal() * COARSE);
    scene.objects.iter_mut().for_each(|object| object.tolerance = None);
    let prepared = Prepared::new(&scene)?;
    let polyhedron = |object: &crate::scene::PreparedObject| {
        let triangles = prepared.triangles[object.first as usize..(object.first + object.count) as usize].to_vec();
        let mesh = Mesh { vertices: prepared.vertices.to_vec(), triangles, ..Mesh::default() };
        Polyhedron::from_mesh(&mesh).ok()
    };
    let polyhedra: Vec<Polyhedron> = prepared.objects.iter().filter_map(polyhedron).collect();
    if polyhedra.is_empty() {
        return Err(StudyError::Nothing("no object of the scene is a polyhedron"));
    }
    sweep(&Steps { polyhedra, most: options.settings.clamp(1, MOST_STEPS) }, watch)
}

impl Knob for Steps {
    type Answer = Vec<Mesh>;

    fn setting(&self) -> &'static str {
        "steps"
    }

    fn settings(&self) -> (Vec<f64>, f64) {
        ((0..self.most).map(f64::from).collect(), f64::from(self.most - 1 + REFERENCE_STEPS))
    }

    fn run(&self, setting: f64, _: &Watch<'_>) -> Result<Trial<Vec<Mesh>>, StudyError> {
        let start = Instant::now();
        let meshes: Result<Vec<Mesh>, StudyError> =
            self.polyhedra.iter().map(|polyhedron| Ok(polyhedron.subdivided(setting as usize)?.limit()?)).collect();
        let (answer, seconds) = (meshes?, start.elapsed().as_secs_f64());
        let triangles = answer.iter().map(|mesh| mesh.triangles.len()).sum::<usize>();
        Ok(Trial { answer, seconds, counts: vec![("triangles", triangles as f64)] })
    }

    fn error_names(&self) -> Vec<&'static str> {
        vec!["RMS normal angle (degrees)", "Hausdorff distance (scene units)", "RMS distance (scene units)"]
    }

    fn errors(&self, trial: &Trial<Vec<Mesh>>, reference: &Trial<Vec<Mesh>>) -> Result<Vec<f64>, StudyError> {
        let pairs = trial.answer.iter().zip(&reference.answer);
        let found: Vec<[f64; 2]> = pairs.flat_map(|(mesh, fine)| differences(mesh, fine)).collect();
        let root = |which: usize| {
            let squares: f64 = found.iter().map(|pair| pair[which] * pair[which]).sum();
            (squares / found.len().max(1) as f64).sqrt()
        };
        let pairs = trial.answer.iter().zip(&reference.answer);
        let farthest = pairs.map(|(mesh, fine)| hausdorff(mesh, fine, MOST_SAMPLES)).fold(0.0, f64::max);
        Ok(vec![root(0), farthest, root(1)])
    }
}

/// The angles, degrees, and the distances between corners of `fine`, with their normals, and `mesh`, with its planes.
fn differences(mesh: &Mesh, fine: &Mesh) -> Vec<[f64; 2]> {
    let sorted = TriangleBvh::new(&mesh.vertices, &mesh.triangles);
    let corners = |triangle: u32| mesh.corners(triangle as usize);
    let step = (fine.triangles.len() / MOST_SAMPLES).max(1);
    let of_triangle = |triangle: usize| {
        let point = fine.corners(triangle)[0];
        let nearest = sorted.nearest(point, corners)?;
        let plane = mesh.area_vector(nearest.triangle as usize);
        let normal = fine.corner_normals.get(triangle).map_or(DVec3::ZERO, |normals| normals[0]);
        let is_clear = plane != DVec3::ZERO && normal != DVec3::ZERO;
        let angle = if is_clear { plane.angle_between(normal).to_degrees() } else { 0.0 };
        Some([angle, nearest.distance])
    };
    let samples: Vec<usize> = (0..fine.triangles.len()).step_by(step).collect();
    samples.into_par_iter().filter_map(of_triangle).collect()
}
