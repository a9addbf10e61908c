//! A mirror that reflects a fraction of light.

use super::lobe::{Flags, Lobe};
use super::shade::Shade;
use super::sighting::{Onward, Sighting};
use crate::color::Channels;
use glam::DVec3;

/// Reflects a fraction of light in one direction.
#[derive(Clone, Debug)]
pub(super) struct Mirror(pub(super) Shade);

impl Lobe for Mirror {
    fn flags(&self) -> Flags {
        Flags::DELTA | Flags::BLACK.when(self.0.is_black())
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
        [Some(Onward::single(sighting.mirrored(), self.0.of(sighting))), None]
    }

    fn shown(&self, sighting: &Sighting) -> Channels {
        self.0.of(sighting)
    }
}
