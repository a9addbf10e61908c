//! Drawing strokes at once, and the beam's way to the light of a picture.

use super::{Beam, ScreenLight, bins::Bins, optics::Optics};
use crate::traversal::Stroke;

impl Beam {
    /// Its settings within their limits.
    pub(super) fn optics(&self) -> Optics {
        Optics::new(self)
    }

    /// A picture without light.
    pub(super) fn dark(&self, guns: usize) -> ScreenLight {
        ScreenLight::dark(self.optics(), guns)
    }
}

/// Draws `strokes` in their order with three guns and returns the light of every pixel.
///
/// A stroke with a number that is not finite, or farther than [`FAR`](super::FAR) from the screen, is left out.
/// Strokes that leave the picture are cut at its edge together with their glow. Negative intensities
/// and colours count as 0, those above [`STRONGEST`](super::STRONGEST) as that.
///
/// The light is the same for any number of threads.
pub fn draw(beam: &Beam, strokes: &[Stroke]) -> ScreenLight {
    let mut light = beam.dark(3);
    light.write(&mut Bins::default(), strokes);
    light
}
