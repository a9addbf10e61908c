//! Stored photons of a lamp, as a record holds them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Stored photons of a lamp on the surfaces of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StoredPhotons {
    /// Values of flux of each photon, 1..=255.
    pub lanes: u8,
    /// In the order in which they were traced.
    pub blocks: Vec<PhotonBlock>,
}

/// Photons that were traced together. The tables are as long as one another, `flux` for each lane.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PhotonBlock {
    /// The number of the target that the photons were sent to.
    pub target: u32,
    /// The number of the block among those sent to that target.
    pub number: u32,
    /// How many paths were traced.
    pub paths: u64,
    /// What became of their flux, W: sent, rescattered, gained, straight, stored, absorbed, escaped, stopped.
    pub balance: [f64; 8],
    /// Where each photon was stored, scene units.
    pub positions: Vec<[f64; 3]>,
    /// Towards where it came from, unit length.
    pub towards: Vec<[f32; 3]>,
    /// Flux, W, lane by lane, one photon after the other.
    pub flux: Vec<f32>,
    /// For each photon, the number of the surface's side that it arrived on.
    pub sides: Vec<u32>,
    /// For each photon, the number of its wavelength set; the highest bit tells that it was scattered broadly before.
    pub wavelength_sets: Vec<u8>,
}

impl StoredPhotons {
    /// How many paths were traced.
    pub fn paths(&self) -> u64 {
        self.blocks.iter().map(|block| block.paths).fold(0, u64::saturating_add)
    }

    /// How many photons were stored.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(|block| block.positions.len()).sum()
    }

    /// Whether none was.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Two corners of a box around the places where they were stored.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let places = || self.blocks.iter().flat_map(|block| &block.positions).map(|at| DVec3::from_array(*at));
        Some([places().reduce(DVec3::min)?, places().reduce(DVec3::max)?])
    }

    pub(super) fn summary(&self) -> String {
        format!("{} photons of {} paths", self.len(), self.paths())
    }

    /// Checks every number; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        let lanes = usize::from(self.lanes);
        if lanes == 0 {
            return Err("photons have no flux".into());
        }
        for block in &self.blocks {
            let count = block.positions.len();
            if [block.towards.len(), block.sides.len(), block.wavelength_sets.len()].iter().any(|other| *other != count)
            {
                return Err("its tables differ in length".into());
            }
            if count.checked_mul(lanes) != Some(block.flux.len()) {
                return Err(format!("{} values of flux for {count} photons", block.flux.len()));
            }
            let finite = block.positions.iter().flatten().chain(&block.balance).all(|number| number.is_finite())
                && block.towards.iter().flatten().chain(&block.flux).all(|number| number.is_finite());
            if !finite {
                return Err("a number is not finite".into());
            }
        }
        Ok(())
    }
}
