//! The walk over the display structure.

use super::{
    Clipper, MAX_DEPTH, MAX_GATHERED, MAX_STORED_VECTORS, MAX_VECTORS, MAX_VISITS, PickHit, PickedKind, Requests,
    Stroke, Update, UpdateFault,
    gather::{Gathered, Gatherer},
    outline::{self, LineSegment},
    phase,
    pick::PickBox,
};
use crate::{
    port::ObjectId,
    structure::{
        Asked, IdentifierChains, Identifiers, MatrixFactors, Member, Node, Operation, Rendered, State, Structures,
    },
};
use glam::{DMat4, DVec3, DVec4};
use protocol::{
    command::{CharacterOrientation, Fourth, VectorClass, VectorList},
    value::PickCoordinates,
};
use rayon::prelude::*;
use std::{
    collections::BTreeSet,
    ops::{ControlFlow, Range},
};

/// Vectors of one list that one thread takes at a time: so few that they stay in its cache.
const PIECE: usize = 1 << 11;
/// Vectors of one list that all threads take together.
const BLOCK: usize = 64 * PIECE;

/// Walks everything that is displayed.
///
/// - `frame`: the number of the refresh frame, for SET RATE and blinking.
pub fn update(structures: &Structures, frame: u64, requests: &Requests) -> Update {
    update_into(structures, frame, requests, Vec::new(), MAX_STORED_VECTORS)
}

/// Walks everything that is displayed, with the memory of the strokes of an earlier update; most of the time of a fresh
/// one goes into its memory.
///
/// - `most`: vectors that are drawn at most, up to [`MAX_STORED_VECTORS`]. A picture of more is walked to answer the
///   requests, and its vectors are counted: [`Update::is_counted_only`].
pub fn update_into(
    structures: &Structures,
    frame: u64,
    requests: &Requests,
    mut strokes: Vec<Stroke>,
    most: u64,
) -> Update {
    let mut walk = Walk::new(structures, frame, requests);
    strokes.clear();
    walk.update.strokes = strokes;
    walk.drawing = Drawing::Stored { most };
    walk.displayed();
    walk.update
}

/// Draws everything that a screen shows, and hands the strokes on part by part, in their order, so that a picture of
/// any number of vectors needs no memory of its own.
///
/// - `screen`: which of the screens that SET DISPLAYS distinguishes, 0..=3.
/// - `take`: gets the parts.
pub fn draw_in_parts(structures: &Structures, frame: u64, screen: u8, take: &mut dyn FnMut(&[Stroke])) {
    let requests = Requests::default();
    let mut walk = Walk::new(structures, frame, &requests);
    walk.drawing = Drawing::HandedOn { screen: 1_u8.checked_shl(screen.into()).unwrap_or(0), take };
    walk.displayed();
    walk.hand_on(0);
}

/// Walks one object with a state of its own, as the cursor that the system shows.
pub fn alone(structures: &Structures, frame: u64, root: ObjectId, state: State) -> Update {
    let requests = Requests::default();
    let mut walk = Walk::new(structures, frame, &requests);
    walk.root(root, state);
    walk.update
}

/// Gathers what a rendering node renders, without drawing anything.
pub fn gather(structures: &Structures, frame: u64, node: ObjectId) -> Gathered<'_> {
    static NOTHING: Requests = Requests { transforms: BTreeSet::new(), write_back: BTreeSet::new(), pick: None };
    let mut walk = Walk::new(structures, frame, &NOTHING);
    walk.gatherer = Some(Gatherer::new(node));
    for root in structures.displayed() {
        walk.root(root, State { factors: Some(Box::<MatrixFactors>::default()), ..State::default() });
    }
    walk.gatherer.map(Gatherer::finish).unwrap_or_default()
}

struct Walk<'a> {
    structures: &'a Structures,
    frame: u64,
    requests: &'a Requests,
    drawing: Drawing<'a>,
    /// What is gathered instead of drawn.
    gatherer: Option<Gatherer<'a>>,
    update: Update,
    identifiers: IdentifierChains<'a>,
    /// A bit for each object that the walk is inside of.
    entered: Vec<u64>,
    /// Clip-space points of the list at hand; kept to save allocations.
    clip: Vec<DVec4>,
}

/// What becomes of strokes.
enum Drawing<'t> {
    /// They stay in the update, unless there are more vectors than this.
    Stored { most: u64 },
    /// Those that one screen shows, a bit, go to somebody who takes them.
    HandedOn { screen: u8, take: &'t mut dyn FnMut(&[Stroke]) },
}

/// A level of the structure that the walk is inside of.
struct Level<'a> {
    items: Items<'a>,
    next: usize,
    /// The state of the next item. Operate nodes of a structure change it for the items after them.
    state: State,
    /// The object that was entered here.
    object: Option<ObjectId>,
}

#[derive(Clone, Copy)]
enum Items<'a> {
    /// Members of a structure.
    Members(&'a [Member]),
    /// Descendants, each with the state of the level.
    Objects(&'a [ObjectId]),
    /// The only descendant.
    Object(ObjectId),
}

/// What the walk comes to next.
struct Visit<'a> {
    object: Option<ObjectId>,
    node: &'a Node,
    /// Whether an operate node applies to the items after it.
    in_structure: bool,
}

impl<'a> Level<'a> {
    /// The next item; none after the last. An item whose object is undefined is skipped.
    fn advance(&mut self, structures: &'a Structures) -> Option<Visit<'a>> {
        loop {
            let place = self.next;
            self.next += 1;
            let (object, in_structure) = match self.items {
                Items::Members(members) => match members.get(place)? {
                    Member::Unnamed(node) => return Some(Visit { object: None, node, in_structure: true }),
                    Member::Named(id) => (*id, true),
                    // An included object is a descendant, as of an instance: its state ends with it.
                    Member::Included(id) => (*id, false),
                },
                Items::Objects(objects) => (*objects.get(place)?, false),
                Items::Object(id) => ((place == 0).then_some(id)?, false),
            };
            if let Some(node) = structures.node(object) {
                return Some(Visit { object: Some(object), node, in_structure });
            }
        }
    }
}

impl<'a> Walk<'a> {
    fn new(structures: &'a Structures, frame: u64, requests: &'a Requests) -> Walk<'a> {
        Walk {
            structures,
            frame,
            requests,
            drawing: Drawing::Stored { most: MAX_STORED_VECTORS },
            gatherer: None,
            update: Update::default(),
            identifiers: IdentifierChains::default(),
            entered: vec![0; structures.extent().div_ceil(64)],
            clip: Vec::new(),
        }
    }

    /// Walks all that is displayed.
    fn displayed(&mut self) {
        for root in self.structures.displayed() {
            self.root(root, State::default());
        }
    }

    fn root(&mut self, root: ObjectId, state: State) {
        let mut levels = vec![Level { items: Items::Object(root), next: 0, state, object: None }];
        while let Some(level) = levels.last_mut() {
            match level.advance(self.structures) {
                Some(visit) => {
                    if self.visit(&visit, &mut levels).is_break() {
                        return;
                    }
                }
                None => {
                    if let Some(object) = levels.pop().and_then(|level| level.object) {
                        self.entered[object.index() / 64] &= !(1 << (object.index() % 64));
                    }
                }
            }
        }
    }

    /// Visits what the innermost level came to; breaks if the update has to end here.
    fn visit(&mut self, visit: &Visit<'a>, levels: &mut Vec<Level<'a>>) -> ControlFlow<()> {
        self.update.visits += 1;
        if self.update.visits > MAX_VISITS {
            self.update.fault = Some(UpdateFault::TooManyVisits);
            return ControlFlow::Break(());
        }
        let Some(level) = levels.last_mut() else { return ControlFlow::Break(()) };
        match visit.node {
            Node::Instance(members) => {
                let state = level.state.clone();
                self.enter(visit.object, Items::Objects(members), state, levels);
            }
            Node::Group(members) => {
                let state = level.state.clone();
                self.enter(visit.object, Items::Members(members), state, levels);
            }
            Node::Operate { operation, descendant, rendered } => {
                if !operation.admits(&level.state) {
                    if visit.in_structure && descendant.is_none() {
                        level.items = Items::Members(&[]); // it guards everything after it
                    }
                    return ControlFlow::Continue(());
                }
                if visit.in_structure && descendant.is_none() {
                    self.apply(operation, visit.object, &mut level.state);
                    if let Some(rendered) = self.shown_instead(rendered.as_deref()) {
                        let state = level.state.clone();
                        level.items = Items::Members(&[]); // it stands for everything after it
                        self.enter(visit.object, rendered, state, levels);
                    }
                    return ControlFlow::Continue(());
                }
                let mut state = level.state.clone();
                self.apply(operation, visit.object, &mut state);
                if let Some(rendered) = self.shown_instead(rendered.as_deref()) {
                    self.enter(visit.object, rendered, state, levels);
                    return ControlFlow::Continue(());
                }
                let below = match (descendant, visit.object) {
                    (Some(below), _) => Items::Object(*below),
                    (None, Some(object)) => Items::Members(self.structures.followers(object)),
                    (None, None) => return ControlFlow::Continue(()),
                };
                self.enter(visit.object, below, state, levels);
            }
            data => self.draw(data, visit.object, &level.state),
        }
        ControlFlow::Continue(())
    }

    /// The vectors that a rendering node shows instead of what is below it.
    fn shown_instead(&self, rendered: Option<&'a Rendered>) -> Option<Items<'a>> {
        let shown = rendered.filter(|rendered| rendered.shown && self.gatherer.is_none());
        shown.map(|rendered| Items::Members(&rendered.members))
    }

    /// Goes a level down, unless the structure is too deep or contains itself.
    fn enter(&mut self, object: Option<ObjectId>, items: Items<'a>, state: State, levels: &mut Vec<Level<'a>>) {
        if levels.len() >= MAX_DEPTH {
            self.update.fault = Some(UpdateFault::TooDeep);
            return;
        }
        if let Some(id) = object {
            let (word, bit) = (&mut self.entered[id.index() / 64], 1 << (id.index() % 64));
            if *word & bit != 0 {
                self.update.fault = Some(UpdateFault::ContainsItself(id));
                return;
            }
            *word |= bit;
        }
        levels.push(Level { items, next: 0, state, object });
    }

    /// The state below an operate node, with what depends on time and on requests.
    fn apply(&mut self, operation: &'a Operation, object: Option<ObjectId>, state: &mut State) {
        match operation.apply(state) {
            Asked::Nothing => {}
            Asked::Phase { rate, since } => {
                let (phase, change) = phase::rate(rate, self.frame.saturating_sub(since));
                state.phase = phase;
                if let Some(change) = change {
                    self.update.changes_at(since + change);
                }
            }
            Asked::Identifier(name) => state.identifiers = self.identifiers.below(state.identifiers, name),
            Asked::Strokes => state.write_back |= object.is_some_and(|o| self.requests.write_back.contains(&o)),
            Asked::Matrix => {
                if let Some(id) = object.filter(|o| self.requests.transforms.contains(o)) {
                    self.update.transforms.entry(id).or_insert(state.ctm);
                }
            }
            Asked::Vectors => {
                if let Some(id) = object.filter(|o| self.requests.transforms.contains(o)) {
                    self.update.transformed.entry(id).or_default();
                    state.gatherer = Some(id);
                }
            }
            Asked::Rendering => self.gatherer.iter_mut().for_each(|gatherer| gatherer.rendering(object, state)),
        }
    }

    /// Draws a data node, unless its state hides it.
    fn draw(&mut self, node: &'a Node, object: Option<ObjectId>, state: &State) {
        if let Some(gatherer) = &mut self.gatherer {
            return gatherer.take(node, state);
        }
        if state.blinking {
            let (seen, change) = phase::blink(state.blink_rate, self.frame);
            self.update.changes_at(change);
            if !seen {
                return;
            }
        }
        let seen_by = match &self.drawing {
            Drawing::Stored { .. } => state.scopes,
            Drawing::HandedOn { screen, .. } => state.scopes & screen,
        };
        if seen_by != 0 {
            self.update.drawn_by(state.scopes);
            let first = self.update.strokes.len();
            match node {
                Node::Vectors(vectors) if vectors.list.fourth != Fourth::Hue || state.blending.is_none() => {
                    self.vectors(vectors.drawn(), state);
                }
                node => self.pieces(node, state),
            }
            if state.write_back {
                self.update.written_back_from(first);
            }
            if let Some(request) = &self.requests.pick
                && state.picking
                && state.identifiers != Identifiers::NONE
                && self.update.picked.is_none()
            {
                let pick_box = PickBox::new(request, state);
                self.update.picked = self.pick(node, object, state, &pick_box, request.coordinates);
            }
        }
        if let Some(gatherer) = state.gatherer {
            self.gather(node, state, gatherer);
        }
    }

    /// Counts vectors; false if they are more than an update draws.
    fn counted(&mut self, vectors: usize) -> bool {
        let sum = self.update.vectors + vectors as u64;
        if sum > MAX_VECTORS {
            self.update.fault = Some(UpdateFault::TooManyVectors);
            return false;
        }
        self.update.vectors = sum;
        true
    }

    /// Whether the vectors that were counted last are drawn.
    fn is_drawn(&mut self) -> bool {
        match self.drawing {
            Drawing::Stored { most } if self.update.vectors > most => {
                if most == MAX_STORED_VECTORS {
                    self.update.fault = Some(UpdateFault::TooManyStored);
                } else if !self.update.is_counted_only {
                    self.update.is_counted_only = true;
                    self.update.strokes.clear();
                    self.update.scopes.clear();
                }
                false
            }
            _ => true,
        }
    }

    /// Gives strokes to who takes them, if there are at least so many.
    fn hand_on(&mut self, least: usize) {
        if let Drawing::HandedOn { take, .. } = &mut self.drawing
            && self.update.strokes.len() >= least
        {
            take(&self.update.strokes);
            self.update.strokes.clear();
        }
    }

    fn vectors(&mut self, list: &VectorList, state: &State) {
        if !self.counted(list.points.len()) || !self.is_drawn() {
            return;
        }
        let clipper = Clipper::new(state);
        if list.points.len() <= PIECE {
            clip(list, 0..list.points.len(), &state.ctm, &clipper, &mut self.clip, &mut self.update.strokes);
            return self.hand_on(BLOCK);
        }
        for start in (0..list.points.len()).step_by(BLOCK) {
            self.block(list, start..(start + BLOCK).min(list.points.len()), state, &clipper);
            self.hand_on(BLOCK);
        }
    }

    /// Draws the vectors of a range of a list.
    fn block(&mut self, list: &VectorList, range: Range<usize>, state: &State, clipper: &Clipper) {
        let starts: Vec<usize> = range.clone().step_by(PIECE).collect();
        if rayon::current_num_threads() == 1 {
            for start in starts {
                let end = (start + PIECE).min(range.end);
                clip(list, start..end, &state.ctm, clipper, &mut self.clip, &mut self.update.strokes);
            }
            return;
        }
        // Long lists are drawn in pieces by all threads; the order of the strokes stays that of the list.
        let parts: Vec<Vec<Stroke>> = starts
            .into_par_iter()
            .map(|start| {
                let end = (start + PIECE).min(range.end);
                let mut strokes = Vec::with_capacity(PIECE);
                clip(list, start..end, &state.ctm, clipper, &mut Vec::with_capacity(PIECE + 1), &mut strokes);
                strokes
            })
            .collect();
        self.update.strokes.reserve(parts.iter().map(Vec::len).sum());
        parts.iter().for_each(|part| self.update.strokes.extend_from_slice(part));
    }

    /// Draws text, polygons and blended lists.
    fn pieces(&mut self, node: &Node, state: &State) {
        if !self.is_drawn() {
            self.counted(outline::parts(node));
            return;
        }
        let mut clipper = Clipper::new(state);
        let is_text = matches!(node, Node::Characters(_) | Node::Labels(_));
        if is_text && state.orientation == CharacterOrientation::ScreenFixed {
            clipper = clipper.at_full_intensity();
        }
        let structures = self.structures;
        // That a segment was one too many is reported by the account.
        let _ = outline::line_segments(node, state, structures, &mut |piece: LineSegment| {
            if !self.counted(1) || !self.is_drawn() {
                return ControlFlow::Break(());
            }
            let clipper = piece.color.map_or(clipper, |color| clipper.in_color(color));
            self.update.strokes.extend(match piece.dot {
                true => clipper.dot(piece.ends[0], piece.intensity[0]),
                false => clipper.line(piece.ends[0], piece.ends[1], piece.intensity),
            });
            self.hand_on(BLOCK);
            ControlFlow::Continue(())
        });
    }

    /// The first line segment of a data node that is inside the pick box.
    fn pick(
        &self,
        node: &Node,
        object: Option<ObjectId>,
        state: &State,
        pick_box: &PickBox,
        coordinates: bool,
    ) -> Option<PickHit> {
        let mut hit = None;
        let _ = outline::line_segments(node, state, self.structures, &mut |piece: LineSegment| {
            let Some(span) = pick_box.inside(piece.ends) else { return ControlFlow::Continue(()) };
            hit = Some((piece, span));
            ControlFlow::Break(())
        });
        let (piece, span) = hit?;
        let (kind, dimension, parameters) = match node {
            Node::Vectors(vectors) => {
                let kind = if vectors.parameters.is_some() { PickedKind::Curve } else { PickedKind::Vectors };
                // In dashes the numbers of the vectors are not those of the curve.
                let chords = vectors.drawn().points.len().saturating_sub(1) as f64;
                let parameters = vectors.parameters.filter(|_| vectors.dashed.is_none());
                (kind, vectors.list.dimension, parameters.map(|range| (range, chords)))
            }
            Node::Labels(_) => (PickedKind::Labels, 3, None),
            Node::Polygons(_) => (PickedKind::Polygons, 3, None),
            _ => (PickedKind::Characters, 3, None),
        };
        let place = coordinates.then(|| {
            let (point, t) = pick_box.coordinates_on(&piece, span);
            let parameter = parameters.map(|([first, last], chords)| {
                let along = (f64::from(piece.index) - 2.0 + t).max(0.0) / chords.max(1.0);
                first + (last - first) * along
            });
            PickCoordinates { point, dimension, parameter }
        });
        let identifiers = self.identifiers.names(state.identifiers);
        Some(PickHit { index: piece.index, identifiers, node: object, kind, coordinates: place })
    }

    /// Adds the vectors of a list to what an XFORM VECTOR node gathers. Text and polygons are no vectors.
    fn gather(&mut self, node: &Node, state: &State, gatherer: ObjectId) {
        let Node::Vectors(vectors) = node else { return };
        let list = vectors.drawn();
        let into = self.update.transformed.entry(gatherer).or_default();
        if into.points.len() + list.points.len() > MAX_GATHERED {
            self.update.fault = Some(UpdateFault::TooManyGathered);
            return;
        }
        let place = |p: &[f32; 4]| state.ctm.project_point3(DVec3::new(p[0].into(), p[1].into(), p[2].into()));
        into.points.extend(list.points.iter().map(place));
        into.lines.extend((0..list.points.len()).map(|i| list.is_line(i)));
    }
}

/// Transforms and clips the vectors *to* the points of `range`.
fn clip(
    list: &VectorList,
    range: Range<usize>,
    ctm: &DMat4,
    clipper: &Clipper,
    clip: &mut Vec<DVec4>,
    strokes: &mut Vec<Stroke>,
) {
    let first = range.start.saturating_sub(1);
    clip.clear();
    Clipper::transform(ctm, &list.points[first..range.end], clip);
    let bright = list.fourth == Fourth::Intensity;
    let intensity = |i: usize| if bright { f64::from(list.points[i][3]) } else { 1.0 };
    for i in range {
        let to = clip[i - first];
        // Each pushes its own: a stroke of two origins would pass through memory on its way.
        if list.class == VectorClass::Dots {
            strokes.extend(clipper.dot(to, intensity(i)));
        } else if list.is_line(i)
            && let Some(stroke) = clipper.line(clip[i - 1 - first], to, [intensity(i - 1), intensity(i)])
        {
            strokes.push(stroke);
        }
    }
}
