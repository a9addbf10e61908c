//! What functions want of the next update: matrices, vectors, picks, and the picture itself; and the update.

use super::Machine;
use crate::{
    interpreter::Message,
    memory::Refusal,
    port::ObjectId,
    structure::{Node, Operation},
    traversal::{
        self, MAX_KEPT, PickHit, PickRequest, Requests, Stroke, Transformed, Trouble, Update,
        write_back::{self, RECORD, RECORDS_PER_MESSAGE},
    },
};
use glam::{DMat4, DVec2};
use protocol::{
    Name, Value,
    command::{Fourth, VectorClass, VectorList},
    value::{PickList, TransformedVectors, VectorEnd},
};
use std::sync::Arc;

/// Requests of one kind that wait for an update; more are refused. Ours.
const MAX_WAITING: usize = 1_000;
/// Vectors of a picture that is drawn in each frame in which it changes, though nobody may look: about a tenth of the frame.
/// Ours.
const ALWAYS_DRAWN: u64 = 200_000;

/// Requests that wait for the next update.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    transforms: Vec<TransformRequest>,
    picks: Vec<Pick>,
    /// Nodes whose picture is to be written back; none for all that is displayed.
    write_backs: Vec<Option<ObjectId>>,
}

/// The matrix or vectors of an XFORM node are wanted.
#[derive(Debug)]
pub(super) struct TransformRequest {
    /// The function that asked.
    pub(super) function: ObjectId,
    /// The node.
    pub(super) node: Name,
    /// What gets the data as its definition, besides the message.
    pub(super) destination: Option<Name>,
    /// Of vectors: the first one, from 1.
    pub(super) first: u32,
    /// Of vectors: how many.
    pub(super) count: u32,
}

/// A pick is wanted.
#[derive(Debug)]
pub(super) struct Pick {
    /// The function that asked.
    pub(super) function: ObjectId,
    /// The centre of the box.
    pub(super) at: DVec2,
    /// Whether coordinates are wanted.
    pub(super) coordinates: bool,
    /// Updates that are still tried.
    pub(super) frames: u32,
}

impl Waiting {
    /// Whether nothing waits.
    pub(super) fn is_empty(&self) -> bool {
        self.transforms.is_empty() && self.picks.is_empty() && self.write_backs.is_empty()
    }

    /// Whether the strokes of the picture themselves are wanted.
    fn want_strokes(&self) -> bool {
        !self.write_backs.is_empty()
    }

    pub(super) fn add_transform(&mut self, request: TransformRequest) -> bool {
        let room = self.transforms.len() < MAX_WAITING;
        if room {
            self.transforms.push(request);
        }
        room
    }

    /// A new pick of a function takes the place of the one before.
    pub(super) fn add_pick(&mut self, pick: Pick) -> bool {
        self.picks.retain(|other| other.function != pick.function);
        let room = self.picks.len() < MAX_WAITING;
        if room {
            self.picks.push(pick);
        }
        room
    }

    /// Only one write-back of a node is made at a time.
    pub(super) fn add_write_back(&mut self, node: Option<ObjectId>) {
        if !self.write_backs.contains(&node) {
            self.write_backs.push(node);
        }
    }
}

impl Machine {
    /// Makes the picture anew if something of it changed, or something is wanted of it.
    ///
    /// A picture that stands still costs nothing. One of many vectors is drawn when somebody looks; till then its vectors
    /// are counted, so that frames pass and orders are answered in time.
    pub(super) fn update_picture(&mut self) {
        let is_looked_at = self.is_followed() || self.waiting.want_strokes();
        self.update_picture_of(if is_looked_at { MAX_KEPT } else { ALWAYS_DRAWN });
    }

    /// Draws the picture with all its strokes, for somebody who looks.
    pub(super) fn draw_picture(&mut self) {
        self.update_picture_of(MAX_KEPT);
    }

    /// Brings the picture up to date.
    ///
    /// - `most`: vectors whose strokes are made.
    fn update_picture_of(&mut self, most: u64) {
        if self.memory.structures.is_held() {
            return; // between BEGIN and END
        }
        for (id, fault) in self.memory.structures.renew_dashes() {
            let of = self.memory.title(id);
            self.report(Message::Range { of, text: format!("the pattern is given up: {fault}") });
        }
        let version = self.memory.structures.version();
        let stays = self.update.next_change.is_none_or(|change| self.frame < change);
        let is_there = !self.update.is_counted_only || most < MAX_KEPT;
        if self.updated == Some(version) && self.waiting.is_empty() && stays && is_there {
            return;
        }
        let waiting = std::mem::take(&mut self.waiting);
        let find = |name: &Name| self.memory.target(name);
        let mut picks = waiting.picks.into_iter();
        let mut pick = picks.next();
        let requests = Requests {
            transforms: waiting.transforms.iter().filter_map(|request| find(&request.node)).collect(),
            write_back: waiting.write_backs.iter().copied().flatten().collect(),
            pick: pick.as_ref().map(|pick| self.pick_request(pick)),
        };
        let room = std::mem::take(&mut self.update.strokes);
        let update = traversal::update_into(&self.memory.structures, self.frame, &requests, room, most);
        self.counters.updates += 1;
        if !update.is_counted_only {
            self.counters.strokes = update.strokes.len() as u64;
        }
        self.say_trouble(&update);
        for request in waiting.transforms {
            self.answer_transform(request, &update);
        }
        for node in waiting.write_backs {
            self.answer_write_back(node, &update);
        }
        if let Some(pick) = pick.take() {
            self.answer_pick(pick, update.picked.as_ref());
        }
        // Each pick looks for itself; that there are several in one frame is rare.
        for pick in picks {
            let requests = Requests { pick: Some(self.pick_request(&pick)), ..Requests::default() };
            let update = traversal::update_into(&self.memory.structures, self.frame, &requests, Vec::new(), 0);
            let picked = update.picked;
            self.answer_pick(pick, picked.as_ref());
        }
        self.update = update;
        self.updated = Some(version);
    }

    /// Reports what an update left out, unless it was said of the update before.
    fn say_trouble(&mut self, update: &Update) {
        match update.trouble.filter(|trouble| self.update.trouble != Some(*trouble)) {
            Some(Trouble::ContainsItself(id)) => {
                let name = self.memory.title(id);
                self.report(Message::Structure(format!("{name} contains itself; it is drawn once")));
            }
            Some(trouble) => self.report(Message::Update(trouble)),
            None => {}
        }
    }

    /// Whether a function is still there: its object may have become another since it asked.
    fn still_asks(&self, function: ObjectId, name: &str) -> bool {
        self.memory.network.function(function).is_some_and(|row| row.name == name)
    }

    fn answer_transform(&mut self, request: TransformRequest, update: &Update) {
        if !self.still_asks(request.function, "XFORMDATA") {
            return;
        }
        let node = self.memory.target(&request.node);
        let matrix = node.and_then(|id| update.transforms.get(&id));
        let vectors = node.and_then(|id| update.transformed.get(&id));
        let vectors = vectors.map(|data| all(data).part(request.first, request.count));
        let (value, defined) = match (matrix, vectors) {
            (Some(matrix), _) => (Value::Transform(Box::new(*matrix)), matrix_node(*matrix)),
            (None, Some(data)) => {
                let list = vector_node(&data);
                (Value::Vectors(Arc::new(data)), list)
            }
            (None, None) => return self.report(Refusal::NotFound(request.node).into()),
        };
        if let Some(name) = request.destination
            && let Err(refusal) = self.memory.define_node(&name, defined)
        {
            self.report(refusal.into());
        }
        self.memory.network.emit(request.function, 1, value, &mut self.memory.effects);
    }

    fn answer_write_back(&mut self, node: Option<ObjectId>, update: &Update) {
        let Some(instance) = self.memory.objects.find("WRITEBACK") else { return };
        let strokes: Vec<&Stroke> = match node {
            None => update.strokes.iter().collect(),
            Some(_) => update.write_back.iter().flat_map(|range| &update.strokes[range.clone()]).collect(),
        };
        let mut messages = Vec::new();
        let records = write_back::records(strokes.iter().copied());
        messages.extend(records.chunks(RECORD * RECORDS_PER_MESSAGE).map(|part| (1, Value::string(part))));
        messages.extend(write_back::lines(strokes).iter().map(|line| (2, Value::string(line))));
        for (output, message) in messages {
            self.memory.network.emit(instance, output, message, &mut self.memory.effects);
        }
    }

    fn pick_request(&self, pick: &Pick) -> PickRequest {
        let location = self.memory.objects.find("PICK_LOCATION").and_then(|id| self.memory.structures.node(id));
        let half_size = match location {
            Some(Node::Operate { operation: Operation::PickLocation { size, .. }, .. }) => *size,
            _ => DVec2::ZERO,
        };
        PickRequest { center: pick.at, half_size, coordinates: pick.coordinates }
    }

    fn answer_pick(&mut self, pick: Pick, hit: Option<&PickHit>) {
        if !self.still_asks(pick.function, "PICK") {
            return;
        }
        let Some(hit) = hit else {
            if pick.frames > 1 {
                self.waiting.add_pick(Pick { frames: pick.frames - 1, ..pick });
            } else {
                self.memory.network.emit(pick.function, 2, Value::Boolean(false), &mut self.memory.effects);
            }
            return;
        };
        let list = PickList {
            index: hit.index,
            identifiers: hit.identifiers.clone(),
            node: hit.node.and_then(|id| Name::new(self.memory.objects.name(id)).ok()),
            type_code: hit.kind.code(),
            place: hit.place,
        };
        self.memory.network.emit(pick.function, 1, Value::Pick(Box::new(list)), &mut self.memory.effects);
    }
}

fn all(data: &Transformed) -> TransformedVectors {
    let ends = data.points.iter().zip(&data.lines).map(|(point, line)| VectorEnd { line: *line, point: *point });
    TransformedVectors { ends: ends.collect() }
}

fn matrix_node(matrix: DMat4) -> Node {
    Node::Operate { operation: Operation::Projective(matrix), descendant: None }
}

fn vector_node(data: &TransformedVectors) -> Node {
    let list = VectorList {
        block_normalized: false,
        class: VectorClass::Itemized,
        dimension: 3,
        estimate: None,
        fourth: Fourth::Intensity,
        internal_units: false,
        points: data.ends.iter().map(|e| [e.point.x as f32, e.point.y as f32, e.point.z as f32, 1.0]).collect(),
        lines: data.ends.iter().map(|e| e.line).collect(),
    };
    Node::Vectors(Box::new(list.into()))
}
