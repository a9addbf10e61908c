//! A message for an input of an operate node, as the value that the node wants.

use crate::structure::{
    NodeFault,
    state::MAX_LEVEL,
    value::{boolean, count, integer, number, position, wrong_kind},
};
use glam::{DMat2, DMat3, DMat4, DVec3};
use protocol::{Value, command::Input};

/// Most frames of a phase of SET RATE and of SET BLINK RATE: half a day. Ours.
const MAX_PHASE: u32 = 60 * 60 * 60 * 12;

/// Left and right, bottom and top, and the intensities if they are given.
type Limits = ([f64; 2], [f64; 2], Option<[f64; 2]>);

/// A message for an input of an operate node.
#[derive(Clone, Copy)]
pub struct Given<'v> {
    /// The input.
    pub input: Input,
    /// The message.
    pub value: &'v Value,
    /// The frame of the display.
    pub frame: u64,
}

/// The matrix of a kind, or the fault.
macro_rules! matrix {
    ($given:ident, $kind:ident) => {
        match $given.value {
            Value::$kind(matrix) => Ok(**matrix),
            value => Err(wrong_kind($given.input, value)),
        }
    };
}

impl Given<'_> {
    /// A 2x2 matrix.
    pub(super) fn matrix2(&self) -> Result<DMat2, NodeFault> {
        matrix!(self, Matrix2)
    }

    /// A 3x3 matrix.
    pub(super) fn matrix3(&self) -> Result<DMat3, NodeFault> {
        matrix!(self, Matrix3)
    }

    /// A 4x3 matrix.
    pub(super) fn matrix4x3(&self) -> Result<DMat4, NodeFault> {
        matrix!(self, Matrix4x3)
    }

    /// A 4x4 matrix.
    pub(super) fn matrix4(&self) -> Result<DMat4, NodeFault> {
        matrix!(self, Matrix4)
    }

    /// An integer or a real.
    pub(super) fn number(&self) -> Result<f64, NodeFault> {
        number(self.value, self.input)
    }

    /// A number, brought into 0..=1.
    pub(super) fn unit(&self) -> Result<f64, NodeFault> {
        Ok(self.number()?.clamp(0.0, 1.0))
    }

    /// TRUE or FALSE.
    pub(super) fn boolean(&self) -> Result<bool, NodeFault> {
        boolean(self.value, self.input)
    }

    /// An integer.
    pub(super) fn integer(&self) -> Result<i32, NodeFault> {
        integer(self.value, self.input)
    }

    /// An integer that is not negative.
    pub(super) fn count(&self) -> Result<u32, NodeFault> {
        count(self.value, self.input)
    }

    /// Frames of a phase, at most half a day.
    pub(super) fn frames(&self) -> Result<u32, NodeFault> {
        Ok(self.count()?.min(MAX_PHASE))
    }

    /// A level of detail, brought into its range.
    pub(super) fn level(&self) -> Result<u16, NodeFault> {
        Ok(self.integer()?.clamp(0, MAX_LEVEL.into()) as u16)
    }

    /// A position in two or three dimensions; z is 0 in two.
    pub(super) fn position(&self) -> Result<DVec3, NodeFault> {
        position(self.value, self.input)
    }

    /// The limits in the rows of a 3x3 matrix, or of a 2x2 one without intensity.
    pub(super) fn viewport(&self) -> Result<Limits, NodeFault> {
        match self.value {
            Value::Matrix3(m) => {
                Ok(([m.x_axis.x, m.x_axis.y], [m.y_axis.x, m.y_axis.y], Some([m.z_axis.x, m.z_axis.y])))
            }
            Value::Matrix2(m) => Ok((m.x_axis.to_array(), m.y_axis.to_array(), None)),
            value => Err(wrong_kind(self.input, value)),
        }
    }

    /// A size, or the size that a 2x2 matrix has: the side of the square that it makes of the unit square. Ours.
    pub(super) fn text_size(&self) -> Result<f64, NodeFault> {
        match self.value {
            Value::Matrix2(m) => Ok(m.determinant().abs().sqrt()),
            _ => self.number(),
        }
    }

    /// Nothing that the node itself can do: a request asks for more, and the mass memory takes it before it comes here.
    pub(super) fn request(&self) -> Result<(), NodeFault> {
        Err(NodeFault::NoSuchInput { input: self.input })
    }
}
