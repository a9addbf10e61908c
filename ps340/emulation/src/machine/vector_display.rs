//! The vector display, and what it is to show.

use crate::calligraphic::{Controls, Refresh, Scene, SharedDisplay};
use std::{cell::Cell, sync::Arc};

/// The vector display, and what it is to show.
#[derive(Debug, Default)]
pub(super) struct VectorDisplay {
    pub(super) screen: Arc<SharedDisplay>,
    /// Whether somebody else lets the screen go along with the frames.
    pub(super) is_watched: bool,
    pub(super) controls: Controls,
    /// A number that changes with them.
    pub(super) settings: u64,
    /// The latest scene, and what its strokes were made of.
    pub(super) scene: Scene,
    pub(super) of: Option<PictureVersion>,
    /// The refresh that was computed last, and of which strokes.
    pub(super) refresh: Cell<Option<(PictureVersion, Refresh)>>,
}

/// What the strokes on the screen are made of: other strokes have another version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PictureVersion {
    pub(super) updates: u64,
    pub(super) overlay: u64,
    pub(super) graphics: bool,
    pub(super) blanked: bool,
    pub(super) screen: u8,
}
