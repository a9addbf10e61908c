//! The surface of a terrain, with its cells kept as they are asked for.

use super::super::error::TerrainError;
use super::super::field::HeightField;
use super::block::Block;
use super::ground::{Ground, GroundView, SIDE};
use crate::numeric::bounds::Bounds;
use glam::DVec2;
use std::fmt;
use std::sync::RwLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// The smooth surface of a terrain as it is seen from some places.
///
/// It is a function of the height field and of the views alone. What is computed of it is kept up to a limit; beyond that it
/// is computed anew, which changes no result.
pub struct TerrainSurface {
    pub(super) ground: Ground,
    /// The coarsest cells, and all finer ones that were asked for.
    pub(super) root: RwLock<Box<Block>>,
    most_bytes: u64,
    blocks: AtomicU64,
    made: AtomicU64,
    asked: AtomicU64,
}

/// What a surface costs by now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TerrainCosts {
    /// Squares of 256 cells that were computed, also again.
    pub made: u64,
    /// How many of these are kept.
    pub kept: u64,
    /// Bytes of those that are kept.
    pub bytes: u64,
    /// How often the height function was asked, for heights or for bounds.
    pub evaluations: u64,
}

impl TerrainSurface {
    /// The surface over the region of a height field.
    ///
    /// - `views`: from where it is seen; none for all detail that the function has, everywhere.
    /// - `most_bytes`: that may be kept; the coarsest cells are kept in any case.
    ///
    /// # Errors
    /// [`TerrainError`] for a view whose numbers are out of range.
    pub fn new(field: HeightField, views: Vec<GroundView>, most_bytes: u64) -> Result<TerrainSurface, TerrainError> {
        let ground = Ground::new(field, views)?;
        let mut asked = 0;
        let root = RwLock::new(Box::new(Block::root(&ground, &mut asked)));
        let [blocks, made, asked] = [1, 1, asked].map(AtomicU64::new);
        Ok(TerrainSurface { ground, root, most_bytes, blocks, made, asked })
    }

    /// Holds the surface.
    pub fn bounds(&self) -> Bounds {
        self.ground.field().bounds()
    }

    /// The height at a place, and its derivatives by x and z; beyond the region as at its edge.
    pub fn height_and_slope(&self, at: DVec2) -> (f64, DVec2) {
        let [from, to] = self.ground.field().region();
        let at = at.clamp(from, to);
        let found = {
            let root = self.root.read().unwrap_or_else(|poisoned| poisoned.into_inner());
            let mut block: &Block = &root;
            loop {
                let within = (at - block.corner) / block.spacing;
                let cell = [within.x, within.y].map(|axis| (axis.max(0.0) as usize).min(SIDE - 1));
                if block.is_final(cell) {
                    let place = (at - block.corner_of(cell)) / block.spacing;
                    let (height, slope) = block.patch(cell).height_and_slope(place);
                    break (height, slope / block.spacing);
                }
                block = self.quarter(block, cell);
            }
        };
        self.keep_to_limit();
        found
    }

    /// What it costs by now.
    pub fn costs(&self) -> TerrainCosts {
        let of = |count: &AtomicU64| count.load(Ordering::Relaxed);
        let kept = of(&self.blocks);
        TerrainCosts { made: of(&self.made), kept, bytes: kept * Block::BYTES, evaluations: of(&self.asked) }
    }

    /// The quarter of a block that has a cell.
    pub(super) fn quarter<'b>(&self, block: &'b Block, cell: [usize; 2]) -> &'b Block {
        block.quarter(&self.ground, cell, |asked| {
            self.blocks.fetch_add(1, Ordering::Relaxed);
            self.made.fetch_add(1, Ordering::Relaxed);
            self.asked.fetch_add(asked, Ordering::Relaxed);
        })
    }

    /// Drops all but the coarsest cells if too much is kept.
    pub(super) fn keep_to_limit(&self) {
        let is_too_much = || self.blocks.load(Ordering::Relaxed) * Block::BYTES > self.most_bytes.max(Block::BYTES);
        if !is_too_much() {
            return;
        }
        let mut root = self.root.write().unwrap_or_else(|poisoned| poisoned.into_inner());
        if is_too_much() {
            root.forget();
            self.blocks.store(1, Ordering::Relaxed);
        }
    }
}

impl fmt::Debug for TerrainSurface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TerrainSurface").field("ground", &self.ground).field("costs", &self.costs()).finish()
    }
}
