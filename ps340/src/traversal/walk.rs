//! The walk over the display structure.

use super::{Clipper, State, Stroke, font};
use crate::{
    port::ObjectId,
    structure::{Member, Node, Operation, Structures},
};
use glam::{DMat4, DVec2, DVec4};
use protocol::command::{Characters, VectorClass, VectorList};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// How deep nodes may nest. The real stack held tens of levels; ours ends a structure that contains itself.
pub const MAX_DEPTH: usize = 500;
/// How many nodes one update visits, so that instances of instances of instances end.
pub const MAX_VISITS: u64 = 20_000_000;
/// How many vectors one update draws; their strokes take 36 bytes each.
pub const MAX_VECTORS: u64 = 20_000_000;

/// Vectors of one list that one thread takes at a time.
const PIECE: usize = 1 << 14;

/// Why an update is incomplete.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// A structure contains itself, or is deeper than [`MAX_DEPTH`].
    #[error("the display structure is more than {MAX_DEPTH} levels deep")]
    TooDeep,
    /// More than [`MAX_VISITS`] nodes.
    #[error("an update visits at most {MAX_VISITS} nodes")]
    TooManyVisits,
    /// More than [`MAX_VECTORS`] vectors.
    #[error("an update draws at most {MAX_VECTORS} vectors")]
    TooManyVectors,
}

/// What one update made.
#[derive(Clone, Debug, Default)]
pub struct Update {
    /// What the beam draws, in the order of the structure.
    pub strokes: Vec<Stroke>,
    /// The accumulated matrix of each XFORM MATRIX node that was asked for and met (the first time).
    pub transforms: BTreeMap<ObjectId, DMat4>,
    /// Nodes visited.
    pub visits: u64,
    /// Vectors and character strokes that went into the pipeline.
    pub vectors: u64,
    /// What was left out, if anything.
    pub trouble: Option<Trouble>,
}

/// Walks everything that is displayed, and looks up the matrices of the nodes in `wanted`.
pub fn update(structures: &Structures, wanted: &BTreeSet<ObjectId>) -> Update {
    let mut walk = Walk { structures, wanted, update: Update::default(), clip: Vec::new() };
    for root in structures.displayed() {
        walk.object(root, &mut State::default(), 0);
    }
    walk.update
}

/// The strokes of one object from a state of its own, as of the cursor that the system shows.
pub fn alone(structures: &Structures, root: ObjectId, mut state: State) -> Vec<Stroke> {
    let mut walk = Walk { structures, wanted: &BTreeSet::new(), update: Update::default(), clip: Vec::new() };
    walk.object(root, &mut state, 0);
    walk.update.strokes
}

struct Walk<'a> {
    structures: &'a Structures,
    wanted: &'a BTreeSet<ObjectId>,
    update: Update,
    /// Clip-space points of the list at hand; kept to save allocations.
    clip: Vec<DVec4>,
}

impl Walk<'_> {
    fn object(&mut self, id: ObjectId, state: &mut State, depth: usize) {
        if let Some(node) = self.structures.node(id) {
            self.node(Some(id), node, state, depth);
        }
    }

    /// Visits a node. An operate node without a descendant changes `state`, for the members after it.
    fn node(&mut self, id: Option<ObjectId>, node: &Node, state: &mut State, depth: usize) {
        self.update.visits += 1;
        if self.update.visits > MAX_VISITS {
            self.update.trouble = Some(Trouble::TooManyVisits);
            return;
        }
        if depth >= MAX_DEPTH {
            self.update.trouble = Some(Trouble::TooDeep);
            return;
        }
        match node {
            Node::Nil => {}
            Node::Instance(members) => {
                for member in members {
                    self.object(*member, &mut state.clone(), depth + 1);
                }
            }
            Node::Group(members) => self.group(members, &mut state.clone(), depth + 1),
            Node::Vectors(node) => self.vectors(node.drawn(), state),
            Node::Characters(characters) => self.characters(characters, state),
            Node::Operate { operation, descendant } => {
                if let (Operation::XformMatrix, Some(id)) = (operation, id)
                    && self.wanted.contains(&id)
                {
                    self.update.transforms.entry(id).or_insert(state.ctm);
                }
                match descendant {
                    Some(below) => {
                        let mut inner = state.clone();
                        inner.apply(operation);
                        self.object(*below, &mut inner, depth + 1);
                    }
                    None => state.apply(operation),
                }
            }
            _ => {}
        }
    }

    fn group(&mut self, members: &[Member], state: &mut State, depth: usize) {
        for member in members {
            match member {
                Member::Unnamed(node) => self.node(None, node, state, depth),
                Member::Named(id) => self.object(*id, state, depth),
                // An included object is a descendant, as of an instance: its state ends with it.
                Member::Included(id) => self.object(*id, &mut state.clone(), depth),
            }
        }
    }

    /// Counts vectors; false if they are more than an update draws.
    fn counted(&mut self, vectors: usize) -> bool {
        let sum = self.update.vectors + vectors as u64;
        if sum > MAX_VECTORS {
            self.update.trouble = Some(Trouble::TooManyVectors);
            return false;
        }
        self.update.vectors = sum;
        true
    }

    fn vectors(&mut self, list: &VectorList, state: &State) {
        if !self.counted(list.points.len()) {
            return;
        }
        let clipper = Clipper::new(state);
        if list.points.len() <= PIECE {
            pieces(list, 0..list.points.len(), &state.ctm, &clipper, &mut self.clip, &mut self.update.strokes);
            return;
        }
        // Long lists are drawn in pieces by all threads; the order of the strokes stays that of the list.
        let starts: Vec<usize> = (0..list.points.len()).step_by(PIECE).collect();
        let parts: Vec<Vec<Stroke>> = starts
            .into_par_iter()
            .map(|start| {
                let end = (start + PIECE).min(list.points.len());
                let mut strokes = Vec::with_capacity(PIECE);
                pieces(list, start..end, &state.ctm, &clipper, &mut Vec::with_capacity(PIECE + 1), &mut strokes);
                strokes
            })
            .collect();
        self.update.strokes.reserve(parts.iter().map(Vec::len).sum());
        parts.iter().for_each(|part| self.update.strokes.extend_from_slice(part));
    }

    /// Strokes of character k lie at `position + (k step + stroke) M`, M the character matrix.
    fn characters(&mut self, characters: &Characters, state: &State) {
        let clipper = Clipper::new(state);
        let clip = |cell: usize, p: [f32; 2]| {
            let at = characters.step * cell as f64 + DVec2::new(f64::from(p[0]), f64::from(p[1]));
            state.ctm * (characters.position + (state.characters * at).extend(0.0)).extend(1.0)
        };
        for (cell, code) in characters.text.iter().enumerate() {
            for line in font::glyph(*code) {
                if !self.counted(line.len()) {
                    return;
                }
                if let [only] = line.as_slice() {
                    self.update.strokes.extend(clipper.dot(clip(cell, *only), 1.0));
                }
                let ends = line.windows(2).filter_map(|w| clipper.line(clip(cell, w[0]), clip(cell, w[1]), [1.0; 2]));
                self.update.strokes.extend(ends);
            }
        }
    }
}

/// Transforms and clips the vectors *to* the points of `range`.
fn pieces(
    list: &VectorList,
    range: std::ops::Range<usize>,
    ctm: &DMat4,
    clipper: &Clipper,
    clip: &mut Vec<DVec4>,
    strokes: &mut Vec<Stroke>,
) {
    let first = range.start.saturating_sub(1);
    clip.clear();
    Clipper::transform(ctm, &list.points[first..range.end], clip);
    let intensity = |i: usize| f64::from(list.points[i][3]);
    for i in range {
        let to = clip[i - first];
        if list.class == VectorClass::Dots {
            strokes.extend(clipper.dot(to, intensity(i)));
        } else if list.is_line(i) {
            strokes.extend(clipper.line(clip[i - 1 - first], to, [intensity(i - 1), intensity(i)]));
        }
    }
}
