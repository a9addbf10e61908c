//! Requests to rendering nodes that wait, and the running rendering.

use crate::{
    port::{ObjectId, RenderingRequest},
    rendering::Task,
};
use std::collections::VecDeque;

/// Requests that wait, and the running rendering.
#[derive(Debug, Default)]
pub(super) struct Renderings {
    pub(super) waiting: VecDeque<(ObjectId, RenderingRequest)>,
    pub(super) task: Option<RunningRendering>,
    /// Whether a rendering was begun, or tried, since the latest frame.
    pub(super) begun: bool,
}

/// A rendering that is being made.
#[derive(Debug)]
pub(super) struct RunningRendering {
    pub(super) node: ObjectId,
    pub(super) task: Task,
    /// Hue and saturation in force at the node.
    pub(super) color: [f64; 2],
}

impl Renderings {
    /// Whether nothing waits or is running.
    pub(super) fn are_done(&self) -> bool {
        self.waiting.is_empty() && self.task.is_none()
    }
}
