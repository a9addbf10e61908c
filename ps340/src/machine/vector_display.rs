//! The display, and what it is to show.

use crate::calligraphic::{Controls, Refresh, Scene, SharedDisplay};
use std::{cell::Cell, sync::Arc};

/// The display, and what it is to show.
#[derive(Debug, Default)]
pub(super) struct VectorDisplay {
    pub(super) screen: Arc<SharedDisplay>,
    /// Whether somebody else lets the screen go along with the frames.
    pub(super) is_watched: bool,
    pub(super) controls: Controls,
    /// Changes with them.
    pub(super) settings: u64,
    /// What was to be shown lately, and of what its strokes were made.
    pub(super) scene: Scene,
    pub(super) of: Option<PictureVersion>,
    /// The refresh that was reckoned last, and of what.
    pub(super) refresh: Cell<Option<(PictureVersion, Refresh)>>,
}

/// Of what the strokes on the screen are made: other strokes have another version.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PictureVersion {
    pub(super) updates: u64,
    pub(super) overlay: u64,
    pub(super) graphics: bool,
    pub(super) blanked: bool,
    pub(super) screen: u8,
}
