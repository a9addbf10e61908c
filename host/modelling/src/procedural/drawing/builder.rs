//! A drawing while it is made.

use super::plant_drawing::{CrossSection, DrawnPolygon, PlantDrawing, Stroke, StrokeNode};
use crate::memory::{self, MemoryExceeded};
use glam::DVec3;

/// Appends to a list that grows while nobody knows how long it will be, if there is memory for that.
pub(in crate::procedural) fn append<T>(list: &mut Vec<T>, item: T, what: &str) -> Result<(), MemoryExceeded> {
    if list.len() == list.capacity() {
        let more = list.capacity().max(8);
        memory::reserve(((list.capacity() + more) * size_of::<T>()) as u64, || {
            format!("drawing {} {what}", list.len())
        })?;
        list.reserve_exact(more);
    }
    list.push(item);
    Ok(())
}

/// A drawing while the turtle is on its way: nodes of strokes come mixed, as it goes back to where branches began.
#[derive(Debug, Default)]
pub(in crate::procedural) struct DrawingBuilder {
    nodes: Vec<(u32, StrokeNode)>,
    strokes: u32,
    pub drawing: PlantDrawing,
}

impl DrawingBuilder {
    /// A line; it goes on with a stroke or begins a new one. Returns the stroke.
    pub fn line(&mut self, stroke: Option<u32>, from: DVec3, to: StrokeNode) -> Result<u32, MemoryExceeded> {
        let number = match stroke {
            Some(number) => number,
            None => {
                self.strokes += 1;
                append(&mut self.nodes, (self.strokes - 1, StrokeNode { position: from, ..to }), "lines")?;
                self.strokes - 1
            }
        };
        append(&mut self.nodes, (number, to), "lines")?;
        Ok(number)
    }

    /// A polygon; nothing for less than three corners.
    pub fn polygon(&mut self, corners: &[DVec3], colour: u32) -> Result<(), MemoryExceeded> {
        if corners.len() < 3 {
            return Ok(());
        }
        let start = self.drawing.corners.len();
        for corner in corners {
            append(&mut self.drawing.corners, *corner, "corners")?;
        }
        let corners = start..self.drawing.corners.len();
        append(&mut self.drawing.polygons, DrawnPolygon { corners, colour }, "polygons")
    }

    /// The drawing, with the nodes of each stroke together.
    pub fn finish(mut self) -> Result<PlantDrawing, MemoryExceeded> {
        let count = self.nodes.len();
        let bytes =
            count * size_of::<StrokeNode>() + self.strokes as usize * (2 * size_of::<usize>() + size_of::<Stroke>());
        memory::reserve(bytes as u64, || format!("sorting {count} nodes of strokes"))?;
        let mut starts = vec![0; self.strokes as usize];
        self.nodes.iter().for_each(|(stroke, _)| starts[*stroke as usize] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += std::mem::replace(start, sum);
        }
        let mut next = starts.clone();
        let nothing = StrokeNode { position: DVec3::ZERO, radius: 0.0, colour: 0 };
        let mut nodes = vec![nothing; count];
        for (stroke, node) in self.nodes {
            nodes[next[stroke as usize]] = node;
            next[stroke as usize] += 1;
        }
        self.drawing.nodes = nodes;
        self.drawing.strokes = starts.into_iter().map(|first| Stroke { first, section: CrossSection::Round }).collect();
        Ok(self.drawing)
    }
}
