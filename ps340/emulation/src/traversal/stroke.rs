//! What a traversal draws: strokes in screen coordinates.

/// One straight movement of the beam, or a dot.
///
/// The screen is the square -1..=1 in x (right) and y (up). The intensity runs linearly from the start to
/// the end.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Stroke {
    /// x, y of the start, -1..=1.
    pub start: [f32; 2],
    /// x, y of the end, -1..=1; equal to `start` for a dot.
    pub end: [f32; 2],
    /// Intensity at the start and at the end, 0..=1.
    pub intensity: [f32; 2],
    /// Linear red, green and blue of the full intensity, 0..=1.
    pub color: [f32; 3],
}

impl Stroke {
    /// Whether the beam dwells instead of moving.
    pub fn is_dot(&self) -> bool {
        self.start == self.end
    }
}
