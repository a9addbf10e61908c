//! Local rendering of polygons: vectors without what is hidden or cut off, and shaded images.
//!
//! [`Facets`] are all that is below a rendering node, in one mesh. A [`Task`] makes a rendering of them in pieces of
//! bounded work, so that nothing else has to wait; [`render`] makes it at once.
//!
//! Not modelled: transparency, the time that the machine took, and the order in which it painted.

mod back_face;
mod facets;
mod fault;
mod hidden_line;
mod normals;
mod project;
mod scan;
mod section;
mod shade;
mod solid;
mod surface;
mod triangulate;

pub use facets::{BYTES_PER_VERTEX, Facets, MAX_VERTICES};
pub use fault::RenderingFault;

use crate::{
    functions::devices::shading::ShadingEnvironment,
    port::Rendering,
    structure::{Member, Node, Operation},
};
use glam::DVec3;
use hidden_line::HiddenLine;
use protocol::command::{Fourth, VectorClass, VectorList};
use shade::Shading;

/// A line that a rendering draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its ends in the coordinates of the rendering node.
    pub ends: [DVec3; 2],
    /// Hue and saturation.
    pub color: [f64; 2],
}

/// A part of the raster screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Columns left of it.
    pub left: u32,
    /// Lines below it.
    pub bottom: u32,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Red, green and blue; the bottom line first, left to right.
    pub pixels: Vec<[u8; 3]>,
}

/// What a rendering makes.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Lines for the vector screen.
    Lines(Vec<Segment>),
    /// An image for the raster screen.
    Image(Image),
}

/// A rendering that is under way.
#[derive(Debug)]
pub struct Task(Stage);

#[derive(Debug)]
enum Stage {
    Made(Vec<Segment>),
    HiddenLine(Box<HiddenLine>),
    Shading(Box<Shading>),
}

impl Task {
    /// Begins a rendering.
    ///
    /// # Errors
    /// A solid is none, or a cut has no plane.
    pub fn new(kind: Rendering, facets: Facets, environment: &ShadingEnvironment) -> Result<Task, RenderingFault> {
        if facets.solid {
            solid::check(&facets)?;
        }
        let plane = || facets.plane.ok_or(RenderingFault::NoPlane);
        Ok(Task(match kind {
            Rendering::CrossSection => Stage::Made(section::cross_section(&facets, &plane()?)),
            Rendering::Sectioned => Stage::Made(section::sectioned(&facets, &plane()?)),
            Rendering::BackFace => Stage::Made(back_face::back_face_removal(&facets)),
            Rendering::HiddenLine => Stage::HiddenLine(Box::new(HiddenLine::new(&facets))),
            Rendering::Wash | Rendering::Flat | Rendering::Gouraud | Rendering::Phong => {
                Stage::Shading(Box::new(Shading::new(kind, facets, environment)))
            }
        }))
    }

    /// Goes on for about so many units of work, each some ten nanoseconds. Returns what was made, once it is done.
    pub fn advance(&mut self, units: u64) -> Option<Outcome> {
        match &mut self.0 {
            Stage::Made(segments) => Some(Outcome::Lines(std::mem::take(segments))),
            Stage::HiddenLine(lines) => lines.advance(units).map(Outcome::Lines),
            Stage::Shading(shading) => shading.advance(units).map(Outcome::Image),
        }
    }
}

/// Makes a rendering at once.
///
/// # Errors
/// As [`Task::new`].
pub fn render(kind: Rendering, facets: Facets, environment: &ShadingEnvironment) -> Result<Outcome, RenderingFault> {
    let mut task = Task::new(kind, facets, environment)?;
    loop {
        if let Some(outcome) = task.advance(u64::MAX) {
            return Ok(outcome);
        }
    }
}

/// Lines as members of a structure: a vector list for each colour, in the order in which the colours come first, with
/// SET COLOR before it unless it is in the colour `at_node` that is in force anyway.
pub fn members(mut segments: Vec<Segment>, at_node: [f64; 2]) -> Vec<Member> {
    let mut members = Vec::new();
    // Those in the colour of the node come before a SET COLOR would hold for them.
    let mut next = Some(at_node);
    while let Some(color) = next {
        let (now, later): (Vec<Segment>, Vec<Segment>) = segments.into_iter().partition(|s| s.color == color);
        if color != at_node {
            let operation = Operation::Color { hue: color[0], saturation: color[1] };
            members.push(Member::Unnamed(Node::Operate { operation, descendant: None }));
        }
        if !now.is_empty() {
            members.push(Member::Unnamed(list(&now)));
        }
        next = later.first().map(|segment| segment.color);
        segments = later;
    }
    members
}

fn list(segments: &[Segment]) -> Node {
    let points = segments.iter().flat_map(|segment| segment.ends);
    let list = VectorList {
        block_normalized: false,
        class: VectorClass::Separate,
        dimension: 3,
        estimate: None,
        fourth: Fourth::Intensity,
        internal_units: false,
        points: points.map(|p| [p.x as f32, p.y as f32, p.z as f32, 1.0]).collect(),
        lines: Vec::new(),
    };
    Node::Vectors(Box::new(list.into()))
}

#[cfg(test)]
mod tests;
