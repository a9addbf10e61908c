//! How the window begins, and what it shares with the machine.

use super::Mapping;
use crate::{line::OperatorLine, shell::Mirror};
use std::sync::{Arc, Mutex, mpsc};

/// Width and height of the window at first, points.
pub(super) const WINDOW: [f32; 2] = [1280.0, 860.0];

/// What window and machine share.
pub(super) struct Link {
    /// The mirror of the machine.
    pub(super) mirror: Arc<Mirror>,
    /// Where operator commands go.
    pub(super) operator_commands: mpsc::Sender<OperatorLine>,
    /// Where hosts attach, as soon as that is known.
    pub(super) lines: Arc<Mutex<Vec<String>>>,
}

/// How the window begins.
#[derive(Clone, Debug, Default)]
pub struct Appearance {
    /// What keys do.
    pub mapping: Mapping,
    /// Points on the screen per unit of the window; none for what the display reports.
    pub scale: Option<f32>,
}
