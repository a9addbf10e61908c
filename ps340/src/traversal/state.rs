//! What the walk carries down the structure: matrices and attributes.

use crate::{hue, structure::Operation};
use glam::{DMat2, DMat4};

/// The state at one place of the display structure.
///
/// A matrix of the machine acts on row vectors, and a node's matrix comes before what is above it:
/// `CTM := node CTM`. In the transposed glam form that is `ctm = ctm * node`.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// From the coordinates of the data to clip space, glam form.
    pub ctm: DMat4,
    /// Multiplies the strokes of characters, glam form.
    pub characters: DMat2,
    /// Left and right of the viewport on the screen.
    pub horizontal: [f64; 2],
    /// Bottom and top of the viewport on the screen.
    pub vertical: [f64; 2],
    /// Intensity at the back and at the front that VIEWPORT set.
    pub viewport_intensity: [f64; 2],
    /// Intensity at the back and at the front that SET INTENSITY set, while it is on.
    pub intensity: Option<[f64; 2]>,
    /// Linear red, green and blue of the colour.
    pub color: [f32; 3],
    /// Hue and saturation of the colour.
    pub hue_saturation: [f64; 2],
    /// Whether front and back clip.
    pub depth_clipping: bool,
}

impl Default for State {
    /// The state at a displayed root: no transformation, an orthographic view of -1..=1 with z 0..=1 from
    /// front to back, the whole screen, intensity 0..=1, white, no depth clipping.
    fn default() -> State {
        State {
            ctm: DMat4::IDENTITY,
            characters: DMat2::IDENTITY,
            horizontal: [-1.0, 1.0],
            vertical: [-1.0, 1.0],
            viewport_intensity: [0.0, 1.0],
            intensity: None,
            color: [1.0; 3],
            hue_saturation: [0.0, 0.0],
            depth_clipping: false,
        }
    }
}

impl State {
    /// The state below an operate node.
    pub fn apply(&mut self, operation: &Operation) {
        match operation {
            Operation::Character(m) => self.characters *= *m,
            Operation::Linear(m) => self.ctm *= DMat4::from_mat3(*m),
            Operation::Translate(by) => self.ctm *= DMat4::from_translation(*by),
            Operation::Affine(m) | Operation::Projective(m) => self.ctm *= *m,
            Operation::Viewport { horizontal, vertical, intensity } => {
                self.horizontal = inside(self.horizontal, *horizontal);
                self.vertical = inside(self.vertical, *vertical);
                self.viewport_intensity = intensity.unwrap_or(self.viewport_intensity);
            }
            Operation::Color { hue, saturation } => {
                self.hue_saturation = [*hue, *saturation];
                self.color = hue::rgb(*hue as f32, *saturation as f32);
            }
            Operation::Intensity { on, range } => self.intensity = on.then_some(*range),
            Operation::DepthClipping(on) => self.depth_clipping = *on,
            _ => {}
        }
    }

    /// Intensity at the back and at the front that is in force.
    pub fn depth_cue(&self) -> [f64; 2] {
        self.intensity.unwrap_or(self.viewport_intensity)
    }
}

/// A range inside an enclosing range, where -1..=1 is the whole of it.
fn inside(outer: [f64; 2], inner: [f64; 2]) -> [f64; 2] {
    let [low, high] = outer;
    inner.map(|x| low + (x + 1.0) * (high - low) / 2.0)
}
