//! Grids of heights that took long to make, kept for whoever asks for the same again.

use crate::procedural::terrain::{HeightGrid, TerrainError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// So many grids that were made last are kept.
const KEPT: usize = 4;

/// The grids that were made last, by what they were made of; the newest is the last.
pub(super) struct KeptGrids<K>(Mutex<Vec<(K, Arc<HeightGrid>)>>);

impl<K: PartialEq> KeptGrids<K> {
    pub(super) const fn new() -> KeptGrids<K> {
        KeptGrids(Mutex::new(Vec::new()))
    }

    /// A grid; if it is not there, it is made.
    ///
    /// # Errors
    /// [`TerrainError`], if it cannot be made.
    pub(super) fn get(
        &self,
        key: K,
        make: impl FnOnce() -> Result<HeightGrid, TerrainError>,
    ) -> Result<Arc<HeightGrid>, TerrainError> {
        if let Some((_, grid)) = self.last().iter().find(|(other, _)| *other == key) {
            return Ok(grid.clone());
        }
        // Not under the lock: a thread that waits for others to help may come back to here.
        let grid = Arc::new(make()?);
        let mut last = self.last();
        if last.len() == KEPT {
            last.remove(0);
        }
        last.push((key, grid.clone()));
        Ok(grid)
    }

    fn last(&self) -> MutexGuard<'_, Vec<(K, Arc<HeightGrid>)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
