//! What goes straight through, as if nothing was there.

use super::lobe::{Flags, Lobe};
use super::shade::Shade;
use super::sighting::{Onward, Sighting};
use crate::color::Channels;
use glam::DVec3;

/// Lets a fraction of light straight through.
#[derive(Clone, Debug)]
pub(super) struct Straight(pub(super) Shade);

impl Lobe for Straight {
    fn flags(&self) -> Flags {
        Flags::DELTA | Flags::STRAIGHT | Flags::BLACK.when(self.0.is_black())
    }

    fn value(&self, _: &Sighting, _: DVec3) -> Channels {
        Channels::ZERO
    }

    fn density(&self, _: &Sighting, _: DVec3) -> f64 {
        0.0
    }

    fn sample(&self, sighting: &Sighting, _: f64, _: [f64; 2]) -> Option<Onward> {
        self.mirrored(sighting)[0]
    }

    #[inline]
    fn strength(&self, sighting: &Sighting) -> f64 {
        self.0.of(sighting).max()
    }

    fn mirrored(&self, sighting: &Sighting) -> [Option<Onward>; 2] {
        [Some(Onward { is_straight: true, ..Onward::single(-sighting.view, self.0.of(sighting)) }), None]
    }
}
