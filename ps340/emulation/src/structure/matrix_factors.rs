//! The parts of the accumulated matrix while polygons are gathered for a rendering.
//!
//! # Model
//! Light and planes need coordinates in which angles are true: *eye coordinates*. They are those just below the
//! innermost perspective (FIELD_OF_VIEW, EYE, a 4x4 matrix with such a last column), or without one, just below the
//! outermost WINDOW or 4x4 matrix; everything below these is modelling.

use glam::DMat4;

/// The parts of the accumulated matrix while polygons are gathered: `ctm = view eye`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatrixFactors {
    /// From eye coordinates to clip space.
    pub view: DMat4,
    /// From the coordinates of the data to eye coordinates.
    pub eye: DMat4,
    /// From the coordinates of the data to those of the rendering node; none outside of it.
    pub local: Option<DMat4>,
    /// Whether a projection was met.
    framed: bool,
    /// Below a SECTIONING_PLANE, and whether that is below the rendering node.
    pub plane: Option<bool>,
}

impl Default for MatrixFactors {
    fn default() -> MatrixFactors {
        MatrixFactors { view: DMat4::IDENTITY, eye: DMat4::IDENTITY, local: None, framed: false, plane: None }
    }
}

impl MatrixFactors {
    /// The parts below a matrix that does not project.
    pub(super) fn transform(&mut self, m: &DMat4) {
        self.eye *= *m;
        self.local.iter_mut().for_each(|local| *local *= *m);
    }

    /// The parts below a window, a field of view or another 4x4 matrix.
    pub(super) fn project(&mut self, m: &DMat4) {
        let affine = m.row(3) == glam::DVec4::W;
        if affine && self.framed {
            return self.transform(m);
        }
        self.view = self.view * self.eye * *m;
        self.eye = DMat4::IDENTITY;
        self.framed = true;
        self.local.iter_mut().for_each(|local| *local *= *m);
    }

    /// Notes that the rendering node is entered.
    pub fn enter(&mut self) {
        self.local = Some(DMat4::IDENTITY);
    }

    /// Notes that a SECTIONING_PLANE is entered.
    pub(super) fn cut(&mut self) {
        self.plane = Some(self.local.is_some());
    }
}
