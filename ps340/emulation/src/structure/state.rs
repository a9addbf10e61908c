//! What a walk carries down the structure: matrices and attributes.

use super::{MatrixFactors, identifiers::Identifiers};
use crate::port::ObjectId;
use glam::{DMat2, DMat4, DVec2};
use protocol::command::CharacterOrientation;

/// All screens: a bit for each of the four.
pub const ALL_SCOPES: u8 = 0b1111;
/// Most a level of detail can be, as remembered from the manuals.
pub const MAX_LEVEL: u16 = 32_767;
/// How many conditional bits there are.
pub const CONDITIONAL_BITS: u8 = 15;
/// Frames of a blinking phase where SET BLINK RATE gives none; ours: half a second.
const DEFAULT_BLINK_RATE: u32 = 30;

/// The state at one point of the display structure.
///
/// A matrix of the machine acts on row vectors, and a node's matrix comes before what is above it:
/// `CTM := node CTM`. In the transposed glam form that is `ctm = ctm * node`.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// From the coordinates of the data to clip space, glam form.
    pub ctm: DMat4,
    /// Multiplies the strokes of characters, glam form.
    pub characters: DMat2,
    /// How characters stand.
    pub orientation: CharacterOrientation,
    /// The font of characters; none for the standard one.
    pub font: Option<ObjectId>,
    /// Left and right of the viewport on the screen.
    pub horizontal: [f64; 2],
    /// Bottom and top of the viewport on the screen.
    pub vertical: [f64; 2],
    /// Intensity at the back and at the front that VIEWPORT set.
    pub viewport_intensity: [f64; 2],
    /// Intensity at the back and at the front that SET INTENSITY set, while it is on.
    pub intensity: Option<[f64; 2]>,
    /// Multiplies the intensity.
    pub contrast: f64,
    /// Linear red, green and blue of the colour.
    pub color: [f32; 3],
    /// Hue and saturation of the colour.
    pub hue_saturation: [f64; 2],
    /// Saturation of lists with a hue for each vector; without it they have the colour of the others.
    pub blending: Option<f64>,
    /// Whether front and back clip.
    pub depth_clipping: bool,
    /// A bit for each screen that draws.
    pub scopes: u8,
    /// Whether it blinks.
    pub blinking: bool,
    /// Frames of a blinking phase, not 0.
    pub blink_rate: u32,
    /// Whether what is drawn can be picked.
    pub picking: bool,
    /// The pick identifiers on the way.
    pub identifiers: Identifiers,
    /// Centre and half size of the pick box, where the structure sets it.
    pub pick_box: Option<[DVec2; 2]>,
    /// The level of detail, 0..=32767.
    pub level: i32,
    /// The conditional bits.
    pub bits: u16,
    /// The phase of the nearest SET RATE above.
    pub phase: bool,
    /// Whether it is to be plotted.
    pub plotter: bool,
    /// Whether the picture of what is below is written back.
    pub write_back: bool,
    /// The XFORM VECTOR node that gathers the vectors below.
    pub gatherer: Option<ObjectId>,
    /// The parts of the matrix, while polygons are gathered for a rendering.
    pub factors: Option<Box<MatrixFactors>>,
}

impl Default for State {
    /// The state at a displayed root: no transformation, an orthographic view of -1..=1 with z 0..=1 from
    /// front to back, the whole screen, intensity 0..=1, white, no depth clipping, all screens, no picking,
    /// level of detail 0, all conditional bits off, phase on.
    fn default() -> State {
        State {
            ctm: DMat4::IDENTITY,
            characters: DMat2::IDENTITY,
            orientation: CharacterOrientation::World,
            font: None,
            horizontal: [-1.0, 1.0],
            vertical: [-1.0, 1.0],
            viewport_intensity: [0.0, 1.0],
            intensity: None,
            contrast: 1.0,
            color: [1.0; 3],
            hue_saturation: [0.0, 0.0],
            blending: None,
            depth_clipping: false,
            scopes: ALL_SCOPES,
            blinking: false,
            blink_rate: DEFAULT_BLINK_RATE,
            picking: false,
            identifiers: Identifiers::NONE,
            pick_box: None,
            level: 0,
            bits: 0,
            phase: true,
            plotter: false,
            write_back: false,
            gatherer: None,
            factors: None,
        }
    }
}

impl State {
    /// The state below a matrix that moves and does not project.
    pub(super) fn transform(&mut self, m: DMat4) {
        self.ctm *= m;
        self.factors.iter_mut().for_each(|factors| factors.transform(&m));
    }

    /// The state below a window, a field of view or another 4x4 matrix.
    pub(super) fn project(&mut self, m: &DMat4) {
        self.ctm *= *m;
        self.factors.iter_mut().for_each(|factors| factors.project(m));
    }

    /// The state below a viewport, whose limits are those on the screen.
    pub(super) fn look_through(&mut self, horizontal: [f64; 2], vertical: [f64; 2], intensity: Option<[f64; 2]>) {
        self.horizontal = horizontal;
        self.vertical = vertical;
        self.viewport_intensity = intensity.unwrap_or(self.viewport_intensity);
    }

    /// Intensity at the back and at the front that is in force.
    pub fn depth_cue(&self) -> [f64; 2] {
        self.intensity.unwrap_or(self.viewport_intensity).map(|i| i * self.contrast)
    }
}

/// A range inside an enclosing range, where -1..=1 is the whole of it.
pub(super) fn inside(outer: [f64; 2], inner: [f64; 2]) -> [f64; 2] {
    let [low, high] = outer;
    inner.map(|x| low + (x + 1.0) * (high - low) / 2.0)
}
