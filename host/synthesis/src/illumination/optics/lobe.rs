//! The interface of every lobe of a surface: its value, its samples with their pdf, its flags.

use super::context::{BsdfSample, ShadingContext};
use crate::color::Channels;
use glam::DVec3;
use std::ops::BitOr;

/// A lobe whose pdf is greater than this straight above, 1/sr, is narrow: that of a diffuse one is 1/π.
pub(super) const NARROW: f64 = 1.5;

/// Properties of a lobe that hold for all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Flags(u16);

impl Flags {
    /// No flag.
    pub(super) const NONE: Flags = Flags(0);
    /// Delta: it scatters to single directions only, as a mirror or a smooth interface does.
    pub(super) const DELTA: Flags = Flags(1);
    /// Broad: it scatters light about everywhere.
    pub(super) const BROAD: Flags = Flags(2);
    /// Diffuse: it reflects light alike to everywhere.
    pub(super) const DIFFUSE: Flags = Flags(4);
    /// Even: its value is one for all light from above.
    pub(super) const EVEN: Flags = Flags(8);
    /// Black: it reflects nothing, wherever.
    pub(super) const BLACK: Flags = Flags(16);
    /// Straight: it lets light straight through, and does nothing else.
    pub(super) const STRAIGHT: Flags = Flags(32);
    /// Clear: it is a polished interface, through which light goes in one direction.
    pub(super) const CLEAR: Flags = Flags(64);
    /// Pane: it reflects, and lets light straight through, as a polished pane does.
    pub(super) const PANE: Flags = Flags(128);
    /// Translucent: it lets light through alike to everywhere on the other side.
    pub(super) const TRANSLUCENT: Flags = Flags(256);

    /// Whether it has all of some flags.
    #[inline]
    pub(super) fn has(self, flags: Flags) -> bool {
        self.0 & flags.0 == flags.0
    }

    /// These flags if they hold, else none.
    pub(super) fn when(self, holds: bool) -> Flags {
        if holds { self } else { Flags::NONE }
    }

    /// Whether a lobe of a pdf straight above, 1/sr, is broad.
    pub(super) fn of_pdf(pdf: f64) -> Flags {
        Flags::BROAD.when(pdf < NARROW)
    }
}

impl BitOr for Flags {
    type Output = Flags;

    fn bitor(self, other: Flags) -> Flags {
        Flags(self.0 | other.0)
    }
}

/// A lobe: a term of a BSDF, with its own sampling. What a kind does not write is that of a delta lobe, which knows single
/// directions only.
pub(super) trait Lobe {
    /// Its properties for all directions.
    fn flags(&self) -> Flags;

    /// Radiance towards the viewer for a unit of flux density, 1/sr: D K / (N·V); 0 of a delta lobe.
    fn value(&self, _: &ShadingContext, _: DVec3) -> Channels {
        Channels::ZERO
    }

    /// The pdf of its samples, 1/sr.
    fn pdf(&self, _: &ShadingContext, _: DVec3) -> f64 {
        0.0
    }

    /// Samples a direction to light; its weight is right for delta lobes only, all others have a pdf.
    ///
    /// - `choice`: uniform in 0..1. `point`: uniform in the unit square.
    fn sample(&self, context: &ShadingContext, _choice: f64, _point: [f64; 2]) -> Option<BsdfSample> {
        self.specular_samples(context)[0]
    }

    /// About what it reflects to the viewer of all the light; more than 0 where it reflects anything.
    fn strength(&self, context: &ShadingContext) -> f64;

    /// Its specular samples: those of a delta lobe.
    fn specular_samples(&self, _: &ShadingContext) -> [Option<BsdfSample>; 2] {
        [None, None]
    }

    /// Diffuse albedo: the part of light from all around that it reflects alike to everywhere.
    fn diffuse_albedo(&self, _: &ShadingContext) -> Channels {
        Channels::ZERO
    }

    /// Diffuse transmittance: the part of light from all around the other side that it lets through alike to everywhere.
    fn diffuse_transmittance(&self, _: &ShadingContext) -> Channels {
        Channels::ZERO
    }

    /// Glossy albedo: about the part of light from all around that it reflects to the viewer, where it shows what is
    /// around; nothing of others.
    fn glossy_albedo(&self, _: &ShadingContext) -> Channels {
        Channels::ZERO
    }

    /// Transmittance of a polished interface.
    fn clear_transmittance(&self, _: &ShadingContext) -> Channels {
        Channels::ZERO
    }
}
