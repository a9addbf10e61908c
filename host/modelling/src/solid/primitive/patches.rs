//! Solids bounded by sculptured patches.

use super::PrimitiveError;
use crate::solid::{Body, Solid};
use crate::surface::{Surface, Tolerance};
use std::sync::Arc;

/// The solid between patches, outside out, that meet bit by bit along all their sides.
///
/// # Errors
/// [`PrimitiveError::Open`] with the open edges if they do not close.
pub fn sculptured<S: Surface + 'static>(patches: Vec<S>) -> Result<Body, PrimitiveError> {
    let curved = patches.into_iter().map(|patch| Arc::new(patch) as Arc<dyn Surface>).collect();
    let body = Body::new(curved, Vec::new());
    // Whether sides meet does not depend on how finely they are divided.
    let coarse = body.tessellate(Tolerance::new(f64::MAX, 60.0))?;
    Solid::new(coarse)?;
    Ok(body)
}
