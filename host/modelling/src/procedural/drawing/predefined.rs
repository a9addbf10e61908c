//! Surfaces that a drawing places again and again: leaves, petals.

use crate::mesh::Mesh;
use crate::surface::BezierPatch;
use glam::DVec3;
use std::sync::Arc;

/// A part of a predefined surface.
#[derive(Clone, Debug, PartialEq)]
pub enum PredefinedPart {
    /// A bicubic Bezier patch.
    Patch(Box<BezierPatch>),
    /// Triangles as they are.
    Triangles(Arc<Mesh>),
    /// A polygon on a plane, divided into triangles.
    Polygon {
        /// Its corners.
        corners: Vec<DVec3>,
        /// Corners of each triangle, counter-clockwise as the polygon runs.
        triangles: Vec<[u32; 3]>,
    },
}

/// A surface that `~NAME` places. In its own coordinates x lies to the right of the turtle, y ahead of it and z along
/// its up vector; the turtle stands in the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct PredefinedSurface {
    /// Its name.
    pub name: String,
    /// What it is made of.
    pub parts: Vec<PredefinedPart>,
}
