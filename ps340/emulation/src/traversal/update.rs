//! The requests to an update, and its results.

use super::{MAX_DEPTH, MAX_GATHERED, MAX_STORED_VECTORS, MAX_VECTORS, MAX_VISITS, PickHit, PickRequest, Stroke};
use crate::{port::ObjectId, structure::ALL_SCOPES};
use glam::{DMat4, DVec3};
use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
};

/// Requests to one update besides the picture.
#[derive(Clone, Debug, Default)]
pub struct Requests {
    /// XFORM nodes whose matrix or vectors are requested.
    pub transforms: BTreeSet<ObjectId>,
    /// WRITEBACK nodes whose picture is requested.
    pub write_back: BTreeSet<ObjectId>,
    /// What is to be picked.
    pub pick: Option<PickRequest>,
}

/// An update fault: the reason why an update is incomplete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UpdateFault {
    /// An object contains itself; it is drawn once.
    #[error("a structure contains itself")]
    ContainsItself(ObjectId),
    /// Structures are nested more than [`MAX_DEPTH`] deep.
    #[error("the display structure is more than {MAX_DEPTH} levels deep")]
    TooDeep,
    /// More than [`MAX_VISITS`] nodes.
    #[error("an update visits at most {MAX_VISITS} nodes")]
    TooManyVisits,
    /// More than [`MAX_VECTORS`] vectors.
    #[error("an update draws at most {MAX_VECTORS} vectors")]
    TooManyVectors,
    /// More than [`MAX_STORED_VECTORS`] vectors in a picture whose strokes are stored.
    #[error("a window and lists of strokes show at most {MAX_STORED_VECTORS} vectors")]
    TooManyStored,
    /// More than [`MAX_GATHERED`] vectors below XFORM VECTOR.
    #[error("XFORM VECTOR gathers at most {MAX_GATHERED} vectors")]
    TooManyGathered,
}

/// The vectors below an XFORM VECTOR node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transformed {
    /// Each point after the accumulated matrix, divided by w.
    pub points: Vec<DVec3>,
    /// Whether the vector to each point is a line.
    pub lines: Vec<bool>,
}

/// The result of one update.
#[derive(Clone, Debug, Default)]
pub struct Update {
    /// What the beam draws, in the order of the structure.
    pub strokes: Vec<Stroke>,
    /// From which stroke on which screens draw, as bits; before the first entry all do.
    pub scopes: Vec<(usize, u8)>,
    /// The accumulated matrix of each XFORM MATRIX node that was asked for and met (the first time).
    pub transforms: BTreeMap<ObjectId, DMat4>,
    /// The vectors of each XFORM VECTOR node that was asked for and met.
    pub transformed: BTreeMap<ObjectId, Transformed>,
    /// The strokes below WRITEBACK nodes that were asked for and met.
    pub write_back: Vec<Range<usize>>,
    /// What was picked, if anything.
    pub picked: Option<PickHit>,
    /// The frame from which the picture is another, though nothing of the structure changes.
    pub next_change: Option<u64>,
    /// Whether the picture has more vectors than were to be drawn: then they are counted only, and there is no stroke.
    pub is_counted_only: bool,
    /// Nodes visited.
    pub visits: u64,
    /// Vectors and character strokes that went into the pipeline.
    pub vectors: u64,
    /// What was left out, if anything.
    pub fault: Option<UpdateFault>,
}

impl Update {
    /// The strokes that a screen draws, 0..=3.
    pub fn on_screen(&self, screen: u8) -> impl Iterator<Item = &Stroke> {
        let bit = 1_u8.checked_shl(u32::from(screen)).unwrap_or(0);
        let ends = self.scopes.iter().skip(1).map(|run| run.0).chain([self.strokes.len()]);
        let first = self.scopes.first().map_or(self.strokes.len(), |run| run.0);
        let runs = std::iter::once((0..first, ALL_SCOPES))
            .chain(self.scopes.iter().zip(ends).map(|(run, end)| (run.0..end, run.1)));
        runs.filter(move |run| run.1 & bit != 0).flat_map(|run| &self.strokes[run.0])
    }

    /// Notes that the strokes from now on are drawn by other screens.
    pub(super) fn drawn_by(&mut self, scopes: u8) {
        if self.scopes.last().map_or(ALL_SCOPES, |run| run.1) != scopes {
            self.scopes.push((self.strokes.len(), scopes));
        }
    }

    /// Notes that the strokes from `first` on are written back.
    pub(super) fn written_back_from(&mut self, first: usize) {
        let end = self.strokes.len();
        match self.write_back.last_mut() {
            Some(range) if range.end == first => range.end = end,
            _ => self.write_back.push(first..end),
        }
    }

    /// Notes that the picture changes by itself at a frame.
    pub(super) fn changes_at(&mut self, frame: u64) {
        self.next_change = Some(self.next_change.map_or(frame, |next| next.min(frame)));
    }
}
