//! The line segments of a data node one by one, with what picking and colour blending need to know of each.

use super::font::{self, Font};
use crate::{
    hue,
    structure::{Labels, Node, Polygons, State, Structures},
};
use glam::{DVec2, DVec3, DVec4};
use protocol::command::{CharacterOrientation, Fourth, VectorClass, VectorList};
use std::ops::ControlFlow;

/// Degrees of hue that one segment of a blended line covers at most.
const BLEND_STEP: f64 = 6.0;

/// A line segment, or a dot if its ends are the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineSegment {
    /// Number of the vector, character, label or polygon in its node, from 1.
    pub(super) index: u32,
    /// Its ends in clip space.
    pub(super) ends: [DVec4; 2],
    /// Its ends in the coordinates of the data.
    pub(super) source: [DVec3; 2],
    /// Intensities of its ends.
    pub(super) intensity: [f64; 2],
    /// Its linear colour, if not that of the state.
    pub(super) color: Option<[f32; 3]>,
    /// Whether it is a dot.
    pub(super) dot: bool,
}

/// A receiver of line segments; it may end the walk.
pub(super) type Sink<'s> = &'s mut dyn FnMut(LineSegment) -> ControlFlow<()>;

/// Gives all line segments of a data node to `sink`, in drawing order. Other nodes have none.
pub(super) fn line_segments(node: &Node, state: &State, structures: &Structures, sink: Sink) -> ControlFlow<()> {
    match node {
        Node::Vectors(vectors) => list(vectors.drawn(), state, sink),
        Node::Characters(characters) => {
            let text = Text::new(state, structures);
            text.write(characters.position, characters.step, &characters.text, None, sink)
        }
        Node::Labels(block) => labels(block, state, structures, sink),
        Node::Polygons(block) => polygons(block, state, sink),
        _ => ControlFlow::Continue(()),
    }
}

/// Vectors, characters and edges of a data node: how many line segments it has at least, without making them.
pub(super) fn parts(node: &Node) -> usize {
    match node {
        Node::Vectors(vectors) => vectors.drawn().points.len(),
        Node::Characters(characters) => characters.text.len(),
        Node::Labels(block) => block.labels.iter().map(|(label, _)| label.text.len()).sum(),
        Node::Polygons(block) => block.polygons.iter().map(|polygon| polygon.vertices.len()).sum(),
        _ => 0,
    }
}

fn list(list: &VectorList, state: &State, sink: Sink) -> ControlFlow<()> {
    let blending = if list.fourth == Fourth::Hue { state.blending } else { None };
    let intensity = |i: usize| if list.fourth == Fourth::Intensity { f64::from(list.points[i][3]) } else { 1.0 };
    let place = |i: usize| DVec3::new(list.points[i][0].into(), list.points[i][1].into(), list.points[i][2].into());
    for to in 0..list.points.len() {
        let dot = list.class == VectorClass::Dots;
        if !dot && !list.is_line(to) {
            continue;
        }
        let from = if dot { to } else { to - 1 };
        let source = [place(from), place(to)];
        let ends = source.map(|p| state.ctm * p.extend(1.0));
        let index = to as u32 + 1;
        let segment =
            LineSegment { index, ends, source, intensity: [intensity(from), intensity(to)], color: None, dot };
        match blending {
            Some(saturation) => {
                blend(segment, [list.points[from][3], list.points[to][3]].map(f64::from), saturation, sink)?
            }
            None => sink(segment)?,
        }
    }
    ControlFlow::Continue(())
}

/// Cuts a line segment into so many that the hue of each is nearly constant.
fn blend(segment: LineSegment, hues: [f64; 2], saturation: f64, sink: Sink) -> ControlFlow<()> {
    // 0 to 720, so that no more than 120 segments come of a line whatever the host sends.
    let [from, to] = hues.map(|h| h.clamp(0.0, 720.0));
    let parts = ((to - from).abs() / BLEND_STEP).ceil().max(1.0) as u32;
    for part in 0..parts {
        let t = [part, part + 1].map(|k| f64::from(k) / f64::from(parts));
        let middle = from + (to - from) * (t[0] + t[1]) / 2.0;
        let color = Some(hue::rgb((middle % 360.0) as f32, saturation as f32));
        let ends = t.map(|t| segment.ends[0].lerp(segment.ends[1], t));
        let source = t.map(|t| segment.source[0].lerp(segment.source[1], t));
        sink(LineSegment { ends, source, color, ..segment })?;
    }
    ControlFlow::Continue(())
}

fn labels(block: &Labels, state: &State, structures: &Structures, sink: Sink) -> ControlFlow<()> {
    let text = Text::new(state, structures);
    for (index, (label, shown)) in (1..).zip(&block.labels) {
        if *shown {
            text.write(label.position, block.step, &label.text, Some(index), sink)?;
        }
    }
    ControlFlow::Continue(())
}

/// The edges of polygons, soft ones too, in the hue of their outline if one was given.
fn polygons(block: &Polygons, state: &State, sink: Sink) -> ControlFlow<()> {
    let mut color = None;
    for (index, polygon) in (1..).zip(&block.polygons) {
        if let Some(outline) = polygon.outline {
            color = Some(hue::rgb(outline as f32, 1.0));
        }
        let corners = polygon.vertices.iter().map(|v| DVec3::from_array(v.position.map(f64::from)));
        let mut from = polygon.vertices.last().map(|v| DVec3::from_array(v.position.map(f64::from)));
        for to in corners {
            if let Some(from) = from {
                let source = [from, to];
                let ends = source.map(|p| state.ctm * p.extend(1.0));
                sink(LineSegment { index, ends, source, intensity: [1.0; 2], color, dot: false })?;
            }
            from = Some(to);
        }
    }
    ControlFlow::Continue(())
}

/// How text is written in one state.
struct Text<'a> {
    state: &'a State,
    /// None if the font is not there: then nothing is drawn.
    font: Option<Font<'a>>,
}

impl<'a> Text<'a> {
    fn new(state: &'a State, structures: &'a Structures) -> Text<'a> {
        let font = match state.font.map(|id| structures.node(id)) {
            None => Some(Font::Standard),
            Some(Some(Node::Font(font))) => Some(Font::User(font)),
            Some(_) => None,
        };
        Text { state, font }
    }

    /// Strokes of character k lie at `position + (k step + stroke) M`, M the character matrix. All segments have the
    /// number `index`, or that of their character.
    fn write(&self, position: DVec3, step: DVec2, text: &[u8], index: Option<u32>, sink: Sink) -> ControlFlow<()> {
        let Some(font) = self.font else { return ControlFlow::Continue(()) };
        for (cell, code) in text.iter().enumerate() {
            let index = index.unwrap_or(cell as u32 + 1);
            let origin = step * cell as f64;
            for stroke in font::strokes(font.glyph(*code)) {
                let local = stroke.map(|p| self.state.characters * (origin + DVec2::from_array(p.map(f64::from))));
                let source = local.map(|l| position + l.extend(0.0));
                let ends = match self.state.orientation {
                    CharacterOrientation::World => source.map(|p| self.state.ctm * p.extend(1.0)),
                    _ => local.map(|l| self.on_screen(position, l)),
                };
                let dot = stroke[0] == stroke[1];
                sink(LineSegment { index, ends, source, intensity: [1.0; 2], color: None, dot })?;
            }
        }
        ControlFlow::Continue(())
    }

    /// A point of screen-oriented text in clip space: `local` beside the position of `anchor`, unrotated.
    fn on_screen(&self, anchor: DVec3, local: DVec2) -> DVec4 {
        let at = self.state.ctm * anchor.extend(1.0);
        let half = |[low, high]: [f64; 2]| (high - low) / 2.0;
        let frame = DVec2::new(half(self.state.horizontal), half(self.state.vertical));
        let offset = match self.state.orientation {
            // In screen units, whatever the viewport.
            CharacterOrientation::ScreenFixed => local / frame,
            // As large as in the world: the mean stretch of the three axes, which no rotation changes.
            _ => {
                let rows = [self.state.ctm.row(0), self.state.ctm.row(1)];
                let stretch =
                    (rows[0].truncate() * frame.x).length_squared() + (rows[1].truncate() * frame.y).length_squared();
                local / frame * (stretch / 2.0).sqrt() / at.w.abs()
            }
        };
        DVec4::new(at.x + offset.x * at.w, at.y + offset.y * at.w, at.z, at.w)
    }
}
