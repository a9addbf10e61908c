//! The reason why a rendering was not made.

use glam::DVec3;

/// The reason why a rendering was not made; the node is then as before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderingFault {
    /// The picture does not meet the node.
    #[error("it is not displayed")]
    NotDisplayed,
    /// Nothing is below the node that could be rendered.
    #[error("no polygons")]
    NoPolygons,
    /// RESERVE_WORKING_STORAGE gave less than this, or the polygons are more than are rendered together.
    #[error("{needed} bytes of working storage are needed")]
    Storage {
        /// In bytes.
        needed: u64,
    },
    /// A cut is wanted, and no SECTIONING_PLANE with a polygon is displayed.
    #[error("no sectioning plane")]
    NoPlane,
    /// The polygons below a SOLID_RENDERING are no boundary of a solid.
    #[error(
        "not a valid solid: {edges} of its edges are not shared by two polygons in opposite directions, the first from \
         {} to {}", position_text(.first[0]), position_text(.first[1])
    )]
    NotSolid {
        /// How many edges are wrong.
        edges: usize,
        /// The ends of the first of them, in the coordinates of the node.
        first: [DVec3; 2],
    },
    /// No rendering was made that could be shown or saved.
    #[error("nothing was rendered")]
    Nothing,
}

/// A point as a command would give it.
fn position_text(point: DVec3) -> String {
    let [x, y, z] = point.to_array().map(|c| c as f32);
    format!("{x},{y},{z}")
}

impl RenderingFault {
    /// The number of the message.
    pub fn number(&self) -> u16 {
        match self {
            RenderingFault::Storage { .. } => 8,
            _ => 10,
        }
    }

    /// The text after the number.
    ///
    /// - `name`: the name of the node.
    pub fn text(&self, name: &str) -> String {
        match self {
            RenderingFault::Storage { needed } => {
                format!("Insufficient memory: {name} needs RESERVE_WORKING_STORAGE {needed}")
            }
            fault => format!("Rendering failed: {fault} at {name}"),
        }
    }
}
