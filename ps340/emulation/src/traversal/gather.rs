//! The polygons, lights and sectioning plane that a rendering node renders, gathered by a walk of its own.
//!
//! # Decided here
//! - What is below the node is rendered: polygons, lit by the ILLUMINATION nodes there. A node that the picture meets
//!   several times is rendered where it is met first.
//! - The first polygon that is met below a SECTIONING_PLANE is the plane, and no part of the object if that node is
//!   below the rendering node; otherwise one that is met elsewhere in the picture does.

use crate::{
    port::ObjectId,
    structure::{MatrixFactors, Node, Polygons, State},
};
use glam::{DMat4, DVec3};
use protocol::command::Illumination;

/// A polygon node where it is displayed.
#[derive(Clone, Debug)]
pub struct PolygonBlock<'a> {
    /// The polygons.
    pub polygons: &'a Polygons,
    /// Where they are, and their colour if they give none.
    pub state: State,
    /// The factors of their matrix.
    pub factors: MatrixFactors,
}

/// A plane in eye coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of it.
    pub point: DVec3,
    /// Towards its front, the side from which its polygon runs clockwise; not 0.
    pub normal: DVec3,
}

/// What is below a rendering node.
#[derive(Clone, Debug, Default)]
pub struct Gathered<'a> {
    /// The state at the node; none if the picture does not meet it.
    pub node: Option<State>,
    /// Polygons of the object.
    pub blocks: Vec<PolygonBlock<'a>>,
    /// Lights, each with the matrix to eye coordinates.
    pub lights: Vec<(Illumination, DMat4)>,
    /// The sectioning plane.
    pub plane: Option<Plane>,
}

/// What a walk gathers.
#[derive(Debug)]
pub(super) struct Gatherer<'a> {
    target: ObjectId,
    /// A plane outside of the target.
    elsewhere: Option<Plane>,
    gathered: Gathered<'a>,
}

impl<'a> Gatherer<'a> {
    /// For a rendering node.
    pub(super) fn new(target: ObjectId) -> Gatherer<'a> {
        Gatherer { target, elsewhere: None, gathered: Gathered::default() }
    }

    /// The state below a rendering node.
    pub(super) fn rendering(&mut self, object: Option<ObjectId>, state: &mut State) {
        if object == Some(self.target) && self.gathered.node.is_none() {
            self.gathered.node = Some(State { factors: None, ..state.clone() });
            state.factors.iter_mut().for_each(|factors| factors.enter());
        }
    }

    /// Takes a data node.
    pub(super) fn take(&mut self, node: &'a Node, state: &State) {
        let Some(factors) = state.factors.as_deref() else { return };
        match node {
            Node::Illumination(light) if factors.local.is_some() => self.gathered.lights.push((*light, factors.eye)),
            Node::Polygons(polygons) => {
                match factors.plane {
                    Some(true) if self.gathered.plane.is_none() => self.gathered.plane = plane(polygons, &factors.eye),
                    Some(false) if self.elsewhere.is_none() => self.elsewhere = plane(polygons, &factors.eye),
                    _ => {}
                }
                if factors.local.is_some() && factors.plane != Some(true) {
                    let state = State { factors: None, ..state.clone() };
                    self.gathered.blocks.push(PolygonBlock { polygons, state, factors: *factors });
                }
            }
            _ => {}
        }
    }

    /// What was gathered.
    pub(super) fn finish(self) -> Gathered<'a> {
        Gathered { plane: self.gathered.plane.or(self.elsewhere), ..self.gathered }
    }
}

/// The plane of the first polygon of a node; none if it has no area.
fn plane(polygons: &Polygons, eye: &DMat4) -> Option<Plane> {
    let polygon = polygons.polygons.first()?;
    let corners: Vec<DVec3> =
        polygon.vertices.iter().map(|v| eye.transform_point3(DVec3::from(v.position.map(f64::from)))).collect();
    let normal = newell(&corners) * eye.determinant().signum();
    let point = corners.iter().sum::<DVec3>() / corners.len() as f64;
    (normal.is_finite() && normal != DVec3::ZERO && point.is_finite()).then_some(Plane { point, normal })
}

/// The vector of twice the area of a polygon. It points to where the corners run clockwise, the axes being left-handed.
pub fn newell(corners: &[DVec3]) -> DVec3 {
    let Some(first) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum()
}
