//! What a turtle or a model of a plant draws, as plain data.

use super::predefined::PredefinedSurface;
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
pub struct DrawnPolygon {
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
pub struct DrawnSphere {
    /// Its middle.
    pub centre: DVec3,
    /// Its radius, 0 or more.
    pub radius: f64,
    /// Number of its colour.
    pub colour: u32,
}

/// A stroke: its axis runs through its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// The number of its first node among those of the drawing.
    pub first: usize,
    /// What it looks like where it is cut across.
    pub section: CrossSection,
}

/// The outline of a stroke where it is cut across its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CrossSection {
    /// A circle.
    #[default]
    Round,
    /// A circle with waves: the radius at an angle a is r (1 + depth sin(count a)).
    Lobed {
        /// How many waves there are.
        count: f64,
        /// Their height, in parts of the radius, 0 and more and below 1.
        depth: f64,
    },
    /// A line, as of a blade of grass: twice the radius wide, without thickness.
    Flat {
        /// A unit vector along the line, the same at all nodes.
        across: DVec3,
    },
}

/// What a turtle draws as it obeys a string of modules, and what models of plants draw.
///
/// Lines that follow each other in one branch are one stroke: a tube or a blade that narrows from node to node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantDrawing {
    /// Nodes of all strokes, one stroke after the other.
    pub nodes: Vec<StrokeNode>,
    /// The strokes, in the order of their nodes; each has two nodes at least.
    pub strokes: Vec<Stroke>,
    /// Filled polygons.
    pub polygons: Vec<DrawnPolygon>,
    /// Corners of all polygons, one polygon after the other.
    pub corners: Vec<DVec3>,
    /// Predefined surfaces with their places.
    pub placed: Vec<PlacedPredefined>,
    /// Spheres.
    pub spheres: Vec<DrawnSphere>,
    /// The surfaces that are placed.
    pub surfaces: Arc<[PredefinedSurface]>,
}

impl PlantDrawing {
    /// The nodes of each stroke.
    pub fn strokes(&self) -> impl Iterator<Item = &[StrokeNode]> {
        let ends = self.strokes.iter().skip(1).map(|stroke| stroke.first).chain([self.nodes.len()]);
        self.strokes.iter().zip(ends).map(|(stroke, end)| &self.nodes[stroke.first..end])
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
