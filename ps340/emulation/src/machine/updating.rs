//! Updates of the picture, and the answers to what functions request of them.

use super::{
    Machine,
    pending::{Pick, TransformRequest},
};
use crate::{
    interpreter::Message,
    memory::Refusal,
    port::ObjectId,
    structure::{Node, Operation},
    traversal::{
        self, MAX_STORED_VECTORS, PickHit, PickRequest, Requests, Stroke, Transformed, Update, UpdateFault,
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

/// Vectors of a picture that is drawn in each frame in which it changes, though nobody may look: about a tenth of the
/// frame. Ours.
const ALWAYS_DRAWN: u64 = 200_000;

impl Machine {
    /// Makes the picture anew if something of it changed, or a request for it waits.
    ///
    /// A picture that stands still costs nothing. One of many vectors is drawn when somebody looks; till then its
    /// vectors are counted, so that frames pass and operator commands are answered in time.
    pub(super) fn update_picture(&mut self) {
        let is_looked_at = self.is_followed() || self.latest.pending.need_strokes();
        self.update_picture_of(if is_looked_at { MAX_STORED_VECTORS } else { ALWAYS_DRAWN });
    }

    /// Draws the picture with all its strokes, for somebody who looks.
    pub(super) fn draw_picture(&mut self) {
        self.update_picture_of(MAX_STORED_VECTORS);
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
        let stays = self.latest.update.next_change.is_none_or(|change| self.frame < change);
        let is_there = !self.latest.update.is_counted_only || most < MAX_STORED_VECTORS;
        if self.latest.version == Some(version) && self.latest.pending.is_empty() && stays && is_there {
            return;
        }
        let waiting = std::mem::take(&mut self.latest.pending);
        let find = |name: &Name| self.memory.target(name);
        let mut picks = waiting.picks.into_iter();
        let mut pick = picks.next();
        let requests = Requests {
            transforms: waiting.transforms.iter().filter_map(|request| find(&request.node)).collect(),
            write_back: waiting.write_backs.iter().copied().flatten().collect(),
            pick: pick.as_ref().map(|pick| self.pick_request(pick)),
        };
        let room = std::mem::take(&mut self.latest.update.strokes);
        let update = traversal::update_into(&self.memory.structures, self.frame, &requests, room, most);
        self.counters.updates += 1;
        if !update.is_counted_only {
            self.counters.strokes = update.strokes.len() as u64;
        }
        self.report_fault(&update);
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
        self.latest.update = update;
        self.latest.version = Some(version);
    }

    /// Reports what an update left out, unless it was reported of the update before.
    fn report_fault(&mut self, update: &Update) {
        match update.fault.filter(|fault| self.latest.update.fault != Some(*fault)) {
            Some(UpdateFault::ContainsItself(id)) => {
                let name = self.memory.title(id);
                self.report(Message::Structure(format!("{name} contains itself; it is drawn once")));
            }
            Some(fault) => self.report(Message::Update(fault)),
            None => {}
        }
    }

    /// Whether a request is still pending: the object of its function may have become another since it asked.
    fn is_pending(&self, function: ObjectId, name: &str) -> bool {
        self.memory.network.function(function).is_some_and(|row| row.name == name)
    }

    fn answer_transform(&mut self, request: TransformRequest, update: &Update) {
        if !self.is_pending(request.function, "XFORMDATA") {
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
        let half_size = location.and_then(Node::operation).and_then(Operation::pick_box_size).unwrap_or(DVec2::ZERO);
        PickRequest { center: pick.at, half_size, coordinates: pick.coordinates }
    }

    fn answer_pick(&mut self, pick: Pick, hit: Option<&PickHit>) {
        if !self.is_pending(pick.function, "PICK") {
            return;
        }
        let Some(hit) = hit else {
            if pick.frames > 1 {
                self.latest.pending.add_pick(Pick { frames: pick.frames - 1, ..pick });
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
            coordinates: hit.coordinates,
        };
        self.memory.network.emit(pick.function, 1, Value::Pick(Box::new(list)), &mut self.memory.effects);
    }
}

fn all(data: &Transformed) -> TransformedVectors {
    let ends = data.points.iter().zip(&data.lines).map(|(point, line)| VectorEnd { line: *line, point: *point });
    TransformedVectors { ends: ends.collect() }
}

fn matrix_node(matrix: DMat4) -> Node {
    Node::operate(Operation::Projective(matrix), None)
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
