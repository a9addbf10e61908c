//! Rocks as a procedural model.

use super::made_mesh::MadeMesh;
use super::object::{Object, ProceduralModel, Shape};
use crate::illumination::Material;
use crate::numeric::bounds::Bounds;
use crate::procedural::rock::{Rock, RockError, RockNumbers};
use glam::{DMat4, DVec3};
use std::sync::Arc;

/// Rocks of some numbers, each of the kinds another one.
#[derive(Debug)]
pub struct RockModel {
    numbers: RockNumbers,
    seed: u32,
    rocks: Vec<Rock>,
}

impl RockModel {
    /// Rocks.
    ///
    /// - `seed`: of the first kind; the others have those that follow.
    /// - `kinds`: how many there are.
    ///
    /// # Errors
    /// [`RockError`] for a number out of range.
    pub fn new(numbers: RockNumbers, seed: u32, kinds: u32) -> Result<RockModel, RockError> {
        let rocks = (0..kinds).map(|kind| Rock::new(&numbers, seed.wrapping_add(kind))).collect::<Result<_, _>>()?;
        Ok(RockModel { numbers, seed, rocks })
    }
}

impl ProceduralModel for RockModel {
    fn bounds(&self) -> Bounds {
        let half = self.rocks.iter().map(Rock::half_box).fold(DVec3::ZERO, DVec3::max);
        Bounds { min: -half, max: half }
    }

    fn kinds(&self) -> u32 {
        self.rocks.len() as u32
    }

    fn materials(&self) -> Vec<Material> {
        Vec::new()
    }

    fn make(&self, seed: u32, detail: f64) -> Result<Vec<Object>, String> {
        let mesh = self.rocks[seed as usize].mesh(detail).map_err(|error| error.to_string())?;
        let shape = Shape::Made(MadeMesh(Arc::new(mesh)));
        Ok(vec![Object { name: "rock".into(), shape, transform: DMat4::IDENTITY, material: None, tolerance: None }])
    }

    fn definition(&self) -> String {
        format!("rocks {:?}, {} kinds from {}", self.numbers, self.rocks.len(), self.seed)
    }
}
