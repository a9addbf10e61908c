//! What a turtle draws, as plain data.

use super::predefined::PredefinedSurface;
use crate::memory::{self, MemoryExceeded};
use crate::numeric::bounds::Bounds;
use glam::{DAffine3, DVec3};
use std::ops::Range;
use std::sync::Arc;

/// A place on the axis of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeNode {
    /// Where it is.
    pub position: DVec3,
    /// Radius of the stroke there, 0 or more.
    pub radius: f64,
    /// Number of the colour of the segment that ends there; at the first node that of the segment that begins there.
    pub colour: u32,
}

/// A filled polygon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TurtlePolygon {
    /// Its corners among those of the drawing, at least three.
    pub corners: Range<usize>,
    /// Number of its colour.
    pub colour: u32,
}

/// A predefined surface that is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPredefined {
    /// Which one, by its number among those of the grammar.
    pub surface: usize,
    /// From its own coordinates into those of the drawing.
    pub placement: DAffine3,
    /// Number of its colour.
    pub colour: u32,
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurtleSphere {
    /// Its middle.
    pub centre: DVec3,
    /// Its radius, 0 or more.
    pub radius: f64,
    /// Number of its colour.
    pub colour: u32,
}

/// What a turtle draws as it obeys a string of modules.
///
/// Lines that follow each other in one branch are one stroke: a tube that narrows from node to node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TurtleDrawing {
    /// Nodes of all strokes, one stroke after the other.
    pub nodes: Vec<StrokeNode>,
    /// Where each stroke begins among the nodes; each has two nodes at least.
    pub strokes: Vec<usize>,
    /// Filled polygons.
    pub polygons: Vec<TurtlePolygon>,
    /// Corners of all polygons, one polygon after the other.
    pub corners: Vec<DVec3>,
    /// Predefined surfaces with their places.
    pub placed: Vec<PlacedPredefined>,
    /// Spheres.
    pub spheres: Vec<TurtleSphere>,
    /// The predefined surfaces of the grammar.
    pub surfaces: Arc<[PredefinedSurface]>,
}

impl TurtleDrawing {
    /// The nodes of each stroke.
    pub fn strokes(&self) -> impl Iterator<Item = &[StrokeNode]> {
        let ends = self.strokes.iter().skip(1).copied().chain([self.nodes.len()]);
        self.strokes.iter().zip(ends).map(|(start, end)| &self.nodes[*start..end])
    }

    /// A box around strokes, polygons and spheres, and around the origins of predefined surfaces.
    pub fn bounds(&self) -> Bounds {
        let around = |centre: DVec3, radius: f64| [centre - radius, centre + radius];
        let nodes = self.nodes.iter().flat_map(|node| around(node.position, node.radius));
        let spheres = self.spheres.iter().flat_map(|sphere| around(sphere.centre, sphere.radius));
        let placed = self.placed.iter().map(|one| one.placement.translation);
        Bounds::of(nodes.chain(spheres).chain(placed).chain(self.corners.iter().copied()))
    }
}

/// Appends to a list that grows while nobody knows how long it will be, if there is memory for that.
pub(super) fn append<T>(list: &mut Vec<T>, item: T, what: &str) -> Result<(), MemoryExceeded> {
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
pub(super) struct DrawingBuilder {
    nodes: Vec<(u32, StrokeNode)>,
    strokes: u32,
    pub drawing: TurtleDrawing,
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
        append(&mut self.drawing.polygons, TurtlePolygon { corners, colour }, "polygons")
    }

    /// The drawing, with the nodes of each stroke together.
    pub fn finish(mut self) -> Result<TurtleDrawing, MemoryExceeded> {
        let count = self.nodes.len();
        let bytes = count * size_of::<StrokeNode>() + self.strokes as usize * 2 * size_of::<usize>();
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
        self.drawing.strokes = starts;
        Ok(self.drawing)
    }
}
