//! Requests to rendering nodes: one after the other, each in slices of a frame.
//!
//! # Decided here
//! - All messages to input `<1>` of rendering nodes wait in one queue, so that FIX(0) after FIX(4) toggles that
//!   rendering. While the picture is held between BEGIN and END they wait.
//! - In a frame one rendering is begun, at once if none is running, so that it is of the moment of its
//!   request; others wait for a frame of their own.
//! - Every message ends with TRUE or FALSE from output `<1>`.
//! - What changes while a rendering is made does not matter to it.
//! - While a shaded rendering is made the vector screen is dark, and it stays dark until TURNONDISPLAY.

use super::{Machine, renderings::RunningRendering};
use crate::{
    functions::devices::shading::ShadingEnvironment,
    interpreter::Message,
    memory::Refusal,
    port::{ObjectId, Rendering, RenderingRequest},
    rendering::{Facets, RenderingFault, RenderingResult, Task, members},
    structure::NodeFault,
    traversal,
};
use protocol::{Value, command::Input};

/// Work on a rendering in a frame, in units of some ten nanoseconds: less than a frame. Ours.
const RENDERING_PER_FRAME: u64 = 1_000_000;
/// Messages of rendering nodes that wait; more are refused. Ours.
const MAX_WAITING: usize = 1_000;

/// The reason why a request came to nothing.
enum Failure {
    Rendering(RenderingFault),
    Refused(Refusal),
}

impl Machine {
    /// Lets a message to a rendering node wait for its turn.
    pub(super) fn request_rendering(&mut self, node: ObjectId, request: RenderingRequest) {
        if self.renderings.waiting.len() >= MAX_WAITING {
            let name = self.memory.objects.name(node).to_owned();
            let fault = NodeFault::Full { input: Input::Number(1) };
            return self.reports.push(Message::Node { name, fault, hint: String::new() });
        }
        let at_once = self.renderings.waiting.is_empty() && matches!(request, RenderingRequest::Render(_));
        self.renderings.waiting.push_back((node, request));
        // Only what takes a frame may begin at once, or a node whose answers come back to it would never rest.
        if at_once {
            self.begin_renderings();
        }
    }

    /// Does a frame's share of the requests to rendering nodes.
    pub(super) fn advance_renderings(&mut self) {
        self.renderings.begun = false;
        self.begin_renderings();
        if let Some(mut under_way) = self.renderings.task.take() {
            match under_way.task.advance(RENDERING_PER_FRAME) {
                Some(outcome) => {
                    self.finish_rendering(under_way, outcome);
                    self.begin_renderings();
                }
                None => self.renderings.task = Some(under_way),
            }
        }
    }

    /// Carries out the requests that wait, up to one that takes longer.
    fn begin_renderings(&mut self) {
        while self.renderings.task.is_none() && !self.memory.structures.is_held() {
            let Some((node, request)) = self.renderings.waiting.pop_front() else { return };
            if matches!(request, RenderingRequest::Render(_)) {
                if self.renderings.begun {
                    return self.renderings.waiting.push_front((node, request));
                }
                self.renderings.begun = true;
            }
            // The name may have become something else since.
            let Some(solid) = self.memory.rendering_node(node) else { continue };
            match self.carry_rendering(node, solid, request) {
                Ok(true) => self.end_request(node, Ok(())),
                Ok(false) => {}
                Err(failure) => self.end_request(node, Err(failure)),
            }
        }
    }

    /// Carries out a request; false if that takes longer.
    fn carry_rendering(&mut self, node: ObjectId, solid: bool, request: RenderingRequest) -> Result<bool, Failure> {
        let nothing = Failure::Rendering(RenderingFault::Nothing);
        let show = match request {
            RenderingRequest::Render(kind) => {
                self.begin_rendering(node, solid, kind).map_err(Failure::Rendering)?;
                return Ok(false);
            }
            RenderingRequest::Save(name) => {
                let saved = self.memory.save_rendered(node, &name).map_err(Failure::Refused)?;
                return if saved { Ok(true) } else { Err(nothing) };
            }
            RenderingRequest::Show(show) => show,
            RenderingRequest::Toggle => self.memory.structures.rendered(node).is_none_or(|rendered| !rendered.shown),
        };
        // The original is always there.
        if self.memory.structures.show_rendered(node, show) || !show { Ok(true) } else { Err(nothing) }
    }

    fn begin_rendering(&mut self, node: ObjectId, solid: bool, kind: Rendering) -> Result<(), RenderingFault> {
        let structures = &self.memory.structures;
        let gathered = traversal::gather(structures, self.frame, node);
        let facets = Facets::new(&gathered, structures, solid, self.memory.system.working_storage)?;
        let color = facets.color;
        let settings = self.memory.objects.find("SHADINGENVIRONMENT");
        let constant = |input| self.memory.network.port(settings?, input)?.first();
        let task = Task::new(kind, facets, &ShadingEnvironment::from_inputs(constant))?;
        if kind.is_shaded() {
            self.tube.graphics = false;
        }
        self.renderings.task = Some(RunningRendering { node, task, color });
        Ok(())
    }

    fn finish_rendering(&mut self, under_way: RunningRendering, outcome: RenderingResult) {
        let RunningRendering { node, color, .. } = under_way;
        let done = match outcome {
            RenderingResult::Image(image) => {
                self.frame_buffer.paint(image.left, image.bottom, image.width, &image.pixels);
                Ok(())
            }
            RenderingResult::Lines(_) if self.memory.rendering_node(node).is_none() => return,
            RenderingResult::Lines(segments) => {
                self.memory.set_rendered(node, members(segments, color)).map_err(Failure::Refused)
            }
        };
        self.end_request(node, done);
    }

    /// Reports why a request failed, and sends from the output whether it did.
    fn end_request(&mut self, node: ObjectId, done: Result<(), Failure>) {
        let success = Value::Boolean(done.is_ok());
        match done {
            Ok(()) => {}
            Err(Failure::Refused(refusal)) => self.reports.push(refusal.into()),
            Err(Failure::Rendering(fault)) => {
                let name = self.memory.objects.name(node).to_owned();
                self.reports.push(Message::Rendering { name, fault });
            }
        }
        self.memory.network.emit(node, 1, success, &mut self.memory.effects);
    }
}
